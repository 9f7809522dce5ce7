//! A restrained stage of the whole cloth, and the same in the numbers of the part that is solved.

use super::friction::is_for_ever;
use crate::force::Stage;
use crate::integrator::StageStart;
use crate::newton::restrained::Restrained;
use crate::newton::{Inertia, Minimum, minimise};
use crate::part::Part;
use crate::solve_report::{NewtonSettings, SolveError, SolveReport};
use crate::solver::LinearSolver;
use crate::system::System;
use arps::{Conjugate, Held, Law};
use mesh_core::{ClothState, World3};
use std::time::Instant;

/// One try of a stage, in the numbers of the whole.
pub(super) struct Try {
    pub(super) x: Vec<World3>,
    /// Gradient (N) on the active vertices with which momenta of the stage end.
    pub(super) gradient: Vec<World3>,
    /// It goes with the displacements as the convex problem of the stage wants it.
    pub(super) is_solved: bool,
    /// Vertices whose way impacts bent.
    pub(super) bent: Vec<u32>,
    pub(super) report: SolveReport,
    pub(super) pushed: Vec<u32>,
}

/// A stage in the numbers of the whole cloth.
pub(super) struct WholeStage<'a> {
    pub(super) cloth: &'a ClothState,
    pub(super) start: &'a StageStart<'a>,
    pub(super) held: &'a [Held],
    /// Momenta that the stage would have without forces (kg m/s).
    pub(super) p: &'a [World3],
    pub(super) fixed: &'a [bool],
    /// Where the stage begins, with what is fixed where it is to be (m).
    pub(super) from: &'a [World3],
    /// Where momentum bleeds, who stands through the stage; all others are free.
    pub(super) stands: Option<Vec<bool>>,
    /// Where a try of the stage ended with fewer that were free (m).
    pub(super) guess: Option<Vec<World3>>,
}

impl WholeStage<'_> {
    /// Where a vertex would go without forces (m).
    pub(super) fn target(&self, i: usize) -> World3 {
        let held = &self.held[i];
        if self.is_fixed(i) {
            self.from[i]
        } else if self.stands.is_some() {
            self.start.base[i] + self.start.velocity[i] * self.start.h
        } else {
            self.start.base[i] + held.velocity(&self.p[i]) * self.start.h
        }
    }

    /// Whether a vertex does not move from where the start has it.
    pub(super) fn is_fixed(&self, i: usize) -> bool {
        self.fixed[i] || self.stands.as_ref().is_some_and(|stands| stands[i])
    }
}

/// A stage in the numbers of a part.
pub(super) struct Local {
    ids: Vec<u32>,
    mass: Vec<f64>,
    x_t0: Vec<World3>,
    base: Vec<World3>,
    p: Vec<World3>,
    guess: Vec<World3>,
    fixed: Vec<bool>,
    /// Of these, those that not even what keeps things apart may move.
    pinned: Vec<bool>,
    /// Absent where vertices stand or are free.
    conjugates: Vec<Conjugate>,
    target: Vec<World3>,
    starts: [Vec<World3>; 2],
}

pub(super) struct Solved {
    pub(super) x: Vec<World3>,
    pub(super) gradient: Vec<World3>,
    pub(super) is_solved: bool,
    /// Vertices of the whole whose way impacts bent.
    pub(super) bent: Vec<u32>,
    pub(super) report: SolveReport,
}

impl Local {
    pub(super) fn new(
        whole: &WholeStage<'_>,
        ids: Vec<u32>,
        answers: &dyn Fn(usize) -> bool,
    ) -> Local {
        let &StageStart { x_t0, base, velocity, h, .. } = whole.start;
        let n = ids.len();
        let each = |of: &[World3]| ids.iter().map(|&i| of[i as usize]).collect::<Vec<_>>();
        let mut local = Local {
            mass: ids.iter().map(|&i| whole.cloth.m[i as usize]).collect(),
            x_t0: each(x_t0),
            base: each(base),
            p: each(whole.p),
            guess: Vec::with_capacity(n),
            starts: [each(whole.from), Vec::with_capacity(n)],
            fixed: Vec::with_capacity(n),
            pinned: Vec::with_capacity(n),
            conjugates: Vec::new(),
            target: Vec::with_capacity(n),
            ids,
        };
        for (k, &i) in local.ids.iter().enumerate() {
            let i = i as usize;
            let is_fixed = whole.is_fixed(i) || !answers(i);
            local.fixed.push(is_fixed);
            local.pinned.push(whole.fixed[i] || !answers(i) || is_for_ever(&whole.held[i]));
            let target = if is_fixed { local.starts[0][k] } else { whole.target(i) };
            local.target.push(target);
            let guess = whole.guess.as_ref().filter(|_| !is_fixed);
            local.starts[1].push(guess.map_or(target, |guess| guess[i]));
            if whole.stands.is_some() {
                continue;
            }
            let way = || whole.held[i].velocity(&(velocity[i] * local.mass[k])) * h;
            local.guess.push(if is_fixed { World3::zeros() } else { way() });
            let held = if is_fixed { for_ever(local.mass[k]) } else { whole.held[i] };
            local.conjugates.push(held.conjugate().expect("laws were checked before the stage"));
        }
        local
    }

    pub(super) fn stage(&self, h: f64) -> Stage<'_> {
        Stage { x_t0: &self.x_t0, base: &self.base, h }
    }

    pub(super) fn solve(
        &self,
        system: &mut System,
        solver: &mut dyn LinearSolver,
        settings: &NewtonSettings,
        whole: &WholeStage<'_>,
    ) -> Result<Solved, SolveError> {
        let &StageStart { h, time, .. } = whole.start;
        let restrained = || Restrained {
            base: &self.base,
            p: &self.p,
            guess: &self.guess,
            conjugates: &self.conjugates,
        };
        let inertia = Inertia {
            mass: &self.mass,
            target: &self.target,
            h,
            time,
            fixed: &self.fixed,
            pinned: &self.pinned,
            restrained: whole.stands.is_none().then(restrained),
        };
        let Minimum { x, p, bent, mut report } =
            minimise(system, solver, &inertia, &self.starts, settings)?;
        let is_solved = p.is_some();
        if whole.stands.is_some() {
            let n_free = self.fixed.iter().filter(|fixed| !**fixed).count();
            report.rest.solves += report.iterations;
            report.rest.unknowns += report.iterations * n_free;
        }
        let gradient = match p {
            // Forces that are linear in the displacements of the last iteration: with those at its end,
            // what is left of it would be a change of momentum that moved nothing.
            Some(p) => p.iter().zip(&self.p).map(|(end, start)| (start - end) / h).collect(),
            None => {
                let clock = Instant::now();
                let gradient = system.gradient_with_contact(&x);
                report.assembly_s += clock.elapsed().as_secs_f64();
                gradient
            }
        };
        let bent = bent.into_iter().map(|k| self.ids[k as usize]).collect();
        Ok(Solved { x, gradient, is_solved, bent, report })
    }
}

/// A particle that never moves.
fn for_ever(mass: f64) -> Held {
    let held = Held::new(Law::Ramp, mass, f64::INFINITY, f64::INFINITY);
    held.expect("masses of a cloth are positive")
}

/// What was found for a part, in the numbers of the whole.
pub(super) fn scattered(
    part: &Part,
    whole: &WholeStage<'_>,
    solved: Solved,
    pushed: Vec<u32>,
) -> Try {
    let mut x = whole.from.to_vec();
    let mut gradient = vec![World3::zeros(); x.len()];
    for (k, &i) in part.vertices().iter().enumerate() {
        x[i as usize] = solved.x[k];
        gradient[i as usize] = solved.gradient[k];
    }
    let Solved { is_solved, bent, report, .. } = solved;
    Try { x, gradient, is_solved, bent, report, pushed }
}

/// Refuses laws of which an implicit stage cannot find the minimum.
pub(super) fn check_laws(held: &[Held], time: f64) -> Result<(), SolveError> {
    let told = |source| SolveError::Restraint { time, source };
    for (particle, held) in held.iter().enumerate() {
        if held.law() == Law::Exact && !held.is_free() && held.p_r() < f64::INFINITY {
            return Err(told(arps::StepError::SecondKink { particle }));
        }
        held.conjugate().map_err(|cause| told(arps::StepError::NotConvex { particle, cause }))?;
    }
    Ok(())
}
