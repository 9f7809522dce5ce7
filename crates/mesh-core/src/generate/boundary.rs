//! Walking along the boundary of a mesh.

use super::GenerateError;
use crate::ids::{HalfEdge, VertexId};
use crate::mesh::Mesh;

/// The next vertex along the boundary, the mesh on the left; `None` inside the mesh.
fn next_on_boundary(mesh: &Mesh, v: VertexId) -> Option<VertexId> {
    let h: HalfEdge = mesh.outgoing(v).next()?;
    mesh.is_boundary_edge(h).then(|| mesh.dest(h))
}

/// The vertices along the boundary from `from` to `to`, both included, the mesh on the left. If both
/// are the same, the whole loop, with that vertex at both ends.
///
/// # Errors
/// If the vertices do not exist or do not lie on the same boundary loop.
pub fn boundary_chain(
    mesh: &Mesh,
    from: VertexId,
    to: VertexId,
) -> Result<Vec<VertexId>, GenerateError> {
    let none = || GenerateError::NoChain { from: from.0, to: to.0 };
    if from.index() >= mesh.n_vertices() {
        return Err(none());
    }
    let mut chain = vec![from];
    let mut at = from;
    loop {
        at = next_on_boundary(mesh, at).ok_or_else(none)?;
        chain.push(at);
        if at == to {
            return Ok(chain);
        }
        if at == from {
            return Err(none());
        }
    }
}

/// The boundary loops, each from its vertex of smallest index onwards with the mesh on the left,
/// ordered by that vertex.
pub fn boundary_loops(mesh: &Mesh) -> Vec<Vec<VertexId>> {
    let mut seen = vec![false; mesh.n_vertices()];
    let mut loops = Vec::new();
    for start in mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)) {
        let mut around = Vec::new();
        let mut at = Some(start);
        while let Some(v) = at.filter(|v| !seen[v.index()]) {
            seen[v.index()] = true;
            around.push(v);
            at = next_on_boundary(mesh, v);
        }
        if !around.is_empty() {
            loops.push(around);
        }
    }
    loops
}
