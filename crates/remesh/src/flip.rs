//! Flips towards an anisotropic Delaunay triangulation.

use crate::driver::Driver;
use crate::metric::Metric;
use crate::quality::LARGEST_SIZE_SQUARED;
use mesh_core::geometry::{area_vector, aspect, signed_area};
use mesh_core::{HalfEdge, Material2, TriangleId, World3, par};

/// The angles opposite an edge must exceed π together by this much (the sine of it) before it is
/// flipped: near-circular arrangements stay as they are from call to call.
const FLIP_MARGIN: f64 = 0.1;

/// Least cosine of the angle between the two new faces in world space, unless they were folded
/// more sharply before.
const SHARPEST_FOLD: f64 = 0.5;

/// Flips around one edit, in one go; more than this means that the metric does not let them settle.
const MOST_FLIPS: usize = 200;

/// Least gain of a flip that repairs a triangle below the aspect bound.
const LEAST_REPAIR: f64 = 1.05;

/// An edge from a to b with the triangles (a, b, c) and (b, a, d) on its sides, in the chart of the
/// first one.
struct Quad<'m> {
    u: [Material2; 4],
    metrics: [&'m Metric; 4],
}

impl<'m> Quad<'m> {
    /// The two triangles of an edge `h` with twin `g` (meaningless on a seam).
    #[inline]
    fn of(driver: &'m Driver<'_>, h: HalfEdge, g: HalfEdge) -> Self {
        let material = driver.cloth.mesh.material();
        let (t, s) = (h.triangle().index(), g.triangle().index());
        let (ka, kd) = (h.corner(), g.prev().corner());
        let kb = if ka == 2 { 0 } else { ka + 1 };
        let kc = 3 - ka - kb;
        let (u, m) = (&material[t], &driver.metrics.corner[t]);
        Quad {
            u: [u[ka], u[kb], u[kc], material[s][kd]],
            metrics: [&m[ka], &m[kb], &m[kc], &driver.metrics.corner[s][kd]],
        }
    }

    /// True unless the opposite angles γ (at c) and δ (at d) in the mean metric exceed π together
    /// by more than the margin.
    #[inline]
    fn is_delaunay(&self) -> bool {
        let [a, b, c, d] = self.u;
        let [m_a, m_b, m_c, m_d] = self.metrics;
        let m = (*m_a + *m_b) + (*m_c + *m_d);
        let (ca, cb, da, db) = (a - c, b - c, a - d, b - d);
        let cross = |p: Material2, q: Material2| p.x * q.y - p.y * q.x;
        // sin(γ + δ) but for a positive factor: cross products in the metric carry √det M.
        let sine = cross(ca, cb) * m.dot(da, db) + cross(db, da) * m.dot(ca, cb);
        if sine >= 0.0 || sine.is_nan() {
            return true;
        }
        let norms =
            m.size_squared(ca) * m.size_squared(cb) * m.size_squared(da) * m.size_squared(db);
        sine * sine * m.determinant() <= FLIP_MARGIN * FLIP_MARGIN * norms
    }

    /// Squared size of the other diagonal.
    fn size_squared_across(&self) -> f64 {
        let across = self.u[3] - self.u[2];
        0.5 * (self.metrics[2].size_squared(across) + self.metrics[3].size_squared(across))
    }
}

impl Driver<'_> {
    /// Flips until no edge of the mesh asks for it.
    pub(crate) fn flip_all(&mut self) {
        let mut wanted = vec![[false; 3]; self.cloth.mesh.n_triangles()];
        {
            let this = &*self;
            par::fill(&mut wanted, |t| {
                let u = &this.cloth.mesh.material()[t];
                let is_low = this.may_be_low(u[0], u[1], u[2]);
                let mut three = [false; 3];
                for (k, wanted) in three.iter_mut().enumerate() {
                    let h = HalfEdge((3 * t + k) as u32);
                    if let Some(g) = this.cloth.mesh.twin(h) {
                        let suspect = is_low || (h < g && !Quad::of(this, h, g).is_delaunay());
                        *wanted = suspect && this.wants_flip(h);
                    }
                }
                three
            });
        }
        for (t, three) in wanted.iter().enumerate() {
            for k in (0..3).filter(|&k| three[k]) {
                self.flip_queue.push(HalfEdge((3 * t + k) as u32));
                self.settle();
            }
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
            let corners = [h, g, h.prev(), g.prev()].map(|e| self.cloth.mesh.origin(e));
            let Ok(edit) = self.cloth.flip(h) else { continue };
            self.metrics.follow_flip(h, g);
            self.flip_passes_limit_on(corners);
            self.journal.push(edit);
            let (t, s) = (h.triangle(), g.triangle());
            self.flipped.push([t, s]);
            let outer = [t.half_edge(0), t.half_edge(1), s.half_edge(0), s.half_edge(1)];
            self.flip_queue.extend(outer);
        }
    }

    /// True if flipping the edge is admissible and makes its surroundings more Delaunay, or repairs
    /// a triangle below the aspect bound.
    fn wants_flip(&self, h: HalfEdge) -> bool {
        let mesh = &self.cloth.mesh;
        let Some(g) = mesh.twin(h) else { return false };
        let quad = Quad::of(self, h, g);
        if quad.is_delaunay() && !self.flip_repairs(&quad.u) {
            return false;
        }
        // A valid edge must not become an invalid one; the others will be split anyway.
        if quad.size_squared_across() > LARGEST_SIZE_SQUARED
            && self.metrics.size_squared(mesh, h) <= LARGEST_SIZE_SQUARED
        {
            return false;
        }
        self.flip_is_admissible(h, g, &quad.u)
    }

    /// True if one of the triangles is below the aspect bound and the flip raises the lower of the
    /// two. The Delaunay criterion never takes it back: it may not lower what is below the bound.
    fn flip_repairs(&self, quad: &[Material2; 4]) -> bool {
        let [a, b, c, d] = *quad;
        if !self.may_be_low(a, b, c) && !self.may_be_low(b, a, d) {
            return false;
        }
        let before = aspect(a, b, c).min(aspect(b, a, d));
        let after = aspect(d, b, c).min(aspect(c, a, d));
        before < self.settings.aspect_min && after > LEAST_REPAIR * before
    }

    /// False only if the triangle's aspect is above the bound: with Q the sum of its squared edges
    /// the squared perimeter is at most 3 Q, so the aspect 12√3 A / p² is at least 4√3 A / Q.
    #[inline]
    pub(crate) fn may_be_low(&self, a: Material2, b: Material2, c: Material2) -> bool {
        let q = (b - a).norm_squared() + (c - b).norm_squared() + (a - c).norm_squared();
        6.92 * signed_area(a, b, c) < self.settings.aspect_min * q
    }

    /// The bounds that do not depend on the metric.
    fn flip_is_admissible(&self, h: HalfEdge, g: HalfEdge, quad: &[Material2; 4]) -> bool {
        let mesh = &self.cloth.mesh;
        if (self.metrics.may_be_line(mesh, h) && mesh.is_feature(h)) || self.is_locked(h) {
            return false;
        }
        if [h, g, h.prev(), g.prev()].into_iter().any(|e| self.held[mesh.origin(e).index()]) {
            return false;
        }
        let [a, b, c, d] = *quad;
        let before = aspect(a, b, c).min(aspect(b, a, d));
        let after = aspect(d, b, c).min(aspect(c, a, d));
        if after < self.settings.aspect_min && after < before {
            return false;
        }
        let ends = [h, g, h.prev(), g.prev()].map(|e| mesh.origin(e));
        let x = ends.map(|v| self.cloth.x[v.index()]);
        !flip_folds(&x)
            && self.flip_keeps_strain(mesh.panels()[h.triangle().index()], quad, &x)
            && self.flip_stays_near([ends[0], ends[1]], quad, &x)
            && mesh.can_flip(h).is_ok()
    }

    /// True if the flip puts no strain into the cloth beyond what is allowed.
    fn flip_keeps_strain(&self, panel: u32, u: &[Material2; 4], x: &[World3; 4]) -> bool {
        let pick = |places: [usize; 3]| (places.map(|i| u[i]), places.map(|i| x[i]));
        self.keeps_strain(
            panel,
            [pick([0, 1, 2]), pick([1, 0, 3])],
            [pick([3, 1, 2]), pick([2, 0, 3])],
        )
    }

    /// Queues all edges of a triangle for a check.
    #[inline]
    pub(crate) fn queue_flips(&mut self, t: TriangleId) {
        self.flip_queue.extend([t.half_edge(0), t.half_edge(1), t.half_edge(2)]);
    }
}

/// True if the two new faces would lie across each other in world space.
fn flip_folds(&[a, b, c, d]: &[World3; 4]) -> bool {
    let cosine = |n: World3, m: World3| {
        let norms = (n.norm_squared() * m.norm_squared()).sqrt();
        if norms > 0.0 { n.dot(&m) / norms } else { 1.0 }
    };
    let before = cosine(area_vector(a, b, c), area_vector(b, a, d));
    let after = cosine(area_vector(d, b, c), area_vector(c, a, d));
    // Written so that positions that are not numbers refuse.
    !(after >= SHARPEST_FOLD || after >= before)
}
