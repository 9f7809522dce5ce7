//! A ring.

use super::limits::{check_below, check_count, check_size, check_triangles};
use super::{GenerateError, Surface};
use crate::geometry::World3;
use std::f64::consts::TAU;

/// A ring around the z axis, its middle at the origin: a tube of radius `tube` (m) along the circle
/// of `radius` (m) in the plane z = 0, with `around` segments around the axis and `across` around the
/// tube. Vertices lie on the surface. Normals point outwards.
///
/// # Errors
/// If a length is not positive, finite and within the limits, if the tube is thicker than the hole
/// allows, or if there are fewer than three segments in a direction, or too many triangles.
pub fn torus(
    radius: f64,
    tube: f64,
    around: usize,
    across: usize,
) -> Result<Surface, GenerateError> {
    check_size("radius of the torus", radius)?;
    check_below("radius of the tube of the torus", tube, radius)?;
    check_count("segments around the torus", around, 3)?;
    check_count("segments around the tube of the torus", across, 3)?;
    check_triangles(&[2, around, across])?;

    let angle = |k: usize, n: usize| (TAU * k as f64 / n as f64).sin_cos();
    let mut positions = Vec::with_capacity(around * across);
    for i in 0..around {
        let (sine, cosine) = angle(i, around);
        positions.extend((0..across).map(|j| {
            let (up, out) = angle(j, across);
            let r = radius + tube * out;
            World3::new(r * cosine, r * sine, tube * up)
        }));
    }
    let vertex = |i: usize, j: usize| (i % around * across + j % across) as u32;
    let mut triangles = Vec::with_capacity(2 * around * across);
    for i in 0..around {
        for j in 0..across {
            let [a, b] = [vertex(i, j), vertex(i + 1, j)];
            let [c, d] = [vertex(i, j + 1), vertex(i + 1, j + 1)];
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    Ok(Surface { positions, triangles })
}
