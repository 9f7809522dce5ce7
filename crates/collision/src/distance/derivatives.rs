//! Squared distance of two given features with its gradient and Hessian.
//!
//! The four distances are one: d² = min over s of |r(x, s)|² with r = Σ wᵢ(s) xᵢ, where s are the
//! parameters of the closest points on lines and planes: none for two points, one for a point and a
//! line, two for a plane or two lines. At the minimum the gradient is 2 wᵢ r, and the Hessian is the
//! one at fixed s less what moving s gains (implicit function theorem),
//!
//! ```text
//! ∂²d²/∂xᵢ∂xⱼ = 2 wᵢ wⱼ I − 2 Σ cᵢₖ (G⁻¹)ₖₗ cⱼₗᵀ,    cᵢₖ = wᵢ eₖ + (∂wᵢ/∂sₖ) r,    Gₖₗ = eₖ · eₗ
//! ```
//!
//! with the directions eₖ = ∂r/∂sₖ. What moving s gains makes the Hessian indefinite; whoever needs it
//! otherwise projects that of the energy.

use mesh_core::World3;
use nalgebra::{Matrix2, Matrix3};

/// Value, gradient and Hessian of the squared distance of two features with N vertices.
#[derive(Clone, Copy, Debug)]
pub struct Derivatives<const N: usize> {
    /// The squared distance (m²).
    pub squared: f64,
    /// Derivatives with respect to the vertices (m).
    pub gradient: [World3; N],
    /// Second derivatives: block `[i][j]` belongs to vertices i and j (1).
    pub hessian: [[Matrix3<f64>; N]; N],
}

impl<const N: usize> Derivatives<N> {
    fn assemble<const K: usize>(
        w: [f64; N],
        slopes: [[f64; N]; K],
        r: World3,
        e: [World3; K],
        inverse: impl Fn(usize, usize) -> f64,
    ) -> Derivatives<N> {
        let c: [[World3; N]; K] =
            std::array::from_fn(|k| std::array::from_fn(|i| e[k] * w[i] + r * slopes[k][i]));
        let block = |i: usize, j: usize| {
            let mut block = Matrix3::identity() * (2.0 * w[i] * w[j]);
            for k in 0..K {
                for l in 0..K {
                    block -= c[k][i] * c[l][j].transpose() * (2.0 * inverse(k, l));
                }
            }
            block
        };
        Derivatives {
            squared: r.norm_squared(),
            gradient: w.map(|w| r * (2.0 * w)),
            hessian: std::array::from_fn(|i| std::array::from_fn(|j| block(i, j))),
        }
    }
}

/// Points `x[0]` and `x[1]`.
pub fn point_point(x: &[World3; 2]) -> Derivatives<2> {
    Derivatives::assemble::<0>([1.0, -1.0], [], x[0] - x[1], [], |_, _| 0.0)
}

/// Point `x[0]` and the line through `x[1]` and `x[2]`, which must differ.
pub fn point_line(x: &[World3; 3]) -> Derivatives<3> {
    let e = x[2] - x[1];
    let length_squared = e.norm_squared();
    let [from_1, from_2] = [x[0] - x[1], x[0] - x[2]];
    let (s, rest) = (from_1.dot(&e) / length_squared, -from_2.dot(&e) / length_squared);
    // From the nearer end, where it is exact; the weights must sum to zero.
    let (s, rest, r) = if s.abs() < rest.abs() {
        (s, 1.0 - s, from_1 - e * s)
    } else {
        (1.0 - rest, rest, from_2 + e * rest)
    };
    Derivatives::assemble([1.0, -rest, -s], [[0.0, 1.0, -1.0]], r, [-e], |_, _| {
        1.0 / length_squared
    })
}

/// Point `x[0]` and the plane through `x[1]`, `x[2]` and `x[3]`, which must not be on a line.
pub fn point_plane(x: &[World3; 4]) -> Derivatives<4> {
    let (u, v) = (x[2] - x[1], x[3] - x[1]);
    let at = x[0] - x[1];
    let normal = u.cross(&v);
    let squared = normal.norm_squared();
    let s = at.cross(&v).dot(&normal) / squared;
    let t = u.cross(&at).dot(&normal) / squared;
    let r = normal * (at.dot(&normal) / squared);
    let slopes = [[0.0, 1.0, -1.0, 0.0], [0.0, 1.0, 0.0, -1.0]];
    Derivatives::assemble([1.0, -(1.0 - s - t), -s, -t], slopes, r, [-u, -v], gram_inverse(u, v))
}

/// The line through `x[0]` and `x[1]`, and the line through `x[2]` and `x[3]`, which must not be
/// parallel. Where they nearly are, derivatives grow without bound: see
/// [`parallel_edges`](super::parallel_edges).
pub fn line_line(x: &[World3; 4]) -> Derivatives<4> {
    let (u, v) = (x[1] - x[0], x[3] - x[2]);
    let between = x[2] - x[0];
    let normal = u.cross(&v);
    let squared = normal.norm_squared();
    let s = between.cross(&v).dot(&normal) / squared;
    let t = between.cross(&u).dot(&normal) / squared;
    let r = normal * (-between.dot(&normal) / squared);
    let slopes = [[-1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -1.0]];
    Derivatives::assemble([1.0 - s, s, -(1.0 - t), -t], slopes, r, [u, -v], gram_inverse(u, -v))
}

/// Inverse of the matrix of dot products of two vectors; the determinant is that of their cross
/// product, which loses nothing to cancellation.
fn gram_inverse(u: World3, v: World3) -> impl Fn(usize, usize) -> f64 {
    let adjugate = Matrix2::new(v.norm_squared(), -u.dot(&v), -u.dot(&v), u.norm_squared());
    let inverse = adjugate / u.cross(&v).norm_squared();
    move |k, l| inverse[(k, l)]
}
