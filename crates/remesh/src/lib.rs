//! Anisotropic adaptive remeshing of cloth, driven by a sizing field.
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
mod split;
mod star;

pub use context::SizingContext;
pub use corners::CornerMetrics;
pub use driver::{adapt, remesh};
pub use field::{MaxOf, PerPanel, SizingField, Uniform};
pub use metric::Metric;
pub use physical::PhysicalSizing;
pub use quality::{MeshQuality, SIZE_BINS};
pub use report::RemeshReport;
pub use settings::{RemeshError, RemeshSettings};
