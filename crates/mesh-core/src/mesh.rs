//! The corner table and its read-only queries.

use crate::geometry::{Material2, signed_area};
use crate::ids::{HalfEdge, NONE, TriangleId, VertexId};

/// A manifold, oriented triangle mesh (several components, any boundary) with material coordinates
/// on its corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    pub(crate) tri: Vec<[u32; 3]>,
    pub(crate) material: Vec<[Material2; 3]>,
    pub(crate) panel: Vec<u32>,
    pub(crate) twin: Vec<u32>,
    /// One outgoing half-edge per vertex; on the boundary the clockwise-most one (it has no twin).
    pub(crate) out: Vec<u32>,
    pub(crate) uid: Vec<u64>,
    pub(crate) next_uid: u64,
    pub(crate) epoch: u64,
}

impl Mesh {
    /// Number of vertices.
    pub fn n_vertices(&self) -> usize {
        self.out.len()
    }

    /// Number of triangles.
    pub fn n_triangles(&self) -> usize {
        self.tri.len()
    }

    /// Number of edits so far: fields compare it to notice that they missed one.
    pub fn epoch(&self) -> u64 {
        self.epoch
    }

    /// The index buffer: vertex indices of every triangle, counter-clockwise in material space.
    #[inline]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.tri
    }

    /// Material coordinates of every triangle's corners (m).
    #[inline]
    pub fn material(&self) -> &[[Material2; 3]] {
        &self.material
    }

    /// The panel of every triangle: an index into the caller's list of fabrics and settings.
    #[inline]
    pub fn panels(&self) -> &[u32] {
        &self.panel
    }

    /// Lasting names of the vertices, never reused.
    pub fn uids(&self) -> &[u64] {
        &self.uid
    }

    /// The uid that the next new vertex will get.
    pub fn next_uid(&self) -> u64 {
        self.next_uid
    }

    /// All vertices.
    pub fn vertices(&self) -> impl Iterator<Item = VertexId> + use<> {
        (0..self.n_vertices() as u32).map(VertexId)
    }

    /// All triangles.
    pub fn triangle_ids(&self) -> impl Iterator<Item = TriangleId> + use<> {
        (0..self.n_triangles() as u32).map(TriangleId)
    }

    /// Every edge once, as one of its half-edges.
    pub fn edges(&self) -> impl Iterator<Item = HalfEdge> + '_ {
        (0..self.twin.len() as u32).map(HalfEdge).filter(|&h| self.is_canonical(h))
    }

    /// True for exactly one half-edge of each edge.
    #[inline]
    pub fn is_canonical(&self, h: HalfEdge) -> bool {
        let twin = self.twin[h.index()];
        twin == NONE || h.0 < twin
    }

    /// The vertex a half-edge starts from.
    #[inline]
    pub fn origin(&self, h: HalfEdge) -> VertexId {
        VertexId(self.tri[h.0 as usize / 3][h.corner()])
    }

    /// The vertex a half-edge points to.
    #[inline]
    pub fn dest(&self, h: HalfEdge) -> VertexId {
        self.origin(h.next())
    }

    /// The vertex opposite a half-edge in its triangle.
    #[inline]
    pub fn opposite(&self, h: HalfEdge) -> VertexId {
        self.origin(h.prev())
    }

    /// The other half of the edge, or `None` on the boundary.
    #[inline]
    pub fn twin(&self, h: HalfEdge) -> Option<HalfEdge> {
        let twin = self.twin[h.index()];
        (twin != NONE).then_some(HalfEdge(twin))
    }

    /// Material coordinate of the corner a half-edge starts from (m).
    #[inline]
    pub fn corner_material(&self, h: HalfEdge) -> Material2 {
        self.material[h.0 as usize / 3][h.corner()]
    }

    /// The edge as a vector in the material space of this half-edge's own side (m).
    #[inline]
    pub fn material_edge(&self, h: HalfEdge) -> Material2 {
        self.corner_material(h.next()) - self.corner_material(h)
    }

    /// Material area of a triangle (m²).
    #[inline]
    pub fn area(&self, t: TriangleId) -> f64 {
        let [a, b, c] = self.material[t.index()];
        signed_area(a, b, c)
    }

    /// Sum of the material areas (m²).
    pub fn total_area(&self) -> f64 {
        self.triangle_ids().map(|t| self.area(t)).sum()
    }

    /// True where the edge has no triangle on its other side.
    #[inline]
    pub fn is_boundary_edge(&self, h: HalfEdge) -> bool {
        self.twin[h.index()] == NONE
    }

    /// True where the boundary passes through the vertex.
    #[inline]
    pub fn is_boundary_vertex(&self, v: VertexId) -> bool {
        self.twin[self.out[v.index()] as usize] == NONE
    }

    /// True where the two sides of an edge have different material coordinates: panels are sewn
    /// together here.
    #[inline]
    pub fn is_seam(&self, h: HalfEdge) -> bool {
        self.twin(h).is_some_and(|g| {
            self.corner_material(h) != self.corner_material(g.next())
                || self.corner_material(h.next()) != self.corner_material(g)
        })
    }

    /// True where remeshing must keep the edge's line: boundary, seam, or change of panel.
    #[inline]
    pub fn is_feature(&self, h: HalfEdge) -> bool {
        match self.twin(h) {
            None => true,
            Some(g) => {
                self.panel[h.triangle().index()] != self.panel[g.triangle().index()]
                    || self.is_seam(h)
            }
        }
    }

    /// The outgoing half-edges of a vertex, counter-clockwise; on the boundary from one boundary
    /// edge to the last triangle.
    #[inline]
    pub fn outgoing(&self, v: VertexId) -> impl Iterator<Item = HalfEdge> + '_ {
        let first = HalfEdge(self.out[v.index()]);
        let mut at = Some(first);
        std::iter::from_fn(move || {
            let h = at?;
            at = self.twin(h.prev()).filter(|&g| g != first);
            Some(h)
        })
    }

    /// The neighbours of a vertex, counter-clockwise.
    #[inline]
    pub fn neighbours(&self, v: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        let last =
            self.outgoing(v).last().map(HalfEdge::prev).filter(|&h| self.is_boundary_edge(h));
        self.outgoing(v).map(|h| self.dest(h)).chain(last.map(|h| self.origin(h)))
    }

    /// The half-edge from `a` to `b` if their edge has one in that direction.
    #[inline]
    pub fn find(&self, a: VertexId, b: VertexId) -> Option<HalfEdge> {
        self.outgoing(a).find(|&h| self.dest(h) == b)
    }

    /// True if the two vertices share an edge.
    #[inline]
    pub fn adjacent(&self, a: VertexId, b: VertexId) -> bool {
        self.neighbours(a).any(|n| n == b)
    }

    /// Vertices − edges + triangles.
    pub fn euler_characteristic(&self) -> i64 {
        self.n_vertices() as i64 - self.edges().count() as i64 + self.n_triangles() as i64
    }

    /// Chooses every vertex's first outgoing half-edge as [`Mesh::new`] does: the one without a
    /// twin, or else the lowest. Edits leave inner vertices with any; sums around a vertex then
    /// depend in their last bits on how the mesh came about.
    pub fn normalise(&mut self) {
        self.out.fill(NONE);
        for h in 0..self.twin.len() {
            let v = self.tri[h / 3][h % 3] as usize;
            if self.out[v] == NONE || self.twin[h] == NONE {
                self.out[v] = h as u32;
            }
        }
    }

    /// Makes `out[v]` the clockwise-most outgoing half-edge, starting from any outgoing one.
    pub(crate) fn anchor(&mut self, v: VertexId, any_outgoing: HalfEdge) {
        debug_assert_eq!(self.origin(any_outgoing), v);
        let mut h = any_outgoing;
        while let Some(g) = self.twin(h) {
            h = g.next();
            if h == any_outgoing {
                break;
            }
        }
        self.out[v.index()] = h.0;
    }

    /// Joins two half-edges as twins; either may be absent.
    pub(crate) fn join(&mut self, a: u32, b: u32) {
        if a != NONE {
            self.twin[a as usize] = b;
        }
        if b != NONE {
            self.twin[b as usize] = a;
        }
    }
}
