//! Offline simulation of adaptive cloth: scene files, world, command line.
//!
//! A scene is text; [`scene::load`] checks it, [`world::World::new`] builds what it describes, and
//! [`world::World::advance`] makes one frame after another.
//!
//! ```
//! use organza::scene::{self, LoadOptions};
//! use organza::world::World;
//!
//! let text = r#"{
//!   frames: 10, frames_per_second: 25, substeps: 2,
//!   cloths: [{
//!     mesh: { grid: { size_m: [0.3, 0.2], cells: [3, 2] } },
//!     fabric: "woven-light",
//!     remeshing: { size_m: { min: 0.02, max: 0.1 }, refine_angle: 0.3 },
//!   }],
//!   handles: [{ select: { corners: ["lower-left"] } }],
//! }"#;
//! let loaded = scene::parse(text, "towel.json5", &LoadOptions::default(), &scene::from_sources(&[]))?;
//! let mut world = World::new(&loaded)?;
//! let report = world.advance()?;
//! assert_eq!((report.frame, report.substeps), (1, 2));
//! world.cloth.mesh.validate()?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod arcsim;
pub mod build;
pub mod checkpoint;
pub mod export;
pub mod fabric;
pub mod handles;
pub mod info;
pub mod picture;
pub mod record;
pub mod remeshing;
pub mod render;
pub mod report;
pub mod scene;
pub mod world;
