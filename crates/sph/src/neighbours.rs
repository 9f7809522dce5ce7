//! Lists of neighbours within the support and a skin (Verlet1967), in blocks of particles.
//!
//! The lists stay good until a particle has moved by half the skin. Particles are sorted by cell first,
//! so that neighbours in space are neighbours in memory.

use crate::grid::{Columns, Grid, Point};
use crate::lanes::{self, LANES};
use crate::walls::{WallState, Walls};
use mesh_core::par;
use pulp::{Simd, WithSimd};

/// Particles per block: one task of a thread.
pub(crate) const BLOCK: usize = 64;

/// Neighbours of one kind (fluid or wall) of the particles of a block.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lists {
    /// Where each particle's candidates start; one more at the end.
    start: Vec<u32>,
    candidates: Vec<u32>,
    /// How many candidates of each particle are within the support, padded to whole lanes, and which;
    /// every particle has room for all its candidates, so that any of them can be looked at alone.
    n_active: Vec<u32>,
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
        &self.candidates[self.start[k] as usize..self.start[k + 1] as usize]
    }

    /// The candidates of all particles of the block.
    fn all_mut(&mut self) -> &mut [u32] {
        let end = self.start.last().map_or(0, |&end| end as usize);
        &mut self.candidates[..end]
    }

    /// Neighbours of particle `k` within the support, and F for each, padded to whole lanes.
    #[inline(always)]
    pub(crate) fn active(&self, k: usize) -> (&[u32], &[f64]) {
        let begin = self.room_of(k);
        let range = begin..begin + self.n_active[k] as usize;
        (&self.active[range.clone()], &self.slope[range])
    }

    /// Where the room of particle `k` for active candidates begins.
    #[inline(always)]
    fn room_of(&self, k: usize) -> usize {
        self.start[k] as usize + LANES * k
    }

    /// Starts anew with no particle.
    fn clear(&mut self) {
        self.start.clear();
        self.start.push(0);
    }

    /// Adds a particle whose candidates are among the points of the rows around `p`.
    #[inline(always)]
    fn push(&mut self, grid: &Grid, columns: &Columns, p: &Point, reach: f64, but: usize) {
        let mut n = *self.start.last().expect("cleared before") as usize;
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
    }

    /// Adds a particle without any candidate.
    fn push_alone(&mut self) {
        self.start.push(*self.start.last().expect("cleared before"));
    }

    /// Makes room for the active candidates.
    fn finish(&mut self) {
        let n_particles = self.start.len() - 1;
        let room = self.room_of(n_particles);
        self.active.resize(room, 0);
        self.slope.resize(room, 0.0);
        self.n_active.resize(n_particles, 0);
    }

    /// Finds the candidates of particle `k`, which is at `p`, that are within the support, and leaves
    /// their squared distances in the place of F for `weigh`, a multiple of `LANES` at a time.
    /// Padding names the particle `filler` at a distance of three smoothing lengths.
    #[inline(always)]
    pub(crate) fn activate(
        &mut self,
        k: usize,
        p: &Point,
        points: &[Point],
        support_squared: f64,
        filler: u32,
    ) -> (&[u32], &mut [f64]) {
        let candidates = &self.candidates[self.start[k] as usize..self.start[k + 1] as usize];
        let begin = self.room_of(k);
        let end = begin + candidates.len() + LANES;
        let (active, r_squared) = (&mut self.active[begin..end], &mut self.slope[begin..end]);
        let mut n = 0;
        for &j in candidates {
            let q = &points[j as usize];
            let d = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
            let squared = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            active[n] = j;
            r_squared[n] = squared;
            n += usize::from(squared < support_squared);
        }
        while n % LANES != 0 {
            active[n] = filler;
            r_squared[n] = 2.25 * support_squared;
            n += 1;
        }
        self.n_active[k] = n as u32;
        (&active[..n], &mut r_squared[..n])
    }
}

/// What belongs to a block of consecutive particles.
#[derive(Clone, Debug, Default)]
pub(crate) struct Block {
    /// Other particles of the fluid.
    pub(crate) fluid: Lists,
    /// Particles of the walls.
    pub(crate) wall: Lists,
    /// Whether the active candidates of each particle and their F are those of the present positions.
    pub(crate) is_fresh: Vec<bool>,
}

/// Lists the neighbours of a block.
struct Listing<'a> {
    grid: &'a Grid,
    columns: &'a Columns,
    walls: &'a Walls,
    first: usize,
    x: &'a [Point],
    reach: f64,
    block: &'a mut Block,
}

impl WithSimd for Listing<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Block { fluid, wall, is_fresh } = self.block;
        is_fresh.clear();
        is_fresh.resize(self.x.len(), false);
        fluid.clear();
        wall.clear();
        for (i, p) in (self.first..).zip(self.x) {
            fluid.push(self.grid, self.columns, p, self.reach, i);
            if self.walls.grid().may_be_near(p) {
                wall.push(self.walls.grid(), self.walls.columns(), p, self.reach, usize::MAX);
            } else {
                wall.push_alone();
            }
        }
        fluid.finish();
        wall.finish();
    }
}

/// Lists the fluid around a block of particles of the walls.
struct WallListing<'a> {
    grid: &'a Grid,
    columns: &'a Columns,
    x: &'a [Point],
    reach: f64,
    lists: &'a mut Lists,
}

impl WithSimd for WallListing<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.lists.clear();
        for p in self.x {
            self.lists.push(self.grid, self.columns, p, self.reach, usize::MAX);
        }
        self.lists.finish();
    }
}

/// The neighbours of all particles.
#[derive(Clone, Debug, Default)]
pub(crate) struct Neighbours {
    grid: Grid,
    columns: Columns,
    pub(crate) blocks: Vec<Block>,
    /// Fluid particles around each particle of the walls that fluid may touch.
    pub(crate) wall_blocks: Vec<Lists>,
}

impl Neighbours {
    /// Lays the grid over the particles; `order` sorts them by its cells.
    pub(crate) fn sort(&mut self, x: &[Point], reach: f64, order: &mut Vec<u32>) {
        self.grid.build(x, reach, order);
    }

    /// Lists the neighbours of particles that are sorted, and puts the particles of the walls that are
    /// among them into `touched`.
    pub(crate) fn list(&mut self, x: &[Point], walls: &Walls, reach: f64, touched: &mut WallState) {
        self.blocks.resize_with(x.len().div_ceil(BLOCK), Block::default);
        self.columns.fill(x);
        let (grid, columns) = (&self.grid, &self.columns);
        let mut no_output = vec![(); x.len()];
        par::blocks(&mut self.blocks, &mut no_output, BLOCK, |b, block, part| {
            let (first, x) = (b * BLOCK, &x[b * BLOCK..b * BLOCK + part.len()]);
            lanes::run(Listing { grid, columns, walls, first, x, reach, block });
        });
        let before = touched.restart(walls);
        for block in &mut self.blocks {
            for j in block.wall.all_mut() {
                *j = touched.place_of(walls, &before, *j);
            }
        }
        self.wall_blocks.resize_with(touched.x.len().div_ceil(BLOCK), Lists::default);
        let mut no_output = vec![(); touched.x.len()];
        par::blocks(&mut self.wall_blocks, &mut no_output, BLOCK, |b, lists, part| {
            let x = &touched.x[b * BLOCK..b * BLOCK + part.len()];
            lanes::run(WallListing { grid, columns, x, reach, lists });
        });
    }

    /// Candidates of particle `i` of the touched walls in the fluid.
    #[inline(always)]
    pub(crate) fn fluid_candidates(&self, i: usize) -> &[u32] {
        self.wall_blocks[i / BLOCK].candidates(i % BLOCK)
    }

    /// Candidates of particle `i` in the fluid.
    #[inline(always)]
    pub(crate) fn candidates(&self, i: usize) -> &[u32] {
        self.blocks[i / BLOCK].fluid.candidates(i % BLOCK)
    }

    /// The distances of particle `i` from others have changed, but its active candidates have not.
    #[inline(always)]
    pub(crate) fn outdate(&mut self, i: usize) {
        self.blocks[i / BLOCK].is_fresh[i % BLOCK] = false;
    }

    /// Candidates of particle `i` in the walls.
    #[inline(always)]
    pub(crate) fn wall_candidates(&self, i: usize) -> &[u32] {
        self.blocks[i / BLOCK].wall.candidates(i % BLOCK)
    }

    /// Pairs of fluid particles in the lists.
    pub(crate) fn n_pairs(&self) -> usize {
        let ends = |block: &Block| *block.fluid.start.last().unwrap_or(&0) as usize;
        self.blocks.iter().map(ends).sum::<usize>() / 2
    }
}
