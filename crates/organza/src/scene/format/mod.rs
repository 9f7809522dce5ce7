//! The scene format, key by key. These types are what a scene file may say; their comments are the
//! published JSON schema. [`Scene`](super::Scene) is what a valid file means.

mod character;
mod cloth;
mod fluid;
mod handle;
mod mesh;
mod obstacle;
mod restraint;
mod solver;
mod view;

pub use character::*;
pub use cloth::*;
pub use fluid::*;
pub use handle::*;
pub use mesh::*;
pub use obstacle::*;
pub use restraint::*;
pub use solver::*;
pub use view::*;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A scene of Organza. Lengths in metres, masses in kilograms, times in seconds; the text may be
/// JSON5 (comments, trailing commas, keys without quotes).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "Organza scene")]
pub struct SceneFile {
    /// Where this schema is, for editors.
    #[serde(rename = "$schema", default)]
    pub schema: Option<String>,
    /// Name of the scene; default is the name of the file.
    #[serde(default)]
    pub name: Option<String>,
    /// Number of frames to simulate after the first, which shows the start.
    #[schemars(range(min = 1))]
    pub frames: u32,
    /// Frame rate (1/s).
    #[serde(default = "default::frames_per_second")]
    pub frames_per_second: f64,
    /// Time steps per frame. Remeshing happens once a frame.
    #[serde(default = "default::substeps")]
    #[schemars(range(min = 1))]
    pub substeps: u32,
    /// Acceleration of gravity (m/s²). Its opposite is "up" in pictures.
    #[serde(default = "default::gravity")]
    pub gravity: [f64; 3],
    /// Moving air; absent means none.
    #[serde(default)]
    pub wind: Option<Wind>,
    /// How time steps are made.
    #[serde(default)]
    pub integrator: Integrator,
    /// The nonlinear solve of each time step.
    #[serde(default)]
    pub newton: Newton,
    /// The linear solver inside the nonlinear one.
    #[serde(default)]
    pub linear_solver: LinearSolver,
    /// Relative residual at which iterative linear solvers stop (1).
    #[serde(default = "default::linear_tolerance")]
    pub linear_tolerance: f64,
    /// The pieces of cloth; a scene has cloth or fluid.
    #[serde(default)]
    pub cloths: Vec<ClothFile>,
    /// What holds or moves vertices of the cloths.
    #[serde(default)]
    pub handles: Vec<HandleFile>,
    /// Bodies that cloth cannot pass.
    #[serde(default)]
    pub obstacles: Vec<ObstacleFile>,
    /// Characters in rows, with what they wear.
    #[serde(default)]
    pub crowd: Option<CrowdFile>,
    /// Fluids, at most one for now. Cloth and fluid pass through each other.
    #[serde(default)]
    pub fluids: Vec<FluidFile>,
    /// How things touch. Absent means that cloth does not touch cloth, and that obstacles, if there
    /// are any, are touched with the default numbers.
    #[serde(default)]
    pub contact: Option<ContactFile>,
    /// The view of pictures; absent means one that shows everything.
    #[serde(default)]
    pub camera: Option<Camera>,
    /// How the camera moves, shot after shot; absent means that it stands where `camera` says.
    #[serde(default)]
    pub shots: Vec<ShotFile>,
    /// Mesh sizes by what the camera sees; absent means that it does not matter what it sees.
    #[serde(default)]
    pub view: Option<ViewFile>,
    /// Lets cloth rest that hardly moves; absent means that all of it always moves.
    #[serde(default)]
    pub restraint: Option<RestraintFile>,
    /// What is recorded besides the frames.
    #[serde(default)]
    pub recording: Recording,
}

/// Air that pushes cloth. On an area A with normal n, moving at v relative to the air, acts the
/// force −(density |vₙ| vₙ n + drag vₜ) A, where vₙ = v·n and vₜ = v − vₙ n.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wind {
    /// Velocity of the air (m/s).
    pub velocity: [f64; 3],
    /// Density of the air (kg/m³).
    #[serde(default = "default::air_density")]
    pub density: f64,
    /// Tangential drag per area and speed (N·s/m³).
    #[serde(default)]
    pub drag: f64,
}

/// The view of pictures. It does not influence the simulation unless the scene has a `view`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Where the camera stands (m).
    pub position: [f64; 3],
    /// The point it looks at (m).
    pub target: [f64; 3],
    /// The direction that is up in the picture; default is against gravity (1).
    #[serde(default)]
    pub up: Option<[f64; 3]>,
    /// Opening angle from the lower to the upper edge (degrees).
    #[serde(default = "default::vertical_fov_deg")]
    pub vertical_fov_deg: f64,
    /// Width and height (pixels).
    #[serde(default = "default::resolution")]
    pub resolution: [u32; 2],
}

/// What is recorded besides the frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Recording {
    /// A complete state, from which a run can be continued, is kept every so many frames.
    #[schemars(range(min = 1))]
    pub checkpoint_every_frames: u32,
}

impl Default for Recording {
    fn default() -> Self {
        Self { checkpoint_every_frames: 25 }
    }
}

/// See [`RestraintFile::bleeding_s`], where the scene does not say (s).
pub(crate) const BLEEDING_S: f64 = 0.5;

/// See [`Thresholds::View`], where the scene does not say (m/s).
pub(crate) const MOST_M_PER_S: f64 = 0.5;

/// See [`FluidRestraint::most_m_per_s`], where the scene does not say (m/s). It is less than for cloth:
/// bleeding makes of it a friction, and water must not stand in heaps.
pub(crate) const FLUID_MOST_M_PER_S: f64 = 0.1;

/// Values of keys that a scene leaves out.
mod default {
    pub(super) fn frames_per_second() -> f64 {
        25.0
    }
    pub(super) fn substeps() -> u32 {
        8
    }
    pub(super) fn gravity() -> [f64; 3] {
        [0.0, 0.0, -9.81]
    }
    pub(super) fn linear_tolerance() -> f64 {
        1e-8
    }
    pub(super) fn air_density() -> f64 {
        1.2
    }
    pub(super) fn friction() -> f64 {
        0.3
    }
    pub(super) fn garment_cell_m() -> f64 {
        0.035
    }
    pub(super) fn crowd_spacing_m() -> [f64; 2] {
        [1.8, 1.8]
    }
    pub(super) fn contact_thickness_m() -> f64 {
        0.005
    }
    pub(super) fn self_contact() -> bool {
        true
    }
    pub(super) fn most_m_per_s() -> f64 {
        super::MOST_M_PER_S
    }
    #[expect(clippy::unnecessary_wraps, reason = "the key may be null")]
    pub(super) fn bleeding_s() -> Option<f64> {
        Some(super::BLEEDING_S)
    }
    pub(super) fn vertical_fov_deg() -> f64 {
        40.0
    }
    pub(super) fn view() -> super::ViewFile {
        let sizing_view::ViewSettings {
            v_back,
            v_out,
            v_hidden,
            margin,
            window,
            size_min_px,
            shift_max_px,
            size_max,
            ..
        } = sizing_view::ViewSettings::default();
        super::ViewFile {
            v_back,
            v_out,
            margin_m: margin,
            window_frames: window,
            size_min_px,
            shift_max_px,
            size_max_m: size_max,
            occlusion: false,
            predicted: false,
            v_hidden,
            cameras: Vec::new(),
        }
    }
    pub(super) fn resolution() -> [u32; 2] {
        [1280, 720]
    }
}
