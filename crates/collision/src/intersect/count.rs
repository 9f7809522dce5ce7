//! All crossings of edges and triangles, within a surface and between two.

use super::{Crossing, edge_triangle};
use crate::{Aabb, Bvh, Surface};
use mesh_core::{World3, par};

/// An edge that crosses a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeTriangle {
    /// The edge.
    pub edge: u32,
    /// The triangle.
    pub triangle: u32,
}

/// Positions with the surface they belong to.
type Side<'a> = (&'a Surface, &'a [World3]);

/// All proper crossings of edges and triangles of one surface at positions `x` (m), in ascending
/// order; `tree` is over its triangles there. An edge with an end in common with a triangle does not
/// cross it.
pub fn within(surface: &Surface, x: &[World3], tree: &Bvh) -> Vec<EdgeTriangle> {
    let pairs = tree.self_pairs(|_, _| true);
    let mut all = par::collect(pairs.len(), |i, found| {
        let [a, b] = pairs[i];
        for (t, other) in [(a, b), (b, a)] {
            let corners = surface.corners(x, t);
            let around = Aabb::around(&corners);
            for edge in surface.owned_edges(other) {
                if !surface.edge_meets_triangle(edge, t) {
                    push_proper((surface, x), edge, t, &corners, &around, found);
                }
            }
        }
    });
    all.sort_unstable();
    all
}

/// All proper crossings of the edges of one surface with the triangles of another at positions `x_a`
/// and `x_b` (m), in ascending order; the trees are over their triangles. Swap the two for the others.
pub fn between(
    (edges, x_a, tree_a): (&Surface, &[World3], &Bvh),
    (triangles, x_b, tree_b): (&Surface, &[World3], &Bvh),
) -> Vec<EdgeTriangle> {
    let pairs = tree_a.pairs_with(tree_b, |_, _| true);
    let mut all = par::collect(pairs.len(), |i, found| {
        let [a, b] = pairs[i];
        let corners = triangles.corners(x_b, b);
        let around = Aabb::around(&corners);
        for edge in edges.owned_edges(a) {
            push_proper((edges, x_a), edge, b, &corners, &around, found);
        }
    });
    all.sort_unstable();
    all
}

#[inline]
fn push_proper(
    (surface, x): Side<'_>,
    edge: u32,
    triangle: u32,
    corners: &[World3; 3],
    around: &Aabb,
    found: &mut Vec<EdgeTriangle>,
) {
    let [p, q] = surface.ends(x, edge);
    if Aabb::around(&[p, q]).overlaps(around) && edge_triangle(&p, &q, corners) == Crossing::Proper
    {
        found.push(EdgeTriangle { edge, triangle });
    }
}

/// [`within`] by looking at every edge and triangle: O(n²), to check it.
pub fn within_brute_force(surface: &Surface, x: &[World3]) -> Vec<EdgeTriangle> {
    let mut all = between_brute_force((surface, x), (surface, x));
    all.retain(|c| !surface.edge_meets_triangle(c.edge, c.triangle));
    all
}

/// [`between`] by looking at every edge and triangle: O(n²), to check it.
pub fn between_brute_force(
    (edges, x_a): Side<'_>,
    (triangles, x_b): Side<'_>,
) -> Vec<EdgeTriangle> {
    let mut all = Vec::new();
    for edge in 0..edges.n_edges() as u32 {
        let [p, q] = edges.ends(x_a, edge);
        for triangle in 0..triangles.n_triangles() as u32 {
            if edge_triangle(&p, &q, &triangles.corners(x_b, triangle)) == Crossing::Proper {
                all.push(EdgeTriangle { edge, triangle });
            }
        }
    }
    all
}
