//! Bending by a curvature tensor on every triangle (Grinspun2006).
//!
//! The tensor of triangle T gathers the bends at its three edges,
//!
//!   Λ_T = (1/A) Σ_e l_e φ_e n_e n_eᵀ,   φ_e = θ_e h_e/(h_e + h_e′),
//!
//! with the dihedral angle θ_e shared between the two triangles by their heights over the edge, and
//! the unit normal n_e of the edge in material space. Energy is A ψ(Λ_T). On a hinge-only model the
//! rigidity depends on the pattern of the mesh (see `docs/decisions.md`); here a
//! constant moment is in equilibrium on every mesh, and the rigidity is exact on every lattice.
//! At a free edge φ is whatever carries no moment across it: it is eliminated beforehand.

use crate::dihedral;
use crate::element::{ElementModel, ElementSystem, Stiffness, chosen};
use crate::fabric::{BendingModel, Fabric};
use crate::force::Stage;
use crate::law::{Bending, Law, Response, project3};
use crate::rest::RestTriangle;
use crate::solver::ABSENT;
use mesh_core::{HalfEdge, Mesh, TriangleId, World3, geometry, par};
use nalgebra::{Matrix3, Vector2, Vector3};
use std::sync::Arc;

/// Bending of all triangles whose fabric uses the shape operator. Stencil: the corners, then the
/// vertices opposite their half-edges 0, 1, 2 in the neighbours.
#[derive(Debug)]
pub struct ShapeOperatorModel {
    stencils: Vec<[u32; 6]>,
    triangles: Vec<u32>,
    /// Λ as (κ₁₁, κ₂₂, 2κ₁₂) is this matrix times the three angles (1/m).
    curvature_from_angles: Vec<Matrix3<f64>>,
    /// Heights over the three edges, of the triangle itself and of its neighbour there (m).
    heights: Vec<[[f64; 2]; 3]>,
    rest: Arc<Vec<RestTriangle>>,
    fabrics: Arc<Vec<Fabric>>,
    curvature_t0: Vec<Vector3<f64>>,
    damped: bool,
    h: f64,
}

/// n nᵀ as (n₁², n₂², 2 n₁n₂).
fn dyad(n: Vector2<f64>) -> Vector3<f64> {
    Vector3::new(n.x * n.x, n.y * n.y, 2.0 * n.x * n.y)
}

/// Height of a triangle over one of its half-edges in material space (m).
fn height(mesh: &Mesh, h: HalfEdge) -> f64 {
    2.0 * mesh.area(h.triangle()) / mesh.material_edge(h).norm()
}

impl ShapeOperatorModel {
    /// The elements; `None` if no fabric bends this way.
    pub fn new(
        mesh: &Mesh,
        rest: Arc<Vec<RestTriangle>>,
        fabrics: Arc<Vec<Fabric>>,
    ) -> Option<Self> {
        let bends = |t: &u32| {
            let fabric = &fabrics[rest[*t as usize].panel as usize];
            fabric.bending.is_some() && fabric.bending_model == BendingModel::ShapeOperator
        };
        let triangles: Vec<u32> = (0..rest.len() as u32).filter(bends).collect();
        if triangles.is_empty() {
            return None;
        }
        let damped = fabrics.iter().any(|f| f.damping.stiffness > 0.0);
        let mut model = ShapeOperatorModel {
            stencils: vec![[ABSENT; 6]; triangles.len()],
            curvature_from_angles: vec![Matrix3::zeros(); triangles.len()],
            heights: vec![[[0.0; 2]; 3]; triangles.len()],
            curvature_t0: if damped { vec![Vector3::zeros(); triangles.len()] } else { Vec::new() },
            triangles,
            rest,
            fabrics,
            damped,
            h: 1.0,
        };
        for e in 0..model.triangles.len() {
            let t = TriangleId(model.triangles[e]);
            let law = model.law(e).at_rest();
            model.stencils[e] = stencil(mesh, t);
            model.curvature_from_angles[e] = curvature_from_angles(mesh, t, &law);
            model.heights[e] = [0, 1, 2].map(|k| {
                let h = t.half_edge(k);
                [height(mesh, h), mesh.twin(h).map_or(0.0, |g| height(mesh, g))]
            });
        }
        Some(model)
    }

    fn fabric(&self, e: usize) -> &Fabric {
        &self.fabrics[self.rest[self.triangles[e] as usize].panel as usize]
    }

    pub(crate) fn law(&self, e: usize) -> &Bending {
        self.fabric(e).bending.as_ref().expect("only triangles that bend are listed")
    }

    fn area(&self, e: usize) -> f64 {
        self.rest[self.triangles[e] as usize].area
    }

    fn viscosity(&self, e: usize) -> Option<Matrix3<f64>> {
        let eta = self.fabric(e).damping.stiffness;
        (self.damped && eta > 0.0).then(|| self.law(e).at_rest() * (eta / self.h))
    }

    /// Heights over edge `k` of the two triangles there (m); zero for one that is not there.
    pub(crate) fn heights(&self, e: usize, k: usize) -> [f64; 2] {
        self.heights[e][k]
    }

    pub(crate) fn response(&self, e: usize, curvature: &Vector3<f64>) -> Response {
        let mut response = self.law(e).response(curvature);
        if let Some(viscosity) = self.viscosity(e) {
            response.stress += viscosity * (curvature - self.curvature_t0[e]);
            response.tangent += viscosity;
        }
        response
    }

    fn curvature(&self, e: usize, x: &[World3; 6]) -> Vector3<f64> {
        let angle = |k: usize| {
            let [a, b, c, d] = hinge(k).map(|i| x[i]);
            let absent = self.stencils[e][3 + k] == ABSENT;
            if absent { 0.0 } else { geometry::dihedral_angle(a, b, c, d) }
        };
        self.curvature_of(e, &Vector3::new(angle(0), angle(1), angle(2)))
    }

    /// Curvature (1/m) of triangle `e` whose edges bend by these angles.
    pub(crate) fn curvature_of(&self, e: usize, angles: &Vector3<f64>) -> Vector3<f64> {
        self.curvature_from_angles[e] * angles
    }

    /// Energy (J) of triangle `e` at a curvature.
    pub(crate) fn energy_of(&self, e: usize, curvature: &Vector3<f64>) -> f64 {
        let mut energy = self.law(e).energy(curvature);
        if let Some(viscosity) = self.viscosity(e) {
            let change = curvature - self.curvature_t0[e];
            energy += 0.5 * change.dot(&(viscosity * change));
        }
        energy * self.area(e)
    }

    /// Moments (J) on the three angles: A Cᵀ ψ′.
    pub(crate) fn moments(&self, e: usize, stress: &Vector3<f64>) -> Vector3<f64> {
        self.curvature_from_angles[e].tr_mul(stress) * self.area(e)
    }

    /// Stiffness (J) of the angles: G = A Cᵀ ψ″ C.
    fn angle_stiffness(&self, e: usize, tangent: &Matrix3<f64>) -> Matrix3<f64> {
        let c = &self.curvature_from_angles[e];
        c.tr_mul(&(tangent * c)) * self.area(e)
    }

    /// Row sums of |G|: a diagonal that is at least as stiff (J).
    pub(crate) fn lean_stiffness(&self, e: usize, tangent: &Matrix3<f64>) -> [f64; 3] {
        let g = self.angle_stiffness(e, tangent).abs();
        [0, 1, 2].map(|k| g.row(k).sum())
    }

    /// The tangent made positive semi-definite, if it is not by construction.
    pub(crate) fn projected(&self, e: usize, tangent: &Matrix3<f64>) -> Matrix3<f64> {
        match self.law(e) {
            Bending::Orthotropic(_) => *tangent,
            Bending::Measured(_) => project3(tangent),
        }
    }

    /// Gradients of the three angles, zero where there is no neighbour.
    fn angle_gradients(&self, e: usize, x: &[World3; 6]) -> [[World3; 4]; 3] {
        std::array::from_fn(|k| {
            if self.stencils[e][3 + k] == ABSENT {
                [World3::zeros(); 4]
            } else {
                dihedral::gradient(&hinge(k).map(|i| x[i]))
            }
        })
    }
}

/// Corners (a, b, c, d) of the hinge at half-edge `k`, as places in the stencil.
pub(crate) const fn hinge(k: usize) -> [usize; 4] {
    [k, (k + 1) % 3, (k + 2) % 3, 3 + k]
}

fn stencil(mesh: &Mesh, t: TriangleId) -> [u32; 6] {
    let [a, b, c] = mesh.triangles()[t.index()];
    let across = |k: usize| {
        let twin = mesh.twin(t.half_edge(k));
        twin.map_or(ABSENT, |g| mesh.opposite(g).0)
    };
    [a, b, c, across(0), across(1), across(2)]
}

/// The constant map from angles to curvature, with free edges eliminated for the tangent `law`.
fn curvature_from_angles(mesh: &Mesh, t: TriangleId, law: &Matrix3<f64>) -> Matrix3<f64> {
    let area = mesh.area(t);
    let mut columns = [Vector3::zeros(); 3];
    // Takes the curvature across every free edge out: the part that costs no energy to relax.
    let mut relax = Matrix3::identity();
    for k in 0..3 {
        let h = t.half_edge(k);
        let edge = mesh.material_edge(h);
        let length = edge.norm();
        let normal = dyad(Vector2::new(-edge.y, edge.x) / length);
        match mesh.twin(h) {
            Some(g) => {
                let (own, other) = (height(mesh, h), height(mesh, g));
                columns[k] = normal * (length / area * own / (own + other));
            }
            None => {
                let free = relax * normal;
                let moment = relax.transpose() * (law * free);
                let stiffness = free.dot(&(law * free));
                if stiffness > 1e-12 * law.norm() {
                    relax -= free * moment.transpose() / stiffness;
                }
            }
        }
    }
    relax * Matrix3::from_columns(&columns)
}

impl ElementModel<6> for ShapeOperatorModel {
    fn name(&self) -> &'static str {
        "bending"
    }

    fn stencils(&self) -> &[[u32; 6]] {
        &self.stencils
    }

    fn begin(&mut self, stage: Stage<'_>) {
        self.h = stage.h;
        if self.damped {
            let mut curvature = std::mem::take(&mut self.curvature_t0);
            par::fill(&mut curvature, |e| {
                let x = self.stencils[e]
                    .map(|i| if i == ABSENT { World3::zeros() } else { stage.x_t0[i as usize] });
                self.curvature(e, &x)
            });
            self.curvature_t0 = curvature;
        }
    }

    fn predict(&mut self, _: &[World3], _: &[World3]) {}

    fn energy(&self, e: usize, x: &[World3; 6]) -> f64 {
        self.energy_of(e, &self.curvature(e, x))
    }

    fn gradient(&self, e: usize, x: &[World3; 6]) -> [World3; 6] {
        let response = self.response(e, &self.curvature(e, x));
        let moment = self.moments(e, &response.stress);
        let mut out = [World3::zeros(); 6];
        for (k, gradient) in self.angle_gradients(e, x).iter().enumerate() {
            for (i, g) in hinge(k).into_iter().zip(gradient) {
                out[i] += g * moment[k];
            }
        }
        out
    }

    /// Exact: Σ_kl G_kl ∇θ_k ∇θ_lᵀ + Σ_k m_k ∇²θ_k with the moments m = A Cᵀψ′ and G = A Cᵀψ″C.
    /// Projected: the first sum with ψ″ clamped (Gauss–Newton); it is exact where the cloth is flat.
    fn system(&self, e: usize, x: &[World3; 6], kind: Stiffness, out: &mut ElementSystem<6>) {
        let response = self.response(e, &self.curvature(e, x));
        let tangent = match kind {
            Stiffness::Projected => self.projected(e, &response.tangent),
            Stiffness::Exact => response.tangent,
        };
        let moment = self.moments(e, &response.stress);
        let g = self.angle_stiffness(e, &tangent);
        let gradients = self.angle_gradients(e, x);

        // Each angle's gradient over all six places, and their combinations Σ_l G_kl ∇θ_l.
        let mut rows = [[World3::zeros(); 6]; 3];
        for (k, gradient) in gradients.iter().enumerate() {
            for (i, value) in hinge(k).into_iter().zip(gradient) {
                rows[k][i] = *value;
            }
        }
        let mixed: [[World3; 6]; 3] = std::array::from_fn(|k| {
            std::array::from_fn(|i| {
                rows[0][i] * g[(k, 0)] + rows[1][i] * g[(k, 1)] + rows[2][i] * g[(k, 2)]
            })
        });
        out.active = true;
        for i in 0..6 {
            out.gradient[i] = (0..3).map(|k| rows[k][i] * moment[k]).sum();
            for j in 0..=i {
                out.stiffness[i][j] = mixed[0][i] * rows[0][j].transpose()
                    + mixed[1][i] * rows[1][j].transpose()
                    + mixed[2][i] * rows[2][j].transpose();
            }
        }
        if kind == Stiffness::Exact {
            for k in 0..3 {
                if self.stencils[e][3 + k] == ABSENT {
                    continue;
                }
                let places = hinge(k);
                let second = dihedral::hessian(&places.map(|i| x[i]));
                for (i, row) in places.into_iter().zip(&second) {
                    for (j, block) in places.into_iter().zip(row).filter(|&(j, _)| j <= i) {
                        out.stiffness[i][j] += block * moment[k];
                    }
                }
            }
        }
    }

    fn part(&self, elements: &[u32], stencils: Vec<[u32; 6]>) -> Self {
        ShapeOperatorModel {
            curvature_t0: chosen(&self.curvature_t0, if self.damped { elements } else { &[] }),
            curvature_from_angles: chosen(&self.curvature_from_angles, elements),
            heights: chosen(&self.heights, elements),
            triangles: chosen(&self.triangles, elements),
            stencils,
            rest: self.rest.clone(),
            fabrics: self.fabrics.clone(),
            damped: self.damped,
            h: self.h,
        }
    }
}
