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

use crate::by_pairs::{DensityChanges, ForceChanges};
use crate::changes::{CHANGED, Changes, MOVED, NEAR, STALE, TOUCHED, TURNED};
use crate::lanes;
use crate::neighbours::Neighbours;
use crate::pair::Laws;
use crate::state::State;
use crate::sweep::{self, Marked};
use crate::walls::WallState;

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
        if is_due {
            overdue.clear()
        } else {
            overdue.age += 1
        }
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
                [&mut |near| touch(near, TOUCHED | NEAR, marks, touched), &mut |near| {
                    touch(near, TOUCHED, wall_marks, touched_walls)
                }],
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
                [&mut |near| touch(near, TOUCHED | NEAR, marks, touched), &mut |near| {
                    touch(near, TOUCHED, wall_marks, touched_walls)
                }],
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
