//! The camera of a scene as recordings hold it.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

use crate::scene::format;

/// The pinhole camera of a scene whose direction against gravity is `up`.
pub fn camera(camera: &format::Camera, up: [f64; 3]) -> io_mcap::Camera {
    let vector = Vector3::from;
    let forward = (vector(camera.target) - vector(camera.position)).normalize();
    let right = forward.cross(&vector(camera.up.unwrap_or(up))).normalize();
    let down = forward.cross(&right);
    let axes = Matrix3::from_columns(&[right, down, forward]);
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    let [width, height] = camera.resolution.map(f64::from);
    let focal = 0.5 * height / (0.5 * camera.vertical_fov_deg.to_radians()).tan();
    io_mcap::Camera {
        width_px: camera.resolution[0],
        height_px: camera.resolution[1],
        focal_px: [focal; 2],
        center_px: [0.5 * width, 0.5 * height],
        position: camera.position,
        rotation: rotation.coords.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Quaternion;

    #[test]
    fn axes_are_right_down_forward() {
        let scene = format::Camera {
            position: [1.0, -5.0, 2.0],
            target: [1.0, 0.0, 2.0],
            up: None,
            vertical_fov_deg: 90.0,
            resolution: [640, 480],
        };
        let recorded = camera(&scene, [0.0, 0.0, 1.0]);
        let q = UnitQuaternion::new_normalize(Quaternion::from(recorded.rotation));
        for (axis, expected) in [
            (Vector3::x(), Vector3::x()),
            (Vector3::y(), -Vector3::z()),
            (Vector3::z(), Vector3::y()),
        ] {
            assert!((q * axis - expected).norm() < 1e-15, "{axis} goes to {}", q * axis);
        }
        // A right angle from the lower to the upper edge: half of it is as far as the plane.
        assert!((recorded.focal_px[1] - 240.0).abs() < 1e-12);
    }
}
