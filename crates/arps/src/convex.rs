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
use crate::held::{Held, Motion, radial_and_across};
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
    /// Rounds of Newton's method.
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

/// Solves convex problems by a semi-smooth Newton method on the dual, which has no kink:
///
/// ```text
/// D(w) = Σ T(b − C w) + ½ wᵀ L w,   gradient L (w − h T′(p)) with p = b − C w
/// (1 + h² G L) Δw = h T′(p) − w,    G = T″(p)
/// ```
///
/// D is convex and once differentiable, so the method converges from anywhere with a line search, and
/// at the minimum w are the displacements. What rests has no row in the linear system: G is zero
/// there. Keeps its buffers.
#[derive(Clone, Debug, Default)]
pub struct ConvexSolver {
    p: Vec<Vector3>,
    size: Vec<f64>,
    place: Vec<usize>,
    movers: Vec<usize>,
    inertia: Vec<Matrix3>,
    rhs: Vec<Vector3>,
    step: Vec<Vector3>,
    change: Vec<Vector3>,
    c_change: Vec<Vector3>,
}

const MAX_ROUNDS: usize = 60;

impl ConvexSolver {
    /// Minimises from the displacements `d` (m) on, and leaves the solution there. `solve` solves the
    /// linear systems: [`MoverSystem::solve_dense`], [`MoverSystem::solve_cg`], or a solver of the
    /// caller's.
    ///
    /// # Errors
    /// What `solve` says.
    ///
    /// # Panics
    /// If the lists of the problem and `d` have different lengths.
    pub fn solve<B: Blocks>(
        &mut self,
        problem: &ConvexProblem<'_, B>,
        d: &mut [Vector3],
        mut solve: impl FnMut(&MoverSystem<'_, B>, &mut [Vector3]) -> Result<(), StepError>,
    ) -> Result<ConvexReport, StepError> {
        let mut report = ConvexReport::default();
        loop {
            self.momenta(problem, d);
            (report.residual, report.converged) = self.residual(problem, d);
            if report.converged || report.n_rounds == MAX_ROUNDS {
                return Ok(report);
            }
            report.n_rounds += 1;
            self.find_movers(problem, d);
            if !self.movers.is_empty() {
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
                for (a, &i) in self.movers.iter().enumerate() {
                    self.change[i] = self.step[a];
                }
            }
            self.advance(problem, d);
        }
    }

    /// Momenta at the end of the step for displacements, and the size of what they are summed from.
    fn momenta<B: Blocks>(&mut self, problem: &ConvexProblem<'_, B>, d: &[Vector3]) {
        self.p.clear();
        self.size.clear();
        for i in 0..d.len() {
            let own = problem.stiffness.diagonal(i) * d[i];
            let (mut sum, mut size) = (own, own.abs().sum());
            problem.stiffness.visit_row(i, |j, block| {
                let part = block * d[j];
                sum += part;
                size += part.abs().sum();
            });
            self.p.push(problem.drive[i] - problem.h * sum);
            self.size.push(problem.drive[i].abs().sum() + problem.h * size);
        }
    }

    /// Greatest error of momentum, and whether each is below the tolerance or rounding.
    fn residual<B: Blocks>(&self, problem: &ConvexProblem<'_, B>, d: &[Vector3]) -> (f64, bool) {
        let (mut worst, mut converged) = (0.0f64, true);
        for i in 0..d.len() {
            let error = momentum_error(&problem.conjugates[i], &self.p[i], &d[i], problem.h);
            worst = worst.max(error);
            converged &= error <= problem.tolerance + 8.0 * f64::EPSILON * self.size[i];
        }
        (worst, converged)
    }

    /// Lists the particles that move with their effective masses, sets the change of those that rest,
    /// which is to go back to where they were, and the right-hand side.
    fn find_movers<B: Blocks>(&mut self, problem: &ConvexProblem<'_, B>, d: &[Vector3]) {
        self.movers.clear();
        self.inertia.clear();
        self.rhs.clear();
        self.place.clear();
        self.change.clear();
        for i in 0..d.len() {
            let held = problem.conjugates[i].held();
            if held.motion(&self.p[i]) == Motion::Rest {
                self.place.push(usize::MAX);
                self.change.push(-d[i]);
            } else {
                self.place.push(self.movers.len());
                self.change.push(Vector3::zeros());
                self.movers.push(i);
                self.inertia.push(inertia(held, &self.p[i]) / problem.h);
            }
        }
        for (a, &i) in self.movers.iter().enumerate() {
            let v = problem.conjugates[i].held().velocity(&self.p[i]);
            let mut back = Vector3::zeros();
            problem.stiffness.visit_row(i, |j, block| back += block * self.change[j]);
            self.rhs.push(self.inertia[a] * (problem.h * v - d[i]) - problem.h * back);
        }
    }

    /// Goes along the change as far as the dual falls.
    fn advance<B: Blocks>(&mut self, problem: &ConvexProblem<'_, B>, d: &mut [Vector3]) {
        self.c_change.clear();
        let row = |i: usize| problem.h * problem.stiffness.row_times(i, &self.change);
        self.c_change.extend((0..d.len()).map(row));
        let share = self.line_search(problem, d);
        for (d, change) in d.iter_mut().zip(&self.change) {
            *d += share * change;
        }
    }

    /// Derivative of h D along the change, at a share of it.
    fn slope<B: Blocks>(&self, problem: &ConvexProblem<'_, B>, d: &[Vector3], share: f64) -> f64 {
        let along = |i: usize| {
            let p = self.p[i] - share * self.c_change[i];
            let v = problem.conjugates[i].held().velocity(&p);
            (d[i] + share * self.change[i] - problem.h * v).dot(&self.c_change[i])
        };
        (0..d.len()).map(along).sum()
    }

    /// A share of the change at which the dual is least, nearly: its slope rises along the way and is
    /// negative at the start, so wherever it is not positive the dual has only fallen. Looks at slopes
    /// alone, since differences of the dual drown in rounding.
    fn line_search<B: Blocks>(&self, problem: &ConvexProblem<'_, B>, d: &[Vector3]) -> f64 {
        let start = self.slope(problem, d, 0.0);
        let flat = 0.1 * start.abs();
        let (mut low, mut high) = ([0.0, start], [1.0, self.slope(problem, d, 1.0)]);
        if high[1] <= flat || start >= 0.0 {
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

/// Effective mass G⁻¹ at a momentum that moves (kg).
fn inertia(held: &Held, p: &Vector3) -> Matrix3 {
    match held.motion(p) {
        Motion::Full => Matrix3::from_diagonal_element(held.mass()),
        _ => {
            let r = p.norm();
            let along = held.mass() / held.ddphi(r);
            radial_and_across(&(p / r), along, held.mass() * r / held.dphi(r))
        }
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
