//! A piece of cloth: mesh, fabric, start, damping, remeshing.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ClothRestraintFile, MeshFile};
use crate::fabric::OrthotropicFabric;
use crate::scene::motion::Transform;

/// A piece of cloth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClothFile {
    /// Name, by which handles find the cloth; default is `cloth0`, `cloth1` and so on.
    #[serde(default)]
    pub name: Option<String>,
    /// Where the mesh comes from.
    pub mesh: MeshFile,
    /// Places the mesh in the scene. Its scale applies to the flat pattern as well, so it
    /// stretches nothing.
    #[serde(default)]
    pub transform: Transform,
    /// What the cloth is made of.
    pub fabric: FabricChoice,
    /// Fabrics of single panels, by the panel's name; the names are those that handles select.
    #[serde(default)]
    pub panel_fabrics: BTreeMap<String, FabricChoice>,
    /// Layers of fabric: multiplies density, stretching and bending stiffness (1).
    #[serde(default = "one")]
    pub thicken: f64,
    /// Multiplies single properties of the fabric.
    #[serde(default)]
    pub multipliers: Multipliers,
    /// Thickness in contact (m): two things keep the mean of theirs. Absent means that of `contact`.
    #[serde(default)]
    pub thickness_m: Option<f64>,
    /// Smallest and largest principal stretch, below and above 1, such as `[0.95, 1.05]`; absent
    /// means no limit (1).
    #[serde(default)]
    pub strain_limits: Option<[f64; 2]>,
    /// Whether triangles give way to compression at the load at which cloth of their size buckles, as if
    /// by wrinkles that the mesh is too coarse for (tension field). The smallest stretch of
    /// `strain_limits` then has no meaning.
    #[serde(default)]
    pub tension_field: bool,
    /// How bending is measured on the mesh.
    #[serde(default)]
    pub bending: BendingModel,
    /// Damping inside the cloth.
    #[serde(default)]
    pub damping: Damping,
    /// Velocity at the start (m/s).
    #[serde(default)]
    pub initial_velocity: [f64; 3],
    /// Rotation at the start, added to the velocity.
    #[serde(default)]
    pub initial_spin: Option<Spin>,
    /// How the mesh adapts; absent means it stays as it is.
    #[serde(default)]
    pub remeshing: Option<Remeshing>,
    /// Who of its vertices may rest; absent means as the scene says.
    #[serde(default)]
    pub restraint: Option<ClothRestraintFile>,
}

/// What a cloth is made of: the name of a fabric of the project, a file with measurements, or
/// numbers of your own.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FabricChoice {
    /// Light plain weave, 0.13 kg/m².
    WovenLight,
    /// Firm plain weave, 0.22 kg/m².
    WovenFirm,
    /// Cotton denim, 0.32 kg/m².
    Denim,
    /// Thin single knit, 0.11 kg/m².
    KnitLight,
    /// Interlock knit, 0.19 kg/m².
    KnitInterlock,
    /// Heavy double knit, 0.28 kg/m².
    KnitHeavy,
    /// Elastic swimwear knit, 0.20 kg/m².
    Swim,
    /// A JSON file with measurements in the format of Wang et al. 2011, relative to the scene file.
    Measured(String),
    /// Numbers of your own.
    Custom(OrthotropicFabric),
}

/// Multiplies single properties of the fabric.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Multipliers {
    /// Multiplies the density (1).
    pub density: f64,
    /// Multiplies the stretching stiffness (1).
    pub stretching: f64,
    /// Multiplies the bending stiffness (1).
    pub bending: f64,
}

impl Default for Multipliers {
    fn default() -> Self {
        Self { density: 1.0, stretching: 1.0, bending: 1.0 }
    }
}

/// How bending is measured on the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BendingModel {
    /// The curvature of each triangle with its neighbours; nearly independent of the mesh pattern.
    #[default]
    Patch,
    /// The angle at each edge; cheaper, its stiffness depends on the mesh pattern.
    Hinge,
}

/// Damping inside the cloth (Rayleigh).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Damping {
    /// Slows all motion: force −c m v, where this is c (1/s).
    pub mass_per_s: f64,
    /// Slows deformation: force −t K v with the stiffness K, where this is t, the Kelvin–Voigt
    /// time (s).
    pub stiffness_s: f64,
}

/// A rigid rotation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spin {
    /// Angular velocity, along the axis of rotation (rad/s).
    pub angular_velocity: [f64; 3],
    /// A point of the axis (m).
    #[serde(default)]
    pub center: [f64; 3],
}

/// How the mesh adapts (Narain2012). The four `refine_` keys are the change across an edge at
/// which it is worth splitting; one that is absent never asks for smaller triangles.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Remeshing {
    /// Shortest and longest edges (m).
    pub size_m: SizeRange,
    /// Turn of the normal (rad).
    #[serde(default)]
    pub refine_angle: Option<f64>,
    /// What a compressed edge may hide: 2.3 times the bulge it would show if it buckled (m).
    #[serde(default)]
    pub refine_compression: Option<f64>,
    /// Turn of the normal of obstacles near the cloth (rad).
    #[serde(default)]
    pub refine_obstacle: Option<f64>,
    /// Difference of velocity (m/s).
    #[serde(default)]
    pub refine_velocity: Option<f64>,
    /// Smallest aspect ratio of triangles, from 0.001 to 0.5; an equilateral one has 1, a needle 0 (1).
    #[serde(default = "default_aspect_min")]
    pub aspect_min: f64,
    /// A collapse must leave all its edges this much shorter than allowed, as a fraction, so that
    /// they are not split again at once (1).
    #[serde(default = "default_hysteresis")]
    pub hysteresis: f64,
    /// The mesh grows no further than this.
    #[serde(default = "default_max_vertices")]
    #[schemars(range(min = 3))]
    pub max_vertices: u32,
}

/// Shortest and longest edges.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SizeRange {
    /// Shortest edge (m).
    pub min: f64,
    /// Longest edge (m).
    pub max: f64,
}

pub(crate) fn one() -> f64 {
    1.0
}

pub(crate) fn default_aspect_min() -> f64 {
    0.2
}

pub(crate) fn default_hysteresis() -> f64 {
    0.2
}

pub(crate) fn default_max_vertices() -> u32 {
    1_000_000
}
