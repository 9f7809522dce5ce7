//! Offline simulation of adaptive cloth: scene files, world, command line.

#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod arcsim;
pub mod build;
pub mod checkpoint;
pub mod fabric;
pub mod handles;
pub mod remeshing;
pub mod render;
pub mod report;
pub mod scene;
pub mod world;
