//! What can be wrong with thresholds.

use crate::law::Law;

/// Why thresholds were refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ThresholdError {
    /// Not a number, or below zero.
    #[error("the {which} threshold is {value} {unit}; it must be a number from 0 to infinity")]
    Value {
        /// Which one: `rest` or `full`.
        which: &'static str,
        /// Its value (unit of the thresholds).
        value: f64,
        /// Unit of the thresholds.
        unit: &'static str,
    },
    /// Full dynamics would begin below rest.
    #[error(
        "the thresholds are inverted: rest up to {rest} {unit}, but full dynamics from {full} {unit}"
    )]
    Inverted {
        /// Rest up to here (unit of the thresholds).
        rest: f64,
        /// Full dynamics from here (unit of the thresholds).
        full: f64,
        /// Unit of the thresholds.
        unit: &'static str,
    },
    /// The law needs more room between the thresholds than there is.
    #[error(
        "`{law:?}` needs more room between rest up to {rest} {unit} and full dynamics from {full} \
         {unit}: the ratio of momenta must be above {ratio}"
    )]
    TooClose {
        /// The law.
        law: Law,
        /// Rest up to here (unit of the thresholds).
        rest: f64,
        /// Full dynamics from here (unit of the thresholds).
        full: f64,
        /// Unit of the thresholds.
        unit: &'static str,
        /// Bound of the ratio of the momenta (1).
        ratio: f64,
    },
    /// A law that would never let anything move.
    #[error("`{law:?}` needs a finite threshold for full dynamics: without one nothing ever moves")]
    NeverFull {
        /// The law.
        law: Law,
    },
    /// A duration that is not a positive finite number.
    #[error("the duration is {duration} s; it must be positive and finite")]
    Duration {
        /// The duration (s).
        duration: f64,
    },
    /// A mass that is not a positive finite number.
    #[error("the mass is {mass} kg; it must be positive and finite")]
    Mass {
        /// The mass (kg).
        mass: f64,
    },
}

/// A law whose kinetic energy is not convex has no conjugate, and no implicit step that is sure to
/// be stable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the kinetic energy of `{law:?}` is not convex: implicit steps with it can gain energy without \
     bound; take `Ramp`, or `paper::algorithm_1` to compare"
)]
pub struct NotConvex {
    /// The law.
    pub law: Law,
}

/// Why a state was refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StateError {
    /// Lists of different lengths.
    #[error("there are {x} positions, {v} velocities and {m} masses")]
    Lengths {
        /// Number of positions.
        x: usize,
        /// Number of velocities.
        v: usize,
        /// Number of masses.
        m: usize,
    },
    /// A mass that is not a positive finite number.
    #[error("the mass of particle {particle} is {mass} kg; it must be positive and finite")]
    Mass {
        /// Its index.
        particle: usize,
        /// Its mass (kg).
        mass: f64,
    },
    /// A pair of particles of which one is not there.
    #[error("the pair {pair:?} is not among {n} particles")]
    Pair {
        /// The pair.
        pair: [usize; 2],
        /// Number of particles.
        n: usize,
    },
    /// A position or velocity that is not finite.
    #[error("position or velocity of particle {particle} is not finite")]
    NotFinite {
        /// Its index.
        particle: usize,
    },
}

/// Why a step was not made; the state is as it was.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// A time that is not positive and finite.
    #[error("{what} is {value} s; it must be positive and finite")]
    Time {
        /// Which one.
        what: &'static str,
        /// Its value (s).
        value: f64,
    },
    /// A tolerance that is not a positive number.
    #[error("the tolerance is {value}; it must be positive")]
    Tolerance {
        /// Its value (1).
        value: f64,
    },
    /// A stiffness matrix for another number of particles.
    #[error("the stiffness matrix has {rows} rows of blocks for {particles} particles")]
    Pattern {
        /// Rows of blocks.
        rows: usize,
        /// Number of particles.
        particles: usize,
    },
    /// The step led to a position or momentum that is not finite: a force that is not, or a step too
    /// long for the stiffness.
    #[error("particle {particle} gets a position or momentum that is not finite")]
    NotFinite {
        /// Its index.
        particle: usize,
    },
    /// Implicit steps need a convex kinetic energy.
    #[error("particle {particle}: {cause}")]
    NotConvex {
        /// Its index.
        particle: usize,
        /// Which law, and what to do.
        cause: NotConvex,
    },
    /// [`Law::Exact`] in an implicit step.
    #[error(
        "particle {particle}: the conjugate of `Exact` has a second kink, which Newton's method does not \
         pass; take `Ramp`"
    )]
    SecondKink {
        /// Its index.
        particle: usize,
    },
    /// A linear system could not be solved.
    #[error("a linear system of {unknowns} particles is singular, or did not converge")]
    Singular {
        /// How many particles it has.
        unknowns: usize,
    },
}
