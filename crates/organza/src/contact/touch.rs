//! A contact with its energy: a gap that is linear in the positions, and the penalty that keeps it
//! open.

use super::pair::{ClosestPoints, Sides};
use cloth_dynamics::contact::penalty;
use cloth_dynamics::solver::BlockMatrix;
use mesh_core::World3;

/// One contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    pub(super) sides: Sides,
    weights: [f64; 4],
    normal: World3,
    /// Part of the gap that the obstacle's side has (m).
    offset: f64,
    /// Gap below which there is a force (m).
    thickness: f64,
    /// Of the penalty (N/m).
    stiffness: f64,
}

/// Share of the thickness that an approach may come to within its thickness before it is seen.
const LANDING: f64 = 0.9;
/// The most steps of an approach.
const MAX_STEPS: usize = 12;

impl Touch {
    /// Of a pair with these closest points; `x` are its corners at the end of the stage, of which only
    /// the obstacle's matter.
    pub(super) fn new(
        sides: Sides,
        closest: &ClosestPoints,
        x: &[World3; 4],
        thickness: f64,
        stiffness: f64,
    ) -> Touch {
        let (normal, weights) = (closest.offset / closest.distance, closest.weights);
        let obstacle = (0..4).filter(|&k| !sides.is_cloth[k]);
        let offset = obstacle.map(|k| normal.dot(&x[k]) * weights[k]).sum();
        Touch { sides, weights, normal, offset, thickness, stiffness }
    }

    /// The gap at positions of the cloth at the end of the stage (m).
    pub(super) fn gap(&self, x: &[World3]) -> f64 {
        let cloth = (0..4).filter(|&k| self.sides.is_cloth[k]);
        let of = |k: usize| self.normal.dot(&x[self.sides.vertices[k] as usize]) * self.weights[k];
        cloth.map(of).sum::<f64>() + self.offset
    }

    pub(super) fn energy(&self, x: &[World3]) -> f64 {
        self.stiffness * penalty(self.gap(x), self.thickness)[0]
    }

    /// The gradient by the gap, along the normal (N), with the curvature of the penalty; none if they do not
    /// repel each other.
    fn force(&self, x: &[World3]) -> Option<(World3, f64)> {
        let [_, slope, curvature] = penalty(self.gap(x), self.thickness);
        (slope < 0.0).then(|| (self.normal * (slope * self.stiffness), curvature))
    }

    pub(super) fn add_gradient(&self, x: &[World3], gradient: &mut [World3]) {
        if let Some((force, _)) = self.force(x) {
            self.sides.add_gradient(&self.weights, &force, gradient);
        }
    }

    pub(super) fn add_stiffness(&self, x: &[World3], to: &mut BlockMatrix) {
        if let Some((_, curvature)) = self.force(x) {
            let along = self.normal * self.normal.transpose() * (curvature * self.stiffness);
            self.sides.add_stiffness(&self.weights, &along, to);
        }
    }

    /// Lists what the contact adds to the gradient of each vertex (N).
    pub(super) fn collect_gradient(&self, x: &[World3], to: &mut Vec<(u32, World3)>) {
        if let Some((force, _)) = self.force(x) {
            let cloth = (0..4).filter(|&k| self.sides.is_cloth[k]);
            to.extend(cloth.map(|k| (self.sides.vertices[k], force * self.weights[k])));
        }
    }
}

/// Where a pair comes nearer than its thickness on the straight way from `x_t0` to `x_t1`; `None` if it
/// does not. Advances by what the motion allows, so that nothing is passed over but grazing.
pub(super) fn approach(
    sides: &Sides,
    [x_t0, x_t1]: [&[World3; 4]; 2],
    start: ClosestPoints,
    thickness: f64,
) -> Option<ClosestPoints> {
    let motion = sides.relative_motion(x_t0, x_t1);
    if motion == 0.0 && start.distance >= thickness {
        return None;
    }
    let (mut t, mut closest) = (0.0, start);
    for _ in 0..MAX_STEPS {
        if closest.distance < thickness {
            break;
        }
        t += (closest.distance - LANDING * thickness) / motion;
        if t >= 1.0 {
            return None;
        }
        closest = sides.closest(&std::array::from_fn(|k| x_t0[k] + (x_t1[k] - x_t0[k]) * t));
    }
    (closest.distance > 0.0 && closest.distance < thickness).then_some(closest)
}
