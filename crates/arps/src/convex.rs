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

use crate::blocks::Stiffness;
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
    /// Displacements at which the forces are known (m).
    pub origin: &'a [Vector3],
    /// Momenta p + h f with the forces there (kg m/s): b = drive + C origin.
    pub drive: &'a [Vector3],
    /// Stiffness L, positive semidefinite (N/m).
    pub stiffness: &'a B,
    /// Error of each momentum at which to stop, at least the rounding of C d (kg m/s).
    pub tolerance: &'a [f64],
    /// Whether a particle near rest is done when its velocity is right, as [`Conjugate::mismatch`] says,
    /// though its displacement does not give its momentum. The caller then takes that from
    /// [`ConvexSolver::end_momenta`] where [`Conjugate::is_vague`].
    pub by_velocity: bool,
    /// The most rounds of Newton's method.
    pub max_rounds: usize,
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
    /// True if every particle had full dynamics in every linear system.
    pub is_full: bool,
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

/// Rounds in which momenta are updated by what changed; after that, against rounding, anew.
const UPDATED_ROUNDS: usize = 3;

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
    pub fn solve<B: Stiffness>(
        &mut self,
        problem: &ConvexProblem<'_, B>,
        d: &mut [Vector3],
        mut solve: impl FnMut(&MoverSystem<'_, B>, &mut [Vector3]) -> Result<(), StepError>,
    ) -> Result<ConvexReport, StepError> {
        let mut report = ConvexReport { is_full: true, ..ConvexReport::default() };
        self.momenta(problem, d);
        loop {
            (report.residual, report.converged) = self.residual(problem, d);
            // Displacements that are a guess would else stay what they were, step after step, as long as that
            // is within the tolerance.
            let moves = || d.iter().any(|d| *d != Vector3::zeros());
            let is_guess = problem.by_velocity && report.n_rounds == 0 && moves();
            if (report.converged && !is_guess) || report.n_rounds == problem.max_rounds {
                return Ok(report);
            }
            report.n_rounds += 1;
            report.is_full &= self.find_movers(problem, d);
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
            self.advance(problem, d, report.n_rounds <= UPDATED_ROUNDS);
        }
    }

    /// Momenta at the end of the step (kg m/s) that go with what the last problem was left with: b − C d.
    pub fn end_momenta(&self) -> &[Vector3] {
        &self.p
    }

    /// Momenta at the end of the step for displacements.
    fn momenta<B: Stiffness>(&mut self, problem: &ConvexProblem<'_, B>, d: &[Vector3]) {
        self.p.clear();
        self.p.extend_from_slice(problem.drive);
        self.change.clear();
        self.change.extend(d.iter().zip(problem.origin).map(|(d, origin)| d - origin));
        if self.change.iter().all(|change| *change == Vector3::zeros()) {
            return;
        }
        self.c_change.resize(d.len(), Vector3::zeros());
        problem.stiffness.multiply(&self.change, &mut self.c_change);
        for (p, c) in self.p.iter_mut().zip(&self.c_change) {
            *p -= problem.h * c;
        }
    }

    /// Greatest error of momentum, and whether each is below the tolerance or rounding.
    fn residual<B: Stiffness>(
        &mut self,
        problem: &ConvexProblem<'_, B>,
        d: &[Vector3],
    ) -> (f64, bool) {
        let (mut worst, mut converged) = (0.0f64, true);
        self.size.clear();
        for i in 0..d.len() {
            let conjugate = &problem.conjugates[i];
            let error = if problem.by_velocity {
                conjugate.mismatch(&self.p[i], &d[i], problem.h)
            } else {
                conjugate.error(&self.p[i], &d[i], problem.h)
            };
            worst = worst.max(error);
            if error <= problem.tolerance[i] {
                continue;
            }
            if self.size.is_empty() {
                self.size.resize(d.len(), 0.0);
                problem.stiffness.multiply_abs(d, &mut self.size);
            }
            let size = problem.drive[i].abs().sum() + problem.h * self.size[i];
            converged &= error <= problem.tolerance[i] + 8.0 * f64::EPSILON * size;
        }
        (worst, converged)
    }

    /// Lists the particles that move with their effective masses, sets the change of those that rest,
    /// which is to go back to where they were, and the right-hand side. True if none is restrained
    /// that could move.
    fn find_movers<B: Stiffness>(&mut self, problem: &ConvexProblem<'_, B>, d: &[Vector3]) -> bool {
        let (mut is_full, mut is_back) = (true, false);
        self.movers.clear();
        self.inertia.clear();
        self.rhs.clear();
        self.place.clear();
        self.change.clear();
        for i in 0..d.len() {
            let held = problem.conjugates[i].held();
            let motion = held.motion(&self.p[i]);
            is_full &= motion == Motion::Full || held.p_r() == f64::INFINITY;
            if motion == Motion::Rest {
                self.place.push(usize::MAX);
                self.change.push(-d[i]);
                is_back |= d[i] != Vector3::zeros();
            } else {
                self.place.push(self.movers.len());
                self.change.push(Vector3::zeros());
                self.movers.push(i);
                self.inertia.push(inertia(held, &self.p[i]) / problem.h);
            }
        }
        self.c_change.clear();
        self.c_change.resize(d.len(), Vector3::zeros());
        if is_back {
            problem.stiffness.multiply(&self.change, &mut self.c_change);
        }
        for (a, &i) in self.movers.iter().enumerate() {
            let v = problem.conjugates[i].held().velocity(&self.p[i]);
            let back = problem.h * self.c_change[i];
            self.rhs.push(self.inertia[a] * (problem.h * v - d[i]) - back);
        }
        is_full
    }

    /// Goes along the change as far as the dual falls.
    fn advance<B: Stiffness>(
        &mut self,
        problem: &ConvexProblem<'_, B>,
        d: &mut [Vector3],
        update: bool,
    ) {
        problem.stiffness.multiply(&self.change, &mut self.c_change);
        self.c_change.iter_mut().for_each(|c| *c *= problem.h);
        let share = self.line_search(problem, d);
        for (d, change) in d.iter_mut().zip(&self.change) {
            *d += share * change;
        }
        if update {
            for (p, c) in self.p.iter_mut().zip(&self.c_change) {
                *p -= share * c;
            }
        } else {
            self.momenta(problem, d);
        }
    }

    /// Derivative of h D along the change, at a share of it.
    fn slope<B>(&self, problem: &ConvexProblem<'_, B>, d: &[Vector3], share: f64) -> f64 {
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
    fn line_search<B>(&self, problem: &ConvexProblem<'_, B>, d: &[Vector3]) -> f64 {
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
