//! Strain limits, the last mile: the few triangles that an unconverged step leaves out of bounds are
//! brought back one by one.
//!
//! Newton's method ends when hardly anything moves any more, or by order; a handful of triangles in
//! a thousand may then still be strained beyond their limits. Each is given the nearest admissible
//! deformation gradient, its singular values clamped, with its centre of mass where it was. Sweeps
//! over the triangles around what moved follow until all are in bounds (Gauss–Seidel, as the edges of
//! Provot1995). Momentum is kept to rounding, and the cost is that of the triangles out of bounds.

use crate::fabric::{Fabric, StrainLimits};
use crate::part::Part;
use crate::rest::RestTriangle;
use crate::strain_limit::{Limited, is_free, orthonormal, principal_stretches};
use mesh_core::{World3, par};
use nalgebra::Matrix2;
use std::sync::Arc;

#[cfg(test)]
mod tests;

/// Excess that is not worth a correction (1).
const TOLERANCE: f64 = 1e-4;
/// The most sweeps; what is out of bounds after them, the report shows.
const MAX_SWEEPS: usize = 40;

/// Which triangles each vertex belongs to, as places in one list.
#[derive(Debug)]
struct Incidence {
    starts: Vec<u32>,
    elements: Vec<u32>,
}

impl Incidence {
    /// For stencils over so many vertices.
    fn new(stencils: &[[u32; 3]], n_vertices: usize) -> Self {
        let mut starts = vec![0u32; n_vertices + 1];
        for i in stencils.iter().flatten() {
            starts[*i as usize + 1] += 1;
        }
        for i in 0..n_vertices {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut elements = vec![0; 3 * stencils.len()];
        for (e, i) in stencils.iter().enumerate().flat_map(|(e, s)| s.iter().map(move |i| (e, i))) {
            elements[next[*i as usize] as usize] = e as u32;
            next[*i as usize] += 1;
        }
        Incidence { starts, elements }
    }

    fn around(&self, i: u32) -> &[u32] {
        &self.elements[self.starts[i as usize] as usize..self.starts[i as usize + 1] as usize]
    }
}

/// The projection of all triangles that have limits.
#[derive(Debug)]
pub(crate) struct StrainProjection {
    limited: Limited,
    /// Made when it is first needed.
    incidence: Option<Incidence>,
}

impl StrainProjection {
    /// Limits over the given triangles; `None` if no fabric has any.
    pub(crate) fn new(
        triangles: &[[u32; 3]],
        rest: Arc<Vec<RestTriangle>>,
        fabrics: Arc<Vec<Fabric>>,
    ) -> Option<Self> {
        let limited = Limited::new(triangles, rest, fabrics)?;
        Some(StrainProjection { limited, incidence: None })
    }

    /// The projection of the triangles in a part of the cloth; `None` if none of them has limits.
    pub(crate) fn part(&self, part: &Part) -> Option<Self> {
        let (elements, stencils) = part.elements(&self.limited.stencils);
        let limited = self.limited.part(&elements, stencils);
        (!elements.is_empty()).then_some(StrainProjection { limited, incidence: None })
    }

    /// Brings triangles that are out of bounds back, by moving their vertices; `mass` is infinite
    /// where a vertex is held (kg). `None` if all are in bounds as they are; true if all are now; false
    /// if the sweeps have run out. Triangles with three held vertices do not count, since nothing can
    /// be done about them.
    pub(crate) fn project(&mut self, x: &mut [World3], mass: &dyn Fn(u32) -> f64) -> Option<bool> {
        let mut todo = self.out_of_bounds(x);
        if todo.is_empty() {
            return None;
        }
        let incidence = self
            .incidence
            .take()
            .unwrap_or_else(|| Incidence::new(&self.limited.stencils, x.len()));
        let mut moved = Vec::new();
        for _ in 0..MAX_SWEEPS {
            moved.clear();
            for &e in &todo {
                if self.project_one(e as usize, x, mass) {
                    moved.extend(self.limited.stencils[e as usize]);
                }
            }
            if moved.is_empty() {
                break;
            }
            todo.clear();
            todo.extend(moved.iter().flat_map(|&i| incidence.around(i)));
            todo.sort_unstable();
            todo.dedup();
        }
        self.incidence = Some(incidence);
        Some(moved.is_empty())
    }

    /// Elements whose stretches are out of bounds.
    fn out_of_bounds(&self, x: &[World3]) -> Vec<u32> {
        let mut marks = vec![false; self.limited.stencils.len()];
        par::fill(&mut marks, |e| {
            let (rest, limits) = self.limited.element(e);
            let f = rest.deformation_gradient(&self.limited.stencils[e].map(|i| x[i as usize]));
            !is_free(limits, &f) && is_out(limits, principal_stretches(&f).0)
        });
        (0..).zip(marks).filter(|(_, is_marked)| *is_marked).map(|(e, _)| e).collect()
    }

    /// Brings one triangle back; false if it was in bounds, or cannot move.
    fn project_one(&self, e: usize, x: &mut [World3], mass: &dyn Fn(u32) -> f64) -> bool {
        let (rest, limits) = self.limited.element(e);
        let corners = self.limited.stencils[e];
        let m = corners.map(mass);
        let is_held = m.map(f64::is_infinite);
        if is_held == [true; 3] {
            return false;
        }
        let at = corners.map(|i| x[i as usize]);
        let f = rest.deformation_gradient(&at);
        if is_free(limits, &f) {
            return false;
        }
        let (sigma, v) = principal_stretches(&f);
        if !is_out(limits, sigma) {
            return false;
        }
        let [u1, u2, _] = orthonormal(&(f * v), sigma);
        let [s1, s2] = sigma.map(|s| s.clamp(limits.min, limits.max));
        let goal = u1 * v.column(0).transpose() * s1 + u2 * v.column(1).transpose() * s2;
        // The goal maps the material edges, which are the inverse of (b₁, b₂).
        let b = Matrix2::from_rows(&[rest.b[1].transpose(), rest.b[2].transpose()]);
        let Some(material) = b.try_inverse() else { return false };
        let edges = goal * material;
        let shape = [World3::zeros(), edges.column(0).into(), edges.column(1).into()];
        // What is held stays, and the others take their places about it.
        let weights =
            if is_held.contains(&true) { is_held.map(|h| f64::from(u8::from(h))) } else { m };
        let centre = |p: &[World3; 3]| -> World3 {
            (0..3).map(|k| p[k] * weights[k]).sum::<World3>() / weights.iter().sum::<f64>()
        };
        let shift = centre(&at) - centre(&shape);
        for k in (0..3).filter(|&k| !is_held[k]) {
            x[corners[k] as usize] = shape[k] + shift;
        }
        true
    }
}

/// Whether a stretch is out of bounds by more than the tolerance.
fn is_out(limits: &StrainLimits, [high, low]: [f64; 2]) -> bool {
    high > limits.max + TOLERANCE || low < limits.min - TOLERANCE
}
