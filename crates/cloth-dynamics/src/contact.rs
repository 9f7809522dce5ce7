//! What keeps cloth from passing through things, as the solver sees it: a potential that rises without
//! bound as a gap closes, and a bound on every step, so that none is made that closes one.
//!
//! A stage starts where nothing touches and makes only steps of which a continuous test says that
//! they are free. So nothing ever passes through anything, converged or not (Li2020). What is held by
//! the contact, obstacles, moves to its place at the end of the stage along with these steps.

use crate::force::Stage;
use crate::solver::BlockMatrix;
use mesh_core::World3;

/// Contact of the cloth with whatever it must not pass.
pub trait Contact: Send + Sync {
    /// A short name for reports.
    fn name(&self) -> &'static str;

    /// A stage begins: takes what it lags, and where obstacles are to go. The positions `x_t0` of the
    /// stage belong to the first time, its end is the second (s); masses are those of the vertices (kg).
    /// The energy at `x_t0` may be asked for without looking ahead first.
    fn begin(&mut self, stage: Stage<'_>, times: [f64; 2], mass: &[f64]);

    /// Finds what may come close on the way from `x` by `step` (m), while obstacles go where they are
    /// to be; returns the share of the way that is certainly free, from 0 to 1.
    fn look_ahead(&mut self, x: &[World3], step: &[World3]) -> f64;

    /// Lets what was found in the way of obstacles go along with them: changes `step` from `x` (m) and
    /// tells whether there was anything to change.
    fn carry(&self, x: &[World3], step: &mut [World3]) -> bool;

    /// Obstacles go this share of the way to where they are to be.
    fn follow(&mut self, share: f64);

    /// Whether obstacles are where they are to be at the end of the stage.
    fn has_arrived(&self) -> bool;

    /// Energy (J) of positions on the way that was last looked at.
    fn energy(&self, x: &[World3]) -> f64;

    /// Adds gradient (N) and positive semi-definite stiffness (N/m), within the pattern that the
    /// matrix has.
    fn add_system(&self, x: &[World3], gradient: &mut [World3], stiffness: &mut BlockMatrix);
}

/// Stiffness of a contact in units of the mass of what touches over h²: enough to stop a vertex that
/// comes with a few times d̂/h.
pub const STIFFNESS: f64 = 20.0;

/// The barrier −(d − d̂)² ln(d/d̂) for a gap d below d̂, zero beyond (Li2020 Eq. 6, here of the distance
/// itself), with its first two derivatives; infinite for d ≤ 0. Energy is this times a stiffness
/// (N/m).
pub fn barrier(d: f64, d_hat: f64) -> [f64; 3] {
    if d >= d_hat {
        return [0.0; 3];
    }
    if d <= 0.0 || d.is_nan() {
        return [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY];
    }
    let (gap, log) = (d - d_hat, (d / d_hat).ln());
    let ratio = gap / d;
    [-gap * gap * log, -2.0 * gap * log - gap * ratio, -2.0 * log - 4.0 * ratio + ratio * ratio]
}

/// Smoothed friction: potential f₀ of a slip `y` (m), its slope f₁ and the slope of that, which is the
/// Coulomb force 1 beyond `y_stick` and falls to zero smoothly below (Li2020 Eq. 14 and 17). Energy is
/// this times friction coefficient and normal force (N).
pub fn friction(y: f64, y_stick: f64) -> [f64; 3] {
    if y >= y_stick {
        return [y, 1.0, 0.0];
    }
    let s = y / y_stick;
    [y_stick * (s * s * (1.0 - s / 3.0) + 1.0 / 3.0), s * (2.0 - s), 2.0 * (1.0 - s) / y_stick]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Central differences of `f`'s entry `k` against its entry `k + 1`.
    fn check(f: impl Fn(f64) -> [f64; 3], at: f64, h: f64, scale: [f64; 2]) {
        let (low, high) = (f(at - h), f(at + h));
        for k in 0..2 {
            let slope = (high[k] - low[k]) / (2.0 * h);
            assert!((slope - f(at)[k + 1]).abs() < 1e-6 * scale[k], "{k} at {at}");
        }
    }

    #[test]
    fn slopes_are_those_of_finite_differences() {
        for share in [0.01, 0.3, 0.7, 0.95, 1.2] {
            let d = 0.005 * share;
            let [_, slope, stiffness] = barrier(d, 0.005);
            check(|d| barrier(d, 0.005), d, 1e-5 * d, [slope.abs() + 1e-9, stiffness.abs() + 1e-3]);
            check(|y| friction(y, 0.005), d, 1e-5 * d, [1.0, 1.0 / 0.005]);
        }
    }

    #[test]
    fn barriers_repel_and_friction_is_smooth() {
        assert_eq!(barrier(1.0, 1.0), [0.0; 3]);
        assert_eq!(barrier(0.0, 1.0)[0], f64::INFINITY);
        assert!(barrier(0.5, 1.0)[1] < 0.0 && barrier(1e-9, 1.0)[0] > barrier(1e-6, 1.0)[0]);
        let [inside, outside] = [0.999_999, 1.000_001].map(|y| friction(y, 1.0));
        assert!((inside[0] - outside[0]).abs() < 1e-5 && (inside[1] - 1.0).abs() < 1e-5);
        assert_eq!(friction(0.0, 1.0)[1], 0.0);
    }
}
