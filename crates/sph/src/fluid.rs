//! A fluid and its time step.

use crate::changes::Changes;
use crate::grid::Point;
use crate::incremental::Update;
use crate::motion::{Moved, Outside, larger};
use crate::neighbours::Neighbours;
use crate::pair::Laws;
use crate::report::{Seconds, StepReport};
use crate::restraint::RestraintSettings;
use crate::settings::{FluidError, FluidSettings};
use crate::sheets::Sheets;
use crate::source::{Emitter, Sink};
use crate::state::{Spare, State};
use crate::sweep;
use crate::walls::{WallState, Walls};
use arps::Restraint;
use nalgebra::Vector3;
use std::time::Instant;

/// Particles of one fluid between walls. `R` is the policy that restrains them; `()` restrains nothing. It
/// is asked about every particle in every step, with the lasting number for its index.
#[derive(Clone, Debug)]
pub struct Fluid<R = ()> {
    pub(crate) settings: FluidSettings,
    pub(crate) laws: Laws,
    pub(crate) walls: Walls,
    /// The part of the walls that fluid may touch.
    pub(crate) touched: WallState,
    pub(crate) state: State,
    /// Positions when neighbours were last listed.
    pub(crate) listed: Vec<Point>,
    pub(crate) neighbours: Neighbours,
    pub(crate) restraint: Option<(R, RestraintSettings)>,
    pub(crate) emitters: Vec<Emitter>,
    pub(crate) sinks: Vec<Sink>,
    pub(crate) time: f64,
    pub(crate) next_id: u64,
    pub(crate) fastest: f64,
    pub(crate) hardest: f64,
    /// At least as far as any particle is from where it was listed (m).
    pub(crate) farthest: f64,
    pub(crate) scratch: Scratch,
}

/// Memory that lives from step to step and holds nothing of use between two.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) moved: Moved,
    pub(crate) changes: Changes,
    pub(crate) order: Vec<u32>,
    pub(crate) spare: Spare,
}

impl Fluid {
    /// A fluid of particles at these positions (m) with these velocities (m/s).
    ///
    /// # Errors
    /// If a setting has no sense, the lists differ in length, or a particle is outside of the domain.
    pub fn new(
        settings: FluidSettings,
        mut walls: Walls,
        positions: &[Vector3<f64>],
        velocities: &[Vector3<f64>],
    ) -> Result<Self, FluidError> {
        settings.check()?;
        if velocities.len() != positions.len() {
            let (found, expected) = (velocities.len(), positions.len());
            return Err(FluidError::Length { what: "velocities", found, expected });
        }
        if positions.len() + walls.n_particles() > (u32::MAX / 4) as usize {
            return Err(FluidError::TooMany { n: positions.len() });
        }
        let laws = Laws::new(&settings);
        let reach = laws.kernel.support() + settings.skin * settings.spacing;
        let densities = (laws.mass / settings.spacing.powi(3), settings.rest_density);
        walls.prepare(&laws.kernel, densities, laws.wall_factor, reach);
        let mut state = State::default();
        for (id, (x, v)) in (0..).zip(positions.iter().zip(velocities)) {
            if !settings.domain.contains(x) || !v.norm().is_finite() {
                return Err(escaped(id, &[x.x, x.y, x.z, 0.0], v.norm()));
            }
            state.push(id, x, v);
        }
        let mut fluid = Fluid {
            next_id: state.len() as u64,
            settings,
            laws,
            walls,
            touched: WallState::default(),
            state,
            listed: Vec::new(),
            neighbours: Neighbours::default(),
            restraint: None,
            emitters: Vec::new(),
            sinks: Vec::new(),
            time: 0.0,
            fastest: velocities.iter().map(Vector3::norm).fold(0.0, f64::max),
            hardest: 0.0,
            farthest: 0.0,
            scratch: Scratch::default(),
        };
        fluid.list_neighbours();
        fluid.evaluate_all(&mut Seconds::default());
        fluid.hardest = hardest(&fluid.state.a);
        Ok(fluid)
    }
}

impl<R: Restraint> Fluid<R> {
    /// The same fluid under a policy: from the next step on particles move with the effective velocity
    /// that the policy gives them, and what stands still costs little.
    ///
    /// # Errors
    /// If a setting has no sense.
    pub fn restrained<Q: Restraint>(
        self,
        policy: Q,
        settings: RestraintSettings,
    ) -> Result<Fluid<Q>, FluidError> {
        settings.check()?;
        Ok(self.with_restraint(Some((policy, settings))))
    }

    /// The same fluid without any policy, although it is of a type that could have one.
    pub fn released<Q: Restraint>(self) -> Fluid<Q> {
        self.with_restraint(None)
    }

    /// From the next step on the policy is this one; nothing where there has been none. Whoever rests wakes
    /// in that step if the new one wants it.
    pub fn change_policy(&mut self, policy: R) {
        if let Some((old, _)) = &mut self.restraint {
            *old = policy;
        }
    }

    /// The policy, if there is one.
    pub fn policy(&self) -> Option<&R> {
        self.restraint.as_ref().map(|(policy, _)| policy)
    }

    fn with_restraint<Q>(self, restraint: Option<(Q, RestraintSettings)>) -> Fluid<Q> {
        Fluid {
            settings: self.settings,
            laws: self.laws,
            walls: self.walls,
            touched: self.touched,
            state: self.state,
            listed: self.listed,
            neighbours: self.neighbours,
            restraint,
            emitters: self.emitters,
            sinks: self.sinks,
            time: self.time,
            next_id: self.next_id,
            fastest: self.fastest,
            hardest: self.hardest,
            farthest: self.farthest,
            scratch: self.scratch,
        }
    }

    /// The longest step that is stable in the present state (s): a part of the time that sound and
    /// flow take through a smoothing length, and of the time in which the largest acceleration crosses
    /// it (Monaghan1992 §10.3).
    pub fn step_bound(&self) -> f64 {
        self.step_bound_among(0.0)
    }

    /// The same among surfaces that move at a `speed` (m/s).
    pub(crate) fn step_bound_among(&self, speed: f64) -> f64 {
        let h = self.laws.kernel.smoothing_length();
        let flow = self.fastest + speed;
        let signal = self.settings.sound_speed * (1.0 + 0.6 * self.settings.viscosity) + flow;
        let by_sound = self.settings.courant * h / signal;
        let by_force = 0.25 * (h / self.hardest).sqrt();
        by_sound.min(by_force)
    }

    /// Makes one step of `dt` (s): velocities by the present accelerations, then positions by the new
    /// velocities, then everything that depends on them.
    ///
    /// # Errors
    /// If the step is not positive or longer than [`Fluid::step_bound`], or if a particle leaves the
    /// domain. The fluid is then as it was.
    pub fn step(&mut self, dt: f64) -> Result<StepReport, FluidError> {
        self.leave_sheets();
        self.step_among(dt, None)
    }

    /// A step among surfaces, if there are any.
    pub(crate) fn step_among(
        &mut self,
        dt: f64,
        mut sheets: Option<&mut Sheets>,
    ) -> Result<StepReport, FluidError> {
        if !(dt.is_finite() && dt > 0.0) {
            let wanted = "positive and finite";
            return Err(FluidError::OutOfRange { name: "step", value: dt, wanted });
        }
        let speed = sheets.as_ref().map_or(0.0, |sheets| sheets.speed());
        let bound = self.step_bound_among(speed);
        if dt > bound * (1.0 + 1e-12) {
            return Err(FluidError::StepTooLong { step: dt, bound });
        }
        let n = self.state.len();
        let mut report = StepReport { steps: 1, particles: n as u64, ..StepReport::default() };
        if self.is_out_of_order() {
            let clock = Instant::now();
            self.list_in_between();
            if let Some(sheets) = &mut sheets {
                sheets.forget_particles();
            }
            report.seconds.neighbours += clock.elapsed().as_secs_f64();
            report.listings += 1;
        }
        let clock = Instant::now();
        self.kick_and_drift(dt, sheets.as_deref_mut(), &mut report)?;
        self.time += dt;
        report.moved =
            if self.restraint.is_some() { self.scratch.moved.movers.len() } else { n } as u64;
        report.seconds.motion = clock.elapsed().as_secs_f64() - report.seconds.sheets;
        let clock = Instant::now();
        let is_mended = self.mend_lists(&mut report);
        let lists_are_old =
            !is_mended && (self.emit_and_drain(&mut report) || self.farthest > self.half_skin());
        if lists_are_old {
            self.list_neighbours();
            report.listings += 1;
        }
        report.seconds.neighbours += clock.elapsed().as_secs_f64();
        let clock = Instant::now();
        if let Some(sheets) = &mut sheets {
            let others = lists_are_old || report.emitted + report.drained > 0;
            self.touch_sheets(sheets, others, &mut report.seconds);
        }
        let by_sheets = sheets.as_ref().map_or(&[][..], |sheets| &sheets.changed);
        if lists_are_old || !self.evaluate_changes(by_sheets, &mut report) {
            self.evaluate_all(&mut report.seconds);
            report.sweeps = 1;
        } else {
            report.seconds.changes = clock.elapsed().as_secs_f64();
        }
        if report.sweeps == 1 {
            let n_pairs = self.neighbours.n_pairs() as u64;
            (report.density_pairs, report.force_pairs) = (n_pairs, n_pairs);
        }
        if let Some(sheets) = &mut sheets {
            self.feel_sheets(sheets, &mut report.seconds);
        }
        self.hardest = hardest(&self.state.a);
        Ok(report)
    }

    /// Makes as many steps within the bound as `duration` (s) takes.
    ///
    /// # Errors
    /// As for [`Fluid::step`]; the fluid is then as before the step that failed.
    pub fn advance(&mut self, duration: f64) -> Result<StepReport, FluidError> {
        if !(duration.is_finite() && duration >= 0.0) {
            let wanted = "0 or more and finite";
            return Err(FluidError::OutOfRange { name: "duration", value: duration, wanted });
        }
        self.leave_sheets();
        self.make_steps(duration, None)
    }

    /// As many steps as `duration` (s) takes.
    pub(crate) fn make_steps(
        &mut self,
        duration: f64,
        mut sheets: Option<&mut Sheets>,
    ) -> Result<StepReport, FluidError> {
        let mut report = StepReport::default();
        let mut left = duration;
        while left > 0.0 {
            let speed = sheets.as_ref().map_or(0.0, |sheets| sheets.speed());
            let n = (left / self.step_bound_among(speed)).ceil().max(1.0);
            let dt = left / n;
            report.add(&self.step_among(dt, sheets.as_deref_mut())?);
            left = if n > 1.0 { left - dt } else { 0.0 };
        }
        Ok(report)
    }

    /// New velocities and positions.
    fn kick_and_drift(
        &mut self,
        dt: f64,
        sheets: Option<&mut Sheets>,
        report: &mut StepReport,
    ) -> Result<(), FluidError> {
        let (state, moved) = (&mut self.state, &mut self.scratch.moved);
        let (listed, domain) = (&self.listed, &self.settings.domain);
        match &self.restraint {
            None => moved.free(state, listed, domain, dt),
            Some(restraint) => {
                let now = (self.laws.mass, self.time);
                moved.restrained(restraint, now, state, listed, domain, dt);
            }
        }
        if let Some(sheets) = sheets {
            let clock = Instant::now();
            // As far as particles and surfaces may come towards each other.
            let ahead = (moved.fastest + sheets.speed()) * dt;
            sheets.list(&self.laws, &state.x, ahead);
            sheets.push((dt, self.laws.mass), &state.by_sheets, &mut state.given);
            sheets.begin_step(dt);
            let is_restrained = self.restraint.is_some();
            let of_step = (self.laws.mass, dt);
            let kept = sheets.keep_sides(state, moved, (listed, domain), of_step, is_restrained);
            (report.stopped, report.squeezed) = (kept.stopped, kept.squeezed);
            sheets.end_step();
            sheets.travel((moved.fastest * dt).max(kept.longest_way) + sheets.speed() * dt);
            report.seconds.sheets += clock.elapsed().as_secs_f64();
        }
        if let Some(Outside { at, x, u }) = &moved.outside {
            let speed = Vector3::new(u[0], u[1], u[2]).norm();
            return Err(escaped(state.id[*at], x, speed));
        }
        match &self.restraint {
            None => moved.apply_free(state),
            Some(_) => moved.apply_restrained(state),
        }
        self.fastest = moved.fastest;
        self.farthest = self.farthest.max(moved.farthest_squared.sqrt());
        Ok(())
    }

    /// Densities, pressures and accelerations by what the step has changed. Returns false if so much
    /// moves that everything has to be computed anew.
    fn evaluate_changes(&mut self, by_sheets: &[u32], report: &mut StepReport) -> bool {
        let Some((_, settings)) = &self.restraint else { return false };
        let n = self.state.len();
        let (moved, changes) = (&self.scratch.moved, &mut self.scratch.changes);
        // Nothing held is nothing gained: the bits are then those of a fluid without a policy.
        let most_movers = settings.sweep_above * n as f64;
        if !moved.any_held || moved.movers.len() as f64 >= most_movers || !changes.is_known(n) {
            return false;
        }
        let update = Update {
            laws: &self.laws,
            walls: &mut self.touched,
            neighbours: &mut self.neighbours,
            state: &mut self.state,
            movers: &moved.movers,
            stopped: &moved.stopped,
            by_sheets,
            tolerance: settings.pressure_tolerance,
            gravity: self.settings.gravity.into(),
            may_leave: settings.sweep_above < 1.0,
            force_interval: settings.force_interval,
            all_anew: report.emitted + report.drained > 0,
            changes,
        };
        let Some(looked) = update.run() else { return false };
        report.changed += looked.changed;
        report.density_pairs += looked.density_pairs;
        report.force_pairs += looked.force_pairs;
        true
    }

    /// Densities, pressures and accelerations of all particles, from nothing but their positions and
    /// effective velocities.
    pub(crate) fn evaluate_all(&mut self, seconds: &mut Seconds) {
        let clock = Instant::now();
        let State { x, w, a, density, by_sheets, .. } = &mut self.state;
        let (laws, neighbours) = (&self.laws, &mut self.neighbours);
        sweep::densities(laws, x, &self.touched, neighbours, density, None);
        sweep::wall_densities(laws, x, &mut self.touched, neighbours, None);
        for ((x, w), &density) in x.iter_mut().zip(w.iter_mut()).zip(density.iter()) {
            x[3] = self.laws.pressure_term(density);
            w[3] = density;
        }
        for (((x, w), density), by) in x.iter_mut().zip(w.iter_mut()).zip(density).zip(by_sheets) {
            if by[3] > 0.0 {
                w[3] = *density + by[3];
                x[3] = self.laws.pressure_term(w[3]);
            }
        }
        for (x, &density) in self.touched.x.iter_mut().zip(&self.touched.density) {
            x[3] = self.laws.pressure_term(density);
        }
        seconds.density += clock.elapsed().as_secs_f64();
        let clock = Instant::now();
        let all = (self.settings.gravity.into(), None);
        sweep::accelerations(&self.laws, x, w, &self.touched, &mut self.neighbours, all, a);
        if let Some((_, settings)) = &self.restraint {
            // While most particles move the next step will not look at changes either.
            let n_movers = self.scratch.moved.movers.len() as f64;
            if n_movers < settings.sweep_above * self.state.len() as f64 {
                self.scratch.changes.evaluated_all(&self.state, &self.touched);
            } else {
                self.scratch.changes.forget();
            }
        } else {
            self.scratch.changes.forget();
        }
        seconds.force += clock.elapsed().as_secs_f64();
    }
}

/// The greatest acceleration (m/s²).
pub(crate) fn hardest(a: &[Point]) -> f64 {
    let squared = |a: &Point| a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
    a.iter().fold(0.0, |most, a| larger(squared(a), most)).sqrt()
}

fn escaped(id: u64, x: &Point, speed: f64) -> FluidError {
    FluidError::Escaped { id, x: x[0], y: x[1], z: x[2], speed }
}
