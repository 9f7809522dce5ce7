//! A rectangular sheet in the plane z = 0.

use super::Sheet;
use crate::construct::MeshError;
use crate::geometry::{Material2, World3};
use crate::mesh::Mesh;

/// How the cells of a grid are cut into triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Diagonal {
    /// Diagonals turn from cell to cell.
    Alternating,
    /// All diagonals run the same way.
    One,
}

/// A sheet of `size` (m) with `cells` cells; the first corner lies at the origin, material and world
/// coordinates agree. Vertex (i, j) has the index `j (cells[0] + 1) + i`.
///
/// # Errors
/// If a size is not positive and finite, or there are no cells.
pub fn grid(size: [f64; 2], cells: [usize; 2], diagonal: Diagonal) -> Result<Sheet, MeshError> {
    let [nx, ny] = cells;
    let at = |i: usize, j: usize| (j * (nx + 1) + i) as u32;
    let point = |i: usize, j: usize| {
        Material2::new(size[0] * i as f64 / nx as f64, size[1] * j as f64 / ny as f64)
    };
    let mut triangles = Vec::with_capacity(2 * nx * ny);
    let mut material = Vec::with_capacity(2 * nx * ny);
    for j in 0..ny {
        for i in 0..nx {
            let [p, q, r, s] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let turn = diagonal == Diagonal::Alternating && (i + j) % 2 == 1;
            let cut = if turn { [[p, q, s], [q, r, s]] } else { [[p, q, r], [p, r, s]] };
            for corners in cut {
                triangles.push(corners.map(|(i, j)| at(i, j)));
                material.push(corners.map(|(i, j)| point(i, j)));
            }
        }
    }
    let n_vertices = (nx + 1) * (ny + 1);
    let positions = (0..n_vertices)
        .map(|k| point(k % (nx + 1), k / (nx + 1)))
        .map(|u| World3::new(u.x, u.y, 0.0))
        .collect();
    let panels = vec![0; triangles.len()];
    Ok(Sheet { mesh: Mesh::new(n_vertices, triangles, material, panels)?, positions })
}
