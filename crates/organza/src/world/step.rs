//! A step of the cloth, in halves where it fails.

use super::{MAX_HALVINGS, Prepared, RISE_DEPTH, StepError, World, YIELD_DEPTH};
use crate::report::Seconds;
use cloth_dynamics::{SolveError, SolveReport, Step};
use std::time::Instant;

impl World {
    /// One step; a failing one is redone in halves.
    pub(super) fn step(
        &mut self,
        step: Step,
        frame: u64,
        depth: u32,
        solve: &mut SolveReport,
        retries: &mut u32,
        seconds: &mut Seconds,
    ) -> Result<(), StepError> {
        let clock = Instant::now();
        self.bring_obstacles(step, frame)?;
        self.prepare().map_err(|e| StepError::TooLarge { frame, message: e.to_string() })?;
        seconds.build += clock.elapsed().as_secs_f64();
        let Prepared { system, names } = self.prepared.as_mut().expect("prepare() has run");
        self.handles.take_hold(&self.cloth, names, step.time);
        system.accept_rise(depth >= RISE_DEPTH);
        let constraints = |time: f64| self.handles.constraints(names, time);
        let dry = (!self.wet.is_empty()).then(|| self.cloth.m.clone());
        for (mass, wet) in self.cloth.m.iter_mut().zip(&self.wet) {
            *mass += wet;
        }
        let done = self.integrator.advance(
            &mut self.cloth,
            system,
            self.solver.as_mut(),
            &constraints,
            &self.newton,
            step,
        );
        if let Some(dry) = dry {
            self.cloth.m = dry;
        }
        match done {
            Ok(report) => {
                solve.add(&report);
                Ok(())
            }
            Err(source) => {
                if self.tangled.matters() {
                    // The contact may have found it free in the meantime.
                    self.prepared = None;
                }
                if let SolveError::Caught { place, .. } = source
                    && depth >= YIELD_DEPTH
                    && self.yield_at(place)
                {
                    *retries += 1;
                    return self.step(step, frame, depth, solve, retries, seconds);
                }
                if depth == MAX_HALVINGS {
                    return Err(StepError::Solve { frame, time: step.time, h: step.h, source });
                }
                *retries += 1;
                let h = 0.5 * step.h;
                for time in [step.time, step.time + h] {
                    self.step(Step { time, h }, frame, depth + 1, solve, retries, seconds)?;
                }
                Ok(())
            }
        }
    }
}
