//! Generators of simple sheets and garments.

mod grid;

pub use grid::{Diagonal, grid};

use crate::geometry::World3;
use crate::mesh::Mesh;

/// A generated mesh and its positions in world space (m).
#[derive(Clone, Debug)]
pub struct Sheet {
    /// Topology and material space.
    pub mesh: Mesh,
    /// World positions (m).
    pub positions: Vec<World3>,
}
