//! A round sheet in the plane z = 0.

use super::limits::{check_count, check_size, check_triangles};
use super::{Border, GenerateError, Sheet};
use crate::geometry::Material2;
use crate::ids::VertexId;
use crate::mesh::Mesh;
use std::f64::consts::TAU;

/// A disc of `radius` (m) around the origin: a centre vertex and `rings` rings with 6 k vertices in
/// ring k, so that all edges have about the length `radius / rings`. Material and world coordinates
/// agree. Vertex 0 is the centre; ring k begins on the x axis with the index `1 + 3 k (k - 1)`. The
/// outline is a regular polygon of `6 rings` corners on the circle: the border `rim`.
///
/// # Errors
/// If the radius is not positive, finite and within the limits, or if there are no rings or too
/// many.
pub fn disc(radius: f64, rings: usize) -> Result<Sheet, GenerateError> {
    check_size("radius of the disc", radius)?;
    check_count("rings of the disc", rings, 1)?;
    check_triangles(&[6, rings, rings])?;

    let mut points = vec![Material2::zeros()];
    for k in 1..=rings {
        let r = radius * k as f64 / rings as f64;
        points.extend((0..6 * k).map(|i| {
            let (sine, cosine) = (TAU * i as f64 / (6 * k) as f64).sin_cos();
            Material2::new(r * cosine, r * sine)
        }));
    }
    // Each ring falls into six sectors of k edges; the last vertex of one is the first of the next.
    let at = |k: usize, sector: usize, i: usize| match k {
        0 => 0,
        _ => (1 + 3 * k * (k - 1) + (sector * k + i) % (6 * k)) as u32,
    };
    let mut triangles = Vec::with_capacity(6 * rings * rings);
    for k in 1..=rings {
        for sector in 0..6 {
            for i in 0..k {
                let outer = [at(k, sector, i), at(k, sector, i + 1)];
                triangles.push([at(k - 1, sector, i), outer[0], outer[1]]);
                if i + 1 < k {
                    triangles.push([at(k - 1, sector, i), outer[1], at(k - 1, sector, i + 1)]);
                }
            }
        }
    }
    let material = triangles.iter().map(|t| t.map(|v| points[v as usize])).collect();
    let panels = vec![0; triangles.len()];
    let positions = points.iter().map(|u| u.push(0.0)).collect();
    let rim = points.len() - 6 * rings..points.len();
    let borders = vec![Border { name: "rim", vertices: rim.map(|v| VertexId(v as u32)).collect() }];
    Ok(Sheet { mesh: Mesh::new(points.len(), triangles, material, panels)?, positions, borders })
}
