//! Explicit symplectic steps for the adaptive equations of motion.

use crate::error::StepError;
use crate::held::{Held, Motion};
use crate::restraint::Restraint;
use crate::{Particles, Vector3};

/// An explicit symplectic scheme for dp/dt = f(x), dx/dt = ∂T/∂p.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Scheme {
    /// p ← p + h f(x), then x ← x + h q̇(p). First order: the energy oscillates by an amount of
    /// order h.
    SymplecticEuler,
    /// Half a drift, a kick, half a drift. Second order, for the same single evaluation of forces.
    #[default]
    StormerVerlet,
}

/// What forces are evaluated at.
#[derive(Clone, Copy, Debug)]
pub struct Now<'a> {
    /// Time (s).
    pub time: f64,
    /// Positions (m).
    pub x: &'a [Vector3],
    /// Effective velocities (m/s): zero for what rests. Damping uses these, Manteaux2013 §4.1;
    /// otherwise forces on resting particles would go on changing.
    pub v: &'a [Vector3],
}

/// What a step did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moved {
    /// How many particles rest at its end.
    pub n_rest: usize,
    /// How many are in transition.
    pub n_transition: usize,
    /// How many have full dynamics.
    pub n_full: usize,
    /// Momentum that bled away from resting particles (kg m/s).
    pub bled: Vector3,
}

/// Explicit steps with a policy of restraint.
///
/// The step must resolve the fastest motion: h ω < 2 for full dynamics, and less by the square root
/// of the law's greatest slope where particles pass through the transition (1.29 for [`Law::Ramp`]
/// at a ratio of energies of 20, but 5.8 for [`Law::Spline`]).
///
/// [`Law::Ramp`]: crate::Law::Ramp
/// [`Law::Spline`]: crate::Law::Spline
#[derive(Clone, Debug)]
pub struct Explicit<R> {
    restraint: R,
    scheme: Scheme,
    bleeding: Option<f64>,
    x: Vec<Vector3>,
    p: Vec<Vector3>,
    v: Vec<Vector3>,
    f: Vec<Vector3>,
}

impl<R: Restraint> Explicit<R> {
    /// Steps of a scheme under a policy; `()` restrains nothing.
    pub fn new(restraint: R, scheme: Scheme) -> Explicit<R> {
        let empty = Vec::new;
        Explicit {
            restraint,
            scheme,
            bleeding: None,
            x: empty(),
            p: empty(),
            v: empty(),
            f: empty(),
        }
    }

    /// The policy.
    pub fn restraint(&self) -> &R {
        &self.restraint
    }

    /// Lets the momentum of resting particles decay with a time constant τ (s).
    ///
    /// In scenes with friction, particles that have stopped keep a momentum near p_r, and the least
    /// disturbance makes them flicker. A particle that rests at the beginning of a step bleeds during
    /// it ([`bleeding_kick`]). That leaves the restrained energy as it is, since T is flat at rest, and
    /// acts as static friction: a force below p_r/τ never moves the particle, at whatever step. What is given up is the conservation of momentum; [`Moved::bled`] says how much.
    ///
    /// # Errors
    /// A τ that is not positive and finite.
    pub fn with_bleeding(mut self, tau: f64) -> Result<Explicit<R>, StepError> {
        check_time("the time constant of bleeding", tau)?;
        self.bleeding = Some(tau);
        Ok(self)
    }

    /// Makes a step of h (s). `force` adds the forces (N) on all particles to a slice of zeros; it is
    /// called once.
    ///
    /// # Errors
    /// A step that is not positive and finite, or leads to numbers that are not finite.
    pub fn step(
        &mut self,
        particles: &mut Particles,
        h: f64,
        mut force: impl FnMut(Now<'_>, &mut [Vector3]),
    ) -> Result<Moved, StepError> {
        check_time("the step", h)?;
        let n = particles.len();
        let before = match self.scheme {
            Scheme::SymplecticEuler => 0.0,
            Scheme::StormerVerlet => 0.5 * h,
        };
        for buffer in [&mut self.x, &mut self.p, &mut self.v, &mut self.f] {
            buffer.resize(n, Vector3::zeros());
        }
        self.f.fill(Vector3::zeros());
        for i in 0..n {
            let held = self.restraint.at(&particles.particle(i));
            self.v[i] = held.velocity(&particles.p[i]);
            self.x[i] = particles.x[i] + before * self.v[i];
        }
        force(Now { time: particles.time + before, x: &self.x, v: &self.v }, &mut self.f);
        let mut moved = Moved::default();
        for i in 0..n {
            let held = self.restraint.at(&particles.particle(i));
            let p = self.kick(&held, &particles.p[i], &self.f[i], h, &mut moved.bled);
            moved.count(held.motion(&p));
            self.x[i] += (h - before) * held.velocity(&p);
            self.p[i] = p;
            if !self.x[i].iter().chain(self.p[i].iter()).all(|c| c.is_finite()) {
                return Err(StepError::NotFinite { particle: i });
            }
        }
        std::mem::swap(&mut particles.x, &mut self.x);
        std::mem::swap(&mut particles.p, &mut self.p);
        particles.time += h;
        Ok(moved)
    }

    fn kick(&self, held: &Held, p: &Vector3, f: &Vector3, h: f64, bled: &mut Vector3) -> Vector3 {
        let kicked = p + h * f;
        match self.bleeding {
            Some(tau) if held.motion(p) == Motion::Rest => {
                let left = bleeding_kick(p, f, h, tau);
                *bled += kicked - left;
                left
            }
            _ => kicked,
        }
    }
}

/// The momentum (kg m/s) after a time h (s) of a particle that rests under a constant force f (N) and
/// bleeds with a time constant τ (s): the solution f τ + (p − f τ) e^(−h/τ) of dp/dt = f − p/τ.
pub fn bleeding_kick(p: &Vector3, f: &Vector3, h: f64, tau: f64) -> Vector3 {
    p + (tau * f - p) * -(-h / tau).exp_m1()
}

impl Moved {
    /// Counts one particle.
    pub(crate) fn count(&mut self, motion: Motion) {
        match motion {
            Motion::Rest => self.n_rest += 1,
            Motion::Transition => self.n_transition += 1,
            Motion::Full => self.n_full += 1,
        }
    }
}

pub(crate) fn check_time(what: &'static str, value: f64) -> Result<(), StepError> {
    if value > 0.0 && value < f64::INFINITY { Ok(()) } else { Err(StepError::Time { what, value }) }
}
