//! Lists of neighbours that are mended where something has moved, come or gone, rather than made anew.
//!
//! Two particles are in each other's lists if they were within the reach of each other where each of them
//! was last listed, and lists are in ascending order. So they depend on these places and on the order of
//! the particles alone, and not on what was mended when.

use crate::cells::Cells;
use crate::grid::Point;
use crate::neighbours::{BLOCK, Block, Neighbours};
use crate::walls::{WallState, Walls};

/// Memory for mending, which holds nothing of use between two calls.
#[derive(Clone, Debug, Default)]
pub(crate) struct Mending {
    found: Vec<u32>,
    before: Vec<u32>,
    walls: Vec<u32>,
}

/// What particles are listed among.
pub(crate) struct Surroundings<'a> {
    pub(crate) walls: &'a Walls,
    pub(crate) touched: &'a mut WallState,
    /// How far from a particle others are listed (m).
    pub(crate) reach: f64,
}

impl Neighbours {
    /// Gets ready for mending lists of particles that were listed at these places.
    pub(crate) fn prepare_mending(&mut self, listed: &[Point], reach: f64) {
        if self.cells.is_none() {
            let mut cells = Cells::over(listed, reach);
            (0..).zip(listed).for_each(|(i, p)| cells.insert(i, p));
            self.cells = Some(cells);
        }
    }

    fn cells_mut(&mut self) -> &mut Cells {
        self.cells.as_mut().expect("prepared for mending")
    }

    /// Lists particle `i` at another place.
    pub(crate) fn renew(
        &mut self,
        i: usize,
        to: &Point,
        listed: &mut [Point],
        around: &mut Surroundings<'_>,
    ) {
        let cells = self.cells_mut();
        cells.remove(i as u32, &listed[i]);
        cells.insert(i as u32, to);
        listed[i] = *to;
        self.link(i, listed, around);
    }

    /// Adds a particle, the last one of `listed`.
    pub(crate) fn append(&mut self, listed: &[Point], around: &mut Surroundings<'_>) {
        let i = listed.len() - 1;
        self.cells_mut().insert(i as u32, &listed[i]);
        if i.is_multiple_of(BLOCK) {
            self.blocks.push(Block::default());
        }
        let block = &mut self.blocks[i / BLOCK];
        block.fluid.append();
        block.wall.append();
        block.is_fresh.push(false);
        self.link(i, listed, around);
    }

    /// Takes out particle `i`; the last one gets its number. Whom it was listed for is added to
    /// `left`, particles and particles of walls.
    pub(crate) fn remove(&mut self, i: usize, listed: &mut Vec<Point>, left: &mut [Vec<u32>; 2]) {
        let last = listed.len() - 1;
        let (from, to) = (last as u32, i as u32);
        self.cells_mut().remove(to, &listed[i]);
        let Mending { mut before, mut walls, found } = std::mem::take(&mut self.mending);
        before.clear();
        before.extend_from_slice(self.candidates(i));
        for &j in &before {
            self.forget_candidate(j as usize, to);
        }
        walls.clear();
        walls.extend_from_slice(self.wall_candidates(i));
        for &j in &walls {
            self.wall_blocks[j as usize / BLOCK].remove(j as usize % BLOCK, to);
        }
        rename(&mut left[0], to, from);
        left[0].extend(before.iter().map(|&j| if j == from { to } else { j }));
        left[1].extend_from_slice(&walls);
        if i != last {
            let cells = self.cells_mut();
            cells.remove(from, &listed[last]);
            cells.insert(to, &listed[last]);
            before.clear();
            before.extend_from_slice(self.candidates(last));
            for &j in &before {
                self.forget_candidate(j as usize, from);
                self.add_candidate(j as usize, to);
            }
            walls.clear();
            walls.extend_from_slice(self.wall_candidates(last));
            for &j in &walls {
                let (lists, k) = (&mut self.wall_blocks[j as usize / BLOCK], j as usize % BLOCK);
                lists.remove(k, from);
                lists.insert(k, to);
            }
            self.put_lists(i, &before, &walls);
        }
        self.mending = Mending { found, before, walls };
        listed.swap_remove(i);
        let block = self.blocks.last_mut().expect("has the last particle");
        block.fluid.pop();
        block.wall.pop();
        block.is_fresh.pop();
        if block.is_fresh.is_empty() {
            self.blocks.pop();
        }
    }

    /// Gives particle `i` its lists, and puts it into those of others.
    fn link(&mut self, i: usize, listed: &[Point], around: &mut Surroundings<'_>) {
        self.n_mended += 1;
        let Mending { mut found, mut before, mut walls } = std::mem::take(&mut self.mending);
        let (p, number) = (&listed[i], i as u32);
        self.cells_mut().near(listed, p, number, &mut found);
        before.clear();
        before.extend_from_slice(self.candidates(i));
        for &j in &before {
            if found.binary_search(&j).is_err() {
                self.forget_candidate(j as usize, number);
            }
        }
        for &j in &found {
            if before.binary_search(&j).is_err() {
                self.add_candidate(j as usize, number);
            }
        }
        walls.clear();
        around.walls.near(p, around.reach, &mut walls);
        before.clear();
        before.extend_from_slice(self.wall_candidates(i));
        for wall in &mut walls {
            *wall = around.touched.place_of(around.walls, &WallState::default(), *wall);
            let (lists, k) = (*wall as usize / BLOCK, *wall as usize % BLOCK);
            if lists == self.wall_blocks.len() {
                self.wall_blocks.push(Default::default());
            }
            if k == self.wall_blocks[lists].len() {
                self.wall_blocks[lists].append();
            }
            self.wall_blocks[lists].insert(k, number);
        }
        for &j in &before {
            if !walls.contains(&j) {
                self.wall_blocks[j as usize / BLOCK].remove(j as usize % BLOCK, number);
            }
        }
        self.put_lists(i, &found, &walls);
        self.mending = Mending { found, before, walls };
    }

    /// Gives particle `i` these lists.
    fn put_lists(&mut self, i: usize, fluid: &[u32], walls: &[u32]) {
        let block = &mut self.blocks[i / BLOCK];
        let k = i % BLOCK;
        block.is_fresh[k] = false;
        // Not lazily: both have to be put.
        if block.fluid.replace(k, fluid) | block.wall.replace(k, walls) {
            block.is_fresh.fill(false);
        }
    }

    fn add_candidate(&mut self, of: usize, j: u32) {
        let block = &mut self.blocks[of / BLOCK];
        if block.fluid.insert(of % BLOCK, j) {
            block.is_fresh.fill(false);
        }
    }

    /// What is known of the active candidates may name `j`.
    fn forget_candidate(&mut self, of: usize, j: u32) {
        let block = &mut self.blocks[of / BLOCK];
        block.fluid.remove(of % BLOCK, j);
        block.is_fresh[of % BLOCK] = false;
    }
}

/// In a list of numbers, particle `removed` is gone and the `last` one has got its number.
pub(crate) fn rename(list: &mut Vec<u32>, removed: u32, last: u32) {
    list.retain(|&i| i != removed);
    list.iter_mut().filter(|i| **i == last).for_each(|i| *i = removed);
}
