//! Collision geometry of deforming triangle meshes: geometry in, geometry out.
//!
//! A [`Surface`] is the connectivity of one or several meshes. A tree of boxes, [`Bvh`], finds what is
//! near; [`distance`] measures it, [`ccd`] follows it through a step, [`intersect`] tells what has
//! crossed, and [`contour`] along which lines. [`proximity`] and [`swept`] do this for whole surfaces.
//! What follows from contact, forces, impulses or shorter steps, is the caller's business.
//!
//! ```
//! use collision::{Body, Surface, proximity, swept};
//! use mesh_core::World3;
//!
//! // Two triangles as one surface: the upper one falls 2 m during the step, upon the lower one.
//! let surface = Surface::new(6, &[[0, 1, 2], [3, 4, 5]])?;
//! let x_t0: Vec<World3> = [
//!     [0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0],
//!     [0.5, 0.5, 1.0], [1.5, 0.5, 1.5], [0.5, 1.5, 1.5],
//! ].map(World3::from).into();
//! let x_t1: Vec<World3> = (0..).zip(&x_t0)
//!     .map(|(v, x)| if v < 3 { *x } else { x - World3::new(0.0, 0.0, 2.0) })
//!     .collect();
//!
//! // Room of 5 mm around everything: contact begins at a distance of 1 cm.
//! let radius = |_vertex: u32| 0.005;
//! let body = Body::moving(&surface, &x_t0, &x_t1, &radius);
//! let impacts = swept::impacts_within(body, &body.tree());
//!
//! // The lower corner comes first: after 0.99 m, or a little before.
//! let t = swept::free_until(&impacts);
//! assert!(t <= 0.99 / 2.0 && t > 0.99 / 2.0 - 1e-5);
//! let first = impacts.iter().find(|i| i.t == t).unwrap();
//! assert_eq!(first.pair.vertices(&surface, &surface), [3, 0, 1, 2]);
//!
//! // Up to there nothing is in contact; a bit later something is.
//! let at = |t: f64| -> Vec<World3> {
//!     x_t0.iter().zip(&x_t1).map(|(a, b)| a * (1.0 - t) + b * t).collect()
//! };
//! let n_contacts = |x: &[World3]| {
//!     let body = Body::still(&surface, x, &radius);
//!     proximity::within(body, &body.tree()).len()
//! };
//! assert_eq!(n_contacts(&at(t)), 0);
//! assert!(n_contacts(&at(t + 1e-4)) > 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Architecture invariants
//! - A continuous test never misses what touches in exact arithmetic. It may report a hit early, and
//!   may take a near miss for a hit; its work is bounded.
//! - Crossing or not is decided exactly, by predicates on the coordinates as they are.
//! - No length is compared with a constant, but for what covers underflow: nothing changes when
//!   everything is scaled by a power of two or moved where its coordinates stay exact.
//! - Elements without area or length are ordinary input.
//! - Every pair of features is found once, and lists are in ascending order: they depend neither on
//!   the number of threads nor on the history of a tree.
//! - Nothing here knows of masses, forces or time steps.
#![forbid(unsafe_code)]

mod aabb;
mod bvh;
pub mod ccd;
pub mod contour;
pub mod distance;
pub mod intersect;
mod morton;
mod near;
mod pairs;
pub mod proximity;
mod rings;
mod surface;
pub mod swept;

pub use aabb::Aabb;
pub use bvh::Bvh;
pub use pairs::{Body, Pair, PairKind};
pub use surface::{Surface, SurfaceError};
