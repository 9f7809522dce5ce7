//! A box.

use super::limits::check_size;
use super::{GenerateError, Surface};
use crate::geometry::World3;

/// A box of the given lengths (m) along x, y and z around the origin: 8 vertices, 12 triangles.
/// Normals point outwards.
///
/// # Errors
/// If a length is not positive, finite and within the limits.
pub fn cuboid(size: [f64; 3]) -> Result<Surface, GenerateError> {
    size.into_iter().try_for_each(|length| check_size("length of the box", length))?;
    let half = World3::from(size) * 0.5;
    // Vertex number = x + 2 y + 4 z, each 0 on the low side and 1 on the high side.
    let side = |vertex: usize, axis: usize| if vertex >> axis & 1 == 1 { 1.0 } else { -1.0 };
    let positions = (0..8)
        .map(|v| World3::new(side(v, 0), side(v, 1), side(v, 2)).component_mul(&half))
        .collect();
    let mut triangles = Vec::with_capacity(12);
    for axis in 0..3 {
        // Going along b and then c turns counter-clockwise as seen from the high side of the axis.
        let (a, b, c) = (1 << axis, 1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        triangles.extend([[a, a + b, a + b + c], [a, a + b + c, a + c]]);
        triangles.extend([[0, b + c, b], [0, c, b + c]]);
    }
    Ok(Surface { positions, triangles })
}
