//! A mannequin and its clothes, made by formulas: bodies for cloth where no character is at hand.
//!
//! - [`Mannequin`]: a body of 1.7 m whose skin is one closed smooth mesh with edges as long as wanted.
//!   It stands with level arms, then eases into a [`Motion`] that goes on for ever.
//! - [`Garment`]: clothes that fit it, sewn from panels with flat patterns; they start clear of the
//!   body and of each other.
//!
//! The z axis is up, the floor is at z = 0, and the body looks along −y. Its skin is the surface of
//! capsules blended by a smooth minimum ([`body::distance`]), moved by linear blend skinning.
#![forbid(unsafe_code)]

pub mod body;
mod error;
mod figure;
mod garment;
mod motion;
mod skeleton;
mod skin;

pub use error::MannequinError;
pub use figure::Mannequin;
pub use garment::Garment;
pub use motion::{Action, Motion, WALK_RADIUS};
