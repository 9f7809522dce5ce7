//! Implicit dynamics of cloth on an incremental potential.
#![forbid(unsafe_code)]

mod dihedral;
mod element;
mod fabric;
mod force;
mod hinge;
mod integrator;
pub mod law;
mod membrane;
mod newton;
mod point_forces;
mod rest;
mod shape_operator;
pub mod solver;
mod strain_limit;
mod system;
mod wind;

pub use element::{ElementModel, ElementSystem, Elements, Stiffness};
pub use fabric::{BendingModel, Damping, Fabric, StrainLimits};
pub use force::{Force, Stage};
pub use hinge::HingeModel;
pub use integrator::{ImplicitEuler, Sdirk2, Step, TimeIntegrator};
pub use membrane::MembraneModel;
pub use newton::{NewtonSettings, SolveError, SolveReport};
pub use point_forces::{Gravity, MassDamping, Springs};
pub use rest::RestTriangle;
pub use shape_operator::ShapeOperatorModel;
pub use strain_limit::{STRENGTH, StrainLimitModel, principal_stretches};
pub use system::{Constraints, Environment, System};
pub use wind::{Wind, WindModel};
