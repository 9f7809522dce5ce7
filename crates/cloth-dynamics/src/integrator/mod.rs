//! Time integrators: implicit Euler, and a second-order one that damps the stiff end as strongly.

mod implicit_euler;
mod rise;
mod sdirk2;

pub use implicit_euler::ImplicitEuler;
pub use sdirk2::Sdirk2;

use crate::force::Stage;
use crate::newton::{Inertia, Minimum, minimise};
use crate::solve_report::{NewtonSettings, SolveError, SolveReport};
use crate::solver::LinearSolver;
use crate::system::{Constraints, System};
use mesh_core::{ClothState, World3};
use std::time::Instant;

/// One step of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Time at the start (s).
    pub time: f64,
    /// Length (s).
    pub h: f64,
}

/// A rule that advances cloth by one step. A step is a transaction: on error the cloth is as before.
pub trait TimeIntegrator: Send {
    /// Length of the implicit stages of a step of `h` (s).
    fn stage(&self, h: f64) -> f64;

    /// Advances positions and velocities from `step.time` by `step.h`; `constraints` tells where
    /// vertices are held at a given time (s).
    ///
    /// # Errors
    /// See [`SolveError`].
    fn advance(
        &mut self,
        cloth: &mut ClothState,
        system: &mut System,
        solver: &mut dyn LinearSolver,
        constraints: &dyn Fn(f64) -> Constraints,
        settings: &NewtonSettings,
        step: Step,
    ) -> Result<SolveReport, SolveError>;
}

/// Everything an implicit stage starts from.
pub(crate) struct StageStart<'a> {
    pub(crate) x_t0: &'a [World3],
    /// Velocity is (x − base)/h.
    pub(crate) base: &'a [World3],
    /// Velocity (m/s) that the stage would have without forces; of restrained vertices, momentum over
    /// mass.
    pub(crate) velocity: &'a [World3],
    pub(crate) h: f64,
    /// When the cloth is at `x_t0` (s).
    pub(crate) time_t0: f64,
    /// End of the stage (s).
    pub(crate) time: f64,
    pub(crate) constraints: Constraints,
}

/// What a stage leads to.
pub(crate) struct StageEnd {
    /// Positions (m).
    pub(crate) x: Vec<World3>,
    /// Velocities (m/s); of restrained vertices, momentum over mass.
    pub(crate) v: Vec<World3>,
    /// Vertices whose way something was in.
    pub(crate) bent: Vec<u32>,
    pub(crate) report: SolveReport,
}

/// Solves one stage.
fn solve_stage(
    cloth: &ClothState,
    system: &mut System,
    solver: &mut dyn LinearSolver,
    settings: &NewtonSettings,
    start: &StageStart<'_>,
) -> Result<StageEnd, SolveError> {
    let Some(mut resting) = system.resting.take() else {
        return plain_stage(cloth, system, solver, settings, start);
    };
    let end = resting.stage(cloth, system, solver, settings, start);
    if end.is_err() {
        // The next try knows nothing of this one.
        resting.wake_all();
    }
    system.resting = Some(resting);
    end
}

/// Solves one stage in which nothing is restrained.
pub(crate) fn plain_stage(
    cloth: &ClothState,
    system: &mut System,
    solver: &mut dyn LinearSolver,
    settings: &NewtonSettings,
    start: &StageStart<'_>,
) -> Result<StageEnd, SolveError> {
    let &StageStart { x_t0, base, velocity, h, time_t0, time, ref constraints } = start;
    system.begin(Stage { x_t0, base, h });
    system.springs.springs.clone_from(&constraints.springs);
    let mut target: Vec<World3> = base.iter().zip(velocity).map(|(x, v)| x + v * h).collect();
    let mut resting = x_t0.to_vec();
    let mut fixed = vec![false; x_t0.len()];
    for &(i, x) in &constraints.fixed {
        let i = i as usize;
        fixed[i] = true;
        target[i] = x;
        resting[i] = x;
    }
    let starts = [resting, target.clone()];
    let clock = Instant::now();
    if let Some(contact) = &mut system.contact {
        contact.begin(Stage { x_t0, base, h }, [time_t0, time], &cloth.m, &target);
        system.make_room_for_contact()?;
    }
    let contact_s = clock.elapsed().as_secs_f64();
    let inertia = Inertia {
        mass: &cloth.m,
        target: &target,
        h,
        time,
        fixed: &fixed,
        pinned: &fixed,
        restrained: None,
    };
    let Minimum { x, bent, mut report, .. } =
        minimise(system, solver, &inertia, &starts, settings)?;
    report.contact_s += contact_s;
    let v = x.iter().zip(base).map(|(x, base)| (x - base) / h).collect();
    Ok(StageEnd { x, v, bent, report })
}
