//! Sizing tensors: symmetric 2×2 metrics on material space that say how long edges may be.

use mesh_core::{Blend, Material2};
use nalgebra::{Matrix2, SMatrix, Vector2};
use std::ops::{Add, Mul};

/// A symmetric positive semi-definite 2×2 tensor M on material space (1/m²). An edge u is short
/// enough where uᵀ M u ≤ 1, so the eigenvalue λ allows edges of length 1/√λ along its eigenvector.
///
/// All operations are closed forms that accept rank 0 and 1. A tensor with an entry that is not
/// finite stays so through every operation, and the driver counts it ([`Metric::is_valid`]).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Metric {
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Metric {
    /// No wish at all: edges may have any length.
    pub const ZERO: Metric = Metric { xx: 0.0, xy: 0.0, yy: 0.0 };

    /// The tensor [[xx, xy], [xy, yy]] (1/m²).
    #[inline]
    pub const fn new(xx: f64, xy: f64, yy: f64) -> Metric {
        Metric { xx, xy, yy }
    }

    /// Edges up to `size` long in every direction (m).
    #[inline]
    pub fn uniform(size: f64) -> Metric {
        let lambda = 1.0 / (size * size);
        Metric::new(lambda, 0.0, lambda)
    }

    /// Edges up to `along` in a direction (any length but zero) and up to `across` at right angles
    /// to it (m).
    pub fn with_sizes(direction: Material2, along: f64, across: f64) -> Metric {
        let d = direction / direction.norm();
        let (p, q) = (1.0 / (along * along), 1.0 / (across * across));
        Metric::new(
            p * d.x * d.x + q * d.y * d.y,
            (p - q) * d.x * d.y,
            p * d.y * d.y + q * d.x * d.x,
        )
    }

    /// GᵀG / change²: along an edge a quantity of gradient G (its unit per metre) changes by at
    /// most `change` (the same unit).
    #[inline]
    pub fn of_gradient<const R: usize>(gradient: &SMatrix<f64, R, 2>, change: f64) -> Metric {
        let (a, b) = (gradient.column(0), gradient.column(1));
        Metric::new(a.dot(&a), a.dot(&b), b.dot(&b)) * (1.0 / (change * change))
    }

    /// Bᵀ M B for B = [[b₁₁, b₁₂], [b₂₁, b₂₂]], given in this order: the tensor in other coordinates.
    #[inline]
    pub(crate) fn congruent(&self, [b11, b12, b21, b22]: [f64; 4]) -> Metric {
        let (p, q) = (self.xx * b11 + self.xy * b21, self.xy * b11 + self.yy * b21);
        let (r, s) = (self.xx * b12 + self.xy * b22, self.xy * b12 + self.yy * b22);
        Metric::new(b11 * p + b21 * q, b11 * r + b21 * s, b12 * r + b22 * s)
    }

    /// An upper bound of the eigenvalues (1/m²), without a square root.
    #[inline]
    pub(crate) fn bound(&self) -> f64 {
        // The larger diagonal entry, written so that what is not a number stays so.
        0.5 * (self.xx + self.yy + (self.xx - self.yy).abs()) + self.xy.abs()
    }

    /// The symmetric part of a matrix (1/m²).
    pub fn from_matrix(m: &Matrix2<f64>) -> Metric {
        Metric::new(m.m11, 0.5 * (m.m12 + m.m21), m.m22)
    }

    /// As a matrix (1/m²).
    pub fn matrix(self) -> Matrix2<f64> {
        Matrix2::new(self.xx, self.xy, self.xy, self.yy)
    }

    /// The entries xx, xy and yy (1/m²).
    #[inline]
    pub fn entries(&self) -> [f64; 3] {
        [self.xx, self.xy, self.yy]
    }

    /// uᵀ M u: the squared size of an edge (no unit).
    #[inline]
    pub fn size_squared(&self, u: Material2) -> f64 {
        (self.xx * u.x + 2.0 * self.xy * u.y) * u.x + self.yy * u.y * u.y
    }

    /// uᵀ M w: the inner product of two vectors (no unit).
    #[inline]
    pub fn dot(&self, u: Material2, w: Material2) -> f64 {
        u.x * (self.xx * w.x + self.xy * w.y) + u.y * (self.xy * w.x + self.yy * w.y)
    }

    /// Sum of the eigenvalues (1/m²).
    #[inline]
    pub fn trace(&self) -> f64 {
        self.xx + self.yy
    }

    /// Product of the eigenvalues (1/m⁴).
    #[inline]
    pub fn determinant(&self) -> f64 {
        self.xx * self.yy - self.xy * self.xy
    }

    /// The eigenvalues, the larger first (1/m²).
    #[inline]
    pub fn eigenvalues(&self) -> [f64; 2] {
        let (mean, radius) = self.mean_and_radius();
        [mean + radius, mean - radius]
    }

    /// The eigenvalues, the larger first (1/m²), and their unit eigenvectors.
    pub fn eigen(&self) -> ([f64; 2], [Material2; 2]) {
        let (mean, radius) = self.mean_and_radius();
        let d = 0.5 * (self.xx - self.yy);
        // The form without cancellation of the two that span the first eigenvector.
        let first = if d >= 0.0 {
            Vector2::new(d + radius, self.xy)
        } else {
            Vector2::new(self.xy, radius - d)
        };
        let norm = first.norm();
        let first = if norm > 0.0 { first / norm } else { Vector2::x() };
        ([mean + radius, mean - radius], [first, Vector2::new(-first.y, first.x)])
    }

    /// True if every entry is finite and no eigenvalue is negative beyond rounding.
    #[inline]
    pub fn is_valid(&self) -> bool {
        let [large, small] = self.eigenvalues();
        large.is_finite() && small.is_finite() && small >= -1e-9 * large
    }

    /// The same eigenvectors with the eigenvalues clamped to [1/ℓ_max², 1/ℓ_min²], then the smaller
    /// one raised to at least `aspect_min`² of the larger (sizes in m).
    #[inline]
    pub fn clamp(self, size_min: f64, size_max: f64, aspect_min: f64) -> Metric {
        let (low, high) = (1.0 / (size_max * size_max), 1.0 / (size_min * size_min));
        self.clamp_eigenvalues(low, high, aspect_min * aspect_min)
    }

    /// As [`Metric::clamp`], with the bounds of the eigenvalues and of their ratio.
    #[inline]
    pub(crate) fn clamp_eigenvalues(self, low: f64, high: f64, ratio: f64) -> Metric {
        self.map(|[large, small]| {
            let large = greater(low, less(large, high));
            let small = greater(less(small, high), greater(low, ratio * large));
            [large, less(small, large)]
        })
    }

    /// Raises the smaller eigenvalue to at least `aspect_min`² of the larger, and to zero.
    #[inline]
    pub fn limit_anisotropy(self, aspect_min: f64) -> Metric {
        let floor = aspect_min * aspect_min;
        let [large, small] = self.eigenvalues();
        if small >= floor * large && small >= 0.0 {
            return self;
        }
        self.map(|[large, small]| {
            let large = greater(large, 0.0);
            [large, less(greater(small, floor * large), large)]
        })
    }

    /// The same eigenvectors with negative eigenvalues set to zero.
    #[inline]
    pub fn positive_part(self) -> Metric {
        self.map(|[large, small]| [greater(large, 0.0), greater(small, 0.0)])
    }

    /// The least tensor on the common eigenbasis of A and B that dominates both: with A = P⁻ᵀ
    /// diag(aᵢ) P⁻¹ and B = P⁻ᵀ diag(bᵢ) P⁻¹ it is P⁻ᵀ diag(max(aᵢ, bᵢ)) P⁻¹, so an edge that it
    /// allows is allowed by both.
    ///
    /// With C = A + B and D = (A − B)/2: if D is semi-definite, one of the two dominates. Otherwise
    /// C = L Lᵀ is positive definite and the result is C/2 + L |K| Lᵀ with K = L⁻¹ D L⁻ᵀ, whose
    /// entries are at most 1/2. For a 2×2 matrix of negative determinant, |K| = (tr K · K − 2 det K ·
    /// I)/τ with τ² = tr² K − 4 det K, written out so that rounding in the weak direction of C stays
    /// there: A and B may be of any rank. Two tensors of rank 1 that are nearly parallel have their
    /// sum for maximum, twice either; [clamp](Metric::clamp) them first where that matters.
    #[inline]
    pub fn max(self, other: Metric) -> Metric {
        let c = self + other;
        if !(c.xx + c.xy + c.yy).is_finite() {
            return Metric::new(f64::NAN, f64::NAN, f64::NAN);
        }
        let d = (self + other * -1.0) * 0.5;
        if d.xx * d.yy >= d.xy * d.xy {
            return if d.trace() >= 0.0 { self } else { other };
        }
        if c.xx >= c.yy {
            half_sum_plus_modulus(c, d)
        } else {
            half_sum_plus_modulus(c.swap_axes(), d.swap_axes()).swap_axes()
        }
    }

    #[inline]
    fn swap_axes(self) -> Metric {
        Metric::new(self.yy, self.xy, self.xx)
    }

    /// The same eigenvectors with the eigenvalues (the larger first) replaced; `f` must not spread
    /// them further apart than they were.
    #[inline]
    fn map(self, f: impl Fn([f64; 2]) -> [f64; 2]) -> Metric {
        let (mean, radius) = self.mean_and_radius();
        if !(mean + radius).is_finite() {
            return Metric::new(f64::NAN, f64::NAN, f64::NAN);
        }
        let [large, small] = f([mean + radius, mean - radius]);
        let centre = 0.5 * (large + small);
        let stretch = if radius > 0.0 { 0.5 * (large - small) / radius } else { 0.0 };
        Metric {
            xx: centre + stretch * (self.xx - mean),
            xy: stretch * self.xy,
            yy: centre + stretch * (self.yy - mean),
        }
    }

    /// Centre and half distance of the eigenvalues.
    #[inline]
    fn mean_and_radius(&self) -> (f64, f64) {
        let d = 0.5 * (self.xx - self.yy);
        (0.5 * (self.xx + self.yy), (d * d + self.xy * self.xy).sqrt())
    }
}

/// C/2 + L |K| Lᵀ with C = L Lᵀ and K = L⁻¹ D L⁻ᵀ, for C of positive trace with its larger diagonal
/// entry first and det D < 0.
#[inline]
fn half_sum_plus_modulus(c: Metric, d: Metric) -> Metric {
    // E = [[1, 0], [−s, 1]] makes E C Eᵀ = diag(c.xx, weak); then K is scaled entry by entry.
    let s = c.xy / c.xx;
    let weak = c.yy - s * c.xy;
    let (d_xy, d_yy) = (d.xy - s * d.xx, d.yy - s * (2.0 * d.xy - s * d.xx));
    let p = d.xx / c.xx;
    let (o, q) = if weak > 1e-15 * c.yy {
        let bound = |k: f64| less(greater(k, -0.5), 0.5);
        (bound(d_xy / (c.xx * weak).sqrt()), bound(d_yy / weak))
    } else {
        (0.0, 0.0)
    };
    let tau = ((p - q) * (p - q) + 4.0 * o * o).sqrt();
    let (xx, xy, yy) = if tau > 0.0 {
        ((p * (p - q) + 2.0 * o * o) / tau, o * (p + q) / tau, (q * (q - p) + 2.0 * o * o) / tau)
    } else {
        (0.5, 0.0, 0.5)
    };
    let weak = greater(weak, 0.0);
    let m_xx = c.xx * (0.5 + xx);
    let m_xy = (c.xx * weak).sqrt() * xy;
    let m_yy = weak * (0.5 + yy);
    Metric::new(m_xx, m_xy + s * m_xx, m_yy + s * (2.0 * m_xy + s * m_xx))
}

/// The greater of two numbers: one instruction, unlike `f64::max`, which has to look for NaN.
#[inline]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The lesser of two numbers.
#[inline]
fn less(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

impl Add for Metric {
    type Output = Metric;

    #[inline]
    fn add(self, other: Metric) -> Metric {
        Metric::new(self.xx + other.xx, self.xy + other.xy, self.yy + other.yy)
    }
}

impl Mul<f64> for Metric {
    type Output = Metric;

    #[inline]
    fn mul(self, factor: f64) -> Metric {
        Metric::new(self.xx * factor, self.xy * factor, self.yy * factor)
    }
}

impl Blend for Metric {
    #[inline]
    fn midpoint(&self, other: &Self) -> Self {
        (*self + *other) * 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Eigenvalues over twelve decades, sometimes zero, at any angle.
    fn any_metric() -> impl Strategy<Value = Metric> {
        let lambda =
            || prop_oneof![4 => (-6.0..6.0f64).prop_map(|e| 10f64.powf(e)), 1 => Just(0.0)];
        (lambda(), lambda(), 0.0..std::f64::consts::TAU).prop_map(|(p, q, angle)| {
            let (s, c) = angle.sin_cos();
            Metric::new(p * c * c + q * s * s, (p - q) * s * c, p * s * s + q * c * c)
        })
    }

    proptest! {
        #[test]
        fn eigen_rebuilds_the_tensor(m in any_metric()) {
            let (lambda, e) = m.eigen();
            prop_assert!(lambda[0] >= lambda[1]);
            let rebuilt = e[0] * e[0].transpose() * lambda[0] + e[1] * e[1].transpose() * lambda[1];
            prop_assert!((rebuilt - m.matrix()).norm() <= 1e-14 * lambda[0]);
            prop_assert!((e[0].norm() - 1.0).abs() < 1e-14 && e[0].dot(&e[1]).abs() < 1e-15);
            prop_assert!(m.is_valid());
        }

        #[test]
        fn max_dominates_both_and_is_the_common_basis_maximum(a in any_metric(), b in any_metric()) {
            let m = a.max(b);
            let c = a + b;
            let scale = c.trace();
            // The maximum jumps where two tensors of rank 1 become parallel: rounding counts as much
            // as their sum is ill-conditioned.
            let condition = scale * scale / c.determinant().max(1e-16 * scale * scale);
            let eps = scale * (1e-14 + 1e-15 * condition).min(0.5);
            for lower in [a, b] {
                let gap = (m + lower * -1.0).eigenvalues()[1];
                prop_assert!(gap >= -eps, "gap {gap} at scale {scale}");
            }
            // Never more than the sum, which dominates too.
            prop_assert!((c + m * -1.0).eigenvalues()[1] >= -eps);
            prop_assert!((m.matrix() - b.max(a).matrix()).norm() <= eps);
            // Least on the common basis: M − A and M − B are singular where neither dominates.
            if (a + b * -1.0).determinant() < -1e-6 * scale * scale {
                for lower in [a, b] {
                    let det = (m + lower * -1.0).determinant();
                    prop_assert!(det.abs() <= eps * scale, "{det} at {scale}");
                }
            }
        }

        #[test]
        fn clamp_keeps_directions_and_bounds(m in any_metric(), aspect in 0.01..1.0f64) {
            let clamped = m.clamp(0.01, 0.5, aspect);
            let [large, small] = clamped.eigenvalues();
            let (low, high) = (4.0, 1e4);
            prop_assert!(small >= low * (1.0 - 1e-9) && large <= high * (1.0 + 1e-9));
            prop_assert!(small >= aspect * aspect * large * (1.0 - 1e-9));
            // Same eigenvectors: the two commute.
            let (p, q) = (m.matrix(), clamped.matrix());
            prop_assert!((p * q - q * p).norm() <= 1e-12 * p.norm() * q.norm());
        }

        #[test]
        fn of_gradient_measures_the_change(g in prop::array::uniform6(-9.0..9.0f64), x in -1.0..1.0f64) {
            let gradient = nalgebra::Matrix3x2::from_row_slice(&g);
            let u = Material2::new(x, 1.0 - x);
            let expected = (gradient * u).norm_squared() / 0.09;
            let got = Metric::of_gradient(&gradient, 0.3).size_squared(u);
            prop_assert!((got - expected).abs() <= 1e-13 * (1.0 + gradient.norm_squared()) / 0.09);
        }
    }

    #[test]
    fn zero_and_rank_one() {
        let x = Metric::new(9.0, 0.0, 0.0);
        let y = Metric::new(0.0, 0.0, 4.0);
        assert_eq!(x.max(y), Metric::new(9.0, 0.0, 4.0));
        assert_eq!(Metric::ZERO.max(x), x);
        assert_eq!(x.max(x), x);
        assert_eq!(Metric::ZERO.max(Metric::ZERO), Metric::ZERO);
        assert_eq!(Metric::ZERO.clamp(0.1, 0.5, 0.2), Metric::uniform(0.5));
        assert_eq!(Metric::uniform(0.2).limit_anisotropy(1.0), Metric::uniform(0.2));
        assert_eq!(Metric::ZERO.limit_anisotropy(0.2), Metric::ZERO);
        let (lambda, [first, _]) = x.eigen();
        assert_eq!((lambda, first), ([9.0, 0.0], Material2::x()));
    }

    #[test]
    fn not_a_number_survives_every_operation() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for m in [
                Metric::new(bad, 0.0, 1.0),
                Metric::new(1.0, bad, 1.0),
                Metric::new(1.0, 0.0, bad),
                Metric::new(bad, bad, bad),
            ] {
                assert!(!m.is_valid());
                assert!(!m.clamp(0.1, 1.0, 0.2).is_valid());
                assert!(!m.positive_part().is_valid());
                assert!(!m.max(Metric::uniform(1.0)).is_valid(), "{m:?}");
                assert!(!Metric::uniform(1.0).max(m).is_valid(), "{m:?}");
            }
        }
        assert!(!Metric::new(1.0, 2.0, 1.0).is_valid());
        assert!(Metric::new(1e150, 0.0, 1.0).max(Metric::new(1.0, 0.0, 1e150)).is_valid());
    }

    #[test]
    fn sizes_along_and_across() {
        let m = Metric::with_sizes(Material2::new(3.0, 4.0), 0.5, 0.1);
        assert!((m.size_squared(Material2::new(0.3, 0.4)) - 1.0).abs() < 1e-14);
        assert!((m.size_squared(Material2::new(-0.08, 0.06)) - 1.0).abs() < 1e-14);
        assert_eq!(Metric::uniform(0.5).midpoint(&Metric::ZERO), Metric::uniform(0.5) * 0.5);
    }
}
