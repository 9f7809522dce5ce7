//! The keys of ARCSim's scene files. Kept to what the files say; what it means is in `translate`.

use std::fmt;

use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::scene::format::{BendingModel, Camera, Integrator, LinearSolver, Newton, Recording};

/// A scene of ARCSim.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArcsimFile {
    // One of two ways to give time.
    pub(super) frame_time: Option<f64>,
    pub(super) frame_steps: Option<u32>,
    pub(super) end_time: Option<f64>,
    pub(super) end_frame: Option<u32>,
    pub(super) timestep: Option<f64>,
    pub(super) save_frames: Option<u32>,
    pub(super) duration: Option<f64>,
    pub(super) cloths: Vec<ArcsimCloth>,
    #[serde(default)]
    pub(super) motions: ArcsimMotions,
    #[serde(default)]
    pub(super) handles: Vec<ArcsimHandle>,
    #[serde(default)]
    pub(super) obstacles: ArcsimObstacles,
    pub(super) morphs: Option<Value>,
    pub(super) gravity: Option<[f64; 3]>,
    pub(super) wind: Option<ArcsimWind>,
    /// Of cloth on cloth.
    pub(super) friction: Option<f64>,
    /// Of cloth on obstacles.
    pub(super) obs_friction: Option<f64>,
    #[serde(default)]
    pub(super) disable: Vec<String>,
    #[serde(default)]
    pub(super) magic: Magic,
    /// Settings that ARCSim has no words for.
    #[serde(default)]
    pub(super) organza: Extras,
}

/// Settings that ARCSim has no words for.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Extras {
    pub(super) name: Option<String>,
    pub(super) integrator: Option<Integrator>,
    pub(super) newton: Option<Newton>,
    pub(super) linear_solver: Option<LinearSolver>,
    pub(super) linear_tolerance: Option<f64>,
    pub(super) bending: Option<BendingModel>,
    pub(super) camera: Option<Camera>,
    pub(super) recording: Option<Recording>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArcsimCloth {
    pub(super) mesh: String,
    pub(super) transform: Option<ArcsimTransform>,
    pub(super) velocity: Option<ArcsimVelocity>,
    #[serde(default)]
    pub(super) materials: Vec<ArcsimMaterial>,
    pub(super) remeshing: Option<ArcsimRemeshing>,
    /// Of version 0.3.
    pub(super) reference: Option<Value>,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArcsimTransform {
    pub(super) scale: Option<f64>,
    /// Angle (degrees), then the axis.
    pub(super) rotate: Option<[f64; 4]>,
    pub(super) translate: Option<[f64; 3]>,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArcsimVelocity {
    pub(super) linear: Option<[f64; 3]>,
    pub(super) angular: Option<[f64; 3]>,
    pub(super) origin: Option<[f64; 3]>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArcsimMaterial {
    pub(super) data: Option<String>,
    pub(super) thicken: Option<f64>,
    pub(super) density_mult: Option<f64>,
    pub(super) stretching_mult: Option<f64>,
    pub(super) bending_mult: Option<f64>,
    pub(super) damping: Option<f64>,
    pub(super) strain_limits: Option<[f64; 2]>,
    pub(super) yield_curv: Option<Value>,
    pub(super) weakening: Option<Value>,
    // Of version 0.3: a material without measurements, plasticity and fracture.
    pub(super) thickness: Option<Value>,
    pub(super) density: Option<Value>,
    pub(super) elastic_modulus: Option<Value>,
    pub(super) poisson_ratio: Option<Value>,
    pub(super) bending_factor: Option<Value>,
    pub(super) yield_stretch: Option<Value>,
    pub(super) plastic_flow: Option<Value>,
    pub(super) toughness: Option<Value>,
    pub(super) bend_width: Option<Value>,
    pub(super) initiation_factor: Option<Value>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArcsimRemeshing {
    pub(super) refine_angle: Option<f64>,
    pub(super) refine_compression: Option<f64>,
    pub(super) refine_velocity: Option<f64>,
    pub(super) size: Option<[f64; 2]>,
    pub(super) aspect_min: Option<f64>,
    /// Of version 0.3.
    pub(super) refine_fracture: Option<Value>,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArcsimWind {
    pub(super) density: Option<f64>,
    pub(super) velocity: Option<[f64; 3]>,
    pub(super) drag: Option<f64>,
}

/// Motions: lists of keyframes, or a file.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub(super) enum ArcsimMotions {
    Lists(Vec<Vec<ArcsimKeyframe>>),
    File(ArcsimMotionFile),
}

impl Default for ArcsimMotions {
    fn default() -> Self {
        Self::Lists(Vec::new())
    }
}

impl<'de> Deserialize<'de> for ArcsimMotions {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ListsOrFile;
        impl<'de> Visitor<'de> for ListsOrFile {
            type Value = ArcsimMotions;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of motions or an object with `motfile`")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, lists: A) -> Result<ArcsimMotions, A::Error> {
                Deserialize::deserialize(SeqAccessDeserializer::new(lists))
                    .map(ArcsimMotions::Lists)
            }

            fn visit_map<A: MapAccess<'de>>(self, file: A) -> Result<ArcsimMotions, A::Error> {
                Deserialize::deserialize(MapAccessDeserializer::new(file)).map(ArcsimMotions::File)
            }

            fn visit_unit<E: Error>(self) -> Result<ArcsimMotions, E> {
                Ok(ArcsimMotions::default())
            }
        }
        deserializer.deserialize_any(ListsOrFile)
    }
}

/// Motions of several bodies in one file.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArcsimMotionFile {
    pub(super) motfile: String,
    pub(super) fps: f64,
    /// Applied after the motions.
    pub(super) transform: Option<ArcsimTransform>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArcsimKeyframe {
    pub(super) time: f64,
    pub(super) transform: Option<ArcsimTransform>,
    /// Rate of change of the transform.
    pub(super) velocity: Option<ArcsimTransform>,
}

/// Obstacles: a list, or a pattern for the names of their files, of which the first has the first
/// motion and so on.
#[derive(Debug, Clone, Serialize)]
#[serde(untagged)]
pub(super) enum ArcsimObstacles {
    List(Vec<ArcsimObstacle>),
    Pattern(String),
}

impl Default for ArcsimObstacles {
    fn default() -> Self {
        Self::List(Vec::new())
    }
}

impl<'de> Deserialize<'de> for ArcsimObstacles {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ListOrPattern;
        impl<'de> Visitor<'de> for ListOrPattern {
            type Value = ArcsimObstacles;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of obstacles or a pattern for the names of their files")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<ArcsimObstacles, A::Error> {
                Deserialize::deserialize(SeqAccessDeserializer::new(list))
                    .map(ArcsimObstacles::List)
            }

            fn visit_str<E: Error>(self, pattern: &str) -> Result<ArcsimObstacles, E> {
                Ok(ArcsimObstacles::Pattern(pattern.to_owned()))
            }

            fn visit_unit<E: Error>(self) -> Result<ArcsimObstacles, E> {
                Ok(ArcsimObstacles::default())
            }
        }
        deserializer.deserialize_any(ListOrPattern)
    }
}

#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArcsimHandle {
    #[serde(rename = "type")]
    pub(super) kind: Option<String>,
    pub(super) cloth: Option<u32>,
    pub(super) nodes: Option<Vec<u32>>,
    pub(super) label: Option<Value>,
    /// Index into the motions; −1 for none.
    pub(super) motion: Option<i64>,
    pub(super) start_time: Option<f64>,
    pub(super) end_time: Option<f64>,
    pub(super) fade_time: Option<f64>,
    // Of circle handles.
    pub(super) circumference: Option<Value>,
    pub(super) u: Option<Value>,
    pub(super) center: Option<Value>,
    pub(super) axis0: Option<Value>,
    pub(super) axis1: Option<Value>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ArcsimObstacle {
    pub(super) mesh: String,
    pub(super) transform: Option<ArcsimTransform>,
    /// Index into the motions; −1 for none.
    pub(super) motion: Option<i64>,
    pub(super) start_time: Option<f64>,
    pub(super) end_time: Option<f64>,
}

/// Constants that ARCSim keeps in one place. Of contact, only `repulsion_thickness` is used here.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Magic {
    pub(super) fixed_high_res_mesh: Option<bool>,
    pub(super) handle_stiffness: Option<f64>,
    pub(super) collision_stiffness: Option<f64>,
    pub(super) repulsion_thickness: Option<f64>,
    pub(super) projection_thickness: Option<f64>,
    pub(super) edge_flip_threshold: Option<f64>,
    pub(super) rib_stiffening: Option<f64>,
    pub(super) combine_tensors: Option<bool>,
    pub(super) preserve_creases: Option<bool>,
    // Of version 0.3.
    pub(super) add_jitter: Option<bool>,
    pub(super) relax_initial_state: Option<bool>,
    pub(super) relax_method: Option<i64>,
    pub(super) separation_step_size: Option<f64>,
    pub(super) max_cracks: Option<i64>,
    pub(super) enable_localopt: Option<bool>,
}
