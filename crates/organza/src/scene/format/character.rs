//! Characters that the program makes itself, what they wear, and crowds of them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ClothFile, default};

/// A mannequin of 1.7 m that stands on the plane z = 0 and looks along −y, its arms level. It eases
/// into its motion, which goes on for ever.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CharacterFile {
    /// What it does.
    pub motion: Action,
    /// Where in the cycle of its motion it begins, as a part of the cycle (1).
    pub phase: f64,
    /// Chooses small differences in speed and width of the motion; 0 for none.
    pub seed: u32,
    /// About how long the edges of its skin are (m).
    pub cell_m: f64,
    /// When it begins to move (s).
    pub start_s: f64,
    /// How long it takes until it moves in full (s).
    pub ease_s: f64,
}

impl Default for CharacterFile {
    fn default() -> Self {
        Self {
            motion: Action::Stand,
            phase: 0.0,
            seed: 0,
            cell_m: 0.035,
            start_s: 0.2,
            ease_s: 1.5,
        }
    }
}

/// What a character does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Action {
    /// Stands with level arms.
    Stand,
    /// Walks on a circle of 1.5 m around a point at its left.
    Walk,
    /// Spins on the spot.
    Turn,
    /// Kicks to the front with one leg and then the other.
    Kick,
    /// Sways, steps, turns to and fro.
    Dance,
}

/// A garment that fits a character.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GarmentFile {
    /// Which garment.
    pub kind: GarmentKind,
    /// Name of the obstacle that wears it, whose mesh must be a `character`. Left out in a `crowd`
    /// alone.
    #[serde(default)]
    pub on: Option<String>,
    /// About how long the edges of the mesh are (m).
    #[serde(default = "default::garment_cell_m")]
    pub cell_m: f64,
}

/// Which garment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GarmentKind {
    /// A dress without sleeves.
    Dress,
    /// A skirt that rests on the hips.
    Skirt,
    /// Wide trousers that rest on the hips.
    Trousers,
    /// A jacket with sleeves, open in front.
    Jacket,
    /// An elastic belt around the jacket.
    Belt,
}

/// Characters in rows, each with its own phase and seed, named `crowd0`, `crowd1` and so on as their
/// cloths are.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CrowdFile {
    /// How many.
    #[schemars(range(min = 1))]
    pub count: u32,
    /// Distance from one to the next along x and y, around the origin (m).
    #[serde(default = "default::crowd_spacing_m")]
    pub spacing_m: [f64; 2],
    /// How many stand side by side along x; absent for about as many as behind each other.
    #[serde(default)]
    pub columns: Option<u32>,
    /// What they are like; phase and seed are those of the first.
    #[serde(default)]
    pub character: CharacterFile,
    /// What they do, in turn; empty for what `character` does.
    #[serde(default)]
    pub motions: Vec<Action>,
    /// What they wear, in turn: cloths with garments.
    #[schemars(length(min = 1))]
    pub cloths: Vec<ClothFile>,
    /// Coefficient of friction between them and cloth (1).
    #[serde(default = "default::friction")]
    pub friction: f64,
}
