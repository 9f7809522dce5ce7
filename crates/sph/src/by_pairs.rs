//! What changes, pair by pair: what a pair gave before is computed again and taken away.

use crate::changes::{CHANGED, Changes, MOVED, TOUCHED, TURNED};
use crate::grid::Point;
use crate::incremental::Update;
use crate::lanes::{Four, LANES};
use crate::pair::{Side, transpose};
use crate::place::{Place, named, pick, squared_distance};
use pulp::{Simd, WithSimd};

impl Update<'_> {
    /// Densities by the pairs with a mover. Returns how many.
    #[inline(always)]
    fn densities<S: Simd>(&mut self, simd: S) -> u64 {
        let Changes { x: old_x, marks, touched, wall_marks, touched_walls, .. } =
            &mut *self.changes;
        let kernel = &self.laws.kernel;
        let (x, density) = (&self.state.x, &mut self.state.density);
        let mut n_pairs = 0;
        for &mover in self.movers {
            let i = mover as usize;
            let (new, old) = (Place::splat(simd, &x[i]), Place::splat(simd, &old_x[i]));
            let mut own = 0.0;
            for at in self.neighbours.candidates(i).chunks(LANES) {
                let there = named(at, mover);
                let new = new.squared_distance(&Place::gather(simd, x, there));
                let old = old.squared_distance(&Place::gather(simd, old_x, there));
                let (new, old) = (kernel.value_and_slope(new).0, kernel.value_and_slope(old).0);
                let by = ((new - old) * self.laws.mass).array();
                for (&j, &by) in at.iter().zip(&by) {
                    let mark = &mut marks[j as usize];
                    // A pair of movers belongs to the first of them.
                    if by == 0.0 || (*mark & MOVED != 0 && j < mover) {
                        continue;
                    }
                    own += by;
                    density[j as usize] += by;
                    if *mark & TOUCHED == 0 {
                        *mark |= TOUCHED;
                        touched.push(j);
                    }
                    n_pairs += 1;
                }
            }
            for &j in self.neighbours.wall_candidates(i) {
                let k = j as usize;
                let value = |p: &Point| kernel.value(squared_distance(p, &self.walls.x[k]));
                let by = value(&x[i]) - value(&old_x[i]);
                if by == 0.0 {
                    continue;
                }
                own += self.walls.mass[k] * by;
                self.walls.density[k] += self.laws.mass * by;
                if wall_marks[k] & TOUCHED == 0 {
                    wall_marks[k] |= TOUCHED;
                    touched_walls.push(j);
                }
            }
            density[i] += own;
        }
        for &i in touched.iter() {
            self.neighbours.outdate(i as usize);
        }
        n_pairs
    }

    /// Accelerations by the pairs with a changed particle. Returns how many.
    #[inline(always)]
    fn accelerations<S: Simd>(&mut self, simd: S) -> u64 {
        let laws = self.laws;
        let Changes { x: old_x, w: old_w, marks, changed, near, wall_terms, changed_walls, .. } =
            &mut *self.changes;
        let (x, w, a) = (&self.state.x, &self.state.w, &mut self.state.a);
        let kernel = &laws.kernel;
        let support_squared = kernel.support() * kernel.support();
        let mut n_pairs = 0;
        for &here in changed.iter() {
            let i = here as usize;
            let mut own = [0.0; 3];
            let mut give = |at: &[u32], by: [[f64; LANES]; 3]| {
                for (l, &j) in at.iter().enumerate() {
                    let there = &mut a[j as usize];
                    for k in 0..3 {
                        own[k] += by[k][l];
                        there[k] -= by[k][l];
                    }
                }
            };
            let turned = marks[i] & TURNED != 0;
            // Neighbours that stand still as this particle does come first: between those only
            // pressures change.
            let candidates = self.neighbours.candidates(i);
            near.resize(candidates.len(), 0);
            let (mut n_still, mut from) = (0, candidates.len());
            for &j in candidates {
                let mark = marks[j as usize];
                // A pair of changed particles belongs to the first of them.
                let elsewhere = mark & CHANGED != 0 && j < here;
                let is_near = squared_distance(&x[i], &x[j as usize]) < support_squared;
                if turned || mark & TURNED != 0 {
                    let was_near =
                        squared_distance(&old_x[i], &old_x[j as usize]) < support_squared;
                    near[from - 1] = j;
                    from -= usize::from(!elsewhere && (is_near || was_near));
                } else {
                    near[n_still] = j;
                    n_still += usize::from(!elsewhere && is_near);
                }
            }
            n_pairs += (n_still + candidates.len() - from) as u64;
            let new_here = Side::splat(simd, &x[i], &w[i]);
            let old_here = Side::splat(simd, &old_x[i], &old_w[i]);
            for at in near[..n_still].chunks(LANES) {
                let there = named(at, here);
                let [x0, x1, x2, new_term] = transpose(simd, pick(x, there));
                let [_, _, _, old_term] = transpose(simd, pick(old_x, there));
                let rise =
                    (new_here.pressure_term - old_here.pressure_term) + (new_term - old_term);
                let squared = Place(new_here.x).squared_distance(&Place([x0, x1, x2]));
                let slope = kernel.value_and_slope(squared).1;
                let by = laws.by_pressure(&new_here.x, &[x0, x1, x2], rise, slope);
                give(at, by.map(Four::array));
            }
            for at in near[from..candidates.len()].chunks(LANES) {
                let there = named(at, here);
                let new_there = Side::gather(simd, pick(x, there), pick(w, there));
                let old_there = Side::gather(simd, pick(old_x, there), pick(old_w, there));
                let new_squared = Place(new_here.x).squared_distance(&Place(new_there.x));
                let old_squared = Place(old_here.x).squared_distance(&Place(old_there.x));
                let new =
                    laws.between(&new_here, &new_there, kernel.value_and_slope(new_squared).1);
                let old =
                    laws.between(&old_here, &old_there, kernel.value_and_slope(old_squared).1);
                give(at, [0, 1, 2].map(|k| (new[k] - old[k]).array()));
            }
            let (new_here, old_here) = (Side::new(&x[i], &w[i]), Side::new(&old_x[i], &old_w[i]));
            for &j in self.neighbours.wall_candidates(i) {
                let (wall, mass) = (&self.walls.x[j as usize], self.walls.mass[j as usize]);
                let place = [wall[0], wall[1], wall[2]];
                let by = |side: &Side<f64>, p: &Point, term: f64| {
                    let slope = kernel.slope_over_r(squared_distance(p, wall));
                    laws.by_wall(side, &place, term, mass, slope)
                };
                let old_term = wall_terms[j as usize];
                let new = by(&new_here, &x[i], wall[3]);
                let old = by(&old_here, &old_x[i], old_term);
                for k in 0..3 {
                    own[k] += new[k] - old[k];
                }
            }
            for k in 0..3 {
                a[i][k] += own[k];
            }
        }
        for &j in changed_walls.iter() {
            let (wall, mass) = (&self.walls.x[j as usize], self.walls.mass[j as usize]);
            let rise = wall[3] - wall_terms[j as usize];
            for &i in self.neighbours.fluid_candidates(j as usize) {
                // What has changed itself has the new pressure already.
                if marks[i as usize] & CHANGED == 0 {
                    let (x, a) = (&x[i as usize], &mut a[i as usize]);
                    let s = -rise * mass * kernel.slope_over_r(squared_distance(x, wall));
                    for k in 0..3 {
                        a[k] += s * (x[k] - wall[k]);
                    }
                }
            }
        }
        n_pairs
    }
}

/// The densities by pairs.
pub(crate) struct DensityChanges<'u, 'a>(pub(crate) &'u mut Update<'a>);

impl WithSimd for DensityChanges<'_, '_> {
    type Output = u64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> u64 {
        self.0.densities(simd)
    }
}

/// The accelerations by pairs.
pub(crate) struct ForceChanges<'u, 'a>(pub(crate) &'u mut Update<'a>);

impl WithSimd for ForceChanges<'_, '_> {
    type Output = u64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> u64 {
        self.0.accelerations(simd)
    }
}
