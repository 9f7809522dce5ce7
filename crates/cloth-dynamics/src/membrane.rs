//! Stretching and shearing of the triangles: any [`Law`] of the Green strain, with Kelvin–Voigt
//! damping.
//!
//! With F = Σ xᵢ bᵢᵀ and E = ½ (FᵀF − I) the energy is A ψ(E), the force on corner i is −A F S bᵢ,
//! and the stiffness between corners i and j is A (ZᵢᵀD Zⱼ + (bᵢ·S bⱼ) I), where S = ∂ψ/∂E,
//! D = ∂²ψ/∂E² and Zᵢ = ∂E/∂xᵢ.
//!
//! The projected stiffness clamps D and S to their positive parts, and takes S not from the iterate
//! but from the linear prediction E + Z Δx of the last Newton step (from the start of the stage in
//! the first). When stiff cloth turns by θ in one iteration, the iterate is stretched by θ²/2 for the
//! moment; S there is many times the true tension, resists any further turn, and Newton's method
//! creeps. The predicted stress is what a solver with multipliers would use, and both agree at the
//! solution.

use crate::element::{ElementModel, ElementSystem, Stiffness, chosen};
use crate::fabric::Fabric;
use crate::force::Stage;
use crate::law::{Law, Membrane, Response, TensionField, project3};
use crate::rest::RestTriangle;
use mesh_core::{World3, par};
use nalgebra::{Matrix2, Matrix3, Matrix3x2, Vector3};
use std::sync::Arc;

/// The membrane energy of all triangles.
#[derive(Debug)]
pub struct MembraneModel {
    stencils: Vec<[u32; 3]>,
    rest: Arc<Vec<RestTriangle>>,
    fabrics: Arc<Vec<Fabric>>,
    /// Strain at the start of the step, kept only if some fabric is damped.
    strain_t0: Vec<Vector3<f64>>,
    /// Stress (s₁₁, s₂₂, s₁₂) for the geometric part of the projected stiffness (N/m).
    tension: Vec<Vector3<f64>>,
    damped: bool,
    /// What wrinkles take from each fabric; empty if from none.
    fields: Arc<Vec<Option<TensionField>>>,
    /// Loads at which triangles buckle (N/m), as `fields`.
    loads: Vec<Vector3<f64>>,
    h: f64,
}

impl MembraneModel {
    /// Membranes over the given triangles.
    pub fn new(
        triangles: &[[u32; 3]],
        rest: Arc<Vec<RestTriangle>>,
        fabrics: Arc<Vec<Fabric>>,
    ) -> Self {
        let damped = fabrics.iter().any(|f| f.damping.stiffness > 0.0);
        let strain_t0 = if damped { vec![Vector3::zeros(); rest.len()] } else { Vec::new() };
        let tension = vec![Vector3::zeros(); rest.len()];
        let stencils = triangles.to_vec();
        let fields = Arc::new(tension_fields(&fabrics));
        let loads = loads(&rest, &fields);
        MembraneModel { stencils, rest, fabrics, strain_t0, tension, damped, fields, loads, h: 1.0 }
    }

    fn fabric(&self, e: usize) -> &Fabric {
        &self.fabrics[self.rest[e].panel as usize]
    }

    /// Damping as a tangent (N/m): η/h times the law's tangent at rest.
    fn viscosity(&self, e: usize) -> Option<Matrix3<f64>> {
        let fabric = self.fabric(e);
        let eta = fabric.damping.stiffness;
        (self.damped && eta > 0.0).then(|| fabric.membrane.at_rest() * (eta / self.h))
    }

    /// What wrinkles within a triangle change.
    fn wrinkled(&self, e: usize, strain: &Vector3<f64>) -> Option<Response> {
        let load = self.loads.get(e)?;
        self.fields[self.rest[e].panel as usize].as_ref()?.change(strain, load)
    }

    fn stress(&self, e: usize, strain: &Vector3<f64>) -> Vector3<f64> {
        let mut stress = self.fabric(e).membrane.stress(strain);
        if let Some(change) = self.wrinkled(e, strain) {
            stress += change.stress;
        }
        match self.viscosity(e) {
            Some(viscosity) => stress + viscosity * (strain - self.strain_t0[e]),
            None => stress,
        }
    }

    fn response(&self, e: usize, strain: &Vector3<f64>) -> Response {
        let mut response = self.fabric(e).membrane.response(strain);
        if let Some(change) = self.wrinkled(e, strain) {
            response.stress += change.stress;
            response.tangent += change.tangent;
        }
        if let Some(viscosity) = self.viscosity(e) {
            response.stress += viscosity * (strain - self.strain_t0[e]);
            response.tangent += viscosity;
        }
        response
    }
}

/// What wrinkles take from each fabric; empty if from none. Measured fabrics lose what their law at rest
/// would: under compression it is that, nearly.
fn tension_fields(fabrics: &[Fabric]) -> Vec<Option<TensionField>> {
    if !fabrics.iter().any(|f| f.tension_field) {
        return Vec::new();
    }
    let field =
        |f: &Fabric| TensionField::new(f.membrane.at_rest(), f.bending.as_ref().map(Law::at_rest));
    fabrics.iter().map(|f| f.tension_field.then(|| field(f)).flatten()).collect()
}

/// Loads at which triangles buckle (N/m); empty if nothing may.
fn loads(rest: &[RestTriangle], fields: &[Option<TensionField>]) -> Vec<Vector3<f64>> {
    if fields.is_empty() {
        return Vec::new();
    }
    let load = |rest: &RestTriangle| match &fields[rest.panel as usize] {
        Some(field) => field.load(rest),
        None => Vector3::zeros(),
    };
    rest.iter().map(load).collect()
}

/// The symmetric 2×2 stress of (s₁₁, s₂₂, s₁₂).
fn tensor(s: &Vector3<f64>) -> Matrix2<f64> {
    Matrix2::new(s.x, s.z, s.z, s.y)
}

/// Positive part of a symmetric 2×2 matrix, in closed form.
pub(crate) fn positive_part(s: &Matrix2<f64>) -> Matrix2<f64> {
    let mean = 0.5 * (s[(0, 0)] + s[(1, 1)]);
    let half = 0.5 * (s[(0, 0)] - s[(1, 1)]);
    let radius = (half * half + s[(0, 1)] * s[(0, 1)]).sqrt();
    let (high, low) = (mean + radius, mean - radius);
    if low >= 0.0 {
        *s
    } else if high <= 0.0 {
        Matrix2::zeros()
    } else {
        // high > 0 > low: s = high P + low (I − P), so P = (s − low I)/(high − low).
        (s - Matrix2::identity() * low) * (high / (high - low))
    }
}

/// The corners' share of P bᵢ with the first Piola–Kirchhoff stress P = F S (N/m).
fn spread(rest: &RestTriangle, piola: &Matrix3x2<f64>) -> [World3; 3] {
    let g1 = piola * rest.b[1] * rest.area;
    let g2 = piola * rest.b[2] * rest.area;
    [-g1 - g2, g1, g2]
}

impl ElementModel<3> for MembraneModel {
    fn name(&self) -> &'static str {
        "membrane"
    }

    fn stencils(&self) -> &[[u32; 3]] {
        &self.stencils
    }

    fn begin(&mut self, stage: Stage<'_>) {
        self.h = stage.h;
        let strain = |rest: &[RestTriangle], stencil: [u32; 3], e: usize| {
            let x = stencil.map(|i| stage.x_t0[i as usize]);
            RestTriangle::green_strain(&rest[e].deformation_gradient(&x))
        };
        if self.damped {
            let (rest, stencils) = (&self.rest, &self.stencils);
            par::fill(&mut self.strain_t0, |e| strain(rest, stencils[e], e));
        }
        // Nothing has moved yet, so damping adds no stress.
        let mut tension = std::mem::take(&mut self.tension);
        par::fill(&mut tension, |e| {
            let strain = strain(&self.rest, self.stencils[e], e);
            self.fabric(e).membrane.stress(&strain)
        });
        self.tension = tension;
    }

    fn predict(&mut self, x: &[World3], step: &[World3]) {
        let mut tension = std::mem::take(&mut self.tension);
        par::fill(&mut tension, |e| {
            let stencil = self.stencils[e];
            let f = self.rest[e].deformation_gradient(&stencil.map(|i| x[i as usize]));
            let df = self.rest[e].deformation_gradient(&stencil.map(|i| step[i as usize]));
            let strain = RestTriangle::green_strain(&f) + RestTriangle::strain_change(&f, &df);
            self.stress(e, &strain)
        });
        self.tension = tension;
    }

    fn energy(&self, e: usize, x: &[World3; 3]) -> f64 {
        let rest = &self.rest[e];
        let strain = RestTriangle::green_strain(&rest.deformation_gradient(x));
        let mut energy = self.fabric(e).membrane.energy(&strain);
        energy += self.wrinkled(e, &strain).map_or(0.0, |change| change.energy);
        if let Some(viscosity) = self.viscosity(e) {
            let change = strain - self.strain_t0[e];
            energy += 0.5 * change.dot(&(viscosity * change));
        }
        energy * rest.area
    }

    fn gradient(&self, e: usize, x: &[World3; 3]) -> [World3; 3] {
        let rest = &self.rest[e];
        let f = rest.deformation_gradient(x);
        let stress = self.stress(e, &RestTriangle::green_strain(&f));
        spread(rest, &(f * tensor(&stress)))
    }

    fn system(&self, e: usize, x: &[World3; 3], kind: Stiffness, out: &mut ElementSystem<3>) {
        let rest = &self.rest[e];
        let f = rest.deformation_gradient(x);
        let Response { stress, tangent, .. } = self.response(e, &RestTriangle::green_strain(&f));
        let stress = tensor(&stress);
        out.active = true;
        out.gradient = spread(rest, &(f * stress));

        let (s, d) = match kind {
            Stiffness::Exact => (stress, tangent),
            Stiffness::Projected => {
                (positive_part(&tensor(&self.tension[e])), self.projected(e, &tangent))
            }
        };
        // Only corners 1 and 2 need work: each row of blocks sums to zero.
        let (f1, f2) = (f.column(0), f.column(1));
        let z = [1, 2].map(|i| {
            let b = rest.b[i];
            Matrix3::from_columns(&[f1 * b.x, f2 * b.y, f1 * b.y + f2 * b.x])
        });
        let block = |i: usize, j: usize| {
            let geometric = rest.b[i + 1].dot(&(s * rest.b[j + 1]));
            (z[i] * d * z[j].transpose() + Matrix3::identity() * geometric) * rest.area
        };
        let (k11, k21, k22) = (block(0, 0), block(1, 0), block(1, 1));
        let (k10, k20) = (-k11 - k21.transpose(), -k21 - k22);
        out.stiffness[1][1] = k11;
        out.stiffness[2][1] = k21;
        out.stiffness[2][2] = k22;
        out.stiffness[1][0] = k10;
        out.stiffness[2][0] = k20;
        out.stiffness[0][0] = -k10 - k20;
    }

    fn part(&self, elements: &[u32], stencils: Vec<[u32; 3]>) -> Self {
        let rest = Arc::new(chosen(&self.rest, elements));
        MembraneModel::new(&stencils, rest, self.fabrics.clone())
    }
}

impl MembraneModel {
    /// A quadratic law is positive definite by construction; others are projected.
    fn projected(&self, e: usize, tangent: &Matrix3<f64>) -> Matrix3<f64> {
        match self.fabric(e).membrane {
            Membrane::Orthotropic(_) => *tangent,
            Membrane::Measured(_) => project3(tangent),
        }
    }
}
