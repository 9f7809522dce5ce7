//! The pinhole camera.

use crate::error::{ViewError, check};
use mesh_core::World3;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

/// A pinhole camera. Camera space has its origin at the pinhole and its axes to the right of the
/// picture, down, and forward; a point (x, y, z) there is seen (f x/z, f y/z) from the middle of the
/// picture, with the focal length f in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    position: World3,
    world_from_camera: UnitQuaternion<f64>,
    focal_px: f64,
    resolution: [u32; 2],
    near: f64,
}

/// Coordinates beyond this are taken for broken (m): their squares and products would overflow.
const FARTHEST: f64 = 1e60;

impl Camera {
    /// Nearest depth of a camera that was not told otherwise (m).
    pub const NEAR: f64 = 0.01;

    /// A camera at `position` (m) with the axes `world_from_camera` (right, down, forward), a focal
    /// length (px) and the width and height of its picture (px).
    ///
    /// # Errors
    /// If a number is out of range.
    pub fn new(
        position: World3,
        world_from_camera: UnitQuaternion<f64>,
        focal_px: f64,
        resolution: [u32; 2],
    ) -> Result<Camera, ViewError> {
        let far = position.iter().chain(world_from_camera.coords.iter());
        for &value in far {
            check("a coordinate of the camera", value, "finite and of size up to 1e60", |x| {
                x.abs() <= FARTHEST
            })?;
        }
        for (name, side) in [("the width", resolution[0]), ("the height", resolution[1])] {
            check(name, f64::from(side), "at least 1 (px)", |side| side >= 1.0)?;
        }
        check("the focal length", focal_px, "above 0 and finite (px)", |f| {
            f > 0.0 && f.is_finite() && (1.0 / f).is_finite()
        })?;
        Ok(Camera { position, world_from_camera, focal_px, resolution, near: Camera::NEAR })
    }

    /// A camera at `position` (m) that sees `target` (m) in the middle of its picture, with `up`
    /// pointing up in it (any length; another axis takes its place if the camera looks along it),
    /// an angle between the lower and the upper edge (rad), and width and height (px).
    ///
    /// # Errors
    /// If a number is out of range or the target is where the camera is.
    pub fn looking_at(
        position: World3,
        target: World3,
        up: World3,
        vertical_fov: f64,
        resolution: [u32; 2],
    ) -> Result<Camera, ViewError> {
        check("the field of view", vertical_fov, "above 0 and below π (rad)", |angle| {
            angle > 0.0 && angle < std::f64::consts::PI
        })?;
        let no_direction =
            || ViewError::NoDirection { position: position.into(), target: target.into() };
        let forward = direction(target - position).ok_or_else(no_direction)?;
        let up = direction(up).unwrap_or(World3::z());
        let right = [up, World3::z(), World3::y()]
            .into_iter()
            .map(|up| forward.cross(&up))
            .find(|right| right.norm() > 1e-6)
            .ok_or_else(no_direction)?
            .normalize();
        let axes = Matrix3::from_columns(&[right, forward.cross(&right), forward]);
        let rotation =
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        let focal_px = 0.5 * f64::from(resolution[1]) / (0.5 * vertical_fov).tan();
        Camera::new(position, rotation, focal_px, resolution)
    }

    /// The same camera with another nearest depth (m): nothing nearer is seen, and sizes in pixels
    /// are worked out as if nothing were nearer.
    ///
    /// # Errors
    /// If it is not above zero and finite.
    pub fn with_near(self, near: f64) -> Result<Camera, ViewError> {
        check("the nearest depth", near, "above 0 and up to 1e60 (m)", |near| {
            near > 0.0 && near <= FARTHEST && (1.0 / near).is_finite()
        })?;
        Ok(Camera { near, ..self })
    }

    /// Where the camera stands (m).
    pub fn position(&self) -> World3 {
        self.position
    }

    /// The axes of the camera in the world: right, down, forward.
    pub fn world_from_camera(&self) -> UnitQuaternion<f64> {
        self.world_from_camera
    }

    /// Focal length (px).
    pub fn focal_px(&self) -> f64 {
        self.focal_px
    }

    /// Width and height of the picture (px).
    pub fn resolution(&self) -> [u32; 2] {
        self.resolution
    }

    /// Nearest depth (m).
    pub fn near(&self) -> f64 {
        self.near
    }

    /// Slopes x/z and y/z of the picture's edges in camera space (1).
    pub(crate) fn slopes(&self) -> [f64; 2] {
        self.resolution.map(|side| 0.5 * f64::from(side) / self.focal_px)
    }

    /// The way from this camera to another, `share` of it done: straight on for the position and
    /// the focal length in picture heights, about one axis for the rotation. The resolution and the
    /// nearest depth are this camera's.
    pub(crate) fn towards(&self, other: &Camera, share: f64) -> Camera {
        let heights = |c: &Camera| c.focal_px / f64::from(c.resolution[1]);
        let focal = heights(self) + (heights(other) - heights(self)) * share;
        let turn = self.world_from_camera.rotation_to(&other.world_from_camera);
        Camera {
            position: self.position + (other.position - self.position) * share,
            world_from_camera: turn.powf(share) * self.world_from_camera,
            focal_px: focal * f64::from(self.resolution[1]),
            ..*self
        }
    }
}

/// Unit vector along `v`, if it has a direction.
fn direction(v: World3) -> Option<World3> {
    // Divided first by its largest part, since the square of a very long or short vector would
    // overflow or vanish.
    let largest = v.amax();
    (largest > 0.0 && v.iter().all(|x| x.is_finite())).then(|| (v / largest).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_right_down_forward() {
        let y = World3::y();
        let camera = Camera::looking_at(y * -5.0, World3::zeros(), World3::z(), 1.0, [4, 3]);
        let axes = camera.unwrap().world_from_camera();
        for (axis, expected) in
            [(World3::x(), World3::x()), (World3::y(), -World3::z()), (World3::z(), y)]
        {
            assert!((axes * axis - expected).norm() < 1e-15);
        }
    }

    #[test]
    fn bad_numbers_are_named() {
        let (o, z) = (World3::zeros(), World3::z());
        let look = |at, to, fov, size| Camera::looking_at(at, to, z, fov, size);
        let message = |camera: Result<Camera, ViewError>| camera.unwrap_err().to_string();
        assert!(message(look(o, z, 0.0, [1, 1])).contains("field of view is 0"));
        assert!(message(look(o, z, f64::NAN, [1, 1])).contains("field of view"));
        assert!(message(look(o, z, 1.0, [1, 0])).contains("height is 0"));
        assert!(message(look(o, o, 1.0, [1, 1])).contains("no direction"));
        assert!(message(look(o * f64::NAN, z, 1.0, [1, 1])).contains("no direction"));
        // Along up is allowed.
        let camera = look(o, z, 1.0, [1, 1]).unwrap();
        assert!((camera.world_from_camera() * z - z).norm() < 1e-15);
        assert!(message(camera.with_near(0.0)).contains("nearest depth is 0"));
    }
}
