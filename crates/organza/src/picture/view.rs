//! Where a picture of a frame is taken from.

use io_mcap::OwnedFrame;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::{DEFAULT_SIZE, PictureOptions};
use crate::render::{Bounds, Size, Viewpoint};

/// Where pictures are taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// Through the camera of the scene.
    Camera,
    /// From outside, so that everything is seen.
    Outside,
}

/// The viewpoint and size of a picture of `frame`; `points` (m) are what the view from outside
/// shows, and `up` is the direction against gravity. `None` for the view through a camera that is
/// not there.
pub fn viewpoint<I>(
    frame: &OwnedFrame,
    points: I,
    up: [f64; 3],
    options: &PictureOptions,
) -> Option<(Viewpoint, Size)>
where
    I: IntoIterator<Item = [f64; 3]>,
    I::IntoIter: Clone,
{
    let own_size = frame.camera.map(|camera| Size::new(camera.width_px, camera.height_px));
    let size = options.size.or(own_size).unwrap_or(DEFAULT_SIZE);
    match (options.view, &frame.camera) {
        (Some(View::Camera), None) => None,
        (Some(View::Camera) | None, Some(camera)) => Some((through(camera, frame), size)),
        (Some(View::Outside), _) | (None, None) => Some((Viewpoint::fit(points, up, size), size)),
    }
}

/// The view through a recorded camera.
fn through(camera: &io_mcap::Camera, frame: &OwnedFrame) -> Viewpoint {
    let rotation = UnitQuaternion::new_normalize(Quaternion::from(camera.rotation));
    let eye = Vector3::from(camera.position);
    let forward = rotation * Vector3::z();
    // The distance of the target decides how near things are still drawn: that of cloth and fluid.
    let cloth = frame.garments.iter().flat_map(|g| g.points.iter().copied());
    let fluid = frame.fluid.iter().flatten().map(|particle| particle.position);
    let bounds = Bounds::of(cloth.chain(fluid));
    let middle = 0.5 * (Vector3::from(bounds.min) + Vector3::from(bounds.max));
    let distance = (middle - eye).norm();
    let distance = if bounds.is_empty() || distance == 0.0 { 1.0 } else { distance };
    Viewpoint {
        eye: camera.position,
        target: (eye + forward * distance).into(),
        up: (rotation * -Vector3::y()).into(),
        vertical_fov: 2.0 * (0.5 * f64::from(camera.height_px) / camera.focal_px[1]).atan(),
    }
}
