//! Collision geometry of deforming triangle meshes.
#![forbid(unsafe_code)]

mod aabb;
mod bvh;
pub mod ccd;
pub mod contour;
pub mod distance;
pub mod intersect;
mod morton;
pub mod pairs;
pub mod proximity;
mod surface;
pub mod swept;

pub use aabb::Aabb;
pub use bvh::Bvh;
pub use pairs::{Body, Pair, PairKind};
pub use surface::{Surface, SurfaceError};
