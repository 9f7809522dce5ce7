//! Fabrics: the project's own presets, custom orthotropic numbers, and files with measurements.

mod measured;
mod presets;

pub use measured::MeasuredFabric;
pub(crate) use measured::read_measured;
pub use presets::preset;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A fabric with constant stiffness in warp and weft direction.
///
/// With the Green strain E of the flat pattern (1 is warp or u, 2 is weft or v), the stretching
/// energy per area is ½ (C₁₁ E₁₁² + 2 C₁₂ E₁₁ E₂₂ + C₂₂ E₂₂² + C₃₃ (2 E₁₂)²).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OrthotropicFabric {
    /// Mass per area (kg/m²).
    pub density_kg_per_m2: f64,
    /// Stretching stiffness (N/m).
    pub stretching_n_per_m: Stretching,
    /// Bending stiffness (N·m).
    pub bending_n_m: Bending,
}

/// Stretching stiffness of an orthotropic fabric. The energy must be positive for every strain:
/// warp · weft > coupling².
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stretching {
    /// C₁₁, along the warp (N/m).
    pub warp: f64,
    /// C₂₂, along the weft (N/m).
    pub weft: f64,
    /// C₁₂, between the two (N/m). For an isotropic sheet, Poisson's ratio times C₁₁.
    #[serde(default)]
    pub coupling: f64,
    /// C₃₃, in shear (N/m).
    pub shear: f64,
}

/// Bending stiffness of an orthotropic fabric, by the direction in which it is curved. Zero for all
/// three means cloth that does not resist bending.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bending {
    /// Curved along the warp (N·m).
    pub warp: f64,
    /// Curved along the weft (N·m).
    pub weft: f64,
    /// Curved along the bias, at 45° to both (N·m).
    pub bias: f64,
}

/// What a cloth of a scene is made of, with every number known.
#[derive(Debug, Clone, PartialEq)]
pub enum Fabric {
    /// Constant stiffness.
    Orthotropic(OrthotropicFabric),
    /// Stiffness that depends on strain and curvature, as measured.
    Measured(Box<MeasuredFabric>),
}

impl Fabric {
    /// Mass per area, before any multiplier (kg/m²).
    #[must_use]
    pub fn density_kg_per_m2(&self) -> f64 {
        match self {
            Self::Orthotropic(fabric) => fabric.density_kg_per_m2,
            Self::Measured(fabric) => fabric.density,
        }
    }

    /// The largest stretching stiffness, before any multiplier (N/m).
    #[must_use]
    pub fn max_stretching(&self) -> f64 {
        match self {
            Self::Orthotropic(fabric) => {
                let c = fabric.stretching_n_per_m;
                [c.warp, c.weft, c.coupling.abs(), c.shear].into_iter().fold(0.0, f64::max)
            }
            Self::Measured(fabric) => {
                fabric.stretching.iter().flatten().fold(0.0, |max, c| max.max(c.abs()))
            }
        }
    }

    /// The largest bending stiffness, before any multiplier (N·m).
    #[must_use]
    pub fn max_bending(&self) -> f64 {
        match self {
            Self::Orthotropic(fabric) => {
                let b = fabric.bending_n_m;
                b.warp.max(b.weft).max(b.bias)
            }
            Self::Measured(fabric) => {
                fabric.bending.iter().flatten().fold(0.0, |max, b| max.max(b.abs()))
            }
        }
    }
}
