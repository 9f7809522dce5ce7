//! Reads scenes of ARCSim 0.2.1 and translates them to the project's own format.
//!
//! What ARCSim's files mean, as far as this version simulates it:
//!
//! | ARCSim | here |
//! |---|---|
//! | `frame_time`, `frame_steps` (or `timestep`, `save_frames`) | frame rate and substeps |
//! | `end_time`, `end_frame`, `duration` | number of frames |
//! | `rotate: [angle°, x, y, z]` | axis and angle |
//! | `thicken` | multiplies density, stretching, bending |
//! | `damping` of a material | Kelvin–Voigt time (s) |
//! | node handles | springs of 10³ N/m, or `magic.handle_stiffness`, which may fade |
//! | `motions` | smooth keyframes, at rest at both ends unless they say otherwise; rotations the shorter way around |
//! | `motions` as an object | a motion file: places of rigid bodies in every frame |
//! | `obstacles` as a text | files with the numbers 0, 1 and so on, each with the motion of its number |
//! | `obs_friction`, `friction` | friction of obstacles, of cloth on cloth |
//! | `magic.repulsion_thickness` | thickness of contact |
//! | `disable` | leaves the part out |
//!
//! Morphs, fracture, handles other than on nodes and the like are collected as not supported, each
//! with its place; plasticity is left out with a notice. A key `organza`, unknown to ARCSim, may hold
//! `name`, `integrator`, `newton`, `linear_solver`, `linear_tolerance`, `bending`, `camera` and
//! `recording` as in the project's own scenes.

mod cloth;
mod format;
mod handle;
mod mot;
mod motion;
mod obstacle;
mod translate;

pub(crate) use translate::{is_arcsim, read};
