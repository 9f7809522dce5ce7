//! What a step changes if most particles stand still: pairs of which neither side has changed are
//! never looked at (Manteaux2013 §3, §4).
//!
//! First densities: a pair changes its kernel value if one of the two has moved. Then pressures: a
//! density that has changed by little leaves the pressure as the accelerations have it. Then the
//! accelerations, by the pairs in which one of the two has a new position, velocity or pressure. What a
//! pair gave before is computed again from the old particles and taken away.

use crate::grid::Point;
use crate::lanes::{self, Four, LANES};
use crate::neighbours::Neighbours;
use crate::pair::{Laws, Side, transpose};
use crate::state::State;
use crate::walls::Walls;
use pulp::{Simd, WithSimd};

/// Has moved.
const MOVED: u8 = 1;
/// Has a new density.
const TOUCHED: u8 = 2;
/// Has a new position, velocity or pressure.
const CHANGED: u8 = 4;

/// Marks and lists of the particles that a step changes; empty between two steps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Changes {
    marks: Vec<u8>,
    touched: Vec<u32>,
    changed: Vec<u32>,
}

/// How much was looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Looked {
    /// Pairs for densities.
    pub(crate) density_pairs: u64,
    /// Pairs for accelerations.
    pub(crate) force_pairs: u64,
    /// Particles with a new position, velocity or pressure.
    pub(crate) changed: u64,
}

/// All that an update needs.
pub(crate) struct Update<'a> {
    pub(crate) laws: &'a Laws,
    pub(crate) walls: &'a Walls,
    pub(crate) neighbours: &'a Neighbours,
    /// Positions and P before the step.
    pub(crate) old_x: &'a [Point],
    /// Effective velocities and ρ before the step.
    pub(crate) old_w: &'a [Point],
    /// The particles after kick and drift, with P and ρ as before.
    pub(crate) state: &'a mut State,
    /// Who has moved.
    pub(crate) movers: &'a [u32],
    /// Who has stopped.
    pub(crate) stopped: &'a [u32],
    /// Changes of pressure that do not count (Pa).
    pub(crate) tolerance: f64,
    pub(crate) changes: &'a mut Changes,
    /// Most particles with changes before it is better to compute everything anew.
    pub(crate) most_changed: usize,
}

impl Update<'_> {
    /// Brings densities and accelerations up to date. Returns nothing, and leaves the accelerations as
    /// they were, if too many particles have changed: then everything has to be computed anew.
    pub(crate) fn run(self) -> Option<Looked> {
        lanes::run(self)
    }

    /// Densities by the pairs with a mover. Returns how many.
    #[inline(always)]
    fn densities<S: Simd>(&mut self, simd: S) -> u64 {
        let Changes { marks, touched, .. } = &mut *self.changes;
        let kernel = &self.laws.kernel;
        let (x, density) = (&self.state.x, &mut self.state.density);
        let mut n_pairs = 0;
        for &i in self.movers {
            marks[i as usize] |= MOVED | TOUCHED;
            touched.push(i);
        }
        for &mover in self.movers {
            let i = mover as usize;
            let (new, old) = (Place::splat(simd, &x[i]), Place::splat(simd, &self.old_x[i]));
            let mut own = 0.0;
            for at in self.neighbours.candidates(i).chunks(LANES) {
                let there = named(at, mover);
                let new = new.squared_distance(&Place::gather(simd, x, there));
                let old = old.squared_distance(&Place::gather(simd, self.old_x, there));
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
                let wall = &self.walls.points()[j as usize];
                let value = |p: &Point| kernel.value(squared_distance(p, wall));
                own += wall[3] * (value(&x[i]) - value(&self.old_x[i]));
            }
            density[i] += own;
        }
        n_pairs
    }

    /// Gives the particles their new pressures and lists those for which something has changed.
    #[inline(always)]
    fn pressures(&mut self) {
        let Changes { marks, touched, changed } = &mut *self.changes;
        for &i in self.stopped {
            marks[i as usize] |= CHANGED;
            changed.push(i);
        }
        for &i in touched.iter() {
            let k = i as usize;
            let (p, w, density) = (&mut self.state.x[k], &mut self.state.w[k], self.state.density[k]);
            let term = self.laws.pressure_term(density);
            let difference = term * density * density - p[3] * w[3] * w[3];
            let known = marks[k] & CHANGED != 0;
            if known || marks[k] & MOVED != 0 || difference.abs() > self.tolerance {
                (p[3], w[3]) = (term, density);
                if !known {
                    marks[k] |= CHANGED;
                    changed.push(i);
                }
            }
        }
    }

    /// Accelerations by the pairs with a changed particle. Returns how many.
    #[inline(always)]
    fn accelerations<S: Simd>(&mut self, simd: S) -> u64 {
        let (laws, Changes { marks, changed, .. }) = (self.laws, &*self.changes);
        let (x, w, a) = (&self.state.x, &self.state.w, &mut self.state.a);
        let (old_x, old_w) = (self.old_x, self.old_w);
        let kernel = &laws.kernel;
        let support_squared = kernel.support() * kernel.support();
        let mut n_pairs = 0;
        for &here in changed {
            let i = here as usize;
            let new_here = Side::splat(simd, &x[i], &w[i]);
            let old_here = Side::splat(simd, &old_x[i], &old_w[i]);
            let mut own = [0.0; 3];
            for at in self.neighbours.candidates(i).chunks(LANES) {
                let there = named(at, here);
                let new_there = Side::gather(simd, pick(x, there), pick(w, there));
                let old_there = Side::gather(simd, pick(old_x, there), pick(old_w, there));
                let new_squared = Place(new_here.x).squared_distance(&Place(new_there.x));
                let old_squared = Place(old_here.x).squared_distance(&Place(old_there.x));
                let near = new_squared.array().map(|squared| squared < support_squared);
                let was_near = old_squared.array().map(|squared| squared < support_squared);
                let new = laws.between(&new_here, &new_there, kernel.value_and_slope(new_squared).1);
                let old = laws.between(&old_here, &old_there, kernel.value_and_slope(old_squared).1);
                let by = [0, 1, 2].map(|k| (new[k] - old[k]).array());
                for (l, &j) in at.iter().enumerate() {
                    let both = marks[j as usize] & CHANGED != 0;
                    if !(near[l] | was_near[l]) || (both && j < here) {
                        continue;
                    }
                    let there = &mut a[j as usize];
                    for k in 0..3 {
                        own[k] += by[k][l];
                        there[k] -= by[k][l];
                    }
                    n_pairs += 1;
                }
            }
            let (new_here, old_here) = (Side::new(&x[i], &w[i]), Side::new(&old_x[i], &old_w[i]));
            for &j in self.neighbours.wall_candidates(i) {
                let wall = &self.walls.points()[j as usize];
                let place = [wall[0], wall[1], wall[2]];
                let by = |side: &Side<f64>, p: &Point| {
                    let slope = kernel.slope_over_r(squared_distance(p, wall));
                    laws.by_wall(side, &place, wall[3], slope)
                };
                let (new, old) = (by(&new_here, &x[i]), by(&old_here, &old_x[i]));
                for k in 0..3 {
                    own[k] += new[k] - old[k];
                }
            }
            for k in 0..3 {
                a[i][k] += own[k];
            }
        }
        n_pairs
    }
}

impl WithSimd for Update<'_> {
    type Output = Option<Looked>;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Option<Looked> {
        self.changes.marks.resize(self.state.len(), 0);
        let density_pairs = self.densities(simd);
        self.pressures();
        let n_changed = self.changes.changed.len();
        let looked = (n_changed <= self.most_changed).then(|| {
            let force_pairs = self.accelerations(simd);
            Looked { density_pairs, force_pairs, changed: n_changed as u64 }
        });
        self.changes.clear();
        looked
    }
}

impl Changes {
    fn clear(&mut self) {
        for &i in self.touched.iter().chain(&self.changed) {
            self.marks[i as usize] = 0;
        }
        self.touched.clear();
        self.changed.clear();
    }
}

/// One place or four.
struct Place<N>([N; 3]);

impl<S: Simd> Place<Four<S>> {
    #[inline(always)]
    fn splat(simd: S, p: &Point) -> Self {
        Place([0, 1, 2].map(|k| Four::splat(simd, p[k])))
    }

    #[inline(always)]
    fn gather(simd: S, list: &[Point], at: [u32; LANES]) -> Self {
        let [x, y, z, _] = transpose(simd, pick(list, at));
        Place([x, y, z])
    }

    #[inline(always)]
    fn squared_distance(&self, other: &Self) -> Four<S> {
        let d = [0, 1, 2].map(|k| self.0[k] - other.0[k]);
        d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
    }
}

fn squared_distance(p: &Point, q: &Point) -> f64 {
    let d = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
}

/// Up to four numbers of particles, filled up with `filler`.
#[inline(always)]
fn named(at: &[u32], filler: u32) -> [u32; LANES] {
    [0, 1, 2, 3].map(|l| at.get(l).copied().unwrap_or(filler))
}

#[inline(always)]
fn pick(list: &[Point], at: [u32; LANES]) -> [&Point; LANES] {
    at.map(|j| &list[j as usize])
}
