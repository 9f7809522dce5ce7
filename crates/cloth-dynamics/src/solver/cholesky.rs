//! The two solvers that rest on a sparse Cholesky factor: a new one for each matrix, or an old one
//! for as long as it pays.

use nalgebra::Vector3;

use super::conjugate_gradient::End;
use super::cost::{self, FactorSize};
use super::kept_factor::KeptFactor;
use super::matrix::BlockMatrix;
use super::{LinearError, LinearReport, LinearSettings, LinearSolver, Method, check};

/// Factors every matrix. The solution is corrected by conjugate gradients, with the factor as the
/// preconditioner, until the true residual is below the tolerance: at most one or two iterations
/// for a factor in double precision.
pub struct SparseCholesky {
    kept: KeptFactor,
}

impl SparseCholesky {
    /// A solver with these settings.
    pub fn new(settings: LinearSettings) -> Self {
        Self { kept: KeptFactor::new(settings) }
    }

    /// Counted size of the factor in use; `None` before the first solve.
    pub fn factor_size(&self) -> Option<FactorSize> {
        self.kept.analysis().map(FactorSize::known)
    }
}

impl LinearSolver for SparseCholesky {
    fn solve(
        &mut self,
        matrix: &BlockMatrix,
        rhs: &[Vector3<f64>],
        x: &mut [Vector3<f64>],
    ) -> Result<LinearReport, LinearError> {
        match check(matrix, rhs, x)? {
            Some(report) => Ok(report),
            None => self.kept.solve_fresh(matrix, rhs, x),
        }
    }

    fn reset(&mut self) {
        *self = Self::new(*self.kept.settings());
    }
}

/// Iterations expected of a stale factor that has not been tried yet.
const FIRST_GUESS: f64 = 4.0;
/// The most solves in a row that do not try a stale factor.
const LONGEST_BAR: usize = 31;

/// Keeps the factor of an earlier matrix as the preconditioner of conjugate gradients.
///
/// If `A` has changed little since `L Lᵀ` was its factor, the eigenvalues of `(L Lᵀ)⁻¹ A` crowd
/// around one and few iterations are needed. A new factor is computed when
/// - the pattern has changed,
/// - a solve has used up as many iterations as a factorisation costs, or
/// - the last solve cost more than the mean over the life of the factor, its own cost included:
///   from there on the mean would rise. (This is the rule for replacing any machine that wears.)
///
/// Where factors turn out useless for the very next matrix, every matrix is factored for a while.
pub struct StaleFactorCg {
    kept: KeptFactor,
    life: Life,
    experience: Experience,
}

/// What has been paid for the factor in use.
#[derive(Clone, Copy, Debug, Default)]
struct Life {
    /// Counted cost of the factor and of all solves with it.
    spent: f64,
    solves: usize,
    /// The factor has served its time.
    worn: bool,
}

/// What earlier factors have taught.
#[derive(Clone, Copy, Debug, Default)]
struct Experience {
    /// Iterations of the last solve with a stale factor.
    last_iterations: Option<usize>,
    /// How many solves to come must not try a stale factor.
    barred: usize,
    /// How many the last bar was for; zero after a success.
    last_bar: usize,
}

impl Experience {
    /// A factor that was no use for the very next matrix: the more often, the longer the bar.
    fn useless(&mut self) {
        self.last_bar = (2 * self.last_bar + 1).min(LONGEST_BAR);
        self.barred = self.last_bar;
    }
}

impl StaleFactorCg {
    /// A solver with these settings.
    pub fn new(settings: LinearSettings) -> Self {
        Self {
            kept: KeptFactor::new(settings),
            life: Life::default(),
            experience: Experience::default(),
        }
    }

    pub(super) fn settings(&self) -> &LinearSettings {
        self.kept.settings()
    }

    /// Whether there is a factor worth trying.
    fn is_useful(&self, matrix: &BlockMatrix) -> bool {
        self.kept.has_factor(matrix.pattern()) && !self.life.worn && self.experience.barred == 0
    }

    /// Counted size of the factor for matrices of this pattern.
    fn size(&self, matrix: &BlockMatrix) -> FactorSize {
        let pattern = matrix.pattern();
        match self.kept.analysis() {
            Some(analysis) if analysis.is_of(pattern) => FactorSize::known(analysis),
            earlier => FactorSize::guess(pattern, earlier.map(FactorSize::known)),
        }
    }

    /// Expected cost of the next solve; where that needs a new factor, its cost is shared out over
    /// `life` solves.
    pub(super) fn expected_cost(&self, matrix: &BlockMatrix, life: usize) -> f64 {
        let pattern = matrix.pattern();
        let size = self.size(matrix);
        let iteration = size.iteration(pattern, self.kept.is_single());
        let stale = self.experience.last_iterations.map_or(FIRST_GUESS, |n| n as f64) * iteration;
        if self.is_useful(matrix) {
            return stale;
        }
        let single = self.kept.wants_single();
        let iteration = size.iteration(pattern, single);
        let mut fresh = size.factorize(single) + 2.0 * iteration;
        if !self.kept.is_analysed(pattern) {
            fresh += cost::analysis(pattern);
        }
        let later = if self.experience.barred > 0 { fresh } else { stale.min(fresh) };
        let life = life.max(1) as f64;
        (fresh + (life - 1.0) * later) / life
    }

    /// [`LinearSolver::solve`] without the checks.
    pub(super) fn solve_checked(
        &mut self,
        matrix: &BlockMatrix,
        rhs: &[Vector3<f64>],
        x: &mut [Vector3<f64>],
    ) -> Result<LinearReport, LinearError> {
        let pattern = matrix.pattern();
        let mut abandoned = 0;
        if self.is_useful(matrix) {
            let size = self.size(matrix);
            let iteration = size.iteration(pattern, self.kept.is_single());
            let budget = (size.factorize(self.kept.wants_single()) / iteration).ceil() as usize + 1;
            if let Some(outcome) = self.kept.solve_stale(matrix, rhs, x, budget) {
                self.experience.last_iterations = Some(outcome.iterations);
                if matches!(outcome.end, End::Converged | End::Rounding) {
                    self.experience.last_bar = 0;
                    self.pay(outcome.iterations as f64 * iteration);
                    return Ok(LinearReport::iterative(Method::StaleFactorCg, &outcome));
                }
                abandoned = outcome.iterations;
                if self.life.solves == 1 {
                    self.experience.useless();
                }
            }
        } else {
            self.experience.barred = self.experience.barred.saturating_sub(1);
        }
        let report = self.kept.solve_fresh(matrix, rhs, x)?;
        self.begin_life(matrix, &report);
        Ok(LinearReport { iterations: report.iterations + abandoned, ..report })
    }

    /// Opens the books for a new factor.
    fn begin_life(&mut self, matrix: &BlockMatrix, report: &LinearReport) {
        let size = self.size(matrix);
        let single = self.kept.is_single();
        let iterations = report.iterations as f64 + 1.0;
        self.life = Life::default();
        self.pay(size.factorize(single) + iterations * size.iteration(matrix.pattern(), single));
        self.life.worn = false;
    }

    /// Books the cost of a solve, and finds out whether the factor is worn.
    fn pay(&mut self, cost: f64) {
        self.life.spent += cost;
        self.life.solves += 1;
        self.life.worn = cost * self.life.solves as f64 > self.life.spent;
    }
}

impl LinearSolver for StaleFactorCg {
    fn solve(
        &mut self,
        matrix: &BlockMatrix,
        rhs: &[Vector3<f64>],
        x: &mut [Vector3<f64>],
    ) -> Result<LinearReport, LinearError> {
        match check(matrix, rhs, x)? {
            Some(report) => Ok(report),
            None => self.solve_checked(matrix, rhs, x),
        }
    }

    fn reset(&mut self) {
        *self = Self::new(*self.settings());
    }
}
