//! The choice between block-Jacobi conjugate gradients and a factor, by counted cost.

use std::sync::Arc;

use nalgebra::Vector3;

use super::block_jacobi::BlockJacobiCg;
use super::cholesky::StaleFactorCg;
use super::conjugate_gradient::End;
use super::cost;
use super::matrix::BlockMatrix;
use super::pattern::BlockPattern;
use super::{LinearError, LinearReport, LinearSettings, LinearSolver, Method, check};

/// After this many solves with a factor, conjugate gradients get another chance.
const PROBE_EVERY: usize = 32;

/// Picks the cheapest method for each matrix.
///
/// The cost of a factor follows from the pattern. That of conjugate gradients depends on the
/// condition of the matrix, which is not known beforehand; but the last solve tells, since one step
/// resembles the next. Where there is no last solve, or a long time ago, conjugate gradients are
/// tried with a budget: as many iterations as the factor costs. So the price of not knowing is at
/// most the price of the solve.
pub struct Auto {
    jacobi: BlockJacobiCg,
    factor: StaleFactorCg,
    /// What the last attempt of conjugate gradients needed, or would at least have needed.
    jacobi_history: Option<JacobiHistory>,
    solves_since_jacobi: usize,
    pattern: Option<Arc<BlockPattern>>,
    solves_on_pattern: usize,
    /// How many solves the pattern before this one served for.
    life_before: usize,
}

#[derive(Clone, Copy, Debug)]
struct JacobiHistory {
    iterations: f64,
    n_vertices: usize,
}

impl Auto {
    /// A solver with these settings.
    pub fn new(settings: LinearSettings) -> Self {
        Self {
            jacobi: BlockJacobiCg::new(settings),
            factor: StaleFactorCg::new(settings),
            jacobi_history: None,
            solves_since_jacobi: 0,
            pattern: None,
            solves_on_pattern: 0,
            life_before: 1,
        }
    }

    /// Counts the solves on each pattern, which is how often a new factor can be used.
    fn follow(&mut self, pattern: &Arc<BlockPattern>) {
        let same = |old: &Arc<BlockPattern>| Arc::ptr_eq(old, pattern) || **old == **pattern;
        if !self.pattern.as_ref().is_some_and(same) {
            self.life_before = self.solves_on_pattern.max(1);
            self.solves_on_pattern = 0;
        }
        self.pattern = Some(pattern.clone());
        self.solves_on_pattern += 1;
    }

    /// Expected cost of conjugate gradients: for a given stiffness the iterations grow with the
    /// number of vertices along a side.
    fn jacobi_cost(&self, matrix: &BlockMatrix) -> Option<f64> {
        let history = self.jacobi_history?;
        let ratio = matrix.n_vertices() as f64 / history.n_vertices as f64;
        let iterations = history.iterations * ratio.sqrt() + 1.0;
        Some(iterations * cost::jacobi_iteration(matrix.pattern()))
    }
}

impl LinearSolver for Auto {
    fn solve(
        &mut self,
        matrix: &BlockMatrix,
        rhs: &[Vector3<f64>],
        x: &mut [Vector3<f64>],
    ) -> Result<LinearReport, LinearError> {
        if let Some(report) = check(matrix, rhs, x)? {
            return Ok(report);
        }
        let pattern = matrix.pattern();
        self.follow(pattern);
        let life = self.life_before.max(self.solves_on_pattern);
        let factor_cost = self.factor.expected_cost(matrix, life);
        let probe = self.solves_since_jacobi >= PROBE_EVERY;
        let mut abandoned = 0;
        if probe || self.jacobi_cost(matrix).is_none_or(|cost| cost < factor_cost) {
            let settings = self.factor.settings();
            let budget = (factor_cost / cost::jacobi_iteration(pattern)).ceil();
            let budget = (budget as usize).min(settings.max_iterations);
            self.solves_since_jacobi = 0;
            // A block that is not positive definite is for the factor to deal with.
            if let Ok(outcome) = self.jacobi.attempt(matrix, rhs, x, budget) {
                let solved = matches!(outcome.end, End::Converged | End::Rounding);
                // One that did not get there would have needed more: how much more is a guess.
                let iterations = if solved { outcome.iterations } else { 2 * budget };
                self.jacobi_history = Some(JacobiHistory {
                    iterations: iterations as f64,
                    n_vertices: matrix.n_vertices(),
                });
                if solved {
                    return Ok(LinearReport::iterative(Method::BlockJacobiCg, &outcome));
                }
                abandoned = outcome.iterations;
            }
        }
        self.solves_since_jacobi += 1;
        match self.factor.solve_checked(matrix, rhs, x) {
            // No memory for a factor: conjugate gradients can do with little.
            Err(LinearError::TooLarge { .. }) => self.jacobi.solve(matrix, rhs, x),
            Err(error) => Err(error),
            Ok(report) => Ok(LinearReport { iterations: report.iterations + abandoned, ..report }),
        }
    }

    fn reset(&mut self) {
        *self = Self::new(*self.factor.settings());
    }
}
