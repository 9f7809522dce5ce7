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
//!
//! # A sizing field of your own
//!
//! [`world::World::set_sizing`] exchanges the field that says how long edges may be, or builds upon
//! the one of the scene. This one also wants fine cloth near a hand, in the first garment alone:
//!
//! ```
//! use mesh_core::{TriangleId, World3};
//! use remesh::{MaxOf, Metric, SizingContext, SizingField};
//!
//! struct NearHand {
//!     hand: World3,                   // m
//!     panels: std::ops::Range<u32>,
//! }
//!
//! impl SizingField for NearHand {
//!     fn metric(&self, context: &SizingContext<'_>, at: TriangleId) -> Metric {
//!         if !self.panels.contains(&context.cloth.mesh.panels()[at.index()]) {
//!             return Metric::ZERO; // no wish
//!         }
//!         let [a, b, c] = context.cloth.corners(at);
//!         let distance = ((a + b + c) / 3.0 - self.hand).norm();
//!         Metric::uniform(0.01 + 0.3 * distance)
//!     }
//! }
//!
//! # use organza::{scene::{self, LoadOptions}, world::World};
//! # let text = r#"{
//! #   frames: 10,
//! #   cloths: [{
//! #     mesh: { grid: { size_m: [0.3, 0.2], cells: [3, 2] } },
//! #     fabric: "woven-light",
//! #     remeshing: { size_m: { min: 0.02, max: 0.1 } },
//! #   }],
//! # }"#;
//! # let loaded = scene::parse(text, "towel.json5", &LoadOptions::default(), &scene::from_sources(&[]))?;
//! let mut world = World::new(&loaded)?;
//! let near = NearHand { hand: World3::zeros(), panels: world.garments[0].panels.clone() };
//! world.set_sizing(|scene| MaxOf(near, scene))?;
//! let report = world.advance()?;
//! assert!(report.faces > 50);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! To record such a run, give [`record::Run::start_with`] the function that builds the world.

#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod arcsim;
pub mod build;
pub mod character;
pub mod checkpoint;
pub mod contact;
pub mod export;
mod eyes;
pub mod fabric;
pub mod fluid;
pub mod handles;
pub mod info;
pub mod obstacle;
mod obstacle_sizing;
pub mod picture;
pub mod record;
pub mod remeshing;
pub mod render;
pub mod report;
pub mod scene;
pub mod world;

/// The README's examples are tests, too.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
