//! What lies behind the scene: a soft light gradient, and a floor that only shows its shadow.

use super::Size;
use super::colour::{Light, mix, scale, smoothstep};
use super::lens::Lens;
use super::shade::Lights;
use super::shadow::SoftShadow;

const TOP: Light = [0.73, 0.77, 0.81];
const BOTTOM: Light = [0.88, 0.88, 0.87];
/// Part of the light that the floor loses in full shadow.
const SHADOW: f32 = 0.42;

/// Light of the backdrop at a place in the picture (px).
pub(super) fn light(size: Size, [column, row]: [f64; 2]) -> Light {
    let (width, height) = (f64::from(size.width), f64::from(size.height));
    let down = smoothstep(0.0, 1.0, (row / height) as f32);
    let (x, y) = (2.0 * column / width - 1.0, 2.0 * row / height - 1.0);
    let vignette = 1.0 - 0.09 * (x * x + y * y) as f32;
    scale(mix(TOP, BOTTOM, down), vignette)
}

/// A level floor in eye space.
pub(super) struct Floor {
    /// Its height along the world's up, from the eye; negative, since it lies below.
    level: f64,
    soft: SoftShadow,
}

impl Floor {
    /// A floor at `height` along the world's up (m); `None` if the eye is below, or if the light
    /// comes from below.
    pub(super) fn new(lens: &Lens, lights: &Lights, height: f64) -> Option<Self> {
        let level = lens.level(height);
        let soft = SoftShadow::new(lights.shadow()?);
        (level < 0.0 && lens.up.dot(&Lights::key()) > 0.1).then_some(Self { level, soft })
    }

    /// Part of the backdrop's light that is left at a place in the picture (px).
    pub(super) fn lit(&self, lens: &Lens, [column, row]: [f64; 2]) -> f32 {
        let ray = lens.ray(column, row);
        let fall = lens.up.dot(&ray);
        if fall >= 0.0 {
            return 1.0;
        }
        let depth = self.level / fall;
        // The floor fades with distance, so that it has no horizon.
        let fade = 1.0 - smoothstep(1.5, 4.0, depth as f32);
        1.0 - SHADOW * fade * self.soft.cover(ray * depth)
    }
}
