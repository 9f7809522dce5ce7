//! Directions for restrained vertices: Newton's method with a kinetic energy that has a kink.
//!
//! With the conjugate ψ of a restrained kinetic energy the stage minimises
//!
//!   Φ(x) = Σ ψᵢ(|dᵢ|/h) − pᵢ·dᵢ/h + V(x),   d = x − base,
//!
//! where p are the momenta that the stage has without forces. An iteration makes V quadratic at x and
//! minimises the rest exactly (proximal Newton): a convex problem, whose linear systems hold only what
//! moves, see [`arps::ConvexProblem`]. Its solution is a direction in which Φ falls. Where everything
//! has full dynamics that is one linear system, the same as without restraint.

use super::{Direction, Found, Inertia, Model, Newton};
use crate::element::Stiffness;
use crate::solve_report::{SolveError, SolveReport};
use crate::solver::{BlockMatrix, LinearError, LinearSolver, clear_fixed};
use arps::{Conjugate, ConvexProblem, ConvexSolver, MoverSystem, StepError};
use mesh_core::{World3, par};
use std::cell::RefCell;
use std::sync::Arc;
use std::time::Instant;

/// What a stage needs to know of restraint.
pub(crate) struct Restrained<'a> {
    /// Positions of vertices that rest (m).
    pub base: &'a [World3],
    /// Momenta that the stage would have without forces (kg m/s).
    pub p: &'a [World3],
    /// Displacements that the stage would have with the velocities at its start (m).
    pub guess: &'a [World3],
    /// Kinetic energies; what is fixed rests for ever.
    pub conjugates: &'a [Conjugate],
}

impl Restrained<'_> {
    /// The part of Φ that depends on velocities (J).
    pub(super) fn potential(&self, inertia: &Inertia<'_>, x: &[World3]) -> f64 {
        let one = |i: usize| self.one(i, &(x[i] - self.base[i]), inertia.h);
        par::sum(x.len(), |i| if inertia.fixed[i] { 0.0 } else { one(i) })
    }

    /// A position, or that of rest if it differs from it by rounding alone.
    pub(super) fn snapped(&self, i: usize, x: World3) -> World3 {
        let base = &self.base[i];
        if (x - base).amax() <= 4.0 * f64::EPSILON * base.amax() { *base } else { x }
    }

    fn one(&self, i: usize, d: &World3, h: f64) -> f64 {
        self.conjugates[i].psi(d.norm() / h) - self.p[i].dot(d) / h
    }
}

/// Share of the tolerance to which a convex problem is solved.
const INNER: f64 = 0.5;
/// Share of the greatest speed by which momenta over mass may be off at rest and in transition, as long
/// as that is within these shares of what may rest.
const COARSE: [f64; 2] = [0.1, 0.3];
const FINE: f64 = 1e-4;
const ROUGH: f64 = 0.5;
/// The most linear systems for one direction; what is left then is for the next. Few need more than ten:
/// to begin again before the problem is solved costs more, since the forces of the next point are those of
/// what moves the wrong way.
const MAX_ROUNDS: usize = 20;
/// With a greater share of movers, those that rest keep rows of the identity, and the matrix its
/// pattern.
const MOST: f64 = 0.7;

/// Keeps buffers from one direction to the next.
#[derive(Default)]
pub(super) struct Directions {
    convex: ConvexSolver,
    /// Everything had full dynamics the last time, so that an exact Hessian may do.
    was_full: bool,
}

/// The stiffness as the convex problem sees it; linear systems put inertia on its diagonal for a while.
struct Operator<'a>(RefCell<&'a mut BlockMatrix>);

impl arps::Stiffness for Operator<'_> {
    fn multiply(&self, d: &[World3], out: &mut [World3]) {
        self.0.borrow().multiply(d, out);
    }

    fn multiply_abs(&self, d: &[World3], out: &mut [f64]) {
        self.0.borrow().multiply_abs(d, out);
    }
}

impl Newton<'_> {
    /// The direction to the minimum with V made quadratic.
    pub(super) fn restrained_direction(
        &mut self,
        restrained: &Restrained<'_>,
    ) -> Result<Found, SolveError> {
        let Inertia { h, time, fixed, mass, .. } = *self.inertia;
        if !self.directions.was_full {
            self.kind = Stiffness::Projected;
        }
        let n = self.x.len();
        let clock = Instant::now();
        let mut gradient = vec![World3::zeros(); n];
        self.system.assemble(&self.x, self.kind, &mut gradient);
        if fixed.contains(&true) {
            self.system.matrix.eliminate(fixed);
            clear_fixed(&mut gradient, fixed);
        }
        self.report.assembly_s += clock.elapsed().as_secs_f64();
        if !gradient.iter().all(|g| g.iter().all(|c| c.is_finite())) {
            return Err(SolveError::NotFinite { time, h });
        }

        let clock = Instant::now();
        let moves = |i: usize| !fixed[i];
        let zero = World3::zeros();
        let from: Vec<World3> =
            (0..n).map(|i| if moves(i) { self.x[i] - restrained.base[i] } else { zero }).collect();
        let drive: Vec<World3> = (0..n)
            .map(|i| if moves(i) { restrained.p[i] - gradient[i] * h } else { zero })
            .collect();
        let fastest = from.iter().map(|d| d.norm_squared()).fold(0.0, f64::max).sqrt() / h;
        // How far momenta are off, in units of what they may be.
        let tolerance = |i: usize| {
            let (held, most) = (restrained.conjugates[i].held(), self.settings.tolerance * mass[i]);
            if held.p_r() == 0.0 || mass[i] * from[i].norm() >= h * held.p_f() {
                return most;
            }
            // Between things that move fast momenta may be less exact, more so those that follow from a
            // velocity.
            let coarse = if from[i] == zero { COARSE[0] } else { COARSE[1] };
            let share = coarse * fastest * held.mass() / held.p_r();
            most.min(share.clamp(FINE, ROUGH) * held.p_r())
        };
        let mut tolerance: Vec<f64> = (0..n).map(tolerance).collect();
        let error =
            |i: usize| restrained.conjugates[i].mismatch(&drive[i], &from[i], h) / tolerance[i];
        let is_slow =
            |i: usize| mass[i] * from[i].norm() < h * restrained.conjugates[i].held().p_f();
        let slow = (0..n).filter(|&i| is_slow(i)).map(error).fold(0.0, f64::max);
        if self.is_near && slow <= 1.0 {
            return Ok(Found::Minimum);
        }
        tolerance.iter_mut().for_each(|tolerance| *tolerance *= INNER);
        let operator = Operator(RefCell::new(&mut self.system.matrix));
        let problem = ConvexProblem {
            h,
            conjugates: restrained.conjugates,
            origin: &from,
            drive: &drive,
            stiffness: &operator,
            tolerance: &tolerance,
            by_velocity: true,
            max_rounds: MAX_ROUNDS,
        };
        // One stage resembles the next, in who moves too.
        let is_first = self.report.iterations == 0;
        let mut to = if is_first { restrained.guess.to_vec() } else { from.clone() };
        let (mut failed, mut shifted) = (None, false);
        let (solver, report) = (&mut *self.solver, &mut self.report);
        let found = self.directions.convex.solve(&problem, &mut to, |movers, out| {
            let solved = solve_movers(solver, movers, fixed, report, out);
            let told = solved.map_err(|error| failed = Some(error));
            shifted |= told.map_err(|()| StepError::Singular { unknowns: movers.movers.len() })?;
            Ok(())
        });
        self.report.linear_s += clock.elapsed().as_secs_f64();
        let is_telling = match (found, failed) {
            (Ok(convex), _) => {
                self.report.rest.solves += convex.n_solves;
                self.report.rest.unknowns += convex.n_unknowns;
                self.directions.was_full = convex.is_full;
                convex.converged || convex.is_full
            }
            (Err(_), _) if self.kind == Stiffness::Exact => return Ok(Found::TooExact),
            (Err(_), Some(source)) => return Err(SolveError::Linear { time, source }),
            (Err(_), None) => return Err(SolveError::NotFinite { time, h }),
        };
        let p = self.directions.convex.end_momenta().to_vec();
        let step: Vec<World3> = to.iter().zip(&from).map(|(to, from)| to - from).collect();
        let slope = par::sum(n, |i| {
            let kinetic = || restrained.one(i, &to[i], h) - restrained.one(i, &from[i], h);
            if moves(i) { gradient[i].dot(&step[i]) + kinetic() } else { 0.0 }
        });
        let mut end = vec![World3::zeros(); n];
        par::fill(&mut end, |i| self.inertia.reach(i, &self.x[i], &step[i]));
        self.model = Some(Model { x: end, p });
        Ok(Found::Direction(Direction { step, slope: slope.min(0.0), is_telling, shifted }))
    }
}

/// Solves for the movers; true if the matrix had to be made positive definite.
fn solve_movers(
    solver: &mut dyn LinearSolver,
    system: &MoverSystem<'_, Operator<'_>>,
    fixed: &[bool],
    report: &mut SolveReport,
    out: &mut [World3],
) -> Result<bool, LinearError> {
    let MoverSystem { movers, inertia, h, rhs, place, .. } = *system;
    let mut stiffness = system.stiffness.0.borrow_mut();
    let n_free = fixed.iter().filter(|fixed| !**fixed).count();
    let linear = if movers.len() as f64 >= MOST * n_free as f64 {
        let n = fixed.len();
        let (mut whole, mut solution) = (vec![World3::zeros(); n], vec![World3::zeros(); n]);
        for (&i, rhs) in movers.iter().zip(rhs) {
            whole[i] = rhs / h;
        }
        let linear = if movers.len() == n_free {
            let before: Vec<_> = movers.iter().map(|&i| *stiffness.diagonal(i)).collect();
            for (&i, inertia) in movers.iter().zip(inertia) {
                *stiffness.diagonal_mut(i) += inertia / h;
            }
            let linear = solver.solve(&stiffness, &whole, &mut solution);
            for (&i, before) in movers.iter().zip(&before) {
                *stiffness.diagonal_mut(i) = *before;
            }
            linear?
        } else {
            let mut matrix = BlockMatrix::clone(&stiffness);
            let rests: Vec<bool> = place.iter().map(|&place| place == usize::MAX).collect();
            matrix.eliminate(&rests);
            for (&i, inertia) in movers.iter().zip(inertia) {
                *matrix.diagonal_mut(i) += inertia / h;
            }
            solver.solve(&matrix, &whole, &mut solution)?
        };
        for (&i, out) in movers.iter().zip(out) {
            *out = solution[i];
        }
        linear
    } else {
        let (pattern, slots) = stiffness.pattern().restricted(movers, place);
        let mut matrix = stiffness.restricted(Arc::new(pattern), &slots);
        for (a, inertia) in inertia.iter().enumerate() {
            *matrix.diagonal_mut(a) += inertia / h;
        }
        let rhs: Vec<World3> = rhs.iter().map(|rhs| rhs / h).collect();
        out.fill(World3::zeros());
        solver.solve(&matrix, &rhs, out)?
    };
    report.note(&linear);
    Ok(linear.shift > 0.0)
}
