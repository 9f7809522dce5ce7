//! When resting particles wake.
//!
//! A particle at rest among particles at rest feels a constant force, so the time at which its
//! momentum leaves the ball of radius p_r is the root of a quadratic. Kept in a queue, it costs
//! nothing until then.

use crate::Vector3;
use crate::explicit::bleeding_kick;
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// A particle at rest under a constant force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Time from which on it rests (s).
    pub since: f64,
    /// Its momentum then (kg m/s).
    pub p: Vector3,
    /// The force on it (N).
    pub f: Vector3,
    /// Momentum norm up to which it rests (kg m/s).
    pub p_r: f64,
    /// Time constant with which momentum bleeds away, if it does (s).
    pub bleeding: Option<f64>,
}

impl Rest {
    /// Its momentum at a time (kg m/s): p + f t, or with bleeding f τ + (p − f τ) e^(−t/τ).
    pub fn momentum_at(&self, time: f64) -> Vector3 {
        let t = time - self.since;
        match self.bleeding {
            None => self.p + t * self.f,
            Some(tau) => bleeding_kick(&self.p, &self.f, t, tau),
        }
    }

    /// The time at which it wakes (s), infinity for never. It is too early by some units of rounding
    /// rather than too late. With a momentum or force that is not a number it wakes at once, so that
    /// somebody sees it.
    pub fn wakes_at(&self) -> f64 {
        let wait = match self.bleeding {
            None => self.leaves_after(&self.f),
            Some(tau) => {
                // The momentum goes in a straight line towards f τ, and is y of the way there after
                // −τ ln(1 − y).
                let y = self.leaves_after(&(tau * self.f - self.p));
                if y < 1.0 { -tau * (-y).ln_1p() } else { f64::INFINITY }
            }
        };
        if wait.is_nan() {
            return self.since;
        }
        // Rounding of p, f and the time itself.
        let early = 8.0 * f64::EPSILON * (wait + self.since.abs());
        if wait < f64::INFINITY { (self.since + wait - early).max(self.since) } else { wait }
    }

    /// The least s ≥ 0 beyond which ‖p + s u‖ > p_r; infinity if there is none.
    fn leaves_after(&self, u: &Vector3) -> f64 {
        if self.p_r == f64::INFINITY {
            return f64::INFINITY;
        }
        let scale = u.norm();
        if scale == 0.0 {
            return if self.p.norm() > self.p_r { 0.0 } else { f64::INFINITY };
        }
        // Along the direction of u: s² + 2 along s − room = 0.
        let along = self.p.dot(u) / scale;
        let norm = self.p.norm();
        let room = (self.p_r - norm) * (self.p_r + norm);
        if room < 0.0 {
            return 0.0;
        }
        let root = (along * along + room).sqrt();
        // Of the two ways to write the root the one that does not cancel.
        let s = if along > 0.0 { room / (along + root) } else { root - along };
        s / scale
    }
}

/// A queue of resting particles, by the time at which they wake.
///
/// Particles with the same time wake in the order of their indices, so the order does not depend on
/// how they got in. A particle whose force or momentum changes is put in again with
/// [`rest`](WakeQueue::rest), which forgets what was there; what was forgotten is thrown away when it
/// comes up. All operations cost O(log n).
#[derive(Clone, Debug, Default)]
pub struct WakeQueue {
    heap: BinaryHeap<Reverse<Entry>>,
    /// Per particle: how it rests, and which entry of the heap is the valid one.
    resting: Vec<Option<Rest>>,
    stamp: Vec<u64>,
    n: usize,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    time: f64,
    particle: usize,
    stamp: u64,
}

impl Entry {
    fn key(&self, other: &Entry) -> Ordering {
        let by_time = self.time.total_cmp(&other.time);
        by_time.then(self.particle.cmp(&other.particle)).then(self.stamp.cmp(&other.stamp))
    }
}

impl PartialEq for Entry {
    fn eq(&self, other: &Entry) -> bool {
        self.key(other) == Ordering::Equal
    }
}

impl Eq for Entry {}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Entry) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Entry {
    fn cmp(&self, other: &Entry) -> Ordering {
        self.key(other)
    }
}

impl WakeQueue {
    /// An empty queue.
    pub fn new() -> WakeQueue {
        WakeQueue::default()
    }

    /// How many particles rest.
    pub fn len(&self) -> usize {
        self.n
    }

    /// True if none rests.
    pub fn is_empty(&self) -> bool {
        self.n == 0
    }

    /// How a particle rests, if it does.
    pub fn get(&self, particle: usize) -> Option<&Rest> {
        self.resting.get(particle)?.as_ref()
    }

    /// Puts a particle to rest, or changes how it rests.
    pub fn rest(&mut self, particle: usize, rest: Rest) {
        self.take(particle);
        if self.resting.len() <= particle {
            self.resting.resize(particle + 1, None);
            self.stamp.resize(particle + 1, 0);
        }
        self.resting[particle] = Some(rest);
        self.n += 1;
        let (time, stamp) = (rest.wakes_at(), self.stamp[particle]);
        if time < f64::INFINITY {
            self.heap.push(Reverse(Entry { time, particle, stamp }));
        }
        // Most of what is in the heap was forgotten: start it anew.
        if self.heap.len() > 64 && self.heap.len() > 4 * self.n {
            let (resting, stamp) = (&self.resting, &self.stamp);
            self.heap
                .retain(|Reverse(e)| resting[e.particle].is_some() && stamp[e.particle] == e.stamp);
        }
    }

    /// Takes a particle out before its time: a neighbour moved, something touched it.
    pub fn take(&mut self, particle: usize) -> Option<Rest> {
        let rest = self.resting.get_mut(particle)?.take()?;
        self.stamp[particle] += 1;
        self.n -= 1;
        Some(rest)
    }

    /// The time at which the next particle wakes (s); infinity if none does.
    pub fn next_time(&mut self) -> f64 {
        self.drop_forgotten();
        self.heap.peek().map_or(f64::INFINITY, |Reverse(entry)| entry.time)
    }

    /// Takes out the next particle that wakes at `time` (s) or before, if there is one.
    pub fn wake(&mut self, time: f64) -> Option<(usize, Rest)> {
        if self.next_time() > time {
            return None;
        }
        let Reverse(entry) = self.heap.pop()?;
        Some((entry.particle, self.take(entry.particle)?))
    }

    fn drop_forgotten(&mut self) {
        while let Some(Reverse(entry)) = self.heap.peek() {
            let valid =
                self.resting[entry.particle].is_some() && self.stamp[entry.particle] == entry.stamp;
            if valid {
                break;
            }
            self.heap.pop();
        }
    }
}
