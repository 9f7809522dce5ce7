//! Pairs that may touch for a while: sought once, for a way and all that is near it, and asked for as
//! long as nothing strays far from it.

use super::pair::Sides;
use mesh_core::{World3, par};

/// Pairs with the way for which they were sought.
#[derive(Default)]
pub(super) struct Candidates {
    pub(super) pairs: Vec<Sides>,
    /// Positions at the start of the way, of the cloth and of the obstacles (m).
    start: [Vec<World3>; 2],
    /// The way from there to its end (m).
    way: [Vec<World3>; 2],
    /// How far anything may be off the way (m).
    room: f64,
}

impl Candidates {
    /// Pairs that are complete for the way of the cloth from `x[0]` to `x[1]` while the obstacles go
    /// theirs (m), and for all that is off it by no more than `room` (m).
    pub(super) fn new(
        pairs: Vec<Sides>,
        room: f64,
        x: [&[World3]; 2],
        obstacles: [&[World3]; 2],
    ) -> Candidates {
        let way = [x, obstacles]
            .map(|[x_t0, x_t1]| x_t0.iter().zip(x_t1).map(|(from, to)| to - from).collect());
        Candidates { pairs, start: [x[0].to_vec(), obstacles[0].to_vec()], way, room }
    }

    /// Whether nothing is missing for another way.
    ///
    /// Each of its ends is compared with the point of the old way that is nearest to it, the same
    /// share of it for everything: in between, nothing is further off.
    pub(super) fn are_complete(&self, x: [&[World3]; 2], obstacles: [&[World3]; 2]) -> bool {
        let same = |k: usize, new: [&[World3]; 2]| self.start[k].len() == new[0].len();
        let near = |end: usize| {
            let share = self.share(x[end]);
            let is_near = |set: usize, x: &[World3]| {
                (0..x.len()).all(|i| self.off(set, i, x, share) <= self.room)
            };
            is_near(0, x[end]) && is_near(1, obstacles[end])
        };
        same(0, x) && same(1, obstacles) && near(0) && near(1)
    }

    /// Whether nothing is far from the way, so that most of what is near each other is known.
    pub(super) fn are_around(&self, x: &[World3], obstacles: &[World3]) -> bool {
        self.are_complete([x, x], [obstacles, obstacles])
    }

    /// Share of the way that is nearest to positions of the cloth (1).
    fn share(&self, x: &[World3]) -> f64 {
        let (start, way) = (&self.start[0], &self.way[0]);
        let along = par::sum(x.len(), |i| (x[i] - start[i]).dot(&way[i]));
        let whole = par::sum(x.len(), |i| way[i].norm_squared());
        if whole > 0.0 { (along / whole).clamp(0.0, 1.0) } else { 0.0 }
    }

    /// How far position `i` is off that point of the way (m).
    fn off(&self, set: usize, i: usize, x: &[World3], share: f64) -> f64 {
        (x[i] - self.start[set][i] - self.way[set][i] * share).norm()
    }
}
