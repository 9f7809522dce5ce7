//! Implicit restrained steps: backward Euler of the adaptive equations of motion as a convex problem.

use crate::blocks::{Blocks, SparseBlocks};
use crate::convex::{ConvexProblem, ConvexSolver};
use crate::error::StepError;
use crate::explicit::{bleeding_kick, check_time};
use crate::held::Held;
use crate::linear::MoverSystem;
use crate::restraint::Restraint;
use crate::{Conjugate, Law, Moved, Particles, Vector3};

/// Implicit steps with a policy of restraint, for forces that come from a potential energy V.
///
/// A step minimises Σ h T*((x′ − x)/h) − p·(x′ − x) + h V(x′) over the new positions x′; the new
/// momenta are p + h f(x′). For a convex V the restrained energy T + V never rises, whatever the
/// stiffness and the step, and the linear systems hold the moving particles only.
#[derive(Clone, Debug)]
pub struct Implicit<R> {
    restraint: R,
    stiffness: SparseBlocks,
    bleeding: Option<f64>,
    tolerance: f64,
    solver: ConvexSolver,
    conjugates: Vec<Conjugate>,
    now: Trial,
    next: Trial,
    /// Momenta at the beginning of the step, after bleeding.
    p: Vec<Vector3>,
    drive: Vec<Vector3>,
    tolerances: Vec<f64>,
}

/// Displacements, with positions, forces and potential energy there.
#[derive(Clone, Debug, Default)]
struct Trial {
    d: Vec<Vector3>,
    x: Vec<Vector3>,
    f: Vec<Vector3>,
    potential: f64,
}

/// What an implicit step did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImplicitReport {
    /// Who rests at its end, and what bled away.
    pub moved: Moved,
    /// Linearisations of the forces.
    pub n_newton: usize,
    /// Linear systems solved.
    pub n_solves: usize,
    /// Particles in the linear systems, summed over these.
    pub n_unknowns: usize,
    /// Greatest error of momentum over the particles (kg m/s).
    pub residual: f64,
    /// False if the residual did not come under the tolerance, or under rounding.
    pub converged: bool,
}

const MAX_NEWTON: usize = 40;
const MAX_ROUNDS: usize = 60;
const MAX_HALVINGS: usize = 30;

impl<R: Restraint> Implicit<R> {
    /// Steps under a policy, for particles whose interactions have the pattern of `stiffness`.
    pub fn new(restraint: R, stiffness: SparseBlocks) -> Implicit<R> {
        Implicit {
            restraint,
            stiffness,
            bleeding: None,
            tolerance: 1e-10,
            solver: ConvexSolver::default(),
            conjugates: Vec::new(),
            now: Trial::default(),
            next: Trial::default(),
            p: Vec::new(),
            drive: Vec::new(),
            tolerances: Vec::new(),
        }
    }

    /// The policy.
    pub fn restraint(&self) -> &R {
        &self.restraint
    }

    /// Lets the momentum of resting particles decay with a time constant τ (s), as in
    /// [`Explicit::with_bleeding`](crate::Explicit::with_bleeding).
    ///
    /// # Errors
    /// A τ that is not positive and finite.
    pub fn with_bleeding(mut self, tau: f64) -> Result<Implicit<R>, StepError> {
        check_time("the time constant of bleeding", tau)?;
        self.bleeding = Some(tau);
        Ok(self)
    }

    /// Stops when the error of every momentum is below this share (1) of the greatest drive
    /// ‖p + h f‖; 1e-10 if not set. What rounding allows is enough in any case. With 1e-6, and linear
    /// systems solved to 1e-8, energy rises by nothing that counts; with 1e-3 by up to some 1e-4.
    ///
    /// # Errors
    /// A tolerance that is not positive.
    pub fn with_tolerance(mut self, tolerance: f64) -> Result<Implicit<R>, StepError> {
        if tolerance.is_nan() || tolerance <= 0.0 {
            return Err(StepError::Tolerance { value: tolerance });
        }
        self.tolerance = tolerance;
        Ok(self)
    }

    /// Makes a step of h (s). `evaluate` is given positions (m), adds forces (N) to a slice of zeros
    /// and their stiffness −∂f/∂x, projected to be positive semidefinite (N/m), to a matrix of zeros,
    /// and returns the potential energy (J). `solve` is as in [`ConvexSolver::solve`].
    ///
    /// # Errors
    /// A step that is not positive and finite; a pattern of another size; a policy with a law that is not convex, or with
    /// [`Law::Exact`], whose conjugate has a second kink; a linear system that cannot be solved; a
    /// result that is not finite. The particles are then as they were.
    pub fn step(
        &mut self,
        particles: &mut Particles,
        h: f64,
        mut evaluate: impl FnMut(&[Vector3], &mut [Vector3], &mut SparseBlocks) -> f64,
        mut solve: impl FnMut(&MoverSystem<'_, SparseBlocks>, &mut [Vector3]) -> Result<(), StepError>,
    ) -> Result<ImplicitReport, StepError> {
        check_time("the step", h)?;
        let n = particles.len();
        if self.stiffness.n_rows() != n {
            return Err(StepError::Pattern { rows: self.stiffness.n_rows(), particles: n });
        }
        self.hold(particles)?;
        let mut report = ImplicitReport::default();
        self.now.d.clear();
        self.now.d.resize(n, Vector3::zeros());
        self.now.evaluate(&particles.x, &mut self.stiffness, &mut evaluate);
        report.moved.bled = self.bleed(particles, h);
        let mut objective = self.objective(&self.now, h);
        loop {
            report.n_newton += 1;
            let drive = |i: usize| self.p[i] + h * self.now.f[i];
            self.drive.clear();
            self.drive.extend((0..n).map(drive));
            if let Some(particle) = self.drive.iter().position(|b| !b.iter().all(|c| c.is_finite()))
            {
                return Err(StepError::NotFinite { particle });
            }
            let most = self.drive.iter().map(|b| b.norm()).fold(0.0, f64::max);
            let tolerance = self.tolerance * most;
            self.tolerances.clear();
            self.tolerances.resize(n, 0.1 * tolerance);
            let problem = ConvexProblem {
                h,
                conjugates: &self.conjugates,
                origin: &self.now.d,
                drive: &self.drive,
                stiffness: &self.stiffness,
                tolerance: &self.tolerances,
                by_velocity: false,
                max_rounds: MAX_ROUNDS,
            };
            if report.n_newton == 1 {
                // Go on as before, to begin with.
                let on = |i: usize| h * self.conjugates[i].held().velocity(&self.p[i]);
                self.next.d.clear();
                self.next.d.extend((0..n).map(on));
            } else {
                self.next.d.clone_from(&self.now.d);
            }
            let convex = self.solver.solve(&problem, &mut self.next.d, &mut solve)?;
            report.n_solves += convex.n_solves;
            report.n_unknowns += convex.n_unknowns;
            let falls = self.line_search(particles, h, &mut objective, &mut evaluate);
            let (residual, converged) = self.residual(h, tolerance);
            (report.residual, report.converged) = (residual, converged);
            if converged || !falls || report.n_newton == MAX_NEWTON {
                break;
            }
        }
        self.finish(particles, h, &mut report)?;
        Ok(report)
    }

    fn hold(&mut self, particles: &Particles) -> Result<(), StepError> {
        self.conjugates.clear();
        for i in 0..particles.len() {
            let held: Held = self.restraint.at(&particles.particle(i));
            let conjugate = held.conjugate();
            if held.law() == Law::Exact && !held.is_free() && held.p_r() < f64::INFINITY {
                return Err(StepError::SecondKink { particle: i });
            }
            let conjugate =
                conjugate.map_err(|cause| StepError::NotConvex { particle: i, cause })?;
            self.conjugates.push(conjugate);
        }
        Ok(())
    }

    /// Momenta at the beginning of the step: those of resting particles such that they end it as if
    /// they had bled under the force that they feel now. They stay within the ball of radius p_r, so
    /// T does not notice; a force so strong that they would not moves the particle anyway. Returns
    /// what is missing.
    fn bleed(&mut self, particles: &Particles, h: f64) -> Vector3 {
        self.p.clone_from(&particles.p);
        let mut bled = Vector3::zeros();
        let Some(tau) = self.bleeding else { return bled };
        for (i, p) in self.p.iter_mut().enumerate() {
            let conjugate = &self.conjugates[i];
            let left = bleeding_kick(p, &self.now.f[i], h, tau) - h * self.now.f[i];
            if conjugate.stays(p) && conjugate.stays(&left) {
                bled += *p - left;
                *p = left;
            }
        }
        bled
    }

    /// What a step minimises (J s).
    fn objective(&self, trial: &Trial, h: f64) -> f64 {
        let kinetic = |i: usize| {
            h * self.conjugates[i].psi(trial.d[i].norm() / h) - self.p[i].dot(&trial.d[i])
        };
        (0..trial.d.len()).map(kinetic).sum::<f64>() + h * trial.potential
    }

    /// Goes from `now` towards `next` until the objective does not rise, and makes that `now`. False
    /// if it rises however short the way.
    fn line_search(
        &mut self,
        particles: &Particles,
        h: f64,
        objective: &mut f64,
        evaluate: &mut impl FnMut(&[Vector3], &mut [Vector3], &mut SparseBlocks) -> f64,
    ) -> bool {
        let before = *objective;
        let slope = self.slope(h, false);
        let size = before.abs() + h * self.now.potential.abs();
        for _ in 0..MAX_HALVINGS {
            self.next.evaluate(&particles.x, &mut self.stiffness, evaluate);
            let after = self.objective(&self.next, h);
            // Near the minimum the objective is all rounding, and its slope tells more.
            let flatter = || self.slope(h, true).abs() <= 0.5 * slope.abs();
            if after <= before + 1e-13 * size || (after <= before + 1e-6 * size && flatter()) {
                std::mem::swap(&mut self.now, &mut self.next);
                *objective = after;
                return true;
            }
            for (next, now) in self.next.d.iter_mut().zip(&self.now.d) {
                *next = 0.5 * (*next + now);
            }
        }
        // Not a step: the stiffness belongs to `now` again, and the report says what is left.
        self.now.evaluate(&particles.x, &mut self.stiffness, evaluate);
        false
    }

    /// Derivative of the objective on the way from `now` to `next`, at one of these ends.
    fn slope(&self, h: f64, at_next: bool) -> f64 {
        let end = if at_next { &self.next } else { &self.now };
        let along = |i: usize| {
            let change = self.next.d[i] - self.now.d[i];
            let conjugate = &self.conjugates[i];
            let kinetic = if end.d[i] == Vector3::zeros() {
                // The kink, from the side of the other end.
                let height = conjugate.held().p_r() * change.norm();
                if change == Vector3::zeros() {
                    0.0
                } else if at_next {
                    -height
                } else {
                    height
                }
            } else {
                conjugate.momentum(&(end.d[i] / h)).dot(&change)
            };
            kinetic - (self.p[i] + h * end.f[i]).dot(&change)
        };
        (0..self.now.d.len()).map(along).sum()
    }

    fn residual(&self, h: f64, tolerance: f64) -> (f64, bool) {
        let (mut worst, mut converged) = (0.0f64, true);
        for i in 0..self.p.len() {
            let p = self.p[i] + h * self.now.f[i];
            let error = self.conjugates[i].error(&p, &self.now.d[i], h);
            // Forces inherit the rounding of positions, times the stiffness.
            let mut stiff = self.stiffness.diagonal(i).norm() * self.now.x[i].norm();
            self.stiffness.visit_row(i, |j, block| stiff += block.norm() * self.now.x[j].norm());
            let rounding = p.norm() + self.p[i].norm() + h * stiff;
            worst = worst.max(error);
            converged &= error <= tolerance + 4.0 * f64::EPSILON * rounding;
        }
        (worst, converged)
    }

    fn finish(
        &mut self,
        particles: &mut Particles,
        h: f64,
        report: &mut ImplicitReport,
    ) -> Result<(), StepError> {
        for i in 0..particles.len() {
            let (d, f, conjugate) = (&self.now.d[i], &self.now.f[i], &self.conjugates[i]);
            let p = &mut self.drive[i];
            let kicked = self.p[i] + h * f;
            // The slope of ψ for movers: p + h f has the error of the displacement times h² k/m.
            *p = if *d == Vector3::zeros() { kicked } else { conjugate.momentum(&(d / h)) };
            let motion = conjugate.held().motion(p);
            report.moved.count(motion);
            if !self.now.x[i].iter().chain(p.iter()).all(|c| c.is_finite()) {
                return Err(StepError::NotFinite { particle: i });
            }
        }
        particles.x.clone_from(&self.now.x);
        particles.p.clone_from(&self.drive);
        particles.time += h;
        Ok(())
    }
}

impl Trial {
    fn evaluate(
        &mut self,
        x_t0: &[Vector3],
        stiffness: &mut SparseBlocks,
        evaluate: &mut impl FnMut(&[Vector3], &mut [Vector3], &mut SparseBlocks) -> f64,
    ) {
        self.x.clear();
        self.x.extend(x_t0.iter().zip(&self.d).map(|(x, d)| x + d));
        self.f.clear();
        self.f.resize(x_t0.len(), Vector3::zeros());
        stiffness.clear();
        self.potential = evaluate(&self.x, &mut self.f, stiffness);
    }
}
