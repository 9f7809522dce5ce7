//! Which features may come near each other while everything moves on straight lines.
//!
//! Three sieves, each of which keeps all that the next one has to see: groups of four triangles by the
//! tree, pairs of triangles by common vertices around which nothing is near ([`fans`]) and by separating
//! axes ([`quads`]), and pairs of features ([`features`]) by their distance.

mod fans;
mod features;
mod lanes;
mod quads;

use crate::pairs::{Body, Candidate, Pair, PairKind};
use crate::{Aabb, Bvh, distance};
use features::Gap;
use mesh_core::{World3, par};
use quads::{Frame, Quad, Quads};

/// As [`near_within`](crate::swept::near_within).
pub(crate) fn within(
    body: Body<'_>,
    tree: &Bvh,
    most: impl Fn(&[u32; 4], PairKind) -> f64 + Sync,
) -> Vec<(Pair, f64)> {
    let (groups, used) = if body.is_all_awake() {
        (tree.self_groups(), (0..tree.n_groups() as u32).collect())
    } else {
        let groups = tree.self_groups_awake(&awake_groups(body, tree));
        let used = distinct(groups.iter().flatten().copied());
        (groups, used)
    };
    let covered = |v: u32| fans::covers(body, v);
    let quads = Quads::new(body, tree, &used, &Frame::of(&tree.bounds()), covered);
    let mut pairs = fans::pairs(body);
    pairs.extend(par::collect(groups.len(), |g, pairs| {
        let [s, t] = groups[g];
        let (first, second) = (quads.of(s), quads.of(t));
        // Of a group with itself, each pair once.
        let of = if s == t { 0b1000_1100_1110 } else { 0xffff };
        let hits = first.without_common(second, first.overlaps(second) & of);
        for_each_meeting(first, second, hits, |a, b| pairs.push([a, b]));
    }));
    let found = par::collect(pairs.len(), |i, found| {
        let [a, b] = pairs[i];
        let reach = reach_of((body, a), (body, b));
        features::look((body, a), (body, b), true, reach, |pair| {
            found.extend(near(pair, body, body, &most));
        });
    });
    sorted(found)
}

/// As [`near_between`](crate::swept::near_between).
pub(crate) fn between(
    (a, tree_a): (Body<'_>, &Bvh),
    (b, tree_b): (Body<'_>, &Bvh),
) -> Vec<(Pair, f64)> {
    let groups = if a.is_all_awake() || b.is_all_awake() {
        tree_a.groups_with(tree_b)
    } else {
        let awake = [awake_groups(a, tree_a), awake_groups(b, tree_b)];
        tree_a.groups_with_awake(tree_b, [&awake[0], &awake[1]])
    };
    if groups.is_empty() {
        return Vec::new();
    }
    let used = [0, 1].map(|side| distinct(groups.iter().map(|pair| pair[side])));
    // Of a large body only a part may be near.
    let mut bounds = Aabb::EMPTY;
    for (tree, used) in [(tree_a, &used[0]), (tree_b, &used[1])] {
        bounds = used.iter().fold(bounds, |all, &g| all.union(&tree.around(g as usize)));
    }
    let frame = Frame::of(&bounds);
    let first = Quads::new(a, tree_a, &used[0], &frame, |_| false);
    let second = Quads::new(b, tree_b, &used[1], &frame, |_| false);
    let any = |_: &[u32; 4], _: PairKind| f64::INFINITY;
    let found = par::collect(groups.len(), |g, found| {
        let (first, second) = (first.of(groups[g][0]), second.of(groups[g][1]));
        for_each_meeting(first, second, first.overlaps(second), |s, t| {
            let reach = reach_of((a, s), (b, t));
            features::look((a, s), (b, t), false, reach, |pair| {
                found.extend(near(pair, a, b, &any));
            });
        });
    });
    sorted(found)
}

/// Marks of the groups of which some vertex is awake.
fn awake_groups(body: Body<'_>, tree: &Bvh) -> Vec<bool> {
    let mut awake = vec![false; tree.n_groups()];
    let triangles = body.surface().triangles();
    par::fill(&mut awake, |g| {
        tree.elements_of(g).iter().any(|&t| body.has_awake(&triangles[t as usize]))
    });
    awake
}

/// The numbers of a list, each once, ascending.
fn distinct(of: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut all: Vec<u32> = of.collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// Calls `found` with all pairs of triangles of two quads that may meet, of those with a bit in `hits`:
/// bit 4 i + j for triangle `i` of the first and `j` of the second.
#[inline]
fn for_each_meeting(first: &Quad, second: &Quad, hits: u32, mut found: impl FnMut(u32, u32)) {
    let mut rest = hits;
    while rest != 0 {
        let i = rest.trailing_zeros() as usize / 4;
        let mut hits = rest >> (4 * i) & 0xf & first.may_meet(i, second);
        rest &= !(0xf << (4 * i));
        while hits != 0 {
            found(first.triangles[i], second.triangles[hits.trailing_zeros() as usize]);
            hits &= hits - 1;
        }
    }
}

fn sorted(mut found: Vec<(Pair, f64)>) -> Vec<(Pair, f64)> {
    found.sort_unstable_by_key(|(pair, _)| *pair);
    found
}

/// The tolerance of what two things can reach is far above rounding, so that nothing is missed by it.
const ROUNDING: f64 = 1e-9;

/// The most that features of two triangles can reach on the way (m).
#[inline]
fn reach_of((a, s): (Body<'_>, u32), (b, t): (Body<'_>, u32)) -> f64 {
    let (first, second) =
        (&a.surface().triangles()[s as usize], &b.surface().triangles()[t as usize]);
    let motions = second.map(|v| b.motion(v as usize));
    let mut most: f64 = 0.0;
    for &v in first {
        let motion = a.motion(v as usize);
        for other in &motions {
            most = most.max((motion - other).norm_squared());
        }
    }
    (most.sqrt() + (a.radius_of(first) + b.radius_of(second))) * (1.0 + ROUNDING)
}

/// A pair with its distance at the start, if the relative motion can use it up and the swept boxes
/// overlap. Its thickness counts up to a limit.
#[inline]
fn near(
    pair: Pair,
    a: Body<'_>,
    b: Body<'_>,
    limit: &impl Fn(&[u32; 4], PairKind) -> f64,
) -> Option<(Pair, f64)> {
    let vertices = pair.vertices(a.surface(), b.surface());
    if !is_awake(pair, &vertices, a, b) {
        return None;
    }
    let x = &pair.positions(vertices, a.x_t0(), b.x_t0());
    let is_edges = pair.kind == PairKind::EdgeEdge;
    let Candidate { x_t1, thickness, .. } = &Candidate::of(pair, a, b);
    let thickness = thickness.min(limit(&vertices, pair.kind));
    let m: [World3; 4] = std::array::from_fn(|k| x_t1[k] - x[k]);
    let apart = |a: usize, b: usize| (m[a] - m[b]).norm_squared();
    let most = if is_edges {
        apart(0, 2).max(apart(0, 3)).max(apart(1, 2)).max(apart(1, 3))
    } else {
        apart(0, 1).max(apart(0, 2)).max(apart(0, 3))
    };
    let reach = (most.sqrt() + thickness) * (1.0 + ROUNDING);
    let gap = if is_edges { Gap::between_edges(x) } else { Gap::to_triangle(x) };
    if gap.is_beyond(reach) {
        return None;
    }
    let squared = if is_edges {
        distance::edge_edge(x).squared
    } else {
        distance::vertex_triangle(x).squared
    };
    let is_near = squared <= reach * reach && boxes_overlap(pair, a, b);
    is_near.then(|| (pair, squared.sqrt()))
}

/// Whether any vertex of a pair is awake.
#[inline]
fn is_awake(pair: Pair, vertices: &[u32; 4], a: Body<'_>, b: Body<'_>) -> bool {
    if a.is_all_awake() || b.is_all_awake() {
        return true;
    }
    let (front, rear) = vertices.split_at(if pair.kind == PairKind::EdgeEdge { 2 } else { 1 });
    let (first, second) = if pair.kind == PairKind::TriangleVertex { (b, a) } else { (a, b) };
    first.has_awake(front) || second.has_awake(rear)
}

fn boxes_overlap(pair: Pair, a: Body<'_>, b: Body<'_>) -> bool {
    let vertices = pair.vertices(a.surface(), b.surface());
    let front = if pair.kind == PairKind::EdgeEdge { 2 } else { 1 };
    let (first, second) = vertices.split_at(front);
    let (first_body, second_body) =
        if pair.kind == PairKind::TriangleVertex { (b, a) } else { (a, b) };
    first_body.box_around(first).overlaps(&second_body.box_around(second))
}
