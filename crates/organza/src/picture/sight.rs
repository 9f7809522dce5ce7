//! What the cameras of a scene see of recorded frames.

use std::fs::File;
use std::path::Path;

use io_mcap::{OwnedFrame, OwnedGarment, Recording};
use mesh_core::{ClothState, Material2, Mesh, World3};
use sizing_view::{CameraPath, Frustum, ViewFactors, ViewSettings, window};

use super::PictureError;
use crate::record::scene_of;

/// The cameras of a recorded scene, with its constants of sizing by view, or the usual ones where it has
/// none. What stands in the way is not looked at.
#[derive(Clone, Debug)]
pub struct Sight {
    /// That of the scene first.
    paths: Vec<CameraPath>,
    settings: ViewSettings,
    frame_s: f64,
}

/// How a triangle is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Seen {
    Front,
    Back,
    Outside,
}

impl Sight {
    /// The cameras of the scene of the recording at `path`.
    ///
    /// # Errors
    /// The scene cannot be read, or has no camera.
    pub(super) fn of(recording: &mut Recording<File>, path: &Path) -> Result<Sight, PictureError> {
        let scene = scene_of(recording, path)?.scene;
        let no_camera = || PictureError::NoCamera { path: path.to_owned(), frame: 0 };
        let mut paths = vec![scene.camera_path.clone().ok_or_else(no_camera)?];
        let frame_s = scene.frame_s();
        let mut settings = ViewSettings::default();
        if let Some(view) = scene.view {
            settings = view.settings;
            paths.extend(view.more_cameras);
        }
        Ok(Sight { paths, settings, frame_s })
    }

    /// The view factor of every triangle (1); not a number where the mesh is none.
    pub(super) fn factors(&self, garment: &OwnedGarment, frame: u64) -> Vec<f64> {
        let time = frame as f64 * self.frame_s;
        let windows =
            self.paths.iter().map(|path| window(path, time, self.frame_s, &self.settings));
        let samples: Vec<_> = windows.flatten().collect();
        let cloth = cloth(garment);
        let factors = cloth.and_then(|c| ViewFactors::evaluate(&c, &samples, &self.settings).ok());
        factors.map_or_else(
            || vec![f64::NAN; garment.triangles.len()],
            |factors| factors.values().to_vec(),
        )
    }

    /// How the scene's camera sees every triangle now.
    pub(super) fn seen(&self, garment: &OwnedGarment, frame: u64) -> Vec<Seen> {
        let frustum = Frustum::new(&self.paths[0].at(frame as f64 * self.frame_s));
        let of = |t: &[u32; 3]| {
            let corners = t.map(|v| World3::from(garment.points[v as usize]));
            if frustum.distance(&corners) > 0.0 {
                return Seen::Outside;
            }
            let [a, b, c] = corners.map(|x| frustum.camera_space(x));
            if (b - a).cross(&(c - a)).dot(&a) > 0.0 { Seen::Back } else { Seen::Front }
        };
        garment.triangles.iter().map(of).collect()
    }

    /// The edges of the frustum of the scene's camera, as far as the middle of the cloth and a little
    /// farther (m).
    pub(super) fn frustum(&self, frame: &OwnedFrame) -> Vec<[[f64; 3]; 2]> {
        let camera = self.paths[0].at(frame.index as f64 * self.frame_s);
        let points = || frame.garments.iter().flat_map(|g| &g.points).map(|x| World3::from(*x));
        let n = points().count().max(1) as f64;
        let middle = points().sum::<World3>() / n;
        let depth = 1.3 * (middle - camera.position()).norm();
        let [width, height] =
            camera.resolution().map(|side| 0.5 * f64::from(side) / camera.focal_px());
        let corner = |x: f64, y: f64| {
            let way = World3::new(x * width, y * height, 1.0) * depth;
            camera.position() + camera.world_from_camera() * way
        };
        let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
        let line = |a: World3, b: World3| [a.into(), b.into()];
        (0..4)
            .flat_map(|k| {
                [line(camera.position(), corners[k]), line(corners[k], corners[(k + 1) % 4])]
            })
            .collect()
    }
}

/// A recorded garment as cloth; none if its mesh is not valid.
fn cloth(garment: &OwnedGarment) -> Option<ClothState> {
    let material = garment.material.iter().map(|u| u.map(Material2::from)).collect();
    let panels = vec![0; garment.triangles.len()];
    let mesh = Mesh::new(garment.points.len(), garment.triangles.clone(), material, panels).ok()?;
    let points = garment.points.iter().map(|x| World3::from(*x)).collect();
    ClothState::at_rest(mesh, points, vec![1.0]).ok()
}
