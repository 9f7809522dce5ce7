//! Constitutive laws: energy per area as a function of three strains or curvatures.
//!
//! The argument is (a₁₁, a₂₂, 2 a₁₂) of a symmetric 2×2 tensor in the fabric's axes (warp, weft):
//! Green strain for a membrane law (energy in J/m², stress in N/m), the curvature tensor (1/m) for
//! a bending law (moment in N).

mod measured_bending;
mod measured_membrane;
mod quadratic;
mod tension_field;

pub use measured_bending::MeasuredBending;
pub use measured_membrane::MeasuredMembrane;
pub use quadratic::{NotPositive, Quadratic};
pub(crate) use tension_field::TensionField;

use nalgebra::{Matrix3, Vector3};

/// Energy density with its first and second derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Response {
    /// Energy per material area (J/m²).
    pub energy: f64,
    /// First derivative: the conjugate stress (N/m) or moment (N).
    pub stress: Vector3<f64>,
    /// Second derivative: the tangent (N/m; N m for bending).
    pub tangent: Matrix3<f64>,
}

/// A hyperelastic law.
pub trait Law {
    /// Energy per material area (J/m²).
    fn energy(&self, a: &Vector3<f64>) -> f64;

    /// First derivative: the conjugate stress (N/m) or moment (N).
    fn stress(&self, a: &Vector3<f64>) -> Vector3<f64>;

    /// Energy, stress and tangent.
    fn response(&self, a: &Vector3<f64>) -> Response;

    /// The constant tangent at rest, positive semi-definite: what damping is proportional to.
    fn at_rest(&self) -> Matrix3<f64>;
}

/// A fabric's resistance to stretching.
#[derive(Clone, Debug)]
pub enum Membrane {
    /// Orthotropic St. Venant–Kirchhoff.
    Orthotropic(Quadratic),
    /// Data-driven (Wang2011).
    Measured(MeasuredMembrane),
}

/// A fabric's resistance to bending.
#[derive(Clone, Debug)]
pub enum Bending {
    /// Orthotropic, linear in curvature.
    Orthotropic(Quadratic),
    /// Data-driven (Wang2011).
    Measured(MeasuredBending),
}

macro_rules! dispatch {
    ($kind:ident) => {
        impl Law for $kind {
            #[inline]
            fn energy(&self, a: &Vector3<f64>) -> f64 {
                match self {
                    $kind::Orthotropic(law) => law.energy(a),
                    $kind::Measured(law) => law.energy(a),
                }
            }
            #[inline]
            fn stress(&self, a: &Vector3<f64>) -> Vector3<f64> {
                match self {
                    $kind::Orthotropic(law) => law.stress(a),
                    $kind::Measured(law) => law.stress(a),
                }
            }
            #[inline]
            fn response(&self, a: &Vector3<f64>) -> Response {
                match self {
                    $kind::Orthotropic(law) => law.response(a),
                    $kind::Measured(law) => law.response(a),
                }
            }
            fn at_rest(&self) -> Matrix3<f64> {
                match self {
                    $kind::Orthotropic(law) => law.at_rest(),
                    $kind::Measured(law) => law.at_rest(),
                }
            }
        }
    };
}

dispatch!(Membrane);
dispatch!(Bending);

/// The nearest positive semi-definite matrix (in the Frobenius norm). Cheap where nothing has to
/// be done: leading minors decide.
pub(crate) fn project3(m: &Matrix3<f64>) -> Matrix3<f64> {
    let minor = m[(0, 0)] * m[(1, 1)] - m[(0, 1)] * m[(1, 0)];
    if m[(0, 0)] > 0.0 && minor > 0.0 && m.determinant() > 0.0 {
        return *m;
    }
    let eigen = m.symmetric_eigen();
    let clamped = eigen.eigenvalues.map(|l| l.max(0.0));
    eigen.eigenvectors * Matrix3::from_diagonal(&clamped) * eigen.eigenvectors.transpose()
}
