//! Pairs that may touch for a while: sought once, for a way and all that is near it, and asked for as
//! long as nothing strays far from it.

use super::pair::Sides;
use mesh_core::{World3, par};

/// Part of a stray that room is left for the next time.
const LEARNED: f64 = 0.5;
/// What is left of room that was not needed, from one search to the next.
const FORGOTTEN: f64 = 0.8;

/// Pairs with the way for which they were sought.
#[derive(Default)]
pub(super) struct Candidates {
    pub(super) pairs: Vec<Sides>,
    /// Positions at the start of the way, of the cloth and of the obstacles (m).
    start: [Vec<World3>; 2],
    /// The way from there to its end (m).
    way: [Vec<World3>; 2],
    /// How far each vertex of the cloth, and the obstacles, may be off the way (m).
    pub(super) room: Vec<f64>,
    pub(super) obstacle_room: f64,
}

impl Candidates {
    /// The room to leave for another way that was off this one: at least `least`, at most `most`
    /// (m).
    pub(super) fn learn(&mut self, x: [&[World3]; 2], least: f64, most: f64) {
        if self.start[0].len() == x[0].len() {
            let shares = x.map(|x| self.share(x));
            let off = |i: usize| {
                f64::max(self.off(0, i, x[0], shares[0]), self.off(0, i, x[1], shares[1]))
            };
            let mut room = vec![0.0; x[0].len()];
            par::fill(&mut room, |i| {
                (FORGOTTEN * self.room[i]).max(LEARNED * off(i)).clamp(least, most)
            });
            self.room = room;
        } else {
            self.room = vec![least; x[0].len()];
        }
        self.obstacle_room = least;
    }

    /// Pairs that are complete for the way of the cloth from `x[0]` to `x[1]` while the obstacles go
    /// theirs (m), and for all that is off it by no more than there is room.
    pub(super) fn set(&mut self, pairs: Vec<Sides>, x: [&[World3]; 2], obstacles: [&[World3]; 2]) {
        self.pairs = pairs;
        self.start = [x[0].to_vec(), obstacles[0].to_vec()];
        self.way = [x, obstacles]
            .map(|[x_t0, x_t1]| x_t0.iter().zip(x_t1).map(|(from, to)| to - from).collect());
    }

    /// Whether nothing is missing for another way.
    ///
    /// Each of its ends is compared with the point of the old way that is nearest to it, the same
    /// share of it for everything: in between, nothing is further off.
    pub(super) fn are_complete(&self, x: [&[World3]; 2], obstacles: [&[World3]; 2]) -> bool {
        let same = |k: usize, new: [&[World3]; 2]| self.start[k].len() == new[0].len();
        let near = |end: usize| {
            let share = self.share(x[end]);
            let mut cloth =
                (0..x[end].len()).map(|i| self.off(0, i, x[end], share) <= self.room[i]);
            let y = obstacles[end];
            let mut bodies = (0..y.len()).map(|i| self.off(1, i, y, share) <= self.obstacle_room);
            cloth.all(|near| near) && bodies.all(|near| near)
        };
        same(0, x) && same(1, obstacles) && near(0) && near(1)
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
