//! Motions: periodic curves of joint angles, and the path of the whole body.

use crate::skeleton::{Joint, N_JOINTS, Pose, smooth};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use std::f64::consts::{PI, TAU};

/// What a mannequin does, over and over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Stands with level arms.
    Stand,
    /// Walks on a circle of [`WALK_RADIUS`], counter-clockwise seen from above.
    Walk,
    /// Spins on the spot.
    Turn,
    /// Kicks to the front with one leg and then the other.
    Kick,
    /// Sways, steps, turns to and fro.
    Dance,
}

/// Radius of the circle of [`Action::Walk`] (m).
pub const WALK_RADIUS: f64 = 1.5;

/// How a mannequin moves. It stands until `start`, eases into its action, and goes on for ever.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// What it does.
    pub action: Action,
    /// Where in the cycle it begins, as a part of the cycle (1).
    pub phase: f64,
    /// Chooses small differences in speed and width from one mannequin to the next; 0 for none.
    pub seed: u64,
    /// When it begins (s).
    pub start: f64,
    /// How long it takes until it moves in full (s).
    pub ease: f64,
}

impl Motion {
    /// Stands still.
    pub const STAND: Motion =
        Motion { action: Action::Stand, phase: 0.0, seed: 0, start: 0.0, ease: 1.0 };

    /// Time in which the joints run through a cycle (s); 0 if nothing moves. The path of the body is
    /// not periodic: it turns on, or walks on.
    pub fn period(&self) -> f64 {
        let plain = match self.action {
            Action::Stand => return 0.0,
            Action::Walk => 1.15,
            Action::Turn => 2.0,
            Action::Kick => 3.2,
            Action::Dance => 4.4,
        };
        plain * (1.0 + 0.06 * self.chance(0))
    }

    /// A number between −1 and 1 that the seed chooses; 0 for the seed 0. (splitmix64, Steele2014.)
    fn chance(&self, k: u64) -> f64 {
        if self.seed == 0 {
            return 0.0;
        }
        let mut z = self.seed.wrapping_add((k + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        2.0 * ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64 - 1.0
    }

    /// The pose at a time (s).
    pub(crate) fn pose(&self, time: f64) -> Pose {
        let u = if self.ease > 0.0 { (time - self.start) / self.ease } else { f64::INFINITY };
        // Share of the action, and its own clock: the integral of that share.
        let (share, clock) = if time <= self.start {
            (0.0, 0.0)
        } else if u >= 1.0 {
            (1.0, time - self.start - 0.5 * self.ease)
        } else {
            (smooth(2.0 * u - 1.0), self.ease * u.powi(4) * (u * u - 3.0 * u + 2.5))
        };
        let mut angles = Angles::new(share);
        if self.action == Action::Stand {
            return angles.pose(Isometry3::identity());
        }
        let turns = clock / self.period();
        // Whole cycles go first, so that later ones have the digits of the first.
        let c = TAU * (turns.fract() + self.phase);
        let wide = 1.0 + 0.12 * self.chance(1);
        let place = match self.action {
            Action::Stand => Isometry3::identity(),
            Action::Walk => walk(&mut angles, c, wide, turns),
            Action::Turn => turn(&mut angles, c, wide, turns, self.phase),
            Action::Kick => kick(&mut angles, c, wide),
            Action::Dance => {
                let chances = [2, 3, 4].map(|k| PI * self.chance(k));
                dance(&mut angles, c, TAU * self.phase, wide, chances)
            }
        };
        angles.pose(place)
    }
}

/// Angles of the joints while they are put together, each eased by the same share.
struct Angles {
    share: f64,
    turns: [UnitQuaternion<f64>; N_JOINTS],
}

/// The sides: joints and the sign of x.
const LEFT: Side = Side {
    sign: 1.0,
    shoulder: Joint::LeftShoulder,
    elbow: Joint::LeftElbow,
    hip: Joint::LeftHip,
    knee: Joint::LeftKnee,
    ankle: Joint::LeftAnkle,
};
const RIGHT: Side = Side {
    sign: -1.0,
    shoulder: Joint::RightShoulder,
    elbow: Joint::RightElbow,
    hip: Joint::RightHip,
    knee: Joint::RightKnee,
    ankle: Joint::RightAnkle,
};

struct Side {
    sign: f64,
    shoulder: Joint,
    elbow: Joint,
    hip: Joint,
    knee: Joint,
    ankle: Joint,
}

impl Angles {
    fn new(share: f64) -> Angles {
        Angles { share, turns: [UnitQuaternion::identity(); N_JOINTS] }
    }

    fn pose(self, place: Isometry3<f64>) -> Pose {
        Pose { turns: self.turns, place }
    }

    /// Turns a joint, after what it was turned already, about x, then y, then z (rad).
    fn turn(&mut self, joint: Joint, [x, y, z]: [f64; 3]) {
        let s = self.share;
        self.turns[joint as usize] =
            UnitQuaternion::from_euler_angles(s * x, s * y, s * z) * self.turns[joint as usize];
    }

    /// An arm lowered from level, swung to the back, bent at the elbow (rad).
    fn arm(&mut self, side: &Side, lowered: f64, back: f64, bent: f64) {
        self.turn(side.shoulder, [0.0, side.sign * lowered, 0.0]);
        self.turn(side.shoulder, [back, 0.0, 0.0]);
        self.turn(side.elbow, [0.0, 0.0, -side.sign * bent]);
    }

    /// A leg lifted to the front and to its side, bent at the knee; the foot stays half level (rad).
    fn leg(&mut self, side: &Side, front: f64, out: f64, bent: f64) {
        self.turn(side.hip, [0.0, -side.sign * out, 0.0]);
        self.turn(side.hip, [-front, 0.0, 0.0]);
        self.turn(side.knee, [bent, 0.0, 0.0]);
        self.turn(side.ankle, [0.5 * (front - bent), 0.0, 0.0]);
    }
}

fn about_z(angle: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle)
}

/// A swell from 0 to 1 and back over half a cycle, 0 over the other half, twice differentiable.
fn swell(c: f64) -> f64 {
    c.sin().max(0.0).powi(3)
}

fn walk(angles: &mut Angles, c: f64, wide: f64, turns: f64) -> Isometry3<f64> {
    let swing = 0.40 * wide;
    for (side, c) in [(&LEFT, c), (&RIGHT, c + PI)] {
        // The knee bends while the leg swings to the front.
        let bent = 0.12 + 0.55 * (0.5 + 0.5 * c.cos()).powi(2);
        angles.leg(side, swing * c.sin() + 0.04, 0.0, bent);
        angles.arm(side, 1.0, 0.9 * swing * c.sin(), 0.35);
    }
    angles.turn(Joint::Pelvis, [0.03, 0.04 * c.cos(), -0.10 * c.sin()]);
    angles.turn(Joint::Spine, [0.0, -0.04 * c.cos(), 0.10 * c.sin()]);
    angles.turn(Joint::Chest, [0.0, 0.0, 0.10 * c.sin()]);
    // Two steps a cycle, each as long as the legs of 0.88 m reach.
    let way = turns * 4.0 * 0.88 * swing.sin();
    let turned = way / WALK_RADIUS;
    // It looks along −y, so the middle of the circle is at its left, where x > 0.
    let centre = Vector3::new(WALK_RADIUS, 0.0, 0.0);
    let at = about_z(turned);
    Isometry3::from_parts(Translation3::from(centre - at * centre), at)
}

fn turn(angles: &mut Angles, c: f64, wide: f64, turns: f64, phase: f64) -> Isometry3<f64> {
    for (side, c) in [(&LEFT, c), (&RIGHT, c + PI)] {
        let lift = swell(c);
        angles.leg(side, 0.25 * lift, 0.12 + 0.10 * lift, 0.12 + 0.45 * lift);
        angles.arm(side, 0.35 + 0.25 * wide * c.cos(), -0.15, 0.35);
    }
    angles.turn(Joint::Spine, [0.05 * c.sin(), 0.06 * c.cos(), 0.0]);
    angles.turn(Joint::Chest, [-0.06, 0.0, 0.12 * c.sin()]);
    // Not at an even rate: about a fifth faster and slower.
    let start = (TAU * phase).sin();
    let turned = TAU * turns + 0.2 * (c.sin() - start);
    Isometry3::from_parts(Translation3::identity(), about_z(turned))
}

fn kick(angles: &mut Angles, c: f64, wide: f64) -> Isometry3<f64> {
    for (side, c) in [(&LEFT, c), (&RIGHT, c + PI)] {
        // First the knee comes up bent, then the leg stretches.
        angles.leg(side, 0.12 + 0.85 * wide * swell(c), 0.10, 0.25 + 0.8 * swell(c + 0.6));
        angles.arm(side, 0.95, -0.35 + 0.25 * c.sin(), 0.75);
    }
    let kicks = swell(c) + swell(c + PI);
    angles.turn(Joint::Pelvis, [-0.08 * kicks, 0.0, -0.12 * c.sin()]);
    angles.turn(Joint::Spine, [0.06, 0.0, 0.10 * c.sin()]);
    angles.turn(Joint::Chest, [0.06, 0.0, 0.12 * c.sin()]);
    Isometry3::identity()
}

fn dance(angles: &mut Angles, c: f64, c0: f64, wide: f64, chance: [f64; 3]) -> Isometry3<f64> {
    for (side, c) in [(&LEFT, c), (&RIGHT, c + PI)] {
        let (lift, bounce) = (swell(c), 0.5 + 0.5 * (4.0 * c).cos());
        let bent = 0.15 + 0.14 * bounce + 0.35 * lift;
        angles.leg(side, 0.5 * bent + 0.12 * lift, 0.12 + 0.14 * wide * lift, bent);
        let lowered = 0.55 + 0.35 * wide * (c + chance[0]).sin();
        angles.arm(side, lowered, 0.30 * (2.0 * c + chance[1]).sin(), 0.45 + 0.25 * c.cos());
    }
    angles.turn(Joint::Pelvis, [0.0, 0.06 * (2.0 * c).sin(), 0.25 * c.sin()]);
    angles.turn(Joint::Spine, [0.04, -0.05 * (2.0 * c).sin(), -0.10 * (c + chance[2]).sin()]);
    angles.turn(Joint::Chest, [0.03 * c.cos(), -0.04 * (2.0 * c).sin(), -0.10 * c.sin()]);
    angles.turn(Joint::Head, [0.05, 0.0, 0.25 * c.sin()]);
    // The floor is crossed and turned upon, from where it began.
    let path = |c: f64| Vector3::new(0.16 * c.sin(), 0.10 * (2.0 * c).sin(), 0.0);
    let turned = 0.9 * wide * (c.sin() - c0.sin());
    Isometry3::from_parts(Translation3::from(path(c) - path(c0)), about_z(turned))
}
