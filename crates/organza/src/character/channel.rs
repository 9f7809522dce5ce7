//! Channels of an animation: one part of one node's transform over time.

use super::Container;
use gltf::json::animation::{Animation, Channel as JsonChannel, Interpolation, Property};
use gltf::json::validation::Checked;
use nalgebra::{Matrix4, Quaternion, Rotation3, UnitQuaternion, Vector3, Vector4};

/// Translation, rotation and scale of a node to its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub(super) translation: Vector3<f64>,
    pub(super) rotation: UnitQuaternion<f64>,
    pub(super) scale: Vector3<f64>,
}

impl Pose {
    pub(super) fn matrix(&self) -> Matrix4<f64> {
        let turn = Rotation3::from(self.rotation).to_homogeneous();
        (turn * Matrix4::new_nonuniform_scaling(&self.scale)).append_translation(&self.translation)
    }
}

/// One part of one node's transform over time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Channel {
    pub(super) node: usize,
    part: Part,
    way: Way,
    /// Times of the keyframes, ascending (s).
    times: Vec<f64>,
    /// One a keyframe, or tangent, value, tangent a keyframe for splines. Vectors end with 0;
    /// quaternions are x, y, z, w.
    values: Vec<Vector4<f64>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Translation,
    Rotation,
    Scale,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Step,
    Linear,
    Spline,
}

impl Channel {
    /// Sets its part of a node's transform to that at a time (s): the first keyframe's before it, the
    /// last one's after it.
    pub(super) fn apply(&self, time: f64, pose: &mut Pose) {
        let value = self.at(time);
        match self.part {
            Part::Translation => pose.translation = value.xyz(),
            Part::Scale => pose.scale = value.xyz(),
            Part::Rotation => {
                pose.rotation = UnitQuaternion::try_new(Quaternion::from(value), 1e-12)
                    .unwrap_or_else(UnitQuaternion::identity);
            }
        }
    }

    /// Times of the keyframes, ascending (s).
    pub(super) fn times(&self) -> &[f64] {
        &self.times
    }

    fn at(&self, time: f64) -> Vector4<f64> {
        let last = self.times.len() - 1;
        let after = self.times.partition_point(|&t| t <= time);
        if after == 0 || after > last {
            return self.value(after.min(last));
        }
        let before = after - 1;
        let span = self.times[after] - self.times[before];
        let s = (time - self.times[before]) / span;
        let (a, b) = (self.value(before), self.value(after));
        match self.way {
            Way::Step => a,
            Way::Linear if self.part == Part::Rotation => {
                let [a, b] = [a, b].map(|q| UnitQuaternion::new_normalize(Quaternion::from(q)));
                // Opposite quaternions are no problem: half a turn of a quaternion is a whole one.
                a.try_slerp(&b, s, 1e-12).unwrap_or(a).into_inner().coords
            }
            Way::Linear => a * (1.0 - s) + b * s,
            Way::Spline => {
                let (s2, s3) = (s * s, s * s * s);
                let (out, into) = (self.values[3 * before + 2], self.values[3 * after]);
                a * (2.0 * s3 - 3.0 * s2 + 1.0)
                    + out * (span * (s3 - 2.0 * s2 + s))
                    + b * (3.0 * s2 - 2.0 * s3)
                    + into * (span * (s3 - s2))
            }
        }
    }

    fn value(&self, keyframe: usize) -> Vector4<f64> {
        match self.way {
            Way::Spline => self.values[3 * keyframe + 1],
            Way::Step | Way::Linear => self.values[keyframe],
        }
    }
}

/// Reads a channel of an animation.
///
/// # Errors
/// A sentence about the channel.
pub(super) fn read(
    file: &Container,
    animation: &Animation,
    channel: &JsonChannel,
) -> Result<Channel, String> {
    let node = channel.target.node.value();
    if node >= file.root.nodes.len() {
        return Err(format!("there is no node {node}"));
    }
    let part = match channel.target.path {
        Checked::Valid(Property::Translation) => Part::Translation,
        Checked::Valid(Property::Rotation) => Part::Rotation,
        Checked::Valid(Property::Scale) => Part::Scale,
        Checked::Valid(Property::MorphTargetWeights) => {
            return Err("morph targets are not supported".into());
        }
        Checked::Invalid => return Err("what it moves is not known".into()),
    };
    if file.root.nodes[node].matrix.is_some() {
        return Err(format!("node {node} has a matrix, which cannot be animated"));
    }
    let sampler = animation.samplers.get(channel.sampler.value()).ok_or("has no sampler")?;
    let way = match sampler.interpolation {
        Checked::Valid(Interpolation::Step) => Way::Step,
        Checked::Valid(Interpolation::Linear) => Way::Linear,
        Checked::Valid(Interpolation::CubicSpline) => Way::Spline,
        Checked::Invalid => return Err("its interpolation is not known".into()),
    };
    let times: Vec<f64> = file.numbers::<1>(sampler.input)?.into_iter().map(|[t]| t).collect();
    if times.is_empty() {
        return Err("has no keyframes".into());
    }
    if let Some(k) = times.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(format!("keyframe {} is not after the one before it", k + 1));
    }
    let values: Vec<Vector4<f64>> = match part {
        Part::Rotation => {
            file.numbers::<4>(sampler.output)?.into_iter().map(Vector4::from).collect()
        }
        Part::Translation | Part::Scale => {
            let numbers = file.numbers::<3>(sampler.output)?;
            numbers.into_iter().map(|x| Vector3::from(x).push(0.0)).collect()
        }
    };
    let wanted = if way == Way::Spline { 3 * times.len() } else { times.len() };
    if values.len() != wanted {
        return Err(format!("has {} values instead of {wanted}", values.len()));
    }
    let channel = Channel { node, part, way, times, values };
    let is_zero = |k: &usize| channel.value(*k).norm() < 1e-6;
    if part == Part::Rotation
        && let Some(k) = (0..channel.times.len()).find(is_zero)
    {
        return Err(format!("the quaternion of keyframe {k} is zero"));
    }
    Ok(channel)
}
