//! Adaptively restrained particles: what hardly moves rests, exactly (Manteaux2013, corrected).
#![forbid(unsafe_code)]

mod conjugate;
mod error;
mod held;
mod law;
mod restraint;

pub use conjugate::Conjugate;
pub use error::{NotConvex, ThresholdError};
pub use held::{Held, Motion};
pub use law::Law;
pub use restraint::{Kinetic, Particle, Restraint, Speed};

/// A position, velocity, momentum or force in world space.
pub type Vector3 = nalgebra::Vector3<f64>;
/// A 3 × 3 block.
pub type Matrix3 = nalgebra::Matrix3<f64>;
