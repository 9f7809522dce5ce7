//! Linear solvers for the implicit step: symmetric positive definite systems `A x = b` of 3×3
//! blocks, one block row per mesh vertex.
//!
//! Every Newton iteration of an implicit step ends here, with `A = M/h² + K` (mass, step,
//! stiffness) or something like it. Where the cloth is stiff or the step long, `A` is badly
//! conditioned, and how fast the system is solved is how fast the simulation runs.
//!
//! | method | cost | for |
//! |---|---|---|
//! | [`BlockJacobiCg`] | iterations × blocks; iterations grow with stiffness and size | soft cloth, short steps, very large meshes |
//! | [`SparseCholesky`] | one factorisation, whatever the stiffness | stiff cloth |
//! | [`StaleFactorCg`] | a few iterations with the factor of an earlier matrix | matrices that change slowly |
//! | [`Auto`] | the one of these with the lowest counted cost | the default |
//!
//! The way of a matrix: a [`PatternBuilder`] collects the stencils of all elements and makes a
//! [`BlockPattern`]; [`StencilSlots`] remember where each element's blocks go; a [`BlockMatrix`]
//! receives the blocks; a [`LinearSolver`] solves. The pattern lives until the mesh or the contacts
//! change, and with it the analysis that the factorisation needs.
//!
//! All results are the same bits in every run: sums have a fixed order, and choices rest on counts
//! of operations and iterations, never on a clock.

mod analysis;
#[cfg(test)]
mod assembly_tests;
mod auto;
mod block_jacobi;
mod cholesky;
mod conjugate_gradient;
mod cost;
mod factor;
mod kept_factor;
mod matrix;
mod pattern;
mod scatter;
mod sums;

use nalgebra::Vector3;

pub use auto::Auto;
pub use block_jacobi::BlockJacobiCg;
pub use cholesky::{SparseCholesky, StaleFactorCg};
pub use cost::FactorSize;
pub use matrix::{BlockMatrix, clear_fixed};
pub use pattern::{ABSENT, BlockPattern, PatternBuilder, PatternError};
pub use scatter::StencilSlots;

use conjugate_gradient::{End, Outcome};

/// Solves symmetric positive definite block systems.
pub trait LinearSolver: Send {
    /// Solves `A x = rhs` until `‖rhs − A x‖ ≤ tolerance ‖rhs‖`.
    ///
    /// On entry `x` is a guess (zero if there is none); on success it is the solution, and on
    /// [`LinearError::NoConvergence`] the last iterate. All slices have one entry per vertex.
    fn solve(
        &mut self,
        matrix: &BlockMatrix,
        rhs: &[Vector3<f64>],
        x: &mut [Vector3<f64>],
    ) -> Result<LinearReport, LinearError>;

    /// Forgets all factors, analyses and history: from here on the solver behaves, bit for bit, like
    /// a new one. Called at checkpoints, so that a resumed run goes on like an uninterrupted one.
    fn reset(&mut self);
}

/// Which solver to use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SolverKind {
    /// [`BlockJacobiCg`].
    BlockJacobiCg,
    /// [`SparseCholesky`].
    SparseCholesky,
    /// [`StaleFactorCg`].
    StaleFactorCg,
    /// [`Auto`].
    #[default]
    Auto,
}

impl SolverKind {
    /// Makes a solver of this kind.
    pub fn build(self, settings: LinearSettings) -> Box<dyn LinearSolver> {
        match self {
            Self::BlockJacobiCg => Box::new(BlockJacobiCg::new(settings)),
            Self::SparseCholesky => Box::new(SparseCholesky::new(settings)),
            Self::StaleFactorCg => Box::new(StaleFactorCg::new(settings)),
            Self::Auto => Box::new(Auto::new(settings)),
        }
    }
}

/// What all solvers want to know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearSettings {
    /// The relative residual `‖b − A x‖ / ‖b‖` (2-norm) to reach (dimensionless).
    pub tolerance: f64,
    /// The most iterations of block-Jacobi conjugate gradients in one solve.
    pub max_iterations: usize,
    /// Precision of factors.
    pub precision: Precision,
    /// What a factorisation does where the matrix is not positive definite; `None`: report an error.
    pub regularisation: Option<Regularisation>,
}

impl Default for LinearSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            max_iterations: 20_000,
            precision: Precision::default(),
            regularisation: Some(Regularisation::default()),
        }
    }
}

/// Precision in which factors are computed. The solution is in double precision always.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// Double precision.
    Double,
    /// Single precision with a few iterations of conjugate gradients on top, which costs about half;
    /// double precision for a while after that has failed or needed many iterations.
    #[default]
    Mixed,
}

/// How to make a matrix positive definite that is not: a shift `s` adds `s` times the Gershgorin
/// sum of each vertex's rows (the largest sum of absolute values along a row) to its diagonal, and
/// grows until the factorisation succeeds, which it does for `s > 1` at the latest.
///
/// The solution then is that of the shifted system: still a descent direction where `−b` is a
/// gradient (Nocedal and Wright 2006, Algorithm 3.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Regularisation {
    /// The first shift tried where there is no history (dimensionless).
    pub first: f64,
    /// The factor from one try to the next (dimensionless; 2 is taken for anything not above one).
    pub growth: f64,
}

impl Regularisation {
    /// The shift to try after `shift` has failed (zero: none has been tried); `last` is the one that
    /// succeeded last (zero: none).
    fn next(&self, shift: f64, last: f64) -> f64 {
        let growth = if self.growth > 1.0 { self.growth } else { 2.0 };
        if shift > 0.0 {
            shift * growth
        } else if last > 0.0 {
            last / growth
        } else {
            self.first.max(f64::EPSILON)
        }
    }
}

impl Default for Regularisation {
    fn default() -> Self {
        Self { first: 1e-6, growth: 4.0 }
    }
}

/// The method that produced a solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Nothing to do: no vertices, or a right-hand side of zero (below 1e-140).
    Trivial,
    /// Block-Jacobi conjugate gradients.
    BlockJacobiCg,
    /// A factorisation of this very matrix.
    Cholesky,
    /// Conjugate gradients preconditioned by the factor of an earlier matrix.
    StaleFactorCg,
}

/// What a solve did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearReport {
    /// The method that produced the solution.
    pub method: Method,
    /// Iterations of conjugate gradients, with those of abandoned attempts. Zero for a factorisation
    /// whose solution needed no improvement.
    pub iterations: usize,
    /// `‖b − A x‖ / ‖b‖`, computed from the solution (of the shifted system, if there is a shift;
    /// dimensionless) (1).
    pub relative_residual: f64,
    /// The tolerance is below what double precision can reach for this matrix: the residual is
    /// within a few roundings of `‖A‖ ‖x‖ + ‖b‖`.
    pub rounding_limited: bool,
    /// Whether this solve computed a factor.
    pub refactored: bool,
    /// Whether this solve analysed the pattern.
    pub analysed: bool,
    /// The shift that made the matrix positive definite; zero if it was (dimensionless, see
    /// [`Regularisation`]).
    pub shift: f64,
}

impl LinearReport {
    fn trivial() -> Self {
        Self {
            method: Method::Trivial,
            iterations: 0,
            relative_residual: 0.0,
            rounding_limited: false,
            refactored: false,
            analysed: false,
            shift: 0.0,
        }
    }

    fn iterative(method: Method, outcome: &Outcome) -> Self {
        Self {
            method,
            iterations: outcome.iterations,
            relative_residual: outcome.relative_residual,
            rounding_limited: outcome.end == End::Rounding,
            ..Self::trivial()
        }
    }
}

/// Why a system was not solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LinearError {
    /// The slices do not fit the matrix.
    #[error("matrix of {n_vertices} vertices, right-hand side of {rhs}, solution of {x}")]
    Shape {
        /// Vertices of the matrix.
        n_vertices: usize,
        /// Length of the right-hand side.
        rhs: usize,
        /// Length of the solution.
        x: usize,
    },
    /// A number is NaN or infinite, or so large that its square is.
    #[error("{what} is not finite at vertex {vertex}")]
    NotFinite {
        /// What it belongs to.
        what: &'static str,
        /// The vertex of its row.
        vertex: usize,
    },
    /// A pivot of the factorisation, or a diagonal block, is not positive.
    #[error("the matrix is not positive definite at vertex {vertex} (with a shift of {shift:e})")]
    NotPositiveDefinite {
        /// The vertex where this was seen.
        vertex: usize,
        /// The largest shift tried (dimensionless).
        shift: f64,
    },
    /// Conjugate gradients met a direction along which the matrix is not positive.
    #[error("the matrix is not positive definite: pᵀAp = {curvature:e} in iteration {iteration}")]
    NegativeCurvature {
        /// The iteration.
        iteration: usize,
        /// `pᵀ A p` for the search direction `p`.
        curvature: f64,
    },
    /// The tolerance was not reached.
    #[error(
        "relative residual {relative_residual:e} after {iterations} iterations, \
         {tolerance:e} was asked for"
    )]
    NoConvergence {
        /// Iterations done.
        iterations: usize,
        /// Reached (dimensionless).
        relative_residual: f64,
        /// Asked for (dimensionless).
        tolerance: f64,
    },
    /// The factor does not fit into memory, or into 32-bit indices.
    #[error("the factor of a matrix of {n_vertices} vertices does not fit: {reason}")]
    TooLarge {
        /// Vertices of the matrix.
        n_vertices: usize,
        /// What the factorisation said.
        reason: String,
    },
}

/// Squared norms of right-hand sides below this count as zero: they no longer have all their digits.
const TINY: f64 = 1e-280;

/// Refuses bad input. Answers at once where there is nothing to solve.
fn check(
    matrix: &BlockMatrix,
    rhs: &[Vector3<f64>],
    x: &mut [Vector3<f64>],
) -> Result<Option<LinearReport>, LinearError> {
    let n_vertices = matrix.n_vertices();
    if rhs.len() != n_vertices || x.len() != n_vertices {
        return Err(LinearError::Shape { n_vertices, rhs: rhs.len(), x: x.len() });
    }
    for (what, vector) in [("the right-hand side", rhs), ("the guess", &*x)] {
        if !sums::dot(vector, vector).is_finite() {
            let size = |i: &usize| vector[*i].norm_squared();
            let worst = (0..n_vertices).find(|i| !size(i).is_finite()).unwrap_or(0);
            return Err(LinearError::NotFinite { what, vertex: worst });
        }
    }
    if sums::dot(rhs, rhs) < TINY {
        x.fill(Vector3::zeros());
        return Ok(Some(LinearReport::trivial()));
    }
    Ok(None)
}

/// The error that says why conjugate gradients ended without a solution.
fn no_convergence(matrix: &BlockMatrix, outcome: &Outcome, tolerance: f64) -> LinearError {
    if let Some(vertex) = matrix.row_sums().iter().position(|sum| !sum.is_finite()) {
        return LinearError::NotFinite { what: "the matrix", vertex };
    }
    let Outcome { iterations, relative_residual, .. } = *outcome;
    match outcome.end {
        End::Curvature(curvature) => {
            LinearError::NegativeCurvature { iteration: iterations, curvature }
        }
        _ => LinearError::NoConvergence { iterations, relative_residual, tolerance },
    }
}
