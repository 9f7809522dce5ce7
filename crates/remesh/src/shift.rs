//! How far an edit moves the surface.
//!
//! A flip or a collapse replaces facets by others, which where cloth is curved lie elsewhere. In a
//! picture that is a jump from one frame to the next ("pop"). A split moves nothing.

use crate::driver::Driver;
use crate::star::{Removal, Star};
use mesh_core::geometry::inverse_edges;
use mesh_core::{HalfEdge, Material2, VertexId, World3};
use nalgebra::Matrix3;

impl Driver<'_> {
    /// Vertices answer for their triangles, so whoever takes over a part of one takes its limit over, too.
    fn pass_limit_on(&mut self, limit: Matrix3<f64>, to: &[VertexId]) {
        for v in to {
            let own = &mut self.shift[v.index()];
            if limit.trace() > own.trace() {
                *own = limit;
            }
        }
    }

    /// The limit of the new vertex of a split edge; to be called for all of them.
    pub(crate) fn split_passes_limit_on(&mut self, ends: [VertexId; 2]) {
        if !self.shift.is_empty() {
            self.shift.push(Matrix3::zeros());
            let new = [VertexId(self.shift.len() as u32 - 1)];
            ends.into_iter().for_each(|v| self.pass_limit_on(self.shift[v.index()], &new));
        }
    }

    /// The limits of the corners across an edge that was flipped.
    pub(crate) fn flip_passes_limit_on(&mut self, [a, b, c, d]: [VertexId; 4]) {
        if !self.shift.is_empty() {
            let [p, q] = [a, b].map(|v| self.shift[v.index()]);
            self.pass_limit_on(if p.trace() <= q.trace() { p } else { q }, &[c, d]);
        }
    }

    /// The limits around a vertex that was removed; to be called for all of them.
    pub(crate) fn collapse_passes_limit_on(&mut self, removed: VertexId, ring: &[VertexId]) {
        if !self.shift.is_empty() {
            self.pass_limit_on(self.shift[removed.index()], ring);
            self.shift.swap_remove(removed.index());
        }
    }

    /// True if the surface may be moved by `shift` (m) at a vertex.
    fn may_shift(&self, v: VertexId, shift: &World3) -> bool {
        shift.dot(&(self.shift[v.index()] * shift)) <= 1.0
    }

    /// True if a flip of the edge from a to b, with the corners c and d across, moves the surface by no
    /// more than is allowed. It moves it most where the two diagonals cross.
    pub(crate) fn flip_stays_near(
        &self,
        [a, b]: [VertexId; 2],
        u: &[Material2; 4],
        x: &[World3; 4],
    ) -> bool {
        if self.shift.is_empty() {
            return true;
        }
        let (s, t) = crossing([u[0], u[1]], [u[2], u[3]]);
        let shift = (x[2] + (x[3] - x[2]) * t) - (x[0] + (x[1] - x[0]) * s);
        self.may_shift(a, &shift) && self.may_shift(b, &shift)
    }

    /// True if a collapse moves the surface by no more than is allowed. It moves it most where the vertex
    /// was or where a new edge crosses an old one.
    pub(crate) fn collapse_stays_near(&self, v: VertexId, star: &Star, removal: &Removal) -> bool {
        if self.shift.is_empty() || self.shift[v.index()] == Matrix3::zeros() {
            return true;
        }
        let mesh = &self.cloth.mesh;
        let place = |h: HalfEdge| (mesh.corner_material(h), self.cloth.x[mesh.origin(h).index()]);
        // The new triangle that the vertex would lie on: it has the greatest of the least weights.
        let mut on: (f64, World3) = (f64::NEG_INFINITY, World3::repeat(f64::NAN));
        for (e, side) in removal.survivors(star) {
            let corners = [side, e.next(), e.prev()].map(place);
            let u = corners.map(|(u, _)| u);
            let s = inverse_edges(u) * (mesh.corner_material(e) - u[0]);
            let weights = [1.0 - s.x - s.y, s.x, s.y];
            let least = weights.into_iter().fold(f64::INFINITY, f64::min);
            if least > on.0 {
                on = (least, corners.iter().zip(weights).map(|((_, x), weight)| x * weight).sum());
            }
        }
        let new_edge_is_near = |(e, side): (HalfEdge, HalfEdge)| {
            let ((u, x), (u_end, x_end)) = (place(side), place(e.prev()));
            // Those on the same side of a line through the vertex.
            let around = removal.survivors(star).filter(|(_, other)| *other == side);
            around.flat_map(|(e, _)| [(e, e.next()), (e, e.prev())]).all(|(e, old)| {
                let ((u_v, x_v), (u_old, x_old)) = (place(e), place(old));
                let (s, t) = crossing([u, u_end], [u_v, u_old]);
                let apart = !(s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0);
                apart || self.may_shift(v, &((x + (x_end - x) * s) - (x_v + (x_old - x_v) * t)))
            })
        };
        self.may_shift(v, &(on.1 - self.cloth.x[v.index()]))
            && removal.survivors(star).all(new_edge_is_near)
    }
}

/// Where the lines through two pairs of points cross: how far along either (1).
fn crossing([a, b]: [Material2; 2], [c, d]: [Material2; 2]) -> (f64, f64) {
    let (p, q, from) = (b - a, d - c, c - a);
    let area = p.perp(&q);
    (from.perp(&q) / area, from.perp(&p) / area)
}
