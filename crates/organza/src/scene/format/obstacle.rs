//! Obstacles, and how things touch.

use std::fmt;

use schemars::JsonSchema;
use serde::de::{Deserializer, Error, Visitor};
use serde::{Deserialize, Serialize};

use super::{CharacterFile, default};
use crate::scene::motion::{Motion, Transform};

/// A body that cloth cannot pass. It moves as prescribed, whatever pushes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObstacleFile {
    /// Name; default is `obstacle0`, `obstacle1` and so on.
    #[serde(default)]
    pub name: Option<String>,
    /// Where the surface comes from.
    pub mesh: ObstacleMesh,
    /// Places the surface in the scene, or in the frame of its motion.
    #[serde(default)]
    pub transform: Transform,
    /// How it moves: with T(t) the transform of the motion at time t, a point that `transform` puts
    /// at x is at T(t) x. Absent means that it stays.
    #[serde(default)]
    pub motion: Option<Motion>,
    /// Coefficient of friction between it and cloth (1).
    #[serde(default = "default::friction")]
    pub friction: f64,
    /// Thickness in contact (m): cloth and obstacle keep the mean of theirs. Absent means that of
    /// `contact`.
    #[serde(default)]
    pub thickness_m: Option<f64>,
    /// When it appears (s); 0 means that it is there from the start. Cloth must not lie across it
    /// then.
    #[serde(default)]
    pub start_s: f64,
    /// When it is gone (s); absent means never.
    #[serde(default)]
    pub end_s: Option<f64>,
}

/// Where the surface of an obstacle comes from: exactly one of `obj`, `obj_sequence`, `gltf`,
/// `character`, `sphere`, `box`, `plane`, `capsule`, `torus`. Cloth is stopped on both sides of open surfaces.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ObstacleMesh {
    /// A Wavefront OBJ file, relative to the scene file; `v` and `f` alone count.
    pub obj: Option<String>,
    /// An animation by one OBJ file for every frame.
    pub obj_sequence: Option<ObjSequence>,
    /// A character with a skeleton, from a glTF 2.0 file.
    pub gltf: Option<Gltf>,
    /// A mannequin that moves.
    pub character: Option<CharacterFile>,
    /// A sphere around the origin.
    pub sphere: Option<Sphere>,
    /// A box around the origin.
    #[serde(rename = "box")]
    pub cuboid: Option<Cuboid>,
    /// A flat rectangle around the origin.
    pub plane: Option<Plane>,
    /// A cylinder with round ends around the origin.
    pub capsule: Option<Capsule>,
    /// A ring around the z axis.
    pub torus: Option<Torus>,
}

/// An animation by one OBJ file for every frame, with straight ways from frame to frame. All have
/// the vertices and faces of the first in the same order. Before the first frame and after the last
/// nothing moves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObjSequence {
    /// The files, relative to the scene file, with one place for the number as C's `printf` writes
    /// it: `walk/body%04d.obj`.
    pub files: String,
    /// Numbers of the first and the last frame.
    pub frames: [u32; 2],
    /// Frame rate (1/s).
    pub frames_per_second: f64,
    /// Time of the first frame (s).
    #[serde(default)]
    pub start_s: f64,
}

/// A character from a glTF 2.0 file (`.glb`, or `.gltf` with its buffers in files or in itself): all
/// triangles of its scene, moved by its nodes and skins. Its y axis is up, so that most scenes place
/// it with `rotate: { axis: [1, 0, 0], degrees: 90 }`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gltf {
    /// The file, relative to the scene file.
    pub file: String,
    /// The animation, by name or by number counted from 0; absent means the first, or none where
    /// the file has none.
    #[serde(default)]
    pub animation: Option<AnimationRef>,
    /// When the animation begins (s).
    #[serde(default)]
    pub start_s: f64,
}

/// An animation, by name or by number counted from 0.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum AnimationRef {
    /// By number.
    Index(u32),
    /// By name.
    Name(String),
}

impl<'de> Deserialize<'de> for AnimationRef {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameOrIndex;
        impl Visitor<'_> for NameOrIndex {
            type Value = AnimationRef;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("the name or the number of an animation")
            }

            fn visit_u64<E: Error>(self, index: u64) -> Result<AnimationRef, E> {
                let too_large = |_| E::custom(format!("there is no animation {index}"));
                u32::try_from(index).map(AnimationRef::Index).map_err(too_large)
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<AnimationRef, E> {
                Ok(AnimationRef::Name(name.to_owned()))
            }
        }
        deserializer.deserialize_any(NameOrIndex)
    }
}

/// A ring around the z axis, its middle at the origin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Torus {
    /// Radius of the circle in the middle of the tube (m).
    pub radius_m: f64,
    /// Radius of the tube, less than that of the circle (m).
    pub tube_radius_m: f64,
    /// Number of segments around the axis and around the tube, each at least 3.
    #[serde(default = "default_torus_segments")]
    pub segments: [u32; 2],
}

/// A sphere around the origin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Radius (m).
    pub radius_m: f64,
    /// How often the triangles of an icosahedron are quartered: 20 · 4ⁿ triangles.
    #[serde(default = "default_detail")]
    pub detail: u32,
}

/// A box around the origin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cuboid {
    /// Lengths along x, y and z (m).
    pub size_m: [f64; 3],
}

/// A flat rectangle around the origin in the plane z = 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// Lengths along x and y (m).
    pub size_m: [f64; 2],
}

/// A cylinder around the z axis with half a sphere at each end, its middle at the origin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Capsule {
    /// Radius (m).
    pub radius_m: f64,
    /// Length of the cylinder between the half spheres (m).
    pub length_m: f64,
    /// Number of segments around, at least 4; each half sphere has a quarter as many rings.
    #[serde(default = "default_segments")]
    pub segments: u32,
}

/// How things touch.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ContactFile {
    /// Distance that is kept between the middle surfaces of things that touch, where cloths and
    /// obstacles have no `thickness_m` of their own (m).
    pub thickness_m: f64,
    /// Coefficient of friction of cloth on cloth (1).
    pub friction: f64,
    /// Whether cloth touches cloth, itself included.
    pub self_contact: bool,
}

impl Default for ContactFile {
    fn default() -> Self {
        Self {
            thickness_m: default::contact_thickness_m(),
            friction: default::friction(),
            self_contact: default::self_contact(),
        }
    }
}

fn default_detail() -> u32 {
    4
}

fn default_segments() -> u32 {
    32
}

fn default_torus_segments() -> [u32; 2] {
    [48, 16]
}
