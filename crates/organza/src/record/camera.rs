//! The camera of a scene as recordings hold it.

/// The pinhole camera with its numbers by name.
pub fn camera(camera: &sizing_view::Camera) -> io_mcap::Camera {
    let [width_px, height_px] = camera.resolution();
    io_mcap::Camera {
        width_px,
        height_px,
        focal_px: [camera.focal_px(); 2],
        center_px: [width_px, height_px].map(|side| 0.5 * f64::from(side)),
        position: camera.position().into(),
        rotation: camera.world_from_camera().coords.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Quaternion, UnitQuaternion, Vector3};

    #[test]
    fn axes_are_right_down_forward() {
        let (position, target) = (Vector3::new(1.0, -5.0, 2.0), Vector3::new(1.0, 0.0, 2.0));
        let fov = std::f64::consts::FRAC_PI_2;
        let seen = sizing_view::Camera::looking_at(position, target, Vector3::z(), fov, [640, 480])
            .unwrap();
        let recorded = camera(&seen);
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
