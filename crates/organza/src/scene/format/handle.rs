//! What holds or moves vertices of a cloth.

use std::fmt;

use schemars::JsonSchema;
use serde::de::{Deserializer, Error, Visitor};
use serde::{Deserialize, Serialize};

use crate::scene::motion::Motion;

/// Holds vertices of a cloth where they are, or moves them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HandleFile {
    /// The cloth, by name or by number counted from 0.
    #[serde(default)]
    pub cloth: ClothRef,
    /// The vertices held, chosen on the mesh at the start.
    pub select: Select,
    /// How the vertices move; absent means they stay where they were at `start_s`.
    #[serde(default)]
    pub motion: Option<Motion>,
    /// When the handle takes hold (s).
    #[serde(default)]
    pub start_s: f64,
    /// When it lets go (s); absent means never.
    #[serde(default)]
    pub end_s: Option<f64>,
    /// How long its springs take to fade away after `end_s` (s): a time t later they have
    /// (1 − t / `fade_s`)⁴ of their stiffness.
    #[serde(default)]
    pub fade_s: f64,
    /// Holds by springs of this stiffness (N/m); absent means exactly.
    #[serde(default)]
    pub stiffness_n_per_m: Option<f64>,
}

/// A cloth, by name or by number counted from 0.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum ClothRef {
    /// By number.
    Index(u32),
    /// By name.
    Name(String),
}

impl Default for ClothRef {
    fn default() -> Self {
        Self::Index(0)
    }
}

impl<'de> Deserialize<'de> for ClothRef {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameOrIndex;
        impl Visitor<'_> for NameOrIndex {
            type Value = ClothRef;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name or the number of a cloth")
            }

            fn visit_u64<E: Error>(self, index: u64) -> Result<ClothRef, E> {
                let too_large = |_| E::custom(format!("there is no cloth {index}"));
                u32::try_from(index).map(ClothRef::Index).map_err(too_large)
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<ClothRef, E> {
                Ok(ClothRef::Name(name.to_owned()))
            }
        }
        deserializer.deserialize_any(NameOrIndex)
    }
}

/// Which vertices of a cloth. Sides and corners are those of the flat pattern (u to the right, v
/// upward).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Select {
    /// Vertices by number, counted from 0 in the order of the mesh file.
    Vertices(Vec<u32>),
    /// The vertices nearest to corners of the rectangle around the pattern.
    Corners(Vec<Corner>),
    /// All vertices on sides of the pattern: of a grid, the upper and lower openings of a tube, waist
    /// and hem of a skirt, the hem of a tunic; of a mesh from a file those that touch the rectangle
    /// around the pattern.
    Sides(Vec<Side>),
    /// All vertices on borders of a generated mesh. A grid has `left`, `right`, `lower`, `upper`; a
    /// disc `rim`; a tube `lower`, `upper`; a skirt `hem`, `waist`; a tunic `hem`, `neck`, and with
    /// sleeves `left-cuff`, `right-cuff`, without them `left-armhole`, `right-armhole` (right is x > 0
    /// before the transform); a poncho `neck`, `outline`.
    Borders(Vec<String>),
    /// All vertices of panels, outlines included. The panels of a mesh file are its groups (`g`) and
    /// objects (`o`) by name; those of a tunic `front`, `back`, `right-sleeve`, `left-sleeve`; of a
    /// poncho `front`, `back`; of other meshes `0`, `1` and so on.
    Panels(Vec<String>),
    /// All vertices inside a rectangle of the pattern, its border included.
    Box(PatternBox),
    /// All vertices on the border of the cloth.
    Boundary,
    /// All vertices.
    All,
}

/// A corner of the rectangle around the flat pattern.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Corner {
    /// Smallest u, smallest v.
    LowerLeft,
    /// Largest u, smallest v.
    LowerRight,
    /// Largest u, largest v.
    UpperRight,
    /// Smallest u, largest v.
    UpperLeft,
}

/// A side of the flat pattern.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// Smallest u.
    Left,
    /// Largest u.
    Right,
    /// Smallest v.
    Lower,
    /// Largest v.
    Upper,
}

/// A rectangle of the flat pattern.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PatternBox {
    /// Smallest u and v (m).
    pub min: [f64; 2],
    /// Largest u and v (m).
    pub max: [f64; 2],
}
