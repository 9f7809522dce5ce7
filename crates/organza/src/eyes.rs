//! What the cameras of a scene see in the next frames, and what stands in their way.

use crate::obstacle::Obstacle;
use crate::scene::{Scene, View};
use mesh_core::{ClothState, par};
use sizing_view::{CameraPath, DepthBuffer, Sample, ViewSettings, window};

/// Rows of the pictures in which occlusion is found: hands are wider than their pixels.
const DEPTH_ROWS: u32 = 180;
/// Thickness of garments with their folds, which is not told hidden from seen (m).
const LAYERS: f64 = 0.02;

/// No camera is guessed farther ahead; it stays there (frames).
const MOST_FRAMES: f64 = 1000.0;

/// The cameras of a scene.
pub(crate) struct Eyes {
    /// All of them, that of the scene first.
    paths: Vec<CameraPath>,
    settings: ViewSettings,
    occlusion: bool,
    /// Their future is guessed from their past.
    predicted: bool,
    /// Surfaces nearer to each other than this do not hide each other (m).
    thickness: f64,
    frame_s: f64,
}

impl Eyes {
    /// Those of a scene, which look in a way; none if it has no camera.
    pub(crate) fn new(scene: &Scene, view: &View) -> Option<Eyes> {
        let paths = std::iter::once(scene.camera_path.clone()?).chain(view.more_cameras.clone());
        Some(Eyes {
            paths: paths.collect(),
            settings: view.settings,
            occlusion: view.occlusion,
            predicted: view.predicted,
            thickness: LAYERS.max(2.0 * scene.contact.map_or(0.0, |contact| contact.thickness)),
            frame_s: scene.frame_s(),
        })
    }

    /// The same with a window of at least so many frames (1).
    pub(crate) fn ahead(mut self, frames: f64) -> Eyes {
        self.settings.window = self.settings.window.max(frames);
        self
    }

    /// The constants.
    pub(crate) fn settings(&self) -> &ViewSettings {
        &self.settings
    }

    /// Time from frame to frame (s).
    pub(crate) fn frame_s(&self) -> f64 {
        self.frame_s
    }

    /// The windows of all cameras at a time (s), with what stands in their way if that is to count.
    pub(crate) fn samples(
        &self,
        cloth: &ClothState,
        time: f64,
        obstacles: &[Obstacle],
    ) -> Vec<Sample> {
        let windows = self.paths.iter().map(|path| {
            let guess = self.predicted.then(|| {
                let frames = self.settings.window.min(MOST_FRAMES);
                let guess = path.foreseen(time, self.frame_s, frames);
                guess.expect("the scene's cameras have been checked")
            });
            window(guess.as_ref().unwrap_or(path), time, self.frame_s, &self.settings)
        });
        let mut samples: Vec<Sample> = windows.flatten().collect();
        if self.occlusion {
            let depths = self.depths(cloth, time, obstacles, &samples);
            for (sample, depth) in samples.iter_mut().zip(depths) {
                sample.depth = depth;
            }
        }
        samples
    }

    /// What stands in the way of every sample: cloth and obstacles where they are now, as the cloth is
    /// held fixed over the window (Koh2014 Eq. (4)). None for cameras that have no depth buffer.
    fn depths(
        &self,
        cloth: &ClothState,
        time: f64,
        obstacles: &[Obstacle],
        samples: &[Sample],
    ) -> Vec<Option<DepthBuffer>> {
        let there = obstacles.iter().filter(|obstacle| obstacle.is_there(time));
        let bodies: Vec<_> = there.map(|o| (&o.triangles, o.positions(time))).collect();
        let mut depths = vec![None; samples.len()];
        par::fill(&mut depths, |k| {
            let mut depth =
                DepthBuffer::new(&samples[k].camera, DEPTH_ROWS, self.thickness).ok()?;
            cloth.mesh.triangle_ids().for_each(|t| depth.draw(&cloth.corners(t)));
            for (triangles, x) in &bodies {
                triangles.iter().for_each(|t| depth.draw(&t.map(|v| x[v as usize])));
            }
            Some(depth)
        });
        depths
    }
}
