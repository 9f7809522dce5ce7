//! Policies: which particles may rest, and from which thresholds on.

use crate::Vector3;
use crate::error::ThresholdError;
use crate::held::{Held, check};
use crate::law::Law;

/// What a policy may look at: one particle at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Place in the arrays of whoever asks, for policies with data of their own per particle.
    pub index: usize,
    /// Mass, positive and finite (kg).
    pub mass: f64,
    /// Position (m).
    pub x: Vector3,
    /// Time (s).
    pub time: f64,
}

/// A policy of restraint: the kinetic energy that each particle shall have.
///
/// It is pure: the same particle, the same answer, on whatever thread and in whatever order. It is
/// asked once or twice per particle and step, so an answer should cost some nanoseconds. `()` is the policy
/// that restrains nothing.
///
/// The restrained energy is conserved for thresholds that depend on nothing but the mass. Where a
/// threshold changes with position or time (nearer to a camera, say), it is as if it were changed
/// from outside, once between two steps: momentum is still conserved, and the energy of the particle
/// jumps by the difference of T, at most p_r²/2m of the larger threshold for the default law.
pub trait Restraint: Send + Sync {
    /// The restrained kinetic energy of one particle.
    fn at(&self, particle: &Particle) -> Held;

    /// True if the answer depends on nothing that changes, neither on position nor on time: then whoever
    /// rests need not be asked about again.
    fn is_steady(&self) -> bool {
        false
    }
}

/// No restraint.
impl Restraint for () {
    #[inline]
    fn at(&self, particle: &Particle) -> Held {
        Held::free(particle.mass)
    }

    fn is_steady(&self) -> bool {
        true
    }
}

impl<R: Restraint + ?Sized> Restraint for &R {
    #[inline]
    fn at(&self, particle: &Particle) -> Held {
        (**self).at(particle)
    }

    fn is_steady(&self) -> bool {
        (**self).is_steady()
    }
}

impl<R: Restraint + ?Sized> Restraint for Box<R> {
    #[inline]
    fn at(&self, particle: &Particle) -> Held {
        (**self).at(particle)
    }

    fn is_steady(&self) -> bool {
        (**self).is_steady()
    }
}

/// Thresholds of speed: p_r = m v_r. They keep their meaning when remeshing changes masses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speed {
    law: Law,
    v_r: f64,
    v_f: f64,
}

impl Speed {
    /// Rest up to the speed `v_r` and full dynamics from `v_f` (m/s) on, by the default law.
    ///
    /// # Errors
    /// See [`Speed::with_law`].
    pub fn new(v_r: f64, v_f: f64) -> Result<Speed, ThresholdError> {
        Speed::with_law(Law::default(), v_r, v_f)
    }

    /// The same with a law of choice.
    ///
    /// # Errors
    /// Thresholds that [`Held::new`] refuses for this law.
    pub fn with_law(law: Law, v_r: f64, v_f: f64) -> Result<Speed, ThresholdError> {
        check(law, v_r, v_f, [v_r, v_f], "m/s")?;
        Ok(Speed { law, v_r, v_f })
    }

    /// The law.
    pub fn law(&self) -> Law {
        self.law
    }

    /// Speed up to which a particle rests (m/s).
    pub fn v_r(&self) -> f64 {
        self.v_r
    }

    /// Speed from which on it has full dynamics (m/s).
    pub fn v_f(&self) -> f64 {
        self.v_f
    }
}

impl Restraint for Speed {
    #[inline]
    fn at(&self, particle: &Particle) -> Held {
        let mass = particle.mass;
        Held::checked(self.law, mass, mass * self.v_r, mass * self.v_f)
    }

    fn is_steady(&self) -> bool {
        true
    }
}

/// Thresholds of kinetic energy, as in Manteaux2013 Eq. (3): p_r = √(2 m ε_r).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kinetic {
    law: Law,
    /// √(2 ε), so that a threshold is this times √m.
    root_r: f64,
    root_f: f64,
}

impl Kinetic {
    /// Rest up to the kinetic energy `energy_r` and full dynamics from `energy_f` (J) on, by the
    /// default law.
    ///
    /// # Errors
    /// See [`Kinetic::with_law`].
    pub fn new(energy_r: f64, energy_f: f64) -> Result<Kinetic, ThresholdError> {
        Kinetic::with_law(Law::default(), energy_r, energy_f)
    }

    /// The same with a law of choice; [`Law::Spline`] is the paper's.
    ///
    /// # Errors
    /// Thresholds that [`Held::new`] refuses for this law; `Exact` needs `energy_f` > 4 `energy_r`.
    pub fn with_law(law: Law, energy_r: f64, energy_f: f64) -> Result<Kinetic, ThresholdError> {
        let [root_r, root_f] = [energy_r, energy_f].map(|energy| (2.0 * energy).sqrt());
        check(law, root_r, root_f, [energy_r, energy_f], "J")?;
        Ok(Kinetic { law, root_r, root_f })
    }

    /// The law.
    pub fn law(&self) -> Law {
        self.law
    }
}

impl Restraint for Kinetic {
    #[inline]
    fn at(&self, particle: &Particle) -> Held {
        let root = particle.mass.sqrt();
        Held::checked(self.law, particle.mass, root * self.root_r, root * self.root_f)
    }

    fn is_steady(&self) -> bool {
        true
    }
}
