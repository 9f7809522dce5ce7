//! A cylinder with round ends.

use super::limits::{check_count, check_size, check_triangles};
use super::{GenerateError, Surface};
use crate::geometry::World3;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A cylinder of `radius` and `length` (m) around the z axis with half a sphere at each end, the
/// middle at the origin, `around` segments around and a quarter as many rings on each half sphere.
/// The cylinder is one row of long cells; vertices lie on the surface. Normals point outwards.
///
/// # Errors
/// If a length is not positive, finite and within the limits, or if there are fewer than four
/// segments around, or too many triangles.
pub fn capsule(radius: f64, length: f64, around: usize) -> Result<Surface, GenerateError> {
    check_size("radius of the capsule", radius)?;
    check_size("length of the capsule", length)?;
    check_count("segments around the capsule", around, 4)?;
    check_triangles(&[around, around])?;

    // Rings from the lower pole up; the two in the middle are the ends of the cylinder.
    let n_rings = around / 4;
    let latitude = |k: usize| FRAC_PI_2 * k as f64 / n_rings as f64;
    let rings: Vec<[f64; 2]> = (1..=n_rings)
        .map(|k| [latitude(k).sin(), -latitude(n_rings - k).sin()])
        .chain((1..=n_rings).rev().map(|k| [latitude(k).sin(), latitude(n_rings - k).sin()]))
        .collect();
    let mut positions = vec![World3::new(0.0, 0.0, -radius - 0.5 * length)];
    for (j, [r, z]) in rings.iter().enumerate() {
        let end = if j < n_rings { -0.5 * length } else { 0.5 * length };
        positions.extend((0..around).map(|i| {
            let (sine, cosine) = (TAU * i as f64 / around as f64).sin_cos();
            World3::new(radius * r * cosine, radius * r * sine, end + radius * z)
        }));
    }
    positions.push(World3::new(0.0, 0.0, radius + 0.5 * length));

    let vertex = |ring: usize, i: usize| (1 + ring * around + i % around) as u32;
    let (bottom, top) = (0, positions.len() as u32 - 1);
    let mut triangles = Vec::with_capacity(2 * around * rings.len());
    for i in 0..around {
        triangles.push([bottom, vertex(0, i + 1), vertex(0, i)]);
        for lower in 0..rings.len() - 1 {
            let upper = lower + 1;
            let [a, b] = [vertex(lower, i), vertex(lower, i + 1)];
            let [c, d] = [vertex(upper, i), vertex(upper, i + 1)];
            triangles.extend([[a, b, d], [a, d, c]]);
        }
        triangles.push([vertex(rings.len() - 1, i), vertex(rings.len() - 1, i + 1), top]);
    }
    Ok(Surface { positions, triangles })
}
