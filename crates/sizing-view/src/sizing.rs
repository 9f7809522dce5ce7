//! The sizing field around another one.

use crate::factors::ViewFactors;
use crate::screen::{bounded, root};
use mesh_core::TriangleId;
use remesh::{Metric, SizingContext, SizingField};

/// Any sizing field, made as coarse as the view allows: M ↦ v² M (Koh2014 Eq. (2)), then no finer
/// than ℓ_min in the picture (Eq. (5)–(8)), then no coarser than the settings' `size_max` (or the field
/// itself, if that is coarser) and no narrower than their `aspect_min`. Of several cameras and times the finest counts, by the tensor maximum.
///
/// Where v = 1 and the picture resolves all that the field asks for, the metric is the field's own, to
/// the bit. View factors of another state of the mesh give metrics that are not valid, which the
/// remesher counts.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewSizing<'a, S> {
    field: S,
    factors: &'a ViewFactors,
    coarsest: &'a [f64],
}

impl<'a, S: SizingField> ViewSizing<'a, S> {
    /// The field as seen with these view factors.
    pub fn new(field: S, factors: &'a ViewFactors) -> ViewSizing<'a, S> {
        ViewSizing { field, factors, coarsest: &[] }
    }

    /// The same with a limit of its own for every panel, beside the settings' `size_max`: coarsening
    /// makes no edge longer than this (m), by the panel's index. Panels beyond the slice have none.
    #[must_use]
    pub fn with_limits(self, coarsest: &'a [f64]) -> ViewSizing<'a, S> {
        ViewSizing { coarsest, ..self }
    }
}

impl<S: SizingField> SizingField for ViewSizing<'_, S> {
    fn metric(&self, context: &SizingContext<'_>, at: TriangleId) -> Metric {
        let mesh = &context.cloth.mesh;
        let is_theirs = self.factors.epoch() == mesh.epoch()
            && self.factors.values().len() == mesh.n_triangles();
        if !is_theirs {
            return Metric::new(f64::NAN, f64::NAN, f64::NAN);
        }
        let wanted = self.field.metric(context, at);
        let settings = self.factors.settings();
        // The field's own wish for coarseness goes before ours against it.
        let of_panel = self.coarsest.get(mesh.panels()[at.index()] as usize);
        let limit = of_panel.map_or(settings.size_max, |limit| limit.min(settings.size_max));
        let coarsest = limit.max(1.0 / wanted.eigenvalues()[1].max(0.0).sqrt());
        let (mut seen, mut n) = (Metric::ZERO, 0);
        for (factor, finest) in self.factors.wishes(at) {
            let metric = bounded(wanted * (factor * factor), finest);
            if metric == wanted {
                return wanted;
            }
            // Before the maximum: two narrow tensors that are nearly parallel would add up in it.
            seen = seen.max(metric.clamp(0.0, coarsest, settings.aspect_min));
            n += 1;
        }
        if n > 1 {
            // Of two that are below the field, the maximum need not be.
            seen = bounded(seen, &root(wanted));
        }
        seen
    }
}
