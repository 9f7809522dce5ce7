//! Weakly compressible SPH fluid.
#![forbid(unsafe_code)]

mod checkpoint;
mod fluid;
mod grid;
mod incremental;
mod kernel;
mod lanes;
pub mod measure;
mod motion;
mod neighbours;
mod pair;
mod report;
mod restraint;
pub mod scenes;
mod settings;
mod source;
mod state;
mod state_equation;
mod sweep;
mod view;
mod walls;

pub use checkpoint::Checkpoint;
pub use fluid::Fluid;
pub use kernel::CubicSpline;
pub use report::StepReport;
pub use restraint::RestraintSettings;
pub use settings::{Bounds, FluidError, FluidSettings};
pub use source::{Emitter, Sink};
pub use state_equation::Tait;
pub use view::{Energy, Particle};
pub use walls::{Open, Walls};
