//! A rectangular sheet in the plane z = 0.

use super::lattice::Lattice;
use super::limits::check_size;
use super::{Diagonal, GenerateError, Sheet};
use crate::geometry::Material2;

/// A sheet of `size` (m) with `cells` cells; the first corner lies at the origin, material and world
/// coordinates agree. Vertex (i, j) has the index `j (cells[0] + 1) + i`. Borders: `left`, `right`,
/// `lower`, `upper`.
///
/// # Errors
/// If a size is not positive, finite and within the limits, or if there are no cells or too many.
pub fn grid(size: [f64; 2], cells: [usize; 2], diagonal: Diagonal) -> Result<Sheet, GenerateError> {
    check_size("width of the grid", size[0])?;
    check_size("height of the grid", size[1])?;
    let point = |i: usize, j: usize| {
        Material2::new(size[0] * i as f64 / cells[0] as f64, size[1] * j as f64 / cells[1] as f64)
    };
    Lattice::new(cells)?.sheet(diagonal, point, |i, j| point(i, j).push(0.0))
}
