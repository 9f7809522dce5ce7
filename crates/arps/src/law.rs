//! Restraining laws: how much of its momentum a particle carries.
//!
//! A law is a function φ of the momentum norm r = ‖p‖; the restrained kinetic energy is
//! T(p) = φ(r)/m. Here are φ and its first two derivatives in closed form. φ is 0 up to p_r, and
//! φ′(r) = r from p_f on (but for `Soft`, which never gets there).

/// How a particle passes from rest to full dynamics.
///
/// The effective velocity is φ′(r)/m along the momentum: zero for a norm r up to p_r, for most laws
/// p/m from p_f on. All but the two splines have a convex kinetic energy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Law {
    /// φ′ rises in a straight line from 0 at p_r to p_f at p_f: full dynamics above p_f with the
    /// smallest possible slope, p_f/(p_f − p_r). The default.
    #[default]
    Ramp,
    /// φ′ = r − p_r: the simplest. What moves lags by p_r for ever, and p_f is not used.
    Soft,
    /// φ′ rises to p_f on the way from p_r to p_f − p_r and stays there up to p_f: convex, and T is
    /// the full kinetic energy above p_f. Needs p_f > 2 p_r.
    Exact,
    /// Cubic Hermite version of `Ramp`: R is continuous.
    Smooth,
    /// T = (1 − ρ) r²/2m with ρ a quintic in the kinetic energy: the law of Manteaux2013 Eq. (3).
    /// Not convex for any thresholds.
    Spline,
    /// T = (1 − ρ) r²/2m with ρ a quintic in the momentum norm: Manteaux2013 §6.3. Not convex
    /// either, though less so.
    MomentumSpline,
}

impl Law {
    /// Every law.
    pub const ALL: [Law; 6] =
        [Law::Ramp, Law::Soft, Law::Exact, Law::Smooth, Law::Spline, Law::MomentumSpline];

    /// True if the kinetic energy is convex whatever the thresholds: what implicit steps need.
    pub fn is_convex(self) -> bool {
        !matches!(self, Law::Spline | Law::MomentumSpline)
    }
}

/// φ, φ′ and φ″ at one momentum norm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Profile {
    /// φ (kg² m²/s²).
    pub(crate) value: f64,
    /// φ′: mass times effective speed (kg m/s).
    pub(crate) carried: f64,
    /// φ″: radial eigenvalue of R (1).
    pub(crate) slope: f64,
}

const REST: Profile = Profile { value: 0.0, carried: 0.0, slope: 0.0 };

/// Slope of the straight part of `Ramp`.
pub(crate) fn ramp_slope(p_r: f64, p_f: f64) -> f64 {
    p_f / (p_f - p_r)
}

/// Slope of the rising part of `Exact`.
pub(crate) fn exact_slope(p_r: f64, p_f: f64) -> f64 {
    p_f / (p_f - 2.0 * p_r)
}

/// `Smooth` on its way: φ′ = a t² + b t³ for t = (r − p_r)/(p_f − p_r) in [0, 1].
pub(crate) fn smooth_cubic(p_r: f64, p_f: f64) -> (f64, f64) {
    let w = p_f - p_r;
    (3.0 * p_f - w, w - 2.0 * p_f)
}

/// φ and its derivatives. At the ends of the transition, where φ″ of some laws jumps, it is the
/// value outside.
pub(crate) fn profile(law: Law, r: f64, p_r: f64, p_f: f64) -> Profile {
    if r >= p_f {
        return Profile {
            value: value_at_full(law, p_r, p_f) + 0.5 * (r - p_f) * (r + p_f),
            carried: r,
            slope: 1.0,
        };
    }
    if r <= p_r {
        return REST;
    }
    let w = p_f - p_r;
    match law {
        Law::Ramp => straight(r - p_r, ramp_slope(p_r, p_f)),
        Law::Soft => straight(r - p_r, 1.0),
        Law::Exact if r < p_f - p_r => straight(r - p_r, exact_slope(p_r, p_f)),
        Law::Exact => {
            let level = 0.5 * p_f * (p_f - 2.0 * p_r) + p_f * (r - (p_f - p_r));
            Profile { value: level, carried: p_f, slope: 0.0 }
        }
        Law::Smooth => {
            let t = (r - p_r) / w;
            let (a, b) = smooth_cubic(p_r, p_f);
            Profile {
                value: w * t * t * t * (a / 3.0 + b * t / 4.0),
                carried: t * t * (a + b * t),
                slope: t * (2.0 * a + 3.0 * b * t) / w,
            }
        }
        Law::Spline => {
            let d = w * (p_f + p_r);
            let x = (r - p_r) * (r + p_r) / d;
            released(r, quintic(x), 2.0 * r / d, 2.0 / d)
        }
        Law::MomentumSpline => released(r, quintic((r - p_r) / w), 1.0 / w, 0.0),
    }
}

/// φ(p_f), so that φ has no jump there.
fn value_at_full(law: Law, p_r: f64, p_f: f64) -> f64 {
    let w = p_f - p_r;
    match law {
        Law::Ramp => 0.5 * p_f * w,
        Law::Smooth => w * (0.5 * p_f - w / 12.0),
        Law::Soft | Law::Exact | Law::Spline | Law::MomentumSpline => 0.5 * p_f * p_f,
    }
}

fn straight(above: f64, slope: f64) -> Profile {
    Profile { value: 0.5 * slope * above * above, carried: slope * above, slope }
}

/// 1 − ρ = 10 x³ − 15 x⁴ + 6 x⁵ and its two derivatives.
fn quintic(x: f64) -> [f64; 3] {
    let y = 1.0 - x;
    [
        x * x * x * (10.0 + x * (6.0 * x - 15.0)),
        30.0 * x * x * y * y,
        60.0 * x * y * (1.0 - 2.0 * x),
    ]
}

/// φ = (1 − ρ) r²/2 for 1 − ρ = s(x(r)), with x′ and x″ by r.
fn released(r: f64, [s, s_x, s_xx]: [f64; 3], x_r: f64, x_rr: f64) -> Profile {
    let s_r = s_x * x_r;
    let s_rr = s_xx * x_r * x_r + s_x * x_rr;
    Profile {
        value: 0.5 * s * r * r,
        carried: s * r + 0.5 * r * r * s_r,
        slope: s + 2.0 * r * s_r + 0.5 * r * r * s_rr,
    }
}
