//! Time integrators: implicit Euler, and a second-order one that damps the stiff end as strongly.

mod implicit_euler;
mod sdirk2;

pub use implicit_euler::ImplicitEuler;
pub use sdirk2::Sdirk2;

use crate::force::Stage;
use crate::newton::{Inertia, minimise};
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
struct StageStart<'a> {
    x_t0: &'a [World3],
    /// Velocity is (x − base)/h.
    base: &'a [World3],
    /// Velocity (m/s) that the stage would have without forces.
    velocity: &'a [World3],
    h: f64,
    /// When the cloth is at `x_t0` (s).
    time_t0: f64,
    /// End of the stage (s).
    time: f64,
    constraints: Constraints,
}

/// Solves one stage; returns the new positions.
fn solve_stage(
    cloth: &ClothState,
    system: &mut System,
    solver: &mut dyn LinearSolver,
    settings: &NewtonSettings,
    start: StageStart<'_>,
) -> Result<(Vec<World3>, SolveReport), SolveError> {
    let StageStart { x_t0, base, velocity, h, time_t0, time, constraints } = start;
    system.begin(Stage { x_t0, base, h });
    system.springs.springs = constraints.springs;
    let mut target: Vec<World3> = base.iter().zip(velocity).map(|(x, v)| x + v * h).collect();
    let mut resting = x_t0.to_vec();
    let mut fixed = vec![false; x_t0.len()];
    for (i, x) in constraints.fixed {
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
    let inertia = Inertia { mass: &cloth.m, target: &target, h, time, fixed: &fixed };
    let (x, mut report) = minimise(system, solver, &inertia, &starts, settings)?;
    report.contact_s += contact_s;
    Ok((x, report))
}
