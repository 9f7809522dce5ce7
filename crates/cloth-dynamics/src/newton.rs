//! Newton's method on the incremental potential of an implicit stage,
//!
//!   Φ(x) = 1/(2h²) Σ mᵢ |xᵢ − x̃ᵢ|² + V(x),
//!
//! whose minimum is the new position. An iteration may raise Φ on trial, but the result is never above
//! the start, so a stage cannot blow up at any stiffness; stopping early costs accuracy, is allowed
//! ("one iteration is the fast setting") and is always reported.

use crate::contact::Blocked;
use crate::element::Stiffness;
use crate::solve_report::{NewtonSettings, SolveError, SolveReport};
use crate::solver::{LinearSolver, clear_fixed};
use crate::system::System;
use mesh_core::{World3, par};
use nalgebra::Matrix3;
use restrained::{Directions, Restrained};
use start::REST_STARTS;
use std::time::Instant;

pub(crate) mod restrained;
mod start;
#[cfg(test)]
mod tests;

/// The stage to be solved: inertia and constraints.
pub(crate) struct Inertia<'a> {
    /// Masses (kg).
    pub mass: &'a [f64],
    /// Where each vertex would go without forces (m).
    pub target: &'a [World3],
    /// Step (s).
    pub h: f64,
    /// Time at the end of the stage (s).
    pub time: f64,
    /// Vertices that do not move from where the start has them.
    pub fixed: &'a [bool],
    /// Of these, those that do not move either to keep things apart.
    pub pinned: &'a [bool],
    /// Restrained kinetic energies in the place of the plain ones.
    pub restrained: Option<Restrained<'a>>,
}

impl Inertia<'_> {
    fn potential(&self, system: &System, x: &[World3]) -> f64 {
        let kinetic = match &self.restrained {
            None => {
                let sum =
                    par::sum(x.len(), |i| self.mass[i] * (x[i] - self.target[i]).norm_squared());
                sum / (2.0 * self.h * self.h)
            }
            Some(restrained) => restrained.potential(self, x),
        };
        let contact = system.contact.as_ref().map_or(0.0, |contact| contact.energy(x));
        kinetic + system.energy(x) + contact
    }

    /// Where a step leads to.
    fn reach(&self, i: usize, x: &World3, step: &World3) -> World3 {
        let to = x + step;
        self.restrained.as_ref().map_or(to, |restrained| restrained.snapped(i, to))
    }
}

/// Share of the predicted decrease that a step must reach (Armijo).
const SUFFICIENT: f64 = 1e-4;
/// The most halvings before a direction is given up.
const MAX_HALVINGS: usize = 30;
/// Full steps in a row that may end above the lowest point before it is returned to.
const WATCH: usize = 2;
/// The same while each of them ends below the one before: they are on their way back into the valley.
const WATCH_FALLING: usize = 15;
/// An iteration that leaves a greater share of the residual than this is slow.
const SLOW: f64 = 0.3;
/// The first iterations are never made with the exact Hessian: they are far from its validity.
const PROJECTED_ITERATIONS: usize = 3;
/// Share of the residual of a failed try with the exact Hessian at which it is tried again.
const EXACT_AGAIN: f64 = 0.1;
/// Iterations are allowed up to this multiple of the limit while triangles are out of their strain
/// limits, or cloth has come through what it touches.
const PATIENCE: usize = 3;
/// How often contacts are looked for that came up during the iterations.
const MAX_LOOKS: usize = 2;

/// What an iteration finds.
enum Found {
    Direction(Direction),
    /// The exact Hessian was too much for the solver.
    TooExact,
    /// Nothing is left to do.
    Minimum,
}

/// A direction to go, and what is known of it.
struct Direction {
    step: Vec<World3>,
    /// Slope of the potential along it (J).
    slope: f64,
    /// The minimum is near if it is short: else only forces at its end can tell.
    is_telling: bool,
    /// The matrix had to be made positive definite.
    shifted: bool,
}

/// The lowest point so far, kept while steps that raise the potential are on trial.
#[derive(Default)]
struct Watchdog {
    /// Steps since then.
    age: usize,
    phi: f64,
    /// Slope of the potential along `direction`.
    slope: f64,
    x: Vec<World3>,
    /// Empty while the start itself is on trial.
    direction: Vec<World3>,
}

/// A minimisation on its way.
struct Newton<'a> {
    system: &'a mut System,
    solver: &'a mut dyn LinearSolver,
    inertia: &'a Inertia<'a>,
    settings: &'a NewtonSettings,
    report: SolveReport,
    x: Vec<World3>,
    phi: f64,
    /// The start at rest (m).
    at_rest: &'a [World3],
    trial: Vec<World3>,
    lowest: Watchdog,
    kind: Stiffness,
    directions: Directions,
    /// Residual (m/s) at which the exact Hessian was last found not to be positive definite; infinite
    /// if it was not.
    exact_failed_at: f64,
    converged: bool,
    /// The last step was short.
    is_near: bool,
    /// No descent is left within rounding.
    stuck: bool,
    /// The start on trial was no good, and the iterations from there do not count.
    began_again: bool,
    /// Vertices whose way contact has changed.
    bent: Vec<u32>,
    /// Where the last direction of a restrained stage led to, in full.
    model: Option<Model>,
}

/// A minimum with V made quadratic, under restraint.
struct Model {
    /// Positions (m).
    x: Vec<World3>,
    /// Momenta with the forces of that V (kg m/s).
    p: Vec<World3>,
}

/// What a stage was solved to.
pub(crate) struct Minimum {
    /// Positions (m).
    pub x: Vec<World3>,
    /// Under restraint, the momenta (kg m/s) that go with the forces of the last iteration, linear in
    /// the displacements, if its step was the last one and made in full.
    pub p: Option<Vec<World3>>,
    /// Vertices whose way something was in.
    pub bent: Vec<u32>,
    pub report: SolveReport,
}

/// Minimises the incremental potential from the better of two starts: at rest where the step begins,
/// or where inertia alone would lead.
///
/// A Newton step that turns stiff cloth by an angle θ stretches it by θ²/2. The next step takes that
/// back, but a line search would not let it come so far, and creep (the Maratos effect). So full
/// steps are made on trial, and only if a few of them end above the lowest point so far, and no longer
/// come down towards it, are they taken back, to follow the direction from there by halves (the
/// watchdog, Nocedal2006 §15.6).
/// No point above a start is ever returned.
pub(crate) fn minimise(
    system: &mut System,
    solver: &mut dyn LinearSolver,
    inertia: &Inertia<'_>,
    starts: &[Vec<World3>; 2],
    settings: &NewtonSettings,
) -> Result<Minimum, SolveError> {
    let clock = Instant::now();
    let (x, phi, lowest) = start::choose(system, inertia, starts)?;
    let energy_s = clock.elapsed().as_secs_f64();
    let report = SolveReport { stages: 1, residual: f64::INFINITY, energy_s, ..Default::default() };
    let mut newton = Newton {
        trial: vec![World3::zeros(); x.len()],
        lowest,
        kind: Stiffness::Projected,
        directions: Directions::default(),
        exact_failed_at: f64::INFINITY,
        converged: false,
        is_near: false,
        stuck: false,
        began_again: false,
        bent: Vec::new(),
        model: None,
        system,
        solver,
        inertia,
        settings,
        report,
        x,
        phi,
        at_rest: &starts[0],
    };
    let (mut budget, mut looks) = (settings.max_iterations, 0);
    let mut patience = PATIENCE * settings.max_iterations;
    loop {
        while newton.report.iterations < budget && !newton.converged && !newton.stuck {
            newton.iterate(newton.report.iterations + 1 == budget)?;
            if std::mem::take(&mut newton.began_again) {
                budget += newton.report.iterations;
                patience += newton.report.iterations;
            }
        }
        if looks < MAX_LOOKS && newton.look_for_contacts()? {
            looks += 1;
            budget = budget.max(newton.report.iterations + 1);
            continue;
        }
        let may_end = newton.respect_limits() && !newton.passes();
        let is_late = newton.report.iterations >= patience;
        if may_end || newton.converged || newton.stuck || is_late {
            break;
        }
        budget = newton.report.iterations + 1;
    }
    newton.report.unconverged = usize::from(!newton.converged);
    newton.secure()?;
    let Newton { x, model, bent, report, .. } = newton;
    let p = model.filter(|model| model.x == x).map(|model| model.p);
    Ok(Minimum { x, p, bent, report })
}

impl Newton<'_> {
    /// One linear solve and the step that it leads to; the last one is not made on trial. Without a
    /// step, and not counted, if the exact Hessian was too much for the solver.
    fn iterate(&mut self, is_last: bool) -> Result<(), SolveError> {
        let inertia = self.inertia;
        let found = match &inertia.restrained {
            None => self.direction()?,
            Some(restrained) => self.restrained_direction(restrained)?,
        };
        let Direction { step, slope, is_telling, shifted } = match found {
            Found::Direction(direction) => direction,
            Found::TooExact => {
                self.exact_failed_at = self.report.residual;
                self.kind = Stiffness::Projected;
                return Ok(());
            }
            Found::Minimum => {
                self.converged = true;
                return Ok(());
            }
        };
        self.report.iterations += 1;

        let clock = Instant::now();
        let largest = step.iter().map(|d| d.norm_squared()).fold(0.0, f64::max).sqrt();
        let before = std::mem::replace(&mut self.report.residual, largest / self.inertia.h);
        // The step of a matrix that had to be shifted says nothing about how far it is to go.
        let is_short = self.report.residual <= self.settings.tolerance && !shifted;
        let is_full = self.advance(step, slope, is_last);
        self.report.energy_s += clock.elapsed().as_secs_f64();
        let is_lower = self.lowest.age == 0;
        self.is_near = is_short && is_full && is_lower;
        self.converged = self.is_near && is_telling;

        // Where cloth buckles, the projected Hessian is too stiff, and the last vertices would
        // creep; near the minimum the exact one is positive definite.
        if shifted {
            self.exact_failed_at = self.report.residual;
        }
        let is_slow = self.kind == Stiffness::Exact || self.report.residual > SLOW * before;
        let is_near = self.report.iterations >= PROJECTED_ITERATIONS && is_full && is_lower;
        // Where it was not, it is tried again much nearer to the minimum.
        let is_due = self.report.residual < EXACT_AGAIN * self.exact_failed_at;
        let is_exact = is_slow && is_near && is_due;
        self.kind = if is_exact { Stiffness::Exact } else { Stiffness::Projected };
        Ok(())
    }

    /// The direction of Newton's method.
    fn direction(&mut self) -> Result<Found, SolveError> {
        let (h, time, n) = (self.inertia.h, self.inertia.time, self.x.len());
        let clock = Instant::now();
        let mut rhs = assemble(self.system, self.inertia, &self.x, self.kind);
        self.report.assembly_s += clock.elapsed().as_secs_f64();
        if !rhs.iter().all(|g| g.iter().all(|c| c.is_finite())) {
            return Err(SolveError::NotFinite { time, h });
        }

        let clock = Instant::now();
        for g in &mut rhs {
            *g = -*g;
        }
        let mut step = vec![World3::zeros(); n];
        let solved = self.solver.solve(&self.system.matrix, &rhs, &mut step);
        self.report.linear_s += clock.elapsed().as_secs_f64();
        let linear = match solved {
            Ok(linear) => linear,
            // Conjugate gradients cannot shift a matrix that is not positive definite.
            Err(_) if self.kind == Stiffness::Exact => return Ok(Found::TooExact),
            Err(source) => return Err(SolveError::Linear { time, source }),
        };
        self.report.note(&linear);
        let slope = -par::sum(n, |i| rhs[i].dot(&step[i]));
        let shifted = linear.shift > 0.0;
        Ok(Found::Direction(Direction { step, slope, is_telling: true, shifted }))
    }

    /// Makes the step; false if not in full.
    fn advance(&mut self, direction: Vec<World3>, slope: f64, is_last: bool) -> bool {
        let x = &self.x;
        self.system.predict(x, &direction);
        let inertia = self.inertia;
        par::fill(&mut self.trial, |i| inertia.reach(i, &x[i], &direction[i]));
        if self.lowest.age == 0 {
            self.lowest.phi = self.phi;
            self.lowest.slope = slope;
            self.lowest.x.clone_from(x);
            self.lowest.direction = direction;
        }
        let before = std::mem::replace(&mut self.phi, inertia.potential(self.system, &self.trial));
        let lowest = &mut self.lowest;
        let watch = if self.phi < before { WATCH_FALLING } else { WATCH };
        if self.phi <= lowest.phi + SUFFICIENT * lowest.slope + noise(lowest.phi) {
            lowest.age = 0;
        } else if self.phi.is_finite() && lowest.age < watch && !is_last {
            lowest.age += 1;
        } else {
            if lowest.direction.is_empty() {
                self.begin_again();
            } else {
                self.halve();
            }
            return false;
        }
        std::mem::swap(&mut self.x, &mut self.trial);
        true
    }

    /// Returns to the start at rest from one on trial that came to nothing.
    fn begin_again(&mut self) {
        self.system.rests = REST_STARTS;
        self.began_again = true;
        self.lowest.age = 0;
        self.x.clone_from(&self.lowest.x);
        self.phi = self.lowest.phi;
        self.system.predict(&self.x, &vec![World3::zeros(); self.x.len()]);
    }

    /// Returns to the lowest point and follows its direction by halves until the potential has fallen
    /// enough; stays there if it does not.
    fn halve(&mut self) {
        let lowest = &mut self.lowest;
        let mut share = 1.0;
        lowest.age = 0;
        for _ in 0..MAX_HALVINGS {
            share *= 0.5;
            par::for_each(&mut lowest.direction, |_, d| *d *= 0.5);
            self.report.halvings += 1;
            self.system.predict(&lowest.x, &lowest.direction);
            let inertia = self.inertia;
            par::fill(&mut self.trial, |i| inertia.reach(i, &lowest.x[i], &lowest.direction[i]));
            self.phi = self.inertia.potential(self.system, &self.trial);
            if self.phi <= lowest.phi + SUFFICIENT * share * lowest.slope + noise(lowest.phi) {
                std::mem::swap(&mut self.x, &mut self.trial);
                return;
            }
        }
        self.x.clone_from(&lowest.x);
        self.phi = lowest.phi;
        self.stuck = true;
    }

    /// Brings triangles back that are out of their strain limits, where that lowers the potential;
    /// false if some are left.
    fn respect_limits(&mut self) -> bool {
        let Some(mut limits) = self.system.limits.take() else { return true };
        let clock = Instant::now();
        let Inertia { mass, fixed, .. } = *self.inertia;
        let mass = |i: u32| if fixed[i as usize] { f64::INFINITY } else { mass[i as usize] };
        self.trial.copy_from_slice(&self.x);
        let in_bounds = match limits.project(&mut self.trial, &mass) {
            None => true,
            Some(all) => {
                let phi = self.inertia.potential(self.system, &self.trial);
                let is_lower = phi <= self.phi + noise(self.phi);
                if is_lower {
                    std::mem::swap(&mut self.x, &mut self.trial);
                    self.phi = phi;
                }
                is_lower && all
            }
        };
        self.system.limits = Some(limits);
        self.report.energy_s += clock.elapsed().as_secs_f64();
        in_bounds
    }

    /// Whether it has come through a contact: its way would have to be changed, which leaves gaps that
    /// are smaller with every step, and in the end none.
    fn passes(&self) -> bool {
        self.system.contact.as_ref().is_some_and(|contact| contact.is_passed(&self.x))
    }

    /// Gives energies to contacts that came up on the way; true if there are any.
    fn look_for_contacts(&mut self) -> Result<bool, SolveError> {
        let Some(contact) = &mut self.system.contact else { return Ok(false) };
        let clock = Instant::now();
        let is_new = contact.look(&self.x);
        if is_new {
            self.system.make_room_for_contact()?;
            self.phi = self.inertia.potential(self.system, &self.x);
            self.lowest.age = 0;
            (self.converged, self.stuck) = (false, false);
        }
        self.report.contact_s += clock.elapsed().as_secs_f64();
        Ok(is_new)
    }

    /// Shortens the way of the stage until nothing passes through anything on it. If that takes it above
    /// the start at rest, energy would come from nowhere: less of the way at a time does it better.
    fn secure(&mut self) -> Result<(), SolveError> {
        let Some(contact) = &mut self.system.contact else { return Ok(()) };
        let clock = Instant::now();
        let caught = |Blocked { place }| SolveError::Caught { time: self.inertia.time, place };
        self.trial.clone_from(&self.x);
        self.report.shortened = contact.secure(&mut self.x, self.inertia.pinned).map_err(caught)?;
        if self.report.shortened > 0 {
            let is_bent = |&i: &u32| self.trial[i as usize] != self.x[i as usize];
            self.bent = (0..self.x.len() as u32).filter(is_bent).collect();
        }
        self.report.touches = contact.n_touches();
        let is_bent = self.report.shortened > 0 && !self.system.accepts_rise;
        let potential = |x: &[World3]| self.inertia.potential(self.system, x);
        // With the contacts that are known now: at the start some were not.
        let is_above = |rest: f64| potential(&self.x) > rest + noise(rest);
        let rises = is_bent && is_above(potential(self.at_rest));
        self.report.contact_s += clock.elapsed().as_secs_f64();
        if rises {
            return Err(SolveError::Rise { time: self.inertia.time, h: self.inertia.h });
        }
        Ok(())
    }
}

/// Changes of a potential below this are rounding (J).
fn noise(phi: f64) -> f64 {
    1e-13 * phi.abs()
}

/// Sets the matrix to the Hessian of Φ with fixed vertices taken out; returns ∇Φ.
fn assemble(
    system: &mut System,
    inertia: &Inertia<'_>,
    x: &[World3],
    kind: Stiffness,
) -> Vec<World3> {
    let scale = 1.0 / (inertia.h * inertia.h);
    let mut gradient: Vec<World3> = vec![World3::zeros(); x.len()];
    par::fill(&mut gradient, |i| (x[i] - inertia.target[i]) * (inertia.mass[i] * scale));
    system.assemble(x, kind, &mut gradient);
    for (i, m) in inertia.mass.iter().enumerate() {
        *system.matrix.diagonal_mut(i) += Matrix3::identity() * (m * scale);
    }
    if inertia.fixed.contains(&true) {
        system.matrix.eliminate(inertia.fixed);
        clear_fixed(&mut gradient, inertia.fixed);
    }
    gradient
}
