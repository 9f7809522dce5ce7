//! Friction: what touches at the start of a stage resists sliding in the plane of its contact there,
//! with at most μ times the normal force there (lagged Coulomb friction, Li2020 §5).

use super::pair::{ClosestPoints, Sides};
use cloth_dynamics::contact::friction;
use cloth_dynamics::solver::BlockMatrix;
use mesh_core::World3;
use nalgebra::Matrix3;

/// One contact with its friction.
pub(super) struct Slip {
    sides: Sides,
    weights: [f64; 4],
    /// Onto the tangent plane.
    tangential: Matrix3<f64>,
    /// Friction coefficient times normal force (N).
    most: f64,
    /// Slip below which the force is less (m).
    y_stick: f64,
    /// Way of the obstacle's side during the stage, less the cloth's side's base (m).
    offset: World3,
    /// The obstacle's side stands still, or there is none.
    stands: bool,
}

impl Slip {
    /// Of a contact whose second side, if an obstacle's, goes the weighted way `way` (m); `None`
    /// where there is no friction.
    pub(super) fn new(
        sides: Sides,
        closest: &ClosestPoints,
        most: f64,
        way: World3,
        y_stick: f64,
    ) -> Option<Slip> {
        let is_some = most > 0.0 && most.is_finite() && closest.distance > 0.0;
        is_some.then(|| {
            let normal = closest.offset / closest.distance;
            let tangential = Matrix3::identity() - normal * normal.transpose();
            Slip {
                sides,
                weights: closest.weights,
                tangential,
                most,
                y_stick,
                offset: way,
                stands: way == World3::zeros(),
            }
        })
    }

    /// Slip is measured from these positions of the cloth (m).
    pub(super) fn set_base(&mut self, base: &[World3]) {
        self.offset -= self.of_cloth(base);
    }

    fn of_cloth(&self, x: &[World3]) -> World3 {
        let cloth = (0..4).filter(|&k| self.sides.is_cloth[k]);
        cloth.map(|k| x[self.sides.vertices[k] as usize] * self.weights[k]).sum()
    }

    fn slip(&self, x: &[World3]) -> World3 {
        self.tangential * (self.of_cloth(x) + self.offset)
    }

    pub(super) fn energy(&self, x: &[World3]) -> f64 {
        self.most * friction(self.slip(x).norm(), self.y_stick)[0]
    }

    pub(super) fn add_gradient(&self, x: &[World3], gradient: &mut [World3]) {
        let slip = self.slip(x);
        let y = slip.norm();
        if y > 0.0 {
            let force = slip / y * (self.most * friction(y, self.y_stick)[1]);
            self.sides.add_gradient(&self.weights, &force, gradient);
        }
    }

    /// Adds what holds vertices that stand (N); where anything of the contact moves, nothing does.
    pub(super) fn add_grip(&self, stands: &[bool], grip: &mut [f64]) {
        let cloth = || (0..4).filter(|&k| self.sides.is_cloth[k]);
        let of = |k: usize| self.sides.vertices[k] as usize;
        if self.stands && cloth().all(|k| stands[of(k)]) {
            cloth().for_each(|k| grip[of(k)] += self.most * self.weights[k].abs());
        }
    }

    pub(super) fn add_stiffness(&self, x: &[World3], to: &mut BlockMatrix) {
        let slip = self.slip(x);
        let y = slip.norm();
        let [_, force, slope] = friction(y, self.y_stick);
        let (across, along, direction) =
            if y > 0.0 { (force / y, slope, slip / y) } else { (slope, slope, World3::zeros()) };
        let stiffness =
            self.tangential * across + direction * direction.transpose() * (along - across);
        self.sides.add_stiffness(&self.weights, &(stiffness * self.most), to);
    }
}
