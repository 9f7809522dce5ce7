//! Strain that an edit would put into the cloth.
//!
//! A triangulation is a piecewise linear surface: flips and collapses replace some of its facets by
//! others, and where cloth is curved the new facets are shorter or longer than the pattern. A split
//! is free of this. Strain from nowhere is energy from nowhere: the next step would have to work it
//! off ("pop").

use crate::driver::Driver;
use mesh_core::{Material2, World3, geometry};

/// A triangle by its corners in material and world space.
pub(crate) type Facet = ([Material2; 3], [World3; 3]);

/// By how much the principal stretches of a triangle leave a range (1); infinite if they are not
/// numbers.
fn excess([min, max]: [f64; 2], (u, x): Facet) -> f64 {
    let f = geometry::gradient(x, &geometry::inverse_edges(u));
    let (f1, f2) = (f.column(0), f.column(1));
    let (c11, c22, c12) = (f1.norm_squared(), f2.norm_squared(), f1.dot(&f2));
    let (mean, half) = (0.5 * (c11 + c22), 0.5 * (c11 - c22));
    let radius = (half * half + c12 * c12).sqrt();
    let high = (mean + radius).sqrt();
    let low = (mean - radius).max(0.0).sqrt();
    if high.is_nan() { f64::INFINITY } else { (high - max).max(min - low).max(0.0) }
}

impl Driver<'_> {
    /// True if no new triangle is strained beyond the limits of its panel, or beyond what one of the
    /// old ones was.
    pub(crate) fn keeps_strain<const N: usize>(
        &self,
        panel: u32,
        old: [Facet; N],
        new: [Facet; N],
    ) -> bool {
        let Some(&limits) = self.settings.stretch_limits.get(panel as usize) else { return true };
        let worst =
            |facets: [Facet; N]| facets.map(|f| excess(limits, f)).into_iter().fold(0.0, f64::max);
        let after = worst(new);
        after == 0.0 || after <= worst(old)
    }
}
