//! Kick and drift: new velocities by the accelerations, new positions by the velocities.

use crate::grid::Point;
use crate::restraint::RestraintSettings;
use crate::settings::Bounds;
use crate::state::State;
use arps::{Motion, Particle, Restraint, Vector3};

/// The particles after a kick and a drift, and what was noticed on the way.
#[derive(Clone, Debug, Default)]
pub(crate) struct Moved {
    /// New momenta per mass of all particles.
    pub(crate) u: Vec<Point>,
    /// New positions and effective velocities: of all particles, or of the movers alone if there is a
    /// policy.
    pub(crate) x: Vec<Point>,
    pub(crate) w: Vec<Point>,
    /// Under a policy: particles whose position changes.
    pub(crate) movers: Vec<u32>,
    /// Under a policy: particles that have moved before and stand still now.
    pub(crate) stopped: Vec<u32>,
    /// Greatest speed of the momenta (m/s).
    pub(crate) fastest: f64,
    /// Square of the farthest way from where neighbours were listed (m²).
    pub(crate) farthest_squared: f64,
    /// True if a particle may be restrained at all.
    pub(crate) any_held: bool,
    /// The first particle that has left the domain.
    pub(crate) outside: Option<Outside>,
}

/// A particle that has left the domain.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outside {
    pub(crate) at: usize,
    pub(crate) x: Point,
    pub(crate) u: Point,
}

impl Moved {
    /// Starts anew.
    fn clear(&mut self) {
        self.x.clear();
        self.w.clear();
        self.u.clear();
        self.movers.clear();
        self.stopped.clear();
        (self.fastest, self.farthest_squared) = (0.0, 0.0);
        (self.any_held, self.outside) = (false, None);
    }

    /// Moves all particles freely for a time `dt` (s).
    pub(crate) fn free(&mut self, state: &State, listed: &[Point], domain: &Bounds, dt: f64) {
        self.clear();
        let (mut fastest, mut farthest, mut inside) = (0.0, 0.0, true);
        self.u.extend(state.u.iter().zip(&state.a).map(|(u, a)| {
            let u = kick(u, a, dt);
            fastest = larger(squared(&u), fastest);
            u
        }));
        self.x.extend(state.x.iter().zip(&self.u).zip(listed).map(|((x, u), listed)| {
            let x = drift(x, u, dt);
            inside &= is_inside(domain, &x);
            farthest = larger(squared(&difference(&x, listed)), farthest);
            x
        }));
        self.w.extend(self.u.iter().zip(&state.w).map(|(u, w)| [u[0], u[1], u[2], w[3]]));
        (self.fastest, self.farthest_squared) = (fastest.sqrt(), farthest);
        if !inside {
            let at = self.x.iter().position(|x| !is_inside(domain, x));
            self.outside = at.map(|at| Outside { at, x: self.x[at], u: self.u[at] });
        }
    }

    /// The same under a policy. `mass` is that of a particle (kg), `time` the time at the start (s).
    pub(crate) fn restrained<R: Restraint>(
        &mut self,
        (policy, settings): &(R, RestraintSettings),
        (mass, time): (f64, f64),
        state: &State,
        listed: &[Point],
        domain: &Bounds,
        dt: f64,
    ) {
        self.clear();
        let (mut fastest, mut any_held) = (0.0, false);
        // 1 − e^(−dt/τ): du/dt = a − u/τ is solved exactly, as `arps::bleeding_kick` does.
        let (tau, lost) = settings.bleeding.map_or((0.0, 0.0), |tau| (tau, -(-dt / tau).exp_m1()));
        let bleeds = settings.bleeding.is_some();
        let inactive_squared = settings.inactivity * settings.inactivity;
        let (movers, stopped) = (&mut self.movers, &mut self.stopped);
        let particles = state.x.iter().zip(&state.w).zip(state.u.iter().zip(&state.a)).enumerate();
        self.u.extend(particles.map(|(i, ((x, w), (u, a)))| {
            let was_still = squared(w) == 0.0;
            let position = Vector3::new(x[0], x[1], x[2]);
            let index = state.id[i] as usize;
            let held = policy.at(&Particle { index, mass, x: position, time });
            any_held |= !held.is_free();
            let u = if bleeds && was_still && !held.is_free() {
                let bled = |k: usize| u[k] + (tau * a[k] - u[k]) * lost;
                [bled(0), bled(1), bled(2), 0.0]
            } else {
                kick(u, a, dt)
            };
            fastest = larger(squared(&u), fastest);
            let v = match held.motion(&(Vector3::new(u[0], u[1], u[2]) * mass)) {
                Motion::Rest => [0.0; 4],
                Motion::Full => u,
                Motion::Transition => {
                    let v = held.velocity(&(Vector3::new(u[0], u[1], u[2]) * mass));
                    [v.x, v.y, v.z, 0.0]
                }
            };
            let speed_squared = squared(&v);
            if speed_squared > 0.0 && speed_squared >= inactive_squared {
                movers.push(i as u32);
                self.x.push(drift(x, &v, dt));
                self.w.push([v[0], v[1], v[2], w[3]]);
            } else if !was_still {
                stopped.push(i as u32);
            }
            u
        }));
        let (mut farthest, mut inside) = (0.0, true);
        for (x, &i) in self.x.iter().zip(&self.movers) {
            inside &= is_inside(domain, x);
            farthest = larger(squared(&difference(x, &listed[i as usize])), farthest);
        }
        (self.fastest, self.farthest_squared) = (f64::sqrt(fastest), farthest);
        self.any_held = any_held;
        if !inside {
            let k = self.x.iter().position(|x| !is_inside(domain, x));
            self.outside = k.map(|k| {
                let at = self.movers[k] as usize;
                Outside { at, x: self.x[k], u: self.u[at] }
            });
        }
    }

    /// Gives particle `i` another position, momentum per mass and effective velocity than was found, in
    /// its `slot` of the movers; one that has none moves all the same.
    pub(crate) fn correct(
        &mut self,
        i: usize,
        (slot, [x, u, w]): (Option<usize>, [nalgebra::Vector3<f64>; 3]),
        state: &State,
        listed: &[Point],
        domain: &Bounds,
    ) {
        let x = [x.x, x.y, x.z, state.x[i][3]];
        let w = [w.x, w.y, w.z, state.w[i][3]];
        self.u[i] = [u.x, u.y, u.z, 0.0];
        match slot {
            Some(slot) => (self.x[slot], self.w[slot]) = (x, w),
            None => {
                self.movers.push(i as u32);
                self.x.push(x);
                self.w.push(w);
                self.stopped.retain(|&stopped| stopped as usize != i);
            }
        }
        self.fastest = larger(u.norm(), self.fastest);
        let way = squared(&difference(&x, &listed[i]));
        self.farthest_squared = larger(way, self.farthest_squared);
        if !is_inside(domain, &x) && self.outside.is_none() {
            self.outside = Some(Outside { at: i, x, u: self.u[i] });
        }
    }

    /// Moves the particles of the state, as [`Moved::free`] has found.
    pub(crate) fn apply_free(&mut self, state: &mut State) {
        std::mem::swap(&mut self.x, &mut state.x);
        std::mem::swap(&mut self.w, &mut state.w);
        std::mem::swap(&mut self.u, &mut state.u);
    }

    /// Moves the particles of the state, as [`Moved::restrained`] has found.
    pub(crate) fn apply_restrained(&mut self, state: &mut State) {
        for ((&i, x), w) in self.movers.iter().zip(&self.x).zip(&self.w) {
            (state.x[i as usize], state.w[i as usize]) = (*x, *w);
        }
        for &i in &self.stopped {
            state.w[i as usize] = [0.0, 0.0, 0.0, state.w[i as usize][3]];
        }
        std::mem::swap(&mut self.u, &mut state.u);
    }
}

#[inline(always)]
fn kick(u: &Point, a: &Point, dt: f64) -> Point {
    [u[0] + dt * a[0], u[1] + dt * a[1], u[2] + dt * a[2], 0.0]
}

#[inline(always)]
fn drift(x: &Point, v: &Point, dt: f64) -> Point {
    [x[0] + dt * v[0], x[1] + dt * v[1], x[2] + dt * v[2], x[3]]
}

/// False also for what is not a number.
#[inline(always)]
fn is_inside(domain: &Bounds, x: &Point) -> bool {
    (0..3).fold(true, |inside, k| inside & (domain.min[k] <= x[k]) & (x[k] <= domain.max[k]))
}

#[inline(always)]
fn difference(a: &Point, b: &Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2], 0.0]
}

#[inline(always)]
fn squared(v: &Point) -> f64 {
    v[0] * v[0] + v[1] * v[1] + v[2] * v[2]
}

#[inline(always)]
pub(crate) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
