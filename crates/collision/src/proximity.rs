//! Which features are within a thickness of each other, at one instant.

use crate::distance::{self, EdgeEdgeFeature, VertexTriangleFeature};
use crate::pairs::{Body, Candidate, Pair, PairKind, search_between, search_within};
use crate::{Bvh, Surface};
use mesh_core::World3;

/// Which features of a pair are closest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// Of a vertex and a triangle, in either order.
    VertexTriangle(VertexTriangleFeature),
    /// Of two edges.
    EdgeEdge(EdgeEdgeFeature),
}

/// Two features within their thickness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proximity {
    /// The features.
    pub pair: Pair,
    /// The closest of their features.
    pub feature: Feature,
    /// Weights of [`Pair::vertices`] that give `offset` (1).
    pub weights: [f64; 4],
    /// From the triangle to the vertex, or from the second edge to the first: along it they separate
    /// (m).
    pub offset: World3,
    /// The distance (m).
    pub distance: f64,
    /// Sum of the radii of the two: the distance below which they are in contact (m).
    pub thickness: f64,
}

impl Proximity {
    /// The four vertices that the weights belong to; see [`Pair::vertices`].
    pub fn vertices(&self, a: &Surface, b: &Surface) -> [u32; 4] {
        self.pair.vertices(a, b)
    }
}

/// All pairs of features of a body with a distance of at most the sum of their radii, each once, in
/// ascending order. Features with a vertex in common are not in contact. The tree is the body's
/// ([`Body::tree`]); of a moving body, the end of the motion counts.
pub fn within(body: Body<'_>, tree: &Bvh) -> Vec<Proximity> {
    let found = search_within(body, tree, measure);
    found.into_iter().map(|(_, proximity)| proximity).collect()
}

/// All pairs of a feature of `a` and a feature of `b` with a distance of at most the sum of their
/// radii, each once, in ascending order. The trees are the bodies'.
pub fn between(a: (Body<'_>, &Bvh), b: (Body<'_>, &Bvh)) -> Vec<Proximity> {
    let found = search_between(a, b, measure);
    found.into_iter().map(|(_, proximity)| proximity).collect()
}

fn measure(candidate: &Candidate) -> Option<Proximity> {
    let &Candidate { pair, x_t1: ref x, thickness, .. } = candidate;
    let (feature, weights, offset, squared) = if pair.kind == PairKind::EdgeEdge {
        let c = distance::edge_edge(x);
        (Feature::EdgeEdge(c.feature), c.weights, c.offset, c.squared)
    } else {
        let c = distance::vertex_triangle(x);
        (Feature::VertexTriangle(c.feature), c.weights, c.offset, c.squared)
    };
    let distance = squared.sqrt();
    (distance <= thickness).then_some(Proximity {
        pair,
        feature,
        weights,
        offset,
        distance,
        thickness,
    })
}
