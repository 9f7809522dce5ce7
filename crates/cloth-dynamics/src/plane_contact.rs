//! Contact with a fixed plane, without friction: the simplest of obstacles.

use crate::contact::{Blocked, Contact, STIFFNESS, penalty};
use crate::force::Stage;
use crate::solver::BlockMatrix;
use mesh_core::{World3, par};

/// Share of its gap, or of the thickness, that a vertex keeps in a step.
const CLEAR: f64 = 0.1;

/// A plane that cloth stays above.
#[derive(Debug)]
pub struct PlaneContact {
    normal: World3,
    /// Height of the plane along the normal (m).
    height: f64,
    thickness: f64,
    /// Mass over h² by vertex (N/m).
    inertia: Vec<f64>,
    /// Gap that each vertex keeps in this stage (m).
    least: Vec<f64>,
}

impl PlaneContact {
    /// The plane through `point` (m) with a normal (of any length but zero) towards the cloth, which it
    /// repels from less than `thickness` (m).
    pub fn new(point: World3, normal: World3, thickness: f64) -> Self {
        let normal = normal.normalize();
        PlaneContact {
            normal,
            height: normal.dot(&point),
            thickness,
            inertia: Vec::new(),
            least: Vec::new(),
        }
    }

    fn gap(&self, x: &World3) -> f64 {
        self.normal.dot(x) - self.height
    }
}

impl Contact for PlaneContact {
    fn name(&self) -> &'static str {
        "plane"
    }

    fn begin(&mut self, stage: Stage<'_>, _: [f64; 2], mass: &[f64], _: &[World3]) {
        self.inertia.clear();
        self.inertia.extend(mass.iter().map(|m| m / (stage.h * stage.h)));
        let least = |x: &World3| CLEAR * self.gap(x).min(self.thickness);
        self.least = stage.x_t0.iter().map(least).collect();
    }

    fn couples(&self) -> Vec<[u32; 2]> {
        Vec::new()
    }

    fn energy(&self, x: &[World3]) -> f64 {
        par::sum(x.len(), |i| {
            let [energy, ..] = penalty(self.gap(&x[i]), self.thickness);
            if energy == 0.0 { 0.0 } else { energy * STIFFNESS * self.inertia[i] }
        })
    }

    fn add_gradient(&self, x: &[World3], gradient: &mut [World3]) {
        for (i, x) in x.iter().enumerate() {
            let [_, slope, _] = penalty(self.gap(x), self.thickness);
            if slope < 0.0 {
                gradient[i] += self.normal * (slope * STIFFNESS * self.inertia[i]);
            }
        }
    }

    fn add_system(&self, x: &[World3], gradient: &mut [World3], stiffness: &mut BlockMatrix) {
        self.add_gradient(x, gradient);
        for (i, x) in x.iter().enumerate() {
            let [_, slope, curvature] = penalty(self.gap(x), self.thickness);
            if slope < 0.0 {
                let k = STIFFNESS * self.inertia[i];
                *stiffness.diagonal_mut(i) +=
                    self.normal * self.normal.transpose() * (curvature * k);
            }
        }
    }

    fn look(&mut self, _: &[World3]) -> bool {
        // Every vertex has its energy from the start.
        false
    }

    fn is_passed(&self, x: &[World3]) -> bool {
        x.iter().any(|x| self.gap(x) <= 0.0)
    }

    fn secure(&mut self, x: &mut [World3], fixed: &[bool]) -> Result<usize, Blocked> {
        let mut n = 0;
        for ((x, least), fixed) in x.iter_mut().zip(&self.least).zip(fixed) {
            let lift = least - (self.normal.dot(x) - self.height);
            if lift > 0.0 && *fixed {
                return Err(Blocked { place: *x });
            }
            if lift > 0.0 {
                *x += self.normal * lift;
                n += 1;
            }
        }
        Ok(n)
    }

    fn n_touches(&self) -> usize {
        self.inertia.len()
    }

    fn is_still(&self, _: [f64; 2]) -> bool {
        true
    }
}
