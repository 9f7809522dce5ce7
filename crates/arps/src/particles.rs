//! The state of a particle system, and its adaptive Hamiltonian.

use crate::error::StateError;
use crate::restraint::{Particle, Restraint};
use crate::{Held, Vector3};

/// Positions, momenta and masses of particles.
#[derive(Clone, Debug, PartialEq)]
pub struct Particles {
    /// Positions (m).
    pub x: Vec<Vector3>,
    /// Momenta (kg m/s). They go on changing while a particle rests.
    pub p: Vec<Vector3>,
    /// Time (s).
    pub time: f64,
    m: Vec<f64>,
}

impl Particles {
    /// Particles at positions (m) with velocities (m/s) and masses (kg) at time 0. The velocities
    /// give the momenta m v, restrained or not.
    ///
    /// # Errors
    /// Lists of different lengths; a position or velocity that is not finite; a mass that is not
    /// positive and finite.
    pub fn new(x: Vec<Vector3>, v: &[Vector3], m: Vec<f64>) -> Result<Particles, StateError> {
        if x.len() != v.len() || x.len() != m.len() {
            return Err(StateError::Lengths { x: x.len(), v: v.len(), m: m.len() });
        }
        for i in 0..x.len() {
            if !(m[i] > 0.0 && m[i] < f64::INFINITY) {
                return Err(StateError::Mass { particle: i, mass: m[i] });
            }
            if !x[i].iter().chain(v[i].iter()).all(|c| c.is_finite()) {
                return Err(StateError::NotFinite { particle: i });
            }
        }
        let p = v.iter().zip(&m).map(|(v, m)| *m * v).collect();
        Ok(Particles { x, p, time: 0.0, m })
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.m.len()
    }

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.m.is_empty()
    }

    /// Masses (kg).
    pub fn masses(&self) -> &[f64] {
        &self.m
    }

    /// What a policy sees of one particle.
    #[inline]
    pub fn particle(&self, index: usize) -> Particle {
        Particle { index, mass: self.m[index], x: self.x[index], time: self.time }
    }

    /// Sets `held` to what a policy says of every particle.
    pub fn hold(&self, restraint: &impl Restraint, held: &mut Vec<Held>) {
        held.clear();
        held.extend((0..self.len()).map(|i| restraint.at(&self.particle(i))));
    }

    /// Restrained kinetic energy Σ T(p) (J).
    pub fn kinetic_energy(&self, restraint: &impl Restraint) -> f64 {
        let energy = |i: usize| restraint.at(&self.particle(i)).kinetic_energy(&self.p[i]);
        (0..self.len()).map(energy).sum()
    }

    /// The adaptive Hamiltonian H_AR = Σ T(p) + V (J), Manteaux2013 Eq. (2), for the potential energy
    /// V (J) of these positions. Steps conserve it in place of the full energy.
    pub fn hamiltonian(&self, restraint: &impl Restraint, potential: f64) -> f64 {
        self.kinetic_energy(restraint) + potential
    }

    /// Σ p (kg m/s). Conserved in closed systems, restrained or not.
    pub fn linear_momentum(&self) -> Vector3 {
        self.p.iter().sum()
    }

    /// Σ x × p (kg m²/s). Conserved in closed systems, restrained or not, since the effective
    /// velocity is along p.
    pub fn angular_momentum(&self) -> Vector3 {
        self.x.iter().zip(&self.p).map(|(x, p)| x.cross(p)).sum()
    }
}
