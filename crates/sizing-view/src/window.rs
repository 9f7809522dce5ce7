//! What the cameras of the next frames see: the samples of the temporal window.

use crate::camera::Camera;
use crate::depth::DepthBuffer;
use crate::path::CameraPath;
use crate::settings::ViewSettings;
use mesh_core::World3;

/// A camera with its weight in the temporal window.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// w(τ), from 0 to 1 (1).
    pub weight: f64,
    /// The camera at t + τ.
    pub camera: Camera,
    /// What stands in the way of this camera, if that is to count. Without it everything inside the
    /// frustum that faces the camera is visible.
    pub depth: Option<DepthBuffer>,
}

impl Sample {
    /// A camera of full weight with a free view.
    pub fn new(camera: Camera) -> Sample {
        Sample { weight: 1.0, camera, depth: None }
    }

    /// v_fb of Koh2014 Eq. (3): the view factor of a triangle, `c` in camera space (m), in the picture.
    #[inline]
    pub(crate) fn factor(
        &self,
        corners: &[World3; 3],
        c: &[World3; 3],
        settings: &ViewSettings,
    ) -> f64 {
        let fits = if is_back_facing(c) { settings.v_back } else { 1.0 };
        let hidden = self.depth.as_ref().is_some_and(|depth| depth.hides(corners));
        if hidden { settings.v_hidden.min(fits) } else { fits }
    }
}

/// True if the normal of a triangle in camera space points away from the camera.
#[inline]
fn is_back_facing([a, b, c]: &[World3; 3]) -> bool {
    (b - a).cross(&(c - a)).dot(a) > 0.0
}

/// The cameras that decide about resolution at time `time` (s): those of the frames `frame` seconds
/// apart in the window [t, t + T) of Koh2014 Eq. (4) with T = `settings.window` frames and w(τ) = 1 −
/// τ/T, and those on both sides of every cut inside it, so that the view factor rises without a jump
/// before every cut. The heaviest comes first; a camera that does not move is listed once.
///
/// Several cameras at once are several windows, one after the other in one list: the finest wins.
///
/// `frame` must be positive; the list holds the camera of `time` alone if it is not.
pub fn window(path: &CameraPath, time: f64, frame: f64, settings: &ViewSettings) -> Vec<Sample> {
    let length = settings.window * frame;
    let mut all = vec![(1.0, path.at(time))];
    if length > 0.0 && length.is_finite() {
        let frames = (1..).map(f64::from).take_while(|&k| k < settings.window);
        all.extend(frames.map(|k| (1.0 - k / settings.window, path.at(time + k * frame))));
        for (cut, sides) in path.cuts(time, time + length) {
            all.extend(sides.map(|camera| (1.0 - (cut - time) / length, camera)));
        }
    }
    // Stable, so that equal weights stay in the order of time.
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut samples: Vec<Sample> = Vec::with_capacity(all.len());
    for (weight, camera) in all {
        if samples.iter().all(|s| s.camera != camera) {
            samples.push(Sample { weight, ..Sample::new(camera) });
        }
    }
    samples
}
