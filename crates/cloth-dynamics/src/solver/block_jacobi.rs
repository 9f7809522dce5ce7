//! Conjugate gradients preconditioned by the inverse diagonal blocks ("block Jacobi").
//!
//! No set-up worth the name and little memory, but the iterations grow with the stiffness and with
//! the square root of the number of vertices: for small steps and soft cloth.

use nalgebra::{Matrix3, Vector3};

use super::conjugate_gradient::{self, End, Outcome, Preconditioner, Start, Vectors, step};
use super::matrix::BlockMatrix;
use super::sums::CHUNK;
use super::{
    LinearError, LinearReport, LinearSettings, LinearSolver, Method, check, no_convergence,
};

/// Block-Jacobi conjugate gradients, as a solver.
#[derive(Clone, Debug)]
pub struct BlockJacobiCg {
    settings: LinearSettings,
    preconditioner: BlockJacobi,
    vectors: Vectors,
}

impl BlockJacobiCg {
    /// A solver with these settings.
    pub fn new(settings: LinearSettings) -> Self {
        Self { settings, preconditioner: BlockJacobi::default(), vectors: Vectors::default() }
    }

    /// Runs at most `max_iterations` iterations, whatever the settings say, and tells how it ended.
    pub(super) fn attempt(
        &mut self,
        matrix: &BlockMatrix,
        rhs: &[Vector3<f64>],
        x: &mut [Vector3<f64>],
        max_iterations: usize,
    ) -> Result<Outcome, LinearError> {
        self.preconditioner.set(matrix)?;
        Ok(conjugate_gradient::solve(
            matrix,
            rhs,
            x,
            &mut self.preconditioner,
            Start::Given,
            self.settings.tolerance,
            max_iterations,
            &mut self.vectors,
        ))
    }
}

impl LinearSolver for BlockJacobiCg {
    fn solve(
        &mut self,
        matrix: &BlockMatrix,
        rhs: &[Vector3<f64>],
        x: &mut [Vector3<f64>],
    ) -> Result<LinearReport, LinearError> {
        if let Some(report) = check(matrix, rhs, x)? {
            return Ok(report);
        }
        let outcome = self.attempt(matrix, rhs, x, self.settings.max_iterations)?;
        if matches!(outcome.end, End::Converged | End::Rounding) {
            Ok(LinearReport::iterative(Method::BlockJacobiCg, &outcome))
        } else {
            Err(no_convergence(matrix, &outcome, self.settings.tolerance))
        }
    }

    fn reset(&mut self) {}
}

/// The inverses of the diagonal blocks; symmetric, so six numbers each: xx, xy, xz, yy, yz, zz.
#[derive(Clone, Debug, Default)]
struct BlockJacobi {
    inverses: Vec<[f64; 6]>,
}

impl BlockJacobi {
    /// Inverts the diagonal blocks, all of which must be positive definite.
    fn set(&mut self, matrix: &BlockMatrix) -> Result<(), LinearError> {
        self.inverses.clear();
        for vertex in 0..matrix.n_vertices() {
            let block = matrix.diagonal(vertex);
            let inverse = inverse_if_positive(block).ok_or_else(|| {
                if block.iter().all(|a| a.is_finite()) {
                    LinearError::NotPositiveDefinite { vertex, shift: 0.0 }
                } else {
                    LinearError::NotFinite { what: "the matrix", vertex }
                }
            })?;
            self.inverses.push(inverse);
        }
        Ok(())
    }

    /// One chunk of `z = M⁻¹ r`; returns its part of `rᵀ z`.
    fn chunk(inverses: &[[f64; 6]], r: &[Vector3<f64>], z: &mut [Vector3<f64>]) -> f64 {
        let mut partial = Vector3::zeros();
        for ((m, r), z) in inverses.iter().zip(r).zip(z) {
            let [xx, xy, xz, yy, yz, zz] = *m;
            *z = Vector3::new(
                xx * r.x + xy * r.y + xz * r.z,
                xy * r.x + yy * r.y + yz * r.z,
                xz * r.x + yz * r.y + zz * r.z,
            );
            partial += r.component_mul(z);
        }
        partial.sum()
    }
}

impl Preconditioner for BlockJacobi {
    fn apply(&mut self, r: &[Vector3<f64>], z: &mut [Vector3<f64>]) -> f64 {
        let chunks = self.inverses.chunks(CHUNK).zip(r.chunks(CHUNK)).zip(z.chunks_mut(CHUNK));
        chunks.map(|((m, r), z)| Self::chunk(m, r, z)).sum()
    }

    // The same as the default, with each chunk of r still in the cache when it is wanted again.
    fn advance(
        &mut self,
        alpha: f64,
        _target: f64,
        vectors: &mut Vectors,
        x: &mut [Vector3<f64>],
    ) -> (f64, f64) {
        let Vectors { r, z, p, q } = vectors;
        let (mut rr, mut rz) = (0.0, 0.0);
        for first in (0..x.len()).step_by(CHUNK) {
            let chunk = first..(first + CHUNK).min(x.len());
            let r = &mut r[chunk.clone()];
            rr += step(alpha, &p[chunk.clone()], &q[chunk.clone()], &mut x[chunk.clone()], r);
            rz += Self::chunk(&self.inverses[chunk.clone()], r, &mut z[chunk]);
        }
        (rr, rz)
    }
}

/// The inverse of a symmetric block (its lower triangle is read), or `None` where it is not positive
/// definite.
fn inverse_if_positive(block: &Matrix3<f64>) -> Option<[f64; 6]> {
    let inverse = block.cholesky()?.inverse();
    let m = &inverse;
    let six = [m[(0, 0)], m[(1, 0)], m[(2, 0)], m[(1, 1)], m[(2, 1)], m[(2, 2)]];
    six.iter().all(|a| a.is_finite()).then_some(six)
}
