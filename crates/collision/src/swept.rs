//! Which features come close to each other while everything moves on straight lines.

use crate::pairs::{Body, Candidate, Pair, PairKind, search_between, search_within};
use crate::{Bvh, ccd, near};

/// Two features that come as close as the sum of their radii, or nearly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// The features.
    pub pair: Pair,
    /// Until when their motion is certainly free, as in [`Ccd`](ccd::Ccd) (1).
    pub t: f64,
}

/// All pairs of features of a body whose swept boxes overlap, in ascending order; none with a vertex
/// in common. The tree is the body's ([`Body::tree`]).
pub fn candidates_within(body: Body<'_>, tree: &Bvh) -> Vec<Pair> {
    let found = search_within(body, tree, |_| Some(()));
    found.into_iter().map(|(pair, ())| pair).collect()
}

/// All pairs of a feature of `a` and a feature of `b` whose swept boxes overlap, in ascending order.
pub fn candidates_between(a: (Body<'_>, &Bvh), b: (Body<'_>, &Bvh)) -> Vec<Pair> {
    let found = search_between(a, b, |_| Some(()));
    found.into_iter().map(|(pair, ())| pair).collect()
}

/// All pairs of features of a body that may come as near as the sum of their radii on the way, however
/// each of their points goes its part of it at the pace of the others, with their distances at the
/// start (m), in ascending order; none with a vertex in common. The tree is the body's
/// ([`Body::tree`]). Where `most`, by the [`Pair::vertices`] and the kind of a pair, is less than the
/// sum of its radii (m), it takes its place.
pub fn near_within(
    body: Body<'_>,
    tree: &Bvh,
    most: impl Fn(&[u32; 4], PairKind) -> f64 + Sync,
) -> Vec<(Pair, f64)> {
    near::within(body, tree, most)
}

/// All pairs of a feature of `a` and a feature of `b` that may come as near; else as
/// [`near_within`].
pub fn near_between(a: (Body<'_>, &Bvh), b: (Body<'_>, &Bvh)) -> Vec<(Pair, f64)> {
    near::between(a, b)
}

/// All impacts of a body with itself, in ascending order of pairs: between features without a common
/// vertex that come as close as the sum of their radii. None is missed; the rules of
/// [`ccd`] hold.
pub fn impacts_within(body: Body<'_>, tree: &Bvh) -> Vec<Impact> {
    as_impacts(search_within(body, tree, collide))
}

/// All impacts of a body with another one, in ascending order of pairs.
pub fn impacts_between(a: (Body<'_>, &Bvh), b: (Body<'_>, &Bvh)) -> Vec<Impact> {
    as_impacts(search_between(a, b, collide))
}

/// The time until which motion with these impacts is certainly free (1): the earliest, or 1.
pub fn free_until(impacts: &[Impact]) -> f64 {
    impacts.iter().map(|impact| impact.t).fold(1.0, f64::min)
}

fn as_impacts(found: Vec<(Pair, f64)>) -> Vec<Impact> {
    found.into_iter().map(|(pair, t)| Impact { pair, t }).collect()
}

fn collide(candidate: &Candidate) -> Option<f64> {
    let Candidate { pair, x_t0, x_t1, thickness } = candidate;
    let test = match pair.kind {
        PairKind::EdgeEdge => ccd::edge_edge,
        PairKind::VertexTriangle | PairKind::TriangleVertex => ccd::vertex_triangle,
    };
    match test(x_t0, x_t1, *thickness) {
        ccd::Ccd::Free => None,
        ccd::Ccd::Hit { t } => Some(t),
    }
}
