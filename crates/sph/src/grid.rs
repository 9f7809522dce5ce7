//! A grid of cells over the bounding box of some points, and the order that sorts the points by cell.

use std::ops::Range;

/// Coordinates of a point; the fourth number is whatever travels with it.
pub(crate) type Point = [f64; 4];

/// The coordinates of points one axis at a time, for looking at many in a row.
#[derive(Clone, Debug, Default)]
pub(crate) struct Columns([Vec<f64>; 3]);

impl Columns {
    /// Takes the coordinates of these points.
    pub(crate) fn fill(&mut self, points: &[Point]) {
        for (k, column) in self.0.iter_mut().enumerate() {
            column.clear();
            column.extend(points.iter().map(|p| p[k]));
        }
    }

    /// Squared distances (m²) of a range of points from `p`.
    #[inline(always)]
    pub(crate) fn squared_distances(&self, range: Range<usize>, p: &Point, squared: &mut Vec<f64>) {
        let [x, y, z] = [0, 1, 2].map(|k| &self.0[k][range.clone()]);
        squared.clear();
        squared.extend(x.iter().zip(y).zip(z).map(|((x, y), z)| {
            let d = [p[0] - x, p[1] - y, p[2] - z];
            d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
        }));
    }
}

/// Cells are shorter along x than along y and z, so that a row is cut close to a sphere.
const CELLS_PER_REACH: f64 = 4.0;

/// Cells in rows along x: the points of neighbouring cells of a row follow each other in the order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grid {
    origin: [f64; 3],
    /// How far around a point others are looked for (m), a little more than asked for.
    reach: f64,
    /// Size of a cell along y and z (m), at least the reach.
    cell: f64,
    inverse_cell: [f64; 3],
    /// Number of cells along each axis.
    dims: [i64; 3],
    /// For every cell where its points start in the order; one more at the end.
    start: Vec<u32>,
    /// Cell of each point, in the old order.
    cells: Vec<u32>,
    /// For every cell whether a point may be within the reach of it, once asked for.
    near: Vec<bool>,
}

impl Grid {
    /// Lays cells over the points, for looking `reach` (m) around them, and writes the order that sorts
    /// them by cell, stably, to `order`. Far-flung points get larger cells, to bound their number.
    pub(crate) fn build(&mut self, x: &[Point], reach: f64, order: &mut Vec<u32>) {
        let first = x.first().copied().unwrap_or_default();
        let (mut low, mut high) = ([first[0], first[1], first[2]], [first[0], first[1], first[2]]);
        for p in x {
            for k in 0..3 {
                low[k] = p[k].min(low[k]);
                high[k] = p[k].max(high[k]);
            }
        }
        self.origin = low;
        // The rounding of coordinates in cells.
        self.reach = reach * (1.0 + 1e-9);
        self.cell = self.reach;
        let most = (4096 + 64 * x.len()) as f64;
        let n_cells = loop {
            self.inverse_cell = [CELLS_PER_REACH, 1.0, 1.0].map(|n| n / self.cell);
            let along = |k: usize| ((high[k] - low[k]) * self.inverse_cell[k]).floor() + 1.0;
            let n = along(0) * along(1) * along(2);
            if n <= most {
                self.dims = [along(0) as i64, along(1) as i64, along(2) as i64];
                break n as usize;
            }
            self.cell *= 2.0;
        };
        self.count(x, n_cells);
        order.clear();
        order.resize(x.len(), 0);
        // `start[c]` runs to the end of cell c while its points are placed, and is set back after.
        for (i, &c) in self.cells.iter().enumerate() {
            let at = &mut self.start[c as usize];
            order[*at as usize] = i as u32;
            *at += 1;
        }
        for c in (1..=n_cells).rev() {
            self.start[c] = self.start[c - 1];
        }
        self.start[0] = 0;
    }

    /// Prepares [`Grid::may_be_near`]; for points that stay where they are.
    pub(crate) fn mark_near(&mut self) {
        self.near = vec![false; self.start.len().saturating_sub(1)];
        let wide = CELLS_PER_REACH as i64 + 1;
        for (c, pair) in (0..).zip(self.start.windows(2)) {
            if pair[0] == pair[1] {
                continue;
            }
            let at = [
                c % self.dims[0],
                c / self.dims[0] % self.dims[1],
                c / self.dims[0] / self.dims[1],
            ];
            let range = |k: usize, by: i64| (at[k] - by).max(0)..(at[k] + by + 1).min(self.dims[k]);
            for z in range(2, 1) {
                for y in range(1, 1) {
                    let row = (z * self.dims[1] + y) * self.dims[0];
                    let x = range(0, wide);
                    self.near[(row + x.start) as usize..(row + x.end) as usize].fill(true);
                }
            }
        }
    }

    /// False only if no point is within the reach of `p`.
    #[inline(always)]
    pub(crate) fn may_be_near(&self, p: &Point) -> bool {
        let at = self.coordinates(p);
        if (0..3).any(|k| at[k] < 0 || at[k] >= self.dims[k]) {
            return !self.near.is_empty();
        }
        self.near[((at[2] * self.dims[1] + at[1]) * self.dims[0] + at[0]) as usize]
    }

    /// Fills `cells`, and `start` with the number of points in the cells before each.
    fn count(&mut self, x: &[Point], n_cells: usize) {
        self.start.clear();
        self.start.resize(n_cells + 1, 0);
        self.cells.clear();
        for p in x {
            let at = self.coordinates(p);
            // Rounding may put a point on the far border one cell out.
            let [i, j, k] = [0, 1, 2].map(|k| at[k].clamp(0, self.dims[k] - 1));
            let c = ((k * self.dims[1] + j) * self.dims[0] + i) as u32;
            self.cells.push(c);
            self.start[c as usize] += 1;
        }
        let mut sum = 0;
        for slot in &mut self.start {
            let here = *slot;
            *slot = sum;
            sum += here;
        }
    }

    #[inline(always)]
    fn coordinates(&self, p: &Point) -> [i64; 3] {
        [0, 1, 2].map(|k| ((p[k] - self.origin[k]) * self.inverse_cell[k]).floor() as i64)
    }

    /// Where in the order the points lie that may be within the reach of `p`: nine ranges, of which any
    /// may be empty.
    #[inline(always)]
    pub(crate) fn rows(&self, p: &Point) -> [Range<usize>; 9] {
        let at = self.coordinates(p);
        // For the rows before, at and behind `p`: the square of its distance from them.
        let squares = |k: usize| {
            let before = p[k] - (self.origin[k] + at[k] as f64 * self.cell);
            [before * before, 0.0, (self.cell - before) * (self.cell - before)]
        };
        let (y_squares, z_squares) = (squares(1), squares(2));
        let x = p[0] - self.origin[0];
        let mut rows = [const { 0..0 }; 9];
        for (n, row) in rows.iter_mut().enumerate() {
            let (j, k) = (n % 3, n / 3);
            let (y, z) = (at[1] + j as i64 - 1, at[2] + k as i64 - 1);
            let exists = (0..self.dims[1]).contains(&y) && (0..self.dims[2]).contains(&z);
            let left = self.reach * self.reach - y_squares[j] - z_squares[k];
            if !exists || left < 0.0 {
                continue;
            }
            let half = left.sqrt();
            let x0 = (((x - half) * self.inverse_cell[0]).floor() as i64).max(0);
            let x1 = (((x + half) * self.inverse_cell[0]).floor() as i64).min(self.dims[0] - 1);
            if x0 <= x1 {
                let first = (z * self.dims[1] + y) * self.dims[0];
                let [from, to] =
                    [first + x0, first + x1 + 1].map(|c| self.start[c as usize] as usize);
                *row = from..to;
            }
        }
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn squared(a: &Point, b: &Point) -> f64 {
        (0..3).map(|k| (a[k] - b[k]).powi(2)).sum()
    }

    proptest! {
        #[test]
        fn rows_hold_every_point_within_a_cell(
            points in prop::collection::vec([-3.0..3.0f64, -1.0..1.0, 0.0..2.0, 0.0..1.0], 1..60),
            cell in 0.05..2.0f64,
            probe in [-4.0..4.0f64, -2.0..2.0, -1.0..3.0, 0.0..1.0],
        ) {
            let (mut grid, mut order) = (Grid::default(), Vec::new());
            grid.build(&points, cell, &mut order);
            let mut found = vec![false; points.len()];
            for at in grid.rows(&probe).into_iter().flatten() {
                let i = order[at] as usize;
                prop_assert!(!found[i], "point {} is found twice", i);
                found[i] = true;
            }
            grid.mark_near();
            let near = points.iter().any(|p| squared(p, &probe) < cell * cell);
            prop_assert!(grid.may_be_near(&probe) || !near);
            for (i, p) in points.iter().enumerate() {
                prop_assert!(found[i] || squared(p, &probe) > cell * cell);
            }
            let mut sorted = order.clone();
            sorted.sort_unstable();
            prop_assert!(sorted.iter().enumerate().all(|(k, &i)| k == i as usize));
        }
    }

    #[test]
    fn no_points_and_far_points() {
        let (mut grid, mut order) = (Grid::default(), Vec::new());
        grid.build(&[], 0.1, &mut order);
        assert!(grid.rows(&[0.0; 4]).iter().all(Range::is_empty));
        let far = [[0.0; 4], [1e6, 1e6, 1e6, 0.0]];
        grid.build(&far, 0.1, &mut order);
        assert!(grid.start.len() < 10_000);
    }
}
