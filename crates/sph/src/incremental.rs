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
use crate::walls::WallState;
use pulp::{Simd, WithSimd};

/// Has another position.
const MOVED: u8 = 1;
/// Has another effective velocity, or may have.
const TURNED: u8 = 2;
/// Has another density.
const TOUCHED: u8 = 4;
/// Has another position, velocity or pressure.
const CHANGED: u8 = 8;

/// The part of the particles above which changes cost more than everything anew (1).
const MOST_CHANGED: f64 = 0.4;
/// Longest pause between two tries, in steps.
const LONGEST_PAUSE: u32 = 32;

/// What is remembered from step to step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Changes {
    /// Positions and P, effective velocities and ρ as the accelerations have them.
    x: Vec<Point>,
    w: Vec<Point>,
    /// P of the touched walls as the accelerations have it.
    wall_terms: Vec<f64>,
    /// The same marks and lists for the walls: another density, another pressure.
    wall_marks: Vec<u8>,
    touched_walls: Vec<u32>,
    changed_walls: Vec<u32>,
    /// Marks of particles and lists of those that have one; empty between two steps.
    marks: Vec<u8>,
    touched: Vec<u32>,
    changed: Vec<u32>,
    /// Neighbours that are looked at for a particle.
    near: Vec<u32>,
    /// Steps until the next try, and how many there were after the last one that was in vain.
    pub(crate) wait: u32,
    pub(crate) pause: u32,
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
    pub(crate) walls: &'a mut WallState,
    pub(crate) neighbours: &'a Neighbours,
    /// The particles after kick and drift, with P and ρ as before.
    pub(crate) state: &'a mut State,
    /// Who has moved.
    pub(crate) movers: &'a [u32],
    /// Who has stopped.
    pub(crate) stopped: &'a [u32],
    /// Changes of pressure that do not count (Pa).
    pub(crate) tolerance: f64,
    pub(crate) changes: &'a mut Changes,
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
        let Changes { x: old_x, marks, touched, changed, wall_marks, touched_walls, .. } =
            &mut *self.changes;
        let kernel = &self.laws.kernel;
        let (x, density) = (&self.state.x, &mut self.state.density);
        for &i in self.movers {
            marks[i as usize] = MOVED | TURNED | TOUCHED | CHANGED;
            touched.push(i);
            changed.push(i);
        }
        for &i in self.stopped {
            marks[i as usize] = TURNED | CHANGED;
            changed.push(i);
        }
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
        n_pairs
    }

    /// Gives the particles their new pressures and lists those for which something has changed.
    #[inline(always)]
    fn pressures(&mut self) {
        let Changes { marks, touched, changed, wall_marks, touched_walls, changed_walls, .. } =
            &mut *self.changes;
        for &j in touched_walls.iter() {
            let k = j as usize;
            let (x, density) = (&mut self.walls.x[k], self.walls.density[k]);
            let term = self.laws.pressure_term(density);
            if (term - x[3]).abs() * density * density > self.tolerance {
                x[3] = term;
                wall_marks[k] |= CHANGED;
                changed_walls.push(j);
            }
        }
        for &i in touched.iter() {
            let k = i as usize;
            let (p, w, density) =
                (&mut self.state.x[k], &mut self.state.w[k], self.state.density[k]);
            let term = self.laws.pressure_term(density);
            let difference = term * density * density - p[3] * w[3] * w[3];
            let known = marks[k] & CHANGED != 0;
            if known || difference.abs() > self.tolerance {
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

impl WithSimd for Update<'_> {
    type Output = Option<Looked>;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Option<Looked> {
        self.changes.marks.resize(self.state.len(), 0);
        self.changes.wall_marks.resize(self.walls.x.len(), 0);
        let density_pairs = self.densities(simd);
        self.pressures();
        let n_changed = self.changes.changed.len();
        let worth_it = n_changed as f64 <= MOST_CHANGED * self.state.len() as f64;
        let looked = worth_it.then(|| {
            let force_pairs = self.accelerations(simd);
            Looked { density_pairs, force_pairs, changed: n_changed as u64 }
        });
        self.changes.finish(self.state, self.walls, worth_it);
        looked
    }
}

impl Changes {
    /// Everything has been computed from this state.
    pub(crate) fn evaluated_all(&mut self, state: &State, walls: &WallState) {
        self.x.clone_from(&state.x);
        self.w.clone_from(&state.w);
        self.wall_terms.clear();
        self.wall_terms.extend(walls.x.iter().map(|x| x[3]));
    }

    /// What was computed is not known here.
    pub(crate) fn forget(&mut self) {
        self.x.clear();
    }

    /// True if it is time for a try: after one that was in vain the next ones are too, mostly. Not
    /// before everything was computed once.
    pub(crate) fn may_try(&mut self, n_particles: usize) -> bool {
        if self.wait > 0 {
            self.wait -= 1;
            return false;
        }
        self.is_known(n_particles)
    }

    /// True if what was computed is known here.
    pub(crate) fn is_known(&self, n_particles: usize) -> bool {
        self.x.len() == n_particles
    }

    /// Takes over what has been computed, and removes the marks.
    fn finish(&mut self, state: &State, walls: &WallState, worth_it: bool) {
        if worth_it {
            for &i in &self.changed {
                let i = i as usize;
                (self.x[i], self.w[i]) = (state.x[i], state.w[i]);
            }
            for &j in &self.changed_walls {
                self.wall_terms[j as usize] = walls.x[j as usize][3];
            }
            self.pause = 0;
        } else {
            self.pause = (2 * self.pause + 1).min(LONGEST_PAUSE);
            self.wait = self.pause;
        }
        for &i in self.touched.iter().chain(&self.changed) {
            self.marks[i as usize] = 0;
        }
        for &j in &self.touched_walls {
            self.wall_marks[j as usize] = 0;
        }
        self.touched.clear();
        self.changed.clear();
        self.touched_walls.clear();
        self.changed_walls.clear();
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
