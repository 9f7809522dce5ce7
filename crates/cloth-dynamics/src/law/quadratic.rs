//! A law that is linear in its argument: St. Venant–Kirchhoff membranes, linear plates.

use super::{Law, Response};
use nalgebra::{Matrix3, Vector3};

/// The constants do not make a positive definite law.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "orthotropic constants c11 = {c11}, c12 = {c12}, c22 = {c22}, c33 = {c33} are not positive \
     definite: c11, c22, c33 and c11 c22 − c12² must be positive and finite"
)]
pub struct NotPositive {
    /// Warp stiffness (N/m; N m for bending).
    pub c11: f64,
    /// Coupling (N/m; N m for bending).
    pub c12: f64,
    /// Weft stiffness (N/m; N m for bending).
    pub c22: f64,
    /// Shear stiffness (N/m; N m for bending).
    pub c33: f64,
}

/// Orthotropic: ψ(a) = ½ (c₁₁ a₁₁² + 2 c₁₂ a₁₁ a₂₂ + c₂₂ a₂₂² + c₃₃ (2 a₁₂)²).
#[derive(Clone, Debug, PartialEq)]
pub struct Quadratic {
    c: Matrix3<f64>,
}

impl Quadratic {
    /// From orthotropic constants (N/m for membranes, N m for bending).
    ///
    /// # Errors
    /// If they are not positive definite and finite.
    pub fn orthotropic(c11: f64, c12: f64, c22: f64, c33: f64) -> Result<Self, NotPositive> {
        let minor = c11 * c22 - c12 * c12;
        if [c11, c22, c33, minor].iter().all(|&c| c.is_finite() && c > 0.0) {
            Ok(Quadratic { c: Matrix3::new(c11, c12, 0.0, c12, c22, 0.0, 0.0, 0.0, c33) })
        } else {
            Err(NotPositive { c11, c12, c22, c33 })
        }
    }

    /// A plate without Poisson coupling from its rigidities (N m) when bent along the warp, the bias
    /// (45°) and the weft: a cylinder of curvature κ along the bias has κ₁₁ = κ₂₂ = κ/2 and 2κ₁₂ = κ.
    /// Where the bias is softer than any such plate, the twist keeps a thousandth of the weakest.
    ///
    /// # Errors
    /// If a rigidity is not positive and finite.
    pub fn plate(warp: f64, bias: f64, weft: f64) -> Result<Self, NotPositive> {
        let least = 1e-3 * warp.min(weft).min(bias);
        Quadratic::orthotropic(warp, 0.0, weft, (bias - 0.25 * (warp + weft)).max(least))
    }

    /// Isotropic with stiffness `k` and Poisson's ratio `nu` (plane stress): c₁₁ = k/(1 − ν²) for a
    /// membrane with k = E h (N/m); for a plate of rigidity B pass k = B (1 − ν²).
    ///
    /// # Errors
    /// If the result is not positive definite.
    pub fn isotropic(k: f64, nu: f64) -> Result<Self, NotPositive> {
        let c = k / (1.0 - nu * nu);
        Quadratic::orthotropic(c, nu * c, c, 0.5 * (1.0 - nu) * c)
    }
}

impl Law for Quadratic {
    #[inline]
    fn energy(&self, a: &Vector3<f64>) -> f64 {
        0.5 * a.dot(&(self.c * a))
    }

    #[inline]
    fn stress(&self, a: &Vector3<f64>) -> Vector3<f64> {
        self.c * a
    }

    #[inline]
    fn response(&self, a: &Vector3<f64>) -> Response {
        let stress = self.c * a;
        Response { energy: 0.5 * a.dot(&stress), stress, tangent: self.c }
    }

    fn at_rest(&self) -> Matrix3<f64> {
        self.c
    }
}
