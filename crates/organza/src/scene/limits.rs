//! The largest numbers that a scene may ask for. Each stands far beyond what cloth needs, and far
//! below where arithmetic or memory fails.

/// Size of a scene or material file (bytes).
pub const MAX_TEXT_BYTES: u64 = 64 << 20;
/// Size of a mesh file (bytes).
pub const MAX_MESH_BYTES: u64 = 1 << 30;
/// Frames of an animation by one file for each.
pub const MAX_SEQUENCE_FRAMES: u32 = 10_000;
/// Size of a motion file (bytes).
pub const MAX_MOTION_BYTES: u64 = 256 << 20;
/// Cloths of a scene.
pub const MAX_CLOTHS: usize = 10_000;
/// Handles of a scene.
pub const MAX_HANDLES: usize = 100_000;
/// Cameras beside that of the scene.
pub const MAX_VIEW_CAMERAS: usize = 100;
/// Frames that cameras are followed beyond the end of a scene.
pub const MAX_VIEW_WINDOW: f64 = 10_000.0;
/// Characters of a crowd.
pub const MAX_CROWD: usize = 1_000;
/// Obstacles of a scene.
pub const MAX_OBSTACLES: usize = 10_000;
/// Coefficients of friction (1).
pub const MAX_FRICTION: f64 = 100.0;
/// Thickness of contact (m).
pub const MAX_THICKNESS_M: f64 = 1.0;
/// Complaints shown of one scene; a file that is no scene at all could have millions.
pub const MAX_ISSUES: usize = 50;
/// Characters shown of a message or a path.
pub const MAX_SHOWN_CHARS: usize = 1000;
/// Coordinates, lengths and offsets (m).
pub const MAX_COORDINATE_M: f64 = 1e6;
/// Speeds of cloth and wind (m/s).
pub const MAX_SPEED_M_PER_S: f64 = 1e4;
/// Largest threshold of kinetic energy (J).
pub const MAX_ENERGY_J: f64 = 1e9;
/// Angular speed (rad/s).
pub const MAX_SPIN_RAD_PER_S: f64 = 1e4;
/// Acceleration of gravity (m/s²).
pub const MAX_GRAVITY_M_PER_S2: f64 = 1e4;
/// Stretching (N/m), bending (N·m) and handle stiffness (N/m), multipliers included.
pub const MAX_STIFFNESS: f64 = 1e12;
/// Mass per area of cloth (kg/m²), multipliers included.
pub const MAX_DENSITY_KG_PER_M2: f64 = 1e4;
/// Mass per volume of air (kg/m³).
pub const MAX_AIR_DENSITY_KG_PER_M3: f64 = 1e4;
/// Multipliers and scales, and the inverse of the smallest one.
pub const MAX_FACTOR: f64 = 1e6;
/// Triangles that a generator makes.
pub const MAX_TRIANGLES: f64 = mesh_core::generate::MAX_TRIANGLES as f64;
/// Triangles of all cloths together, and of all obstacles: several gigabytes of mesh and matrix.
pub const MAX_SCENE_TRIANGLES: usize = 4 * mesh_core::generate::MAX_TRIANGLES;
/// Smallest length of a generated mesh (m).
pub const MIN_SIZE_M: f64 = mesh_core::generate::MIN_SIZE;
/// Vertices that remeshing may make.
pub const MAX_VERTICES: f64 = 2e7;
/// Largest aspect bound for which edits are still to be found, and the smallest that is one.
pub const ASPECT_RANGE: [f64; 2] = [0.001, 0.5];
/// Frames times substeps.
pub const MAX_STEPS: f64 = 1e9;
/// Frames per second (1/s), and the inverse of the slowest rate.
pub const MAX_FRAME_RATE: f64 = 1e6;
/// Simulated time (s).
pub const MAX_TIME_S: f64 = 1e9;
/// Damping (1/s) and damping time (s).
pub const MAX_DAMPING: f64 = 1e6;
/// Width and height of pictures (pixels).
pub const MAX_PICTURE_PX: u32 = 16_384;
/// Shots of a camera.
pub const MAX_SHOTS: usize = 10_000;
/// Particles of a fluid at the start: several gigabytes.
pub const MAX_PARTICLES: f64 = 1e7;
/// Density of a fluid (kg/m³).
pub const MAX_FLUID_DENSITY_KG_PER_M3: f64 = 1e6;
