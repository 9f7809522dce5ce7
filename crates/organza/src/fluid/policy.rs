//! The policies of restraint that a scene may ask for.

use crate::scene::format::{FLUID_MOST_M_PER_S, FluidRestraint, RestraintLaw, RestraintPolicy};
use arps::{Automatic, Held, Kinetic, Law, Particle, Restraint, Speed, ThresholdError};
use sizing_view::{PixelThresholds, ViewRestraint};

/// A policy of a scene.
#[derive(Clone, Debug, PartialEq)]
pub enum Policy {
    /// By speed.
    Speed(Speed),
    /// By kinetic energy.
    Kinetic(Kinetic),
    /// By motion in the picture; the speeds of a pixel are by the lasting numbers of the particles.
    View(ViewRestraint),
}

impl Restraint for Policy {
    #[inline]
    fn at(&self, particle: &Particle) -> Held {
        match self {
            Policy::Speed(policy) => policy.at(particle),
            Policy::Kinetic(policy) => policy.at(particle),
            Policy::View(policy) => policy.at(particle),
        }
    }
}

/// What thresholds chosen by an error depend on of the scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    /// Simulated time (s).
    pub(crate) duration: f64,
    /// Time from frame to frame (s).
    pub(crate) frame_s: f64,
}

/// The policy that `restraint` describes. Thresholds that are not given are those of no restraint. One by
/// view restrains nothing before it has seen the particles.
///
/// # Errors
/// If the thresholds do not fit each other or the law.
pub(crate) fn of(restraint: &FluidRestraint, run: Run) -> Result<Policy, ThresholdError> {
    let law = match restraint.law {
        RestraintLaw::Ramp => Law::Ramp,
        RestraintLaw::Soft => Law::Soft,
        RestraintLaw::Exact => Law::Exact,
        RestraintLaw::Smooth => Law::Smooth,
        RestraintLaw::Spline => Law::Spline,
        RestraintLaw::MomentumSpline => Law::MomentumSpline,
    };
    let value = |number: Option<f64>| number.unwrap_or(0.0);
    let duration = restraint.duration_s.unwrap_or(run.duration);
    let most = restraint.most_m_per_s.unwrap_or(FLUID_MOST_M_PER_S);
    let view = |thresholds| Policy::View(ViewRestraint { thresholds, pixel_speeds: Vec::new() });
    Ok(match restraint.policy {
        RestraintPolicy::Speed => Policy::Speed(Speed::with_law(
            law,
            value(restraint.restrain_below_m_per_s),
            value(restraint.restore_above_m_per_s),
        )?),
        RestraintPolicy::Kinetic => Policy::Kinetic(Kinetic::with_law(
            law,
            value(restraint.restrain_below_j),
            value(restraint.restore_above_j),
        )?),
        RestraintPolicy::Automatic => {
            Policy::Speed(Automatic::for_error(value(restraint.error_m), duration)?.speed)
        }
        RestraintPolicy::View => view(PixelThresholds::new(
            law,
            value(restraint.restrain_below_px_per_frame),
            value(restraint.restore_above_px_per_frame),
            most,
        )?),
        RestraintPolicy::AutomaticView => {
            let frames = duration / run.frame_s;
            view(PixelThresholds::for_error(law, value(restraint.error_px), frames, most)?)
        }
    })
}
