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
    /// Square of the distance of each of these particles from its nearest sample (m²).
    pub(super) nearest: Vec<f64>,
    is_known: bool,
    /// How far a particle and a sample may have come towards each other (m).
    travel: f64,
}

impl Near {
    /// The lists are worthless: other samples, or particles in another order.
    pub(super) fn forget(&mut self) {
        self.is_known = false;
    }

    /// Notes how far (m) particles and samples come towards each other at most.
    pub(super) fn travel(&mut self, way: f64) {
        self.travel += way;
    }

    /// Lists the samples within `support` (m), unless they are known; `ahead` (m) is how far things
    /// will come towards each other before the lists are used.
    pub(super) fn list(
        &mut self,
        x: &[Point],
        samples: &[Point],
        [support, spacing, ahead]: [f64; 3],
    ) {
        let margin = MARGIN * spacing;
        if self.is_known && self.travel + ahead <= margin {
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
        for (i, p) in (0..).zip(x) {
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
                self.nearest.push(nearest);
            }
        }
        (self.is_known, self.travel) = (true, 0.0);
    }

    /// Samples around the `k`th particle that has any.
    #[inline(always)]
    pub(super) fn samples(&self, k: usize) -> &[u32] {
        &self.which[self.start[k] as usize..self.start[k + 1] as usize]
    }
}
