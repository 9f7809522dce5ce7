//! Cloth of which parts rest: implicit stages under a policy of restraint, whose cost follows what
//! moves.
//!
//! A restrained vertex keeps its momentum p while it stands still (Manteaux2013), with a convex law
//! that lets an implicit stage decide at its end who moves (`newton/restrained.rs`). Velocities of a
//! cloth under restraint are momenta over mass; where nothing is restrained that is the same.
//!
//! The vertices are of two kinds. The *active* ones are those that moved in the last stage and all
//! within a few edges; their forces are evaluated, as forces of a [`Part`] of the cloth with the same
//! bits as in the whole. All others *sleep*: nothing near them has moved, so the force on them is
//! constant, and the time at which their momentum will have grown too large is known beforehand (a
//! queue, [`WakeQueue`]). If a stage moves something whose neighbourhood is not active all, it is
//! made again with a larger part. So who sleeps never decides what happens, only what it costs.

mod fall_asleep;
mod local;
mod neighbours;
mod part_contact;

use crate::contact::Contact;
use crate::force::Stage;
use crate::integrator::{StageEnd, StageStart, Step, plain_stage};
use crate::part::Part;
use crate::point_forces::Springs;
use crate::solve_report::{NewtonSettings, RestReport, SolveError, SolveReport};
use crate::solver::LinearSolver;
use crate::system::{Constraints, System};
use arps::{Held, Particle, Rest, Restraint, WakeQueue};
use local::{Local, Solved, Try, WholeStage, scattered};
use mesh_core::{ClothState, World3};
use neighbours::Neighbours;
use part_contact::{PartContact, gradient_of};
use std::sync::Arc;
use std::time::Instant;

/// Edges within which the force on a vertex depends on another: bending looks across a triangle.
const REACH: usize = 2;
/// Share of the vertices above which all are active.
const WHOLE: f64 = 0.6;
/// The part is made smaller when less than this share of it is wanted.
const SHRINK: f64 = 0.5;
/// Error of a momentum that is restrained, as a share of that up to which its vertex rests.
const FINE: f64 = 1e-4;
/// The same where momentum bleeds, as a share of what does in the stage: were it more, forces left over
/// in equilibrium would keep vertices from rest.
const FINE_BLED: f64 = 0.3;
const ROUGH: f64 = 0.05;
/// By what momentum bleeds faster at rest: so that what is slow does not creep on for ever.
const STATIC: f64 = 2.0;
/// Effective speed, as a share of that up to which a vertex rests, below which bleeding puts it to rest
/// unless it gets faster.
const STICK: f64 = 0.2;
/// By how much more its momentum may grow in a stage, as a share of what bleeds: forces that damping
/// balances do not end creeping, and at rest are less than half of what that withstands.
const GROWTH: f64 = 0.1;
/// Share of the momentum up to which a vertex rests that one is left with which is put to rest: rounding
/// must not take it out again, where it would be held by the lesser friction of what moves.
const INSIDE: f64 = 1.0 - 1e-12;
/// Change of a contact force on a sleeper that is rounding (1).
const SAME: f64 = 1e-9;

/// Restraint of vertices: who may rest.
#[derive(Clone)]
pub struct RestingPolicy {
    /// The thresholds.
    pub restraint: Arc<dyn Restraint>,
    /// Time constant with which momentum bleeds away that is held back, p − m ∂T/∂p, if it does (s).
    /// Without it, damped cloth creeps towards ‖p‖ = p_r for ever, and flickers there. Energy only falls
    /// by it, and full dynamics are as they were; but it acts as static friction of p_r over this time
    /// on what rests, and momentum is not conserved.
    pub bleeding: Option<f64>,
}

/// The state of a restrained cloth on its current mesh.
pub(crate) struct Resting {
    policy: RestingPolicy,
    near: Neighbours,
    active: Vec<bool>,
    n_active: usize,
    /// Forces of the active vertices, unless all or none are active.
    patch: Option<Patch>,
    queue: WakeQueue,
    /// Gradient of contact in the forces of sleepers (N); empty without contact.
    touching: Vec<World3>,
    was_fixed: Vec<bool>,
    /// What was held where at the end of the last stage.
    last: Constraints,
}

struct Patch {
    part: Arc<Part>,
    system: System,
}

impl Resting {
    pub(crate) fn new(policy: RestingPolicy, system: &System) -> Resting {
        let n = system.mesh_pattern().n_vertices();
        Resting {
            policy,
            near: Neighbours::new(system.mesh_pattern()),
            active: vec![true; n],
            n_active: n,
            patch: None,
            queue: WakeQueue::new(),
            touching: Vec::new(),
            was_fixed: vec![false; n],
            last: Constraints::default(),
        }
    }

    /// Wakes everything; momenta must have been [settled](Resting::settle).
    pub(crate) fn wake_all(&mut self) {
        self.active.fill(true);
        self.n_active = self.active.len();
        self.patch = None;
        self.queue = WakeQueue::new();
    }

    /// Goes on with another policy from a time (s) on; sleepers with other thresholds wake at another
    /// time. Momenta must have been [settled](Resting::settle).
    pub(crate) fn change_policy(&mut self, policy: RestingPolicy, cloth: &ClothState, time: f64) {
        let rate = |policy: &RestingPolicy| policy.bleeding.map(|tau| tau / STATIC);
        for i in 0..self.active.len() {
            let Some(&rest) = self.queue.get(i) else { continue };
            let (mass, x) = (cloth.m[i], cloth.x[i]);
            let p_r = policy.restraint.at(&Particle { index: i, mass, x, time }).p_r();
            if !self.was_fixed[i] && (p_r != rest.p_r || rate(&policy) != rest.bleeding) {
                let p = cloth.v[i] * mass;
                let bleeding = rate(&policy);
                self.queue.rest(i, Rest { since: time, p, p_r, bleeding, ..rest });
            }
        }
        self.policy = policy;
    }

    /// Brings the velocities of sleepers up to a time (s).
    pub(crate) fn settle(&self, v: &mut [World3], mass: &[f64], time: f64) {
        if self.queue.is_empty() {
            return;
        }
        for (i, v) in v.iter_mut().enumerate() {
            if let Some(rest) = self.queue.get(i) {
                *v = rest.momentum_at(time) / mass[i];
            }
        }
    }

    /// Whether nothing happens in a step: all sleep, and nothing wakes them.
    pub(crate) fn sleeps(
        &mut self,
        contact: Option<&dyn Contact>,
        constraints: &dyn Fn(f64) -> Constraints,
        Step { time, h }: Step,
        stages: &[f64],
    ) -> bool {
        let all = self.n_active == 0 && self.policy.restraint.is_steady();
        if !all || self.queue.next_time() <= time + h {
            return false;
        }
        stages.iter().all(|end| constraints(*end) == self.last)
            && contact.is_none_or(|contact| contact.is_still([time, time + h]))
    }

    /// Solves one stage.
    pub(crate) fn stage(
        &mut self,
        cloth: &ClothState,
        system: &mut System,
        solver: &mut dyn LinearSolver,
        settings: &NewtonSettings,
        start: &StageStart<'_>,
    ) -> Result<StageEnd, SolveError> {
        let &StageStart { x_t0, base, velocity, h, time_t0, time, .. } = start;
        let n = x_t0.len();
        let held = |i: usize| {
            let (mass, x) = (cloth.m[i], x_t0[i]);
            self.policy.restraint.at(&Particle { index: i, mass, x, time: time_t0 })
        };
        let held: Vec<Held> = (0..n).map(held).collect();
        if held.iter().all(Held::is_free) {
            self.wake_all();
            return plain_stage(cloth, system, solver, settings, start);
        }
        let mut fixed = vec![false; n];
        let mut from = x_t0.to_vec();
        for &(i, x) in &start.constraints.fixed {
            fixed[i as usize] = true;
            from[i as usize] = x;
        }
        let bled = self.policy.bleeding.map_or(0.0, |tau| (h / tau).min(1.0));
        let momentum = |i: usize| {
            let p = velocity[i] * cloth.m[i];
            if bled == 0.0 || !self.active[i] {
                // Of sleepers the queue knows it.
                return p;
            }
            let (r, p_r) = (p.norm(), held[i].p_r());
            if r <= p_r {
                p * (1.0 - STATIC * bled).max(0.0)
            } else {
                p - (p - held[i].s(&p)) * bled
            }
        };
        let p: Vec<World3> = (0..n).map(momentum).collect();

        let mut rest = RestReport { stages: 1, ..RestReport::default() };
        let woken = self.woken(&held, &p, start, &from, &fixed, &mut rest);
        self.grow(woken, false);
        let mut contact_s = 0.0;
        let fine =
            self.policy.bleeding.map_or(FINE, |tau| (FINE_BLED * h / tau).clamp(FINE, ROUGH));
        let whole =
            WholeStage { cloth, start, held: &held, p: &p, fixed: &fixed, from: &from, fine };
        let is_still = |c: &dyn Contact| c.is_still([time_t0, time]);
        if self.n_active == 0 && system.contact.as_deref().is_none_or(is_still) {
            rest.slept = 1;
            rest.untouched = n;
            let mut v = velocity.to_vec();
            self.settle(&mut v, &cloth.m, time);
            let report = SolveReport { stages: 1, rest, ..SolveReport::default() };
            return Ok(StageEnd { x: x_t0.to_vec(), v, bent: Vec::new(), report });
        }
        if self.touching.is_empty() && system.contact.is_some() {
            self.touching = vec![World3::zeros(); n];
        }
        let done = loop {
            let clock = Instant::now();
            self.begin_contact(system, &whole, &mut rest);
            contact_s += clock.elapsed().as_secs_f64();
            let done = if self.n_active == 0 {
                let report = SolveReport { stages: 1, ..SolveReport::default() };
                Try {
                    x: from.clone(),
                    gradient: vec![World3::zeros(); n],
                    is_solved: false,
                    report,
                    pushed: Vec::new(),
                }
            } else {
                self.attempt(system, solver, settings, &whole, &mut rest)?
            };
            let mut missing = done.pushed.clone();
            if self.n_active < n {
                let moved = (0..n).filter(|&i| done.x[i] != x_t0[i] || base[i] != x_t0[i]);
                let around = self.near.around(moved.map(|i| i as u32), REACH);
                missing.extend(around.into_iter().filter(|&i| !self.active[i as usize]));
                if let Some(contact) = &system.contact {
                    missing.extend(self.disturbed(&**contact, &done.x, &whole, true));
                }
            }
            if missing.is_empty() {
                break done;
            }
            rest.redone += 1;
            self.grow(missing, true);
        };
        let Try { x, gradient, is_solved, mut report, .. } = done;
        report.contact_s += contact_s;
        rest.untouched = n - self.n_active;
        let v = self.momenta(&whole, &x, &gradient, is_solved, &mut rest);
        self.put_to_sleep(system, &whole, &x, &v);
        self.was_fixed.clone_from(&fixed);
        self.last.clone_from(&start.constraints);
        report.rest.add(&rest);
        Ok(StageEnd { x, v, bent: Vec::new(), report })
    }

    /// Sleepers that wake in the stage.
    fn woken(
        &mut self,
        held: &[Held],
        p: &[World3],
        start: &StageStart<'_>,
        from: &[World3],
        fixed: &[bool],
        report: &mut RestReport,
    ) -> Vec<u32> {
        if !self.policy.restraint.is_steady() {
            for (i, held) in held.iter().enumerate() {
                if let Some(&rest) = self.queue.get(i)
                    && rest.p_r != held.p_r()
                    && rest.p_r < f64::INFINITY
                {
                    let since = start.time - start.h;
                    self.queue.rest(i, Rest { since, p: p[i], p_r: held.p_r(), ..rest });
                }
            }
        }
        let mut woken = Vec::new();
        while let Some((i, _)) = self.queue.wake(start.time) {
            woken.push(i as u32);
        }
        report.woken += woken.len();
        let sleeps = |i: usize| !self.active[i];
        let disturbed = (0..fixed.len())
            .filter(|&i| sleeps(i) && (fixed[i] != self.was_fixed[i] || from[i] != start.x_t0[i]));
        woken.extend(disturbed.map(|i| i as u32));
        if start.constraints.springs != self.last.springs {
            let both = start.constraints.springs.iter().chain(&self.last.springs);
            woken.extend(both.map(|&(i, ..)| i).filter(|&i| sleeps(i as usize)));
        }
        woken
    }

    /// Makes vertices active with all around them; by far more if a stage was `redone` for them.
    fn grow(&mut self, missing: Vec<u32>, redone: bool) {
        if missing.is_empty() {
            return;
        }
        let rings = if redone { 4 * REACH } else { 2 * REACH };
        let mut wanted = self.near.around(missing, rings);
        wanted.retain(|&i| !self.active[i as usize]);
        self.patch = None;
        for i in wanted {
            self.activate(i as usize);
        }
        if self.n_active as f64 > WHOLE * self.active.len() as f64 {
            self.wake_all();
        }
    }

    fn activate(&mut self, i: usize) {
        self.queue.take(i);
        self.active[i] = true;
        self.n_active += 1;
    }

    /// Begins the stage for contact, and makes active what that disturbs.
    fn begin_contact(
        &mut self,
        system: &mut System,
        whole: &WholeStage<'_>,
        report: &mut RestReport,
    ) {
        let Some(contact) = &mut system.contact else { return };
        let &StageStart { x_t0, base, h, time_t0, time, .. } = whole.start;
        let target = |i: usize| whole.target(i);
        let target: Vec<World3> = (0..x_t0.len()).map(target).collect();
        if self.n_active < x_t0.len() {
            let sleepers: Vec<bool> = self.active.iter().map(|active| !active).collect();
            contact.rest(Some(&sleepers));
        } else {
            contact.rest(None);
        }
        contact.begin(Stage { x_t0, base, h }, [time_t0, time], &whole.cloth.m, &target);
        if self.n_active < x_t0.len() {
            let disturbed = self.disturbed(&**contact, whole.from, whole, false);
            report.woken += disturbed.len();
            self.grow(disturbed, false);
        }
    }

    /// Sleepers that contact wakes in this stage, if the cloth ends it at `x`. Of the others, the
    /// forces are brought up to date if this is the end.
    fn disturbed(
        &mut self,
        contact: &dyn Contact,
        x: &[World3],
        whole: &WholeStage<'_>,
        is_end: bool,
    ) -> Vec<u32> {
        let gradient = gradient_of(contact, x);
        let (h, time) = (whole.start.h, whole.start.time);
        let (mut woken, mut changed) = (Vec::new(), Vec::new());
        for (i, now) in gradient.iter().enumerate() {
            let Some(rest) = self.queue.get(i) else { continue };
            let before = self.touching[i];
            if (now - before).norm() <= SAME * (now.norm() + before.norm()) {
                continue;
            }
            let f = rest.f + before - now;
            let p = whole.p[i] + f * h;
            if p.norm() > rest.p_r {
                woken.push(i as u32);
            } else {
                changed.push((i, Rest { since: time, p, f, ..*rest }));
            }
        }
        if is_end && woken.is_empty() {
            for (i, rest) in changed {
                self.queue.rest(i, rest);
                self.touching[i] = gradient[i];
            }
        }
        woken
    }

    /// Solves the stage for the active vertices.
    fn attempt(
        &mut self,
        system: &mut System,
        solver: &mut dyn LinearSolver,
        settings: &NewtonSettings,
        whole: &WholeStage<'_>,
        report: &mut RestReport,
    ) -> Result<Try, SolveError> {
        let n = self.active.len();
        if self.n_active == n {
            let local = Local::new(whole, (0..n as u32).collect(), &|_| true)?;
            system.springs = Springs { springs: whole.start.constraints.springs.clone() };
            system.begin(local.stage(whole.start.h));
            system.make_room_for_contact()?;
            let Solved { x, gradient, is_solved, report } =
                local.solve(system, solver, settings, whole)?;
            return Ok(Try { x, gradient, is_solved, report, pushed: Vec::new() });
        }
        if self.patch.is_none() {
            report.parts += 1;
            let active = (0..n as u32).filter(|&i| self.active[i as usize]);
            let vertices = self.near.around(active, REACH);
            let part = Arc::new(Part::new(self.active.clone(), vertices));
            self.patch = Some(Patch { system: system.part(&part)?, part });
        }
        let Some(Patch { part, system: own }) = &mut self.patch else { unreachable!() };
        let local = Local::new(whole, part.vertices().to_vec(), &|i| part.answers(i))?;
        own.springs = Springs::of(part, &whole.start.constraints.springs);
        own.begin(local.stage(whole.start.h));
        let Some(contact) = system.contact.take() else {
            return Ok(scattered(
                part,
                whole,
                local.solve(own, solver, settings, whole)?,
                Vec::new(),
            ));
        };
        let lent =
            PartContact::new(contact, part.clone(), whole.from.to_vec(), whole.fixed.to_vec());
        own.contact = Some(Box::new(lent.clone()));
        let room = own.make_room_for_contact().map_err(SolveError::from);
        let solved = room.and_then(|()| local.solve(own, solver, settings, whole));
        own.contact = None;
        let (contact, pushed) = lent.end();
        system.contact = contact;
        Ok(scattered(part, whole, solved?, pushed))
    }

    /// Momenta over mass at the end of the stage (m/s).
    fn momenta(
        &self,
        whole: &WholeStage<'_>,
        x: &[World3],
        gradient: &[World3],
        is_solved: bool,
        report: &mut RestReport,
    ) -> Vec<World3> {
        let &StageStart { base, h, time, .. } = whole.start;
        let mut v = whole.start.velocity.to_vec();
        self.settle(&mut v, &whole.cloth.m, time);
        for (i, v) in v.iter_mut().enumerate().filter(|(i, _)| self.active[*i]) {
            let d = x[i] - base[i];
            if whole.fixed[i] || d != World3::zeros() {
                let held = &whole.held[i];
                *v = d / h;
                if !whole.fixed[i] && !held.is_free() {
                    let conjugate = held.conjugate().expect("it was convex before the stage");
                    let by_force = whole.p[i] - gradient[i] * h;
                    let p = if is_solved && conjugate.is_vague(&by_force, &d, h) {
                        by_force
                    } else {
                        conjugate.momentum(v)
                    };
                    let before = whole.start.velocity[i] * whole.cloth.m[i];
                    *v = self.stuck(held, &before, p, h) / whole.cloth.m[i];
                }
                continue;
            }
            let mut p = whole.p[i] - gradient[i] * h;
            let (norm, most) = (p.norm(), whole.held[i].p_r());
            let is_off = norm > (1.0 + 2.0 * whole.fine) * most;
            if is_off || (norm > most && self.policy.bleeding.is_some()) {
                // Left over by a stage that did not converge, it would be energy from nowhere; where
                // momentum bleeds, less does too.
                report.cut += usize::from(is_off);
                p *= INSIDE * most / norm;
            }
            *v = p / whole.cloth.m[i];
        }
        v
    }

    /// A momentum at the end of a stage of length `h` (s), put to rest if it bleeds, is slow, and does not
    /// get faster. `before` is that at its beginning, before any of it bled: with what was left then, each
    /// force forwards would make it faster, though friction holds it.
    fn stuck(&self, held: &Held, before: &World3, p: World3, h: f64) -> World3 {
        let Some(tau) = self.policy.bleeding else { return p };
        let (r, p_r) = (p.norm(), held.p_r());
        let most = before.norm() + GROWTH * (h / tau).min(1.0) * p_r;
        let is_slow = held.dphi(r) < STICK * p_r;
        if r > p_r && is_slow && r <= most { p * (INSIDE * p_r / r) } else { p }
    }
}
