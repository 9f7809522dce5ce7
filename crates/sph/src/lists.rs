//! Lists of candidates: who may be within the support of a particle until it has moved by half the skin.

use crate::grid::{Columns, Grid, Point};
use crate::lanes::LANES;
use crate::place::{Place, squared_distance};
use pulp::Simd;

/// Candidates for which there is room to spare once lists have been mended.
const SPARE_ROOM: usize = 8;

/// Neighbours of one kind (fluid or wall) of the particles of a block.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lists {
    /// Where the room for each particle's candidates starts; one more at the end.
    start: Vec<u32>,
    /// How many candidates there are in it.
    count: Vec<u32>,
    candidates: Vec<u32>,
    /// How many candidates of each particle are within the support, padded to whole lanes, and which;
    /// every particle has room for all its candidates, so that any of them can be looked at alone.
    n_active: Vec<u32>,
    /// The same without padding.
    n_within: Vec<u32>,
    active: Vec<u32>,
    /// Squared distances in a row of cells.
    squared: Vec<f64>,
    /// For each active candidate F(r) = W′(r)/r; 0 in the padding.
    slope: Vec<f64>,
}

impl Lists {
    /// Candidates of the block's particle `k`.
    #[inline(always)]
    pub(crate) fn candidates(&self, k: usize) -> &[u32] {
        let start = self.start[k] as usize;
        &self.candidates[start..start + self.count[k] as usize]
    }

    /// The candidates of all particles of a block that has just been listed.
    pub(crate) fn all_mut(&mut self) -> &mut [u32] {
        let end = self.start.last().map_or(0, |&end| end as usize);
        &mut self.candidates[..end]
    }

    /// Pairs of a particle and a candidate.
    pub(crate) fn n_pairs(&self) -> usize {
        self.count.iter().map(|&n| n as usize).sum()
    }

    /// Number of particles that have a list.
    pub(crate) fn len(&self) -> usize {
        self.count.len()
    }

    /// Neighbours of particle `k` within the support, and F for each, padded to whole lanes.
    #[inline(always)]
    pub(crate) fn active(&self, k: usize) -> (&[u32], &[f64]) {
        let begin = self.room_of(k);
        let range = begin..begin + self.n_active[k] as usize;
        (&self.active[range.clone()], &self.slope[range])
    }

    /// Neighbours of particle `k` within the support.
    #[inline(always)]
    pub(crate) fn within(&self, k: usize) -> &[u32] {
        let begin = self.room_of(k);
        &self.active[begin..begin + self.n_within[k] as usize]
    }

    /// Where the room of particle `k` for active candidates begins.
    #[inline(always)]
    fn room_of(&self, k: usize) -> usize {
        self.start[k] as usize + LANES * k
    }

    /// Starts anew with no particle.
    pub(crate) fn clear(&mut self) {
        self.start.clear();
        self.count.clear();
        self.start.push(0);
    }

    /// Adds a particle whose candidates are among the points of the rows around `p`.
    #[inline(always)]
    pub(crate) fn push(
        &mut self,
        grid: &Grid,
        columns: &Columns,
        p: &Point,
        reach: f64,
        but: usize,
    ) {
        let first = *self.start.last().expect("cleared before");
        let mut n = first as usize;
        let reach_squared = reach * reach;
        for range in grid.rows(p).into_iter().filter(|range| !range.is_empty()) {
            columns.squared_distances(range.clone(), p, &mut self.squared);
            if self.candidates.len() < n + range.len() {
                self.candidates.resize((n + range.len()) * 2, 0);
            }
            let room = &mut self.candidates[n..n + range.len()];
            let mut found = 0;
            for (j, &squared) in range.zip(&self.squared) {
                room[found] = j as u32;
                found += usize::from((squared < reach_squared) & (j != but));
            }
            n += found;
        }
        self.start.push(n as u32);
        self.count.push(n as u32 - first);
    }

    /// Adds a particle without any candidate.
    pub(crate) fn push_alone(&mut self) {
        self.start.push(*self.start.last().expect("cleared before"));
        self.count.push(0);
    }

    /// Makes room for the active candidates.
    pub(crate) fn finish(&mut self) {
        let n_particles = self.start.len() - 1;
        let room = self.room_of(n_particles);
        self.active.resize(room, 0);
        self.slope.resize(room, 0.0);
        self.n_active.resize(n_particles, 0);
        self.n_within.resize(n_particles, 0);
    }

    /// Finds the candidates of particle `k`, which is at `p`, that are within the support, and leaves
    /// their squared distances in the place of F for `weigh`, a multiple of `LANES` at a time.
    /// Padding names the particle `filler` at a distance of three smoothing lengths.
    #[inline(always)]
    pub(crate) fn activate<S: Simd>(
        &mut self,
        simd: S,
        k: usize,
        p: &Point,
        points: &[Point],
        (support_squared, filler): (f64, u32),
    ) -> (&[u32], &mut [f64]) {
        let start = self.start[k] as usize;
        let candidates = &self.candidates[start..start + self.count[k] as usize];
        let begin = self.room_of(k);
        let end = begin + candidates.len() + LANES;
        let (active, r_squared) = (&mut self.active[begin..end], &mut self.slope[begin..end]);
        let here = Place::splat(simd, p);
        let mut n = 0;
        let mut add = |at: &[u32], squared: &[f64]| {
            for (&j, &squared) in at.iter().zip(squared) {
                active[n] = j;
                r_squared[n] = squared;
                n += usize::from(squared < support_squared);
            }
        };
        let (fours, rest) = candidates.as_chunks::<LANES>();
        for at in fours {
            add(at, &here.squared_distance(&Place::gather(simd, points, *at)).array());
        }
        for &j in rest {
            add(&[j], &[squared_distance(p, &points[j as usize])]);
        }
        self.n_within[k] = n as u32;
        while n % LANES != 0 {
            active[n] = filler;
            r_squared[n] = 2.25 * support_squared;
            n += 1;
        }
        self.n_active[k] = n as u32;
        (&active[..n], &mut r_squared[..n])
    }

    /// Adds candidate `j` to particle `k`, if it is none yet. Returns true if that moved the rooms of the
    /// block, so that nothing is known of active candidates any more.
    pub(crate) fn insert(&mut self, k: usize, j: u32) -> bool {
        let Err(at) = self.candidates(k).binary_search(&j) else { return false };
        let (start, n) = (self.start[k] as usize, self.count[k] as usize);
        let is_moved = start + n == self.start[k + 1] as usize;
        if is_moved {
            self.move_rooms(k, n + 1);
        }
        let start = self.start[k] as usize;
        self.candidates.copy_within(start + at..start + n, start + at + 1);
        self.candidates[start + at] = j;
        self.count[k] += 1;
        is_moved
    }

    /// Takes candidate `j` from particle `k`, if it is one.
    pub(crate) fn remove(&mut self, k: usize, j: u32) {
        let Ok(at) = self.candidates(k).binary_search(&j) else { return };
        let (start, n) = (self.start[k] as usize, self.count[k] as usize);
        self.candidates.copy_within(start + at + 1..start + n, start + at);
        self.count[k] -= 1;
    }

    /// Gives particle `k` these candidates. Returns true if that moved the rooms of the block.
    pub(crate) fn replace(&mut self, k: usize, list: &[u32]) -> bool {
        let is_moved = (self.start[k + 1] - self.start[k]) < list.len() as u32;
        self.count[k] = 0;
        if is_moved {
            self.move_rooms(k, list.len());
        }
        let start = self.start[k] as usize;
        self.candidates[start..start + list.len()].copy_from_slice(list);
        self.count[k] = list.len() as u32;
        is_moved
    }

    /// Adds a particle with a room of nothing.
    pub(crate) fn append(&mut self) {
        if self.start.is_empty() {
            self.clear();
        }
        self.push_alone();
        self.finish();
    }

    /// Takes out the last particle.
    pub(crate) fn pop(&mut self) {
        self.start.pop();
        self.count.pop();
        self.finish();
    }

    /// Gives every particle more room than it needs, and particle `k` also room for `n` candidates.
    fn move_rooms(&mut self, k: usize, n: usize) {
        let (mut start, mut candidates) = (vec![0], Vec::new());
        for (i, &count) in self.count.iter().enumerate() {
            candidates.extend_from_slice(self.candidates(i));
            let needed = if i == k { n.max(count as usize) } else { count as usize };
            let end = *start.last().expect("not empty") as usize + needed + SPARE_ROOM;
            candidates.resize(end, 0);
            start.push(end as u32);
        }
        (self.start, self.candidates) = (start, candidates);
        self.finish();
    }
}
