//! The conjugate of a restrained kinetic energy: from velocities back to momenta.

use crate::held::{Held, radial_and_across};
use crate::law::{Law, exact_slope, ramp_slope, smooth_cubic};
use crate::{Matrix3, Vector3};

/// ψ = T*, the conjugate of a convex kinetic energy: a function of the effective velocity.
///
/// ψ(v) = sup over p of p·v − T(p). Its slope is the momentum, so p = ψ′(‖v‖) v/‖v‖ undoes the
/// effective velocity. At zero velocity it has a kink of height p_r: a particle stands still exactly
/// while its momentum is within the ball of that radius, like dry friction in momentum space. `Exact`
/// has a second kink, at the speed p_f/m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conjugate {
    held: Held,
}

impl Conjugate {
    pub(crate) fn of(held: Held) -> Conjugate {
        Conjugate { held }
    }

    /// The kinetic energy whose conjugate this is.
    pub fn held(&self) -> &Held {
        &self.held
    }

    /// ψ at a speed (J); infinite for a particle that rests for ever.
    pub fn psi(&self, speed: f64) -> f64 {
        if speed == 0.0 {
            return 0.0;
        }
        let (m, p_r, p_f) = (self.held.mass(), self.held.p_r(), self.held.p_f());
        let carried = m * speed;
        if p_r == f64::INFINITY {
            f64::INFINITY
        } else if carried >= p_f {
            // φ = r²/2 − what the law keeps back.
            let kept = 0.5 * p_f * p_f - self.held.phi(p_f);
            0.5 * carried * speed + kept / m
        } else {
            match self.held.law() {
                Law::Ramp => p_r * speed + 0.5 * carried * speed / ramp_slope(p_r, p_f),
                Law::Soft => p_r * speed + 0.5 * carried * speed,
                Law::Exact => p_r * speed + 0.5 * carried * speed / exact_slope(p_r, p_f),
                _ => {
                    let r = self.dpsi(speed);
                    r * speed - self.held.phi(r) / m
                }
            }
        }
    }

    /// ψ′ at a speed: the momentum norm (kg m/s). At speed 0 it is p_r, the upper end of the kink; at
    /// the second kink of `Exact` it is the upper end too.
    pub fn dpsi(&self, speed: f64) -> f64 {
        let (m, p_r, p_f) = (self.held.mass(), self.held.p_r(), self.held.p_f());
        let carried = m * speed;
        if carried >= p_f {
            return carried;
        }
        if p_r == f64::INFINITY {
            return f64::INFINITY;
        }
        match self.held.law() {
            Law::Ramp => p_r + carried / ramp_slope(p_r, p_f),
            Law::Soft => p_r + carried,
            Law::Exact => p_r + carried / exact_slope(p_r, p_f),
            _ => p_r + (p_f - p_r) * smooth_root(carried, p_r, p_f),
        }
    }

    /// ψ″ at a speed (kg): the effective mass along the motion. For `Smooth` it is infinite at 0.
    pub fn ddpsi(&self, speed: f64) -> f64 {
        let (m, p_r, p_f) = (self.held.mass(), self.held.p_r(), self.held.p_f());
        if m * speed >= p_f {
            return m;
        }
        if p_r == f64::INFINITY {
            return f64::INFINITY;
        }
        match self.held.law() {
            Law::Ramp => m / ramp_slope(p_r, p_f),
            Law::Soft => m,
            Law::Exact => m / exact_slope(p_r, p_f),
            _ => m / self.held.ddphi(self.dpsi(speed)),
        }
    }

    /// The momentum that goes with a velocity (kg m/s). Zero velocity goes with every momentum in
    /// the ball of radius p_r; it gives the middle, 0.
    pub fn momentum(&self, v: &Vector3) -> Vector3 {
        let speed = v.norm();
        if speed == 0.0 { Vector3::zeros() } else { v * (self.dpsi(speed) / speed) }
    }

    /// Effective mass ∂p/∂v at a velocity other than 0 (kg): ψ″ along it, ψ′/‖v‖ across.
    pub fn effective_mass(&self, v: &Vector3) -> Matrix3 {
        let speed = v.norm();
        radial_and_across(&(v / speed), self.ddpsi(speed), self.dpsi(speed) / speed)
    }

    /// How far a momentum p (kg m/s) at the end of a step of h (s) is from one that goes with the
    /// displacement d (m).
    pub fn error(&self, p: &Vector3, d: &Vector3, h: f64) -> f64 {
        if *d == Vector3::zeros() {
            (p.norm() - self.held.p_r()).max(0.0)
        } else {
            (self.momentum(&(d / h)) - p).norm()
        }
    }

    /// By how much a momentum p (kg m/s) at the end of a step of h (s) and the displacement d (m) do not go
    /// with each other: the lesser of [`Conjugate::error`] and of the mass times what the velocities
    /// ∂T/∂p and d/h differ by. Near rest that is by far the lesser, for there the direction of a momentum
    /// hangs on a velocity of nearly nothing.
    pub fn mismatch(&self, p: &Vector3, d: &Vector3, h: f64) -> f64 {
        self.error(p, d, h).min(self.slip(p, d, h))
    }

    /// True if a displacement says less about the momentum than p does: see [`Conjugate::mismatch`].
    pub fn is_vague(&self, p: &Vector3, d: &Vector3, h: f64) -> bool {
        2.0 * self.slip(p, d, h) < self.error(p, d, h)
    }

    /// Infinite for what moves though its momentum says that it rests.
    fn slip(&self, p: &Vector3, d: &Vector3, h: f64) -> f64 {
        if self.stays(p) && *d != Vector3::zeros() {
            return f64::INFINITY;
        }
        (self.held.s(p) - d * (self.held.mass() / h)).norm()
    }

    /// True if a particle with this momentum at the end of the step stays where it is: the kink.
    #[inline]
    pub fn stays(&self, p: &Vector3) -> bool {
        p.norm_squared() <= self.held.p_r() * self.held.p_r() && !self.held.is_free()
    }

    /// The displacement of one particle pulled by a drive c (kg m/s) against a spring: the minimum
    /// over d of h ψ(‖d‖/h) − c·d + ½ λ ‖d‖², for a step h (s) and λ ≥ 0 (kg/s). The proximal map of
    /// ψ, in closed form (for `Smooth` the root of a cubic).
    pub fn proximal(&self, c: &Vector3, lambda: f64, h: f64) -> Vector3 {
        let norm = c.norm();
        if norm <= self.held.p_r() {
            return Vector3::zeros();
        }
        let carried = self.carried_against(norm, lambda * h / self.held.mass());
        c * (h * carried / (self.held.mass() * norm))
    }

    /// φ′(r) at the r with r + a φ′(r) = c, for c above p_r.
    fn carried_against(&self, c: f64, a: f64) -> f64 {
        let (p_r, p_f) = (self.held.p_r(), self.held.p_f());
        let full = c / (1.0 + a);
        if full >= p_f {
            return full;
        }
        let straight = |slope: f64| slope * (c - p_r) / (1.0 + a * slope);
        match self.held.law() {
            Law::Ramp => straight(ramp_slope(p_r, p_f)),
            Law::Soft => straight(1.0),
            Law::Exact => straight(exact_slope(p_r, p_f)).min(p_f),
            _ => {
                // w t + a φ′(t) = c − p_r rises with t.
                let (a2, a3) = smooth_cubic(p_r, p_f);
                let w = p_f - p_r;
                let f = |t: f64| (w * t + a * t * t * (a2 + a3 * t)) - (c - p_r);
                let df = |t: f64| w + a * t * (2.0 * a2 + 3.0 * a3 * t);
                let t = rising_root(f, df);
                t * t * (a2 + a3 * t)
            }
        }
    }
}

/// t in [0, 1] with φ′(p_r + t (p_f − p_r)) = `carried` for `Smooth`, `carried` in [0, p_f): Viète's
/// formula for 1/t, then one step of Newton's method against rounding.
fn smooth_root(carried: f64, p_r: f64, p_f: f64) -> f64 {
    if carried <= 0.0 {
        return 0.0;
    }
    // (1/t)³ − a/c (1/t) − b/c = 0 has three real roots; the largest is the one from 1 up.
    let (a, b) = smooth_cubic(p_r, p_f);
    let third = (a / (3.0 * carried)).sqrt();
    let cosine = (b / (2.0 * carried) / (third * third * third)).clamp(-1.0, 1.0);
    let t = (0.5 / (third * (cosine.acos() / 3.0).cos())).clamp(0.0, 1.0);
    let slope = t * (2.0 * a + 3.0 * b * t);
    let better = t - (t * t * (a + b * t) - carried) / slope;
    if better.is_finite() { better.clamp(0.0, 1.0) } else { t }
}

/// The root in [0, 1] of a function that rises there, by Newton's method kept inside a bracket.
fn rising_root(f: impl Fn(f64) -> f64, df: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    let mut t = 0.5;
    // Bisection alone would be done after 60.
    for _ in 0..80 {
        let value = f(t);
        if value > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let newton = t - value / df(t);
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - t).abs() <= f64::EPSILON * t {
            return next;
        }
        t = next;
    }
    t
}
