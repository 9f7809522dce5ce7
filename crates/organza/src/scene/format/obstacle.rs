//! Obstacles, and how things touch.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::default;
use crate::scene::motion::{Motion, Transform};

/// A body that cloth cannot pass. It moves as prescribed, whatever pushes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObstacleFile {
    /// Name; default is `obstacle0`, `obstacle1` and so on.
    #[serde(default)]
    pub name: Option<String>,
    /// Where the surface comes from.
    pub mesh: ObstacleMesh,
    /// Places the surface in the scene, or in the frame of its motion.
    #[serde(default)]
    pub transform: Transform,
    /// How it moves: with T(t) the transform of the motion at time t, a point that `transform` puts
    /// at x is at T(t) x. Absent means that it stays.
    #[serde(default)]
    pub motion: Option<Motion>,
    /// Coefficient of friction between it and cloth (1).
    #[serde(default = "default::friction")]
    pub friction: f64,
}

/// Where the surface of an obstacle comes from: exactly one of `obj`, `sphere`, `box`, `plane`,
/// `capsule`. Cloth is stopped on both sides of open surfaces.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ObstacleMesh {
    /// A Wavefront OBJ file, relative to the scene file; `v` and `f` alone count.
    pub obj: Option<String>,
    /// A sphere around the origin.
    pub sphere: Option<Sphere>,
    /// A box around the origin.
    #[serde(rename = "box")]
    pub cuboid: Option<Cuboid>,
    /// A flat rectangle around the origin.
    pub plane: Option<Plane>,
    /// A cylinder with round ends around the origin.
    pub capsule: Option<Capsule>,
}

/// A sphere around the origin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Radius (m).
    pub radius_m: f64,
    /// How often the triangles of an icosahedron are quartered: 20 · 4ⁿ triangles.
    #[serde(default = "default_detail")]
    pub detail: u32,
}

/// A box around the origin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cuboid {
    /// Lengths along x, y and z (m).
    pub size_m: [f64; 3],
}

/// A flat rectangle around the origin in the plane z = 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// Lengths along x and y (m).
    pub size_m: [f64; 2],
}

/// A cylinder around the z axis with half a sphere at each end, its middle at the origin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Capsule {
    /// Radius (m).
    pub radius_m: f64,
    /// Length of the cylinder between the half spheres (m).
    pub length_m: f64,
    /// Number of segments around, at least 4; each half sphere has a quarter as many rings.
    #[serde(default = "default_segments")]
    pub segments: u32,
}

/// How things touch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ContactFile {
    /// Distance that is kept between the middle surfaces of things that touch (m).
    pub thickness_m: f64,
    /// Coefficient of friction of cloth on cloth (1).
    pub friction: f64,
    /// Whether cloth touches cloth, itself included.
    pub self_contact: bool,
}

impl Default for ContactFile {
    fn default() -> Self {
        Self {
            thickness_m: default::contact_thickness_m(),
            friction: default::friction(),
            self_contact: default::self_contact(),
        }
    }
}

fn default_detail() -> u32 {
    4
}

fn default_segments() -> u32 {
    32
}
