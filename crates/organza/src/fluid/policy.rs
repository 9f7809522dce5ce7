//! The policies of restraint that a scene may ask for.

use crate::scene::format::{FluidRestraint, RestraintLaw, RestraintPolicy};
use arps::{Automatic, Held, Kinetic, Law, Particle, Restraint, Speed, ThresholdError};

/// A policy of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Policy {
    /// By speed.
    Speed(Speed),
    /// By kinetic energy.
    Kinetic(Kinetic),
}

impl Restraint for Policy {
    #[inline]
    fn at(&self, particle: &Particle) -> Held {
        match self {
            Policy::Speed(policy) => policy.at(particle),
            Policy::Kinetic(policy) => policy.at(particle),
        }
    }
}

/// The policy that `restraint` describes. Thresholds that are not given are those of no restraint.
///
/// # Errors
/// If the thresholds do not fit each other or the law.
pub(crate) fn of(restraint: &FluidRestraint) -> Result<Policy, ThresholdError> {
    let law = match restraint.law {
        RestraintLaw::Ramp => Law::Ramp,
        RestraintLaw::Soft => Law::Soft,
        RestraintLaw::Exact => Law::Exact,
        RestraintLaw::Smooth => Law::Smooth,
        RestraintLaw::Spline => Law::Spline,
        RestraintLaw::MomentumSpline => Law::MomentumSpline,
    };
    let value = |number: Option<f64>| number.unwrap_or(0.0);
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
        RestraintPolicy::Automatic => Policy::Speed(
            Automatic::for_error(value(restraint.error_m), value(restraint.duration_s))?.speed,
        ),
    })
}
