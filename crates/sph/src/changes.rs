//! What is remembered from step to step of what has been computed, and the marks of what a step changes.

use crate::grid::Point;
use crate::mend::rename;
use crate::state::State;
use crate::walls::WallState;

/// Has another position.
pub(crate) const MOVED: u8 = 1;
/// Has another effective velocity, or may have.
pub(crate) const TURNED: u8 = 2;
/// Has another density.
pub(crate) const TOUCHED: u8 = 4;
/// Has another position, velocity or pressure.
pub(crate) const CHANGED: u8 = 8;
/// Has another acceleration.
pub(crate) const STALE: u8 = 16;
/// Has another density, but has not moved.
pub(crate) const NEAR: u8 = 32;

/// What is remembered from step to step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Changes {
    /// Positions and P, effective velocities and ρ as the accelerations have them.
    pub(crate) x: Vec<Point>,
    pub(crate) w: Vec<Point>,
    /// Particles, and particles of walls, that a particle has left that is gone.
    pub(crate) left: [Vec<u32>; 2],
    /// P of the touched walls as the accelerations have it.
    pub(crate) wall_terms: Vec<f64>,
    /// The same marks and lists for the walls: another density, another pressure.
    pub(crate) wall_marks: Vec<u8>,
    pub(crate) touched_walls: Vec<u32>,
    pub(crate) changed_walls: Vec<u32>,
    /// Marks of particles and lists of those that have one; empty between two steps.
    pub(crate) marks: Vec<u8>,
    pub(crate) touched: Vec<u32>,
    pub(crate) changed: Vec<u32>,
    /// Neighbours that are looked at for a particle.
    pub(crate) near: Vec<u32>,
    /// Particles whose accelerations are stale.
    pub(crate) stale: Vec<u32>,
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

    pub(crate) fn clear(&mut self) {
        self.age = 0;
        self.lists.iter_mut().for_each(Vec::clear);
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
    pub(crate) fn finish(&mut self, state: &State, walls: &WallState) {
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
    pub(crate) fn clear_marks(&mut self) {
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
