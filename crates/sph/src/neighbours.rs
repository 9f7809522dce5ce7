//! Lists of neighbours within the support and a skin (Verlet1967), in blocks of particles.
//!
//! The lists stay good until a particle has moved by half the skin. Particles are sorted by cell first,
//! so that neighbours in space are neighbours in memory.

use crate::cells::Cells;
use crate::grid::{Columns, Grid, Point};
use crate::lanes;
use crate::lists::Lists;
use crate::mend::{Mending, Surroundings};
use crate::place::squared_distance;
use crate::walls::{WallState, Walls};
use mesh_core::par;
use pulp::{Simd, WithSimd};

/// Particles per block: one task of a thread.
pub(crate) const BLOCK: usize = 64;

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

/// Takes neighbours as they are found.
pub(crate) type Found<'a> = &'a mut dyn FnMut(&[u32]);

/// The neighbours of all particles.
#[derive(Clone, Debug, Default)]
pub(crate) struct Neighbours {
    grid: Grid,
    columns: Columns,
    /// Where the particles are listed, once lists are mended.
    pub(crate) cells: Option<Cells>,
    /// How often a particle has got a list of its own since all did.
    pub(crate) n_mended: u64,
    pub(crate) mending: Mending,
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
    /// among them into `touched`, after those that are there to be `kept`.
    pub(crate) fn list(
        &mut self,
        x: &[Point],
        walls: &Walls,
        reach: f64,
        (touched, kept): (&mut WallState, &[u32]),
    ) {
        (self.cells, self.n_mended) = (None, 0);
        self.blocks.resize_with(x.len().div_ceil(BLOCK), Block::default);
        self.columns.fill(x);
        let (grid, columns) = (&self.grid, &self.columns);
        let mut no_output = vec![(); x.len()];
        par::blocks(&mut self.blocks, &mut no_output, BLOCK, |b, block, part| {
            let (first, x) = (b * BLOCK, &x[b * BLOCK..b * BLOCK + part.len()]);
            lanes::run(Listing { grid, columns, walls, first, x, reach, block });
        });
        let before = touched.restart(walls);
        for &j in kept {
            touched.place_of(walls, &before, j);
        }
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

    /// The same for particles in any order, of which nothing is listed yet: one after the other.
    pub(crate) fn list_unsorted(
        &mut self,
        x: &[Point],
        walls: &Walls,
        reach: f64,
        (touched, kept): (&mut WallState, &[u32]),
    ) {
        let before = touched.restart(walls);
        for &j in kept {
            touched.place_of(walls, &before, j);
        }
        *self = Neighbours::default();
        let n_blocks = touched.x.len().div_ceil(BLOCK);
        self.wall_blocks.resize_with(n_blocks, Lists::default);
        (0..touched.x.len()).for_each(|j| self.wall_blocks[j / BLOCK].append());
        self.cells = Some(Cells::over(x, reach));
        let mut around = Surroundings { walls, touched, reach };
        for n in 1..=x.len() {
            self.append(&x[..n], &mut around);
        }
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

    /// Hands out the candidates of particle `i` in the fluid, and those in the walls, that are within the
    /// support if all are at `x`: as they were when the active candidates were found, where these are
    /// known.
    pub(crate) fn within(
        &self,
        i: usize,
        x: &[Point],
        walls: &WallState,
        support_squared: f64,
        [fluid, wall]: [Found<'_>; 2],
    ) {
        let (block, k) = (&self.blocks[i / BLOCK], i % BLOCK);
        if block.is_fresh[k] {
            fluid(block.fluid.within(k));
            wall(block.wall.within(k));
            return;
        }
        let p = &x[i];
        let each = |candidates: &[u32], points: &[Point], found: Found<'_>| {
            let near = |j: &&u32| squared_distance(p, &points[**j as usize]) < support_squared;
            candidates.iter().filter(near).for_each(|j| found(&[*j]));
        };
        each(block.fluid.candidates(k), x, fluid);
        each(block.wall.candidates(k), &walls.x, wall);
    }

    /// Fluid within the support of particle `i` of the touched walls when its density was found last.
    #[inline(always)]
    pub(crate) fn fluid_within(&self, i: usize) -> &[u32] {
        self.wall_blocks[i / BLOCK].within(i % BLOCK)
    }

    /// The distances of particle `i` from others have changed.
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
        self.blocks.iter().map(|block| block.fluid.n_pairs()).sum::<usize>() / 2
    }
}
