//! SDIRK2: second order, L-stable, two implicit stages (Alexander1977).
//!
//! With γ = 1 − 1/√2 both stages are implicit Euler steps of length γh:
//!
//!   stage 1: X₁ = x₀ + γh V₁,                    M (V₁ − v₀) = γh f(X₁)
//!   stage 2: X₂ = x₀ + (1 − γ)h V₁ + γh V₂,      M (V₂ − v₀ − (1 − γ)h a₁) = γh f(X₂)
//!
//! with a₁ = (V₁ − v₀)/(γh), and (X₂, V₂) is the new state. On a linear oscillator it has the
//! stability function of TR-BDF2 with γ = 2 − √2: waves it can resolve keep their energy to second
//! order, and what it cannot resolve is damped out at once. Unlike TR-BDF2 it never evaluates the
//! forces of the old state, which remeshing or a new contact may just have thrown off balance, and
//! unlike BDF2 it carries no history across them.

use super::rise::{StepEnd, take_back};
use super::{StageEnd, StageStart, Step, TimeIntegrator, solve_stage};
use crate::solve_report::{NewtonSettings, SolveError, SolveReport};
use crate::solver::LinearSolver;
use crate::system::{Constraints, System};
use mesh_core::{ClothState, World3};

/// The second-order integrator.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sdirk2;

const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

impl TimeIntegrator for Sdirk2 {
    fn stage(&self, h: f64) -> f64 {
        GAMMA * h
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
        let (h_stage, h_rest) = (self.stage(h), (1.0 - GAMMA) * h);
        let stages = [time + h_stage, time + h];
        if let Some(report) = system.sleeps(constraints, Step { time, h }, &stages) {
            return Ok(report);
        }
        system.settle(cloth, time);
        let start = StageStart {
            x_t0: &cloth.x,
            base: &cloth.x,
            velocity: &cloth.v,
            h: h_stage,
            time_t0: time,
            time: time + h_stage,
            constraints: constraints(time + h_stage),
        };
        let StageEnd { x: x_1, v: v_1, mut bent, mut report } =
            solve_stage(cloth, system, solver, settings, &start)?;

        let moved = cloth.x.iter().zip(&x_1);
        let base: Vec<World3> = moved.map(|(x, x_1)| x + (x_1 - x) / h_stage * h_rest).collect();
        let free: Vec<World3> = cloth
            .v
            .iter()
            .zip(&v_1)
            .map(|(v_0, v_1)| v_0 + (v_1 - v_0) * (h_rest / h_stage))
            .collect();
        let held = constraints(time + h);
        let fixed: Vec<usize> = held.fixed.iter().map(|&(i, _)| i as usize).collect();
        let start = StageStart {
            x_t0: &x_1,
            base: &base,
            velocity: &free,
            h: h_stage,
            time_t0: time + h_stage,
            time: time + h,
            constraints: held,
        };
        let StageEnd { x: x_2, v: mut v_2, bent: more, report: second } =
            solve_stage(cloth, system, solver, settings, &start)?;
        report.add(&second);

        for i in fixed {
            // The stages do not apply to a prescribed path: its mean velocity does.
            v_2[i] = (x_2[i] - cloth.x[i]) / h;
        }
        bent.extend(more);
        bent.sort_unstable();
        bent.dedup();
        let end = StepEnd { x: &x_2, v: &mut v_2, bent: &bent };
        take_back(system, cloth, end, constraints, Step { time, h })?;
        cloth.x = x_2;
        let before = std::mem::replace(&mut cloth.v, v_2);
        system.put_to_rest(cloth, &before, Step { time, h });
        Ok(report)
    }
}
