//! Contact with a fixed plane, without friction: the simplest of obstacles.

use crate::contact::{Contact, STIFFNESS, barrier};
use crate::force::Stage;
use crate::solver::BlockMatrix;
use mesh_core::{World3, par};

/// A plane that cloth stays above.
#[derive(Debug)]
pub struct PlaneContact {
    normal: World3,
    /// Height of the plane along the normal (m).
    height: f64,
    thickness: f64,
    /// Mass over h² by vertex (N/m).
    inertia: Vec<f64>,
}

impl PlaneContact {
    /// The plane through `point` (m) with a normal (of any length but zero) towards the cloth, which it
    /// repels from less than `thickness` (m).
    pub fn new(point: World3, normal: World3, thickness: f64) -> Self {
        let normal = normal.normalize();
        PlaneContact { normal, height: normal.dot(&point), thickness, inertia: Vec::new() }
    }

    fn gap(&self, x: &World3) -> f64 {
        self.normal.dot(x) - self.height
    }
}

impl Contact for PlaneContact {
    fn name(&self) -> &'static str {
        "plane"
    }

    fn begin(&mut self, stage: Stage<'_>, _: [f64; 2], mass: &[f64]) {
        self.inertia.clear();
        self.inertia.extend(mass.iter().map(|m| m / (stage.h * stage.h)));
    }

    fn look_ahead(&mut self, x: &[World3], step: &[World3]) -> f64 {
        let share = |(x, step): (&World3, &World3)| {
            let (from, to) = (self.gap(x), self.gap(&(x + step)));
            // The last millionth of the gap covers rounding.
            if to > 1e-6 * from { 1.0 } else { ((1.0 - 1e-6) * from / (from - to)).clamp(0.0, 1.0) }
        };
        x.iter().zip(step).map(share).fold(1.0, f64::min)
    }

    fn carry(&self, _: &[World3], _: &mut [World3]) -> bool {
        false
    }

    fn follow(&mut self, _: f64) {}

    fn has_arrived(&self) -> bool {
        true
    }

    fn energy(&self, x: &[World3]) -> f64 {
        par::sum(x.len(), |i| {
            let [energy, ..] = barrier(self.gap(&x[i]), self.thickness);
            if energy == 0.0 { 0.0 } else { energy * STIFFNESS * self.inertia[i] }
        })
    }

    fn add_system(&self, x: &[World3], gradient: &mut [World3], stiffness: &mut BlockMatrix) {
        for (i, x) in x.iter().enumerate() {
            let [_, slope, curvature] = barrier(self.gap(x), self.thickness);
            if slope < 0.0 {
                let k = STIFFNESS * self.inertia[i];
                gradient[i] += self.normal * (slope * k);
                *stiffness.diagonal_mut(i) +=
                    self.normal * self.normal.transpose() * (curvature * k);
            }
        }
    }
}
