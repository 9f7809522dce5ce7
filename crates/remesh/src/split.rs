//! Splitting invalid edges, the longest first.

use crate::driver::Driver;
use crate::quality::LARGEST_SIZE_SQUARED;
use mesh_core::geometry::aspect;
use mesh_core::{HalfEdge, TriangleId, VertexId};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// An invalid edge: the bits of its squared size (positive, so they sort like it), then the lower
/// half-edge first.
type Entry = (u64, Reverse<u32>);

impl Driver<'_> {
    /// Splits until no edge is invalid, each time flipping around the new vertex.
    pub(crate) fn split_invalid(&mut self) {
        let mut queue = self.invalid_edges();
        while let Some((bits, Reverse(h))) = queue.pop() {
            let h = HalfEdge(h);
            // Edits renumber half-edges; whoever changes an edge queues it anew. An entry may come up
            // twice for two edges: on regular meshes sizes are the same to the bit.
            if self.metrics.size_squared(&self.cloth.mesh, h).to_bits() != bits {
                continue;
            }
            if self.is_held(h) {
                continue;
            }
            if self.cloth.mesh.n_vertices() >= self.settings.max_vertices {
                self.vertex_limit_reached = true;
                return;
            }
            self.split_edge(h, &mut queue);
        }
    }

    fn split_edge(&mut self, h: HalfEdge, queue: &mut BinaryHeap<Entry>) {
        let n_triangles = self.cloth.mesh.n_triangles() as u32;
        let g = self.cloth.mesh.twin(h);
        let ends = [h, h.next()].map(|e| self.cloth.mesh.origin(e));
        let on_line = g.is_some() && self.cloth.mesh.is_feature(h);
        // Refused if a half would be too thin to have a clear orientation.
        let Ok(edit) = self.cloth.split(h) else { return };
        self.metrics.follow_split(h, g, on_line);
        self.kept.push(false);
        let new = VertexId(self.held.len() as u32);
        let is_held = self.cloth.mesh.neighbours(new).any(|i| self.held[i.index()]);
        self.held.push(is_held);
        self.split_passes_limit_on(ends);
        self.journal.push(edit);

        // Halves, spokes and the outer edges, of which those of the new triangles are renumbered.
        let mut child = TriangleId(n_triangles);
        for side in [Some(h), g].into_iter().flatten() {
            let (half, spoke, outer) = (child.half_edge(0), side.next(), child.half_edge(1));
            self.flip_queue.extend([half, spoke, outer, side.prev()]);
            for e in [half, spoke, outer, side.prev()] {
                self.queue_split(e, queue);
            }
            if g.is_none() {
                self.queue_split(side, queue);
            }
            child.0 += 1;
        }
        self.settle();
        for [t, s] in &self.flipped {
            // The new diagonal is the last edge of both.
            for e in
                [t.half_edge(0), t.half_edge(1), t.half_edge(2), s.half_edge(0), s.half_edge(1)]
            {
                self.queue_split(e, queue);
            }
        }
    }

    /// True if a longer edge in one of its triangles, which could not be split, holds the edge back:
    /// a half would fall below the aspect bound. Cloth sewn to a fixed panel would be cut into
    /// slivers along the seam otherwise, because the sides over a long base can never be short.
    ///
    /// Edges are split the longest first, so a longer one in the same triangle has been refused.
    fn is_held(&self, h: HalfEdge) -> bool {
        let mesh = &self.cloth.mesh;
        let size_squared = self.metrics.size_squared(mesh, h);
        [Some(h), mesh.twin(h)].into_iter().flatten().any(|side| {
            let is_longer = |e| self.metrics.size_squared(mesh, e) > size_squared;
            let [a, b, c] = [side, side.next(), side.prev()].map(|e| mesh.corner_material(e));
            let middle = (a + b) * 0.5;
            (is_longer(side.next()) || is_longer(side.prev()))
                && aspect(a, middle, c).min(aspect(middle, b, c)) < self.settings.aspect_min
        })
    }

    /// Queues an edge if it is invalid.
    fn queue_split(&self, h: HalfEdge, queue: &mut BinaryHeap<Entry>) {
        let size_squared = self.metrics.size_squared(&self.cloth.mesh, h);
        if size_squared > LARGEST_SIZE_SQUARED && !self.is_locked(h) {
            let canonical = self.cloth.mesh.twin(h).map_or(h, |g| g.min(h));
            queue.push((size_squared.to_bits(), Reverse(canonical.0)));
        }
    }

    /// All invalid edges that may be split.
    fn invalid_edges(&mut self) -> BinaryHeap<Entry> {
        self.measure_edges();
        let mut queue = Vec::new();
        for (t, sizes) in self.sizes.iter().enumerate() {
            for (k, size_squared) in sizes.iter().enumerate() {
                let h = HalfEdge((3 * t + k) as u32);
                if *size_squared > LARGEST_SIZE_SQUARED && !self.is_locked(h) {
                    queue.push((size_squared.to_bits(), Reverse(h.0)));
                }
            }
        }
        queue.into()
    }
}
