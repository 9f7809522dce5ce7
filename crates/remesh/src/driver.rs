//! The driver: flip to Delaunay, split what is too long, collapse what can go.

use crate::corners::CornerMetrics;
use crate::field::SizingField;
use crate::quality::MeshQuality;
use crate::report::RemeshReport;
use crate::settings::{RemeshError, RemeshSettings};
use mesh_core::{ClothState, Edit, HalfEdge, Mesh, TriangleId, par};
use nalgebra::Matrix3;

/// Adapts the mesh to a sizing field (Narain2012 §4): evaluates the field once on every triangle,
/// then [`adapt`]s.
///
/// # Errors
/// If a setting is out of range or does not fit the mesh; nothing is changed then.
pub fn remesh<S: SizingField + ?Sized>(
    cloth: &mut ClothState,
    field: &S,
    settings: &RemeshSettings<'_>,
) -> Result<RemeshReport, RemeshError> {
    let mut metrics = CornerMetrics::evaluate(cloth, field, settings)?;
    adapt(cloth, &mut metrics, settings)
}

/// Adapts the mesh to metrics that are already at hand, which follow the edits.
///
/// Three passes: flip edges until the mesh is Delaunay in the metric; split invalid edges, the
/// longest first, each followed by flips around it; collapse edges, the shortest first, each
/// followed by flips around it. No collapse and no flip makes a valid edge invalid, so at the end
/// every edge is valid, unless the vertex limit stopped the splits or the edge lies beside a longer
/// one that must not be split (on a fixed panel) and a half would have been too thin
/// ([`MeshQuality::n_invalid`]); no further collapse is admissible; and a second call with the
/// metrics as they are now makes no edit.
///
/// The cost is one scan of the mesh plus the edits. It ends on every input: splits are bounded by
/// the vertex limit, collapses by the number of vertices, flips around one edit by a constant.
///
/// # Errors
/// If a setting is out of range or does not fit the mesh, or the metrics belong to another state of the
/// mesh; nothing is changed then.
pub fn adapt(
    cloth: &mut ClothState,
    metrics: &mut CornerMetrics,
    settings: &RemeshSettings<'_>,
) -> Result<RemeshReport, RemeshError> {
    settings.check()?;
    let (expected, got) = (cloth.mesh.epoch(), metrics.epoch);
    if expected != got {
        return Err(RemeshError::Stale { expected, got });
    }
    settings.check_shift(cloth.mesh.n_vertices())?;
    let mut driver = Driver::new(cloth, metrics, settings);
    driver.flip_all();
    driver.split_invalid();
    driver.collapse_all();
    Ok(driver.finish())
}

/// The state of a call.
pub(crate) struct Driver<'a> {
    pub(crate) cloth: &'a mut ClothState,
    pub(crate) metrics: &'a mut CornerMetrics,
    pub(crate) settings: &'a RemeshSettings<'a>,
    /// Vertices that must not be removed.
    pub(crate) kept: Vec<bool>,
    /// Vertices around which edges are only split.
    pub(crate) held: Vec<bool>,
    /// By vertex, the metric of how far the surface may be moved (1/m²); empty for no limit.
    pub(crate) shift: Vec<Matrix3<f64>>,
    /// Panels that must not be touched; empty if there are none.
    fixed: Vec<bool>,
    pub(crate) journal: Vec<Edit>,
    /// Squared sizes of all edges at the last [`Driver::measure_edges`].
    pub(crate) sizes: Vec<[f64; 3]>,
    sizes_epoch: Option<u64>,
    /// Edges whose quadrilateral changed: to be checked for a flip.
    pub(crate) flip_queue: Vec<HalfEdge>,
    /// Triangles that took part in the flips of the last [`Driver::settle`].
    pub(crate) flipped: Vec<[TriangleId; 2]>,
    pub(crate) n_flip_limits: usize,
    pub(crate) vertex_limit_reached: bool,
}

/// Which vertices have one of these names.
fn marked(mesh: &Mesh, names: &[u64]) -> Vec<bool> {
    if names.is_empty() {
        return vec![false; mesh.n_vertices()];
    }
    let mut names = names.to_vec();
    names.sort_unstable();
    mesh.uids().iter().map(|uid| names.binary_search(uid).is_ok()).collect()
}

impl<'a> Driver<'a> {
    fn new(
        cloth: &'a mut ClothState,
        metrics: &'a mut CornerMetrics,
        settings: &'a RemeshSettings<'a>,
    ) -> Self {
        let kept = marked(&cloth.mesh, settings.keep);
        let held = marked(&cloth.mesh, settings.hold);
        let mut fixed = Vec::new();
        if !settings.fixed_panels.is_empty() {
            fixed = vec![false; cloth.densities().len()];
            for &panel in settings.fixed_panels {
                if let Some(slot) = fixed.get_mut(panel as usize) {
                    *slot = true;
                }
            }
        }
        Driver {
            cloth,
            metrics,
            settings,
            kept,
            held,
            shift: settings.shift.to_vec(),
            fixed,
            journal: Vec::new(),
            sizes: Vec::new(),
            sizes_epoch: None,
            flip_queue: Vec::new(),
            flipped: Vec::new(),
            n_flip_limits: 0,
            vertex_limit_reached: false,
        }
    }

    /// True if there are fixed panels.
    pub(crate) fn has_fixed(&self) -> bool {
        !self.fixed.is_empty()
    }

    /// True if a triangle belongs to a fixed panel.
    #[inline]
    pub(crate) fn is_fixed(&self, t: TriangleId) -> bool {
        !self.fixed.is_empty() && self.fixed[self.cloth.mesh.panels()[t.index()] as usize]
    }

    /// True if a triangle at the edge belongs to a fixed panel.
    #[inline]
    pub(crate) fn is_locked(&self, h: HalfEdge) -> bool {
        !self.fixed.is_empty()
            && (self.is_fixed(h.triangle())
                || self.cloth.mesh.twin(h).is_some_and(|g| self.is_fixed(g.triangle())))
    }

    /// Sizes all edges, unless nothing has changed since the last time.
    pub(crate) fn measure_edges(&mut self) {
        let mesh = &self.cloth.mesh;
        if self.sizes_epoch != Some(mesh.epoch()) {
            self.sizes_epoch = Some(mesh.epoch());
            self.sizes.resize(mesh.n_triangles(), [0.0; 3]);
            par::fill(&mut self.sizes, |t| self.metrics.edge_sizes(mesh, t));
        }
    }

    /// Leaves the cloth without a history and reports.
    fn finish(mut self) -> RemeshReport {
        if !self.journal.is_empty() {
            self.cloth.normalise();
        }
        self.measure_edges();
        let count = |kind: fn(&Edit) -> bool| self.journal.iter().filter(|e| kind(e)).count();
        let quality =
            MeshQuality::measure(&self.cloth.mesh, &self.sizes, self.settings.aspect_min, |h| {
                self.is_locked(h)
            });
        RemeshReport {
            n_splits: count(|e| matches!(e, Edit::Split { .. })),
            n_flips: count(|e| matches!(e, Edit::Flip { .. })),
            n_collapses: count(|e| matches!(e, Edit::Collapse { .. })),
            n_bad_metrics: self.metrics.n_bad,
            vertex_limit_reached: self.vertex_limit_reached,
            n_flip_limits: self.n_flip_limits,
            quality,
            journal: self.journal,
        }
    }
}
