//! Wrinkles that are too fine for the mesh: what buckles within a triangle withstands no more
//! compression than it takes to buckle (tension field, Pipkin1986; as a remedy for the stiffness of
//! coarse meshes, Choi2002 and Koh2014 §5).
//!
//! With the strain W ⪰ 0 that wrinkles hide, and the load κ at which a plate of the triangle's
//! width buckles, the energy per area is
//!
//!   ψ_r(E) = min_W ψ(E + W) + κ : W,                 ψ(E) = ½ E : C E.
//!
//! It is convex and once differentiable, and its stress is the one nearest to C E, in the norm of
//! C⁻¹, that stays in S + κ ⪰ 0. Either nothing wrinkles, or everything does (S = −κ), or W = ω n nᵀ with
//! n across the folds. In the last case ω minimises for a given n, and n is found by Newton's
//! method from the best of some directions.

use super::Response;
use crate::rest::RestTriangle;
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Directions from which the best starts the search; the function has few maxima.
const N_DIRECTIONS: usize = 16;
/// Newton's method doubles its digits each time.
const MAX_ITERATIONS: usize = 12;
/// Steps of the search below this are not doubted (rad).
const NEAR: f64 = 1e-4;
/// Change of direction below which it is found (rad).
const FOUND: f64 = 1e-13;

/// What wrinkles take from a quadratic law.
#[derive(Clone, Debug)]
pub(crate) struct TensionField {
    /// Stiffness of the law (N/m).
    c: Matrix3<f64>,
    compliance: Matrix3<f64>,
    /// Rigidity of the weaker of warp and weft (N m).
    rigidity: f64,
}

impl TensionField {
    /// For a law with this positive definite stiffness (N/m), and the stiffness of bending (N m).
    pub(crate) fn new(c: Matrix3<f64>, bending: Option<Matrix3<f64>>) -> Option<Self> {
        let rigidity = bending.map_or(0.0, |d| d[(0, 0)].min(d[(1, 1)]));
        Some(TensionField { compliance: c.try_inverse()?, c, rigidity })
    }

    /// The load κ = (κ₁₁, κ₂₂, κ₁₂) at which a triangle buckles (N/m): π² B/w² across a width w, with w²
    /// eighteen times the variance of the triangle in that direction, which is the square of the
    /// height of an equilateral one.
    pub(crate) fn load(&self, rest: &RestTriangle) -> Vector3<f64> {
        // 12 Σ b bᵀ is the inverse of the second moment.
        let inverse: Matrix2<f64> = rest.b.iter().map(|b| b * b.transpose()).sum();
        let kappa = inverse * (2.0 / 3.0 * PI * PI * self.rigidity);
        Vector3::new(kappa[(0, 0)], kappa[(1, 1)], kappa[(0, 1)])
    }

    /// ψ_r − ψ with its derivatives by the strain (E₁₁, E₂₂, 2 E₁₂); `None` where nothing wrinkles.
    pub(crate) fn change(&self, strain: &Vector3<f64>, load: &Vector3<f64>) -> Option<Response> {
        // Y₀ = C E + κ, which wrinkles make positive semi-definite.
        let y0 = self.c * strain + load;
        if is_positive(&y0) {
            return None;
        }
        let slack = -self.compliance * y0;
        if is_positive(&Vector3::new(slack.x, slack.y, 0.5 * slack.z)) {
            let energy = 0.5 * y0.dot(&slack);
            return Some(Response { energy, stress: -y0, tangent: -self.c });
        }
        let fold = self.fold(&y0);
        let (cq, cq1) = (self.c * fold.q, self.c * fold.q1);
        let energy = 0.5 * fold.omega * fold.q.dot(&y0);
        // The minimum over ω and ω θ answers to the strain.
        let y = y0 + cq * fold.omega;
        let turn = fold.q2.dot(&y) / fold.omega + fold.q1.dot(&cq1);
        let hessian = Matrix2::new(fold.q.dot(&cq), fold.q.dot(&cq1), fold.q.dot(&cq1), turn);
        let inverse = hessian
            .try_inverse()
            .unwrap_or_else(|| Matrix2::from_diagonal(&Vector2::new(1.0 / hessian[(0, 0)], 0.0)));
        let b = nalgebra::Matrix3x2::from_columns(&[cq, cq1]);
        Some(Response { energy, stress: cq * fold.omega, tangent: -b * inverse * b.transpose() })
    }

    /// The direction in which folding saves most, ½ (q·y₀)²/(q·C q), found on −q·y₀/√(q·C q).
    fn fold(&self, y0: &Vector3<f64>) -> Fold {
        let saved = |theta: f64| {
            let q = direction(theta);
            -q.dot(y0) / q.dot(&(self.c * q)).sqrt()
        };
        let angles = (0..N_DIRECTIONS).map(|k| PI * k as f64 / N_DIRECTIONS as f64);
        let best = angles.max_by(|a, b| saved(*a).total_cmp(&saved(*b)));
        let mut theta = best.unwrap_or(0.0);
        let mut value = saved(theta);
        for _ in 0..MAX_ITERATIONS {
            let (slope, curvature) = self.derivatives(y0, theta);
            // Uphill where the function is not concave; it is near its maximum.
            let step = if curvature < 0.0 { -slope / curvature } else { 0.1 * slope.signum() };
            let mut step = step.clamp(-0.2, 0.2);
            // Near the maximum only the slope can tell.
            while step.abs() > NEAR && saved(theta + step) < value {
                step *= 0.5;
            }
            theta += step;
            value = saved(theta);
            if step.abs() <= FOUND {
                break;
            }
        }
        let (q, q1, q2) = (direction(theta), turned(theta), bent(theta));
        Fold { omega: -q.dot(y0) / q.dot(&(self.c * q)), q, q1, q2 }
    }

    /// First and second derivative of −q·y₀ (q·C q)^(−1/2) by the angle.
    fn derivatives(&self, y0: &Vector3<f64>, theta: f64) -> (f64, f64) {
        let (q, q1, q2) = (direction(theta), turned(theta), bent(theta));
        let (n, n1, n2) = (-q.dot(y0), -q1.dot(y0), -q2.dot(y0));
        let (cq, cq1) = (self.c * q, self.c * q1);
        let (d, d1) = (q.dot(&cq), 2.0 * q1.dot(&cq));
        let d2 = 2.0 * (q2.dot(&cq) + q1.dot(&cq1));
        let root = d.sqrt();
        let slope = (n1 - 0.5 * n * d1 / d) / root;
        let curvature = (n2 - n1 * d1 / d + n * (0.75 * d1 * d1 / (d * d) - 0.5 * d2 / d)) / root;
        (slope, curvature)
    }
}

/// Folds across n: W = ω n nᵀ.
struct Fold {
    /// Strain that they hide (1).
    omega: f64,
    /// (n₁², n₂², 2 n₁ n₂), and its derivatives by the angle of n.
    q: Vector3<f64>,
    q1: Vector3<f64>,
    q2: Vector3<f64>,
}

/// n nᵀ as a strain.
fn direction(theta: f64) -> Vector3<f64> {
    let (s, c) = theta.sin_cos();
    Vector3::new(c * c, s * s, 2.0 * s * c)
}

/// d/dθ of [`direction`].
fn turned(theta: f64) -> Vector3<f64> {
    let (s, c) = (2.0 * theta).sin_cos();
    Vector3::new(-s, s, 2.0 * c)
}

/// d²/dθ² of [`direction`].
fn bent(theta: f64) -> Vector3<f64> {
    2.0 * turned(theta + 0.5 * FRAC_PI_2)
}

/// Whether the symmetric matrix (y₁₁, y₂₂, y₁₂) is positive semi-definite.
fn is_positive(y: &Vector3<f64>) -> bool {
    y.x >= 0.0 && y.y >= 0.0 && y.x * y.y >= y.z * y.z
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A positive definite stiffness, orthotropic or not (N/m).
    fn stiffness() -> impl Strategy<Value = Matrix3<f64>> {
        prop::array::uniform9(-1.0f64..1.0).prop_map(|a| {
            let a = Matrix3::from_row_slice(&a);
            (a * a.transpose() + Matrix3::identity() * 0.1) * 500.0
        })
    }

    fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
        prop::array::uniform3(-size..size).prop_map(Vector3::from)
    }

    /// A load, positive semi-definite (N/m).
    fn load() -> impl Strategy<Value = Vector3<f64>> {
        (0.0..1.0, 0.0..1.0, -1.0..1.0)
            .prop_map(|(a, b, c): (f64, f64, f64)| Vector3::new(a, b, c * (a * b).sqrt()) * 5.0)
    }

    fn field(c: Matrix3<f64>) -> TensionField {
        TensionField::new(c, None).unwrap()
    }

    /// The smaller eigenvalue of (y₁₁, y₂₂, y₁₂).
    fn least(y: &Vector3<f64>) -> f64 {
        0.5 * (y.x + y.y) - (0.25 * (y.x - y.y).powi(2) + y.z * y.z).sqrt()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// Convex, so these conditions make a minimum: W ⪰ 0, S + κ ⪰ 0, W : (S + κ) = 0.
        #[test]
        fn the_minimum_is_found(c in stiffness(), strain in vector(0.3), load in load()) {
            let field = field(c);
            let Some(change) = field.change(&strain, &load) else {
                prop_assert!(least(&(c * strain + load)) >= -1e-12);
                return Ok(());
            };
            let y = c * strain + change.stress + load;
            let w = field.compliance * change.stress;
            let (size, w_size) = ((c * strain + load).norm(), w.norm());
            prop_assert!(least(&y) >= -1e-9 * size, "S + κ: {}", least(&y));
            let hidden = Vector3::new(w.x, w.y, 0.5 * w.z);
            prop_assert!(least(&hidden) >= -1e-9 * w_size, "W: {}", least(&hidden));
            prop_assert!(w.dot(&y).abs() <= 1e-9 * size * w_size, "W : (S + κ): {}", w.dot(&y));
            // The energy is that of this W.
            let energy = w.dot(&(c * strain + load)) + 0.5 * w.dot(&(c * w));
            prop_assert!((change.energy - energy).abs() <= 1e-9 * size * w_size);
            prop_assert!(change.energy <= 0.0);
        }

        #[test]
        fn derivatives_are_those_of_the_energy(
            c in stiffness(), strain in vector(0.3), load in load(), along in vector(1.0),
        ) {
            let field = field(c);
            let at = |t: f64| field.change(&(strain + along * t), &load);
            let h = 1e-6;
            let (Some(here), Some(before), Some(after)) = (at(0.0), at(-h), at(h)) else {
                return Ok(());
            };
            let is_apex = |change: &Response| change.tangent == -c;
            if is_apex(&before) != is_apex(&after) {
                return Ok(());
            }
            let size = c.norm();
            let slope = (after.energy - before.energy) / (2.0 * h);
            prop_assert!((slope - here.stress.dot(&along)).abs() <= 1e-6 * size, "{slope}");
            let bend = (after.stress - before.stress) / (2.0 * h);
            let told = here.tangent * along;
            // The tangent turns fast where folds have only begun and where all is nearly slack.
            let folded = (field.compliance * here.stress).norm();
            let taut = (c * strain + here.stress + load).norm() / size;
            let third = (h / folded.min(taut)).powi(2);
            prop_assert!((bend - told).norm() <= (1e-5 + 10.0 * third) * size, "{bend} {told}");
        }

        /// ψ_r is convex: its tangent has no negative eigenvalue.
        #[test]
        fn the_tangent_is_positive(c in stiffness(), strain in vector(0.3), load in load()) {
            if let Some(change) = field(c).change(&strain, &load) {
                let least = (c + change.tangent).symmetric_eigenvalues().min();
                prop_assert!(least >= -1e-9 * c.norm(), "{least}");
            }
        }
    }

    /// A plate that is bent by its own triangle, across each of its heights.
    #[test]
    fn an_equilateral_triangle_buckles_as_a_plate_of_its_height() {
        let (side, rigidity) = (0.1f64, 1e-5);
        let height = side * 0.75f64.sqrt();
        let b = |angle: f64| Vector2::new(angle.cos(), angle.sin()) / height;
        let third = 2.0 * PI / 3.0;
        let rest = RestTriangle {
            b: [b(0.3), b(0.3 + third), b(0.3 + 2.0 * third)],
            area: 0.5 * side * height,
            panel: 0,
        };
        let bending = Matrix3::from_diagonal(&Vector3::new(2.0 * rigidity, rigidity, 1.0));
        let field = TensionField::new(Matrix3::identity(), Some(bending)).unwrap();
        let load = field.load(&rest);
        let euler = PI * PI * rigidity / (height * height);
        let wanted = Vector3::new(euler, euler, 0.0);
        assert!((load - wanted).norm() < 1e-12 * euler, "{load} {wanted}");
    }
}
