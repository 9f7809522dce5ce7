//! View-dependent sizing of cloth (Koh2014): fine where it shows, coarse where it does not.
//!
//! A [`CameraPath`] of shots and cuts says what is seen when; [`window`](window()) lists the cameras
//! of the next frames; [`ViewFactors`] are worked out from them once per remeshing; [`ViewSizing`]
//! puts them around any other sizing field. Cloth outside of the picture is coarsened with its
//! distance from it, cloth that faces away by a factor, and visible cloth is meshed no finer than a few
//! pixels. Before cloth comes into the picture it is refined, so that nothing pops, also on cuts.
//!
//! The policy is one field among others. Here it is, and then another one in its place: resolution
//! by an importance that somebody painted on the flat pattern.
//!
//! ```
//! use mesh_core::{ClothState, TriangleId, World3, generate};
//! use remesh::{Metric, PhysicalSizing, RemeshSettings, SizingContext, SizingField, remesh};
//! use sizing_view::{Camera, CameraPath, ViewFactors, ViewSettings, ViewSizing, window};
//!
//! /// Another field, coarser where a map of the panel says that it matters less.
//! struct Painted<S> {
//!     field: S,
//!     /// Importance from 0 to 1, row by row over a square of 1 m.
//!     map: [[f64; 4]; 4],
//! }
//!
//! impl<S: SizingField> SizingField for Painted<S> {
//!     fn metric(&self, context: &SizingContext<'_>, at: TriangleId) -> Metric {
//!         let cell = context.centroid(at).map(|u| ((u * 4.0) as usize).min(3));
//!         let importance = self.map[cell.y][cell.x];
//!         // Edges may be longer by one over the importance.
//!         self.field.metric(context, at) * importance.powi(2)
//!     }
//! }
//!
//! let sheet = generate::grid([1.0, 1.0], [10, 10], generate::Diagonal::Alternating)?;
//! let mut cloth = ClothState::at_rest(sheet.mesh, sheet.positions, vec![0.2])?;
//! let mut painted = cloth.clone();
//! let physics = PhysicalSizing { size_max: 0.04, ..PhysicalSizing::default() };
//!
//! // A camera above one corner, looking down; at t = 0, with frames of 1/25 s.
//! let (corner, above) = (World3::new(0.0, 0.0, 0.0), World3::new(0.0, 0.0, 0.3));
//! let camera = Camera::looking_at(above, corner, World3::y(), 0.5, [1280, 720])?;
//! let settings = ViewSettings::default();
//! let samples = window(&CameraPath::still(camera), 0.0, 0.04, &settings);
//! let factors = ViewFactors::evaluate(&cloth, &samples, &settings)?;
//! remesh(&mut cloth, &ViewSizing::new(physics, &factors), &RemeshSettings::default())?;
//!
//! let mut map = [[0.2; 4]; 4];
//! map[0][0] = 1.0;
//! remesh(&mut painted, &Painted { field: physics, map }, &RemeshSettings::default())?;
//!
//! let full = (1.0f64 / 0.04).powi(2) as usize;
//! assert!(cloth.mesh.n_vertices() < full / 2 && painted.mesh.n_vertices() < full / 2);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # More than the paper
//! - Several cameras: give [`ViewFactors::evaluate`] the windows of all of them. The finest wins.
//! - What stands in the way: give the samples a [`DepthBuffer`]. Cloth that is hidden from all of
//!   them counts as not visible.
//! - No path at hand: [`CameraPath::predicted`] guesses the next frames from the last two cameras.
//! - No pops: [`shift_metrics`] keep the remesher from edits that move what shows by more than a pixel.
//! - Restraint by the same cameras: [`ViewRestraint`] lets particles of any kind rest that move by
//!   less than some pixels per frame, and sooner where nobody sees them.
//! - Far away cloth costs nothing: a panel that is far from every frustum is decided at once.
//!
//! # What always holds
//! - v(t) ≥ w(τ) ṽ(t + τ) at all samples; what is visible now has v = 1.
//! - Metrics are valid for all cameras that can be made: inside the cloth, along it, with a picture
//!   of one pixel.
//! - Results have the same bits at any number of threads.
#![forbid(unsafe_code)]

mod camera;
mod depth;
mod error;
mod factors;
mod frustum;
mod path;
mod restraint;
mod screen;
mod settings;
mod shift;
mod silhouette;
mod sizing;
mod window;

pub use camera::Camera;
pub use depth::DepthBuffer;
pub use error::ViewError;
pub use factors::ViewFactors;
pub use frustum::{Frustum, Place};
pub use path::{CameraPath, Key, Shot};
pub use restraint::{PixelThresholds, ViewRestraint, pixel_speeds};
pub use screen::bounded;
pub use settings::ViewSettings;
pub use shift::shift_metrics;
pub use sizing::ViewSizing;
pub use window::{Sample, window};
