//! Cloth of which parts rest: implicit stages under a policy of restraint, whose cost follows what
//! moves.
//!
//! A restrained vertex keeps its momentum p while it stands still (Manteaux2013), with a convex law
//! that lets an implicit stage decide at its end who moves (`newton/restrained.rs`). Velocities of a
//! cloth under restraint are momenta over mass; where nothing is restrained that is the same. Where
//! momentum bleeds away, vertices stand or are free instead, and stages are plain: see `friction.rs`.
//!
//! The vertices are of two kinds. The *active* ones are those that moved in the last stage and all
//! within a few edges; their forces are evaluated, as forces of a [`Part`] of the cloth with the same
//! bits as in the whole. All others *sleep*: nothing near them has moved, so the force on them is
//! constant, and the time at which their momentum will have grown too large is known beforehand (a
//! queue, [`WakeQueue`]). If a stage moves something whose neighbourhood is not active all, it is
//! made again with a larger part. So who sleeps never decides what happens, only what it costs.

mod fall_asleep;
mod friction;
mod local;
mod momenta;
mod part_contact;

use crate::contact::Contact;
use crate::force::Stage;
use crate::integrator::{StageEnd, StageStart, Step, plain_stage};
use crate::neighbours::Neighbours;
use crate::part::Part;
use crate::point_forces::Springs;
use crate::solve_report::{NewtonSettings, RestReport, SolveError, SolveReport};
use crate::solver::LinearSolver;
use crate::system::{Constraints, System};
use arps::{Held, Particle, Rest, Restraint, WakeQueue};
use friction::Restless;
use local::{Local, Solved, Try, WholeStage, check_laws, scattered};
use mesh_core::{ClothState, World3};
use part_contact::{PartContact, gradient_of};
use std::sync::Arc;
use std::time::Instant;

/// Edges within which the force on a vertex depends on another: bending looks across a triangle.
const REACH: usize = 2;
/// Share of the vertices above which all are active.
const WHOLE: f64 = 0.6;
/// The part is made smaller when less than this share of it is wanted.
const SHRINK: f64 = 0.5;
/// Change of a contact force on a sleeper that is rounding (1).
const SAME: f64 = 1e-9;

/// Restraint of vertices: who may rest.
#[derive(Clone)]
pub struct RestingPolicy {
    /// The thresholds.
    pub restraint: Arc<dyn Restraint>,
    /// Time constant τ with which momentum bleeds away that is held back (s), if it does.
    ///
    /// Without, momenta and the restrained energy are conserved; but damped cloth creeps towards
    /// ‖p‖ = p_r for ever, and while it slows down a stage solves many linear systems. With τ, what moves
    /// has full dynamics, and a stage costs what it does without restraint. What is slower than p_r/2 with
    /// all near it, and hardly gets faster, is put to rest, and stays until the momentum that it gathers
    /// exceeds p_r, while that bleeds in τ/8: so until more than 8 p_r/τ pulls at it for long, besides what
    /// friction in its contacts holds. What is slower than p_f loses in τ what restraint would hold back.
    /// Kinetic and potential energy together only fall by it; momentum is not conserved.
    pub bleeding: Option<f64>,
}

/// The state of a restrained cloth on its current mesh.
pub(crate) struct Resting {
    policy: RestingPolicy,
    near: Neighbours,
    active: Vec<bool>,
    n_active: usize,
    /// Forces of the active vertices, unless all or none are, or they are others than in the last stage.
    patch: Option<Patch>,
    queue: WakeQueue,
    /// Gradient of contact in the forces of sleepers (N); empty without contact.
    touching: Vec<World3>,
    /// Where momentum bleeds, what active vertices that stand have gathered (kg m/s).
    gathered: Vec<World3>,
    /// False if it is not known what those have gathered.
    knows_past: bool,
    /// Of these, those that are free in the next stage.
    loose: Vec<u32>,
    restless: Restless,
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
            gathered: vec![World3::zeros(); n],
            knows_past: false,
            loose: Vec::new(),
            restless: Restless::default(),
            was_fixed: vec![false; n],
            last: Constraints::default(),
        }
    }

    /// Wakes everything and forgets the past; momenta must have been [settled](Resting::settle).
    pub(crate) fn wake_all(&mut self) {
        self.activate_all();
        self.knows_past = false;
        self.loose.clear();
        self.restless = Restless::default();
    }

    /// Wakes some vertices at a time (s), and what is near them.
    pub(crate) fn wake(&mut self, vertices: Vec<u32>, time: f64) {
        self.grow(vertices, 2 * REACH, time);
    }

    fn activate_all(&mut self) {
        self.active.fill(true);
        self.n_active = self.active.len();
        self.patch = None;
        self.queue = WakeQueue::new();
        self.gathered.fill(World3::zeros());
    }

    /// Goes on with another policy from a time (s) on; sleepers with other thresholds wake at another
    /// time.
    pub(crate) fn change_policy(&mut self, policy: RestingPolicy, cloth: &ClothState, time: f64) {
        for i in 0..self.active.len() {
            let Some(&rest) = self.queue.get(i) else { continue };
            let (mass, x) = (cloth.m[i], cloth.x[i]);
            let held = policy.restraint.at(&Particle { index: i, mass, x, time });
            let (p_r, bleeding) = (held.p_r(), policy.rate(&held));
            if !self.was_fixed[i] && (p_r != rest.p_r || bleeding != rest.bleeding) {
                let p = rest.momentum_at(time);
                self.queue.rest(i, Rest { since: time, p, p_r, bleeding, ..rest });
            }
        }
        self.policy = policy;
    }

    /// Brings the velocities of sleepers up to a time (s). What they gather where momentum bleeds is never
    /// theirs.
    pub(crate) fn settle(&self, v: &mut [World3], mass: &[f64], time: f64) {
        if self.queue.is_empty() || self.policy.bleeding.is_some() {
            return;
        }
        for (i, v) in v.iter_mut().enumerate() {
            if let Some(rest) = self.queue.get(i) {
                *v = rest.momentum_at(time) / mass[i];
            }
        }
    }

    /// Whether velocities are momenta over mass that a law conserves.
    pub(crate) fn conserves(&self) -> bool {
        self.policy.bleeding.is_none()
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
        let &StageStart { x_t0, base, h, time_t0, time, .. } = start;
        let n = x_t0.len();
        let held = |i: usize| {
            let (mass, x) = (cloth.m[i], x_t0[i]);
            self.policy.restraint.at(&Particle { index: i, mass, x, time: time_t0 })
        };
        let held: Vec<Held> = (0..n).map(held).collect();
        check_laws(&held, time_t0)?;
        system.springs.springs.clone_from(&start.constraints.springs);
        let slowed = self.policy.slowed(&held, start.velocity, h);
        let start =
            &StageStart { velocity: &slowed, constraints: start.constraints.clone(), ..*start };
        let velocity = start.velocity;
        let mut fixed = vec![false; n];
        let mut from = x_t0.to_vec();
        for &(i, x) in &start.constraints.fixed {
            fixed[i as usize] = true;
            from[i as usize] = x;
        }
        let stands = self.policy.who_stands(&held, &std::mem::take(&mut self.loose), start, &fixed);
        let is_restrained = match &stands {
            None => !held.iter().all(Held::is_free),
            Some(stands) => stands.contains(&true),
        };
        if !is_restrained {
            self.activate_all();
            let mut end = plain_stage(cloth, system, solver, settings, start)?;
            if !held.iter().all(Held::is_free) {
                let (solves, unknowns) = (end.report.iterations, end.report.iterations * n);
                end.report.rest = RestReport { stages: 1, solves, unknowns, ..Default::default() };
            }
            return Ok(end);
        }
        let p: Vec<World3> = (0..n).map(|i| velocity[i] * cloth.m[i]).collect();

        let mut rest = RestReport { stages: 1, ..RestReport::default() };
        let woken = self.woken(&held, start, &from, &fixed, &mut rest);
        self.grow(woken, 2 * REACH, time_t0);
        let mut contact_s = 0.0;
        let mut whole = WholeStage {
            cloth,
            start,
            held: &held,
            p: &p,
            fixed: &fixed,
            from: &from,
            stands,
            guess: None,
        };
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
        let mut tries = SolveReport::default();
        let (done, grip) = loop {
            let clock = Instant::now();
            self.begin_contact(system, &whole, &mut rest);
            contact_s += clock.elapsed().as_secs_f64();
            let done = if self.n_active == 0 {
                let report = SolveReport { stages: 1, ..SolveReport::default() };
                Try {
                    x: from.clone(),
                    gradient: vec![World3::zeros(); n],
                    is_solved: false,
                    bent: Vec::new(),
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
                let grip = self.grip(system.contact.as_deref(), &whole);
                missing = self.pulled(&mut whole, &done, &grip, rest.redone);
                if missing.is_empty() {
                    break (done, grip);
                }
            }
            rest.redone += 1;
            // Only the work of a try counts.
            tries.add(&SolveReport {
                stages: 0,
                unconverged: 0,
                residual: 0.0,
                touches: 0,
                shortened: 0,
                ..done.report
            });
            whole.guess = Some(done.x);
            self.grow(missing, 4 * REACH, time_t0);
        };
        let Try { x, gradient, is_solved, bent, mut report, .. } = done;
        report.add(&tries);
        report.contact_s += contact_s;
        rest.untouched = n - self.n_active;
        let v = self.momenta(&whole, &x, &gradient, is_solved, &mut rest);
        self.gather(&whole, &gradient, &grip);
        self.put_to_sleep(system, &whole, &x, &v, &grip);
        self.was_fixed.clone_from(&fixed);
        self.last.clone_from(&start.constraints);
        report.rest.add(&rest);
        Ok(StageEnd { x, v, bent, report })
    }

    /// Sleepers that wake in the stage.
    fn woken(
        &mut self,
        held: &[Held],
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
                    let p = rest.momentum_at(since);
                    let (p_r, bleeding) = (held.p_r(), self.policy.rate(held));
                    self.queue.rest(i, Rest { since, p, p_r, bleeding, ..rest });
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

    /// Makes vertices active with all around them, at a time (s).
    fn grow(&mut self, missing: Vec<u32>, rings: usize, time: f64) {
        let mut wanted = self.near.around(missing, rings);
        wanted.retain(|&i| !self.active[i as usize]);
        if wanted.is_empty() {
            return;
        }
        let n = self.active.len();
        if (self.n_active + wanted.len()) as f64 > WHOLE * n as f64 {
            wanted = (0..n as u32).filter(|&i| !self.active[i as usize]).collect();
        }
        self.patch = None;
        for i in wanted {
            self.activate(i as usize, time);
        }
    }

    fn activate(&mut self, i: usize, time: f64) {
        if let Some(rest) = self.queue.take(i)
            && self.policy.bleeding.is_some()
        {
            self.gathered[i] = rest.momentum_at(time);
        }
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
            self.grow(disturbed, 2 * REACH, time_t0);
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
            // What friction in the contact holds may have changed as well.
            if p.norm() > rest.p_r || self.policy.bleeding.is_some() {
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
            let local = Local::new(whole, (0..n as u32).collect(), &|_| true);
            system.begin(local.stage(whole.start.h));
            system.make_room_for_contact()?;
            let Solved { x, gradient, is_solved, bent, report } =
                local.solve(system, solver, settings, whole)?;
            return Ok(Try { x, gradient, is_solved, bent, report, pushed: Vec::new() });
        }
        if self.patch.is_none() {
            report.parts += 1;
            let active = (0..n as u32).filter(|&i| self.active[i as usize]);
            let vertices = self.near.around(active, REACH);
            let part = Arc::new(Part::new(self.active.clone(), vertices));
            self.patch = Some(Patch { system: system.part(&part)?, part });
        }
        let Some(Patch { part, system: own }) = &mut self.patch else { unreachable!() };
        let local = Local::new(whole, part.vertices().to_vec(), &|i| part.answers(i));
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
}
