//! Lattices of cells, each cut into two triangles: the pattern behind grids, tubes and panels.

use super::limits::{check_count, check_triangles};
use super::{Border, GenerateError, Sheet};
use crate::geometry::{Material2, World3};
use crate::ids::VertexId;
use crate::mesh::Mesh;

/// How the cells of a lattice are cut into triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Diagonal {
    /// Diagonals turn from cell to cell.
    Alternating,
    /// All diagonals run the same way.
    One,
}

/// A lattice of `cells[0]` columns and `cells[1]` rows of cells.
#[derive(Clone, Copy, Debug)]
pub struct Lattice {
    /// Columns and rows.
    pub cells: [usize; 2],
}

impl Lattice {
    /// A lattice that is neither empty nor absurdly large.
    ///
    /// # Errors
    /// If it is one of both.
    pub fn new(cells: [usize; 2]) -> Result<Lattice, GenerateError> {
        check_count("columns of cells", cells[0], 1)?;
        check_count("rows of cells", cells[1], 1)?;
        check_triangles(&[2, cells[0], cells[1]])?;
        Ok(Lattice { cells })
    }

    /// The vertex in column line `i` and row line `j`.
    pub fn vertex(&self, i: usize, j: usize) -> VertexId {
        VertexId((j * (self.cells[0] + 1) + i) as u32)
    }

    /// The vertices of a row line.
    pub fn row(&self, j: usize) -> impl Iterator<Item = VertexId> + use<> {
        let lattice = *self;
        (0..=self.cells[0]).map(move |i| lattice.vertex(i, j))
    }

    /// The vertices of a column line.
    pub fn column(&self, i: usize) -> impl Iterator<Item = VertexId> + use<> {
        let lattice = *self;
        (0..=self.cells[1]).map(move |j| lattice.vertex(i, j))
    }

    /// The sides by name.
    fn borders(&self) -> Vec<Border> {
        let [nx, ny] = self.cells;
        vec![
            Border { name: "left", vertices: self.column(0).collect() },
            Border { name: "right", vertices: self.column(nx).collect() },
            Border { name: "lower", vertices: self.row(0).collect() },
            Border { name: "upper", vertices: self.row(ny).collect() },
        ]
    }

    /// The sheet with the given material and world coordinates (m) at every vertex (i, j). Borders:
    /// `left`, `right`, `lower`, `upper`.
    ///
    /// # Errors
    /// If the material coordinates make no mesh.
    pub fn sheet(
        &self,
        diagonal: Diagonal,
        material: impl Fn(usize, usize) -> Material2,
        world: impl Fn(usize, usize) -> World3,
    ) -> Result<Sheet, GenerateError> {
        let [nx, ny] = self.cells;
        let mut triangles = Vec::with_capacity(2 * nx * ny);
        let mut corners = Vec::with_capacity(2 * nx * ny);
        for j in 0..ny {
            for i in 0..nx {
                let [p, q, r, s] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                let turn = diagonal == Diagonal::Alternating && (i + j) % 2 == 1;
                let cut = if turn { [[p, q, s], [q, r, s]] } else { [[p, q, r], [p, r, s]] };
                for triangle in cut {
                    triangles.push(triangle.map(|(i, j)| self.vertex(i, j).0));
                    corners.push(triangle.map(|(i, j)| material(i, j)));
                }
            }
        }
        let positions = (0..=ny)
            .flat_map(|j| (0..=nx).map(move |i| (i, j)))
            .map(|(i, j)| world(i, j))
            .collect();
        let panels = vec![0; triangles.len()];
        let mesh = Mesh::new((nx + 1) * (ny + 1), triangles, corners, panels)?;
        Ok(Sheet { mesh, positions, borders: self.borders() })
    }
}
