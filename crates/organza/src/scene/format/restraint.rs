//! Who may rest.

use super::default;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Lets cloth rest that hardly moves, so that it costs nothing until it has to move again (adaptively
/// restrained dynamics, Manteaux2013). A vertex gathers momentum while it rests, and wakes when that
/// has grown.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RestraintFile {
    /// From which thresholds on.
    pub thresholds: Thresholds,
    /// How a vertex passes from rest to full dynamics.
    #[serde(default)]
    pub law: Law,
    /// Time in which momentum bleeds away that is held back (s). With it, cloth moves freely or stands, and
    /// rest withstands a force like static friction: what would give a vertex eight times its speed of rest
    /// in this time. Without it (null) momentum is conserved, and slow cloth creeps on for long.
    #[serde(default = "default::bleeding_s")]
    pub bleeding_s: Option<f64>,
}

/// The same for one cloth, instead of what the scene says.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClothRestraintFile {
    /// From which thresholds on.
    pub thresholds: Thresholds,
    /// How a vertex passes from rest to full dynamics.
    #[serde(default)]
    pub law: Law,
}

/// From which thresholds on cloth rests.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Thresholds {
    /// Nothing rests.
    None,
    /// By speed: rest up to the first, full dynamics from the second on.
    Speed {
        /// Speed up to which a vertex rests (m/s).
        rest_m_per_s: f64,
        /// Speed from which on it has full dynamics (m/s).
        full_m_per_s: f64,
    },
    /// By kinetic energy, as in the paper. It depends on the mesh: a finer one has lighter vertices.
    Kinetic {
        /// Kinetic energy up to which a vertex rests (J).
        rest_j: f64,
        /// Kinetic energy from which on it has full dynamics (J).
        full_j: f64,
    },
    /// By what the cameras see: that of the scene and those of `view`, whose margin, window, occlusion and
    /// factors count here, too; without `view`, its defaults do. Cloth that is out of the picture, or hidden,
    /// rests sooner, and is awake before it comes into it.
    View {
        /// Motion in the picture up to which a vertex rests (pixels per frame).
        rest_px_per_frame: f64,
        /// Motion in the picture from which on it has full dynamics (pixels per frame).
        full_px_per_frame: f64,
        /// Speed up to which a vertex rests at most, however far it is from the picture (m/s).
        #[serde(default = "default::most_m_per_s")]
        most_m_per_s: f64,
    },
    /// As `view`, chosen so that restraint moves vertices that show by no more than this over the whole
    /// scene.
    AutomaticView {
        /// The distance in the picture (pixels).
        error_px: f64,
    },
    /// Chosen so that restraint moves vertices by no more than this over the whole scene.
    Automatic {
        /// The distance (m).
        error_m: f64,
    },
}

/// How a vertex passes from rest to full dynamics.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Law {
    /// The effective velocity rises in a straight line between the thresholds.
    #[default]
    Ramp,
    /// What moves lags by the threshold of rest for ever; the other one is not used.
    Soft,
    /// As `ramp`, with smooth ends.
    Smooth,
}
