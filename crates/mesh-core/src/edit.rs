//! Edits as values: what happened to the mesh, so that fields can follow.

use crate::ids::{TriangleId, VertexId};

/// One change of topology. Replaying a journal of these keeps any field in step with the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edit {
    /// An edge was split at its material midpoint.
    Split {
        /// End of the edge.
        a: VertexId,
        /// The other end.
        b: VertexId,
        /// The new vertex: always the last index.
        new: VertexId,
        /// The triangles that were cut: each new one is pushed at the end, in this order.
        parents: [Option<TriangleId>; 2],
    },
    /// The edge between two triangles was turned to the other diagonal; indices stay.
    Flip {
        /// The two triangles, which now share the other diagonal.
        triangles: [TriangleId; 2],
    },
    /// A vertex was merged into its neighbour, which keeps its place.
    Collapse {
        /// The vertex that went; the last vertex took its index (`swap_remove`).
        removed: VertexId,
        /// The neighbour it went into, numbered *before* the removal.
        kept: VertexId,
        /// The triangles that went, each removed by `swap_remove` in this order.
        triangles: [Option<TriangleId>; 2],
    },
}

/// Why an edit is not possible here; nothing was changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// A flip needs triangles on both sides.
    #[error("the edge lies on the boundary")]
    Boundary,
    /// The edge belongs to a seam, a boundary or a change of panel, whose line is kept.
    #[error("the edit would change a seam, a boundary or a panel's outline")]
    Feature,
    /// The result would not be a manifold mesh.
    #[error("the result would not be a manifold")]
    Topology,
    /// A triangle would be turned over or lose its area in material space.
    #[error("a triangle would be inverted or without area in material space")]
    Inverted,
}
