//! A grid of cells over the bounding box of some points, and the order that sorts the points by cell.

use std::ops::Range;

/// Coordinates of a point; the fourth number is whatever travels with it.
pub(crate) type Point = [f64; 4];

/// Cells in rows along x: the points of neighbouring cells of a row follow each other in the order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grid {
    origin: [f64; 3],
    inverse_cell: f64,
    /// Number of cells along each axis.
    dims: [i64; 3],
    /// For every cell where its points start in the order; one more at the end.
    start: Vec<u32>,
    /// Cell of each point, in the old order.
    cells: Vec<u32>,
}

impl Grid {
    /// Lays cells of at least `cell` (m) over the points and writes the order that sorts them by cell,
    /// stably, to `order`. Far-flung points get larger cells, to bound their number.
    pub(crate) fn build(&mut self, x: &[Point], cell: f64, order: &mut Vec<u32>) {
        order.clear();
        let (mut low, mut high) = ([0.0; 3], [0.0; 3]);
        if let Some(first) = x.first() {
            (low, high) = ([first[0], first[1], first[2]], [first[0], first[1], first[2]]);
        }
        for p in x {
            for k in 0..3 {
                low[k] = p[k].min(low[k]);
                high[k] = p[k].max(high[k]);
            }
        }
        self.origin = low;
        let most = 4096 + 64 * x.len();
        let mut cell = cell;
        let n_cells = loop {
            let along = |k: usize| ((high[k] - low[k]) / cell).floor() + 1.0;
            let n = along(0) * along(1) * along(2);
            if n <= most as f64 {
                self.dims = [along(0) as i64, along(1) as i64, along(2) as i64];
                break n as usize;
            }
            cell *= 2.0;
        };
        self.inverse_cell = 1.0 / cell;
        self.count(x, n_cells);
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
        [0, 1, 2].map(|k| ((p[k] - self.origin[k]) * self.inverse_cell).floor() as i64)
    }

    /// Where in the order the points lie that may be within a cell's length of `p`: up to nine ranges.
    #[inline(always)]
    pub(crate) fn for_each_row(&self, p: &Point, mut f: impl FnMut(Range<usize>)) {
        let at = self.coordinates(p);
        let reach = |k: usize| ((at[k] - 1).max(0), (at[k] + 1).min(self.dims[k] - 1));
        let ((x0, x1), (y0, y1), (z0, z1)) = (reach(0), reach(1), reach(2));
        if x0 > x1 {
            return;
        }
        for z in z0..=z1 {
            for y in y0..=y1 {
                let row = (z * self.dims[1] + y) * self.dims[0];
                let (from, to) = (self.start[(row + x0) as usize], self.start[(row + x1 + 1) as usize]);
                if from < to {
                    f(from as usize..to as usize);
                }
            }
        }
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
            grid.for_each_row(&probe, |range| {
                for at in range {
                    let i = order[at] as usize;
                    assert!(!found[i], "point {i} is found twice");
                    found[i] = true;
                }
            });
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
        grid.for_each_row(&[0.0; 4], |_| panic!("there is nothing"));
        let far = [[0.0; 4], [1e6, 1e6, 1e6, 0.0]];
        grid.build(&far, 0.1, &mut order);
        assert!(grid.start.len() < 10_000);
    }
}
