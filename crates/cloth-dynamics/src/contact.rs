//! What keeps cloth from passing through things, as the solver sees it.
//!
//! A stage begins with a look along the way that inertia alone would take the cloth. What comes near
//! on it gets an energy of a gap that is linear in the positions: the normal and the points of contact
//! are those of the place where things come near. So the energies are convex, finite everywhere and
//! known before the first iteration, and Newton's method needs no shorter steps for their sake. When
//! it is done, the whole way is looked at again: what was overlooked gets its energy, and iterations
//! follow; in the end a continuous test shortens what is left. So nothing passes through
//! anything, converged or not.

use crate::force::Stage;
use crate::solver::BlockMatrix;
use mesh_core::World3;

/// Something is in the way of two bodies that no motion can satisfy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blocked {
    /// Where (m).
    pub place: World3,
}

/// Contact of the cloth with whatever it must not pass.
pub trait Contact: Send + Sync {
    /// A short name for reports.
    fn name(&self) -> &'static str;

    /// A stage begins: finds what comes near on the way from `stage.x_t0` to `target`, where the
    /// vertices would go without forces (m), while obstacles go theirs, and takes what it lags.
    /// The positions `x_t0` belong to the first time, the end of the stage is the second (s); masses are
    /// those of the vertices (kg).
    fn begin(&mut self, stage: Stage<'_>, times: [f64; 2], mass: &[f64], target: &[World3]);

    /// Says before a stage begins which vertices sleep through it, if any do: they are where they were in
    /// the last stage, and only a stage that is begun anew will move them. So between sleepers, and between
    /// them and what stands still, nothing needs to be looked for; forces among them stay what they are in
    /// [`Contact::add_gradient`], and their stiffness may be left out.
    fn rest(&mut self, _sleepers: Option<&[bool]>) {}

    /// Pairs of vertices that share stiffness because they touch, repeats allowed.
    fn couples(&self) -> Vec<[u32; 2]>;

    /// Energy (J) of positions at the end of the stage.
    fn energy(&self, x: &[World3]) -> f64;

    /// Adds the gradient of [`Contact::energy`] (N).
    fn add_gradient(&self, x: &[World3], gradient: &mut [World3]);

    /// Adds by vertex the most that friction in this stage may hold between what stands still, so vertices
    /// with a mark and other things that do not move (N).
    fn add_grip(&self, _stands: &[bool], _grip: &mut [f64]) {}

    /// Adds gradient (N) and positive semi-definite stiffness (N/m); the pattern has room for
    /// [`Contact::couples`].
    fn add_system(&self, x: &[World3], gradient: &mut [World3], stiffness: &mut BlockMatrix);

    /// Looks along the way from the start of the stage to `x` (m) for what has no energy yet and gives
    /// it one; true if there was something.
    fn look(&mut self, x: &[World3]) -> bool;

    /// Whether a contact that has an energy is passed at the end `x` of the stage (m): the way to there
    /// would have to be changed.
    fn is_passed(&self, x: &[World3]) -> bool;

    /// Shortens the way from the start of the stage to `x` (m) until it is certainly free, without
    /// moving the vertices that are `fixed`; returns how many vertices it moved.
    ///
    /// # Errors
    /// If there is no such way.
    fn secure(&mut self, x: &mut [World3], fixed: &[bool]) -> Result<usize, Blocked>;

    /// How many contacts there are in this stage.
    fn n_touches(&self) -> usize;

    /// Whether all that is not cloth stays, between these times (s), where it was at the end of the
    /// last stage.
    fn is_still(&self, times: [f64; 2]) -> bool;
}

/// Stiffness of a contact in units of the mass of what touches over h²: enough to stop a vertex that
/// comes with a few times d̂/h.
pub const STIFFNESS: f64 = 20.0;

/// Share of d̂ over which the force of a contact sets in.
pub const ONSET: f64 = 0.2;

/// The potential of a gap d below d̂, zero beyond, with its first two derivatives; energy is this times
/// a stiffness (N/m). Its curvature rises from 0 to 1 over the first w = [`ONSET`] d̂ and stays there:
/// u³/(6w) for a depth u = d̂ − d up to w, and a parabola from there on. So it is convex and finite, and
/// next to quadratic where it matters: Newton's method needs as few iterations with it as without.
pub fn penalty(d: f64, d_hat: f64) -> [f64; 3] {
    let (u, w) = (d_hat - d, ONSET * d_hat);
    if u <= 0.0 {
        [0.0; 3]
    } else if u < w {
        [u * u * u / (6.0 * w), -u * u / (2.0 * w), u / w]
    } else {
        let more = u - w;
        [w * w / 6.0 + 0.5 * (w + more) * more, -(0.5 * w + more), 1.0]
    }
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
            let [_, slope, stiffness] = penalty(d, 0.005);
            check(|d| penalty(d, 0.005), d, 1e-5 * d, [slope.abs() + 1e-9, stiffness.abs() + 1e-3]);
            check(|y| friction(y, 0.005), d, 1e-5 * d, [1.0, 1.0 / 0.005]);
        }
    }

    #[test]
    fn penalties_repel_and_friction_is_smooth() {
        assert_eq!(penalty(1.0, 1.0), [0.0; 3]);
        assert!(penalty(0.5, 1.0)[1] < 0.0 && penalty(-2.0, 1.0)[0] > penalty(-1.0, 1.0)[0]);
        let [a, b] = [0.800_001, 0.799_999].map(|d| penalty(d, 1.0));
        assert!((0..3).all(|k| (a[k] - b[k]).abs() < 1e-4), "{a:?} {b:?}");
        let [inside, outside] = [0.999_999, 1.000_001].map(|y| friction(y, 1.0));
        assert!((inside[0] - outside[0]).abs() < 1e-5 && (inside[1] - 1.0).abs() < 1e-5);
        assert_eq!(friction(0.0, 1.0)[1], 0.0);
    }
}
