//! Fluids: water and what bounds it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A fluid of particles (weakly compressible SPH). It falls by the `gravity` of the scene and makes
/// as many time steps a frame as it needs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FluidFile {
    /// Name; default is `fluid0`.
    #[serde(default)]
    pub name: Option<String>,
    /// Distance of neighbouring particles at rest (m).
    pub spacing_m: f64,
    /// Density at rest (kg/m³).
    #[serde(default = "density_kg_per_m3")]
    pub density_kg_per_m3: f64,
    /// Speed of sound (m/s); absent means ten times the speed that the fluid has after falling from
    /// its highest point, so that its density varies by about 1 %. Time steps are as long as sound
    /// needs for a fraction of the spacing.
    #[serde(default)]
    pub sound_speed_m_per_s: Option<f64>,
    /// Artificial viscosity α between particles (1).
    #[serde(default = "viscosity")]
    pub viscosity: f64,
    /// The same between particles and walls (1).
    #[serde(default = "wall_viscosity")]
    pub wall_viscosity: f64,
    /// Part of the time of sound through a smoothing length that a step may take (1).
    #[serde(default = "courant")]
    #[schemars(range(max = 1))]
    pub courant: f64,
    /// How much farther than needed neighbours are listed, in spacings (1). Changes the speed only.
    #[serde(default = "skin")]
    pub skin: f64,
    /// Where particles may be; the run ends with an error if one leaves it. Absent means the box
    /// around all that is named here, with its longest edge added on every side.
    #[serde(default)]
    pub domain: Option<Region>,
    /// Blocks of fluid at the start.
    #[serde(default)]
    pub blocks: Vec<Block>,
    /// Nozzles.
    #[serde(default)]
    pub emitters: Vec<EmitterFile>,
    /// Boxes in which particles vanish.
    #[serde(default)]
    pub sinks: Vec<Region>,
    /// Basins: the fluid cannot pass their faces, from either side.
    #[serde(default)]
    pub boxes: Vec<Basin>,
    /// Names of the obstacles that the fluid cannot pass; absent means all. They must not
    /// come or go.
    #[serde(default)]
    pub obstacles: Option<Vec<String>>,
    /// Names of the cloths that the fluid cannot pass, and which it moves; absent means all.
    #[serde(default)]
    pub cloths: Option<Vec<String>>,
    /// How particles that hardly move are kept still (Manteaux2013); absent means not at all.
    #[serde(default)]
    pub restraint: Option<FluidRestraint>,
}

/// A box along the axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// The corner with the smallest coordinates (m).
    pub min: [f64; 3],
    /// The corner with the largest coordinates (m).
    pub max: [f64; 3],
}

/// A block of fluid: particles on a lattice, the first half a spacing from `min`, as many as fit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// The corner with the smallest coordinates (m).
    pub min: [f64; 3],
    /// The corner with the largest coordinates (m).
    pub max: [f64; 3],
    /// Velocity at the start (m/s).
    #[serde(default)]
    pub velocity: [f64; 3],
    /// Moves every particle by up to a thousandth of the spacing, each seed otherwise; 0 leaves them
    /// where they are.
    #[serde(default)]
    pub seed: u32,
    /// Brings its layers as close as their weight presses them in fluid that stands still, so that sound does
    /// not go up and down in it from the start on.
    #[serde(default)]
    pub pressed: bool,
}

/// A rectangular nozzle that lets layers of particles out.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EmitterFile {
    /// Its middle (m).
    pub position: [f64; 3],
    /// Where the fluid goes (1).
    pub direction: [f64; 3],
    /// Edge lengths across the direction, the first as level as possible (m).
    pub size_m: [f64; 2],
    /// Speed of the fluid (m/s).
    pub speed_m_per_s: f64,
    /// When it opens (s).
    #[serde(default)]
    pub start_s: f64,
    /// When it closes (s); absent means never.
    #[serde(default)]
    pub end_s: Option<f64>,
}

/// A box that fluid cannot leave or enter through its faces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Basin {
    /// The corner with the smallest coordinates (m).
    pub min: [f64; 3],
    /// The corner with the largest coordinates (m).
    pub max: [f64; 3],
    /// Faces that are missing.
    #[serde(default)]
    pub open: Vec<Face>,
}

/// A face of a box, by the direction in which it looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum Face {
    /// The one with the smallest x.
    #[serde(rename = "-x")]
    LowX,
    /// The one with the largest x.
    #[serde(rename = "+x")]
    HighX,
    /// The one with the smallest y.
    #[serde(rename = "-y")]
    LowY,
    /// The one with the largest y.
    #[serde(rename = "+y")]
    HighY,
    /// The one with the smallest z.
    #[serde(rename = "-z")]
    LowZ,
    /// The one with the largest z.
    #[serde(rename = "+z")]
    HighZ,
}

/// How particles are restrained. `policy` says by what: by `speed`, between
/// `restrain_below_m_per_s` and `restore_above_m_per_s`; by the `kinetic` energy of a particle, between
/// `restrain_below_j` and `restore_above_j`; `automatic`, so that a particle is off by no more than
/// `error_m` over `duration_s`; by what the cameras see (`view`), between `restrain_below_px_per_frame` and
/// `restore_above_px_per_frame`; or `automatic-view`, so that a particle that shows is off by no more than
/// `error_px` over `duration_s`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FluidRestraint {
    /// By what particles are restrained.
    #[serde(default)]
    pub policy: RestraintPolicy,
    /// Particles slower than this rest (m/s).
    #[serde(default)]
    pub restrain_below_m_per_s: Option<f64>,
    /// Particles faster than this move freely (m/s).
    #[serde(default)]
    pub restore_above_m_per_s: Option<f64>,
    /// Particles with less kinetic energy than this rest (J).
    #[serde(default)]
    pub restrain_below_j: Option<f64>,
    /// Particles with more kinetic energy than this move freely (J).
    #[serde(default)]
    pub restore_above_j: Option<f64>,
    /// Error of position that is accepted (m).
    #[serde(default)]
    pub error_m: Option<f64>,
    /// Particles that move by less than this from picture to picture rest (pixels).
    #[serde(default)]
    pub restrain_below_px_per_frame: Option<f64>,
    /// Particles that move by more than this from picture to picture move freely (pixels).
    #[serde(default)]
    pub restore_above_px_per_frame: Option<f64>,
    /// By view: speed up to which a particle rests at most, however far it is from the picture (m/s); absent
    /// means 0.1.
    #[serde(default)]
    pub most_m_per_s: Option<f64>,
    /// Error in the picture that is accepted (pixels).
    #[serde(default)]
    pub error_px: Option<f64>,
    /// Time over which an error is accepted (s); absent means all of the scene.
    #[serde(default)]
    pub duration_s: Option<f64>,
    /// How particles pass from rest to full dynamics.
    #[serde(default)]
    pub law: RestraintLaw,
    /// Time in which resting particles lose the momentum that they have gathered (s): a static
    /// friction, without which they keep creeping. Null means none, and that momentum is conserved.
    #[serde(default = "bleeding_s")]
    pub bleeding_s: Option<f64>,
    /// A particle in transition that is slower than this rests (m/s).
    #[serde(default)]
    pub inactivity_m_per_s: f64,
    /// A change of pressure up to this leaves accelerations as they are (Pa); absent means a hundredth
    /// of the pressure under a layer of particles.
    #[serde(default)]
    pub pressure_tolerance_pa: Option<f64>,
    /// Everything is computed anew where more than this part of the particles moves (1), or fewer that are
    /// next to nearly all others; 1 for never.
    #[serde(default = "sweep_above")]
    pub sweep_above: f64,
    /// In every how many steps a particle that rests gets its acceleration (1), if little moves.
    #[serde(default = "force_interval")]
    pub force_interval: u32,
}

/// By what particles are restrained.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RestraintPolicy {
    /// By their speed.
    #[default]
    Speed,
    /// By their kinetic energy.
    Kinetic,
    /// By their speed, with thresholds from the error that is accepted.
    Automatic,
    /// By their motion in the picture. What is out of it, or hidden, rests sooner, and is awake before it
    /// comes into it.
    View,
    /// The same, with thresholds from the error that is accepted.
    AutomaticView,
}

/// How particles pass from rest to full dynamics. With all but the splines the restrained kinetic
/// energy is convex.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RestraintLaw {
    /// In a straight line.
    #[default]
    Ramp,
    /// All lag by the lower threshold for ever.
    Soft,
    /// With the full kinetic energy above; the upper threshold is more than twice the lower.
    Exact,
    /// Smoothly.
    Smooth,
    /// The law of Manteaux2013 Eq. (3).
    Spline,
    /// The law of Manteaux2013 §6.3.
    MomentumSpline,
}

fn density_kg_per_m3() -> f64 {
    1000.0
}
fn viscosity() -> f64 {
    0.1
}
fn wall_viscosity() -> f64 {
    0.02
}
fn courant() -> f64 {
    0.4
}
fn skin() -> f64 {
    0.3
}
#[allow(clippy::unnecessary_wraps)]
fn bleeding_s() -> Option<f64> {
    Some(0.05)
}
fn sweep_above() -> f64 {
    0.4
}
fn force_interval() -> u32 {
    1
}
