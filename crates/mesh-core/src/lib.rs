//! Triangle meshes of cloth in material and world space.
//!
//! The mesh is a dense corner table: the index buffer *is* the mesh, half-edge `3 t + k` runs from
//! corner `k` of triangle `t` to corner `k + 1`, and next, previous and triangle are arithmetic.
//! Material coordinates (m) live on corners, so that several flat panels can be sewn into one
//! garment: where the two sides of an edge disagree there is a *seam*. Topology changes are the
//! three journaled edits [`Edit`]; every field that lives on vertices follows by replaying them.
//!
//! ```
//! use mesh_core::{ClothState, VertexField, generate};
//!
//! // A square metre of cloth, 0.2 kg/m², at rest in the plane z = 0.
//! let sheet = generate::grid([1.0, 1.0], [4, 4], generate::Diagonal::Alternating)?;
//! let mut cloth = ClothState::at_rest(sheet.mesh, sheet.positions, vec![0.2])?;
//! let mut dye = VertexField::new(&cloth.mesh, vec![1.0; cloth.mesh.n_vertices()]);
//!
//! let edge = cloth.mesh.edges().next().unwrap();
//! let edit = cloth.split(edge)?;
//! dye.follow(&[edit]);
//!
//! assert_eq!(dye.values().len(), cloth.mesh.n_vertices());
//! assert!((cloth.total_mass() - 0.2).abs() < 1e-15);
//! cloth.mesh.validate()?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Architecture invariants
//! - Always dense: every slice is `0..n`, before and after any edit.
//! - An edit either happens completely or is refused with a [`Refusal`] and changes nothing.
//! - Vertex `uid`s are never reused; indices are only valid until the next edit.
//! - Results never depend on the number of threads ([`par`] is the only place that starts any).
#![forbid(unsafe_code)]

mod collapse;
mod construct;
#[cfg(test)]
mod corruption;
mod edit;
mod field;
mod flip;
pub mod generate;
pub mod geometry;
mod ids;
mod mesh;
pub mod obj;
pub mod par;
mod split;
mod state;
mod validate;

pub use construct::MeshError;
pub use edit::{Edit, Refusal};
pub use field::{Blend, TriangleField, VertexField};
pub use geometry::{Material2, World3};
pub use ids::{HalfEdge, TriangleId, VertexId};
pub use mesh::Mesh;
pub use state::ClothState;
