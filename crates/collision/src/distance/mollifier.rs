//! A factor that takes the contact of two edges away where they become parallel (Li2020).
//!
//! The distance of two edges is continuous but its gradient is not where they are parallel: the
//! closest points jump from one pair of ends to another. Multiplied by this factor, which is zero
//! there with its slope, an energy of the distance is once continuously differentiable. Vertices and
//! triangles see the contact of parallel edges too, so that nothing passes.

use mesh_core::World3;
use nalgebra::Matrix3;

/// Sin² of the angle between two edges below which the factor is less than 1, at their rest lengths
/// (1): Li2020 has 1e-3.
const SINE_SQUARED: f64 = 1e-3;

/// The factor with its derivatives with respect to the four ends.
#[derive(Clone, Copy, Debug)]
pub struct Mollifier {
    /// The factor, from 0 for parallel edges to 1 (1).
    pub value: f64,
    /// First derivatives (1/m).
    pub gradient: [World3; 4],
    /// Second derivatives: block `[i][j]` belongs to ends i and j (1/m²).
    pub hessian: [[Matrix3<f64>; 4]; 4],
}

/// The factor for edges `x[0], x[1]` and `x[2], x[3]` (m) whose lengths at rest are `rest` (m): with
/// c = |u × v|² of the edges and ε = 1e-3 of the product of the squared rest lengths it is
/// (2 − c/ε) c/ε where c < ε, and 1 elsewhere.
pub fn parallel_edges(x: &[World3; 4], rest: [f64; 2]) -> Mollifier {
    let (u, v) = (x[1] - x[0], x[3] - x[2]);
    let c = u.cross(&v).norm_squared();
    let epsilon = SINE_SQUARED * (rest[0] * rest[1]).powi(2);
    if c >= epsilon {
        let (gradient, hessian) = ([World3::zeros(); 4], [[Matrix3::zeros(); 4]; 4]);
        return Mollifier { value: 1.0, gradient, hessian };
    }
    let q = c / epsilon;
    let (first, second) = (2.0 * (1.0 - q) / epsilon, -2.0 / (epsilon * epsilon));
    // Derivatives of c with respect to u and v.
    let (uu, vv, uv) = (u.norm_squared(), v.norm_squared(), u.dot(&v));
    let slope = [(u * vv - v * uv) * 2.0, (v * uu - u * uv) * 2.0];
    let mixed = (u * v.transpose() * 2.0 - v * u.transpose() - Matrix3::identity() * uv) * 2.0;
    let curvature = [
        [(Matrix3::identity() * vv - v * v.transpose()) * 2.0, mixed],
        [mixed.transpose(), (Matrix3::identity() * uu - u * u.transpose()) * 2.0],
    ];
    // Ends 0 and 1 belong to u with signs − and +, ends 2 and 3 to v.
    let sign = |i: usize| if i.is_multiple_of(2) { -1.0 } else { 1.0 };
    let block = |i: usize, j: usize| {
        let (k, l) = (i / 2, j / 2);
        let of_edges = slope[k] * slope[l].transpose() * second + curvature[k][l] * first;
        of_edges * (sign(i) * sign(j))
    };
    Mollifier {
        value: (2.0 - q) * q,
        gradient: std::array::from_fn(|i| slope[i / 2] * (first * sign(i))),
        hessian: std::array::from_fn(|i| std::array::from_fn(|j| block(i, j))),
    }
}
