//! Continuous collision detection that never misses: vertex against triangle and edge against edge,
//! with corners that move on straight lines from t = 0 to t = 1.
//!
//! Both tests ask about differences of points of two convex sets. If `Dᵢ(t)` are the differences of
//! their corners (three for a vertex and a triangle, four for two edges), then all differences at t
//! are the convex hull of the `Dᵢ(t)`, and over a time interval they lie in the hull of the `Dᵢ` at
//! its two ends, because each moves linearly. This is the inclusion function of Wang2021, but we
//! compare it with the origin along any direction and not along the axes only: a direction n with
//! `n · Dᵢ > separation · |n|` at both ends, for all i, *proves* that nothing touches in between, at
//! any parameters. So only time is bisected: a search (`hull.rs`) proposes a direction, a bound with
//! all rounding errors (`certificate.rs`) accepts it, and time goes forward as far as the direction
//! holds. If none is found the interval is shortened, until a contact is reported at the time that
//! is proven to be free.
//!
//! The search may fail, which makes a hit early or false; it cannot make a hit go unseen. Roots of the
//! coplanarity cubic, which miss grazing and coplanar motions in floating point, appear nowhere.
//! Coordinates enter only through differences of two given numbers, each rounded once, so that a
//! large offset costs nothing and no translation has to be exact.

mod certificate;
mod hull;

use certificate::Motion;
use mesh_core::World3;

/// What a continuous test found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ccd {
    /// The distance is above the separation at every time in [0, 1].
    Free,
    /// They come as close as the separation, or nearly.
    Hit {
        /// The distance is above the separation at every time in [0, t] (1), or t = 0 and nothing is
        /// known.
        t: f64,
    },
}

impl Ccd {
    /// The time up to which motion is certainly free (1): 1 if all of it is.
    #[inline]
    pub fn free_until(self) -> f64 {
        match self {
            Ccd::Free => 1.0,
            Ccd::Hit { t } => t,
        }
    }

    /// True for a hit.
    #[inline]
    pub fn is_hit(self) -> bool {
        self != Ccd::Free
    }
}

/// Shortest interval that is tried (1): a hit is reported that close to where the proof ends.
const SHORTEST: f64 = 1.0 / (1 << 20) as f64;
/// By what an interval is shortened when no direction is found (1).
const SHORTEN: f64 = 1.0 / 16.0;
/// Most intervals that are tried; after them a hit is reported where the proof has come to.
const MOST_INTERVALS: usize = 512;

/// Vertex `x[0]` against triangle `x[1], x[2], x[3]`, moving from `x_t0` to `x_t1` (m): do they come as
/// close as `separation` ≥ 0 (m)? The triangle may be degenerate.
///
/// The answer is never [`Ccd::Free`] if they do, in exact arithmetic. It may be a hit if they miss
/// each other by little. At most a fixed number of steps; a coordinate that is not finite separates nothing.
pub fn vertex_triangle(x_t0: &[World3; 4], x_t1: &[World3; 4], separation: f64) -> Ccd {
    let differences = |x: &[World3; 4]| [x[0] - x[1], x[0] - x[2], x[0] - x[3]];
    Motion { d_t0: differences(x_t0), d_t1: differences(x_t1), separation }.advance()
}

/// Edge `x[0], x[1]` against edge `x[2], x[3]`; else as [`vertex_triangle`]. Edges may be parallel or
/// have no length.
pub fn edge_edge(x_t0: &[World3; 4], x_t1: &[World3; 4], separation: f64) -> Ccd {
    let differences = |x: &[World3; 4]| [x[0] - x[2], x[0] - x[3], x[1] - x[2], x[1] - x[3]];
    Motion { d_t0: differences(x_t0), d_t1: differences(x_t1), separation }.advance()
}

impl<const M: usize> Motion<M> {
    /// Proves time to be free from 0 on, as far as it goes.
    fn advance(&self) -> Ccd {
        if self.is_free_along_an_axis() {
            return Ccd::Free;
        }
        let mut t = 0.0;
        let mut step = 1.0;
        for _ in 0..MOST_INTERVALS {
            let end = if step < 1.0 - t { t + step } else { 1.0 };
            match self.separate(t, end) {
                Some(until) if until >= 1.0 => return Ccd::Free,
                Some(until) => {
                    step = until - t;
                    t = until;
                }
                None if step <= SHORTEST => break,
                None => step = (step.min(1.0 - t) * SHORTEN).max(SHORTEST),
            }
        }
        Ccd::Hit { t }
    }
}
