//! A factor that outlives the system it was made for, with the analysis of its pattern: computed in
//! single or double precision, shifted where the matrix is not positive definite.

use std::sync::Arc;

use faer::sparse::FaerError;
use nalgebra::Vector3;

use super::analysis::Analysis;
use super::conjugate_gradient::{self, End, Outcome, Start, Vectors};
use super::factor::{BadPivot, Factor, Real};
use super::matrix::BlockMatrix;
use super::pattern::BlockPattern;
use super::{LinearError, LinearReport, LinearSettings, Method, Precision, no_convergence};

/// The most iterations that improve the solution of a fresh factor in single precision: about what
/// double precision costs more.
const REFINE_SINGLE: usize = 8;
/// A factor in single precision is good if its own solution needs at most this many: a poor one is
/// slow as a stale factor, too.
const GOOD_SINGLE: usize = 3;
/// After a poor one, or one that took long, so many factors are in double precision.
const BARRED: usize = 32;
/// The same in double precision, where more than one or two means a matrix at the edge of singular.
const REFINE_DOUBLE: usize = 20;
/// Shifts above one succeed by Gershgorin's theorem; beyond this the numbers must be broken.
const LARGEST_SHIFT: f64 = 8.0;

/// The factor in the precision it is held in.
enum Numbers {
    Single(Factor<f32>),
    Double(Factor<f64>),
}

impl Numbers {
    fn analysis(&self) -> &Analysis {
        match self {
            Self::Single(factor) => factor.analysis(),
            Self::Double(factor) => factor.analysis(),
        }
    }
}

/// Why a factor did not give a solution.
enum Failure {
    Pivot(BadPivot),
    NoConvergence(Outcome),
}

impl Failure {
    fn iterations(&self) -> usize {
        match self {
            Self::Pivot(_) => 0,
            Self::NoConvergence(outcome) => outcome.iterations,
        }
    }

    fn error(&self, matrix: &BlockMatrix, shift: f64, tolerance: f64) -> LinearError {
        match self {
            Self::Pivot(BadPivot { vertex }) => {
                LinearError::NotPositiveDefinite { vertex: *vertex, shift }
            }
            Self::NoConvergence(outcome) => no_convergence(matrix, outcome, tolerance),
        }
    }
}

/// See the [module](self).
pub(super) struct KeptFactor {
    settings: LinearSettings,
    numbers: Option<Numbers>,
    /// Whether `numbers` holds a factor, and not only room for one.
    valid: bool,
    /// How many factors to come must be in double precision.
    singles_barred: usize,
    /// The last shift that was needed; zero if none was.
    last_shift: f64,
    vectors: Vectors,
}

impl KeptFactor {
    pub(super) fn new(settings: LinearSettings) -> Self {
        Self {
            settings,
            numbers: None,
            valid: false,
            singles_barred: 0,
            last_shift: 0.0,
            vectors: Vectors::default(),
        }
    }

    pub(super) fn settings(&self) -> &LinearSettings {
        &self.settings
    }

    /// The analysis of the last pattern.
    pub(super) fn analysis(&self) -> Option<&Analysis> {
        self.numbers.as_ref().map(Numbers::analysis)
    }

    /// Whether `pattern` needs no new analysis.
    pub(super) fn is_analysed(&self, pattern: &Arc<BlockPattern>) -> bool {
        self.analysis().is_some_and(|analysis| analysis.is_of(pattern))
    }

    /// Whether there is a factor of a matrix of this pattern.
    pub(super) fn has_factor(&self, pattern: &Arc<BlockPattern>) -> bool {
        self.valid && self.is_analysed(pattern)
    }

    /// Whether the factor there is is in single precision.
    pub(super) fn is_single(&self) -> bool {
        matches!(self.numbers, Some(Numbers::Single(_)))
    }

    /// Whether the next factor will be in single precision.
    pub(super) fn wants_single(&self) -> bool {
        self.settings.precision == Precision::Mixed && self.singles_barred == 0
    }

    /// Takes the numbers out, made ready for the next factor of this pattern: analyses it unless
    /// that has been done, and tells whether it had to be.
    fn take(&mut self, pattern: &Arc<BlockPattern>) -> Result<(Numbers, bool), FaerError> {
        self.valid = false;
        let single = self.wants_single();
        let old = self.numbers.take();
        let analysed = !old.as_ref().is_some_and(|numbers| numbers.analysis().is_of(pattern));
        let numbers = match old {
            Some(Numbers::Single(mut factor)) if single => {
                if analysed {
                    factor.turn_to(Analysis::new(pattern.clone())?)?;
                }
                Numbers::Single(factor)
            }
            Some(Numbers::Double(mut factor)) if !single => {
                if analysed {
                    factor.turn_to(Analysis::new(pattern.clone())?)?;
                }
                Numbers::Double(factor)
            }
            other => {
                let analysis = match other {
                    Some(Numbers::Single(factor)) if !analysed => factor.into_analysis(),
                    Some(Numbers::Double(factor)) if !analysed => factor.into_analysis(),
                    // Gone before the new one is made: together they may not fit.
                    stale => {
                        drop(stale);
                        Analysis::new(pattern.clone())?
                    }
                };
                if single {
                    Numbers::Single(Factor::new(analysis)?)
                } else {
                    Numbers::Double(Factor::new(analysis)?)
                }
            }
        };
        Ok((numbers, analysed))
    }

    /// Conjugate gradients on `matrix` with the factor there is (see [`Self::has_factor`]).
    pub(super) fn solve_stale(
        &mut self,
        matrix: &BlockMatrix,
        rhs: &[Vector3<f64>],
        x: &mut [Vector3<f64>],
        budget: usize,
    ) -> Option<Outcome> {
        let tolerance = self.settings.tolerance;
        let (start, vectors) = (Start::Given, &mut self.vectors);
        Some(match self.numbers.as_mut()? {
            Numbers::Single(factor) => {
                conjugate_gradient::solve(matrix, rhs, x, factor, start, tolerance, budget, vectors)
            }
            Numbers::Double(factor) => {
                conjugate_gradient::solve(matrix, rhs, x, factor, start, tolerance, budget, vectors)
            }
        })
    }

    /// Factors `matrix` and solves: in single precision if it is allowed and good enough, else in
    /// double precision, else with a shift.
    pub(super) fn solve_fresh(
        &mut self,
        matrix: &BlockMatrix,
        rhs: &[Vector3<f64>],
        x: &mut [Vector3<f64>],
    ) -> Result<LinearReport, LinearError> {
        let n_vertices = matrix.n_vertices();
        let too_large =
            |error: FaerError| LinearError::TooLarge { n_vertices, reason: error.to_string() };
        let (numbers, analysed) = self.take(matrix.pattern()).map_err(too_large)?;
        self.singles_barred = self.singles_barred.saturating_sub(1);
        let (mut wasted, mut single_failed) = (0, false);
        let mut factor = match numbers {
            Numbers::Double(factor) => factor,
            Numbers::Single(mut factor) => {
                let tolerance = self.settings.tolerance;
                let vectors = &mut self.vectors;
                match attempt(&mut factor, matrix, rhs, x, tolerance, REFINE_SINGLE, vectors) {
                    Ok(outcome) => {
                        if outcome.iterations > GOOD_SINGLE || factor.is_slow() {
                            self.singles_barred = BARRED;
                        }
                        self.numbers = Some(Numbers::Single(factor));
                        self.valid = true;
                        return Ok(report(&outcome, analysed));
                    }
                    Err(failure) => wasted = failure.iterations(),
                }
                single_failed = true;
                Factor::new(factor.into_analysis()).map_err(too_large)?
            }
        };
        let solved = self.solve_double(&mut factor, matrix, rhs, x);
        self.numbers = Some(Numbers::Double(factor));
        let (outcome, wasted_double, shift) = solved?;
        self.valid = true;
        self.last_shift = shift;
        // Where even double precision needed a shift, the fault was not with single precision.
        if single_failed && shift == 0.0 {
            self.singles_barred = BARRED;
        }
        let report = report(&outcome, analysed);
        Ok(LinearReport { iterations: report.iterations + wasted + wasted_double, shift, ..report })
    }

    /// Factors and solves in double precision, with growing shifts where that fails. Returns the
    /// outcome, the iterations of failed attempts, and the shift.
    fn solve_double(
        &mut self,
        factor: &mut Factor<f64>,
        matrix: &BlockMatrix,
        rhs: &[Vector3<f64>],
        x: &mut [Vector3<f64>],
    ) -> Result<(Outcome, usize, f64), LinearError> {
        let tolerance = self.settings.tolerance;
        let (mut wasted, mut shift) = (0, 0.0);
        loop {
            let shifted = (shift > 0.0).then(|| matrix.shifted(shift));
            let system = shifted.as_ref().unwrap_or(matrix);
            let vectors = &mut self.vectors;
            let failure = match attempt(factor, system, rhs, x, tolerance, REFINE_DOUBLE, vectors) {
                Ok(outcome) => return Ok((outcome, wasted, shift)),
                Err(failure) => failure,
            };
            if let Some(vertex) = matrix.row_sums().iter().position(|sum| !sum.is_finite()) {
                return Err(LinearError::NotFinite { what: "the matrix", vertex });
            }
            let next = self.settings.regularisation.map(|r| r.next(shift, self.last_shift));
            match next.filter(|&next| next <= LARGEST_SHIFT) {
                Some(next) => shift = next,
                None => return Err(failure.error(matrix, shift, tolerance)),
            }
            wasted += failure.iterations();
        }
    }
}

/// The report of a fresh factor that needed no shift.
fn report(outcome: &Outcome, analysed: bool) -> LinearReport {
    LinearReport {
        refactored: true,
        analysed,
        ..LinearReport::iterative(Method::Cholesky, outcome)
    }
}

/// Factors and solves in one precision.
fn attempt<T: Real>(
    factor: &mut Factor<T>,
    matrix: &BlockMatrix,
    rhs: &[Vector3<f64>],
    x: &mut [Vector3<f64>],
    tolerance: f64,
    max_iterations: usize,
    vectors: &mut Vectors,
) -> Result<Outcome, Failure> {
    factor.factorize(matrix).map_err(Failure::Pivot)?;
    let start = Start::Preconditioned;
    let outcome = conjugate_gradient::solve(
        matrix,
        rhs,
        x,
        factor,
        start,
        tolerance,
        max_iterations,
        vectors,
    );
    match outcome.end {
        End::Converged | End::Rounding => Ok(outcome),
        _ => Err(Failure::NoConvergence(outcome)),
    }
}
