//! Transforms, and their interpolation over time.

use nalgebra::{Quaternion, Similarity3, Translation3, UnitQuaternion, Vector3, Vector4};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::Range;

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
        Pose::of(self, Turning::AxisAngle).similarity(Turning::AxisAngle)
    }
}

/// A transform that changes over time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// How the time between keyframes is filled.
    #[serde(default)]
    pub interpolation: Interpolation,
    /// Which way rotations go from keyframe to keyframe.
    #[serde(default)]
    pub turning: Turning,
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

/// Which way rotations go from keyframe to keyframe.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Turning {
    /// Axis times angle is interpolated, so that a fixed axis allows any number of turns.
    #[default]
    AxisAngle,
    /// Unit quaternions are interpolated the shorter way around: never more than half a turn from
    /// keyframe to keyframe.
    Shortest,
}

/// A transform at a time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Keyframe {
    /// Time (s).
    pub time_s: f64,
    /// Transform at that time. In motions of handles the scale may be 0: all points meet there.
    #[serde(default)]
    pub transform: Transform,
    /// How fast the transform changes at that time, in a smooth motion; absent means as fast as
    /// between the keyframes beside it, and not at all at both ends of the motion.
    #[serde(default)]
    pub velocity: Option<Velocity>,
}

impl Keyframe {
    /// A keyframe that a smooth motion passes as its neighbours say.
    #[must_use]
    pub fn new(time_s: f64, transform: Transform) -> Self {
        Self { time_s, transform, velocity: None }
    }
}

/// Rate of change of a transform that does not turn.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Velocity {
    /// Of its offset (m/s).
    pub translate: [f64; 3],
    /// Of its factor of enlargement (1/s).
    pub scale: f64,
}

impl Motion {
    /// The transform at time `t` (s): that of the first keyframe before it, of the last after it.
    /// Smooth motions have continuous velocities everywhere; accelerations jump at keyframes.
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
        let first = before.saturating_sub(1);
        let poses = self.poses(first..keys.len().min(after + 2));
        let (a, b) = (&poses[before - first], &poses[after - first]);
        let pose = match self.interpolation {
            Interpolation::Linear => Pose::blend([(1.0 - s, a), (s, b)]),
            Interpolation::Smooth => {
                let (va, vb) = (self.rate(&poses, first, before), self.rate(&poses, first, after));
                let (s2, s3) = (s * s, s * s * s);
                Pose::blend([
                    (2.0 * s3 - 3.0 * s2 + 1.0, a),
                    (span * (s3 - 2.0 * s2 + s), &va),
                    (3.0 * s2 - 2.0 * s3, b),
                    (span * (s3 - s2), &vb),
                ])
            }
        };
        pose.similarity(self.turning)
    }

    /// Whether the transform changes at all.
    #[must_use]
    pub fn is_moving(&self) -> bool {
        let moves = |key: &Keyframe| key.velocity.is_some_and(|v| v != Velocity::default());
        self.keyframes.windows(2).any(|pair| {
            pair[0].transform != pair[1].transform || moves(&pair[0]) || moves(&pair[1])
        })
    }

    /// The poses of some keyframes. A quaternion and its negative are one rotation: each is the one
    /// that is nearer to its predecessor.
    fn poses(&self, keys: Range<usize>) -> Vec<Pose> {
        let mut poses: Vec<Pose> = Vec::with_capacity(keys.len());
        for key in &self.keyframes[keys] {
            let mut pose = Pose::of(&key.transform, self.turning);
            if self.turning == Turning::Shortest
                && poses.last().is_some_and(|last| last.turn.dot(&pose.turn) < 0.0)
            {
                pose.turn = -pose.turn;
            }
            poses.push(pose);
        }
        poses
    }

    /// Rate of change at keyframe `at` (1/s times the pose): the one it gives, or the slope between
    /// its neighbours, zero at both ends. `poses` are those from keyframe `first` on.
    fn rate(&self, poses: &[Pose], first: usize, at: usize) -> Pose {
        let keys = &self.keyframes;
        if let Some(Velocity { translate, scale }) = keys[at].velocity {
            return Pose { scale, offset: Vector3::from(translate), ..Pose::zero() };
        }
        if at == 0 || at + 1 == keys.len() {
            return Pose::zero();
        }
        let per_s = 1.0 / (keys[at + 1].time_s - keys[at - 1].time_s);
        Pose::blend([(per_s, &poses[at + 1 - first]), (-per_s, &poses[at - 1 - first])])
    }
}

/// A transform as numbers that can be added.
struct Pose {
    scale: f64,
    /// Axis times angle (rad) and 0, or a quaternion x, y, z, w, as [`Turning`] says.
    turn: Vector4<f64>,
    offset: Vector3<f64>,
}

impl Pose {
    fn zero() -> Self {
        Self { scale: 0.0, turn: Vector4::zeros(), offset: Vector3::zeros() }
    }

    fn of(transform: &Transform, turning: Turning) -> Self {
        let turn = transform.rotate.map_or_else(Vector3::zeros, |r| r.rotation_vector());
        Self {
            scale: transform.scale,
            turn: match turning {
                Turning::AxisAngle => turn.push(0.0),
                Turning::Shortest => UnitQuaternion::from_scaled_axis(turn).coords,
            },
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

    fn similarity(&self, turning: Turning) -> Similarity3<f64> {
        // A cubic between very different scales can undershoot; a scale of zero has no inverse.
        let scale = self.scale.max(1e-9);
        let turn = match turning {
            Turning::AxisAngle => UnitQuaternion::from_scaled_axis(self.turn.xyz()),
            Turning::Shortest => UnitQuaternion::new_normalize(Quaternion::from(self.turn)),
        };
        Similarity3::from_parts(Translation3::from(self.offset), turn, scale)
    }
}
