//! The proof that a direction separates over an interval of time, with all rounding errors.
//!
//! Let u = 2⁻⁵³. A difference of two given coordinates is rounded once, so its relative error is at
//! most u; a dot product of three terms adds at most 3 u/(1 − 3 u) of Σ |nₖ dₖ| (Higham2002 §3.1). All
//! in all 4 u and a little, and we subtract 16 u of the computed sum: the rest covers the rounding
//! of that sum, of the subtractions and of the length of n. Products may also underflow; `TINY`
//! covers that, since n has components up to 1.

use super::hull::Simplex;
use mesh_core::World3;

/// 16 u.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
/// Far above anything lost to underflow, far below any length.
const TINY: f64 = 1e-290;
/// How much of the way to the end of a proof is left out, so that the next one has room (1).
const SHY: f64 = 1.0 / 1024.0;

/// Differences of the corners of two convex sets at both ends of a linear motion.
pub(super) struct Motion<const M: usize> {
    /// At t = 0 (m).
    pub(super) d_t0: [World3; M],
    /// At t = 1 (m).
    pub(super) d_t1: [World3; M],
    /// Distance to keep (m).
    pub(super) separation: f64,
}

/// A lower bound on `n · Dᵢ − separation · |n|` as a function of time: linear from `at_t0` to `at_t1`.
#[derive(Clone, Copy)]
struct Bound {
    at_t0: f64,
    at_t1: f64,
    /// More than what evaluating in between loses.
    slack: f64,
}

impl Bound {
    #[inline]
    fn holds(&self, t: f64) -> bool {
        (1.0 - t) * self.at_t0 + t * self.at_t1 > self.slack
    }
}

impl<const M: usize> Motion<M> {
    /// True if one of the axes separates all the time.
    #[inline]
    pub(super) fn is_free_along_an_axis(&self) -> bool {
        let all = || self.d_t0.iter().chain(&self.d_t1);
        // Rounding is monotone: if the exact difference were at most the separation, so would be the
        // rounded one.
        (0..3).any(|k| {
            all().all(|d| d[k] > self.separation) || all().all(|d| -d[k] > self.separation)
        })
    }

    /// Looks for a direction that separates from `t` to `end`; returns until when it does, which may
    /// be later than `end`, at most 1.
    pub(super) fn separate(&self, t: f64, end: f64) -> Option<f64> {
        let at = |t: f64| {
            move |(a, b): (&World3, &World3)| if t < 1.0 { a * (1.0 - t) + b * t } else { *b }
        };
        let mut points = [[World3::zeros(); M]; 2];
        for (points, t) in points.iter_mut().zip([t, end]) {
            let both = self.d_t0.iter().zip(&self.d_t1);
            points.iter_mut().zip(both.map(at(t))).for_each(|(p, d)| *p = d);
        }
        let points = points.as_flattened();
        let middle = points.iter().sum::<World3>();
        let mut simplex = Simplex::start(nearest_along(points, &middle));
        let mut until = None;
        // Each round brings the hull's nearest point closer; few are ever needed.
        for _ in 0..4 * M {
            let Some(n) = simplex.direction() else { break };
            let n = n / n.amax();
            let next = nearest_along(points, &n);
            if n.dot(&next) > self.separation * n.norm() {
                until = self.proven_until(&n, t, end);
                if until.is_some() {
                    break;
                }
            }
            if !simplex.add(next) {
                break;
            }
        }
        until
    }

    /// If n separates from `t` to `end`: until when it does.
    fn proven_until(&self, n: &World3, t: f64, end: f64) -> Option<f64> {
        let bounds = self.bounds(n);
        if !bounds.iter().all(|b| b.holds(t) && b.holds(end)) {
            return None;
        }
        if end >= 1.0 || bounds.iter().all(|b| b.holds(1.0)) {
            return Some(1.0);
        }
        let sinking = bounds.iter().filter(|b| !b.holds(1.0));
        let latest = sinking.map(|b| b.at_t0 / (b.at_t0 - b.at_t1)).fold(1.0, f64::min);
        let latest = latest - SHY * (latest - t);
        let better = latest > end && bounds.iter().all(|b| b.holds(latest));
        Some(if better { latest } else { end })
    }

    /// The bounds for direction n, whose largest component is 1 or −1.
    #[inline]
    fn bounds(&self, n: &World3) -> [Bound; M] {
        let margin = self.separation * n.norm();
        let below = |d: &World3| {
            let size = (n.x * d.x).abs() + (n.y * d.y).abs() + (n.z * d.z).abs();
            (n.dot(d) - margin) - ROUNDING * (size + margin) - TINY
        };
        std::array::from_fn(|i| {
            let (at_t0, at_t1) = (below(&self.d_t0[i]), below(&self.d_t1[i]));
            Bound { at_t0, at_t1, slack: ROUNDING * (at_t0.abs() + at_t1.abs()) + TINY }
        })
    }
}

/// The point that lies lowest along n.
#[inline]
fn nearest_along(points: &[World3], n: &World3) -> World3 {
    let mut best = (f64::INFINITY, points[0]);
    for p in points {
        let height = n.dot(p);
        if height < best.0 {
            best = (height, *p);
        }
    }
    best.1
}
