//! Looking at a fluid: particles, sums and energies.

use crate::fluid::Fluid;
use crate::settings::{FluidError, FluidSettings};
use crate::source::{Emitter, Sink};
use crate::walls::Walls;
use arps::{Motion, Restraint};
use nalgebra::Vector3;

/// A particle as it is now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Lasting number, never given twice.
    pub id: u64,
    /// Position (m).
    pub position: Vector3<f64>,
    /// Momentum per mass (m/s).
    pub velocity: Vector3<f64>,
    /// Rate at which the position changes (m/s): less than the velocity for restrained particles.
    pub effective_velocity: Vector3<f64>,
    /// Density (kg/m³).
    pub density: f64,
    /// Pressure (Pa).
    pub pressure: f64,
}

/// Energies of a fluid (J).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// Of motion, by momenta (J).
    pub kinetic: f64,
    /// Of compression, also of the walls (J).
    pub internal: f64,
    /// Of gravity, from the origin up (J).
    pub potential: f64,
}

impl Energy {
    /// The sum (J).
    pub fn total(&self) -> f64 {
        self.kinetic + self.internal + self.potential
    }
}

impl<R: Restraint> Fluid<R> {
    /// What the policy makes of each particle, in the order of [`Fluid::particles`]. One slower than
    /// [`RestraintSettings::inactivity`](crate::RestraintSettings::inactivity) rests, too.
    pub fn motions(&self) -> impl ExactSizeIterator<Item = Motion> + '_ {
        let (mass, time) = (self.laws.mass, self.time);
        let vector = |p: &[f64; 4]| Vector3::new(p[0], p[1], p[2]);
        (0..self.len()).map(move |i| {
            let Some((policy, settings)) = &self.restraint else { return Motion::Full };
            let x = vector(&self.state.x[i]);
            let index = self.state.id[i] as usize;
            let held = policy.at(&arps::Particle { index, mass, x, time });
            let p = vector(&self.state.u[i]) * mass;
            match held.motion(&p) {
                Motion::Transition if held.velocity(&p).norm() < settings.inactivity => {
                    Motion::Rest
                }
                motion => motion,
            }
        })
    }
}

impl<R> Fluid<R> {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.state.len()
    }

    /// True if there are no particles.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The particles, in an order that changes whenever neighbours are listed.
    pub fn particles(&self) -> impl ExactSizeIterator<Item = Particle> + '_ {
        (0..self.len()).map(|i| self.particle(i))
    }

    fn particle(&self, i: usize) -> Particle {
        let vector = |p: &[f64; 4]| Vector3::new(p[0], p[1], p[2]);
        let density = self.state.full_density(i);
        Particle {
            id: self.state.id[i],
            position: vector(&self.state.x[i]),
            velocity: vector(&self.state.u[i]),
            effective_velocity: vector(&self.state.w[i]),
            density,
            pressure: self.laws.tait.pressure(density),
        }
    }

    /// The particles by ascending lasting number.
    pub fn particles_by_id(&self) -> Vec<Particle> {
        let mut particles: Vec<Particle> = self.particles().collect();
        particles.sort_unstable_by_key(|particle| particle.id);
        particles
    }

    /// Accelerations with gravity (m/s²), in the order of [`Fluid::particles`].
    pub fn accelerations(&self) -> impl ExactSizeIterator<Item = Vector3<f64>> + '_ {
        self.state.a.iter().map(|a| Vector3::new(a[0], a[1], a[2]))
    }

    /// Simulated time (s).
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Mass of a particle (kg).
    pub fn particle_mass(&self) -> f64 {
        self.laws.mass
    }

    /// The settings it was made with.
    pub fn settings(&self) -> &FluidSettings {
        &self.settings
    }

    /// The walls.
    pub fn walls(&self) -> &Walls {
        &self.walls
    }

    /// Adds a nozzle, which begins to let particles out in the next step.
    ///
    /// # Errors
    /// If it is not in the domain.
    pub fn add_emitter(&mut self, emitter: Emitter) -> Result<(), FluidError> {
        let bounds = emitter.bounds();
        for corner in [bounds.min, bounds.max] {
            if !self.settings.domain.contains(&corner) {
                let (name, wanted) = ("place of an emitter", "within the domain");
                return Err(FluidError::OutOfRange { name, value: corner.amax(), wanted });
            }
        }
        self.emitters.push(emitter);
        Ok(())
    }

    /// Adds a box in which particles vanish.
    pub fn add_sink(&mut self, sink: Sink) {
        self.sinks.push(sink);
    }

    /// Sum of the momenta (kg·m/s).
    pub fn momentum(&self) -> Vector3<f64> {
        self.particles().map(|p| p.velocity).sum::<Vector3<f64>>() * self.laws.mass
    }

    /// Energies by motion, compression and gravity (J).
    pub fn energy(&self) -> Energy {
        let mut sum = Energy::default();
        for p in self.particles() {
            sum.kinetic += 0.5 * p.velocity.norm_squared();
            sum.internal += self.laws.tait.energy(p.density);
            sum.potential -= self.settings.gravity.dot(&p.position);
        }
        let m = self.laws.mass;
        let walls = self.touched.density.iter().zip(&self.touched.mass);
        let of_walls: f64 =
            walls.map(|(&density, mass)| mass * self.laws.tait.energy(density)).sum();
        Energy {
            kinetic: m * sum.kinetic,
            internal: m * sum.internal + of_walls,
            potential: m * sum.potential,
        }
    }
}
