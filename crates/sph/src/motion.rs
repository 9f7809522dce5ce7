//! Kick and drift: new velocities by the accelerations, new positions by the velocities.

use crate::grid::Point;
use crate::restraint::RestraintSettings;
use crate::settings::Bounds;
use crate::state::State;
use arps::{Motion, Particle, Restraint, Vector3};

/// The particles after a kick and a drift, and what was noticed on the way.
#[derive(Clone, Debug, Default)]
pub(crate) struct Moved {
    pub(crate) x: Vec<Point>,
    pub(crate) w: Vec<Point>,
    pub(crate) u: Vec<Point>,
    /// Particles whose position has changed.
    pub(crate) movers: Vec<u32>,
    /// Particles that have moved before and stand still now.
    pub(crate) stopped: Vec<u32>,
    /// Greatest speed of the momenta (m/s).
    pub(crate) fastest: f64,
    /// Square of the farthest way from where neighbours were listed (m²).
    pub(crate) farthest_squared: f64,
    /// True if a particle may be restrained at all.
    pub(crate) any_held: bool,
    /// A particle that has left the domain.
    pub(crate) outside: Option<usize>,
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
        for i in 0..state.len() {
            let u = kick(&state.u[i], &state.a[i], dt);
            let x = drift(&state.x[i], &u, dt);
            inside &= is_inside(domain, &x);
            fastest = larger(squared(&u), fastest);
            farthest = larger(squared(&difference(&x, &listed[i])), farthest);
            self.x.push(x);
            self.u.push(u);
            self.w.push([u[0], u[1], u[2], state.w[i][3]]);
        }
        self.finish(domain, fastest, farthest, inside);
    }

    /// The same under a policy. `mass` is that of a particle (kg), `time` the time at the end (s).
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
        let (mut fastest, mut farthest, mut inside) = (0.0, 0.0, true);
        // 1 − e^(−dt/τ): du/dt = a − u/τ is solved exactly, as `arps::bleeding_kick` does.
        let bleeding = settings.bleeding.map(|tau| (tau, -(-dt / tau).exp_m1()));
        let inactive_squared = settings.inactivity * settings.inactivity;
        for i in 0..state.len() {
            let (x, w, u, a) = (&state.x[i], &state.w[i], &state.u[i], &state.a[i]);
            let was_still = w[0] == 0.0 && w[1] == 0.0 && w[2] == 0.0;
            let position = Vector3::new(x[0], x[1], x[2]);
            let held = policy.at(&Particle { index: i, mass, x: position, time });
            self.any_held |= !held.is_free();
            let u = match bleeding {
                Some((tau, lost)) if was_still && !held.is_free() => {
                    let bled = |k: usize| u[k] + (tau * a[k] - u[k]) * lost;
                    [bled(0), bled(1), bled(2), 0.0]
                }
                _ => kick(u, a, dt),
            };
            let p = Vector3::new(u[0], u[1], u[2]) * mass;
            let v = match held.motion(&p) {
                Motion::Rest => [0.0; 4],
                Motion::Full => u,
                Motion::Transition => {
                    let v = held.velocity(&p);
                    [v.x, v.y, v.z, 0.0]
                }
            };
            let speed_squared = squared(&v);
            let moves = speed_squared > 0.0 && speed_squared >= inactive_squared;
            self.u.push(u);
            fastest = larger(squared(&u), fastest);
            if moves {
                let x = drift(x, &v, dt);
                inside &= is_inside(domain, &x);
                farthest = larger(squared(&difference(&x, &listed[i])), farthest);
                self.x.push(x);
                self.w.push([v[0], v[1], v[2], w[3]]);
                self.movers.push(i as u32);
            } else {
                if !was_still {
                    self.stopped.push(i as u32);
                }
                self.x.push(*x);
                self.w.push([0.0, 0.0, 0.0, w[3]]);
            }
        }
        self.finish(domain, fastest, farthest, inside);
    }

    fn finish(&mut self, domain: &Bounds, fastest: f64, farthest: f64, inside: bool) {
        (self.fastest, self.farthest_squared) = (fastest.sqrt(), farthest);
        if !inside {
            self.outside = self.x.iter().position(|x| !is_inside(domain, x));
        }
    }

    /// Gives the new particles to the state and takes the old ones.
    pub(crate) fn swap(&mut self, state: &mut State) {
        std::mem::swap(&mut self.x, &mut state.x);
        std::mem::swap(&mut self.w, &mut state.w);
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
