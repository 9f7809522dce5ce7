//! The fluid's part of a frame.

use super::{StepError, World};
use crate::report::Seconds;
use cloth_dynamics::{SolveReport, Step};
use sph::{FluidError, StepReport};
use std::time::Instant;

impl World {
    /// Lets a frame's time go by for the fluid.
    pub(super) fn move_fluid(
        &mut self,
        frame: u64,
        seconds: &mut Seconds,
    ) -> Result<Option<StepReport>, StepError> {
        let Some(water) = &mut self.fluid else { return Ok(None) };
        let clock = Instant::now();
        let done = water.advance(self.frame_s);
        let done = done.map_err(|source| StepError::Fluid { frame, source })?;
        seconds.fluid = clock.elapsed().as_secs_f64();
        Ok(Some(done))
    }

    /// A step of cloth and of the fluid that meets it, or meets bodies that move.
    pub(super) fn step_together(
        &mut self,
        step: Step,
        frame: u64,
        solve: &mut SolveReport,
        retries: &mut u32,
        seconds: &mut Seconds,
    ) -> Result<(), StepError> {
        let told = |source: FluidError| StepError::Fluid { frame, source };
        let clock = Instant::now();
        let Some(water) = &mut self.fluid else { return Ok(()) };
        let Some(meeting) = &mut water.meeting else { return Ok(()) };
        let start = self.cloth.x.clone();
        let scene = (&self.garments[..], &self.obstacles[..]);
        // Of what sleeps the velocity is known only once it is told.
        if let Some(prepared) = &self.prepared {
            prepared.system.settle(&mut self.cloth, step.time);
        }
        let load =
            meeting.load(&mut water.fluid, &mut self.cloth, scene, step.time).map_err(told)?;
        let mut spent = clock.elapsed();
        if !self.garments.is_empty() {
            if let (Some(load), Some(prepared)) = (&load, &mut self.prepared) {
                prepared.system.wake(load.wet(&self.cloth), step.time);
            }
            self.wet = load.as_ref().map(|load| load.masses.clone()).unwrap_or_default();
            let done = self.step(step, frame, 0, solve, retries, seconds);
            self.wet = Vec::new();
            done?;
        }
        let clock = Instant::now();
        let Some(water) = &mut self.fluid else { return Ok(()) };
        let Some(meeting) = &mut water.meeting else { return Ok(()) };
        if let Some(load) = &load {
            meeting.carry(&mut water.fluid, &self.cloth, load).map_err(told)?;
        }
        let cloth = (&self.cloth, &start[..]);
        let times = (step.time, step.h);
        meeting.flow(&mut water.fluid, cloth, &self.obstacles, times).map_err(told)?;
        spent += clock.elapsed();
        seconds.fluid += spent.as_secs_f64();
        Ok(())
    }

    /// What the fluid did in a frame of steps together.
    pub(super) fn fluid_among_others(&mut self) -> Option<StepReport> {
        let water = self.fluid.as_mut()?;
        let done = water.meeting.as_mut()?.report();
        if done.squeezed > 0 {
            self.tangled.warnings.push(format!(
                "fluid had no room between surfaces that closed on it ({} times): it may have come \
                 through",
                done.squeezed
            ));
        }
        Some(done)
    }
}
