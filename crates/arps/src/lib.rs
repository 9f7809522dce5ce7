//! Adaptively restrained particles: what hardly moves rests, exactly (Manteaux2013, corrected).
#![forbid(unsafe_code)]

mod blocks;
mod conjugate;
mod convex;
mod error;
mod explicit;
mod held;
mod implicit;
mod law;
mod linear;
pub mod paper;
mod particles;
mod restraint;
mod wake;

pub use blocks::{Blocks, SparseBlocks};
pub use conjugate::Conjugate;
pub use convex::{ConvexProblem, ConvexReport, ConvexSolver};
pub use error::{NotConvex, StateError, StepError, ThresholdError};
pub use explicit::{Explicit, Moved, Now, Scheme, bleeding_kick};
pub use held::{Held, Motion};
pub use implicit::{Implicit, ImplicitReport};
pub use law::Law;
pub use linear::MoverSystem;
pub use particles::Particles;
pub use restraint::{Kinetic, Particle, Restraint, Speed};
pub use wake::{Rest, WakeQueue};

/// A position, velocity, momentum or force in world space.
pub type Vector3 = nalgebra::Vector3<f64>;
/// A 3 × 3 block.
pub type Matrix3 = nalgebra::Matrix3<f64>;
