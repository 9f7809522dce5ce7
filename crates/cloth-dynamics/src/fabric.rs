//! A fabric: all constants of one panel.

use crate::law::{Bending, Membrane};

/// Bounds on the principal stretches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrainLimits {
    /// Least principal stretch (1), below 1.
    pub min: f64,
    /// Largest principal stretch (1), above 1.
    pub max: f64,
}

/// Rayleigh damping. The part proportional to stiffness acts on strain rates (Kelvin–Voigt), so that
/// rigid motion is never damped by it.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Damping {
    /// Part proportional to mass (1/s).
    pub mass: f64,
    /// Part proportional to stiffness (s).
    pub stiffness: f64,
}

/// How bending is discretised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum BendingModel {
    /// Curvature tensor per triangle: orthotropic, nearly independent of the mesh.
    #[default]
    ShapeOperator,
    /// One angle per edge: cheaper, but its rigidity depends on the mesh's pattern.
    Hinge,
}

/// The constants of one panel's fabric.
#[derive(Clone, Debug)]
pub struct Fabric {
    /// Areal density (kg/m²).
    pub density: f64,
    /// Resistance to stretching.
    pub membrane: Membrane,
    /// Resistance to bending; `None` for none.
    pub bending: Option<Bending>,
    /// Discretisation of bending.
    pub bending_model: BendingModel,
    /// Bounds on the stretch, if any.
    pub strain_limits: Option<StrainLimits>,
    /// Lets go of compression beyond what buckles within a triangle, as by wrinkles that are finer than
    /// the mesh (Pipkin1986, Koh2014 §5); a lower bound on the stretch would get in the way. Without effect
    /// where the membrane has no stiffness at rest in some direction.
    pub tension_field: bool,
    /// Damping.
    pub damping: Damping,
}
