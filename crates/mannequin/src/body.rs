//! The shape of the body: capsules blended into one smooth solid.
//!
//! The body stands upright with its arms level, on the plane z = 0, 1.7 m tall; it looks along −y,
//! and its left arm points along x.

use mesh_core::World3;

/// A cone with round ends.
#[derive(Clone, Copy, Debug)]
struct Part {
    ends: [[f64; 3]; 2],
    /// Radius at each end (m).
    radii: [f64; 2],
}

const fn part(a: [f64; 3], b: [f64; 3], ra: f64, rb: f64) -> Part {
    Part { ends: [a, b], radii: [ra, rb] }
}

/// Trunk and head, which are their own mirror images.
const TRUNK: [Part; 7] = [
    // Hips, waist, ribs, chest, shoulders.
    part([-0.055, 0.005, 0.94], [0.055, 0.005, 0.94], 0.104, 0.104),
    part([-0.048, 0.0, 1.08], [0.048, 0.0, 1.08], 0.070, 0.070),
    part([-0.055, 0.0, 1.20], [0.055, 0.0, 1.20], 0.076, 0.076),
    part([-0.065, -0.008, 1.30], [0.065, -0.008, 1.30], 0.086, 0.086),
    part([-0.135, 0.0, 1.415], [0.135, 0.0, 1.415], 0.050, 0.050),
    // Neck and head.
    part([0.0, 0.0, 1.42], [0.0, -0.005, 1.53], 0.046, 0.044),
    part([0.0, -0.01, 1.585], [0.0, -0.015, 1.64], 0.066, 0.072),
];

/// Limbs of the side x > 0.
const LIMBS: [Part; 6] = [
    // Upper arm, forearm, hand.
    part([0.16, 0.0, 1.41], [0.43, 0.0, 1.41], 0.044, 0.035),
    part([0.43, 0.0, 1.41], [0.67, 0.0, 1.41], 0.036, 0.032),
    part([0.69, 0.0, 1.41], [0.78, 0.0, 1.41], 0.031, 0.028),
    // Thigh, shank, foot.
    part([0.095, 0.0, 0.88], [0.112, 0.0, 0.50], 0.078, 0.048),
    part([0.112, 0.0, 0.50], [0.122, 0.0, 0.09], 0.048, 0.037),
    part([0.122, 0.01, 0.045], [0.130, -0.125, 0.035], 0.037, 0.032),
];

/// Width of the blends (m).
const BLEND: f64 = 0.013;

/// A box around the body (m).
pub(crate) const BOUNDS: [[f64; 3]; 2] = [[-0.86, -0.22, -0.05], [0.86, 0.17, 1.78]];

impl Part {
    /// Distance to the surface, negative inside; not exact where the radii differ (m).
    fn distance(&self, x: &World3) -> f64 {
        let [a, b] = self.ends.map(World3::from);
        let axis = b - a;
        let s = ((x - a).dot(&axis) / axis.norm_squared()).clamp(0.0, 1.0);
        (x - a - axis * s).norm() - (self.radii[0] + (self.radii[1] - self.radii[0]) * s)
    }
}

/// About the distance to the surface of the body, negative inside: the smooth minimum −k ln Σ e^(−d/k)
/// over the parts (m).
pub fn distance(x: &World3) -> f64 {
    let mirrored = World3::new(-x.x, x.y, x.z);
    let trunk = TRUNK.iter().map(|part| part.distance(x));
    let limbs = LIMBS.iter().flat_map(|part| [part.distance(x), part.distance(&mirrored)]);
    let all: Vec<f64> = trunk.chain(limbs).collect();
    let least = all.iter().copied().fold(f64::INFINITY, f64::min);
    least - BLEND * all.iter().map(|d| (-(d - least) / BLEND).exp()).sum::<f64>().ln()
}

/// Gradient of [`distance`] by central differences (1).
pub(crate) fn gradient(x: &World3) -> World3 {
    const STEP: f64 = 1e-5;
    World3::from_fn(|k, _| {
        let mut step = World3::zeros();
        step[k] = STEP;
        (distance(&(x + step)) - distance(&(x - step))) / (2.0 * STEP)
    })
}
