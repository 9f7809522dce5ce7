//! Strain that an edit would put into the cloth.
//!
//! A triangulation is a piecewise linear surface: flips and collapses replace some of its facets by
//! others, and where cloth is curved the new facets are shorter or longer than the pattern. A split
//! is free of this. Strain from nowhere is energy from nowhere: the next step would have to work it
//! off ("pop").

use crate::driver::Driver;
use mesh_core::{Material2, World3, geometry};

impl Driver<'_> {
    /// By how much the principal stretches of a triangle leave the allowed range of its panel (1);
    /// infinite if they are not numbers.
    fn excess(&self, panel: u32, u: [Material2; 3], x: [World3; 3]) -> f64 {
        let Some([min, max]) = self.settings.stretch_limits.get(panel as usize) else { return 0.0 };
        let g = geometry::inverse_edges(u);
        let (p, q) = (x[1] - x[0], x[2] - x[0]);
        let f1 = p * g[(0, 0)] + q * g[(1, 0)];
        let f2 = p * g[(0, 1)] + q * g[(1, 1)];
        let (c11, c22, c12) = (f1.norm_squared(), f2.norm_squared(), f1.dot(&f2));
        let (mean, half) = (0.5 * (c11 + c22), 0.5 * (c11 - c22));
        let radius = (half * half + c12 * c12).sqrt();
        let high = (mean + radius).sqrt();
        let low = (mean - radius).max(0.0).sqrt();
        let excess = (high - max).max(min - low).max(0.0);
        if high.is_nan() { f64::INFINITY } else { excess }
    }

    /// True if no new triangle is strained beyond what is allowed, or beyond what an old one was.
    /// Triangles are given by panel, material and world corners.
    pub(crate) fn keeps_strain<const N: usize>(
        &self,
        panel: u32,
        old: [([Material2; 3], [World3; 3]); N],
        new: [([Material2; 3], [World3; 3]); N],
    ) -> bool {
        if self.settings.stretch_limits.is_empty() {
            return true;
        }
        let worst = |triangles: [([Material2; 3], [World3; 3]); N]| {
            triangles.into_iter().map(|(u, x)| self.excess(panel, u, x)).fold(0.0, f64::max)
        };
        let after = worst(new);
        after == 0.0 || after <= worst(old)
    }
}
