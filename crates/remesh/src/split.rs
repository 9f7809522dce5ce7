//! Splitting invalid edges, the longest first.

use crate::driver::Driver;
use crate::quality::LARGEST_SIZE_SQUARED;
use mesh_core::{HalfEdge, TriangleId, par};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// An invalid edge: the bits of its squared size (positive, so they sort like it), then the lower
/// half-edge first.
type Entry = (u64, Reverse<u32>);

impl Driver<'_> {
    /// Splits until no edge is invalid, each time flipping around the new vertex.
    pub(crate) fn split_invalid(&mut self) {
        let mut queue = self.invalid_edges();
        let mut last = None;
        while let Some(entry) = queue.pop() {
            if last.replace(entry) == Some(entry) {
                continue;
            }
            let (bits, Reverse(h)) = entry;
            let h = HalfEdge(h);
            // Edits renumber half-edges; whoever changes an edge queues it anew.
            if self.metrics.size_squared(&self.cloth.mesh, h).to_bits() != bits {
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
        let on_line = g.is_some() && self.cloth.mesh.is_feature(h);
        // Refused if a half would be too thin: the edge stays invalid until a neighbour changes.
        let Ok(edit) = self.cloth.split(h) else { return };
        self.metrics.follow_split(h, g, on_line);
        self.kept.push(false);
        self.journal.push(edit);

        let children = (n_triangles..self.cloth.mesh.n_triangles() as u32).map(TriangleId);
        let parents = [Some(h), g].into_iter().flatten().map(HalfEdge::triangle);
        for t in parents.chain(children) {
            self.queue_flips(t);
            self.queue_splits(t, queue);
        }
        self.settle();
        for k in 0..self.flipped.len() {
            for t in self.flipped[k] {
                self.queue_splits(t, queue);
            }
        }
    }

    /// Queues the invalid edges of a triangle.
    fn queue_splits(&self, t: TriangleId, queue: &mut BinaryHeap<Entry>) {
        for h in [t.half_edge(0), t.half_edge(1), t.half_edge(2)] {
            let size_squared = self.metrics.size_squared(&self.cloth.mesh, h);
            if size_squared > LARGEST_SIZE_SQUARED && !self.is_locked(h) {
                let canonical = self.cloth.mesh.twin(h).map_or(h, |g| g.min(h));
                queue.push((size_squared.to_bits(), Reverse(canonical.0)));
            }
        }
    }

    /// All invalid edges that may be split.
    fn invalid_edges(&self) -> BinaryHeap<Entry> {
        let mesh = &self.cloth.mesh;
        let mut sizes = vec![0.0; 3 * mesh.n_triangles()];
        par::fill(&mut sizes, |h| {
            let h = HalfEdge(h as u32);
            if mesh.is_canonical(h) { self.metrics.size_squared(mesh, h) } else { 0.0 }
        });
        let invalid = sizes.iter().enumerate().filter(|(_, s)| **s > LARGEST_SIZE_SQUARED);
        let free = invalid.filter(|(h, _)| !self.is_locked(HalfEdge(*h as u32)));
        free.map(|(h, s)| (s.to_bits(), Reverse(h as u32))).collect()
    }
}
