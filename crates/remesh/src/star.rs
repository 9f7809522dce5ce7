//! The triangles around a vertex and what they become when the vertex is merged into a neighbour.

use crate::driver::Driver;
use crate::metric::Metric;
use mesh_core::geometry::{area_vector, aspect};
use mesh_core::{HalfEdge, Material2, Mesh, VertexId};

/// Up to this many spokes need no allocation.
const INLINE: usize = 16;

/// Least cosine between the normals of a face before and after a collapse, in world space.
const SHARPEST_TURN: f64 = 0.5;

/// A position in a ring of `n`, from one below 2 n.
#[inline]
fn wrap(i: usize, n: usize) -> usize {
    if i < n { i } else { i - n }
}

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

    /// True if the boundary passes through the vertex.
    pub(crate) fn is_open(&self) -> bool {
        self.open
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
            .map(move |i| (spokes[wrap(i, spokes.len())], sides[usize::from(i >= line)]))
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
            let before = spokes[wrap(j + n - 1, n)];
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

    /// The removals that leave only valid edges, with the squared size of the edge they go along:
    /// every edge that one makes is shorter than 1 − hysteresis, both in the metric of its new end
    /// and in that of the vertex it replaces. Else the fine spot that the vertex stood for would be
    /// forgotten, and found again in the next call.
    pub(crate) fn valid_removals(&self, v: VertexId, star: &Star) -> Vec<(f64, Removal)> {
        let sized = |r: Removal| (self.metrics.size_squared(&self.cloth.mesh, r.edge), r);
        if star.open || self.metrics.on_line[v.index()] || star.n > INLINE {
            let is_valid = |r: &Removal| self.leaves_valid_edges(star, r);
            return self.removals(v, star).filter(is_valid).map(sized).collect();
        }
        match self.valid_inner_removals(star) {
            0 => Vec::new(),
            valid => {
                let ways = self.removals(v, star).enumerate();
                ways.filter(|(j, _)| valid >> j & 1 == 1).map(|(_, r)| sized(r)).collect()
            }
        }
    }

    /// [`Driver::valid_removals`] for the usual vertex, inside, off all lines and of low degree, as
    /// bits by the position of the spoke. Every neighbour has one place and one metric then.
    fn valid_inner_removals(&self, star: &Star) -> u32 {
        let limit = (1.0 - self.settings.hysteresis).powi(2);
        let spokes = star.spokes();
        let n = spokes.len();
        let mut ring = [(Material2::zeros(), Metric::ZERO); INLINE];
        for (slot, h) in ring.iter_mut().zip(spokes) {
            let (t, k) = (h.triangle().index(), h.corner());
            let l = if k == 2 { 0 } else { k + 1 };
            *slot = (self.cloth.mesh.material()[t][l], self.metrics.corner[t][l]);
        }
        let ring = &ring[..n];
        let removed = *self.metrics.of(spokes[0]);
        let is_short = |kept: usize, end: usize| {
            let ((u_kept, m_kept), (u_end, m_end)) = (&ring[kept], &ring[end]);
            new_size_squared(u_end - u_kept, m_end, m_kept, &removed) <= limit
        };
        let mut valid = 0;
        for j in 0..n {
            // New edges to all but the two neighbours next to it. The one across the star is the
            // longest as a rule: look at it first.
            let is_valid = n < 4
                || is_short(j, wrap(j + n / 2, n))
                    && (j + 2..j + n - 1).all(|i| is_short(j, wrap(i, n)));
            valid |= u32::from(is_valid) << j;
        }
        valid
    }

    /// True if the removal, along a line or of a vertex of high degree, leaves only valid edges.
    fn leaves_valid_edges(&self, star: &Star, removal: &Removal) -> bool {
        let limit = (1.0 - self.settings.hysteresis).powi(2);
        let spokes = star.spokes();
        let n = spokes.len();
        let (first, count) = (removal.first, removal.n_survivors);
        // Every survivor answers for its edge to the next one; what is left over is the edge at
        // either end of a boundary and the second side of a line.
        let is_short = |i: usize| {
            let e = spokes[wrap(first + i, n)];
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
        let [m_end, m_kept, m_removed] = [end, kept, at].map(|h| self.metrics.of(h));
        new_size_squared(u, m_end, m_kept, m_removed) <= limit
    }

    /// True if no surviving triangle falls below the aspect bound (or gets worse where it is below)
    /// and none turns sharply in world space.
    pub(crate) fn keeps_shape(&self, star: &Star, removal: &Removal) -> bool {
        let mesh = &self.cloth.mesh;
        let x_kept = self.cloth.x[removal.kept.index()];
        removal.survivors(star).all(|(e, side)| {
            let [v, p, q] = [e, e.next(), e.prev()].map(|h| mesh.corner_material(h));
            let kept = mesh.corner_material(side);
            if self.may_be_low(kept, p, q) {
                let new = aspect(kept, p, q);
                if new < self.settings.aspect_min && new < aspect(v, p, q) {
                    return false;
                }
            }
            let [x_v, x_p, x_q] =
                [e, e.next(), e.prev()].map(|h| self.cloth.x[mesh.origin(h).index()]);
            let (old, new) = (area_vector(x_v, x_p, x_q), area_vector(x_kept, x_p, x_q));
            let (dot, squares) = (old.dot(&new), old.norm_squared() * new.norm_squared());
            let is_even = dot > 0.0 && dot * dot > SHARPEST_TURN * SHARPEST_TURN * squares;
            let panel = mesh.panels()[e.triangle().index()];
            let (before, after) =
                (([v, p, q], [x_v, x_p, x_q]), ([kept, p, q], [x_kept, x_p, x_q]));
            (is_even || old.norm_squared() == 0.0) && self.keeps_strain(panel, [before], [after])
        })
    }
}

/// Squared size of the edge that a removal makes, in the metric of its ends or of the removed vertex
/// in place of the kept one, whichever is larger.
#[inline]
fn new_size_squared(u: Material2, end: &Metric, kept: &Metric, removed: &Metric) -> f64 {
    0.5 * (end.size_squared(u) + kept.size_squared(u).max(removed.size_squared(u)))
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
