//! Collision geometry of deforming triangle meshes.
#![forbid(unsafe_code)]

mod aabb;
mod bvh;
pub mod ccd;
pub mod distance;
pub mod intersect;
mod morton;
mod surface;

pub use aabb::Aabb;
pub use bvh::Bvh;
pub use surface::{Surface, SurfaceError};
