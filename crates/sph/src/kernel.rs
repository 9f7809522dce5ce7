//! The cubic spline kernel (Monaghan1992), without branches so that several distances are done at once.

use crate::lanes::Number;
use std::f64::consts::PI;

/// The cubic spline in three dimensions. Its support is twice the smoothing length h.
///
/// W(r) = (1 / 4π h³) [(2 − q)₊³ − 4 (1 − q)₊³] with q = r / h: twice differentiable, not negative,
/// and its integral over space is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CubicSpline {
    h: f64,
    inverse_h: f64,
    value_scale: f64,
    slope_scale: f64,
}

impl CubicSpline {
    /// The kernel with smoothing length `h` (m).
    pub fn new(h: f64) -> Self {
        let value_scale = 1.0 / (4.0 * PI * h * h * h);
        CubicSpline {
            h,
            inverse_h: 1.0 / h,
            value_scale,
            slope_scale: -3.0 * value_scale / (h * h),
        }
    }

    /// The smoothing length h (m).
    pub fn smoothing_length(&self) -> f64 {
        self.h
    }

    /// The distance from which the kernel is zero (m).
    pub fn support(&self) -> f64 {
        2.0 * self.h
    }

    /// W(r) for r² = `r_squared` (m²), in 1/m³.
    #[inline]
    pub fn value(&self, r_squared: f64) -> f64 {
        self.value_and_slope(r_squared).0
    }

    /// F(r) = W′(r) / r for r² = `r_squared` (m²), in 1/m⁵: the gradient of W is F times the offset.
    #[inline]
    pub fn slope_over_r(&self, r_squared: f64) -> f64 {
        self.value_and_slope(r_squared).1
    }

    /// W(r) in 1/m³ and F(r) = W′(r) / r in 1/m⁵, for r² = `r_squared` (m²).
    #[inline(always)]
    pub(crate) fn value_and_slope<N: Number>(&self, r_squared: N) -> (N, N) {
        // Below `TINY` the difference loses its digits, but so small an offset makes no force.
        const TINY: f64 = 1e-100;
        let q = r_squared.root() * self.inverse_h;
        let (outer, inner) =
            (q.subtracted_from(2.0).at_least(0.0), q.subtracted_from(1.0).at_least(0.0));
        let (outer_squared, inner_squared) = (outer * outer, inner * inner * 4.0);
        let value = outer_squared * outer - inner_squared * inner;
        let slope = (outer_squared - inner_squared) / q.at_least(TINY);
        (value * self.value_scale, slope * self.slope_scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integral_over_space_is_one() {
        let kernel = CubicSpline::new(0.3);
        let n = 20_000;
        let step = kernel.support() / f64::from(n);
        let shell = |k: u32| {
            let r = (f64::from(k) + 0.5) * step;
            4.0 * PI * r * r * kernel.value(r * r) * step
        };
        let integral: f64 = (0..n).map(shell).sum();
        assert!((integral - 1.0).abs() < 1e-7, "{integral}");
        assert_eq!(kernel.value(kernel.support().powi(2)), 0.0);
    }

    #[test]
    fn slope_is_the_derivative_of_the_value() {
        let kernel = CubicSpline::new(0.07);
        for k in 1..200 {
            let (r, dr) = (0.15 * f64::from(k) / 200.0, 1e-7);
            let difference = kernel.value((r + dr).powi(2)) - kernel.value((r - dr).powi(2));
            let slope = r * kernel.slope_over_r(r * r);
            let scale = kernel.value(0.0) / kernel.smoothing_length();
            assert!((difference / (2.0 * dr) - slope).abs() < 1e-7 * scale, "at {r}");
        }
        assert!(kernel.slope_over_r(0.0).is_finite());
    }
}
