//! Merging a vertex into a neighbour.

use crate::edit::{Edit, Refusal};
use crate::geometry::{Material2, is_sound};
use crate::ids::{HalfEdge, NONE, TriangleId, VertexId};
use crate::mesh::Mesh;

impl Mesh {
    /// Checks whether `removed` may be merged into its neighbour `kept`; calls `changed` with the
    /// corners and new material corners (m; the moved corner first) of every triangle that would
    /// take a new shape, so that the caller can apply its own quality bounds in the same pass.
    ///
    /// Lines are kept: a vertex on a boundary, a seam or a change of panel only goes along that
    /// line, and only where the line is straight in material space, so no panel changes its area.
    pub fn can_collapse(
        &self,
        removed: VertexId,
        kept: VertexId,
        mut changed: impl FnMut([HalfEdge; 3], [Material2; 3]),
    ) -> Result<(), Refusal> {
        let (h, g) = (self.find(removed, kept), self.find(kept, removed));
        if h.is_none() && g.is_none() {
            return Err(Refusal::Topology);
        }
        self.check_link(removed, kept, h, g)?;

        let star = self.star_from(removed, h);
        let other_line = self.check_lines(&star, h, g)?;

        // Replace the vertex in each remaining triangle, with the coordinates of that side.
        let mut u_kept = match (h, g) {
            (Some(h), _) => self.corner_material(h.next()),
            (None, Some(g)) => self.corner_material(g),
            (None, None) => return Err(Refusal::Topology),
        };
        let dying = [h, g.map(HalfEdge::next)];
        for &e in &star {
            if Some(e) == other_line
                && let Some(g) = g
            {
                u_kept = self.corner_material(g);
            }
            if dying.contains(&Some(e)) {
                continue;
            }
            let corners = [u_kept, self.corner_material(e.next()), self.corner_material(e.prev())];
            if !is_sound(corners[0], corners[1], corners[2]) {
                return Err(Refusal::Inverted);
            }
            changed([e, e.next(), e.prev()], corners);
        }
        Ok(())
    }

    /// Link condition: the only common neighbours are those opposite the edge, and those keep
    /// enough triangles to stay proper vertices.
    fn check_link(
        &self,
        v: VertexId,
        w: VertexId,
        h: Option<HalfEdge>,
        g: Option<HalfEdge>,
    ) -> Result<(), Refusal> {
        let apexes = [h, g].map(|side| side.map(|e| self.opposite(e)));
        if apexes[0] == apexes[1] {
            return Err(Refusal::Topology);
        }
        for n in self.neighbours(v) {
            if n != w && !apexes.contains(&Some(n)) && self.adjacent(w, n) {
                return Err(Refusal::Topology);
            }
        }
        for n in apexes.into_iter().flatten() {
            let least = if self.is_boundary_vertex(n) { 2 } else { 4 };
            if self.outgoing(n).take(least).count() < least {
                return Err(Refusal::Topology);
            }
        }
        Ok(())
    }

    /// Outgoing half-edges counter-clockwise; round an inner vertex starting at `h`.
    fn star_from(&self, v: VertexId, h: Option<HalfEdge>) -> Vec<HalfEdge> {
        let mut star: Vec<HalfEdge> = self.outgoing(v).collect();
        if !self.is_boundary_vertex(v)
            && let Some(at) = star.iter().position(|&e| Some(e) == h)
        {
            star.rotate_left(at);
        }
        star
    }

    /// Lines through the vertex: none, or one that contains the edge and runs straight on. Returns
    /// the half-edge along the line's other arm if it lies inside the mesh.
    fn check_lines(
        &self,
        star: &[HalfEdge],
        h: Option<HalfEdge>,
        g: Option<HalfEdge>,
    ) -> Result<Option<HalfEdge>, Refusal> {
        let (Some(&first), Some(&last)) = (star.first(), star.last()) else {
            return Err(Refusal::Topology);
        };
        let straight = |a, b, c| if collinear(a, b, c) { Ok(()) } else { Err(Refusal::Feature) };
        let n_lines = star.iter().filter(|&&e| self.is_feature(e)).count();
        if self.is_boundary_edge(first) {
            let along_boundary = h == Some(first) || g == Some(last.prev());
            if n_lines != 1 || !along_boundary {
                return Err(Refusal::Feature);
            }
            let (u, u_first) = (self.corner_material(first), self.corner_material(first.next()));
            straight(u_first, u, self.corner_material(last.prev()))?;
            return Ok(None);
        }
        if n_lines == 0 {
            return Ok(None);
        }
        let (Some(h), Some(g)) = (h, g) else { return Err(Refusal::Topology) };
        if n_lines != 2 || !self.is_feature(h) {
            return Err(Refusal::Feature);
        }
        let other = star.iter().copied().find(|&e| e != h && self.is_feature(e));
        let (Some(other), Some(back)) = (other, other.and_then(|e| self.twin(e))) else {
            return Err(Refusal::Topology);
        };
        let at = |e: HalfEdge| self.corner_material(e);
        straight(at(h.next()), at(h), at(back))?;
        straight(at(g), at(g.next()), at(other.next()))?;
        Ok(Some(other))
    }

    /// Merges `removed` into its neighbour `kept`, which keeps its place.
    ///
    /// # Errors
    /// See [`Mesh::can_collapse`]; the mesh is then unchanged.
    pub fn collapse(&mut self, removed: VertexId, kept: VertexId) -> Result<Edit, Refusal> {
        let mut replaced: Vec<(HalfEdge, Material2)> = Vec::with_capacity(8);
        self.can_collapse(removed, kept, |[e, ..], [u, ..]| replaced.push((e, u)))?;
        let sides = [self.find(removed, kept), self.find(kept, removed)];

        for &(e, u) in &replaced {
            self.tri[e.triangle().index()][e.corner()] = kept.0;
            self.material[e.triangle().index()][e.corner()] = u;
        }
        // Close the gap of each dying triangle: its two outer edges become one.
        let mut anchors = [None; 4];
        for (k, side) in sides.into_iter().enumerate() {
            let Some(side) = side else { continue };
            let from_apex = self.twin[side.next().index()];
            let from_kept = self.twin[side.prev().index()];
            self.join(from_apex, from_kept);
            let (apex, around_kept) = survivors(from_apex, from_kept);
            anchors[2 * k] = Some((self.opposite(side), apex));
            anchors[2 * k + 1] = Some((kept, around_kept));
        }
        for (v, outgoing) in anchors.into_iter().flatten() {
            self.anchor(v, outgoing);
        }
        let mut gone = sides.map(|side| side.map(HalfEdge::triangle));
        if gone[1] > gone[0] {
            gone.swap(0, 1);
        }
        for t in gone.into_iter().flatten() {
            self.remove_triangle(t);
        }
        self.remove_vertex(removed);
        self.epoch += 1;
        Ok(Edit::Collapse { removed, kept, triangles: gone })
    }

    /// Frees a triangle's slot by moving the last one there.
    fn remove_triangle(&mut self, t: TriangleId) {
        let last = TriangleId(self.tri.len() as u32 - 1);
        self.tri.swap_remove(t.index());
        self.material.swap_remove(t.index());
        self.panel.swap_remove(t.index());
        if t != last {
            for k in 0..3 {
                let (from, to) = (last.half_edge(k), t.half_edge(k));
                self.twin[to.index()] = NONE;
                self.join(to.0, self.twin[from.index()]);
                let origin = self.origin(to).index();
                if self.out[origin] == from.0 {
                    self.out[origin] = to.0;
                }
            }
        }
        self.twin.truncate(3 * last.index());
    }

    /// Frees a vertex's index by renaming the last one.
    fn remove_vertex(&mut self, v: VertexId) {
        let last = VertexId(self.n_vertices() as u32 - 1);
        if v != last {
            let star: Vec<HalfEdge> = self.outgoing(last).collect();
            for h in star {
                self.tri[h.triangle().index()][h.corner()] = v.0;
            }
        }
        self.out.swap_remove(v.index());
        self.uid.swap_remove(v.index());
    }
}

/// Two outer twins that have just been joined (either may be absent): an outgoing half-edge of the
/// apex and one of the kept vertex.
fn survivors(from_apex: u32, from_kept: u32) -> (HalfEdge, HalfEdge) {
    let apex = if from_apex != NONE { HalfEdge(from_apex) } else { HalfEdge(from_kept).next() };
    let kept = if from_kept != NONE { HalfEdge(from_kept) } else { HalfEdge(from_apex).next() };
    (apex, kept)
}

/// True if `b` lies between `a` and `c` on a straight line, up to the rounding of coordinates.
fn collinear(a: Material2, b: Material2, c: Material2) -> bool {
    let (p, q) = (b - a, c - b);
    let scale = a.amax().max(b.amax()).max(c.amax());
    let twist = p.x * q.y - p.y * q.x;
    p.dot(&q) > 0.0 && twist.abs() <= 8.0 * f64::EPSILON * scale * (p.norm() + q.norm())
}
