//! Metrics on the corners of triangles: evaluated on faces, averaged to vertices chart by chart,
//! carried through edits like the material coordinates beside them.

use crate::context::SizingContext;
use crate::field::SizingField;
use crate::metric::Metric;
use crate::settings::{RemeshError, RemeshSettings};
use mesh_core::{Blend, ClothState, HalfEdge, Mesh, TriangleId, VertexId, par};

/// One metric per triangle corner.
///
/// A vertex on a seam belongs to several charts, whose axes have nothing to do with each other, so
/// a metric belongs to a *sector*: the corners around a vertex between two feature edges (boundary,
/// seam, change of panel). All corners of a sector hold the same bits. Stored per corner, a sector
/// needs no name of its own: a split, flip or collapse copies metrics exactly as it copies material
/// coordinates, each side of an edge its own.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerMetrics {
    pub(crate) corner: Vec<[Metric; 3]>,
    /// True for vertices where a feature edge inside the mesh ends.
    pub(crate) on_line: Vec<bool>,
    pub(crate) epoch: u64,
    /// Answers of the field that were not valid.
    pub(crate) n_bad: usize,
}

/// Stands for the size of an edge that is listed elsewhere.
pub(crate) const NOT_HERE: f64 = -1.0;

/// A face's metric and the weight it has in the averages.
#[derive(Clone, Copy, Default)]
struct Face {
    metric: Metric,
    area: f64,
    /// True for its edges that are feature edges inside the mesh, at the lower half-edge.
    lines: [bool; 3],
}

impl CornerMetrics {
    /// Asks the field for every triangle's metric and averages them to the corners, weighted by
    /// material area (Narain2012 §4.1). Invalid answers are replaced by the coarsest valid one, and
    /// anisotropy is limited to the settings' `aspect_min`.
    ///
    /// # Errors
    /// If the settings are out of range or the obstacle metric does not fit the mesh.
    pub fn evaluate<S: SizingField + ?Sized>(
        cloth: &ClothState,
        field: &S,
        settings: &RemeshSettings<'_>,
    ) -> Result<CornerMetrics, RemeshError> {
        settings.check()?;
        let mesh = &cloth.mesh;
        let expected = mesh.n_triangles();
        if let Some(got) = settings.obstacle.map(<[Metric]>::len).filter(|&got| got != expected) {
            return Err(RemeshError::Obstacle { expected, got });
        }
        let context = SizingContext::new(cloth, settings.obstacle);
        let mut faces = vec![Face::default(); mesh.n_triangles()];
        par::fill(&mut faces, |t| {
            let at = TriangleId(t as u32);
            let metric = if settings.fixed_panels.contains(&mesh.panels()[t]) {
                Metric::ZERO
            } else {
                field.metric(&context, at)
            };
            let limited = metric.limit_anisotropy(settings.aspect_min);
            let metric = if metric.is_valid() { limited } else { INVALID };
            Face { metric, area: mesh.area(at), lines: inner_lines(mesh, t) }
        });
        let n_bad = replace_invalid(&mut faces);
        let (corner, on_line) = to_corners(mesh, &faces);
        Ok(CornerMetrics { corner, on_line, epoch: mesh.epoch(), n_bad })
    }

    /// The metrics at a triangle's corners (1/m²).
    pub fn at(&self, t: TriangleId) -> [Metric; 3] {
        self.corner[t.index()]
    }

    /// The metric at the corner a half-edge starts from (1/m²).
    #[inline]
    pub(crate) fn of(&self, h: HalfEdge) -> &Metric {
        &self.corner[h.0 as usize / 3][h.corner()]
    }

    /// Squared size of an edge in the chart of this half-edge's own side.
    #[inline]
    pub(crate) fn side_size_squared(&self, mesh: &Mesh, h: HalfEdge) -> f64 {
        let t = h.0 as usize / 3;
        let (k, l) = (h.corner(), h.next().corner());
        let u = mesh.material()[t][l] - mesh.material()[t][k];
        let [p, q] = [k, l].map(|k| self.corner[t][k].size_squared(u));
        0.5 * (p + q)
    }

    /// Squared size of an edge, Koh2014 Eq. (1): the larger of its two sides, which differ on seams
    /// and changes of panel only (no unit).
    #[inline]
    pub fn size_squared(&self, mesh: &Mesh, h: HalfEdge) -> f64 {
        let own = self.side_size_squared(mesh, h);
        match mesh.twin(h) {
            Some(g) if self.may_be_line(mesh, h) => own.max(self.side_size_squared(mesh, g)),
            _ => own,
        }
    }

    /// False only if the edge is no feature edge inside the mesh.
    #[inline]
    pub(crate) fn may_be_line(&self, mesh: &Mesh, h: HalfEdge) -> bool {
        self.on_line[mesh.origin(h).index()] && self.on_line[mesh.dest(h).index()]
    }

    /// Squared sizes of a triangle's edges; [`NOT_HERE`] for those that the triangle on their other
    /// side answers for.
    #[inline]
    pub(crate) fn edge_sizes(&self, mesh: &Mesh, t: usize) -> [f64; 3] {
        let (u, m) = (&mesh.material()[t], &self.corner[t]);
        let mut sizes = [NOT_HERE; 3];
        for (k, size) in sizes.iter_mut().enumerate() {
            let l = if k == 2 { 0 } else { k + 1 };
            let h = HalfEdge((3 * t + k) as u32);
            let twin = mesh.twin(h);
            if twin.is_some_and(|g| g < h) {
                continue;
            }
            let e = u[l] - u[k];
            *size = 0.5 * (m[k].size_squared(e) + m[l].size_squared(e));
            if let Some(g) = twin
                && self.may_be_line(mesh, h)
            {
                *size = size.max(self.side_size_squared(mesh, g));
            }
        }
        sizes
    }

    /// Follows the split of `h` (and its twin `g`), which has just been made; `on_line` tells
    /// whether they are the two sides of a feature edge.
    pub(crate) fn follow_split(&mut self, h: HalfEdge, g: Option<HalfEdge>, on_line: bool) {
        self.on_line.push(on_line);
        for side in [Some(h), g].into_iter().flatten() {
            let corner = &mut self.corner[side.triangle().index()];
            let (k, l, m) = (side.corner(), side.next().corner(), side.prev().corner());
            let middle = corner[k].midpoint(&corner[l]);
            let child = [middle, corner[l], corner[m]];
            corner[l] = middle;
            self.corner.push(child);
        }
        self.epoch += 1;
    }

    /// Follows the flip of `h` with twin `g`, which has just been made.
    pub(crate) fn follow_flip(&mut self, h: HalfEdge, g: HalfEdge) {
        let [a, b, c] = [h, h.next(), h.prev()].map(|e| *self.of(e));
        let d = *self.of(g.prev());
        self.corner[h.triangle().index()] = [d, b, c];
        self.corner[g.triangle().index()] = [c, a, d];
        self.epoch += 1;
    }

    /// Follows a collapse, which has just been made: `moved` are the corners that went to the kept
    /// vertex, with the metric of their side, numbered as before the edit.
    pub(crate) fn follow_collapse(
        &mut self,
        removed: VertexId,
        gone: [Option<TriangleId>; 2],
        moved: &[(HalfEdge, Metric)],
    ) {
        for (h, metric) in moved {
            self.corner[h.triangle().index()][h.corner()] = *metric;
        }
        for t in gone.into_iter().flatten() {
            self.corner.swap_remove(t.index());
        }
        self.on_line.swap_remove(removed.index());
        self.epoch += 1;
    }
}

/// Stands for every answer that is not valid.
const INVALID: Metric = Metric::new(f64::NAN, f64::NAN, f64::NAN);

/// Replaces invalid metrics by the smallest eigenvalue of the valid ones in all directions; returns
/// how many there were.
fn replace_invalid(faces: &mut [Face]) -> usize {
    let n_bad = faces.iter().filter(|f| f.metric.trace().is_nan()).count();
    if n_bad > 0 {
        let valid = faces.iter().filter(|f| !f.metric.trace().is_nan());
        let coarsest =
            valid.map(|f| f.metric.eigenvalues()[1].max(0.0)).fold(f64::INFINITY, f64::min);
        let coarsest = if coarsest.is_finite() { coarsest } else { 0.0 };
        for face in faces.iter_mut().filter(|f| f.metric.trace().is_nan()) {
            face.metric = Metric::new(coarsest, 0.0, coarsest);
        }
    }
    n_bad
}

/// Which edges of a triangle are feature edges inside the mesh, told at the lower half-edge.
#[inline]
fn inner_lines(mesh: &Mesh, t: usize) -> [bool; 3] {
    let mut lines = [false; 3];
    for (k, line) in lines.iter_mut().enumerate() {
        let h = HalfEdge((3 * t + k) as u32);
        *line = mesh.twin(h).is_some_and(|g| h < g) && mesh.is_feature(h);
    }
    lines
}

/// Averages face metrics over the sectors of every vertex.
fn to_corners(mesh: &Mesh, faces: &[Face]) -> (Vec<[Metric; 3]>, Vec<bool>) {
    let mut on_line = vec![false; mesh.n_vertices()];
    for (t, face) in faces.iter().enumerate() {
        for k in (0..3).filter(|&k| face.lines[k]) {
            let corners = mesh.triangles()[t];
            on_line[corners[k] as usize] = true;
            on_line[corners[(k + 1) % 3] as usize] = true;
        }
    }
    let mut vertices = vec![Metric::ZERO; mesh.n_vertices()];
    par::fill(&mut vertices, |v| {
        let mut average = Average::default();
        if !on_line[v] {
            for h in mesh.outgoing(VertexId(v as u32)) {
                average.add(&faces[h.triangle().index()]);
            }
        }
        average.value()
    });
    let mut corner = vec![[Metric::ZERO; 3]; mesh.n_triangles()];
    par::fill(&mut corner, |t| {
        let corners = mesh.triangles()[t];
        let mut metrics = [Metric::ZERO; 3];
        for (k, metric) in metrics.iter_mut().enumerate() {
            let v = corners[k] as usize;
            *metric = if on_line[v] {
                sector_average(mesh, faces, HalfEdge((3 * t + k) as u32))
            } else {
                vertices[v]
            };
        }
        metrics
    });
    (corner, on_line)
}

/// Average over the sector that holds the corner a half-edge starts from; the vertex lies on at
/// least one feature edge.
fn sector_average(mesh: &Mesh, faces: &[Face], corner: HalfEdge) -> Metric {
    let mut first = corner;
    while !mesh.is_feature(first)
        && let Some(g) = mesh.twin(first)
    {
        first = g.next();
    }
    let mut average = Average::default();
    let mut at = first;
    loop {
        average.add(&faces[at.triangle().index()]);
        match mesh.twin(at.prev()) {
            Some(g) if !mesh.is_feature(g) => at = g,
            _ => return average.value(),
        }
    }
}

/// Area-weighted mean as the first metric plus mean deviation: the mean of equal metrics is that
/// metric to the bit, so a constant field stays constant.
#[derive(Default)]
struct Average {
    first: Metric,
    deviation: Metric,
    area: f64,
}

impl Average {
    #[inline]
    fn add(&mut self, face: &Face) {
        if self.area == 0.0 {
            self.first = face.metric;
        }
        self.deviation = self.deviation + (face.metric + self.first * -1.0) * face.area;
        self.area += face.area;
    }

    #[inline]
    fn value(&self) -> Metric {
        if self.area > 0.0 { self.first + self.deviation * (1.0 / self.area) } else { self.first }
    }
}
