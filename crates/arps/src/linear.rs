//! The linear systems of the convex step, and two ways to solve them.

use crate::blocks::Blocks;
use crate::error::StepError;
use crate::{Matrix3, Vector3};
use nalgebra::{Cholesky, DMatrix, DVector};

/// The system (diag(G⁺)/h + h L) Δ = rhs over the particles that move: symmetric, positive definite,
/// and without the rows and columns of those that rest. G⁺ is the effective mass.
#[derive(Clone, Copy, Debug)]
pub struct MoverSystem<'a, B> {
    /// The particles that move, ascending.
    pub movers: &'a [usize],
    /// Per mover, its effective mass over the step (kg/s).
    pub inertia: &'a [Matrix3],
    /// Stiffness of all particles (N/m).
    pub stiffness: &'a B,
    /// What multiplies the stiffness: the step (s).
    pub h: f64,
    /// Right-hand side per mover (kg m/s).
    pub rhs: &'a [Vector3],
    /// Place among the movers of every particle, or `usize::MAX`.
    pub place: &'a [usize],
}

impl<B: Blocks> MoverSystem<'_, B> {
    /// The block on the diagonal of a mover (kg/s).
    pub fn diagonal(&self, a: usize) -> Matrix3 {
        self.inertia[a] + self.h * self.stiffness.diagonal(self.movers[a])
    }

    /// The matrix times a vector with a block per mover.
    pub fn times(&self, x: &[Vector3], out: &mut [Vector3]) {
        for (a, &i) in self.movers.iter().enumerate() {
            let mut sum = self.diagonal(a) * x[a];
            self.stiffness.visit_row(i, |j, block| {
                if self.place[j] != usize::MAX {
                    sum += self.h * (block * x[self.place[j]]);
                }
            });
            out[a] = sum;
        }
    }

    /// Solves by a dense Cholesky factorisation: exact, for up to some hundred movers.
    ///
    /// # Errors
    /// A matrix that is not positive definite, for which the stiffness was not semidefinite.
    pub fn solve_dense(&self, out: &mut [Vector3]) -> Result<(), StepError> {
        let n = self.movers.len();
        let mut matrix = DMatrix::zeros(3 * n, 3 * n);
        for (a, &i) in self.movers.iter().enumerate() {
            matrix.fixed_view_mut::<3, 3>(3 * a, 3 * a).copy_from(&self.diagonal(a));
            self.stiffness.visit_row(i, |j, block| {
                let b = self.place[j];
                if b < a {
                    matrix.fixed_view_mut::<3, 3>(3 * a, 3 * b).copy_from(&(self.h * block));
                }
            });
        }
        let rhs = DVector::from_iterator(3 * n, self.rhs.iter().flat_map(|r| r.iter().copied()));
        let factor = Cholesky::new(matrix).ok_or(StepError::Singular { unknowns: n })?;
        let solution = factor.solve(&rhs);
        for (a, block) in out.iter_mut().enumerate() {
            *block = solution.fixed_rows::<3>(3 * a).into_owned();
        }
        Ok(())
    }

    /// Solves by conjugate gradients with the diagonal blocks as preconditioner, until the residual
    /// is `tolerance` (1) times the right-hand side: for many movers that are not too stiff.
    ///
    /// # Errors
    /// A diagonal block that is not positive definite, or no convergence in as many iterations as
    /// there are unknowns, times three.
    pub fn solve_cg(&self, tolerance: f64, out: &mut [Vector3]) -> Result<(), StepError> {
        let n = self.movers.len();
        let singular = StepError::Singular { unknowns: n };
        let mut inverse = Vec::with_capacity(n);
        for a in 0..n {
            let factor = Cholesky::new(self.diagonal(a)).ok_or(singular)?;
            inverse.push(factor.inverse());
        }
        let dot =
            |a: &[Vector3], b: &[Vector3]| a.iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>();
        let mut r = self.rhs.to_vec();
        let mut z: Vec<Vector3> = inverse.iter().zip(&r).map(|(m, r)| m * r).collect();
        let mut p = z.clone();
        let mut ap = vec![Vector3::zeros(); n];
        out.fill(Vector3::zeros());
        let enough = tolerance * tolerance * dot(self.rhs, self.rhs);
        let mut rz = dot(&r, &z);
        for _ in 0..=9 * n {
            if dot(&r, &r) <= enough {
                return Ok(());
            }
            self.times(&p, &mut ap);
            let curvature = dot(&p, &ap);
            if curvature.is_nan() || curvature <= 0.0 {
                return Err(singular);
            }
            let alpha = rz / curvature;
            for a in 0..n {
                out[a] += alpha * p[a];
                r[a] -= alpha * ap[a];
                z[a] = inverse[a] * r[a];
            }
            let next = dot(&r, &z);
            let beta = next / rz;
            rz = next;
            for a in 0..n {
                p[a] = z[a] + beta * p[a];
            }
        }
        Err(singular)
    }
}
