//! Cameras over time, and what they mean for mesh sizes.

use super::default;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What the camera sees until the next shot. Before the first shot starts, its camera is there
/// already.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShotFile {
    /// Time of the cut to this shot (s).
    #[serde(default)]
    pub start_s: f64,
    /// Cameras at increasing times, at constant rates in between. Before the first and after the last
    /// nothing moves.
    #[schemars(length(min = 1))]
    pub keyframes: Vec<CameraKeyframe>,
}

/// The camera at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraKeyframe {
    /// Time (s).
    pub time_s: f64,
    /// Where the camera stands (m).
    pub position: [f64; 3],
    /// The point it looks at (m).
    pub target: [f64; 3],
    /// The direction that is up in the picture; default is that of `camera` (1).
    #[serde(default)]
    pub up: Option<[f64; 3]>,
    /// Opening angle from the lower to the upper edge; default is that of `camera` (degrees).
    #[serde(default)]
    pub vertical_fov_deg: Option<f64>,
}

/// Mesh sizes by what the camera sees (Koh2014): cloth outside of the picture is coarsened, and cloth
/// in it meshed no finer than the pixels need.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ViewFile {
    /// Edges of cloth that faces away may be longer by one over this (1). Right for clothes, whose
    /// inside does not show; give 1 for cloth with two visible sides.
    pub v_back: f64,
    /// Edges of cloth far outside of the picture may be longer by one over this (1).
    pub v_out: f64,
    /// Distance from the picture's edge over which cloth gets coarser (m).
    pub margin_m: f64,
    /// How long before cloth comes into the picture it starts to get finer, in frames (1).
    pub window_frames: f64,
    /// Edges are not made shorter than this in the picture; 0 for any length (pixels).
    pub size_min_px: f64,
    /// Nothing is coarsened beyond this length of edges (m).
    pub size_max_m: f64,
}

impl Default for ViewFile {
    fn default() -> Self {
        default::view()
    }
}
