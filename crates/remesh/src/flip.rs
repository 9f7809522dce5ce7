//! Flips towards an anisotropic Delaunay triangulation.

use crate::driver::Driver;
use crate::quality::LARGEST_SIZE_SQUARED;
use mesh_core::geometry::{area_vector, aspect};
use mesh_core::{HalfEdge, Material2, TriangleId, par};

/// The angles opposite an edge must exceed π together by this much (the sine of it) before it is
/// flipped: near-circular arrangements stay as they are from call to call.
const FLIP_MARGIN: f64 = 0.1;

/// Least cosine of the angle between the two new faces in world space, unless they were folded
/// more sharply before.
const SHARPEST_FOLD: f64 = 0.5;

/// Flips around one edit, in one go; more than this means that the metric does not let them settle.
const MOST_FLIPS: usize = 200;

impl Driver<'_> {
    /// Flips until no edge of the mesh asks for it.
    pub(crate) fn flip_all(&mut self) {
        let mut wanted = vec![false; 3 * self.cloth.mesh.n_triangles()];
        {
            let this = &*self;
            par::fill(&mut wanted, |h| {
                let h = HalfEdge(h as u32);
                this.cloth.mesh.is_canonical(h) && this.wants_flip(h)
            });
        }
        for h in (0..wanted.len()).filter(|&h| wanted[h]) {
            self.flip_queue.push(HalfEdge(h as u32));
            self.settle();
        }
    }

    /// Flips queued edges and, in turn, the edges around them. [`Driver::flipped`] then names the
    /// triangles that changed.
    pub(crate) fn settle(&mut self) {
        self.flipped.clear();
        while let Some(h) = self.flip_queue.pop() {
            if !self.wants_flip(h) {
                continue;
            }
            if self.flipped.len() == MOST_FLIPS {
                self.n_flip_limits += 1;
                self.flip_queue.clear();
                return;
            }
            let Some(g) = self.cloth.mesh.twin(h) else { continue };
            let Ok(edit) = self.cloth.flip(h) else { continue };
            self.metrics.follow_flip(h, g);
            self.journal.push(edit);
            let (t, s) = (h.triangle(), g.triangle());
            self.flipped.push([t, s]);
            let outer = [t.half_edge(0), t.half_edge(1), s.half_edge(0), s.half_edge(1)];
            self.flip_queue.extend(outer);
        }
    }

    /// True if flipping the edge is admissible and makes its surroundings more Delaunay.
    #[inline]
    fn wants_flip(&self, h: HalfEdge) -> bool {
        let mesh = &self.cloth.mesh;
        let Some(g) = mesh.twin(h) else { return false };
        let (t, s) = (h.triangle().index(), g.triangle().index());
        let [ka, kb, kc, kd] =
            [h.corner(), h.next().corner(), h.prev().corner(), g.prev().corner()];
        let u = &mesh.material()[t];
        let quad = [u[ka], u[kb], u[kc], mesh.material()[s][kd]];
        let corner = &self.metrics.corner[t];
        let metrics = [corner[ka], corner[kb], corner[kc], self.metrics.corner[s][kd]];

        // Opposite angles γ (at c) and δ (at d) in the mean metric: flip where sin(γ + δ) < 0.
        let sum = (metrics[0] + metrics[1]) + (metrics[2] + metrics[3]);
        let (ca, cb) = (quad[0] - quad[2], quad[1] - quad[2]);
        let (da, db) = (quad[0] - quad[3], quad[1] - quad[3]);
        let cross = |p: Material2, q: Material2| p.x * q.y - p.y * q.x;
        let sine = cross(ca, cb) * sum.dot(da, db) + cross(db, da) * sum.dot(ca, cb);
        let norms = sum.size_squared(ca)
            * sum.size_squared(cb)
            * sum.size_squared(da)
            * sum.size_squared(db);
        let is_delaunay =
            !(sine < 0.0 && sine * sine * sum.determinant() > FLIP_MARGIN * FLIP_MARGIN * norms);
        if is_delaunay && !self.flip_repairs(&quad) {
            return false;
        }
        // A valid edge must not become an invalid one; the others will be split anyway.
        let across = quad[3] - quad[2];
        let new = 0.5 * (metrics[2].size_squared(across) + metrics[3].size_squared(across));
        if new > LARGEST_SIZE_SQUARED && self.metrics.size_squared(mesh, h) <= LARGEST_SIZE_SQUARED
        {
            return false;
        }
        self.flip_is_admissible(h, g, &quad)
    }

    fn flip_repairs(&self, quad: &[Material2; 4]) -> bool {
        let [a, b, c, d] = *quad;
        let bound = self.settings.aspect_min;
        let low = |p: Material2, q: Material2, r: Material2| {
            let sum = (q - p).norm_squared() + (r - q).norm_squared() + (p - r).norm_squared();
            6.92 * mesh_core::geometry::signed_area(p, q, r) < bound * sum
        };
        if !low(a, b, c) && !low(b, a, d) {
            return false;
        }
        let before = aspect(a, b, c).min(aspect(b, a, d));
        let after = aspect(d, b, c).min(aspect(c, a, d));
        before < bound && after > 1.05 * before
    }

    /// The bounds that do not depend on the metric.
    fn flip_is_admissible(&self, h: HalfEdge, g: HalfEdge, quad: &[Material2; 4]) -> bool {
        let mesh = &self.cloth.mesh;
        let on_line = |e: HalfEdge| self.metrics.on_line[mesh.origin(e).index()];
        if (on_line(h) && on_line(g) && mesh.is_feature(h)) || self.is_locked(h) {
            return false;
        }
        let [a, b, c, d] = *quad;
        let before = aspect(a, b, c).min(aspect(b, a, d));
        let after = aspect(d, b, c).min(aspect(c, a, d));
        if after < self.settings.aspect_min && after < before {
            return false;
        }
        !self.flip_folds(h, g) && mesh.can_flip(h).is_ok()
    }

    /// True if the two new faces would lie across each other in world space.
    fn flip_folds(&self, h: HalfEdge, g: HalfEdge) -> bool {
        let x = |e: HalfEdge| self.cloth.x[self.cloth.mesh.origin(e).index()];
        let [a, b, c, d] = [x(h), x(g), x(h.prev()), x(g.prev())];
        let cosine = |n: mesh_core::World3, m: mesh_core::World3| {
            let norms = (n.norm_squared() * m.norm_squared()).sqrt();
            if norms > 0.0 { n.dot(&m) / norms } else { 1.0 }
        };
        let before = cosine(area_vector(a, b, c), area_vector(b, a, d));
        let after = cosine(area_vector(d, b, c), area_vector(c, a, d));
        // Written so that positions that are not numbers refuse.
        !(after >= SHARPEST_FOLD || after >= before)
    }

    /// Queues all edges of a triangle for a check.
    #[inline]
    pub(crate) fn queue_flips(&mut self, t: TriangleId) {
        self.flip_queue.extend([t.half_edge(0), t.half_edge(1), t.half_edge(2)]);
    }
}
