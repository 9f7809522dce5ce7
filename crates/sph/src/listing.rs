//! Particles that come and go, and the lists of neighbours of a fluid: made anew while most of it moves,
//! mended while most of it rests.

use crate::fluid::Fluid;
use crate::mend::{Surroundings, rename};
use crate::motion::larger;
use crate::place::squared_distance;
use crate::report::StepReport;
use crate::source::Sink;
use arps::Restraint;
use nalgebra::Vector3;

/// How many lists are mended until the particles are sorted again, over their number (1): those that move
/// are farther and farther in memory from those that they are near to.
const MOST_MENDED: f64 = 0.5;
/// While everything is computed in each step: the part of half the skin from which on a particle is soon far
/// from where it was listed (1), and the part of the particles from which on, if they are, listing all
/// costs less than mending (1).
const SOON: f64 = 0.7;
const MOST_SOON: f64 = 1.0 / 16.0;

impl<R: Restraint> Fluid<R> {
    /// How far a particle may be from where it was listed (m).
    pub(crate) fn half_skin(&self) -> f64 {
        0.5 * self.settings.skin * self.settings.spacing
    }

    /// True if the next step can begin from what is known.
    fn is_known(&self) -> bool {
        let n = self.state.len();
        self.restraint.is_some() && n > 0 && self.scratch.changes.is_known(n)
    }

    /// True if particles come or go now.
    fn is_due(&self) -> bool {
        let spacing = self.settings.spacing;
        self.emitters.iter().any(|emitter| emitter.is_due(self.time, spacing))
            || !self.sinks.is_empty() && self.state.x.iter().any(|x| swallowed(&self.sinks, x))
    }

    /// True if particles have to be sorted before the next step.
    pub(crate) fn is_out_of_order(&self) -> bool {
        self.is_known()
            && self.scratch.changes.overdue.is_empty()
            && self.neighbours.n_mended as f64 > MOST_MENDED * self.state.len() as f64
    }

    /// After a motion: lists those that are far from where they were listed anew, and lets particles come and
    /// go. Returns false, and does nothing, where it is better or necessary to list all.
    ///
    /// Two that were within the support before the step are in each other's lists after it: they may have
    /// come half a skin each away from where they were listed or, at the end of the step, are listed where
    /// they are, half a skin or less from where they were.
    pub(crate) fn mend_lists(&mut self, report: &mut StepReport) -> bool {
        let n = self.state.len();
        let half_skin_squared = self.half_skin() * self.half_skin();
        let is_known = self.is_known();
        if is_known {
            let (moved, changes) = (&self.scratch.moved, &self.scratch.changes);
            let way =
                |i: &u32| squared_distance(&self.state.x[*i as usize], &changes.x[*i as usize]);
            let longest = moved.movers.iter().map(way).fold(0.0, |most, way| larger(way, most));
            if longest > half_skin_squared {
                return false;
            }
        } else if self.farthest <= self.half_skin() && !self.is_due() {
            return true;
        } else {
            let far = self.state.x.iter().zip(&self.listed).map(|(x, r)| squared_distance(x, r));
            let n_soon = far.filter(|&far| far > SOON * SOON * half_skin_squared).count();
            let is_too_many = n_soon as f64 > MOST_SOON * n as f64;
            if is_too_many || self.neighbours.n_mended as f64 > MOST_MENDED * n as f64 {
                return false;
            }
        }
        let reach = self.reach();
        let n_mended = self.neighbours.n_mended;
        let (moved, changes) = (&mut self.scratch.moved, &mut self.scratch.changes);
        let listed = &mut self.listed;
        let around = &mut Surroundings { walls: &self.walls, touched: &mut self.touched, reach };
        self.neighbours.prepare_mending(listed, reach);
        let x = &self.state.x;
        let mut renew = |i: usize| {
            if squared_distance(&x[i], &listed[i]) > half_skin_squared {
                self.neighbours.renew(i, &x[i], listed, around);
            }
        };
        match is_known {
            true => moved.movers.iter().for_each(|&i| renew(i as usize)),
            false => (0..n).for_each(renew),
        }
        changes.left.iter_mut().for_each(Vec::clear);
        let state = &mut self.state;
        let n_asked = if self.sinks.is_empty() { 0 } else { n };
        for i in (0..n_asked).rev() {
            if swallowed(&self.sinks, &state.x[i]) {
                let (last, i_number) = (state.len() as u32 - 1, i as u32);
                state.swap_remove(i);
                if is_known {
                    changes.swap_remove(i);
                }
                self.neighbours.remove(i, listed, &mut changes.left);
                rename(&mut moved.movers, i_number, last);
                rename(&mut moved.stopped, i_number, last);
                report.drained += 1;
            }
        }
        for emitter in &mut self.emitters {
            emitter.emit(self.time, self.settings.spacing, |x, v| {
                let i = state.len();
                state.push(self.next_id, &x, &v);
                if is_known {
                    changes.push(&state.x[i], &state.w[i]);
                }
                listed.push(state.x[i]);
                self.neighbours.append(listed, around);
                moved.movers.push(i as u32);
                self.next_id += 1;
                self.fastest = self.fastest.max(v.norm());
                report.emitted += 1;
            });
        }
        if is_known {
            changes.know_walls(around.touched);
        }
        report.mended += self.neighbours.n_mended - n_mended;
        self.farthest = self.farthest.min(self.half_skin());
        true
    }

    /// New and removed particles. Returns true if there are any.
    pub(crate) fn emit_and_drain(&mut self, report: &mut StepReport) -> bool {
        let before = self.state.len();
        let sinks = &self.sinks;
        self.state.retain(|x| !swallowed(sinks, x));
        let kept = self.state.len();
        for emitter in &mut self.emitters {
            let state = &mut self.state;
            emitter.emit(self.time, self.settings.spacing, |x, v| {
                state.push(self.next_id, &x, &v);
                self.next_id += 1;
                self.fastest = self.fastest.max(v.norm());
            });
        }
        report.drained += (before - kept) as u64;
        report.emitted += (self.state.len() - kept) as u64;
        report.drained + report.emitted > 0
    }

    /// Sorts the particles and lists their neighbours.
    pub(crate) fn list_neighbours(&mut self) {
        self.neighbours.sort(&self.state.x, self.reach(), &mut self.scratch.order);
        self.state.sort(&self.scratch.order, &mut self.scratch.spare);
        self.listed.clone_from(&self.state.x);
        self.farthest = 0.0;
        let reach = self.reach();
        self.neighbours.list(&self.listed, &self.walls, reach, (&mut self.touched, &[]));
    }

    /// The same between two steps: what was computed stays good.
    pub(crate) fn list_in_between(&mut self) {
        let known = self.scratch.changes.is_known(self.state.len());
        self.list_neighbours();
        if known {
            self.scratch.changes.evaluated_all(&self.state, &self.touched);
        }
    }

    /// Lists neighbours again as they were, around these particles of walls.
    pub(crate) fn list_around_listed(&mut self, touched: &[u32]) {
        let (reach, order) = (self.reach(), &mut self.scratch.order);
        self.neighbours.sort(&self.listed, reach, order);
        let is_sorted = order.iter().zip(0..).all(|(&at, i)| at == i);
        let around = (&mut self.touched, touched);
        if is_sorted {
            self.neighbours.list(&self.listed, &self.walls, reach, around);
        } else {
            self.neighbours.list_unsorted(&self.listed, &self.walls, reach, around);
        }
    }

    /// How far from a particle others are listed (m).
    fn reach(&self) -> f64 {
        self.laws.kernel.support() + self.settings.skin * self.settings.spacing
    }
}

fn swallowed(sinks: &[Sink], x: &[f64; 4]) -> bool {
    let x = Vector3::new(x[0], x[1], x[2]);
    sinks.iter().any(|sink| sink.swallows(&x))
}
