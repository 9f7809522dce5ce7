//! What impacts strain is taken out of velocities.
//!
//! A way that impacts bend ends where no force has led it, and strains cloth. That it is not above the
//! incremental potential of the start at rest does not bound the energy
//!
//!   E = ½ Σ mᵢ |vᵢ|² + V(x),
//!
//! so what E has gained over a step that nothing drives is taken out of the motion around the bent
//! places, against their own rigid motion: linear and angular momentum stay. Friction and damping only
//! take, and what the cloth touches stands still.

use super::Step;
use crate::neighbours::Neighbours;
use crate::solve_report::SolveError;
use crate::system::{Constraints, System};
use mesh_core::{ClothState, World3, par};
use nalgebra::{Matrix3, SymmetricEigen};

/// Changes of the energy below this share of it are rounding.
const ROUNDING: f64 = 1e-12;
/// The motion that energy is taken from has at least this many times as much of it, if any has.
const PLENTY: f64 = 2.0;
/// Smallest principal moment of inertia, over the largest, about which parts are seen to turn.
const SLENDER: f64 = 1e-9;

/// Where a step leads.
pub(crate) struct StepEnd<'a> {
    /// Positions (m).
    pub(crate) x: &'a [World3],
    /// Velocities (m/s).
    pub(crate) v: &'a mut [World3],
    /// Vertices whose way was bent.
    pub(crate) bent: &'a [u32],
}

/// Leaves the end of a step with no more energy than its start, the state of `cloth`, if something was
/// bent and nothing drives the step.
///
/// # Errors
/// If there is not enough motion to take it from, unless that is accepted.
pub(crate) fn take_back(
    system: &mut System,
    cloth: &ClothState,
    end: StepEnd<'_>,
    constraints: &dyn Fn(f64) -> Constraints,
    Step { time, h }: Step,
) -> Result<(), SolveError> {
    let StepEnd { x, v, bent } = end;
    if bent.is_empty() || system.is_driven(&cloth.x, constraints, [time, time + h]) {
        return Ok(());
    }
    let m = &cloth.m;
    let kinetic = |v: &[World3]| 0.5 * par::sum(v.len(), |i| m[i] * v[i].norm_squared());
    let [potential, potential_t1] = [&cloth.x, x].map(|x| system.energy_at_rest(x));
    let energy = kinetic(&cloth.v) + potential;
    let excess = kinetic(v) + potential_t1 - energy;
    if excess <= ROUNDING * (energy.abs() + potential.abs()) {
        return Ok(());
    }
    // What stands by friction goes on to stand.
    let is_friction = system.rests_by_friction();
    let stands = |i: u32| is_friction && v[i as usize] == World3::zeros();
    let bent: Vec<u32> = bent.iter().copied().filter(|&i| !stands(i)).collect();
    let mut area = Area::around(&bent, system, x.len());
    (0..x.len() as u32).for_each(|i| area.is_barred[i as usize] = stands(i));
    for (i, _) in constraints(time + h).fixed {
        area.is_barred[i as usize] = true;
    }
    let mut rings = 1;
    let (motions, own) = loop {
        let motions = area.motions(m, x, v);
        let own: f64 = motions.iter().map(|(part, motion)| motion.other(part, m, x, v)).sum();
        if own >= PLENTY * excess || !area.grow(rings) {
            break (motions, own);
        }
        rings *= 2;
    };
    if own < PLENTY * excess && !system.accepts_rise {
        // The next try knows nothing of this one.
        system.wake_all();
        return Err(SolveError::Rise { time: time + h, h });
    }
    let kept = if own > 0.0 { (1.0 - excess / own).max(0.0).sqrt() } else { 1.0 };
    for (part, motion) in &motions {
        for &i in part {
            let i = i as usize;
            let rigid = motion.at(&x[i]);
            v[i] = rigid + (v[i] - rigid) * kept;
        }
    }
    Ok(())
}

/// Vertices around some, along the couplings of the system, contact among them.
struct Area {
    near: Neighbours,
    is_in: Vec<bool>,
    /// Vertices that stay out of it.
    is_barred: Vec<bool>,
    /// Those that came in last.
    rim: Vec<u32>,
}

impl Area {
    fn around(bent: &[u32], system: &System, n: usize) -> Area {
        let near = Neighbours::new(system.matrix.pattern());
        let mut is_in = vec![false; n];
        bent.iter().for_each(|&i| is_in[i as usize] = true);
        Area { near, is_in, is_barred: vec![false; n], rim: bent.to_vec() }
    }

    /// Takes in this many rings of neighbours; false if there are none.
    fn grow(&mut self, rings: usize) -> bool {
        let before = self.rim.clone();
        for _ in 0..rings {
            let mut next = Vec::new();
            for &j in self.rim.iter().flat_map(|&i| self.near.of(i as usize)) {
                let is_new = !self.is_barred[j as usize] && !self.is_in[j as usize];
                if is_new {
                    self.is_in[j as usize] = true;
                    next.push(j);
                }
            }
            if next.is_empty() {
                break;
            }
            self.rim = next;
        }
        self.rim != before
    }

    /// The connected parts, and how each moves as a whole.
    fn motions(&self, m: &[f64], x: &[World3], v: &[World3]) -> Vec<(Vec<u32>, RigidMotion)> {
        let mut seen = vec![false; x.len()];
        let mut motions = Vec::new();
        for start in (0..x.len()).filter(|&i| self.is_in[i]) {
            if std::mem::replace(&mut seen[start], true) {
                continue;
            }
            let mut part = vec![start as u32];
            let mut k = 0;
            while k < part.len() {
                for &j in self.near.of(part[k] as usize) {
                    if self.is_in[j as usize] && !std::mem::replace(&mut seen[j as usize], true) {
                        part.push(j);
                    }
                }
                k += 1;
            }
            part.sort_unstable();
            let motion = RigidMotion::of(&part, m, x, v);
            motions.push((part, motion));
        }
        motions
    }
}

/// The motion of a rigid body.
struct RigidMotion {
    centre: World3,
    velocity: World3,
    /// Angular velocity (1/s).
    spin: World3,
}

impl RigidMotion {
    /// That with the momentum and the angular momentum of some vertices.
    fn of(part: &[u32], m: &[f64], x: &[World3], v: &[World3]) -> RigidMotion {
        let vertices = || part.iter().map(|&i| i as usize);
        let mass: f64 = vertices().map(|i| m[i]).sum();
        let centre = vertices().map(|i| x[i] * m[i]).sum::<World3>() / mass;
        let velocity = vertices().map(|i| v[i] * m[i]).sum::<World3>() / mass;
        let (mut inertia, mut momentum) = (Matrix3::zeros(), World3::zeros());
        for i in vertices() {
            let arm = x[i] - centre;
            let square = Matrix3::identity() * arm.norm_squared();
            inertia += (square - arm * arm.transpose()) * m[i];
            momentum += arm.cross(&(v[i] - velocity)) * m[i];
        }
        let SymmetricEigen { eigenvalues, eigenvectors } = inertia.symmetric_eigen();
        let least = SLENDER * eigenvalues.max();
        let mut spin = World3::zeros();
        for k in (0..3).filter(|&k| eigenvalues[k] > least) {
            let axis = eigenvectors.column(k);
            spin += axis * (axis.dot(&momentum) / eigenvalues[k]);
        }
        RigidMotion { centre, velocity, spin }
    }

    /// Velocity at a place (m/s).
    fn at(&self, x: &World3) -> World3 {
        self.velocity + self.spin.cross(&(x - self.centre))
    }

    /// Kinetic energy of all other motion (J).
    fn other(&self, part: &[u32], m: &[f64], x: &[World3], v: &[World3]) -> f64 {
        let of = |&i: &u32| {
            let i = i as usize;
            0.5 * m[i] * (v[i] - self.at(&x[i])).norm_squared()
        };
        part.iter().map(of).sum()
    }
}

#[cfg(test)]
mod tests;
