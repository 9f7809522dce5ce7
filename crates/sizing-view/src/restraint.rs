//! Restraint by what cameras see: thresholds of rest in pixels per frame.

use crate::error::{ViewError, check};
use crate::frustum::Frustum;
use crate::settings::ViewSettings;
use crate::window::Sample;
use arps::{Automatic, Held, Law, Particle, Restraint, Speed, ThresholdError};
use mesh_core::{World3, par};

/// For every position of any particles (m) the speed that shows as one pixel per frame (m/s), the
/// least over all cameras of a [`window`](crate::window()), `frame` seconds from frame to frame.
///
/// A particle in the picture moves by no more than a pixel in a frame at that speed, whatever its
/// direction. The speed is divided by the view factor of Koh2014 Eq. (3) at the particle: farther than
/// the margin outside of the picture by `v_out`, and by `v_hidden` behind something, where samples have
/// a [`DepthBuffer`](crate::DepthBuffer). Particles have no sides: `v_back` does not count. A sample
/// counts in full whatever its weight in the window. So what will come into the picture is as little
/// restrained as if it were there already, and nothing wakes late at a cut. Where a position is not a
/// number the speed is 0: nothing rests.
///
/// # Errors
/// If a setting is out of range, `frame` is not positive and finite, or there is no sample.
pub fn pixel_speeds(
    positions: &[World3],
    samples: &[Sample],
    frame: f64,
    settings: &ViewSettings,
) -> Result<Vec<f64>, ViewError> {
    settings.check()?;
    check("the time from frame to frame", frame, "above 0 and finite (s)", |frame| {
        frame > 0.0 && frame < f64::INFINITY
    })?;
    if samples.is_empty() {
        return Err(ViewError::NoCamera);
    }
    let eyes: Vec<Eye<'_>> = samples.iter().map(|sample| Eye::new(sample, settings)).collect();
    let mut speeds = vec![0.0; positions.len()];
    par::fill(&mut speeds, |i| {
        let of = |eye: &Eye<'_>| eye.metres_per_pixel(&positions[i]) / frame;
        let least = eyes.iter().map(of).fold(f64::INFINITY, f64::min);
        if positions[i].iter().all(|x| x.is_finite()) { least } else { 0.0 }
    });
    Ok(speeds)
}

/// One camera.
struct Eye<'a> {
    sample: &'a Sample,
    frustum: Frustum,
    settings: &'a ViewSettings,
    /// Cosine of the angle between the view and the corners of the picture.
    cos_corner: f64,
}

impl<'a> Eye<'a> {
    fn new(sample: &'a Sample, settings: &'a ViewSettings) -> Eye<'a> {
        let [sx, sy] = sample.camera.slopes();
        let cos_corner = 1.0 / (1.0 + sx * sx + sy * sy).sqrt();
        Eye { sample, frustum: Frustum::new(&sample.camera), settings, cos_corner }
    }

    /// How far a particle may go for a pixel, over its view factor (m).
    fn metres_per_pixel(&self, x: &World3) -> f64 {
        let camera = &self.sample.camera;
        let c = self.frustum.camera_space(*x);
        let range = c.norm().max(camera.near());
        // The picture of a point moves fastest, by f |c|/z² = f/(|c| cos²), where the point moves
        // away from the middle. Outside of the picture this goes on with the angle of its corners.
        let cosine = (c.z / range).max(self.cos_corner);
        let metres = range * cosine * cosine / camera.focal_px();
        let distance = self.frustum.distance_to_point(&c);
        let hides = |depth: &crate::DepthBuffer| depth.hides(&[*x; 3]);
        let hidden = self.sample.depth.as_ref().is_some_and(hides);
        let factor = if hidden { self.settings.v_hidden } else { 1.0 };
        metres / self.settings.smoothed(factor, distance)
    }
}

/// Thresholds in pixels per frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelThresholds {
    /// Thresholds as they are where a pixel per frame is 1 m/s.
    thresholds: Speed,
    most: f64,
}

impl PixelThresholds {
    /// Rest up to `rest` and full dynamics from `full` on (pixels per frame). Nothing rests above `most`
    /// (m/s), however far it is outside of the picture: what is out of sight may still be in the way of
    /// something.
    ///
    /// # Errors
    /// Thresholds that [`Held::new`] refuses for this law, and a `most` that is negative or not a number.
    pub fn new(law: Law, rest: f64, full: f64, most: f64) -> Result<Self, ThresholdError> {
        if most.is_nan() || most < 0.0 {
            return Err(ThresholdError::Value { which: "most", value: most, unit: "m/s" });
        }
        Ok(PixelThresholds { thresholds: Speed::with_law(law, rest, full)?, most })
    }

    /// Thresholds that move what shows by at most `error` pixels over so many frames, as
    /// [`Automatic::for_error`] says, with a frame for the unit of time; nothing rests above `most` (m/s).
    ///
    /// # Errors
    /// An error that is negative or not a number, no frames, and as [`PixelThresholds::new`].
    pub fn for_error(law: Law, error: f64, frames: f64, most: f64) -> Result<Self, ThresholdError> {
        let speed = Automatic::for_error(error, frames)?.speed;
        PixelThresholds::new(law, speed.v_r(), speed.v_f(), most)
    }

    /// Pixels per frame up to which a particle rests.
    pub fn rest(&self) -> f64 {
        self.thresholds.v_r()
    }

    /// The restrained kinetic energy of a particle for which a pixel per frame is `pixel_speed` (m/s);
    /// see [`pixel_speeds`].
    #[inline]
    pub fn at(&self, particle: &Particle, pixel_speed: f64) -> Held {
        let least = self.most / self.thresholds.v_r();
        let scale = if least < pixel_speed { least } else { pixel_speed };
        self.thresholds.at(particle).scaled(scale)
    }
}

/// The policy of particles that are seen by cameras: [`PixelThresholds`] with the [`pixel_speeds`] of
/// a list of particles, to be made anew once per frame.
///
/// It asks neither where particles are later in the frame nor when, so it is steady as long as it lives.
/// Particles beyond the list are not restrained.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewRestraint {
    /// The thresholds.
    pub thresholds: PixelThresholds,
    /// Speed of a pixel per frame, by the index of the particle (m/s).
    pub pixel_speeds: Vec<f64>,
}

impl Restraint for ViewRestraint {
    #[inline]
    fn at(&self, particle: &Particle) -> Held {
        let speed = self.pixel_speeds.get(particle.index).copied().unwrap_or(0.0);
        self.thresholds.at(particle, speed)
    }

    fn is_steady(&self) -> bool {
        true
    }
}
