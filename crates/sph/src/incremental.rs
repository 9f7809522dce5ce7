//! What a step changes if most particles stand still: pairs of which neither side has changed are
//! never looked at (Manteaux2013 §3, §4).
//!
//! First densities: a pair changes its kernel value if one of the two has moved. Then pressures: a
//! density that has changed by little leaves the pressure as the accelerations have it. Then the
//! accelerations, by the pairs in which one of the two has a new position, velocity or pressure. What a
//! pair gave before is computed again from the old particles and taken away.
//!
//! Where the particles that change are close together, most of their pairs are among themselves: then
//! their sums are computed anew instead, as in a sweep that leaves out all others.

use crate::grid::Point;
use crate::lanes::{self, Four, LANES};
use crate::mend::rename;
use crate::neighbours::Neighbours;
use crate::pair::{Laws, Side, transpose};
use crate::place::{Place, named, pick, squared_distance};
use crate::state::State;
use crate::sweep::{self, Marked};
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
/// Has another acceleration.
const STALE: u8 = 16;
/// Has another density, but has not moved.
const NEAR: u8 = 32;

/// The part of the particles from which on it is not worth looking for those that no change has
/// reached (1).
const MOST_CHANGED: f64 = 0.4;
/// The part of the particles from which on, if movers are next to them, a sweep over everything costs less
/// (1), and of how many one is asked: scattered movers are next to most particles even where they are few.
const MOST_TOUCHED: f64 = 0.85;
const ASKED: usize = 8;
/// Time to bring a particle's pairs up to date, over that to compute its sums anew (1): densities, of
/// which both ends of a pair get the difference, and accelerations. Measured. New sums of densities find the
/// active neighbours, which accelerations need and the update of pairs makes useless.
const DENSITY_COST: f64 = 5.0;
const FORCE_COST: f64 = 2.5;

/// What is remembered from step to step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Changes {
    /// Positions and P, effective velocities and ρ as the accelerations have them.
    pub(crate) x: Vec<Point>,
    w: Vec<Point>,
    /// Particles, and particles of walls, that a particle has left that is gone.
    pub(crate) left: [Vec<u32>; 2],
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
    /// Particles whose accelerations are stale.
    stale: Vec<u32>,
    pub(crate) overdue: Overdue,
}

/// What has changed since the accelerations of particles that rest were computed last.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Overdue {
    /// Steps since then.
    pub(crate) age: u32,
    /// Particles that have been within the support of a mover, particles with another pressure, and
    /// particles of walls with another pressure; some several times.
    pub(crate) lists: [Vec<u32>; 3],
}

impl Overdue {
    /// True if there is nothing.
    pub(crate) fn is_empty(&self) -> bool {
        self.lists.iter().all(Vec::is_empty)
    }

    fn clear(&mut self) {
        self.age = 0;
        self.lists.iter_mut().for_each(Vec::clear);
    }
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
    pub(crate) neighbours: &'a mut Neighbours,
    /// The particles after kick and drift, with P and ρ as before.
    pub(crate) state: &'a mut State,
    /// Who has moved.
    pub(crate) movers: &'a [u32],
    /// Who has stopped.
    pub(crate) stopped: &'a [u32],
    /// To whom moving surfaces give another density.
    pub(crate) by_sheets: &'a [u32],
    /// Changes of pressure that do not count (Pa).
    pub(crate) tolerance: f64,
    /// Acceleration of gravity (m/s²).
    pub(crate) gravity: [f64; 3],
    /// Whether to leave it to a sweep where that costs less.
    pub(crate) may_leave: bool,
    /// In every how many steps the accelerations of particles that rest are computed.
    pub(crate) force_interval: u32,
    /// Whether there are new or removed particles: then there is nothing to take away or to add to.
    pub(crate) all_anew: bool,
    pub(crate) changes: &'a mut Changes,
}

impl Update<'_> {
    /// Brings densities and accelerations up to date. `None`, and nothing is changed, where it would take
    /// longer than to compute them anew.
    pub(crate) fn run(mut self) -> Option<Looked> {
        self.changes.marks.resize(self.state.len(), 0);
        self.changes.wall_marks.resize(self.walls.x.len(), 0);
        self.mark_movers();
        if self.may_leave && self.movers_are_everywhere() {
            self.changes.clear_marks();
            return None;
        }
        let by_sums = self.touched_by_movers();
        let density_pairs =
            if by_sums { self.densities_anew() } else { lanes::run(DensityChanges(&mut self)) };
        self.pressures();
        let is_due = self.changes.overdue.age + 1 >= self.force_interval;
        let force_pairs = if by_sums && !is_due {
            self.postpone();
            self.accelerations_anew()
        } else if self.touched_by_changes(by_sums, is_due) {
            self.accelerations_anew()
        } else {
            let pairs = lanes::run(ForceChanges(&mut self));
            match is_due && !self.changes.overdue.is_empty() {
                true => {
                    self.touched_by_overdue();
                    pairs + self.accelerations_anew()
                }
                false => pairs,
            }
        };
        let overdue = &mut self.changes.overdue;
        if is_due { overdue.clear() } else { overdue.age += 1 }
        let changed = self.changes.changed.len() as u64;
        self.changes.finish(self.state, self.walls);
        Some(Looked { density_pairs, force_pairs, changed })
    }

    /// True if there are movers next to most particles, by the word of some of these.
    fn movers_are_everywhere(&self) -> bool {
        let marks = &self.changes.marks;
        let moves = |i: &u32| marks[*i as usize] & MOVED != 0;
        let asked = (0..marks.len()).step_by(ASKED);
        let n = asked.len();
        // Few movers do not reach so many.
        let reach = |&i: &u32| 1 + self.neighbours.candidates(i as usize).len();
        let reached: usize = self.movers.iter().map(reach).sum();
        if reached as f64 <= MOST_TOUCHED * marks.len() as f64 {
            return false;
        }
        let touched = asked
            .filter(|&i| marks[i] & MOVED != 0 || self.neighbours.candidates(i).iter().any(moves));
        touched.count() as f64 > MOST_TOUCHED * n as f64
    }

    /// Marks who has moved or stopped.
    fn mark_movers(&mut self) {
        let Changes { marks, touched, changed, .. } = &mut *self.changes;
        for &i in self.movers {
            marks[i as usize] = MOVED | TURNED | TOUCHED | CHANGED;
        }
        touched.extend_from_slice(self.movers);
        touch(self.by_sheets, TOUCHED | NEAR, marks, touched);
        for &i in self.stopped {
            marks[i as usize] = TURNED | CHANGED;
        }
        changed.extend_from_slice(self.movers);
        changed.extend_from_slice(self.stopped);
    }

    /// Marks the particles that were within the support of a mover before the step, if these are so few
    /// that it is cheaper to compute their densities anew than to look at the pairs of the movers: where
    /// movers are close together. Returns false, and marks none, otherwise.
    fn touched_by_movers(&mut self) -> bool {
        let Changes { x: old_x, marks, touched, wall_marks, touched_walls, left, .. } =
            &mut *self.changes;
        let most = match self.all_anew {
            true => usize::MAX,
            false => (DENSITY_COST * self.movers.len() as f64) as usize,
        };
        let (n_before, n_walls_before) = (touched.len(), touched_walls.len());
        for &mover in self.movers {
            self.neighbours.within(
                mover as usize,
                old_x,
                self.walls,
                self.laws.kernel.support().powi(2),
                [
                    &mut |near| touch(near, TOUCHED | NEAR, marks, touched),
                    &mut |near| touch(near, TOUCHED, wall_marks, touched_walls),
                ],
            );
            if touched.len() > most {
                touched.drain(n_before..).for_each(|i| marks[i as usize] &= !(TOUCHED | NEAR));
                touched_walls.drain(n_walls_before..).for_each(|i| wall_marks[i as usize] = 0);
                return false;
            }
        }
        if self.all_anew {
            touch(&left[0], TOUCHED | NEAR, marks, touched);
            touch(&left[1], TOUCHED, wall_marks, touched_walls);
        }
        true
    }

    /// Computes the densities of what is touched anew: of the movers first, which finds whom they are near
    /// to now. Returns the number of pairs.
    fn densities_anew(&mut self) -> u64 {
        let Changes { marks, touched, wall_marks, touched_walls, .. } = &mut *self.changes;
        let State { x, density, .. } = &mut *self.state;
        let (laws, walls, neighbours) = (self.laws, &mut *self.walls, &mut *self.neighbours);
        let only = Some(Marked { marks, bits: MOVED });
        sweep::densities(laws, x, walls, neighbours, density, only);
        for &mover in self.movers {
            neighbours.within(
                mover as usize,
                x,
                walls,
                laws.kernel.support().powi(2),
                [
                    &mut |near| touch(near, TOUCHED | NEAR, marks, touched),
                    &mut |near| touch(near, TOUCHED, wall_marks, touched_walls),
                ],
            );
        }
        let only = Some(Marked { marks, bits: NEAR });
        sweep::densities(laws, x, walls, neighbours, density, only);
        let only = Some(Marked { marks: wall_marks, bits: TOUCHED });
        sweep::wall_densities(laws, x, walls, neighbours, only);
        pairs_of(touched, neighbours)
    }

    /// Marks all particles that may have another acceleration, those by what is overdue included if it
    /// `is_due`. Returns false, and marks none, if computing theirs anew costs more than looking at the pairs
    /// of what has changed. Where densities were computed `by_sums`, what is touched is all that movers are
    /// or were near to.
    fn touched_by_changes(&mut self, by_sums: bool, is_due: bool) -> bool {
        let Changes { marks, touched, changed, changed_walls, stale, .. } = &mut *self.changes;
        if changed.len() as f64 > MOST_CHANGED * marks.len() as f64 {
            stale.extend(0..marks.len() as u32);
            marks.iter_mut().for_each(|mark| *mark |= STALE);
            return true;
        }
        let most = match self.all_anew {
            true => usize::MAX,
            false => (FORCE_COST * changed.len() as f64) as usize,
        };
        if by_sums {
            touch(touched, STALE, marks, stale);
        }
        for &here in changed.iter() {
            touch(&[here], STALE, marks, stale);
            if by_sums && marks[here as usize] & MOVED == 0 {
                self.neighbours.within(
                    here as usize,
                    &self.state.x,
                    self.walls,
                    self.laws.kernel.support().powi(2),
                    [&mut |near| touch(near, STALE, marks, stale), &mut |_| ()],
                );
            } else if !by_sums {
                touch(self.neighbours.candidates(here as usize), STALE, marks, stale);
            }
            if stale.len() > most {
                stale.drain(..).for_each(|i| marks[i as usize] &= !STALE);
                return false;
            }
        }
        for &wall in changed_walls.iter() {
            let near = match by_sums {
                true => self.neighbours.fluid_within(wall as usize),
                false => self.neighbours.fluid_candidates(wall as usize),
            };
            touch(near, STALE, marks, stale);
        }
        if is_due {
            self.touched_by_overdue();
        }
        true
    }

    /// Marks all particles that may have another acceleration by what is overdue. What rests now and has
    /// been near to something that moved has been touched by that.
    fn touched_by_overdue(&mut self) {
        let Changes { marks, stale, overdue, .. } = &mut *self.changes;
        let [touched, changed, walls] = &overdue.lists;
        touch(touched, STALE, marks, stale);
        for &here in changed {
            touch(&[here], STALE, marks, stale);
            self.neighbours.within(
                here as usize,
                &self.state.x,
                self.walls,
                self.laws.kernel.support().powi(2),
                [&mut |near| touch(near, STALE, marks, stale), &mut |_| ()],
            );
        }
        for &wall in walls {
            touch(self.neighbours.fluid_candidates(wall as usize), STALE, marks, stale);
        }
    }

    /// Marks only those that move or have just stopped, and notes what has changed for the others.
    fn postpone(&mut self) {
        let Changes { marks, touched, changed, changed_walls, stale, overdue, .. } =
            &mut *self.changes;
        let turned = |i: &u32, marks: &[u8]| marks[*i as usize] & TURNED != 0;
        for &here in changed.iter() {
            if turned(&here, marks) {
                touch(&[here], STALE, marks, stale);
            }
        }
        let [all_touched, all_changed, all_walls] = &mut overdue.lists;
        all_touched.extend_from_slice(touched);
        let has_not_moved = |i: &u32| marks[*i as usize] & MOVED == 0;
        all_changed.extend(changed.iter().copied().filter(has_not_moved));
        all_walls.extend_from_slice(changed_walls);
    }

    /// Computes stale accelerations anew. Returns the number of pairs.
    fn accelerations_anew(&mut self) -> u64 {
        let only = Marked { marks: &self.changes.marks, bits: STALE };
        let stale = (self.gravity, Some(only));
        let State { x, w, a, .. } = &mut *self.state;
        sweep::accelerations(self.laws, x, w, self.walls, self.neighbours, stale, a);
        pairs_of(&self.changes.stale, self.neighbours)
    }

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
            let density = self.state.full_density(k);
            let (p, w) = (&mut self.state.x[k], &mut self.state.w[k]);
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

/// Marks particles that have none of these marks, and lists them.
#[inline(always)]
fn touch(which: &[u32], bits: u8, marks: &mut [u8], list: &mut Vec<u32>) {
    for &j in which {
        let mark = &mut marks[j as usize];
        if *mark & bits == 0 {
            *mark |= bits;
            list.push(j);
        }
    }
}

/// Pairs of fluid particles in the lists of some particles, each counted once.
fn pairs_of(list: &[u32], neighbours: &Neighbours) -> u64 {
    list.iter().map(|&i| neighbours.candidates(i as usize).len() as u64).sum::<u64>() / 2
}

/// The densities by pairs.
struct DensityChanges<'u, 'a>(&'u mut Update<'a>);

impl WithSimd for DensityChanges<'_, '_> {
    type Output = u64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> u64 {
        self.0.densities(simd)
    }
}

/// The accelerations by pairs.
struct ForceChanges<'u, 'a>(&'u mut Update<'a>);

impl WithSimd for ForceChanges<'_, '_> {
    type Output = u64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> u64 {
        self.0.accelerations(simd)
    }
}

impl Changes {
    /// Everything has been computed from this state.
    pub(crate) fn evaluated_all(&mut self, state: &State, walls: &WallState) {
        self.overdue.clear();
        self.x.clone_from(&state.x);
        self.w.clone_from(&state.w);
        self.wall_terms.clear();
        self.wall_terms.extend(walls.x.iter().map(|x| x[3]));
    }

    /// What was computed is not known here.
    pub(crate) fn forget(&mut self) {
        self.x.clear();
        self.overdue.clear();
    }

    /// True if what was computed is known here.
    pub(crate) fn is_known(&self, n_particles: usize) -> bool {
        self.x.len() == n_particles
    }

    /// A particle is gone; the last one gets its place.
    pub(crate) fn swap_remove(&mut self, i: usize) {
        let last = self.x.len() as u32 - 1;
        self.overdue.lists[..2].iter_mut().for_each(|list| rename(list, i as u32, last));
        self.x.swap_remove(i);
        self.w.swap_remove(i);
    }

    /// There is a new particle, the last one, for which nothing has been computed.
    pub(crate) fn push(&mut self, x: &Point, w: &Point) {
        self.x.push(*x);
        self.w.push(*w);
    }

    /// Fluid may touch more of the walls than before; nothing has been computed for these.
    pub(crate) fn know_walls(&mut self, walls: &WallState) {
        let new = &walls.x[self.wall_terms.len()..];
        self.wall_terms.extend(new.iter().map(|x| x[3]));
    }

    /// Takes over what has been computed, and removes the marks.
    fn finish(&mut self, state: &State, walls: &WallState) {
        for &i in &self.changed {
            let i = i as usize;
            (self.x[i], self.w[i]) = (state.x[i], state.w[i]);
        }
        for &j in &self.changed_walls {
            self.wall_terms[j as usize] = walls.x[j as usize][3];
        }
        self.clear_marks();
    }

    /// Removes all marks.
    fn clear_marks(&mut self) {
        for &i in self.touched.iter().chain(&self.changed).chain(&self.stale) {
            self.marks[i as usize] = 0;
        }
        for &j in &self.touched_walls {
            self.wall_marks[j as usize] = 0;
        }
        self.touched.clear();
        self.changed.clear();
        self.stale.clear();
        self.touched_walls.clear();
        self.changed_walls.clear();
    }
}
