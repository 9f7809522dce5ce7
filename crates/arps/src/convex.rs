//! The convex problem of an implicit restrained step.
//!
//! With the conjugate ψ = T* of a convex kinetic energy, a step of length h from momenta p under
//! forces f with stiffness L = −∂f/∂x ⪰ 0 finds the displacements d that minimise
//!
//! ```text
//! Σ h ψ(‖d_i‖/h) − b·d + ½ dᵀ C d        b = p + h f,  C = h L
//! ```
//!
//! Its optimality condition is p_next = b − C d: the momentum at the end of the step goes with the
//! displacement. A particle stays exactly where it is while ‖p_next‖ ≤ p_r, the kink of ψ at zero, so
//! who moves is decided at the end of the step and not at its beginning.

use crate::blocks::Blocks;
use crate::error::StepError;
use crate::linear::MoverSystem;
use crate::{Conjugate, Matrix3, Vector3};

/// The convex problem of one step with linear forces.
#[derive(Clone, Copy, Debug)]
pub struct ConvexProblem<'a, B> {
    /// Length of the step (s).
    pub h: f64,
    /// Conjugate kinetic energy of each particle.
    pub conjugates: &'a [Conjugate],
    /// Drive b = p + h f of each particle (kg m/s).
    pub drive: &'a [Vector3],
    /// Stiffness L, positive semidefinite (N/m).
    pub stiffness: &'a B,
    /// Residual of momentum at which to stop, at least the rounding of C d (kg m/s).
    pub tolerance: f64,
}

/// How a convex problem was solved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConvexReport {
    /// Rounds of sweeps and Newton step.
    pub n_rounds: usize,
    /// Linear systems solved.
    pub n_solves: usize,
    /// Particles in the linear systems, summed over these.
    pub n_unknowns: usize,
    /// Greatest error of momentum over the particles at the end (kg m/s).
    pub residual: f64,
    /// False if the rounds ran out before the residual came under the tolerance.
    pub converged: bool,
}

/// Solves convex problems: proximal sweeps find the movers, Newton's method on the movers does the
/// rest. Keeps its buffers.
#[derive(Clone, Debug, Default)]
pub struct ConvexSolver {
    p: Vec<Vector3>,
    bound: Vec<f64>,
    place: Vec<usize>,
    movers: Vec<usize>,
    inertia: Vec<Matrix3>,
    rhs: Vec<Vector3>,
    step: Vec<Vector3>,
    change: Vec<Vector3>,
    c_change: Vec<Vector3>,
}

/// Sweeps in front of each Newton step. Without them, and without the stop at zero, the set of movers
/// cycles once h² k/m passes 10.
const N_SWEEPS: usize = 2;
const MAX_ROUNDS: usize = 60;

impl ConvexSolver {
    /// Minimises from the displacements `d` (m) on, and leaves the solution there. `solve` solves the
    /// linear systems: [`MoverSystem::solve_dense`], [`MoverSystem::solve_cg`], or a solver of the
    /// caller's.
    ///
    /// # Errors
    /// What `solve` says.
    pub fn solve<B: Blocks>(
        &mut self,
        problem: &ConvexProblem<'_, B>,
        d: &mut [Vector3],
        mut solve: impl FnMut(&MoverSystem<'_, B>, &mut [Vector3]) -> Result<(), StepError>,
    ) -> Result<ConvexReport, StepError> {
        let n = d.len();
        let all_free = problem.conjugates.iter().all(|c| c.held().is_free());
        let mut report = ConvexReport::default();
        self.bound.clear();
        self.bound.extend((0..n).map(|i| problem.h * greatest(&problem.stiffness.diagonal(i))));
        loop {
            // Without restraint the problem is linear, and a step is one solve as in the plain scheme.
            if !all_free {
                for _ in 0..N_SWEEPS {
                    self.sweep(problem, d);
                }
            }
            self.find_movers(problem, d, all_free);
            let (residual, converged) = self.residual(problem, d);
            (report.residual, report.converged) = (residual, converged);
            if converged || report.n_rounds == MAX_ROUNDS {
                return Ok(report);
            }
            report.n_rounds += 1;
            if self.movers.is_empty() {
                continue;
            }
            let system = MoverSystem {
                movers: &self.movers,
                inertia: &self.inertia,
                stiffness: problem.stiffness,
                h: problem.h,
                rhs: &self.rhs,
                place: &self.place,
            };
            self.step.resize(self.movers.len(), Vector3::zeros());
            solve(&system, &mut self.step)?;
            report.n_solves += 1;
            report.n_unknowns += self.movers.len();
            self.advance(problem, d);
            let (residual, converged) = self.residual(problem, d);
            (report.residual, report.converged) = (residual, converged);
            if converged {
                return Ok(report);
            }
        }
    }

    /// One proximal Gauss–Seidel sweep there and back: every particle in turn goes to the minimum of
    /// the problem in which its own stiffness is replaced by a bound of it.
    fn sweep<B: Blocks>(&self, problem: &ConvexProblem<'_, B>, d: &mut [Vector3]) {
        let n = d.len();
        for i in (0..n).chain((0..n).rev()) {
            let p = problem.drive[i] - problem.h * problem.stiffness.row_times(i, d);
            let pulled = p + self.bound[i] * d[i];
            d[i] = problem.conjugates[i].proximal(&pulled, self.bound[i], problem.h);
        }
    }

    /// Lists the particles that move, with their effective masses and residuals.
    fn find_movers<B: Blocks>(&mut self, problem: &ConvexProblem<'_, B>, d: &[Vector3], all: bool) {
        self.movers.clear();
        self.inertia.clear();
        self.rhs.clear();
        self.place.clear();
        self.place.resize(d.len(), usize::MAX);
        for i in (0..d.len()).filter(|&i| all || d[i] != Vector3::zeros()) {
            let (conjugate, v) = (&problem.conjugates[i], d[i] / problem.h);
            let free = conjugate.held().is_free();
            let mass = conjugate.held().mass();
            let effective =
                if free { Matrix3::identity() * mass } else { conjugate.effective_mass(&v) };
            let p = problem.drive[i] - problem.h * problem.stiffness.row_times(i, d);
            self.place[i] = self.movers.len();
            self.movers.push(i);
            self.inertia.push(effective / problem.h);
            self.rhs.push(p - conjugate.momentum(&v));
        }
    }

    /// Greatest error of momentum, and whether each is below the tolerance or rounding.
    fn residual<B: Blocks>(
        &mut self,
        problem: &ConvexProblem<'_, B>,
        d: &[Vector3],
    ) -> (f64, bool) {
        let (mut worst, mut converged) = (0.0f64, true);
        self.p.clear();
        for i in 0..d.len() {
            let mut rounding = self.bound[i] * d[i].norm() + problem.drive[i].norm();
            problem
                .stiffness
                .visit_row(i, |j, block| rounding += problem.h * block.norm() * d[j].norm());
            let p = problem.drive[i] - problem.h * problem.stiffness.row_times(i, d);
            self.p.push(p);
            let error = momentum_error(&problem.conjugates[i], &p, &d[i], problem.h);
            worst = worst.max(error);
            converged &= error <= problem.tolerance + 8.0 * f64::EPSILON * rounding;
        }
        (worst, converged)
    }

    /// Goes along the Newton step as far as the objective falls. A particle whose displacement would
    /// turn round stops at zero, the kink.
    fn advance<B: Blocks>(&mut self, problem: &ConvexProblem<'_, B>, d: &mut [Vector3]) {
        let n = d.len();
        self.change.clear();
        self.change.resize(n, Vector3::zeros());
        for stop in [true, false] {
            for (a, &i) in self.movers.iter().enumerate() {
                let turns = d[i].dot(&(d[i] + self.step[a])) <= 0.0;
                let free = problem.conjugates[i].held().is_free();
                self.change[i] = if stop && turns && !free { -d[i] } else { self.step[a] };
            }
            self.c_change.clear();
            let row = |i: usize| problem.h * problem.stiffness.row_times(i, &self.change);
            self.c_change.extend((0..n).map(row));
            if self.slope(problem, d, 0.0) < 0.0 {
                break;
            }
        }
        let share = self.line_search(problem, d);
        for &i in &self.movers {
            let to_zero = share == 1.0 && self.change[i] == -d[i];
            d[i] = if to_zero { Vector3::zeros() } else { d[i] + share * self.change[i] };
        }
    }

    /// Derivative of the objective along the change, at a share of it from 0 to 1.
    fn slope<B: Blocks>(&self, problem: &ConvexProblem<'_, B>, d: &[Vector3], share: f64) -> f64 {
        let along = |&i: &usize| {
            let at = d[i] + share * self.change[i];
            // On the way to zero the direction stays.
            let at = if at == Vector3::zeros() { f64::MIN_POSITIVE.sqrt() * d[i] } else { at };
            let p = self.p[i] - share * self.c_change[i];
            (problem.conjugates[i].momentum(&(at / problem.h)) - p).dot(&self.change[i])
        };
        self.movers.iter().map(along).sum()
    }

    /// A share of the change at which the objective is least, nearly: its slope rises along the way
    /// and is negative at the start, so wherever it is not positive the objective has only fallen.
    /// Looks at slopes alone, since differences of the objective drown in rounding.
    fn line_search<B: Blocks>(&self, problem: &ConvexProblem<'_, B>, d: &[Vector3]) -> f64 {
        let start = self.slope(problem, d, 0.0);
        let flat = 1e-3 * start.abs();
        let (mut low, mut high) = ([0.0, start], [1.0, self.slope(problem, d, 1.0)]);
        if high[1] <= flat {
            return 1.0;
        }
        for _ in 0..40 {
            // False position, kept away from the ends.
            let secant = (high[0] * -low[1] + low[0] * high[1]) / (high[1] - low[1]);
            let width = high[0] - low[0];
            let share = secant.clamp(low[0] + 0.1 * width, high[0] - 0.1 * width);
            let slope = self.slope(problem, d, share);
            if slope.abs() <= flat {
                return share;
            }
            if slope < 0.0 {
                low = [share, slope];
            } else {
                high = [share, slope];
            }
        }
        low[0]
    }
}

/// How far a momentum p (kg m/s) at the end of a step of h (s) is from one that goes with the
/// displacement d (m).
pub(crate) fn momentum_error(conjugate: &Conjugate, p: &Vector3, d: &Vector3, h: f64) -> f64 {
    if *d == Vector3::zeros() {
        (p.norm() - conjugate.held().p_r()).max(0.0)
    } else {
        (conjugate.momentum(&(d / h)) - p).norm()
    }
}

/// A bound of the eigenvalues of a symmetric block: the greatest sum over a row.
fn greatest(block: &Matrix3) -> f64 {
    (0..3).map(|i| block.row(i).abs().sum()).fold(0.0, f64::max)
}
