//! Transforms, and their interpolation over time.

use nalgebra::{Similarity3, Translation3, UnitQuaternion, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Scales, then rotates about the origin, then translates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Transform {
    /// Factor of enlargement (1).
    pub scale: f64,
    /// Rotation; absent means none.
    pub rotate: Option<AxisAngle>,
    /// Offset (m).
    pub translate: [f64; 3],
}

impl Default for Transform {
    fn default() -> Self {
        Self { scale: 1.0, rotate: None, translate: [0.0; 3] }
    }
}

/// A rotation about an axis through the origin.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxisAngle {
    /// Direction of the axis, of any length (1).
    pub axis: [f64; 3],
    /// Angle, counter-clockwise as seen against the axis (degrees).
    pub degrees: f64,
}

impl AxisAngle {
    /// Axis of unit length times angle (rad). Zero where the axis has no direction.
    #[must_use]
    pub fn rotation_vector(&self) -> Vector3<f64> {
        let axis = Vector3::from(self.axis);
        axis.try_normalize(0.0).unwrap_or_default() * self.degrees.to_radians()
    }
}

impl Transform {
    /// The transform as a map of points: `similarity() * point` (m).
    #[must_use]
    pub fn similarity(&self) -> Similarity3<f64> {
        Pose::of(self).similarity()
    }
}

/// A transform that changes over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// How the time between keyframes is filled.
    #[serde(default)]
    pub interpolation: Interpolation,
    /// Transforms at increasing times. Before the first and after the last nothing moves.
    #[schemars(length(min = 1))]
    pub keyframes: Vec<Keyframe>,
}

/// How the time between keyframes is filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Interpolation {
    /// At constant speed from each keyframe to the next.
    Linear,
    /// By cubic curves without jumps in speed, at rest at both ends.
    #[default]
    Smooth,
}

/// A transform at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Keyframe {
    /// Time (s).
    pub time_s: f64,
    /// Transform at that time.
    #[serde(default)]
    pub transform: Transform,
}

impl Motion {
    /// The transform at time `t` (s). Rotations are interpolated as rotation vectors, so a fixed
    /// axis allows any number of turns.
    ///
    /// A handle that takes hold at t₀ moves its points by `at(t) * at(t0).inverse()`.
    #[must_use]
    pub fn at(&self, t: f64) -> Similarity3<f64> {
        let keys = &self.keyframes;
        let after = keys.partition_point(|key| key.time_s <= t);
        let (Some(before), Some(next)) = (after.checked_sub(1), keys.get(after)) else {
            // Before the first, after the last, or no keyframe at all.
            let held = if after == 0 { keys.first() } else { keys.last() };
            return held.map_or_else(Similarity3::identity, |key| key.transform.similarity());
        };
        let span = next.time_s - keys[before].time_s;
        let s = (t - keys[before].time_s) / span;
        let (a, b) = (Pose::of(&keys[before].transform), Pose::of(&next.transform));
        match self.interpolation {
            Interpolation::Linear => Pose::blend([(1.0 - s, &a), (s, &b)]).similarity(),
            Interpolation::Smooth => {
                let (va, vb) = (self.rate(before), self.rate(after));
                let (s2, s3) = (s * s, s * s * s);
                Pose::blend([
                    (2.0 * s3 - 3.0 * s2 + 1.0, &a),
                    (span * (s3 - 2.0 * s2 + s), &va),
                    (3.0 * s2 - 2.0 * s3, &b),
                    (span * (s3 - s2), &vb),
                ])
                .similarity()
            }
        }
    }

    /// Rate of change at a keyframe (1/s times the pose): the slope between its neighbours, zero
    /// at both ends.
    fn rate(&self, at: usize) -> Pose {
        let keys = &self.keyframes;
        let neighbours = at.checked_sub(1).and_then(|i| keys.get(i)).zip(keys.get(at + 1));
        neighbours.map_or_else(Pose::zero, |(a, b)| {
            let per_s = 1.0 / (b.time_s - a.time_s);
            Pose::blend([(per_s, &Pose::of(&b.transform)), (-per_s, &Pose::of(&a.transform))])
        })
    }
}

/// A transform as numbers that can be added.
struct Pose {
    scale: f64,
    turn: Vector3<f64>,
    offset: Vector3<f64>,
}

impl Pose {
    fn zero() -> Self {
        Self { scale: 0.0, turn: Vector3::zeros(), offset: Vector3::zeros() }
    }

    fn of(transform: &Transform) -> Self {
        Self {
            scale: transform.scale,
            turn: transform.rotate.map_or_else(Vector3::zeros, |r| r.rotation_vector()),
            offset: Vector3::from(transform.translate),
        }
    }

    fn blend<const N: usize>(parts: [(f64, &Self); N]) -> Self {
        parts.iter().fold(Self::zero(), |sum, (weight, pose)| Self {
            scale: sum.scale + weight * pose.scale,
            turn: sum.turn + pose.turn * *weight,
            offset: sum.offset + pose.offset * *weight,
        })
    }

    fn similarity(&self) -> Similarity3<f64> {
        // A cubic between very different scales can undershoot; a scale of zero has no inverse.
        let scale = self.scale.max(1e-9);
        let turn = UnitQuaternion::from_scaled_axis(self.turn);
        Similarity3::from_parts(Translation3::from(self.offset), turn, scale)
    }
}
