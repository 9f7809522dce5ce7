//! A sphere of nearly equal triangles.

use super::limits::{check_size, check_triangles};
use super::{GenerateError, Surface};
use crate::geometry::World3;
use std::collections::BTreeMap;

/// A sphere of `radius` (m) around the origin: an icosahedron whose triangles were quartered
/// `subdivisions` times, all 10 · 4ⁿ + 2 vertices on the sphere. Normals point outwards.
///
/// # Errors
/// If the radius is not positive, finite and within the limits, or if there would be too many
/// triangles.
pub fn sphere(radius: f64, subdivisions: usize) -> Result<Surface, GenerateError> {
    check_size("radius of the sphere", radius)?;
    let quarters = 4usize.checked_pow(subdivisions.try_into().unwrap_or(u32::MAX));
    check_triangles(&[20, quarters.unwrap_or(usize::MAX)])?;

    let (mut directions, mut triangles) = icosahedron();
    for _ in 0..subdivisions {
        let mut middles = BTreeMap::new();
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for [a, b, c] in triangles {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(a, b): (u32, u32)| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    let sum: World3 = directions[a as usize] + directions[b as usize];
                    directions.push(sum.normalize());
                    directions.len() as u32 - 1
                })
            });
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    Ok(Surface { positions: directions.iter().map(|d| d * radius).collect(), triangles })
}

/// Directions of the corners, and the triangles: poles on the z axis and two rings of five.
fn icosahedron() -> (Vec<World3>, Vec<[u32; 3]>) {
    let (z, r) = (1.0 / 5f64.sqrt(), 2.0 / 5f64.sqrt());
    let mut directions = vec![World3::z()];
    for (offset, z) in [(0.0, z), (0.5, -z)] {
        directions.extend((0..5).map(|i| {
            let (sine, cosine) = (std::f64::consts::TAU * (i as f64 + offset) / 5.0).sin_cos();
            World3::new(r * cosine, r * sine, z)
        }));
    }
    directions.push(-World3::z());
    let mut triangles = Vec::with_capacity(20);
    for i in 0..5 {
        let next = (i + 1) % 5;
        let [upper, upper_next, lower, lower_next] = [1 + i, 1 + next, 6 + i, 6 + next];
        triangles.extend([
            [0, upper, upper_next],
            [upper, lower, upper_next],
            [upper_next, lower, lower_next],
            [11, lower_next, lower],
        ]);
    }
    (directions, triangles)
}
