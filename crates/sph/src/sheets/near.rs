//! Which samples of surfaces are near which particles.

use crate::grid::{Grid, Point};
use crate::place::squared_distance;

/// How much farther than the support samples are listed, in spacings (1).
const MARGIN: f64 = 0.5;

/// Lists of the samples around particles, complete until particles and samples have come closer to
/// each other than the margin allows.
#[derive(Clone, Debug, Default)]
pub(super) struct Near {
    grid: Grid,
    order: Vec<u32>,
    sorted: Vec<Point>,
    /// Particles that have any, ascending, where their samples start in `which`, and one more.
    pub(super) who: Vec<u32>,
    start: Vec<u32>,
    which: Vec<u32>,
    /// The distance of each of these particles from its nearest sample (m) when it was last looked at, and
    /// how far things had come towards each other by then (m).
    nearest: Vec<[f64; 2]>,
    is_known: bool,
    /// The time of the fluid that is listed (s): at any other it has moved unnoticed.
    time: f64,
    /// How far a particle and a sample may have come towards each other (m).
    travel: f64,
}

impl Near {
    /// The lists are worthless: other samples, or particles in another order.
    pub(super) fn forget(&mut self) {
        self.is_known = false;
    }

    /// Notes how far (m) samples come towards particles at most.
    pub(super) fn travel(&mut self, way: f64) {
        self.travel += way;
    }

    /// Notes how far (m) particles and samples come towards each other until a time of the fluid (s).
    pub(super) fn travel_until(&mut self, way: f64, time: f64) {
        self.travel += way;
        self.time = time;
    }

    /// The `k`th particle that has samples is that far (m) from the nearest of them.
    #[inline(always)]
    pub(super) fn look(&mut self, k: usize, nearest: f64) {
        self.nearest[k] = [nearest, self.travel];
    }

    /// At least as far (m) from the `k`th particle its samples are now.
    #[inline(always)]
    pub(super) fn at_least(&self, k: usize) -> f64 {
        let [nearest, travel] = self.nearest[k];
        nearest - (self.travel - travel)
    }

    /// Lists the samples within `support` (m) at a time of the fluid (s), unless they are known; `ahead` (m)
    /// is how far things will come towards each other before the lists are used.
    pub(super) fn list(
        &mut self,
        (x, time): (&[Point], f64),
        samples: &[Point],
        [support, spacing, ahead]: [f64; 3],
    ) {
        let margin = MARGIN * spacing;
        if self.is_known && self.time == time && self.travel + ahead <= margin {
            return;
        }
        let reach = support + margin + ahead;
        self.grid.build(samples, reach, &mut self.order);
        self.sorted.clear();
        self.sorted.extend(self.order.iter().map(|&s| samples[s as usize]));
        self.who.clear();
        self.which.clear();
        self.nearest.clear();
        self.start.clear();
        self.start.push(0);
        let around = box_around(samples, reach);
        for (i, p) in (0..).zip(x) {
            if (0..3).any(|c| p[c] < around[0][c] || p[c] > around[1][c]) {
                continue;
            }
            let begin = self.which.len();
            let mut nearest = f64::INFINITY;
            for at in self.grid.rows(p).into_iter().flatten() {
                let squared = squared_distance(p, &self.sorted[at]);
                if squared < reach * reach {
                    self.which.push(self.order[at]);
                    nearest = nearest.min(squared);
                }
            }
            if self.which.len() > begin {
                self.who.push(i);
                self.start.push(self.which.len() as u32);
                self.nearest.push([nearest.sqrt(), 0.0]);
            }
        }
        (self.is_known, self.time, self.travel) = (true, time, 0.0);
    }

    /// Samples around the `k`th particle that has any.
    #[inline(always)]
    pub(super) fn samples(&self, k: usize) -> &[u32] {
        &self.which[self.start[k] as usize..self.start[k + 1] as usize]
    }
}

/// The corners of a box around points, larger than that by `reach` (m) on all sides.
fn box_around(points: &[Point], reach: f64) -> [[f64; 3]; 2] {
    let mut corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for p in points {
        for c in 0..3 {
            corners[0][c] = corners[0][c].min(p[c] - reach);
            corners[1][c] = corners[1][c].max(p[c] + reach);
        }
    }
    corners
}
