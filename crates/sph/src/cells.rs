//! Points in cells that change one at a time, where a sorted [`Grid`](crate::grid::Grid) would have to be
//! built anew.

use crate::grid::Point;
use crate::place::squared_distance;

/// Cubic cells over all of space, folded: cells that are a multiple of the period apart are one. So no
/// point is ever outside.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cells {
    inverse_size: f64,
    reach_squared: f64,
    /// The period along each axis less one, in cells; the period is a power of two, at least four.
    mask: [i64; 3],
    /// Numbers of the points in each cell, in no order.
    cells: Vec<Vec<u32>>,
}

/// The shortest period: a cell and those beside it must be different ones.
const SHORTEST: i64 = 4;

impl Cells {
    /// Empty cells for these points, for looking `reach` (m) around.
    pub(crate) fn over(points: &[Point], reach: f64) -> Self {
        // The rounding of coordinates in cells.
        let inverse_size = 1.0 / (reach * (1.0 + 1e-9));
        let mut n = [0, 1, 2].map(|k| {
            let (low, high) =
                points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
                    (p[k].min(low), p[k].max(high))
                });
            let n = ((high - low).max(0.0) * inverse_size).min(1e6) as u64 + 2;
            n.next_power_of_two() as i64
        });
        // Far-flung points share cells.
        let most = points.len().max(64) as i64;
        while n.iter().product::<i64>() > most && n.iter().any(|&n| n > SHORTEST) {
            let longest = (0..3).max_by_key(|&k| n[k]).expect("three axes");
            n[longest] /= 2;
        }
        let mask = n.map(|n| n.max(SHORTEST) - 1);
        let n_cells = mask.iter().map(|mask| mask + 1).product::<i64>() as usize;
        let cells = vec![Vec::new(); n_cells];
        Cells { inverse_size, reach_squared: reach * reach, mask, cells }
    }

    fn coordinates(&self, p: &Point) -> [i64; 3] {
        [0, 1, 2].map(|k| (p[k] * self.inverse_size).floor() as i64)
    }

    fn cell(&self, at: [i64; 3]) -> usize {
        let [i, j, k] = [0, 1, 2].map(|axis| at[axis] & self.mask[axis]);
        ((k * (self.mask[1] + 1) + j) * (self.mask[0] + 1) + i) as usize
    }

    /// Adds point `i`, which is at `p`.
    pub(crate) fn insert(&mut self, i: u32, p: &Point) {
        let cell = self.cell(self.coordinates(p));
        self.cells[cell].push(i);
    }

    /// Takes out point `i`, which is at `p`.
    pub(crate) fn remove(&mut self, i: u32, p: &Point) {
        let cell = self.cell(self.coordinates(p));
        let list = &mut self.cells[cell];
        let at = list.iter().position(|&j| j == i).expect("it is where it was put");
        list.swap_remove(at);
    }

    /// Lists the points within the reach of `p` in ascending order, but for `but`.
    pub(crate) fn near(&self, points: &[Point], p: &Point, but: u32, found: &mut Vec<u32>) {
        found.clear();
        let [i, j, k] = self.coordinates(p);
        for k in k - 1..=k + 1 {
            for j in j - 1..=j + 1 {
                for i in i - 1..=i + 1 {
                    let list = &self.cells[self.cell([i, j, k])];
                    let is_near =
                        |&&j: &&u32| squared_distance(p, &points[j as usize]) < self.reach_squared;
                    found.extend(list.iter().filter(is_near).filter(|&&j| j != but));
                }
            }
        }
        found.sort_unstable();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn near_are_those_that_are_near(
            mut points in prop::collection::vec([-3.0..3.0f64, -1.0..1.0, 0.0..2.0, 0.0..1.0], 1..60),
            reach in 0.05..2.0f64,
            moves in prop::collection::vec((0..60usize, [-9.0..9.0f64, -9.0..9.0, -9.0..9.0, 0.0..1.0]), 0..40),
        ) {
            let mut cells = Cells::over(&points, reach);
            (0..).zip(&points).for_each(|(i, p)| cells.insert(i, p));
            for (i, to) in moves {
                let i = i % points.len();
                cells.remove(i as u32, &points[i]);
                points[i] = to;
                cells.insert(i as u32, &to);
            }
            let mut found = Vec::new();
            for (i, p) in points.iter().enumerate() {
                cells.near(&points, p, i as u32, &mut found);
                let near = |&j: &u32| {
                    j as usize != i && squared_distance(p, &points[j as usize]) < reach * reach
                };
                let expected: Vec<u32> = (0..points.len() as u32).filter(near).collect();
                prop_assert_eq!(&found, &expected);
            }
        }
    }
}
