//! The sizing field: the wish for resolution, and its simple combinators.

use crate::context::SizingContext;
use crate::metric::Metric;
use mesh_core::TriangleId;

/// A wish for resolution: how finely each triangle should be meshed.
///
/// The driver evaluates it once per triangle and call, in parallel, on the mesh as it is before the
/// first edit.
pub trait SizingField: Send + Sync {
    /// The metric wanted at triangle `at` (1/m²). Pure: the same context gives the same answer. An
    /// answer that is not [valid](Metric::is_valid) counts as the coarsest one of the call and is
    /// reported.
    fn metric(&self, context: &SizingContext<'_>, at: TriangleId) -> Metric;
}

impl<S: SizingField + ?Sized> SizingField for &S {
    fn metric(&self, context: &SizingContext<'_>, at: TriangleId) -> Metric {
        (**self).metric(context, at)
    }
}

impl<S: SizingField + ?Sized> SizingField for Box<S> {
    fn metric(&self, context: &SizingContext<'_>, at: TriangleId) -> Metric {
        (**self).metric(context, at)
    }
}

/// The same size everywhere and in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uniform {
    /// Longest edge (m).
    pub size: f64,
}

impl SizingField for Uniform {
    fn metric(&self, _: &SizingContext<'_>, _: TriangleId) -> Metric {
        Metric::uniform(self.size)
    }
}

/// As fine as the finer of two fields, direction by direction: the tensor maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaxOf<A, B>(pub A, pub B);

impl<A: SizingField, B: SizingField> SizingField for MaxOf<A, B> {
    fn metric(&self, context: &SizingContext<'_>, at: TriangleId) -> Metric {
        self.0.metric(context, at).max(self.1.metric(context, at))
    }
}

/// A field of its own for every panel, by the panel's index: several cloths with different settings
/// in one mesh. Triangles of panels beyond the list have no wish and are meshed as coarsely as the
/// driver can; name a panel in [`fixed_panels`](crate::RemeshSettings::fixed_panels) to leave it
/// alone.
#[derive(Clone, Debug, PartialEq)]
pub struct PerPanel<S> {
    /// The fields in the order of the panels.
    pub fields: Vec<S>,
}

impl<S: SizingField> SizingField for PerPanel<S> {
    fn metric(&self, context: &SizingContext<'_>, at: TriangleId) -> Metric {
        let panel = context.cloth.mesh.panels()[at.index()] as usize;
        self.fields.get(panel).map_or(Metric::ZERO, |field| field.metric(context, at))
    }
}
