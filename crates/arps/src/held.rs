//! The restrained kinetic energy of one particle.

use crate::error::{NotConvex, ThresholdError};
use crate::law::{Law, Profile, profile};
use crate::{Conjugate, Matrix3, Vector3};

/// What a particle does with its momentum at the moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Motion {
    /// It stands still.
    Rest,
    /// It moves, but otherwise than p/m says.
    Transition,
    /// It moves with p/m.
    Full,
}

/// The kinetic energy T(p) = φ(‖p‖)/m of a restrained particle: the answer of a
/// [`Restraint`](crate::Restraint).
///
/// Four numbers, without thresholds out of order: every function of it is finite for a finite
/// momentum. Momenta are in kg m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    law: Law,
    mass: f64,
    p_r: f64,
    p_f: f64,
}

impl Held {
    /// A particle of some mass (kg) that rests up to the momentum norm `p_r` and has full dynamics
    /// from `p_f` (kg m/s) on.
    ///
    /// Limits: `p_r` = 0 is no restraint (but for `Smooth` and the splines, whose transition then
    /// begins at 0; with `p_f` = 0 as well it is none for them too). An infinite `p_r` is rest for
    /// ever. With an infinite `p_f` alone, `Ramp` and `Exact` are `Soft`.
    ///
    /// # Errors
    /// Thresholds that are negative, not numbers, inverted, or too close for the law (equal ones
    /// above 0; `Exact` needs `p_f` > 2 `p_r`; `Soft` does not look at `p_f`); an infinite `p_f` with
    /// `Smooth` or a spline; a mass that is not positive and finite.
    pub fn new(law: Law, mass: f64, p_r: f64, p_f: f64) -> Result<Held, ThresholdError> {
        if !(mass > 0.0 && mass < f64::INFINITY) {
            return Err(ThresholdError::Mass { mass });
        }
        check(law, p_r, p_f, [p_r, p_f], "kg m/s")?;
        Ok(Held::checked(law, mass, p_r, p_f))
    }

    /// As [`Held::new`] with thresholds that were [`check`]ed, here or in other units; brings the
    /// limits into their form.
    #[inline]
    pub(crate) fn checked(law: Law, mass: f64, p_r: f64, p_f: f64) -> Held {
        let (law, p_f) = match law {
            Law::Ramp | Law::Soft | Law::Exact if p_r == 0.0 => (law, 0.0),
            Law::Ramp | Law::Exact if p_f == f64::INFINITY => (Law::Soft, p_f),
            Law::Soft => (law, f64::INFINITY),
            _ => (law, p_f),
        };
        Held { law, mass, p_r, p_f }
    }

    /// A particle of some mass (kg) without restraint: T = ‖p‖²/2m, and its velocity is p/m to the
    /// bit.
    #[inline]
    pub fn free(mass: f64) -> Held {
        Held { law: Law::Ramp, mass, p_r: 0.0, p_f: 0.0 }
    }

    /// The same particle with both thresholds multiplied by a factor (1): 0 is no restraint,
    /// infinity is rest for ever. A factor that is negative or not a number restrains nothing, the
    /// safe side for a policy that cannot tell.
    #[inline]
    pub fn scaled(&self, factor: f64) -> Held {
        if factor.is_nan() || factor <= 0.0 || self.is_free() {
            return Held::free(self.mass);
        }
        let (p_r, p_f) = (factor * self.p_r, factor * self.p_f);
        let for_ever = p_r == f64::INFINITY || (p_f == f64::INFINITY && self.p_f < p_f);
        let p_r = if for_ever { f64::INFINITY } else { p_r };
        Held { p_r, p_f, ..*self }
    }

    /// The law.
    pub fn law(&self) -> Law {
        self.law
    }

    /// Mass (kg).
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Momentum norm up to which the particle rests (kg m/s).
    pub fn p_r(&self) -> f64 {
        self.p_r
    }

    /// Momentum norm from which on it has full dynamics (kg m/s).
    pub fn p_f(&self) -> f64 {
        self.p_f
    }

    /// True if no momentum is restrained.
    #[inline]
    pub fn is_free(&self) -> bool {
        self.p_f == 0.0
    }

    /// What the particle does with a momentum.
    #[inline]
    pub fn motion(&self, p: &Vector3) -> Motion {
        let square = p.norm_squared();
        if square >= self.p_f * self.p_f {
            Motion::Full
        } else if square <= self.p_r * self.p_r {
            Motion::Rest
        } else {
            Motion::Transition
        }
    }

    /// Restrained kinetic energy T (J).
    pub fn kinetic_energy(&self, p: &Vector3) -> f64 {
        self.profile(p.norm()).value / self.mass
    }

    /// Effective velocity q̇ = ∂T/∂p (m/s): Manteaux2013 Eq. (4) for the splines.
    #[inline]
    pub fn velocity(&self, p: &Vector3) -> Vector3 {
        match self.motion(p) {
            Motion::Full => p / self.mass,
            Motion::Rest => Vector3::zeros(),
            Motion::Transition => {
                let r = p.norm();
                p * (self.profile(r).carried / (r * self.mass))
            }
        }
    }

    /// s = m q̇, the momentum that the effective velocity carries (kg m/s): Manteaux2013 Eq. (11).
    pub fn s(&self, p: &Vector3) -> Vector3 {
        match self.motion(p) {
            Motion::Full => *p,
            Motion::Rest => Vector3::zeros(),
            Motion::Transition => {
                let r = p.norm();
                p * (self.profile(r).carried / r)
            }
        }
    }

    /// R = m ∂q̇/∂p, symmetric (1): φ″ along the momentum, φ′/r across it.
    ///
    /// For the splines this is (1 − ρ) I − p ∇ρᵀ − ∇ρ pᵀ − ½ ‖p‖² ∇²ρ. Manteaux2013 Eq. (10) has
    /// p pᵀ in place of ‖p‖² in the last term, which only agrees in one dimension.
    pub fn r_matrix(&self, p: &Vector3) -> Matrix3 {
        match self.motion(p) {
            Motion::Full => Matrix3::identity(),
            Motion::Rest => Matrix3::zeros(),
            Motion::Transition => {
                let r = p.norm();
                let Profile { carried, slope, .. } = self.profile(r);
                radial_and_across(&(p / r), slope, carried / r)
            }
        }
    }

    /// φ as a function of the momentum norm, T = φ/m (kg² m²/s²).
    pub fn phi(&self, r: f64) -> f64 {
        self.profile(r).value
    }

    /// φ′: mass times effective speed (kg m/s).
    pub fn dphi(&self, r: f64) -> f64 {
        self.profile(r).carried
    }

    /// φ″ (1). Where it jumps, at the ends of a transition, the value outside.
    pub fn ddphi(&self, r: f64) -> f64 {
        self.profile(r).slope
    }

    /// ρ = 1 − 2φ/r², the share of the kinetic energy that is held back (1): the restraining
    /// function of Manteaux2013 Eq. (3) for the splines. The other laws but `Exact` keep a constant
    /// energy back above p_f, so there it tends to 0 without getting there.
    pub fn rho(&self, r: f64) -> f64 {
        if r <= self.p_r { 1.0 } else { 1.0 - 2.0 * self.phi(r) / (r * r) }
    }

    /// The conjugate of the kinetic energy, for implicit steps.
    ///
    /// # Errors
    /// A law whose kinetic energy is not convex, unless it restrains nothing.
    pub fn conjugate(&self) -> Result<Conjugate, NotConvex> {
        if self.law.is_convex() || self.is_free() {
            Ok(Conjugate::of(*self))
        } else {
            Err(NotConvex { law: self.law })
        }
    }

    #[inline]
    pub(crate) fn profile(&self, r: f64) -> Profile {
        profile(self.law, r, self.p_r, self.p_f)
    }
}

/// `along` n nᵀ + `across` (I − n nᵀ) for a unit vector n.
pub(crate) fn radial_and_across(n: &Vector3, along: f64, across: f64) -> Matrix3 {
    n * n.transpose() * (along - across) + Matrix3::from_diagonal_element(across)
}

/// Checks thresholds given as momenta for one mass, and as they were `told`, for the message.
pub(crate) fn check(
    law: Law,
    p_r: f64,
    p_f: f64,
    [rest, full]: [f64; 2],
    unit: &'static str,
) -> Result<(), ThresholdError> {
    if rest.is_nan() || rest < 0.0 {
        return Err(ThresholdError::Value { which: "rest", value: rest, unit });
    }
    if law == Law::Soft {
        return Ok(());
    }
    if full.is_nan() || full < 0.0 {
        return Err(ThresholdError::Value { which: "full", value: full, unit });
    }
    if rest == f64::INFINITY && full == f64::INFINITY {
        return Ok(());
    }
    if full < rest {
        return Err(ThresholdError::Inverted { rest, full, unit });
    }
    let ratio = if law == Law::Exact { 2.0 } else { 1.0 };
    if full > 0.0 && p_f <= ratio * p_r {
        return Err(ThresholdError::TooClose { law, rest, full, unit, ratio });
    }
    let ends = matches!(law, Law::Smooth | Law::Spline | Law::MomentumSpline);
    if full == f64::INFINITY && ends {
        return Err(ThresholdError::NeverFull { law });
    }
    Ok(())
}
