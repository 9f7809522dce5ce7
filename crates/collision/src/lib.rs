//! Collision geometry of deforming triangle meshes.
#![forbid(unsafe_code)]

mod aabb;
mod bvh;
pub mod ccd;
mod morton;

pub use aabb::Aabb;
pub use bvh::Bvh;
