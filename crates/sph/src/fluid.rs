//! A fluid and its time step.

use crate::grid::Point;
use crate::neighbours::Neighbours;
use crate::pair::Laws;
use crate::report::StepReport;
use crate::settings::{FluidError, FluidSettings};
use crate::source::{Emitter, Sink};
use crate::state::{Spare, State};
use crate::sweep;
use crate::walls::Walls;
use nalgebra::Vector3;

/// Particles of one fluid between walls.
#[derive(Clone, Debug)]
pub struct Fluid {
    pub(crate) settings: FluidSettings,
    pub(crate) laws: Laws,
    pub(crate) walls: Walls,
    pub(crate) state: State,
    /// Positions when neighbours were last listed.
    pub(crate) listed: Vec<Point>,
    pub(crate) neighbours: Neighbours,
    pub(crate) emitters: Vec<Emitter>,
    pub(crate) sinks: Vec<Sink>,
    pub(crate) time: f64,
    pub(crate) next_id: u64,
    fastest: f64,
    hardest: f64,
    scratch: Scratch,
}

/// Memory that lives from step to step and holds nothing of use between two.
#[derive(Clone, Debug, Default)]
struct Scratch {
    x: Vec<Point>,
    u: Vec<Point>,
    w: Vec<Point>,
    density: Vec<f64>,
    order: Vec<u32>,
    spare: Spare,
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
        walls.prepare(&laws.kernel, settings.rest_density, laws.wall_factor, reach);
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
            state,
            listed: Vec::new(),
            neighbours: Neighbours::default(),
            emitters: Vec::new(),
            sinks: Vec::new(),
            time: 0.0,
            fastest: velocities.iter().map(Vector3::norm).fold(0.0, f64::max),
            hardest: 0.0,
            scratch: Scratch::default(),
        };
        fluid.list_neighbours();
        fluid.evaluate_all();
        Ok(fluid)
    }

    /// The longest step that is stable in the present state (s): a part of the time that sound and
    /// flow take through a smoothing length, and of the time in which the largest acceleration crosses
    /// it (Monaghan1992 §10.3).
    pub fn step_bound(&self) -> f64 {
        let h = self.laws.kernel.smoothing_length();
        let signal = self.settings.sound_speed * (1.0 + 0.6 * self.settings.viscosity) + self.fastest;
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
        if !(dt.is_finite() && dt > 0.0) {
            let wanted = "positive and finite";
            return Err(FluidError::OutOfRange { name: "step", value: dt, wanted });
        }
        let bound = self.step_bound();
        if dt > bound * (1.0 + 1e-12) {
            return Err(FluidError::StepTooLong { step: dt, bound });
        }
        let moved_squared = self.kick_and_drift(dt)?;
        self.time += dt;
        let mut report = StepReport { steps: 1, ..StepReport::default() };
        let changed = self.emit_and_drain(&mut report);
        let half_skin = 0.5 * self.settings.skin * self.settings.spacing;
        if changed || moved_squared > half_skin * half_skin {
            self.list_neighbours();
            report.listings = 1;
        }
        self.evaluate_all();
        report.particles = self.state.len() as u64;
        report.pairs = self.neighbours.n_pairs() as u64;
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
        let mut report = StepReport::default();
        let mut left = duration;
        while left > 0.0 {
            let n = (left / self.step_bound()).ceil().max(1.0);
            let dt = left / n;
            report.add(&self.step(dt)?);
            left = if n > 1.0 { left - dt } else { 0.0 };
        }
        Ok(report)
    }

    /// New velocities and positions. Returns the square of the farthest way of a particle from where
    /// neighbours were listed (m²).
    fn kick_and_drift(&mut self, dt: f64) -> Result<f64, FluidError> {
        let (state, next) = (&self.state, &mut self.scratch);
        next.x.clear();
        next.u.clear();
        let domain = &self.settings.domain;
        let (low, high) = (domain.min, domain.max);
        let (mut fastest, mut farthest) = (0.0f64, 0.0f64);
        let mut inside = true;
        for i in 0..state.len() {
            let (x, u, a, from) = (&state.x[i], &state.u[i], &state.a[i], &self.listed[i]);
            let u = [u[0] + dt * a[0], u[1] + dt * a[1], u[2] + dt * a[2], 0.0];
            let x = [x[0] + dt * u[0], x[1] + dt * u[1], x[2] + dt * u[2], x[3]];
            for k in 0..3 {
                inside &= (low[k] <= x[k]) & (x[k] <= high[k]);
            }
            let d = [x[0] - from[0], x[1] - from[1], x[2] - from[2]];
            let way = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            let speed = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
            farthest = if way > farthest { way } else { farthest };
            fastest = if speed > fastest { speed } else { fastest };
            next.x.push(x);
            next.u.push(u);
        }
        if !inside {
            let is_out = |x: &Point| !domain.contains(&Vector3::new(x[0], x[1], x[2]));
            let i = next.x.iter().position(is_out).expect("one is out");
            let u = &next.u[i];
            let speed = Vector3::new(u[0], u[1], u[2]).norm();
            return Err(escaped(state.id[i], &next.x[i], speed));
        }
        std::mem::swap(&mut self.state.x, &mut next.x);
        std::mem::swap(&mut self.state.u, &mut next.u);
        self.state.w.copy_from_slice(&self.state.u);
        self.fastest = fastest.sqrt();
        Ok(farthest)
    }

    /// New and removed particles. Returns true if there are any.
    fn emit_and_drain(&mut self, report: &mut StepReport) -> bool {
        let before = self.state.len();
        for sink in &self.sinks {
            self.state.retain(|x| !sink.swallows(&Vector3::new(x[0], x[1], x[2])));
        }
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
    fn list_neighbours(&mut self) {
        let reach = self.laws.kernel.support() + self.settings.skin * self.settings.spacing;
        self.neighbours.sort(&self.state.x, reach, &mut self.scratch.order);
        self.state.sort(&self.scratch.order, &mut self.scratch.spare);
        self.neighbours.list(&self.state.x, &self.walls, reach);
        self.listed.clone_from(&self.state.x);
    }

    /// Densities, pressures and accelerations of all particles, from nothing but their positions and
    /// effective velocities.
    fn evaluate_all(&mut self) {
        let State { x, w, a, .. } = &mut self.state;
        let density = &mut self.scratch.density;
        density.resize(x.len(), 0.0);
        sweep::densities(&self.laws, x, &self.walls, &mut self.neighbours, density);
        for ((x, w), &density) in x.iter_mut().zip(w.iter_mut()).zip(density.iter()) {
            x[3] = self.laws.pressure_term(density);
            w[3] = density;
        }
        let gravity = self.settings.gravity;
        sweep::accelerations(&self.laws, x, w, &self.walls, &mut self.neighbours, a);
        let mut hardest = 0.0f64;
        for a in a.iter_mut() {
            for k in 0..3 {
                a[k] += gravity[k];
            }
            let squared = a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
            hardest = if squared > hardest { squared } else { hardest };
        }
        self.hardest = hardest.sqrt();
    }
}

fn escaped(id: u64, x: &Point, speed: f64) -> FluidError {
    FluidError::Escaped { id, x: x[0], y: x[1], z: x[2], speed }
}
