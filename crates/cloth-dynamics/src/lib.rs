//! Implicit dynamics of cloth on an incremental potential.
//!
//! A step of length h is the minimum of Φ(x) = 1/(2h²) Σ mᵢ |xᵢ − x̃ᵢ|² + V(x): inertia against the
//! energies of the fabric and of what acts on it. Every energy has an exact gradient and a positive
//! semi-definite stiffness; Newton's method never ends above the Φ it started from, so a step cannot
//! blow up at any stiffness. The integrators differ only in which minima they ask for.
//!
//! ```
//! use cloth_dynamics::law::{Bending, Membrane, Quadratic};
//! use cloth_dynamics::solver::{Auto, LinearSettings};
//! use cloth_dynamics::*;
//! use mesh_core::{ClothState, World3, generate};
//! use std::sync::Arc;
//!
//! // A square metre of cotton that hangs by one corner.
//! let sheet = generate::grid([1.0, 1.0], [8, 8], generate::Diagonal::Alternating)?;
//! let mut cloth = ClothState::at_rest(sheet.mesh, sheet.positions, vec![0.15])?;
//! let cotton = Fabric {
//!     density: 0.15,
//!     membrane: Membrane::Orthotropic(Quadratic::isotropic(400.0, 0.2)?),
//!     bending: Some(Bending::Orthotropic(Quadratic::isotropic(1e-5, 0.0)?)),
//!     bending_model: BendingModel::ShapeOperator,
//!     tension_field: false,
//!     strain_limits: None,
//!     damping: Damping::default(),
//! };
//! let environment = Environment { gravity: World3::new(0.0, 0.0, -9.81), wind: None };
//! let mut system = System::new(&cloth, &Arc::new(vec![cotton]), &environment, 0.01)?;
//! let mut solver = Auto::new(LinearSettings::default());
//!
//! let corner = cloth.x[0];
//! let held = |_time: f64| Constraints { fixed: vec![(0, corner)], springs: vec![] };
//! for k in 0..25 {
//!     let step = Step { time: 0.01 * k as f64, h: 0.01 };
//!     let settings = NewtonSettings::default();
//!     let report =
//!         Sdirk2.advance(&mut cloth, &mut system, &mut solver, &held, &settings, step)?;
//!     assert_eq!(report.unconverged, 0);
//! }
//! let lowest = cloth.x.iter().map(|x| x.z).fold(0.0, f64::min);
//! assert!(lowest < -0.25, "a quarter of a second of falling: {lowest} m");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Architecture invariants
//! - What the fabrics and the environment do not need is not built: see [`System::new`].
//! - A step is a transaction: on error the cloth is as it was.
//! - A step that stops before its tolerance says so in its [`SolveReport`].
//! - No clock decides anything: results are the same bits in every run.
#![forbid(unsafe_code)]

mod bending;
pub mod contact;
mod dihedral;
mod element;
mod fabric;
mod force;
mod hinge;
mod integrator;
pub mod law;
mod membrane;
mod neighbours;
mod newton;
mod part;
mod plane_contact;
mod point_forces;
mod rest;
mod resting;
mod shape_operator;
mod solve_report;
pub mod solver;
mod strain_limit;
mod strain_projection;
mod system;
mod wind;

pub use element::{ElementModel, ElementSystem, Elements, Stiffness};
pub use fabric::{BendingModel, Damping, Fabric, StrainLimits};
pub use force::{Force, Stage};
pub use hinge::HingeModel;
pub use integrator::{ImplicitEuler, Sdirk2, Step, TimeIntegrator};
pub use membrane::MembraneModel;
pub use part::Part;
pub use plane_contact::PlaneContact;
pub use point_forces::{Gravity, MassDamping, Springs};
pub use rest::RestTriangle;
pub use resting::RestingPolicy;
pub use shape_operator::ShapeOperatorModel;
pub use solve_report::{NewtonSettings, RestReport, SolveError, SolveReport};
pub use strain_limit::{STRENGTH, StrainLimitModel, principal_stretches};
pub use system::{Constraints, Environment, System};
pub use wind::{Wind, WindModel};
