//! Distances of a vertex and a triangle, and of two edges: the closest points, which features they lie
//! on, and derivatives of the squared distance of given features.
//!
//! Everything is relative: coordinates enter through differences, and no length is compared with a
//! constant. So features of 1e-6 m far from the origin are as good as any, and elements without area
//! or length are ordinary input: they have a closest point too, on one of their edges or corners.
//!
//! The squared distance is a smooth function of the positions while the closest features stay the
//! same, and its value is continuous where they change; so is its gradient, but for parallel edges
//! (see [`parallel_edges`]). An energy is a function of the squared distance, and [`Derivatives`] is
//! what its chain rule needs.

mod closest;
mod derivatives;
mod mollifier;

pub use closest::{
    Closest, EdgeEdgeFeature, VertexTriangleFeature, edge_edge, segment, vertex_triangle,
};
pub use derivatives::{Derivatives, line_line, point_line, point_plane, point_point};
pub use mollifier::{Mollifier, parallel_edges};
