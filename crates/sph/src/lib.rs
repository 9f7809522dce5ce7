//! Weakly compressible SPH fluid between walls of particles, with adaptive restraint: water that has
//! come to rest costs next to nothing (Manteaux2013 §4).
//!
//! [`Fluid`] moves particles by Tait's pressure and artificial viscosity. [`FluidSettings`] say what the
//! fluid is, [`Walls`] where it cannot go, [`Emitter`] and [`Sink`] where it comes from and goes to. A
//! step is bounded by the time of sound through a particle ([`Fluid::step_bound`]); [`Fluid::advance`]
//! makes as many as a time takes.
//!
//! With a policy of restraint from the crate `arps`, particles move with the effective velocity that the
//! policy gives them, and only pairs in which something has changed are looked at. The
//! [`StepReport`] says how many these were. [`measure`] tells how far a run is from another, [`scenes`]
//! has scenes for that.
//!
//! Surfaces that move, such as cloth and bodies, are [`Sheets`]: [`Fluid::advance_among`] lets a fluid
//! flow among them and says what it does to them. No particle comes to the other side of one.
//!
//! ```
//! use arps::Speed;
//! use nalgebra::Vector3;
//! use sph::{Bounds, Fluid, FluidSettings, Open, RestraintSettings, Walls, scenes};
//!
//! // A block of water, 20 cm high, in the corner of a basin.
//! let spacing = 0.05;
//! let basin = Bounds::new(Vector3::zeros(), Vector3::new(0.4, 0.2, 0.4));
//! let mut walls = Walls::none();
//! walls.add_box(&basin, Open::TOP, spacing)?;
//! let settings = FluidSettings::water(spacing, 0.2, basin.grown(0.5));
//! let positions = scenes::block([4, 4, 4], Vector3::zeros(), spacing, 0);
//! let at_rest = vec![Vector3::zeros(); positions.len()];
//! let mut fluid = Fluid::new(settings, walls, &positions, &at_rest)?;
//!
//! // It breaks down and loses energy to viscosity.
//! let before = fluid.energy().total();
//! fluid.advance(0.3)?;
//! assert!(fluid.energy().total() < before);
//! assert!(fluid.particles().all(|p| basin.contains(&p.position)));
//!
//! // Under a policy it comes to rest, and steps look at almost nothing.
//! let settings = RestraintSettings {
//!     bleeding: Some(0.02),
//!     inactivity: 0.01,
//!     ..RestraintSettings::of(fluid.settings())
//! };
//! let mut fluid = fluid.restrained(Speed::new(0.1, 0.2)?, settings)?;
//! fluid.advance(4.0)?;
//! let report = fluid.advance(0.1)?;
//! assert!(report.moved * 20 < report.particles, "{report:?}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Architecture invariants
//! - A step happens completely or leaves the fluid as it was.
//! - Results have the same bits at any number of threads and on any processor: sums run in fixed order
//!   over four lanes, whatever the registers hold.
//! - A policy that restrains nothing gives the bits of no policy.
//! - What a fluid loses to moving surfaces they get: the sum of momenta changes by rounding only.
//! - A particle that moving surfaces leave any room stays on its side of them; if they do not, the
//!   [`StepReport`] says so.
//! - Forces between particles, walls included, are exactly opposite and, but for viscosity, the gradient
//!   of [`Fluid::energy`].
#![forbid(unsafe_code)]

mod by_pairs;
mod cells;
mod changes;
mod checkpoint;
mod fluid;
mod grid;
mod incremental;
mod kernel;
mod lanes;
mod listing;
mod lists;
pub mod measure;
mod mend;
mod motion;
mod neighbours;
mod pair;
mod place;
mod report;
mod restraint;
pub mod scenes;
mod settings;
mod sheets;
mod source;
mod state;
mod state_equation;
mod sweep;
mod view;
mod walls;

pub use checkpoint::Checkpoint;
pub use fluid::Fluid;
pub use kernel::CubicSpline;
pub use report::{Seconds, StepReport};
pub use restraint::RestraintSettings;
pub use settings::{Bounds, FluidError, FluidSettings};
pub use sheets::Sheets;
pub use source::{Emitter, Sink};
pub use state_equation::Tait;
pub use view::{Energy, Particle};
pub use walls::{Open, Walls};
