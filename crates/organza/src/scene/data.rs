//! A scene that has passed every check: defaults filled in, names and files resolved.

use super::format::{
    BendingModel, Camera, Capsule, CharacterFile, Cuboid, Damping, Disc, FluidFile, GarmentKind,
    Gltf, Grid, Integrator, LinearSolver, Multipliers, Newton, Plane, Poncho, Recording, Remeshing,
    Select, Skirt, Sphere, Spin, Torus, Tube, Tunic, Wind,
};
use super::motion::{Motion, Transform};
use crate::contact::ContactSettings;
use crate::fabric::Fabric;
use crate::fluid::Policy;
use sizing_view::{CameraPath, ViewSettings};

/// Everything a run needs to know, except the bytes of mesh files.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Name of the scene.
    pub name: String,
    /// Number of frames after the first, at least 1.
    pub frames: u32,
    /// Frame rate (1/s).
    pub frames_per_second: f64,
    /// Time steps per frame, at least 1.
    pub substeps: u32,
    /// Acceleration of gravity (m/s²).
    pub gravity: [f64; 3],
    /// Moving air.
    pub wind: Option<Wind>,
    /// How time steps are made.
    pub integrator: Integrator,
    /// The nonlinear solve.
    pub newton: Newton,
    /// The linear solver.
    pub linear_solver: LinearSolver,
    /// Relative residual at which iterative linear solvers stop (1).
    pub linear_tolerance: f64,
    /// The pieces of cloth; there is at least one, or a fluid.
    pub cloths: Vec<Cloth>,
    /// What holds or moves them.
    pub handles: Vec<Handle>,
    /// Bodies that cloth cannot pass.
    pub obstacles: Vec<Obstacle>,
    /// The fluid.
    pub fluid: Option<Fluid>,
    /// How things touch; absent where nothing does.
    pub contact: Option<ContactSettings>,
    /// The view of pictures.
    pub camera: Option<Camera>,
    /// The camera over time; there if `camera` is.
    pub camera_path: Option<CameraPath>,
    /// Mesh sizes by what the camera sees; only where there is a camera.
    pub view: Option<View>,
    /// From which thresholds on cloth rests that does not say so itself.
    pub restraint: Thresholds,
    /// Time in which momentum of cloth that rests bleeds away, if it does (s).
    pub bleeding_s: Option<f64>,
    /// What is recorded.
    pub recording: Recording,
}

/// How cameras see: for mesh sizes, and for restraint by view.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct View {
    /// The constants.
    pub settings: ViewSettings,
    /// Whether what stands in the way counts.
    pub occlusion: bool,
    /// Whether the cameras' future is guessed from their past.
    pub predicted: bool,
    /// Cameras besides that of the scene.
    pub more_cameras: Vec<CameraPath>,
}

/// From which thresholds on cloth rests.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Thresholds {
    /// It does not.
    #[default]
    None,
    /// By speed.
    Speed(arps::Speed),
    /// By kinetic energy.
    Kinetic(arps::Kinetic),
    /// By what cameras see.
    View(sizing_view::PixelThresholds),
}

impl Scene {
    /// Time from frame to frame (s).
    #[must_use]
    pub fn frame_s(&self) -> f64 {
        1.0 / self.frames_per_second
    }

    /// Length of a time step (s).
    #[must_use]
    pub fn step_s(&self) -> f64 {
        1.0 / (self.frames_per_second * f64::from(self.substeps))
    }

    /// Unit vector against gravity; z where there is none.
    #[must_use]
    pub fn up(&self) -> [f64; 3] {
        up(self.gravity)
    }
}

/// Unit vector against gravity; z where there is none.
pub(super) fn up(gravity: [f64; 3]) -> [f64; 3] {
    let up = -nalgebra::Vector3::from(gravity);
    up.try_normalize(0.0).map_or([0.0, 0.0, 1.0], Into::into)
}

/// A piece of cloth.
#[derive(Debug, Clone, PartialEq)]
pub struct Cloth {
    /// Name, unique in the scene.
    pub name: String,
    /// Where the mesh comes from.
    pub mesh: MeshSource,
    /// Placement; its scale applies to the flat pattern as well.
    pub transform: Transform,
    /// What the cloth is made of.
    pub fabric: Fabric,
    /// What single panels are made of instead, by name.
    pub panel_fabrics: Vec<(String, Fabric)>,
    /// Multipliers of the fabric, `thicken` included.
    pub multipliers: Multipliers,
    /// Thickness in contact (m); absent for that of the scene.
    pub thickness_m: Option<f64>,
    /// Smallest and largest principal stretch, min < 1 < max (1).
    pub strain_limits: Option<[f64; 2]>,
    /// Whether triangles give way to compression as wrinkled ones would.
    pub tension_field: bool,
    /// How bending is measured.
    pub bending: BendingModel,
    /// Damping inside the cloth.
    pub damping: Damping,
    /// Velocity at the start (m/s).
    pub initial_velocity: [f64; 3],
    /// Rotation at the start, added to the velocity.
    pub initial_spin: Option<Spin>,
    /// How the mesh adapts; absent for a fixed mesh.
    pub remeshing: Option<Remeshing>,
    /// From which thresholds on it rests; absent where it is as the scene says.
    pub restraint: Option<Thresholds>,
}

/// Where a mesh comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum MeshSource {
    /// A Wavefront OBJ file, and one with the flat pattern. The names are keys of the loaded
    /// sources.
    Obj {
        /// The mesh as it starts.
        obj: String,
        /// Its flat pattern.
        material_obj: Option<String>,
    },
    /// A flat rectangle.
    Grid(Grid),
    /// A flat disc.
    Disc(Disc),
    /// A sleeve.
    Tube(Tube),
    /// A skirt.
    Skirt(Skirt),
    /// A tunic.
    Tunic(Tunic),
    /// A poncho.
    Poncho(Poncho),
    /// A garment that fits a character.
    Garment(Garment),
}

/// A garment and who wears it.
#[derive(Debug, Clone, PartialEq)]
pub struct Garment {
    /// Which garment.
    pub kind: GarmentKind,
    /// Name of the obstacle that wears it, which is a [`ObstacleSource::Character`].
    pub on: String,
    /// About how long the edges of the mesh are (m).
    pub cell_m: f64,
}

/// Holds or moves vertices of a cloth.
#[derive(Debug, Clone, PartialEq)]
pub struct Handle {
    /// Index into the scene's cloths.
    pub cloth: usize,
    /// The vertices held.
    pub select: Select,
    /// How they move: by `motion.at(t) * motion.at(start_s).inverse()`.
    pub motion: Option<Motion>,
    /// When the handle takes hold (s).
    pub start_s: f64,
    /// When it lets go (s); infinite for never.
    pub end_s: f64,
    /// How long its springs take to fade after that (s).
    pub fade_s: f64,
    /// Stiffness of the springs (N/m); absent for an exact hold.
    pub stiffness_n_per_m: Option<f64>,
}

/// A body that cloth cannot pass.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    /// Name, unique among the obstacles of the scene.
    pub name: String,
    /// Where the surface comes from.
    pub mesh: ObstacleSource,
    /// Placement.
    pub transform: Transform,
    /// How it moves: after its placement, by `motion.at(t)`.
    pub motion: Option<Motion>,
    /// Coefficient of friction between it and cloth (1).
    pub friction: f64,
    /// Thickness in contact (m); absent for that of the scene.
    pub thickness_m: Option<f64>,
    /// When it appears (s); 0 for one that is there from the start.
    pub start_s: f64,
    /// When it is gone (s); infinite for never.
    pub end_s: f64,
}

/// A fluid.
#[derive(Debug, Clone, PartialEq)]
pub struct Fluid {
    /// Name.
    pub name: String,
    /// Indices of the scene's obstacles that it cannot pass.
    pub obstacles: Vec<usize>,
    /// Indices of the cloths that it cannot pass.
    pub cloths: Vec<usize>,
    /// Acceleration of gravity (m/s²).
    pub gravity: [f64; 3],
    /// By what particles are restrained, if they are.
    pub policy: Option<Policy>,
    /// The rest, as written.
    pub file: FluidFile,
}

/// Where the surface of an obstacle comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum ObstacleSource {
    /// A Wavefront OBJ file: a key of the loaded sources.
    Obj(String),
    /// One OBJ file for every frame.
    Sequence(Sequence),
    /// A character with a skeleton, from a glTF file.
    Gltf(Gltf),
    /// A mannequin.
    Character(CharacterFile),
    /// A sphere.
    Sphere(Sphere),
    /// A box.
    Cuboid(Cuboid),
    /// A finite rectangle.
    Plane(Plane),
    /// A cylinder with round ends.
    Capsule(Capsule),
    /// A ring.
    Torus(Torus),
}

/// An animation by one OBJ file for every frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Sequence {
    /// The files in order, at least one: keys of the loaded sources.
    pub files: Vec<String>,
    /// Frame rate (1/s).
    pub frames_per_second: f64,
    /// Time of the first frame (s).
    pub start_s: f64,
}
