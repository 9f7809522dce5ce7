//! Which features come close to each other while everything moves on straight lines.

use crate::pairs::{Apart, Body, Candidate, Pair, PairKind, search_between, search_within};
use crate::{Bvh, ccd, distance};
use mesh_core::World3;

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
    let found = search_within(body, tree, |_, _| true, |_| Some(()));
    found.into_iter().map(|(pair, ())| pair).collect()
}

/// All pairs of a feature of `a` and a feature of `b` whose swept boxes overlap, in ascending order.
pub fn candidates_between(a: (Body<'_>, &Bvh), b: (Body<'_>, &Bvh)) -> Vec<Pair> {
    let found = search_between(a, b, |_, _| true, |_| Some(()));
    found.into_iter().map(|(pair, ())| pair).collect()
}

/// All pairs of features of a body that may come as near as the sum of their radii on the way, however
/// each of their points goes its part of it at the pace of the others, with their distances at the
/// start (m), in ascending order; none with a vertex in common. The tree is the body's
/// ([`Body::tree`]).
pub fn near_within(body: Body<'_>, tree: &Bvh) -> Vec<(Pair, f64)> {
    let apart = Apart::of(body);
    search_within(body, tree, |i, j| apart.may_meet(i, &apart, j), near)
}

/// All pairs of a feature of `a` and a feature of `b` that may come as near; else as
/// [`near_within`].
pub fn near_between(a: (Body<'_>, &Bvh), b: (Body<'_>, &Bvh)) -> Vec<(Pair, f64)> {
    let (first, second) = (Apart::of(a.0), Apart::of(b.0));
    search_between(a, b, |i, j| first.may_meet(i, &second, j), near)
}

/// All impacts of a body with itself, in ascending order of pairs: between features without a common
/// vertex that come as close as the sum of their radii. None is missed; the rules of
/// [`ccd`] hold.
pub fn impacts_within(body: Body<'_>, tree: &Bvh) -> Vec<Impact> {
    as_impacts(search_within(body, tree, |_, _| true, collide))
}

/// All impacts of a body with another one, in ascending order of pairs.
pub fn impacts_between(a: (Body<'_>, &Bvh), b: (Body<'_>, &Bvh)) -> Vec<Impact> {
    as_impacts(search_between(a, b, |_, _| true, collide))
}

/// The time until which motion with these impacts is certainly free (1): the earliest, or 1.
pub fn free_until(impacts: &[Impact]) -> f64 {
    impacts.iter().map(|impact| impact.t).fold(1.0, f64::min)
}

fn as_impacts(found: Vec<(Pair, f64)>) -> Vec<Impact> {
    found.into_iter().map(|(pair, t)| Impact { pair, t }).collect()
}

/// The distance at the start, if the relative motion can use it up.
#[inline]
fn near(candidate: &Candidate) -> Option<f64> {
    let Candidate { pair, x_t0, x_t1, thickness } = candidate;
    let m: [World3; 4] = std::array::from_fn(|k| x_t1[k] - x_t0[k]);
    let apart = |a: usize, b: usize| (m[a] - m[b]).norm_squared();
    let is_edges = pair.kind == PairKind::EdgeEdge;
    let (most, axis) = if is_edges {
        let most = apart(0, 2).max(apart(0, 3)).max(apart(1, 2)).max(apart(1, 3));
        (most, x_t0[0] + x_t0[1] - x_t0[2] - x_t0[3])
    } else {
        let most = apart(0, 1).max(apart(0, 2)).max(apart(0, 3));
        (most, x_t0[0] * 3.0 - x_t0[1] - x_t0[2] - x_t0[3])
    };
    // The tolerance is far above rounding, so that nothing is missed by it.
    let reach = (most.sqrt() + thickness) * (1.0 + 1e-9);
    // A gap along the line of their centres, which is most often enough to tell.
    let [p, q, r, s] = x_t0.map(|x| axis.dot(&x));
    let gap = if is_edges { p.min(q) - r.max(s) } else { p - q.max(r).max(s) };
    if gap > 0.0 && gap * gap > reach * reach * axis.norm_squared() * (1.0 + 1e-6) {
        return None;
    }
    let squared = if is_edges {
        distance::edge_edge(x_t0).squared
    } else {
        distance::vertex_triangle(x_t0).squared
    };
    (squared <= reach * reach).then(|| squared.sqrt())
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
