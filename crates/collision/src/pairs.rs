//! Pairs of features that may touch: a vertex and a triangle, or two edges.
//!
//! If two triangle meshes have a point in common, then a vertex of one lies on a triangle of the
//! other, or two edges meet. Both kinds of pairs follow from pairs of triangles by ownership
//! ([`Surface`]), each exactly once.

use crate::{Aabb, Bvh, Surface};
use mesh_core::{World3, par};

/// What the elements of a pair are. The first belongs to the first of two bodies, the second to the
/// second; within one body, pairs are vertex–triangle or edge–edge with the lower edge first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PairKind {
    /// A vertex of the first body and a triangle of the second.
    VertexTriangle,
    /// A triangle of the first body and a vertex of the second.
    TriangleVertex,
    /// Two edges.
    EdgeEdge,
}

/// Two features that may touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Pair {
    /// What they are.
    pub kind: PairKind,
    /// Vertex, triangle or edge of the first body.
    pub a: u32,
    /// Vertex, triangle or edge of the second body.
    pub b: u32,
}

impl Pair {
    /// The four vertices as [`distance`](crate::distance) and [`ccd`](crate::ccd) take them: the
    /// vertex before the triangle's corners, or the ends of the first edge before the second's.
    #[inline]
    pub fn vertices(self, a: &Surface, b: &Surface) -> [u32; 4] {
        let with_triangle = |vertex: u32, [p, q, r]: [u32; 3]| [vertex, p, q, r];
        match self.kind {
            PairKind::VertexTriangle => with_triangle(self.a, b.triangles()[self.b as usize]),
            PairKind::TriangleVertex => with_triangle(self.b, a.triangles()[self.a as usize]),
            PairKind::EdgeEdge => {
                let ([p, q], [r, s]) = (a.edges()[self.a as usize], b.edges()[self.b as usize]);
                [p, q, r, s]
            }
        }
    }

    /// The positions of its vertices, given those of the first body and of the second.
    #[inline]
    pub(crate) fn positions(
        self,
        vertices: [u32; 4],
        front: &[World3],
        rear: &[World3],
    ) -> [World3; 4] {
        let [i, j, k, l] = vertices.map(|v| v as usize);
        // Without a choice for each vertex, which would cost more than most tests.
        match self.kind {
            PairKind::EdgeEdge => [front[i], front[j], rear[k], rear[l]],
            PairKind::VertexTriangle => [front[i], rear[j], rear[k], rear[l]],
            PairKind::TriangleVertex => [rear[i], front[j], front[k], front[l]],
        }
    }

    /// Which of the four vertices belong to the first body.
    #[inline]
    pub fn of_first(self) -> [bool; 4] {
        match self.kind {
            PairKind::VertexTriangle => [true, false, false, false],
            PairKind::TriangleVertex => [false, true, true, true],
            PairKind::EdgeEdge => [true, true, false, false],
        }
    }
}

/// A surface that stands still or moves on straight lines, with room around it.
#[derive(Clone, Copy)]
pub struct Body<'a> {
    surface: &'a Surface,
    x_t0: &'a [World3],
    x_t1: &'a [World3],
    radius: &'a (dyn Fn(u32) -> f64 + Sync),
    awake: Option<&'a [bool]>,
}

impl<'a> Body<'a> {
    /// A surface at positions `x` (m). Around each vertex `v` is room of `radius(v)` ≥ 0 (m), half a
    /// thickness; elements have the largest radius of their vertices.
    pub fn still(
        surface: &'a Surface,
        x: &'a [World3],
        radius: &'a (dyn Fn(u32) -> f64 + Sync),
    ) -> Body<'a> {
        Body::moving(surface, x, x, radius)
    }

    /// A surface that moves from `x_t0` to `x_t1` (m); else as [`Body::still`].
    ///
    /// # Panics
    /// If there is not one position for each vertex.
    pub fn moving(
        surface: &'a Surface,
        x_t0: &'a [World3],
        x_t1: &'a [World3],
        radius: &'a (dyn Fn(u32) -> f64 + Sync),
    ) -> Body<'a> {
        let n = surface.n_vertices();
        assert_eq!((x_t0.len(), x_t1.len()), (n, n), "positions and vertices");
        Body { surface, x_t0, x_t1, radius, awake: None }
    }

    /// The same body, of whose vertices only some are awake: the searches of [`swept`](crate::swept) for
    /// what may come near leave pairs out of which no vertex is, and cost next to nothing for them.
    ///
    /// # Panics
    /// If there is not one mark for each vertex.
    #[must_use]
    pub fn awake(self, awake: &'a [bool]) -> Body<'a> {
        assert_eq!(awake.len(), self.surface.n_vertices(), "marks and vertices");
        Body { awake: Some(awake), ..self }
    }

    /// Whether all of its vertices are awake.
    #[inline]
    pub(crate) fn is_all_awake(&self) -> bool {
        self.awake.is_none()
    }

    /// Whether any of some vertices is awake.
    #[inline]
    pub(crate) fn has_awake(&self, vertices: &[u32]) -> bool {
        self.awake.is_none_or(|awake| vertices.iter().any(|&v| awake[v as usize]))
    }

    /// The surface.
    pub fn surface(&self) -> &'a Surface {
        self.surface
    }

    /// The tree over the triangles with their motion and room that searches need.
    pub fn tree(&self) -> Bvh {
        Bvh::build(self.surface.n_triangles(), |t| self.triangle_box(t))
    }

    /// Makes any tree over the triangles the one that searches need; see [`Bvh::update`].
    pub fn update_tree(&self, tree: &mut Bvh) -> bool {
        tree.update(self.surface.n_triangles(), |t| self.triangle_box(t))
    }

    fn triangle_box(&self, t: u32) -> Aabb {
        self.box_around(&self.surface.triangles()[t as usize])
    }

    #[inline]
    pub(crate) fn x_t0(&self) -> &'a [World3] {
        self.x_t0
    }

    #[inline]
    pub(crate) fn x_t1(&self) -> &'a [World3] {
        self.x_t1
    }

    /// The way of a vertex (m).
    #[inline]
    pub(crate) fn motion(&self, v: usize) -> World3 {
        self.x_t1[v] - self.x_t0[v]
    }

    /// The radius of a vertex (m).
    #[inline]
    pub(crate) fn radius(&self, v: u32) -> f64 {
        (self.radius)(v)
    }

    /// The largest radius of some vertices (m).
    #[inline]
    pub(crate) fn radius_of(&self, vertices: &[u32]) -> f64 {
        vertices.iter().map(|&v| (self.radius)(v)).fold(0.0, f64::max)
    }

    /// The box around the way of some vertices, with their room.
    #[inline]
    pub(crate) fn box_around(&self, vertices: &[u32]) -> Aabb {
        let of = |x: &'a [World3]| vertices.iter().map(|&v| &x[v as usize]);
        Aabb::around(of(self.x_t0).chain(of(self.x_t1))).grown(self.radius_of(vertices))
    }
}

/// A pair with what its test needs.
pub(crate) struct Candidate {
    pub(crate) pair: Pair,
    pub(crate) x_t0: [World3; 4],
    pub(crate) x_t1: [World3; 4],
    /// Sum of the two radii (m).
    pub(crate) thickness: f64,
}

impl Candidate {
    /// What the test of a pair of features of two bodies, or of one with itself, needs.
    #[inline]
    pub(crate) fn of(pair: Pair, a: Body<'_>, b: Body<'_>) -> Candidate {
        let vertices = pair.vertices(a.surface, b.surface);
        let of = |front: &[World3], rear: &[World3]| pair.positions(vertices, front, rear);
        let thickness = match (pair.kind, &vertices) {
            (PairKind::EdgeEdge, [p, q, r, s]) => a.radius_of(&[*p, *q]) + b.radius_of(&[*r, *s]),
            (PairKind::VertexTriangle, [v, p, q, r]) => {
                a.radius_of(&[*v]) + b.radius_of(&[*p, *q, *r])
            }
            (PairKind::TriangleVertex, [v, p, q, r]) => {
                b.radius_of(&[*v]) + a.radius_of(&[*p, *q, *r])
            }
        };
        Candidate { pair, x_t0: of(a.x_t0, b.x_t0), x_t1: of(a.x_t1, b.x_t1), thickness }
    }
}

/// A body with the boxes of its features: each is asked for many times.
struct Features<'a> {
    body: Body<'a>,
    vertices: Vec<Aabb>,
    edges: Vec<Aabb>,
    triangles: Vec<Aabb>,
}

impl<'a> Features<'a> {
    fn of(body: Body<'a>) -> Features<'a> {
        let s = body.surface;
        let mut all = Features {
            body,
            vertices: vec![Aabb::EMPTY; s.n_vertices()],
            edges: vec![Aabb::EMPTY; s.n_edges()],
            triangles: vec![Aabb::EMPTY; s.n_triangles()],
        };
        par::fill(&mut all.vertices, |v| body.box_around(&[v as u32]));
        par::fill(&mut all.edges, |e| body.box_around(&s.edges()[e]));
        par::fill(&mut all.triangles, |t| body.triangle_box(t as u32));
        all
    }

    /// Calls `found` with the vertices that a triangle owns and that are near.
    #[inline]
    fn vertices_near(&self, owner: u32, near: &Aabb, mut found: impl FnMut(u32)) {
        for v in self.body.surface.owned_vertices(owner) {
            if self.vertices[v as usize].overlaps(near) {
                found(v);
            }
        }
    }

    /// Calls `found` with the edges that a triangle owns and that are near.
    #[inline]
    fn edges_near(&self, owner: u32, near: &Aabb, mut found: impl FnMut(u32)) {
        for e in self.body.surface.owned_edges(owner) {
            if self.edges[e as usize].overlaps(near) {
                found(e);
            }
        }
    }
}

/// What `test` says about all pairs within a body whose boxes overlap, but for those with a vertex in
/// common, in ascending order of pairs.
pub(crate) fn search_within<T: Send>(
    body: Body<'_>,
    tree: &Bvh,
    test: impl Fn(&Candidate) -> Option<T> + Sync,
) -> Vec<(Pair, T)> {
    let own = Features::of(body);
    let surface = body.surface;
    let triangles = tree.self_pairs(|_, _| true);
    let mut found = par::collect(triangles.len(), |i, found| {
        let [a, b] = triangles[i];
        for (owner, other) in [(a, b), (b, a)] {
            let corners = surface.triangles()[other as usize];
            own.vertices_near(owner, &own.triangles[other as usize], |v| {
                if !corners.contains(&v) {
                    let pair = Pair { kind: PairKind::VertexTriangle, a: v, b: other };
                    ask(pair, body, body, &test, found);
                }
            });
        }
        own.edges_near(a, &own.triangles[b as usize], |e| {
            let [p, q] = surface.edges()[e as usize];
            own.edges_near(b, &own.edges[e as usize], |f| {
                let [r, s] = surface.edges()[f as usize];
                if (p != r) & (p != s) & (q != r) & (q != s) {
                    let pair = Pair { kind: PairKind::EdgeEdge, a: e.min(f), b: e.max(f) };
                    ask(pair, body, body, &test, found);
                }
            });
        });
    });
    found.sort_unstable_by_key(|(pair, _)| *pair);
    found
}

/// What `test` says about all pairs between two bodies whose boxes overlap, in ascending order of
/// pairs.
pub(crate) fn search_between<T: Send>(
    (a, tree_a): (Body<'_>, &Bvh),
    (b, tree_b): (Body<'_>, &Bvh),
    test: impl Fn(&Candidate) -> Option<T> + Sync,
) -> Vec<(Pair, T)> {
    let triangles = tree_a.pairs_with(tree_b, |_, _| true);
    if triangles.is_empty() {
        return Vec::new();
    }
    let (first, second) = (Features::of(a), Features::of(b));
    let mut found = par::collect(triangles.len(), |i, found| {
        let [s, t] = triangles[i];
        first.vertices_near(s, &second.triangles[t as usize], |v| {
            ask(Pair { kind: PairKind::VertexTriangle, a: v, b: t }, a, b, &test, found);
        });
        second.vertices_near(t, &first.triangles[s as usize], |v| {
            ask(Pair { kind: PairKind::TriangleVertex, a: s, b: v }, a, b, &test, found);
        });
        first.edges_near(s, &second.triangles[t as usize], |e| {
            second.edges_near(t, &first.edges[e as usize], |f| {
                ask(Pair { kind: PairKind::EdgeEdge, a: e, b: f }, a, b, &test, found);
            });
        });
    });
    found.sort_unstable_by_key(|(pair, _)| *pair);
    found
}

/// Tests one pair.
#[inline]
fn ask<T>(
    pair: Pair,
    a: Body<'_>,
    b: Body<'_>,
    test: &impl Fn(&Candidate) -> Option<T>,
    found: &mut Vec<(Pair, T)>,
) {
    found.extend(test(&Candidate::of(pair, a, b)).map(|answer| (pair, answer)));
}
