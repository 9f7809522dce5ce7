//! Anisotropic adaptive remeshing of cloth, driven by a sizing field (Narain2012).
//!
//! A [`SizingField`] says for every triangle how finely the cloth should be meshed there, as a
//! [`Metric`] on material space. [`remesh`] averages these to the vertices, splits every edge that
//! is too long, collapses what can go, and flips edges towards an anisotropic Delaunay mesh. It
//! reports every edit as a value, so that fields on the mesh follow by replaying the journal.
//!
//! [`PhysicalSizing`] is the field of the paper: curvature, velocity gradient, compression and
//! obstacles. [`Uniform`], [`MaxOf`] and [`PerPanel`] are building blocks. A field of your own is a
//! type with one pure method. This one asks for fine cloth near a point in space, say a hand that
//! is about to touch it, on top of the physics:
//!
//! ```
//! use mesh_core::{ClothState, TriangleId, VertexField, World3, generate};
//! use remesh::{MaxOf, Metric, PhysicalSizing, RemeshSettings, SizingContext, SizingField, remesh};
//!
//! /// Edges of `finest` at the point, growing with the distance from it.
//! struct NearPoint {
//!     point: World3,
//!     finest: f64,
//!     growth: f64,
//! }
//!
//! impl SizingField for NearPoint {
//!     fn metric(&self, context: &SizingContext<'_>, at: TriangleId) -> Metric {
//!         let [a, b, c] = context.cloth.corners(at);
//!         let distance = ((a + b + c) / 3.0 - self.point).norm();
//!         Metric::uniform(self.finest + self.growth * distance)
//!     }
//! }
//!
//! let sheet = generate::grid([1.0, 1.0], [10, 10], generate::Diagonal::Alternating)?;
//! let mut cloth = ClothState::at_rest(sheet.mesh, sheet.positions, vec![0.2])?;
//! let mut dye = VertexField::new(&cloth.mesh, vec![1.0; cloth.mesh.n_vertices()]);
//!
//! let hand = NearPoint { point: World3::new(0.3, 0.3, 0.02), finest: 0.01, growth: 0.3 };
//! let field = MaxOf(PhysicalSizing::default(), hand);
//! let report = remesh(&mut cloth, &field, &RemeshSettings::default())?;
//! dye.follow(&report.journal);
//!
//! assert!(report.n_splits > 100 && report.quality.n_invalid == 0);
//! assert_eq!(dye.values().len(), cloth.mesh.n_vertices());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`remesh`] is [`CornerMetrics::evaluate`] followed by [`adapt`]; call the two apart to time them
//! or to look at the metrics.
//!
//! # What stays, and what settles
//! - Area, Euler characteristic, the lines of boundaries, seams and panels: exactly. Mass and linear
//!   momentum: to rounding.
//! - With [`RemeshSettings::stretch_limits`]: flips and collapses strain no triangle beyond its limits,
//!   unless one that they replace was strained as much. Curved cloth then stays as fine as its
//!   curvature needs, whatever the field allows.
//! - With [`RemeshSettings::shift`]: no flip and no collapse moves the surface farther than its limits.
//! - Nothing oscillates with the metrics at hand: a second [`adapt`] with the metrics that the first
//!   left makes no edit, and neither does a second [`remesh`] with a constant field. A field that
//!   varies is sampled anew on the new triangles: a smooth one settles within ten calls or so, one
//!   that jumps may keep turning a few edges in a thousand.
//! - The result depends on the state of the cloth alone: not on threads, and not on whether that
//!   state was saved and restored in between.
#![forbid(unsafe_code)]

mod collapse;
mod context;
mod corners;
mod driver;
mod field;
mod flip;
mod metric;
mod physical;
mod quality;
mod report;
mod settings;
mod shift;
mod split;
mod star;
mod strain;

pub use context::SizingContext;
pub use corners::CornerMetrics;
pub use driver::{adapt, remesh};
pub use field::{MaxOf, PerPanel, SizingField, Uniform};
pub use metric::Metric;
pub use physical::PhysicalSizing;
pub use quality::{MeshQuality, SIZE_BINS};
pub use report::RemeshReport;
pub use settings::{RemeshError, RemeshSettings};
