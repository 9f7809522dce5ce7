//! Thresholds chosen from an error that is acceptable.

use crate::Speed;
use crate::error::ThresholdError;
use crate::law::ramp_slope;

/// Thresholds for an acceptable error of position, and what they imply. Made by
/// [`Automatic::for_error`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Automatic {
    /// The policy.
    pub speed: Speed,
    /// The error that it keeps to (m).
    pub error: f64,
    /// The time over which it keeps to that (s).
    pub duration: f64,
    /// Greatest slope of the law: how much faster than p/m the effective velocity changes (1).
    pub slope: f64,
    /// Longest stable explicit step as a share of that without restraint (1).
    pub explicit_step: f64,
}

/// Ratio of the thresholds of speed, √20: nearer and the slope grows, farther and particles lag
/// longer.
const RATIO: f64 = 4.472_135_954_999_579;

impl Automatic {
    /// Speeds below which particles may rest so that restraint moves them by at most `error` (m) over
    /// `duration` (s): v_r = error/duration, with v_f = √20 v_r and the default law.
    ///
    /// With that law the effective velocity differs from p/m by at most v_r: by ‖p‖/m at rest, less
    /// and less through the transition, by nothing above. So
    ///
    /// - a particle under forces that do not depend on its position is off by at most v_r t after a
    ///   time t;
    /// - in a system of linear springs, whatever their stiffness, so is the mass-weighted root mean
    ///   square over the particles. Deviations obey δq̇ = M⁻¹ δp + e and δṗ = −K δq with ‖e_i‖ ≤ v_r,
    ///   so in mass-weighted coordinates δq(t) = ∫ cos(Ω (t − s)) e(s) ds, and the cosine of a symmetric
    ///   Ω makes nothing longer.
    ///
    /// Both are bounds for the worst case, reached by a particle that drifts at v_r for all the time;
    /// as only the time below v_f counts, errors are mostly much smaller. Beyond that, where trajectories
    /// that start together part by themselves (buckling, impacts, fluids), no thresholds bound the
    /// distance: there v_r t is what restraint adds before it is amplified.
    ///
    /// # Errors
    /// An error that is negative or not a number (infinite is allowed: all may rest), or a duration
    /// that is not positive and finite.
    pub fn for_error(error: f64, duration: f64) -> Result<Automatic, ThresholdError> {
        if error.is_nan() || error < 0.0 {
            return Err(ThresholdError::Value { which: "error", value: error, unit: "m" });
        }
        if !(duration > 0.0 && duration < f64::INFINITY) {
            return Err(ThresholdError::Duration { duration });
        }
        let (v_r, v_f) = (error / duration, RATIO * (error / duration));
        let speed = Speed::new(v_r, v_f)?;
        let slope = if v_r > 0.0 { ramp_slope(1.0, RATIO) } else { 1.0 };
        Ok(Automatic { speed, error, duration, slope, explicit_step: 1.0 / slope.sqrt() })
    }
}
