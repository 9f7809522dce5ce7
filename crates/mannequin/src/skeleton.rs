//! The skeleton: joints with their places in the body, and how vertices hang on them.

use mesh_core::World3;
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

/// A joint and the bone beyond it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Joint {
    Pelvis,
    Spine,
    Chest,
    Head,
    LeftShoulder,
    RightShoulder,
    LeftElbow,
    RightElbow,
    LeftHip,
    RightHip,
    LeftKnee,
    RightKnee,
    LeftAnkle,
    RightAnkle,
}

/// Number of joints.
pub(crate) const N_JOINTS: usize = 14;

/// What a joint is.
pub(crate) struct Bone {
    pub(crate) joint: Joint,
    pub(crate) parent: Option<Joint>,
    /// Where it is in the body at rest (m).
    pub(crate) at: [f64; 3],
    /// The direction in which its bone lies (1).
    along: [f64; 3],
    /// Half of the length over which vertices go over to it (m).
    half: f64,
}

/// All joints, parents before their children, in the order of [`Joint`].
///
/// Shoulders and hips are not in the middle of their limbs, but near the skin of armpit and groin: a
/// fold that closes around a joint keeps the length of its skin only there. Farther off, linear blends
/// would pinch it shut, and cloth in it.
pub(crate) const BONES: [Bone; N_JOINTS] = {
    use Joint::*;
    const UP: [f64; 3] = [0.0, 0.0, 1.0];
    const DOWN: [f64; 3] = [0.0, 0.0, -1.0];
    const LEFT: [f64; 3] = [1.0, 0.0, 0.0];
    const RIGHT: [f64; 3] = [-1.0, 0.0, 0.0];
    const fn bone(
        joint: Joint,
        parent: Option<Joint>,
        at: [f64; 3],
        along: [f64; 3],
        half: f64,
    ) -> Bone {
        Bone { joint, parent, at, along, half }
    }
    [
        bone(Pelvis, None, [0.0, 0.0, 0.97], UP, 1.0),
        bone(Spine, Some(Pelvis), [0.0, 0.0, 1.09], UP, 0.07),
        bone(Chest, Some(Spine), [0.0, 0.0, 1.22], UP, 0.07),
        bone(Head, Some(Chest), [0.0, 0.0, 1.53], UP, 0.035),
        bone(LeftShoulder, Some(Chest), [0.167, 0.0, 1.382], LEFT, 0.05),
        bone(RightShoulder, Some(Chest), [-0.167, 0.0, 1.382], RIGHT, 0.05),
        bone(LeftElbow, Some(LeftShoulder), [0.43, 0.0, 1.41], LEFT, 0.05),
        bone(RightElbow, Some(RightShoulder), [-0.43, 0.0, 1.41], RIGHT, 0.05),
        bone(LeftHip, Some(Pelvis), [0.095, -0.04, 0.89], DOWN, 0.10),
        bone(RightHip, Some(Pelvis), [-0.095, -0.04, 0.89], DOWN, 0.10),
        bone(LeftKnee, Some(LeftHip), [0.112, 0.0, 0.50], DOWN, 0.07),
        bone(RightKnee, Some(RightHip), [-0.112, 0.0, 0.50], DOWN, 0.07),
        bone(LeftAnkle, Some(LeftKnee), [0.122, 0.0, 0.09], DOWN, 0.045),
        bone(RightAnkle, Some(RightKnee), [-0.122, 0.0, 0.09], DOWN, 0.045),
    ]
};

/// Points under the feet: heel and toes of the left and the right foot (m), with their ankles.
const SOLES: [([f64; 3], Joint); 4] = [
    ([0.122, 0.01, 0.011], Joint::LeftAnkle),
    ([0.130, -0.125, 0.007], Joint::LeftAnkle),
    ([-0.122, 0.01, 0.011], Joint::RightAnkle),
    ([-0.130, -0.125, 0.007], Joint::RightAnkle),
];

/// Rises from 0 at −1 to 1 at 1 with two continuous derivatives.
pub(crate) fn smooth(t: f64) -> f64 {
    let s = (0.5 * (t + 1.0)).clamp(0.0, 1.0);
    s * s * s * (s * (6.0 * s - 15.0) + 10.0)
}

/// How far a vertex at `x` (m) has gone over from the parent of a joint to its bone, from 0 to 1.
fn share(bone: &Bone, x: &World3) -> f64 {
    let beyond = smooth((x - World3::from(bone.at)).dot(&World3::from(bone.along)) / bone.half);
    match bone.joint {
        // The level of the shoulder cuts the legs, too.
        Joint::LeftShoulder | Joint::RightShoulder => beyond * smooth((x.z - 1.15) / 0.1),
        // Between the legs both have a part.
        Joint::LeftHip => beyond * smooth(x.x / 0.05),
        Joint::RightHip => beyond * smooth(-x.x / 0.05),
        _ => beyond,
    }
}

/// The joints that a vertex at `x` (m) of the body at rest hangs on, with weights that add up to one.
pub(crate) fn weights(x: &World3) -> Vec<(Joint, f64)> {
    let mut reach = [0.0; N_JOINTS];
    let mut own = [0.0; N_JOINTS];
    for (k, bone) in BONES.iter().enumerate() {
        reach[k] = bone.parent.map_or(1.0, |parent| reach[parent as usize] * share(bone, x));
        own[k] = reach[k];
        if let Some(parent) = bone.parent {
            own[parent as usize] -= reach[k];
        }
    }
    let joints = BONES.iter().map(|bone| bone.joint);
    joints.zip(own).filter(|(_, weight)| *weight > 1e-9).collect()
}

/// The way from the body at rest to a pose, bone by bone.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pose {
    /// Rotation of every joint against its parent.
    pub(crate) turns: [UnitQuaternion<f64>; N_JOINTS],
    /// Where the whole body goes: a shift along the floor and a turn about the vertical through it.
    pub(crate) place: Isometry3<f64>,
}

impl Pose {
    /// The maps from rest to the pose of every bone, the lowest sole on the floor.
    pub(crate) fn bones(&self) -> [Isometry3<f64>; N_JOINTS] {
        let mut maps = [Isometry3::identity(); N_JOINTS];
        for (k, bone) in BONES.iter().enumerate() {
            let at = Translation3::from(Vector3::from(bone.at));
            let turn = at * self.turns[k] * at.inverse();
            maps[k] = bone.parent.map_or(turn, |parent| maps[parent as usize] * turn);
        }
        let lift = Translation3::new(0.0, 0.0, -lowest(&maps));
        maps.map(|map| self.place * lift * map)
    }
}

/// How far the soles are above their height at rest: a smooth minimum over all, 0 at rest (m).
fn lowest(maps: &[Isometry3<f64>; N_JOINTS]) -> f64 {
    const BLEND: f64 = 0.01;
    let above = SOLES.map(|(x, ankle)| (maps[ankle as usize] * Point3::from(x)).z - x[2]);
    let mean = above.iter().map(|z| (-z / BLEND).exp()).sum::<f64>() / above.len() as f64;
    -BLEND * mean.ln()
}
