//! Rest by friction: a vertex stands still or is free, and never anything between.
//!
//! A convex law that conserves momentum is dear while cloth slows down: everything passes through its
//! transition, where each vertex has another effective mass in each direction, and each stage is a
//! sequence of linear systems. So what moves has full dynamics here, and a stage is a plain one, with what
//! stands held fast.
//!
//! - A vertex *stands* if its velocity is zero to the bit, so states and recordings need no mark of it.
//!   While it does, it gathers momentum from the forces on it, less what friction in its contacts holds,
//!   and that bleeds away. If it exceeds p_r at the end of a stage, the vertex and all near it are free
//!   in the next, and if by much, the stage is made again. What it has gathered, friction keeps.
//! - A free vertex that is slower than p_f loses what restraint would hold back of its momentum in τ: a
//!   gentle drag, which moves no equilibrium.
//! - A free vertex is put to rest, some times in τ, when it and all near it are slow, their velocities
//!   hardly change, and friction withstands the forces that are left when they stand. Nothing that swings
//!   is slow and balanced at once. A piece of cloth that moves comes to rest as a whole: were a part of it
//!   to stand, the others would pull at that in every stage, and no stage would be cheaper. One that
//!   stands but in some places comes to rest there.
//!
//! A stage with vertices held fast ends below its start in kinetic plus potential energy like any stage of
//! backward Euler, at any stiffness and step, and putting to rest takes kinetic energy: nothing is gained.

use super::local::{Try, WholeStage};
use super::{Patch, REACH, Resting, RestingPolicy};
use crate::contact::Contact;
use crate::force::Stage;
use crate::integrator::{StageStart, Step};
use crate::system::{MOMENT, System};
use arps::{Held, Motion, Particle, bleeding_kick};
use mesh_core::{ClothState, World3};

/// How much faster momentum bleeds away at rest than in τ: friction at rest withstands that times p_r/τ.
const STATIC: f64 = 8.0;
/// Share of the speed up to which a vertex rests at which one is slow.
const SLOW: f64 = 0.5;
/// Acceleration in units of p_r/τ and the mass at which one is balanced. It is well below [`STATIC`]:
/// stiff forces change as the neighbours come to rest.
const BALANCED: f64 = 1.6;
/// The most acceleration that friction at rest withstands (m/s²): whatever the thresholds, nothing stays in
/// the air.
const MOST: f64 = 5.0;
/// How often in τ who comes to rest is looked for.
const LOOKS: f64 = 8.0;
/// Longest time in units of τ for which a vertex is not put to rest again; each time that it is pulled at
/// soon after, the time doubles.
const RESTLESS: f64 = 2.0;
/// Gathered momentum in units of p_r beyond which a stage is made again: what is little above it may as
/// well move from the next stage on.
const HARD: f64 = 2.0;
/// The most doublings of the neighbourhood that is freed.
const MAX_DOUBLINGS: usize = 16;

impl RestingPolicy {
    /// What a vertex with a velocity (m/s) does. Where momentum bleeds, what is slower than p_f and does not
    /// stand is in transition.
    pub fn motion(&self, particle: &Particle, v: &World3) -> Motion {
        let motion = self.restraint.at(particle).motion(&(v * particle.mass));
        let is_slow = motion == Motion::Rest && *v != World3::zeros();
        if self.bleeding.is_some() && is_slow { Motion::Transition } else { motion }
    }

    /// Kinetic energy of a vertex with a velocity (J): the restrained one, or where momentum bleeds the plain
    /// one.
    pub fn kinetic_energy(&self, particle: &Particle, v: &World3) -> f64 {
        match self.bleeding {
            None => self.restraint.at(particle).kinetic_energy(&(v * particle.mass)),
            Some(_) => 0.5 * particle.mass * v.norm_squared(),
        }
    }

    /// Velocities (m/s) at the start of a stage of h (s): what restraint would hold back, p − m ∂T/∂p, bleeds
    /// away.
    pub(super) fn slowed(&self, held: &[Held], v: &[World3], h: f64) -> Vec<World3> {
        let mut slowed = v.to_vec();
        let Some(tau) = self.bleeding else { return slowed };
        for (v, held) in slowed.iter_mut().zip(held) {
            let p = *v * held.mass();
            if held.motion(&p) != Motion::Full {
                *v -= (*v - held.velocity(&p)) * (h / tau).min(1.0);
            }
        }
        slowed
    }

    /// Time constant with which momentum bleeds away at rest that the policy holds so (s).
    pub(super) fn rate(&self, held: &Held) -> Option<f64> {
        let v_r = held.p_r() / held.mass();
        let least = if v_r < f64::INFINITY { v_r / MOST } else { 0.0 };
        self.bleeding.map(|tau| (tau / STATIC).max(least))
    }

    /// Marks of the vertices that stand at the start of a stage, but for `loose` ones, if momentum bleeds.
    pub(super) fn who_stands(
        &self,
        held: &[Held],
        loose: &[u32],
        start: &StageStart<'_>,
        fixed: &[bool],
    ) -> Option<Vec<bool>> {
        let stands = |i: usize| {
            let is_still = start.velocity[i] == World3::zeros() && start.base[i] == start.x_t0[i];
            !fixed[i] && !held[i].is_free() && (is_still || is_for_ever(&held[i]))
        };
        self.bleeding?;
        let mut all: Vec<bool> = (0..held.len()).map(stands).collect();
        loose.iter().for_each(|&i| all[i as usize] &= is_for_ever(&held[i as usize]));
        Some(all)
    }
}

/// Whether a vertex never moves.
pub(super) fn is_for_ever(held: &Held) -> bool {
    held.p_r() == f64::INFINITY
}

/// What of a force (N) is left beyond what friction in contacts holds (N).
pub(super) fn beyond(f: World3, grip: f64) -> World3 {
    let norm = f.norm();
    if norm > grip { f * (1.0 - grip / norm) } else { World3::zeros() }
}

impl Resting {
    /// What friction in contacts holds, by vertex (N), where anything stands.
    pub(super) fn grip(&self, contact: Option<&dyn Contact>, whole: &WholeStage<'_>) -> Vec<f64> {
        let mut grip = vec![0.0; self.active.len()];
        if let (Some(contact), Some(stands)) = (contact, &whole.stands) {
            let is_still = |i| stands[i] || whole.fixed[i] && whole.from[i] == whole.start.x_t0[i];
            let still: Vec<bool> = (0..grip.len()).map(is_still).collect();
            contact.add_grip(&still, &mut grip);
        }
        grip
    }

    /// What active vertices that stand have gathered at the end of a stage (kg m/s). If the past is not known
    /// it is what they will have gathered in the end, so that nothing is held for longer by forgetting.
    fn gathers(
        &self,
        whole: &WholeStage<'_>,
        gradient: &[World3],
        grip: &[f64],
        i: usize,
    ) -> World3 {
        let rate = self.policy.rate(&whole.held[i]).expect("momentum bleeds where anything stands");
        let f = beyond(-gradient[i], grip[i]);
        let &StageStart { time_t0, time, .. } = whole.start;
        if self.knows_past {
            bleeding_kick(&self.gathered[i], &f, time - time_t0, rate)
        } else {
            f * rate
        }
    }

    /// Frees what stands no longer with the forces at the end of a try of a stage; which vertices that are.
    pub(super) fn pulled(
        &mut self,
        whole: &mut WholeStage<'_>,
        done: &Try,
        grip: &[f64],
        n_tries: usize,
    ) -> Vec<u32> {
        let (Some(stands), Some(tau)) = (&whole.stands, self.policy.bleeding) else {
            return Vec::new();
        };
        let hard = if self.knows_past { HARD } else { 1.0 };
        let is_pulled = |i: usize| {
            let p_r = whole.held[i].p_r();
            self.active[i] && stands[i] && !is_for_ever(&whole.held[i]) && {
                done.x[i] != whole.from[i]
                    || self.gathers(whole, &done.gradient, grip, i).norm() > hard * p_r
            }
        };
        let pulled: Vec<u32> =
            (0..grip.len()).filter(|&i| is_pulled(i)).map(|i| i as u32).collect();
        // A stiff wave goes all the way in a stage.
        let rings = REACH << n_tries.min(MAX_DOUBLINGS);
        let freed = self.near.around(pulled, rings);
        self.restless.free(&freed, self.active.len(), whole.start.time, tau);
        let Some(stands) = &mut whole.stands else { return Vec::new() };
        freed.iter().for_each(|&i| stands[i as usize] &= is_for_ever(&whole.held[i as usize]));
        freed
    }

    /// Takes to the end of a stage what vertices that stand have gathered.
    pub(super) fn gather(&mut self, whole: &WholeStage<'_>, gradient: &[World3], grip: &[f64]) {
        let Some(stands) = &whole.stands else { return };
        let mut pulled = Vec::new();
        for i in (0..stands.len()).filter(|&i| self.active[i]) {
            let p_r = whole.held[i].p_r();
            let gathers = stands[i] && !is_for_ever(&whole.held[i]);
            let zero = World3::zeros;
            let p = if gathers { self.gathers(whole, gradient, grip, i) } else { zero() };
            if p.norm() > p_r {
                pulled.push(i as u32);
            }
            self.gathered[i] = p;
        }
        self.knows_past = true;
        self.loose = self.near.around(pulled, REACH);
        let tau = self.policy.bleeding.expect("momentum bleeds where anything stands");
        self.restless.free(&self.loose, stands.len(), whole.start.time, tau);
    }

    /// Puts vertices to rest that are slow with all near them at the end of a step that began with these
    /// velocities (m/s) and has hardly changed them, and that stay where they are when all stand.
    pub(crate) fn put_to_rest(
        &mut self,
        cloth: &mut ClothState,
        system: &mut System,
        before: &[World3],
        step: Step,
    ) {
        let Some(tau) = self.policy.bleeding else { return };
        let looks = |time: f64| (time * LOOKS / tau).floor();
        let (n, time) = (cloth.x.len(), step.time + step.h);
        if looks(step.time) == looks(time) {
            return;
        }
        let ClothState { x, v, m, .. } = cloth;
        let v_r = |i: usize| {
            let particle = Particle { index: i, mass: m[i], x: x[i], time };
            self.policy.restraint.at(&particle).p_r() / m[i]
        };
        // Acceleration (m/s²).
        let little = |v_r: f64| BALANCED * (v_r / tau).min(MOST / STATIC);
        let is_calm = |i: usize| {
            let (v_r, change) = (v_r(i), (v[i] - before[i]).norm());
            v[i].norm() <= SLOW * v_r && change <= little(v_r) * step.h
        };
        let moves = |i: usize| v[i] != World3::zeros();
        let is_busy = |i: usize| moves(i) && !(self.restless.may_rest(i, time) && is_calm(i));
        let busy: Vec<u32> = (0..n).filter(|&i| is_busy(i)).map(|i| i as u32).collect();
        self.restless.calm_down(time);
        let stands = |i: usize| !moves(i);
        let rests = self.may_rest(busy.iter().copied(), stands);
        let is_new = |i: usize| rests[i] && moves(i);
        if !(0..n).any(is_new) {
            return;
        }
        let (gradient, grip) = at_rest(&mut self.patch, system, x, &rests);
        let is_driven = |i: usize| beyond(gradient[i], grip[i]).norm() > little(v_r(i)) * m[i];
        let driven = (0..n).filter(|&i| is_new(i) && is_driven(i)).map(|i| i as u32);
        let rests = self.may_rest(busy.iter().copied().chain(driven), |i| v[i] == World3::zeros());
        v.iter_mut().zip(rests).filter(|(_, rests)| *rests).for_each(|(v, _)| *v = World3::zeros());
    }

    /// Marks of vertices that are far from these busy ones, in pieces of cloth of which nobody is busy or
    /// most `stand` already.
    fn may_rest(
        &self,
        busy: impl Iterator<Item = u32>,
        stands: impl Fn(usize) -> bool,
    ) -> Vec<bool> {
        let mut rests = vec![true; self.active.len()];
        self.near.around(busy, 2 * REACH).into_iter().for_each(|i| rests[i as usize] = false);
        let pieces = self.near.pieces();
        let n_pieces = pieces.iter().max().map_or(0, |last| last + 1);
        let (mut n, mut n_busy, mut n_stands) =
            (vec![0; n_pieces], vec![0; n_pieces], vec![0; n_pieces]);
        for (i, &piece) in pieces.iter().enumerate() {
            n[piece] += 1;
            n_busy[piece] += usize::from(!rests[i]);
            n_stands[piece] += usize::from(stands(i));
        }
        let is_worth_it = |piece: usize| n_busy[piece] == 0 || 2 * n_stands[piece] > n[piece];
        rests.iter_mut().zip(pieces).for_each(|(rests, &piece)| *rests &= is_worth_it(piece));
        rests
    }
}

/// Vertices that were pulled at lately: to put them to rest again at once would not last.
#[derive(Default)]
pub(super) struct Restless {
    /// By vertex, when one was freed for how long (s); empty as long as none was.
    since: Vec<[f64; 2]>,
}

impl Restless {
    fn free(&mut self, freed: &[u32], n: usize, time: f64, tau: f64) {
        if freed.is_empty() {
            return;
        }
        self.since.resize(n, [f64::NEG_INFINITY, 0.0]);
        for &i in freed {
            let [since, wait] = &mut self.since[i as usize];
            if time > *since {
                *wait = (2.0 * *wait).clamp(tau / LOOKS, RESTLESS * tau);
                *since = time;
            }
        }
    }

    fn may_rest(&self, i: usize, time: f64) -> bool {
        self.since.get(i).is_none_or(|[since, wait]| time >= since + wait)
    }

    /// What has been left alone for long is as it was.
    fn calm_down(&mut self, time: f64) {
        for [since, wait] in &mut self.since {
            if time > *since + 4.0 * *wait {
                *wait *= 0.5;
            }
        }
    }
}

/// Gradient of all forces (N), on active vertices, if the cloth stood still at `x`, and what friction in
/// contacts would hold of that (N) where vertices with a mark stand.
fn at_rest(
    patch: &mut Option<Patch>,
    system: &mut System,
    x: &[World3],
    rests: &[bool],
) -> (Vec<World3>, Vec<f64>) {
    let mut gradient = match patch {
        None => {
            system.begin(Stage { x_t0: x, base: x, h: MOMENT });
            system.gradient(x)
        }
        Some(Patch { part, system: own }) => {
            let here = part.gather(x);
            own.begin(Stage { x_t0: &here, base: &here, h: MOMENT });
            let mut gradient = vec![World3::zeros(); x.len()];
            let of_part = own.gradient(&here);
            part.vertices().iter().zip(of_part).for_each(|(&i, g)| gradient[i as usize] = g);
            gradient
        }
    };
    let mut grip = vec![0.0; x.len()];
    if let Some(contact) = &system.contact {
        contact.add_gradient(x, &mut gradient);
        contact.add_grip(rests, &mut grip);
    }
    (gradient, grip)
}
