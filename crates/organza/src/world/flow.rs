//! The fluid's part of a frame.

use super::{StepError, World};
use crate::report::{FluidSummary, Seconds};
use std::time::Instant;

impl World {
    /// Lets a frame's time go by for the fluid.
    pub(super) fn move_fluid(
        &mut self,
        frame: u64,
        seconds: &mut Seconds,
    ) -> Result<Option<FluidSummary>, StepError> {
        let Some(water) = &mut self.fluid else { return Ok(None) };
        let clock = Instant::now();
        let done = water.advance(self.frame_s);
        let done = done.map_err(|source| StepError::Fluid { frame, source })?;
        seconds.fluid = clock.elapsed().as_secs_f64();
        Ok(Some(water.summary(&done, self.frame_s)))
    }
}
