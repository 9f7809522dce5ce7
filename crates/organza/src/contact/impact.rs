//! The last resort of a stage: ways that run into something are changed until none does.
//!
//! First each hit takes the approach out of its own motion, by the least change that does (an
//! inelastic impact, which conserves momentum). Where hits depend on each other that may go on for
//! long, so next they take out the relative motion, and in the end all that hit each other go as
//! one (the impact zones of Provot1997 and Harmon2008, without their rotation). What does not touch at
//! the start of the stage does not touch then either, so that only obstacles that go different ways can
//! be in each other's way.

use super::SurfaceContact;
use super::pair::Sides;
use cloth_dynamics::contact::Blocked;
use collision::ccd;
use mesh_core::{World3, par};

/// Rounds in which hits lose their approach alone.
const NORMAL_ROUNDS: usize = 8;
/// Rounds after which hits have lost their relative motion.
const STICKING_ROUNDS: usize = 16;
/// Rounds after which there is no way.
const MAX_ROUNDS: usize = 64;
/// Share of the gap at the start, or of the thickness, that a way must keep.
const CLEAR: f64 = 0.1;
/// The same, where a way is changed to keep it.
const LANDING: f64 = 0.3;
/// Share of a free way that is gone.
const CAUTION: f64 = 0.9;

/// A pair that hits.
#[derive(Clone, Copy)]
struct Hit {
    sides: Sides,
    /// Until when its way is free (1).
    t: f64,
    /// The gap that the pair may be left with (m).
    gap: f64,
}

impl SurfaceContact {
    /// See [`Contact::secure`](cloth_dynamics::contact::Contact::secure).
    pub(super) fn free_way(&mut self, x: &mut [World3], fixed: &[bool]) -> Result<usize, Blocked> {
        let x_t0 = std::mem::take(&mut self.x_t0);
        let result = self.free_way_from(&x_t0, x, fixed);
        self.x_t0 = x_t0;
        result
    }

    fn free_way_from(
        &mut self,
        x_t0: &[World3],
        x: &mut [World3],
        fixed: &[bool],
    ) -> Result<usize, Blocked> {
        let mut changed = vec![false; x.len()];
        // Those whose pairs have to be looked at: all, then those that the last round moved or hit.
        let mut dirty: Option<Vec<bool>> = None;
        let mut zones = Zones::default();
        let mut round = 0;
        loop {
            if self.cover(x_t0, x) {
                dirty = None;
            }
            let mut hits = self.hits(x_t0, x, dirty.as_deref());
            let Some(first) = hits.first() else {
                return Ok(changed.iter().filter(|&&changed| changed).count());
            };
            let blocked = Blocked { place: self.corners_now(&first.sides, x_t0)[0] };
            if round == MAX_ROUNDS {
                return Err(blocked);
            }
            let before = x.to_vec();
            hits.sort_by(|a, b| a.t.total_cmp(&b.t));
            if round < NORMAL_ROUNDS {
                hits.iter().for_each(|hit| self.take_out_approach(hit, x_t0, x, fixed));
            } else if round < STICKING_ROUNDS {
                hits.iter().for_each(|hit| self.take_out_motion(hit, x_t0, x, fixed));
            } else {
                hits.iter().for_each(|hit| zones.join(&hit.sides));
                self.move_as_one(&zones, x_t0, x, fixed);
            }
            let moved: Vec<bool> = before.iter().zip(&*x).map(|(from, to)| from != to).collect();
            changed.iter_mut().zip(&moved).for_each(|(changed, moved)| *changed |= moved);
            round = match moved.contains(&true) {
                true => round + 1,
                // What does nothing now will not do anything in the next round.
                false if round < NORMAL_ROUNDS => NORMAL_ROUNDS,
                false if round < STICKING_ROUNDS => STICKING_ROUNDS,
                false => return Err(blocked),
            };
            // A hit that nothing was done about is still one.
            let mut open = moved;
            for sides in hits.iter().map(|hit| &hit.sides) {
                for k in (0..4).filter(|&k| sides.is_cloth[k]) {
                    open[sides.vertices[k] as usize] = true;
                }
            }
            dirty = Some(open);
        }
    }

    /// Pairs with one of the vertices `of` that come too near on the way to `x`.
    fn hits(&self, x_t0: &[World3], x: &[World3], of: Option<&[bool]>) -> Vec<Hit> {
        let pairs = &self.candidates.pairs;
        par::collect(pairs.len(), |k, hits| {
            let sides = &pairs[k];
            let is_cloth = |k: &usize| sides.is_cloth[*k];
            if self.is_exempt(sides) {
                return;
            }
            if let Some(of) = of
                && !(0..4).filter(is_cloth).any(|k| of[sides.vertices[k] as usize])
            {
                return;
            }
            let (from, to) = (self.corners_now(sides, x_t0), self.corners_then(sides, x));
            let motion = sides.relative_motion(&from, &to);
            let distance = self.distances[k];
            let gap = sides.thickness.min(distance);
            if distance - motion > CLEAR * gap {
                return;
            }
            let test = if sides.is_edges { ccd::edge_edge } else { ccd::vertex_triangle };
            if let ccd::Ccd::Hit { t } = test(&from, &to, CLEAR * gap) {
                hits.push(Hit { sides: *sides, t, gap: LANDING * gap });
            }
        })
    }

    /// Mass of a corner, up to a common factor; infinite where it does not move.
    fn inertia_of(&self, sides: &Sides, k: usize, fixed: &[bool]) -> f64 {
        let i = sides.vertices[k] as usize;
        if !sides.is_cloth[k] || fixed[i] { f64::INFINITY } else { self.inertia[i] }
    }

    /// Leaves the pair with a gap along the normal that it has when it hits, by the least change.
    fn take_out_approach(&self, hit: &Hit, x_t0: &[World3], x: &mut [World3], fixed: &[bool]) {
        let sides = &hit.sides;
        let (from, to) = (self.corners_now(sides, x_t0), self.corners_then(sides, x));
        let at: [World3; 4] = std::array::from_fn(|k| from[k] + (to[k] - from[k]) * hit.t);
        let closest = sides.closest(&at);
        if closest.distance == 0.0 {
            return;
        }
        let normal = closest.offset / closest.distance;
        let gap: f64 = (0..4).map(|k| normal.dot(&to[k]) * closest.weights[k]).sum();
        let mobility = |k: usize| closest.weights[k] / self.inertia_of(sides, k, fixed);
        let all: f64 = (0..4).map(|k| closest.weights[k] * mobility(k)).sum();
        let lack = hit.gap - gap;
        if lack > 0.0 && all > 0.0 {
            for k in (0..4).filter(|&k| mobility(k) != 0.0) {
                x[sides.vertices[k] as usize] += normal * (lack * mobility(k) / all);
            }
        }
    }

    /// The motion of what holds the pair, or of its centre of mass (m).
    fn common_motion(
        &self,
        sides: &Sides,
        x_t0: &[World3],
        x: &[World3],
        fixed: &[bool],
    ) -> World3 {
        let (from, to) = (self.corners_now(sides, x_t0), self.corners_then(sides, x));
        let inertia = [0, 1, 2, 3].map(|k| self.inertia_of(sides, k, fixed));
        // Obstacles come before what is held.
        let of_obstacle = [0, 1, 2, 3].map(|k| if sides.is_cloth[k] { 0.0 } else { 1.0 });
        let of_held = inertia.map(|m| if m.is_finite() { 0.0 } else { 1.0 });
        let weights = [of_obstacle, of_held, inertia];
        let weights = weights.iter().find(|w| w.iter().sum::<f64>() > 0.0).unwrap_or(&inertia);
        let sum: f64 = weights.iter().sum();
        (0..4).map(|k| (to[k] - from[k]) * (weights[k] / sum)).sum()
    }

    /// Leaves the pair a part of its relative motion that is free.
    fn take_out_motion(&self, hit: &Hit, x_t0: &[World3], x: &mut [World3], fixed: &[bool]) {
        let sides = &hit.sides;
        let common = self.common_motion(sides, x_t0, x, fixed);
        for k in (0..4).filter(|&k| self.inertia_of(sides, k, fixed).is_finite()) {
            let i = sides.vertices[k] as usize;
            let own = x[i] - x_t0[i] - common;
            x[i] = x_t0[i] + common + own * (CAUTION * hit.t);
        }
    }

    /// Gives all vertices of a zone the same motion: that of obstacles or held vertices in it, if there
    /// are any.
    fn move_as_one(&self, zones: &Zones, x_t0: &[World3], x: &mut [World3], fixed: &[bool]) {
        for zone in &zones.zones {
            let (mut held, mut n_held) = (World3::zeros(), 0);
            let (mut free, mut mass) = (World3::zeros(), 0.0);
            for sides in &zone.pairs {
                let is_held = (0..4).any(|k| self.inertia_of(sides, k, fixed).is_infinite());
                if is_held {
                    held += self.common_motion(sides, x_t0, x, fixed);
                    n_held += 1;
                }
            }
            for &i in &zone.vertices {
                let i = i as usize;
                free += (x[i] - x_t0[i]) * self.inertia[i];
                mass += self.inertia[i];
            }
            let motion = if n_held > 0 { held / n_held as f64 } else { free / mass };
            for &i in zone.vertices.iter().filter(|&&i| !fixed[i as usize]) {
                x[i as usize] = x_t0[i as usize] + motion;
            }
        }
    }
}

/// Sets of vertices that move as one.
#[derive(Default)]
struct Zones {
    zones: Vec<Zone>,
}

#[derive(Default)]
struct Zone {
    /// Vertices of the cloth, ascending.
    vertices: Vec<u32>,
    /// The pairs that made it.
    pairs: Vec<Sides>,
}

impl Zones {
    /// Joins all zones that a pair touches.
    fn join(&mut self, sides: &Sides) {
        let own: Vec<u32> =
            (0..4).filter(|&k| sides.is_cloth[k]).map(|k| sides.vertices[k]).collect();
        let mut joined = Zone { vertices: own, pairs: vec![*sides] };
        let touches = |zone: &Zone, vertices: &[u32]| {
            vertices.iter().any(|v| zone.vertices.binary_search(v).is_ok())
        };
        let own = joined.vertices.clone();
        self.zones.retain_mut(|zone| {
            let is_apart = !touches(zone, &own);
            if !is_apart {
                joined.vertices.append(&mut zone.vertices);
                joined.pairs.append(&mut zone.pairs);
            }
            is_apart
        });
        joined.vertices.sort_unstable();
        joined.vertices.dedup();
        self.zones.push(joined);
    }
}
