//! The measured, anisotropic and nonlinear bending of Wang, O'Brien and Ramamoorthi 2011.
//!
//! A file gives the rigidity in three directions (0°, 45°, 90° from the warp) at five curvatures
//! (0, 5, …, 20 per metre). The three directions determine an orthotropic plate without Poisson
//! coupling, B(κ) = diag(B₀, B₉₀, B₄₅ − (B₀ + B₉₀)/4), since a cylinder bent along the bias has
//! κ₁₁ = κ₂₂ = κ/2 and 2κ₁₂ = κ. As for stretching, the potential is the radial integral
//!
//!   ψ(κ) = ∫₀¹ κ : B(|tκ|) : t κ dt = κ : B̄(|κ|) : κ,   B̄(k) = k⁻² ∫₀ᵏ y B(y) dy.

use super::{Law, Response};
use nalgebra::{Matrix3, Vector3};

/// Spacing of the measured curvatures (1/m).
const KNOT: f64 = 5.0;

/// Data-driven bending.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredBending {
    /// Diagonal of B at the five curvatures (N m).
    knots: [Vector3<f64>; 5],
    /// ∫₀ᵏ y B(y) dy at the knots.
    integral: [Vector3<f64>; 5],
}

impl MeasuredBending {
    /// From the file's three rows of five rigidities (N m), each multiplied by `scale`. Negative
    /// values, also of the derived twist rigidity, are raised to zero.
    pub fn new(table: &[[f64; 5]; 3], scale: f64) -> Self {
        let knots: [Vector3<f64>; 5] = std::array::from_fn(|k| {
            let [warp, bias, weft] = [0, 1, 2].map(|row| (table[row][k] * scale).max(0.0));
            Vector3::new(warp, weft, (bias - 0.25 * (warp + weft)).max(0.0))
        });
        let mut integral = [Vector3::zeros(); 5];
        for i in 1..5 {
            integral[i] = integral[i - 1] + Self::moment(&knots, i - 1, i as f64 * KNOT);
        }
        MeasuredBending { knots, integral }
    }

    /// ∫ y B(y) dy from knot `i` to `k`.
    fn moment(knots: &[Vector3<f64>; 5], i: usize, k: f64) -> Vector3<f64> {
        let k_i = i as f64 * KNOT;
        let slope = if i < 4 { (knots[i + 1] - knots[i]) / KNOT } else { Vector3::zeros() };
        let at_zero = knots[i] - slope * k_i;
        at_zero * (0.5 * (k * k - k_i * k_i)) + slope * ((k.powi(3) - k_i.powi(3)) / 3.0)
    }

    /// B̄ and its first two derivatives at curvature `k` (1/m).
    fn mean(&self, k: f64) -> [Vector3<f64>; 3] {
        let i = ((k / KNOT) as usize).min(4);
        let slope =
            if i < 4 { (self.knots[i + 1] - self.knots[i]) / KNOT } else { Vector3::zeros() };
        if i == 0 {
            return [self.knots[0] * 0.5 + slope * (k / 3.0), slope / 3.0, Vector3::zeros()];
        }
        let b = self.knots[i] + slope * (k - i as f64 * KNOT);
        let mean = (self.integral[i] + Self::moment(&self.knots, i, k)) / (k * k);
        let d = (b - mean * 2.0) / k;
        [mean, d, (slope - d * 2.0) / k - (b - mean * 2.0) / (k * k)]
    }

    fn norm(a: &Vector3<f64>) -> f64 {
        (a.x * a.x + a.y * a.y + 0.5 * a.z * a.z).sqrt()
    }
}

impl Law for MeasuredBending {
    fn energy(&self, a: &Vector3<f64>) -> f64 {
        let [mean, ..] = self.mean(Self::norm(a));
        a.component_mul(a).dot(&mean)
    }

    fn stress(&self, a: &Vector3<f64>) -> Vector3<f64> {
        let k = Self::norm(a);
        let [mean, d, _] = self.mean(k);
        let stress = a.component_mul(&mean) * 2.0;
        if k > 1e-12 {
            let grad_k = a.component_mul(&Vector3::new(1.0, 1.0, 0.5)) / k;
            stress + grad_k * a.component_mul(a).dot(&d)
        } else {
            stress
        }
    }

    fn response(&self, a: &Vector3<f64>) -> Response {
        let k = Self::norm(a);
        let [mean, d, dd] = self.mean(k);
        let squares = a.component_mul(a);
        let mut stress = a.component_mul(&mean) * 2.0;
        let mut tangent = Matrix3::from_diagonal(&(mean * 2.0));
        if k > 1e-12 {
            let weights = Vector3::new(1.0, 1.0, 0.5);
            let grad_k = a.component_mul(&weights) / k;
            let hess_k = (Matrix3::from_diagonal(&weights) - grad_k * grad_k.transpose()) / k;
            let cross = a.component_mul(&d) * 2.0;
            stress += grad_k * squares.dot(&d);
            tangent += cross * grad_k.transpose()
                + grad_k * cross.transpose()
                + grad_k * grad_k.transpose() * squares.dot(&dd)
                + hess_k * squares.dot(&d);
        }
        Response { energy: squares.dot(&mean), stress, tangent }
    }

    fn at_rest(&self) -> Matrix3<f64> {
        Matrix3::from_diagonal(&self.knots[0])
    }
}
