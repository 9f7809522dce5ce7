//! From the world to the picture: the axes of the eye and the projection.

use nalgebra::Vector3;

use super::clip::HalfSpace;
use super::viewpoint::{FARTHEST, direction};
use super::{RenderError, Size, Viewpoint};

/// A viewpoint made ready for one size of picture.
///
/// Eye space has its origin at the eye and its axes to the right, up, and back towards the viewer.
/// Its unit is the distance from the eye to the target, so that scenes of any size use the same
/// numbers.
pub(super) struct Lens {
    eye: Vector3<f64>,
    /// Rows: right, up, back; divided by the distance to the target.
    axes: [Vector3<f64>; 3],
    /// Distance to the target (m).
    distance: f64,
    /// Pixels per unit of slope.
    focal_px: f64,
    /// Middle of the picture (px).
    centre: [f64; 2],
    /// The world's up in eye space.
    pub(super) up: Vector3<f64>,
    pub(super) size: Size,
}

impl Lens {
    /// Nearest depth that is drawn, in eye space.
    pub(super) const NEAR: f64 = 1e-3;
    /// Longest side of a picture (px), so that the rasteriser's integers cannot overflow.
    pub(super) const MAX_SIDE: u32 = 16384;

    pub(super) fn new(viewpoint: &Viewpoint, size: Size) -> Result<Self, RenderError> {
        if !(1..=Self::MAX_SIDE).contains(&size.width)
            || !(1..=Self::MAX_SIDE).contains(&size.height)
        {
            let Size { width, height } = size;
            return Err(RenderError::Size { width, height, most: Self::MAX_SIDE });
        }
        let bad = || RenderError::Viewpoint(*viewpoint);
        let Viewpoint { eye, target, up, vertical_fov } = *viewpoint;
        let sane = |v: [f64; 3]| v.iter().all(|x| x.abs() <= FARTHEST);
        let open = vertical_fov > 0.0 && vertical_fov < std::f64::consts::PI;
        if !(sane(eye) && sane(target) && sane(up) && open) {
            return Err(bad());
        }
        let (eye, target) = (Vector3::from(eye), Vector3::from(target));
        let distance = (target - eye).norm();
        let focal_px = f64::from(size.height) / (2.0 * (vertical_fov / 2.0).tan());
        let back = direction(eye - target).ok_or_else(bad)?;
        if !((1.0 / distance).is_finite() && focal_px.is_finite() && focal_px > 1e-6) {
            return Err(bad());
        }
        let world_up = direction(up.into()).unwrap_or(Vector3::z());
        // Looking along up is allowed: then another axis gives the top of the picture.
        let right = [world_up, Vector3::y(), Vector3::x()]
            .into_iter()
            .map(|up| up.cross(&back))
            .find(|right| right.norm() > 1e-6)
            .and_then(direction)
            .ok_or_else(bad)?;
        let top = back.cross(&right);
        let up = Vector3::new(world_up.dot(&right), world_up.dot(&top), world_up.dot(&back));
        let axes = [right, top, back].map(|axis| axis / distance);
        let centre = [f64::from(size.width) / 2.0, f64::from(size.height) / 2.0];
        Ok(Self { eye, axes, distance, focal_px, centre, up, size })
    }

    /// The point `p` (m) in eye space, or `None` if it is broken.
    pub(super) fn eye_space(&self, p: [f64; 3]) -> Option<Vector3<f64>> {
        let offset = Vector3::from(p) - self.eye;
        let v = Vector3::from(self.axes.map(|axis| axis.dot(&offset)));
        (v.amax() <= FARTHEST).then_some(v)
    }

    /// Height above the eye, in eye space, of the level `height` along the world's up (m).
    pub(super) fn level(&self, height: f64) -> f64 {
        let up = self.axes[0] * self.up.x + self.axes[1] * self.up.y + self.axes[2] * self.up.z;
        height / self.distance - up.dot(&self.eye)
    }

    /// Homogeneous pixel coordinates `(column · depth, row · depth, depth)` of `v` in eye space.
    pub(super) fn project(&self, v: Vector3<f64>) -> Vector3<f64> {
        let depth = -v.z;
        Vector3::new(
            self.centre[0] * depth + self.focal_px * v.x,
            self.centre[1] * depth - self.focal_px * v.y,
            depth,
        )
    }

    /// The half-spaces of eye space around what the picture shows, up to `farthest` in depth.
    pub(super) fn frustum(&self, farthest: f64) -> [HalfSpace; 6] {
        let half = |x, y, z, offset| HalfSpace { normal: Vector3::new(x, y, z), offset };
        let [slope_x, slope_y] = self.centre.map(|half_px| half_px / self.focal_px);
        [
            half(0.0, 0.0, -1.0, Self::NEAR),
            half(0.0, 0.0, 1.0, -farthest),
            half(1.0, 0.0, -slope_x, 0.0),
            half(-1.0, 0.0, -slope_x, 0.0),
            half(0.0, 1.0, -slope_y, 0.0),
            half(0.0, -1.0, -slope_y, 0.0),
        ]
    }

    /// The point of eye space with depth 1 that is seen at a place in the picture (px).
    pub(super) fn ray(&self, column: f64, row: f64) -> Vector3<f64> {
        Vector3::new(
            (column - self.centre[0]) / self.focal_px,
            (self.centre[1] - row) / self.focal_px,
            -1.0,
        )
    }
}
