//! Places of four particles at once.

use crate::grid::Point;
use crate::lanes::{Four, LANES};
use crate::pair::transpose;
use pulp::Simd;

/// One place or four.
pub(crate) struct Place<N>(pub(crate) [N; 3]);

impl<S: Simd> Place<Four<S>> {
    #[inline(always)]
    pub(crate) fn splat(simd: S, p: &Point) -> Self {
        Place([0, 1, 2].map(|k| Four::splat(simd, p[k])))
    }

    #[inline(always)]
    pub(crate) fn gather(simd: S, list: &[Point], at: [u32; LANES]) -> Self {
        let [x, y, z, _] = transpose(simd, pick(list, at));
        Place([x, y, z])
    }

    #[inline(always)]
    pub(crate) fn squared_distance(&self, other: &Self) -> Four<S> {
        let d = [0, 1, 2].map(|k| self.0[k] - other.0[k]);
        d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    }
}

#[inline(always)]
pub(crate) fn squared_distance(p: &Point, q: &Point) -> f64 {
    let d = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
}

/// Up to four numbers of particles, filled up with `filler`.
#[inline(always)]
pub(crate) fn named(at: &[u32], filler: u32) -> [u32; LANES] {
    [0, 1, 2, 3].map(|l| at.get(l).copied().unwrap_or(filler))
}

#[inline(always)]
pub(crate) fn pick(list: &[Point], at: [u32; LANES]) -> [&Point; LANES] {
    at.map(|j| &list[j as usize])
}
