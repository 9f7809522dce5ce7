//! Cameras over time, and what they mean for mesh sizes.

use super::{AnimationRef, Camera, default};
use crate::scene::motion::Transform;
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
    /// nothing moves. A shot has these or `gltf`.
    #[serde(default)]
    pub keyframes: Vec<CameraKeyframe>,
    /// A camera from a glTF 2.0 file instead.
    #[serde(default)]
    pub gltf: Option<CameraGltf>,
}

/// A perspective camera of a glTF 2.0 file, moved by its nodes and one animation; followed at the times
/// of the scene's frames. The resolution is that of `camera`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CameraGltf {
    /// The file, relative to the scene file.
    pub file: String,
    /// Name of the camera or of its node; absent means the first that a node has.
    #[serde(default)]
    pub camera: Option<String>,
    /// The animation, by name or by number counted from 0; absent means the first, or none where
    /// the file has none.
    #[serde(default)]
    pub animation: Option<AnimationRef>,
    /// When the animation begins (s).
    #[serde(default)]
    pub start_s: f64,
    /// Places the file in the scene. Its y axis is up, so that most scenes give
    /// `rotate: { axis: [1, 0, 0], degrees: 90 }`.
    #[serde(default)]
    pub transform: Transform,
}

/// Another camera that counts for mesh sizes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ViewCameraFile {
    /// Its resolution, and its place without `shots`.
    pub camera: Camera,
    /// How it moves, shot after shot.
    #[serde(default)]
    pub shots: Vec<ShotFile>,
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
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
    /// No single flip or collapse of an edge moves what shows by more than this; 0 for any distance
    /// (pixels).
    pub shift_max_px: f64,
    /// Nothing is coarsened beyond this length of edges, nor beyond half the mean width of its panel (m).
    pub size_max_m: f64,
    /// Whether cloth behind obstacles and other cloth is coarsened, too: that which nothing of the
    /// window's cameras sees.
    pub occlusion: bool,
    /// Edges of cloth that is hidden may be longer by one over this (1); counts with `occlusion`.
    pub v_hidden: f64,
    /// Whether only the past of the camera is used: what it will see is guessed from how it moved over the
    /// last frame, as where somebody steers it. Cuts are not foreseen.
    pub predicted: bool,
    /// More cameras that see the cloth, for stereo or shadows; what any of them sees is fine.
    pub cameras: Vec<ViewCameraFile>,
}

impl Default for ViewFile {
    fn default() -> Self {
        default::view()
    }
}
