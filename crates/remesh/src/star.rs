//! The triangles around a vertex and what they become when the vertex is merged into a neighbour.

use crate::driver::Driver;
use mesh_core::geometry::{area_vector, aspect};
use mesh_core::{HalfEdge, Mesh, VertexId};

/// Up to this many spokes need no allocation.
const INLINE: usize = 16;

/// Least cosine between the normals of a face before and after a collapse, in world space.
const SHARPEST_TURN: f64 = 0.5;

/// The outgoing half-edges of a vertex, counter-clockwise.
pub(crate) struct Star {
    inline: [HalfEdge; INLINE],
    n: usize,
    spill: Vec<HalfEdge>,
    /// True if the boundary passes through the vertex.
    open: bool,
}

/// One way to merge a star's vertex into a neighbour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Removal {
    /// The neighbour.
    pub(crate) kept: VertexId,
    /// The first triangle that survives, as a position in the star, and how many do.
    first: usize,
    n_survivors: usize,
    /// The corners that stand for the kept vertex: for survivors before `line`, and from there on.
    sides: [HalfEdge; 2],
    /// Position of the spoke, past `first`, on the other side of which the second side begins.
    line: usize,
    /// True if the boundary vertex at the far end of the star, or at its start, gets a new edge.
    open_end: bool,
    open_start: bool,
    /// The edge itself, as a half-edge in either direction.
    pub(crate) edge: HalfEdge,
}

impl Star {
    /// Walks round a vertex.
    #[inline]
    pub(crate) fn of(mesh: &Mesh, v: VertexId) -> Star {
        let mut star = Star {
            inline: [HalfEdge(0); INLINE],
            n: 0,
            spill: Vec::new(),
            open: mesh.is_boundary_vertex(v),
        };
        for h in mesh.outgoing(v) {
            if star.n < INLINE {
                star.inline[star.n] = h;
            } else {
                if star.n == INLINE {
                    star.spill.extend_from_slice(&star.inline);
                }
                star.spill.push(h);
            }
            star.n += 1;
        }
        star
    }

    /// The half-edges.
    #[inline]
    pub(crate) fn spokes(&self) -> &[HalfEdge] {
        if self.n <= INLINE { &self.inline[..self.n] } else { &self.spill }
    }
}

impl Removal {
    /// The surviving triangles, each by its corner that moves and the corner it moves to.
    pub(crate) fn survivors<'s>(
        &self,
        star: &'s Star,
    ) -> impl Iterator<Item = (HalfEdge, HalfEdge)> + use<'s> {
        let (first, line, sides) = (self.first, self.line, self.sides);
        let spokes = star.spokes();
        (first..first + self.n_survivors)
            .map(move |i| (spokes[i % spokes.len()], sides[usize::from(i >= line)]))
    }
}

impl Driver<'_> {
    /// The ways to remove a vertex that keep the lines through it: any neighbour if there is none,
    /// else the neighbours along its one line.
    pub(crate) fn removals<'s>(
        &'s self,
        v: VertexId,
        star: &'s Star,
    ) -> impl Iterator<Item = Removal> + 's {
        let mesh = &self.cloth.mesh;
        let spokes = star.spokes();
        let n = spokes.len();
        // Feature spokes inside the mesh: at most two matter.
        let mut lines = [usize::MAX; 2];
        let mut n_lines = 0;
        if self.metrics.on_line[v.index()] {
            for (i, &h) in spokes.iter().enumerate() {
                if !mesh.is_boundary_edge(h) && mesh.is_feature(h) {
                    if n_lines < 2 {
                        lines[n_lines] = i;
                    }
                    n_lines += 1;
                }
            }
        }
        let ways = match (star.open, n_lines) {
            (false, 0) => n,
            (false, 2) | (true, 0) => 2,
            _ => 0,
        };
        (0..ways).map(move |way| {
            if star.open {
                return boundary_removal(mesh, spokes, way);
            }
            let (j, line) = match n_lines {
                0 => (way, usize::MAX),
                _ => (lines[way], lines[1 - way]),
            };
            let h = spokes[j];
            let before = spokes[(j + n - 1) % n];
            Removal {
                kept: mesh.dest(h),
                first: j + 1,
                n_survivors: n - 2,
                sides: [h.next(), before.prev()],
                line: if line < j { line + n } else { line },
                open_end: false,
                open_start: false,
                edge: h,
            }
        })
    }

    /// True if every edge that the removal makes is shorter than 1 − hysteresis, both in the metric
    /// of its new end and in that of the vertex it replaces: else the fine spot that the vertex
    /// stood for would be forgotten, and found again in the next call.
    pub(crate) fn leaves_valid_edges(&self, star: &Star, removal: &Removal) -> bool {
        let limit = (1.0 - self.settings.hysteresis).powi(2);
        let spokes = star.spokes();
        let n = spokes.len();
        let (first, count) = (removal.first, removal.n_survivors);
        // Every survivor answers for its edge to the next one; what is left over is the edge at
        // either end of a boundary and the second side of a line.
        let is_short = |i: usize| {
            let e = spokes[(first + i) % n];
            let side = removal.sides[usize::from(first + i >= removal.line)];
            let next_is_new = i + 1 < count || removal.open_end;
            let own_is_new = first + i == removal.line || (i == 0 && removal.open_start);
            (!next_is_new || self.new_edge_is_short(e, e.prev(), side, limit))
                && (!own_is_new || self.new_edge_is_short(e, e.next(), side, limit))
        };
        // The edge across the star is the longest as a rule: look at it first.
        count == 0 || (is_short(count.saturating_sub(2) / 2) && (0..count).all(is_short))
    }

    #[inline]
    fn new_edge_is_short(&self, at: HalfEdge, end: HalfEdge, kept: HalfEdge, limit: f64) -> bool {
        let mesh = &self.cloth.mesh;
        let u = mesh.corner_material(end) - mesh.corner_material(kept);
        let q_end = self.metrics.of(end).size_squared(u);
        let q_kept = self.metrics.of(kept).size_squared(u);
        let q_removed = self.metrics.of(at).size_squared(u);
        0.5 * (q_end + q_kept.max(q_removed)) <= limit
    }

    /// True if no surviving triangle falls below the aspect bound (or gets worse where it is below)
    /// and none turns sharply in world space.
    pub(crate) fn keeps_shape(&self, star: &Star, removal: &Removal) -> bool {
        let mesh = &self.cloth.mesh;
        let x_kept = self.cloth.x[removal.kept.index()];
        removal.survivors(star).all(|(e, side)| {
            let [v, p, q] = [e, e.next(), e.prev()].map(|h| mesh.corner_material(h));
            let new = aspect(mesh.corner_material(side), p, q);
            if new < self.settings.aspect_min && new < aspect(v, p, q) {
                return false;
            }
            let [x_v, x_p, x_q] =
                [e, e.next(), e.prev()].map(|h| self.cloth.x[mesh.origin(h).index()]);
            let (old, new) = (area_vector(x_v, x_p, x_q), area_vector(x_kept, x_p, x_q));
            let norms = (old.norm_squared() * new.norm_squared()).sqrt();
            old.norm_squared() == 0.0 || old.dot(&new) > SHARPEST_TURN * norms
        })
    }
}

/// Removal of a boundary vertex along the first (0) or the last (1) boundary edge of its star.
fn boundary_removal(mesh: &Mesh, spokes: &[HalfEdge], way: usize) -> Removal {
    let n = spokes.len();
    let (edge, kept_corner, first) = if way == 0 {
        (spokes[0], spokes[0].next(), 1)
    } else {
        let last = spokes[n - 1].prev();
        (last, last, 0)
    };
    Removal {
        kept: mesh.origin(kept_corner),
        first,
        n_survivors: n - 1,
        sides: [kept_corner; 2],
        line: usize::MAX,
        open_end: way == 0,
        open_start: way == 1,
        edge,
    }
}
