//! Generators: flat sheets, tubes, garments sewn from flat panels, and closed surfaces.
//!
//! Everything is deterministic. World positions put the cloth at rest wherever that is possible:
//! the edges of [`grid`], [`disc`], [`tube`] and [`skirt`] have the same length in both spaces to
//! rounding; garments folded from flat panels ([`tunic`], [`poncho`]) state their tolerance.

mod boundary;
mod capsule;
mod cuboid;
mod disc;
mod error;
mod grid;
mod lattice;
mod limits;
mod sew;
mod skirt;
mod sphere;
mod torus;
mod tube;
mod tunic;

pub use boundary::{boundary_chain, boundary_loops};
pub use capsule::capsule;
pub use cuboid::cuboid;
pub use disc::disc;
pub use error::GenerateError;
pub use grid::grid;
pub use lattice::{Diagonal, Lattice};
pub use limits::{MAX_SIZE, MAX_TRIANGLES, MIN_SIZE};
pub use sew::{Chain, Seam, Sewn, lay_out, sew};
pub use skirt::{Skirt, skirt};
pub use sphere::sphere;
pub use torus::torus;
pub use tube::tube;
pub use tunic::{Tunic, poncho, tunic};

use crate::geometry::World3;
use crate::ids::VertexId;
use crate::mesh::Mesh;

/// A generated mesh and its positions in world space (m).
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Topology and material space.
    pub mesh: Mesh,
    /// World positions (m).
    pub positions: Vec<World3>,
    /// What the parts of its boundary are called. [`sew`] leaves this to its caller.
    pub borders: Vec<Border>,
}

/// A part of a boundary with a name: a side of a rectangle, or an opening such as the waist.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Border {
    /// Its name; generators say which they give.
    pub name: &'static str,
    /// The vertices on it, sorted.
    pub vertices: Vec<VertexId>,
}

/// Triangles in world space without a material space: an obstacle.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// World positions (m).
    pub positions: Vec<World3>,
    /// Vertices of every triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}
