//! The shape operator as a force: what [`ShapeOperatorModel`] says of one triangle, for all of them,
//! with the angle of an edge worked out once for both its triangles, and with a lean stiffness where
//! bending is weak.
//!
//! The full stiffness of a triangle couples six vertices, so every vertex with the two rings around
//! it: twice the blocks that the membrane needs, and three to seven times the work of a factorisation.
//! Where the stage is not too long for the bending, r = K h²/(m height²), inertia and tension carry
//! the matrix, and the coupling may be rounded up to one that stays within the triangles (a
//! majoriser, so that every step remains a descent):
//!
//!   Σ_kl G_kl ∇θ_k ∇θ_lᵀ  ⪯  Σ_k K_k ∇θ_k ∇θ_kᵀ,             K_k = Σ_l |G_kl|       (Gershgorin)
//!   ∇θ ∇θᵀ  ⪯  ∇θ ∇θᵀ + w wᵀ,     w = (0, 0, ∇_c θ, −∇_d θ)
//!
//! and the last sum has no block between the two apexes c and d. Energy and forces are exact always;
//! stiff triangles keep the full stiffness.

use crate::dihedral;
use crate::element::{ElementModel, ElementSystem, Stiffness, batch, chosen};
use crate::force::{Force, Stage};
use crate::law::Law;
use crate::part::Part;
use crate::shape_operator::{ShapeOperatorModel, hinge};
use crate::solver::{
    ABSENT, BlockMatrix, BlockPattern, PatternBuilder, PatternError, StencilSlots,
};
use mesh_core::{World3, geometry, par};
use nalgebra::{Matrix3, Vector3};

/// Above this multiple r of the inertia bending keeps its full stiffness. With the lean one, sheets that
/// hang take up to twice the Newton iterations, each for a quarter of the time; strips that buckle, where
/// nothing but bending carries, would take many times as many.
const LEAN_BELOW: f64 = 10.0;

/// Bending of all triangles of a [`ShapeOperatorModel`].
#[derive(Debug)]
pub(crate) struct ShapeOperatorForce {
    model: ShapeOperatorModel,
    /// Inner edges: ends, then apexes.
    hinges: Vec<[u32; 4]>,
    /// Hinges at the three edges of every triangle of the model, [`ABSENT`] at a free edge.
    hinges_of: Vec<[u32; 3]>,
    /// The places 3 e + k of a hinge in `hinges_of`.
    sides: Vec<[u32; 2]>,
    /// Triangles of the model that are stiff, with their stencils.
    stiff: Vec<u32>,
    stiff_stencils: Vec<[u32; 6]>,
    is_stiff: Vec<bool>,
    stiff_slots: Option<StencilSlots<6>>,
    hinge_slots: Option<StencilSlots<4>>,
}

/// What a triangle hands to its edges.
#[derive(Clone, Copy, Debug, Default)]
struct Share {
    /// Moment ∂(energy)/∂θ of each edge (J).
    moment: [f64; 3],
    /// Lean stiffness of each edge (J).
    stiffness: [f64; 3],
}

impl ShapeOperatorForce {
    /// The force for implicit stages of about `h` (s); `mass` is that of the vertices (kg).
    pub(crate) fn new(model: ShapeOperatorModel, mass: &[f64], h: f64) -> Self {
        let mut force = ShapeOperatorForce::unsorted(model);
        let is_stiff = (0..force.hinges_of.len()).map(|e| !force.is_weak(e, mass, h)).collect();
        force.set_stiff(is_stiff);
        force
    }

    /// Without a list of what is stiff.
    fn unsorted(model: ShapeOperatorModel) -> Self {
        let n = model.stencils().len();
        let mut force = ShapeOperatorForce {
            hinges: Vec::with_capacity(3 * n / 2),
            hinges_of: vec![[ABSENT; 3]; n],
            sides: Vec::with_capacity(3 * n / 2),
            stiff: Vec::new(),
            stiff_stencils: Vec::new(),
            is_stiff: vec![false; n],
            stiff_slots: None,
            hinge_slots: None,
            model,
        };
        force.find_hinges();
        force
    }

    /// Gives every inner edge one hinge, in the order of the triangles that come first.
    fn find_hinges(&mut self) {
        // Edges by (smaller end, larger end); both sides of an edge meet here after sorting.
        let mut ends: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * self.hinges_of.len());
        for (e, stencil) in self.model.stencils().iter().enumerate() {
            for k in (0..3).filter(|k| stencil[3 + k] != ABSENT) {
                let [a, b, ..] = hinge(k).map(|i| stencil[i]);
                ends.push((a.min(b), a.max(b), (3 * e + k) as u32));
            }
        }
        ends.sort_unstable();
        let same = |a: &(u32, u32, u32), b: &(u32, u32, u32)| (a.0, a.1) == (b.0, b.1);
        let mut both: Vec<[u32; 2]> = ends
            .chunk_by(same)
            .flat_map(|side| side.chunks(2))
            .map(|pair| [pair[0].2, pair.get(1).map_or(ABSENT, |p| p.2)])
            .collect();
        both.sort_unstable();
        for [first, second] in both {
            let index = self.hinges.len() as u32;
            let (e, k) = (first as usize / 3, first as usize % 3);
            self.hinges.push(hinge(k).map(|i| self.model.stencils()[e][i]));
            self.sides.push([first, second]);
            for side in [first, second].into_iter().filter(|&side| side != ABSENT) {
                self.hinges_of[side as usize / 3][side as usize % 3] = index;
            }
        }
    }

    /// Whether the bending of a triangle is weak against inertia in a stage of `h`.
    fn is_weak(&self, e: usize, mass: &[f64], h: f64) -> bool {
        let lean = self.model.lean_stiffness(e, &self.model.law(e).at_rest());
        let stencil = &self.model.stencils()[e];
        (0..3).all(|k| {
            let heights = self.model.heights(e, k);
            let apexes = [stencil[(k + 2) % 3], stencil[3 + k]];
            apexes.into_iter().zip(heights).filter(|(v, _)| *v != ABSENT).all(|(v, height)| {
                lean[k] * h * h <= LEAN_BELOW * mass[v as usize] * height * height
            })
        })
    }

    /// Lists the triangles that are stiff.
    fn set_stiff(&mut self, is_stiff: Vec<bool>) {
        self.stiff = (0..).zip(&is_stiff).filter(|(_, stiff)| **stiff).map(|(e, _)| e).collect();
        self.stiff_stencils = chosen(self.model.stencils(), &self.stiff);
        self.is_stiff = is_stiff;
    }

    fn angles(&self, x: &[World3]) -> Vec<f64> {
        let mut angles = vec![0.0; self.hinges.len()];
        par::fill(&mut angles, |i| {
            let [a, b, c, d] = self.hinges[i].map(|v| x[v as usize]);
            geometry::dihedral_angle(a, b, c, d)
        });
        angles
    }

    fn curvature(&self, e: usize, angles: &[f64]) -> Vector3<f64> {
        let angle = |i: u32| if i == ABSENT { 0.0 } else { angles[i as usize] };
        let [a, b, c] = self.hinges_of[e].map(angle);
        self.model.curvature_of(e, &Vector3::new(a, b, c))
    }

    /// Moments of all triangles, with their lean stiffness if it is asked for.
    fn shares(&self, x: &[World3], stiffness: bool) -> Vec<Share> {
        let angles = self.angles(x);
        let mut shares = vec![Share::default(); self.hinges_of.len()];
        par::fill(&mut shares, |e| {
            let response = self.model.response(e, &self.curvature(e, &angles));
            let moment = self.model.moments(e, &response.stress).into();
            let stiffness = if stiffness && !self.is_stiff[e] {
                self.model.lean_stiffness(e, &self.model.projected(e, &response.tangent))
            } else {
                [0.0; 3]
            };
            Share { moment, stiffness }
        });
        shares
    }

    /// Moment and lean stiffness of a hinge.
    fn gather(&self, i: usize, shares: &[Share]) -> (f64, f64) {
        let present = self.sides[i].into_iter().filter(|&side| side != ABSENT);
        present.fold((0.0, 0.0), |(moment, stiffness), side| {
            let (share, k) = (&shares[side as usize / 3], side as usize % 3);
            (moment + share.moment[k], stiffness + share.stiffness[k])
        })
    }

    fn corners(&self, i: usize, x: &[World3]) -> [World3; 4] {
        self.hinges[i].map(|v| x[v as usize])
    }

    fn scatter(&self, i: usize, from: &[World3; 4], to: &mut [World3]) {
        for (&v, g) in self.hinges[i].iter().zip(from) {
            to[v as usize] += g;
        }
    }

    fn add_stiff(&self, x: &[World3], kind: Stiffness, to: &mut BlockMatrix) {
        let slots = self.stiff_slots.as_ref().expect("bind() comes before add_system()");
        let size = batch();
        let mut batch = vec![ElementSystem::<6>::zero(); self.stiff.len().min(size)];
        for first in (0..self.stiff.len()).step_by(size) {
            let count = (self.stiff.len() - first).min(size);
            par::for_each(&mut batch[..count], |k, out| {
                let corners = self.stiff_stencils[first + k]
                    .map(|v| if v == ABSENT { World3::zeros() } else { x[v as usize] });
                let e = self.stiff[first + k] as usize;
                self.model.system(e, &corners, kind, out);
            });
            for (k, system) in batch[..count].iter().enumerate() {
                slots.scatter(first + k, &system.stiffness, to);
            }
        }
    }
}

/// The stiffness K (∇θ ∇θᵀ + w wᵀ), whose block between the apexes is zero.
fn lean_blocks(gradient: &[World3; 4], stiffness: f64) -> [[Matrix3<f64>; 4]; 4] {
    let mut blocks = [[Matrix3::zeros(); 4]; 4];
    for i in 0..4 {
        let scaled = gradient[i] * stiffness;
        for j in 0..=i {
            if (i, j) != (3, 2) {
                blocks[i][j] = scaled * gradient[j].transpose();
            }
        }
    }
    blocks[2][2] *= 2.0;
    blocks[3][3] *= 2.0;
    blocks
}

impl Force for ShapeOperatorForce {
    fn name(&self) -> &'static str {
        self.model.name()
    }

    fn couple(&self, pattern: &mut PatternBuilder) -> Result<(), PatternError> {
        let triangles: Vec<[u32; 3]> =
            self.model.stencils().iter().map(|s| [s[0], s[1], s[2]]).collect();
        pattern.add(&triangles)?;
        pattern.add(&self.stiff_stencils)
    }

    fn bind(&mut self, pattern: &BlockPattern) {
        self.stiff_slots = StencilSlots::new(pattern, &self.stiff_stencils);
        self.hinge_slots = Some(StencilSlots::within(pattern, &self.hinges));
    }

    fn begin(&mut self, stage: Stage<'_>) {
        self.model.begin(stage);
    }

    fn predict(&mut self, _: &[World3], _: &[World3]) {}

    fn energy(&self, x: &[World3]) -> f64 {
        let angles = self.angles(x);
        par::sum(self.hinges_of.len(), |e| self.model.energy_of(e, &self.curvature(e, &angles)))
    }

    fn add_gradient(&self, x: &[World3], gradient: &mut [World3]) {
        let shares = self.shares(x, false);
        let mut forces = vec![[World3::zeros(); 4]; self.hinges.len()];
        par::fill(&mut forces, |i| {
            let (moment, _) = self.gather(i, &shares);
            dihedral::gradient(&self.corners(i, x)).map(|g| g * moment)
        });
        for (i, force) in forces.iter().enumerate() {
            self.scatter(i, force, gradient);
        }
    }

    fn add_system(
        &self,
        x: &[World3],
        kind: Stiffness,
        gradient: &mut [World3],
        stiffness: &mut BlockMatrix,
    ) {
        let slots = self.hinge_slots.as_ref().expect("bind() comes before add_system()");
        let shares = self.shares(x, true);
        let n = self.hinges.len();
        let size = batch();
        let mut batch = vec![ElementSystem::<4>::zero(); n.min(size)];
        for first in (0..n).step_by(size) {
            let count = (n - first).min(size);
            par::for_each(&mut batch[..count], |k, out| {
                let (moment, lean) = self.gather(first + k, &shares);
                let angle = dihedral::gradient(&self.corners(first + k, x));
                out.active = lean > 0.0;
                out.gradient = angle.map(|g| g * moment);
                if out.active {
                    out.stiffness = lean_blocks(&angle, lean);
                }
            });
            for (k, system) in batch[..count].iter().enumerate() {
                self.scatter(first + k, &system.gradient, gradient);
                if system.active {
                    slots.scatter(first + k, &system.stiffness, stiffness);
                }
            }
        }
        if !self.stiff.is_empty() {
            self.add_stiff(x, kind, stiffness);
        }
    }

    fn part(&self, part: &Part) -> Option<Box<dyn Force>> {
        let (elements, stencils) = part.elements(self.model.stencils());
        if elements.is_empty() {
            return None;
        }
        let mut force = ShapeOperatorForce::unsorted(self.model.part(&elements, stencils));
        force.set_stiff(chosen(&self.is_stiff, &elements));
        Some(Box::new(force))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::{BendingModel, Damping, Fabric};
    use crate::law::{Bending, Membrane, Quadratic};
    use crate::rest::RestTriangle;
    use mesh_core::ClothState;
    use mesh_core::generate::{Diagonal, grid};
    use nalgebra::DMatrix;
    use std::sync::Arc;

    /// A crumpled sheet of 5 × 4 cells, and the bending of a fabric with Poisson coupling on it.
    fn crumpled() -> (ClothState, ShapeOperatorModel, Vec<World3>) {
        let sheet = grid([0.1, 0.08], [5, 4], Diagonal::Alternating).unwrap();
        let cloth = ClothState::at_rest(sheet.mesh, sheet.positions, vec![0.2]).unwrap();
        let fabric = Fabric {
            density: 0.2,
            membrane: Membrane::Orthotropic(Quadratic::isotropic(100.0, 0.2).unwrap()),
            bending: Some(Bending::Orthotropic(
                Quadratic::orthotropic(4e-5, 1e-5, 2e-5, 8e-6).unwrap(),
            )),
            bending_model: BendingModel::ShapeOperator,
            tension_field: false,
            strain_limits: None,
            damping: Damping { mass: 0.0, stiffness: 1e-3 },
        };
        let rest = Arc::new(RestTriangle::all(&cloth));
        let model = ShapeOperatorModel::new(&cloth.mesh, rest, Arc::new(vec![fabric])).unwrap();
        let wave = |k: usize| ((k * 37 % 17) as f64 / 17.0 - 0.5) * 0.02;
        let x = cloth.x.iter().enumerate();
        let x = x.map(|(i, x)| x + World3::new(wave(i), wave(i + 5), wave(i + 9))).collect();
        (cloth, model, x)
    }

    fn system(force: &mut ShapeOperatorForce, x: &[World3]) -> (Vec<World3>, DMatrix<f64>) {
        let n = x.len();
        let mut pattern = PatternBuilder::new(n);
        force.couple(&mut pattern).unwrap();
        let pattern = Arc::new(pattern.build().unwrap());
        force.bind(&pattern);
        let mut matrix = BlockMatrix::new(pattern);
        let mut gradient = vec![World3::zeros(); n];
        force.add_system(x, Stiffness::Projected, &mut gradient, &mut matrix);
        let mut dense = DMatrix::zeros(3 * n, 3 * n);
        for column in 0..n {
            let mut unit = vec![World3::zeros(); n];
            let mut image = vec![World3::zeros(); n];
            for c in 0..3 {
                unit[column] = World3::ith(c, 1.0);
                matrix.multiply(&unit, &mut image);
                for (row, y) in image.iter().enumerate() {
                    dense.fixed_view_mut::<3, 1>(3 * row, 3 * column + c).copy_from(y);
                }
            }
        }
        (gradient, dense)
    }

    #[test]
    fn energy_and_forces_are_those_of_the_triangles() {
        let (cloth, mut model, x) = crumpled();
        let stage = Stage { x_t0: &cloth.x, base: &cloth.x, h: 0.01 };
        model.begin(stage);
        let corners = |e: usize| {
            let stencil = model.stencils()[e];
            stencil.map(|i| if i == ABSENT { World3::zeros() } else { x[i as usize] })
        };
        let n = model.stencils().len();
        let energy: f64 = (0..n).map(|e| model.energy(e, &corners(e))).sum();
        let mut gradient = vec![World3::zeros(); x.len()];
        for e in 0..n {
            let places = model.stencils()[e].into_iter().zip(model.gradient(e, &corners(e)));
            for (i, g) in places.filter(|(i, _)| *i != ABSENT) {
                gradient[i as usize] += g;
            }
        }
        let mut force = ShapeOperatorForce::new(model, &cloth.m, 0.01);
        force.begin(stage);
        assert!((force.energy(&x) - energy).abs() < 1e-12 * energy);
        let mut summed = vec![World3::zeros(); x.len()];
        force.add_gradient(&x, &mut summed);
        let (with_stiffness, _) = system(&mut force, &x);
        let scale = gradient.iter().map(|g| g.norm()).fold(0.0, f64::max);
        for ((a, b), c) in gradient.iter().zip(&summed).zip(&with_stiffness) {
            assert!((a - b).norm() < 1e-12 * scale && (a - c).norm() < 1e-12 * scale);
        }
    }

    /// The lean stiffness is at least the full one in every direction, couples fewer vertices, and
    /// is chosen where steps are short.
    #[test]
    fn lean_stiffness_is_an_upper_bound() {
        let (cloth, model, x) = crumpled();
        let mut lean = ShapeOperatorForce::new(model, &cloth.m, 1e-5);
        let (_, model, _) = crumpled();
        let mut full = ShapeOperatorForce::new(model, &cloth.m, 1.0);
        assert!(lean.stiff.is_empty() && full.stiff.len() == cloth.mesh.n_triangles());
        let stage = Stage { x_t0: &cloth.x, base: &cloth.x, h: 0.01 };
        lean.begin(stage);
        full.begin(stage);
        let (lean, full) = (system(&mut lean, &x).1, system(&mut full, &x).1);
        let zeros = |m: &DMatrix<f64>| m.iter().filter(|v| **v == 0.0).count();
        assert!(zeros(&lean) > zeros(&full));
        let largest = full.symmetric_eigenvalues().max();
        let least = (&lean - &full).symmetric_eigenvalues().min();
        assert!(least > -1e-12 * largest, "{least} against {largest}");
        // Not out of proportion: a bound that is merely huge would do as well.
        assert!(lean.symmetric_eigenvalues().max() < 8.0 * largest);
    }
}
