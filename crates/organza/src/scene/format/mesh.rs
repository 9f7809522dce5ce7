//! Where the mesh of a cloth comes from.

use super::GarmentFile;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Where the mesh of a cloth comes from: exactly one of `obj`, `grid`, `disc`, `tube`, `skirt`,
/// `tunic`, `poncho`, `garment`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MeshFile {
    /// A Wavefront OBJ file, relative to the scene file. Positions `v` are where the cloth starts;
    /// texture coordinates `vt` are its flat pattern (m); without `vt` the pattern is x and y.
    pub obj: Option<String>,
    /// A second OBJ file with the same faces, whose x and y are the flat pattern (m).
    pub material_obj: Option<String>,
    /// A flat rectangle.
    pub grid: Option<Grid>,
    /// A flat disc.
    pub disc: Option<Disc>,
    /// A sleeve, open at both ends.
    pub tube: Option<Tube>,
    /// A skirt sewn from flat panels.
    pub skirt: Option<Skirt>,
    /// A tunic with or without sleeves, sewn from a front and a back.
    pub tunic: Option<Tunic>,
    /// A poncho, sewn from a front and a back.
    pub poncho: Option<Poncho>,
    /// A garment that fits a character and starts on it; `transform` comes before the character's.
    pub garment: Option<GarmentFile>,
}

/// A flat rectangle: pattern (u, v) from (0, 0) to `size_m`, at (u, v, 0) in space.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Grid {
    /// Width along u and height along v (m).
    pub size_m: [f64; 2],
    /// Number of cells along u and v, each of two triangles.
    pub cells: [u32; 2],
    /// How cells are cut into triangles.
    #[serde(default)]
    pub diagonal: Diagonal,
}

/// How the cells of a grid are cut into triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Diagonal {
    /// Neighbouring cells are cut in opposite directions, so that neither is preferred.
    #[default]
    Alternating,
    /// All cells are cut in the same direction.
    One,
}

/// A flat disc around the origin in the plane z = 0; its pattern is x and y.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Radius (m).
    pub radius_m: f64,
    /// Number of rings; ring k has 6 k vertices.
    #[schemars(range(min = 1))]
    pub rings: u32,
}

/// A sleeve around the z axis from z = 0 upward, sewn along one line; its pattern has u around and
/// v along the axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tube {
    /// Radius (m).
    pub radius_m: f64,
    /// Length along the axis (m).
    pub length_m: f64,
    /// Number of segments around (at least 3) and along the axis.
    pub segments: [u32; 2],
}

/// A skirt around the z axis, waist at z = 0 and hem below, sewn from equal flat panels, each a
/// sector of a ring. Panels lie side by side in the pattern, v runs from the hem up to the waist.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Skirt {
    /// Number of panels.
    #[serde(default = "default_panels")]
    pub panels: u32,
    /// Circumference of the waist (m).
    pub waist_m: f64,
    /// Circumference of the hem (m).
    pub hem_m: f64,
    /// Length of the cloth from waist to hem (m).
    pub length_m: f64,
    /// Number of cells across and along each panel; at least 3 around in all.
    pub cells: [u32; 2],
}

/// A tunic that hangs flat: front at y < 0, back at y > 0, shoulders at z = 0, hem below, x = 0 in the
/// middle. The pieces lie side by side in the pattern: front, back, sleeves; v runs upward in front and
/// back, u along the arm in the sleeves.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tunic {
    /// Width from the shoulders down to the underarm (m).
    pub width_m: f64,
    /// Width at the hem; default is the width above (m).
    #[serde(default)]
    pub hem_width_m: Option<f64>,
    /// Length from the shoulders to the hem (m).
    pub length_m: f64,
    /// Depth of the armholes below the shoulders (m).
    pub armhole_m: f64,
    /// Width of the opening for the neck (m).
    pub neck_width_m: f64,
    /// Depth of the neckline in front and back (m).
    #[serde(default)]
    pub neck_depth_m: [f64; 2],
    /// Length of the sleeves; absent means open armholes (m).
    #[serde(default)]
    pub sleeve_m: Option<f64>,
    /// About how long the edges of the mesh are (m).
    pub cell_m: f64,
}

/// A poncho: two rectangles sewn at the shoulders beside a slit for the neck. It hangs flat as a tunic
/// does, and its pattern lies as that of a tunic.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Poncho {
    /// Width (m).
    pub width_m: f64,
    /// Length from the shoulders down (m).
    pub length_m: f64,
    /// Width of the opening for the neck (m).
    pub neck_width_m: f64,
    /// About how long the edges of the mesh are (m).
    pub cell_m: f64,
}

fn default_panels() -> u32 {
    4
}
