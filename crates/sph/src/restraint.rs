//! How a fluid treats particles that a policy restrains.

use crate::settings::{FluidError, FluidSettings};

/// What a restrained fluid leaves undone, and when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestraintSettings {
    /// Time constant with which resting particles lose the momentum that they have gathered (s). It
    /// acts as static friction and gives up the conservation of momentum. Without it, particles that
    /// have stopped keep a momentum near the threshold and wake at the least disturbance.
    pub bleeding: Option<f64>,
    /// A particle with a smaller effective speed than this does not move (m/s): the modified criterion
    /// of Manteaux2013 §4.2. Only drag that vanishes with the effective velocity needs it.
    pub inactivity: f64,
    /// A change of pressure up to this leaves accelerations as they are (Pa).
    pub pressure_tolerance: f64,
    /// Everything is computed anew where more than this part of the particles moves (1), or fewer that are
    /// next to nearly all others. Zero: always; one: never.
    pub sweep_above: f64,
    /// In every how many steps a particle that rests gets its acceleration (1), if little moves; what moves
    /// gets its in every step. Above 1 the two particles of a pair get opposite forces on average only.
    pub force_interval: u32,
}

impl RestraintSettings {
    /// Settings for a fluid: no bleeding, no inactivity of what moves, and as tolerance a hundredth of
    /// the pressure under a layer of particles.
    pub fn of(settings: &FluidSettings) -> Self {
        let layer = settings.rest_density * settings.gravity.norm() * settings.spacing;
        RestraintSettings {
            bleeding: None,
            inactivity: 0.0,
            pressure_tolerance: 0.01 * layer,
            sweep_above: 0.4,
            force_interval: 1,
        }
    }

    /// Looks for values out of range.
    pub(crate) fn check(&self) -> Result<(), FluidError> {
        let check = |name, value: f64, holds: bool, wanted| match holds {
            true => Ok(()),
            false => Err(FluidError::OutOfRange { name, value, wanted }),
        };
        let bleeding = self.bleeding.unwrap_or(1.0);
        check("bleeding", bleeding, bleeding > 0.0, "positive")?;
        check("inactivity", self.inactivity, self.inactivity >= 0.0, "0 or more")?;
        let tolerance = self.pressure_tolerance;
        check("pressure_tolerance", tolerance, tolerance >= 0.0, "0 or more")?;
        let part = self.sweep_above;
        let interval = self.force_interval;
        check("force_interval", interval.into(), interval >= 1, "1 or more")?;
        check("sweep_above", part, (0.0..=1.0).contains(&part), "from 0 to 1")
    }
}
