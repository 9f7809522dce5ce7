//! Implicit Euler: first order, strongly damped.

use super::rise::{StepEnd, take_back};
use super::{StageEnd, StageStart, Step, TimeIntegrator, solve_stage};
use crate::solve_report::{NewtonSettings, SolveError, SolveReport};
use crate::solver::LinearSolver;
use crate::system::{Constraints, System};
use mesh_core::ClothState;

/// x₁ = x₀ + h v₁, M (v₁ − v₀) = h f(x₁, v₁).
#[derive(Clone, Copy, Debug, Default)]
pub struct ImplicitEuler;

impl TimeIntegrator for ImplicitEuler {
    fn stage(&self, h: f64) -> f64 {
        h
    }

    fn advance(
        &mut self,
        cloth: &mut ClothState,
        system: &mut System,
        solver: &mut dyn LinearSolver,
        constraints: &dyn Fn(f64) -> Constraints,
        settings: &NewtonSettings,
        Step { time, h }: Step,
    ) -> Result<SolveReport, SolveError> {
        let (time_t0, time) = (time, time + h);
        let step = Step { time: time_t0, h };
        if let Some(report) = system.sleeps(constraints, step, &[time]) {
            return Ok(report);
        }
        system.settle(cloth, time_t0);
        let start = StageStart {
            x_t0: &cloth.x,
            base: &cloth.x,
            velocity: &cloth.v,
            h,
            time_t0,
            time,
            constraints: constraints(time),
        };
        let StageEnd { x, mut v, bent, report } =
            solve_stage(cloth, system, solver, settings, &start)?;
        take_back(system, cloth, StepEnd { x: &x, v: &mut v, bent: &bent }, constraints, step)?;
        cloth.x = x;
        let before = std::mem::replace(&mut cloth.v, v);
        system.put_to_rest(cloth, &before, step);
        Ok(report)
    }
}
