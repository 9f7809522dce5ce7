//! Checks thresholds of rest and makes policies of them.

use super::super::check::At;
use super::super::data::Thresholds;
use super::super::format::{self, Law};
use super::super::limits;
use arps::{Automatic, Kinetic, Speed, ThresholdError};
use sizing_view::PixelThresholds;

/// What thresholds depend on of the scene.
#[derive(Clone, Copy)]
pub(super) struct Run {
    /// Simulated time (s).
    pub(super) duration: f64,
    /// Frames of it.
    pub(super) frames: u32,
    /// Whether there is a camera.
    pub(super) has_camera: bool,
}

/// The policy of a key `restraint`; none if it was complained of.
pub(super) fn thresholds(
    thresholds: format::Thresholds,
    law: Law,
    run: Run,
    at: &At<'_>,
) -> Option<Thresholds> {
    let law = match law {
        Law::Ramp => arps::Law::Ramp,
        Law::Soft => arps::Law::Soft,
        Law::Smooth => arps::Law::Smooth,
    };
    let at = at.key("thresholds");
    let made: Result<Thresholds, ThresholdError> = match thresholds {
        format::Thresholds::None => Ok(Thresholds::None),
        format::Thresholds::Speed { rest_m_per_s, full_m_per_s } => {
            let at = at.key("speed");
            at.key("rest_m_per_s").not_negative(rest_m_per_s, limits::MAX_SPEED_M_PER_S, "m/s");
            at.key("full_m_per_s").not_negative(full_m_per_s, limits::MAX_SPEED_M_PER_S, "m/s");
            Speed::with_law(law, rest_m_per_s, full_m_per_s).map(Thresholds::Speed)
        }
        format::Thresholds::Kinetic { rest_j, full_j } => {
            let at = at.key("kinetic");
            at.key("rest_j").not_negative(rest_j, limits::MAX_ENERGY_J, "J");
            at.key("full_j").not_negative(full_j, limits::MAX_ENERGY_J, "J");
            Kinetic::with_law(law, rest_j, full_j).map(Thresholds::Kinetic)
        }
        format::Thresholds::Automatic { error_m } => {
            at.key("automatic.error_m").not_negative(error_m, limits::MAX_COORDINATE_M, "m");
            let found = Automatic::for_error(error_m, run.duration);
            found.and_then(|found| {
                let (v_r, v_f) = (found.speed.v_r(), found.speed.v_f());
                Speed::with_law(law, v_r, v_f).map(Thresholds::Speed)
            })
        }
        format::Thresholds::View { rest_px_per_frame, full_px_per_frame, most_m_per_s } => {
            let at = at.key("view");
            let limit = limits::MAX_PICTURE_PX.into();
            at.key("rest_px_per_frame").not_negative(rest_px_per_frame, limit, "pixels");
            at.key("full_px_per_frame").not_negative(full_px_per_frame, limit, "pixels");
            at.key("most_m_per_s").not_negative(most_m_per_s, limits::MAX_SPEED_M_PER_S, "m/s");
            let found =
                PixelThresholds::new(law, rest_px_per_frame, full_px_per_frame, most_m_per_s);
            found.map(Thresholds::View)
        }
        format::Thresholds::AutomaticView { error_px } => {
            let limit = limits::MAX_PICTURE_PX.into();
            at.key("automatic-view.error_px").not_negative(error_px, limit, "pixels");
            let frames = f64::from(run.frames);
            PixelThresholds::for_error(law, error_px, frames, format::MOST_M_PER_S)
                .map(Thresholds::View)
        }
    };
    if matches!(made, Ok(Thresholds::View(_))) && !run.has_camera {
        at.complain("the scene has no `camera` to look through");
        return None;
    }
    // What is wrong with one value alone has been said.
    let told = |error: &ThresholdError| !matches!(error, ThresholdError::Value { .. });
    made.inspect_err(|error| {
        if told(error) {
            at.complain(error.to_string());
        }
    })
    .ok()
}

/// Checks the time constant of bleeding.
pub(super) fn check_bleeding(bleeding: Option<f64>, at: &At<'_>) {
    if let Some(tau) = bleeding {
        at.key("bleeding_s").positive(tau, limits::MAX_TIME_S, "s");
    }
}
