//! The preconditioned conjugate gradient method, and the loop around it that trusts only the
//! residual computed afresh.
//!
//! To solve `A x = b`, conjugate gradients minimise `½ xᵀ A x − bᵀ x` over an ever larger space of
//! search directions, each `A`-orthogonal to all before it. The number of iterations grows like the
//! square root of the condition number of `M⁻¹ A`, where `M` is the preconditioner: a matrix like
//! `A` that is cheap to solve with (Hestenes and Stiefel 1952; Saad 2003, §9.2).

use nalgebra::Vector3;

use super::matrix::BlockMatrix;
use super::sums::{CHUNK, dot};

/// Residuals below this many roundings of `‖A‖ ‖x‖ + ‖b‖` cannot be improved in double precision.
const ROUNDINGS: f64 = 64.0;

/// A symmetric positive definite `M ≈ A` to solve with.
pub(super) trait Preconditioner {
    /// `z = M⁻¹ r`; returns `rᵀ z`.
    fn apply(&mut self, r: &[Vector3<f64>], z: &mut [Vector3<f64>]) -> f64;

    /// The step `x += α p`, `r −= α q`, then `z = M⁻¹ r`. Returns `rᵀ r` and `rᵀ z`; where `rᵀ r` is
    /// at most `target`, `z` is not needed any more and may be left as it is.
    fn advance(
        &mut self,
        alpha: f64,
        target: f64,
        vectors: &mut Vectors,
        x: &mut [Vector3<f64>],
    ) -> (f64, f64) {
        let Vectors { r, z, p, q } = vectors;
        let mut rr = 0.0;
        for first in (0..x.len()).step_by(CHUNK) {
            let chunk = first..(first + CHUNK).min(x.len());
            let (x, r) = (&mut x[chunk.clone()], &mut r[chunk.clone()]);
            rr += step(alpha, &p[chunk.clone()], &q[chunk], x, r);
        }
        if rr <= target {
            return (rr, f64::NAN);
        }
        let rz = self.apply(r, z);
        (rr, rz)
    }
}

/// One chunk of `x += α p`, `r −= α q`; returns its part of `rᵀ r`.
pub(super) fn step(
    alpha: f64,
    p: &[Vector3<f64>],
    q: &[Vector3<f64>],
    x: &mut [Vector3<f64>],
    r: &mut [Vector3<f64>],
) -> f64 {
    let mut partial = Vector3::zeros();
    for (((x_i, r_i), p_i), q_i) in x.iter_mut().zip(r.iter_mut()).zip(p).zip(q) {
        *x_i += alpha * p_i;
        *r_i -= alpha * q_i;
        partial += r_i.component_mul(r_i);
    }
    partial.sum()
}

/// The four vectors of the method, kept between solves: residual `r`, preconditioned residual `z`,
/// search direction `p` and its image `q = A p`.
#[derive(Clone, Debug, Default)]
pub(super) struct Vectors {
    pub(super) r: Vec<Vector3<f64>>,
    pub(super) z: Vec<Vector3<f64>>,
    pub(super) p: Vec<Vector3<f64>>,
    pub(super) q: Vec<Vector3<f64>>,
}

impl Vectors {
    fn resize(&mut self, n: usize) {
        for vector in [&mut self.r, &mut self.z, &mut self.p, &mut self.q] {
            vector.resize(n, Vector3::zeros());
        }
    }
}

/// How the iteration ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// The true residual is at most the tolerance.
    Converged,
    /// The true residual is as small as double precision allows, which is above the tolerance.
    Rounding,
    /// The iterations allowed are used up.
    Budget,
    /// No more progress, though rounding does not explain it.
    Stagnated,
    /// `pᵀ A p` was not positive: the matrix is not positive definite (NaN: not finite).
    Curvature(f64),
}

/// What the iteration reached.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outcome {
    pub(super) end: End,
    /// Iterations, one product with `A` and one solve with `M` each.
    pub(super) iterations: usize,
    /// `‖b − A x‖ / ‖b‖`, computed from `x`.
    pub(super) relative_residual: f64,
}

/// Where to start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Start {
    /// From the `x` handed over; from zero if that is better.
    Given,
    /// From `M⁻¹ b`: the solution itself where `M` is a fresh factor of `A`.
    Preconditioned,
}

/// Solves `A x = b` to `‖b − A x‖ ≤ tolerance ‖b‖`.
///
/// The residual that the recurrences carry drifts from the true one, so after each run of the
/// method the residual is computed from `x`, and the method restarted if that is still too large.
pub(super) fn solve(
    a: &BlockMatrix,
    b: &[Vector3<f64>],
    x: &mut [Vector3<f64>],
    preconditioner: &mut impl Preconditioner,
    start: Start,
    tolerance: f64,
    max_iterations: usize,
    vectors: &mut Vectors,
) -> Outcome {
    vectors.resize(x.len());
    let bb = dot(b, b);
    let relative = |rr: f64| (rr / bb).sqrt();
    let mut rr = match start {
        Start::Preconditioned => {
            preconditioner.apply(b, x);
            a.residual(b, x, &mut vectors.r)
        }
        Start::Given if x.iter().any(|x_i| *x_i != Vector3::zeros()) => {
            a.residual(b, x, &mut vectors.r)
        }
        Start::Given => bb,
    };
    if start == Start::Given && (rr >= bb || rr.is_nan()) {
        x.fill(Vector3::zeros());
        vectors.r.copy_from_slice(b);
        rr = bb;
    }
    // The recurrence aims a little lower, so that its drift does not cost a restart.
    let target = (0.9 * tolerance).powi(2) * bb;
    let mut iterations = 0;
    let mut before = f64::INFINITY;
    let end = loop {
        if relative(rr) <= tolerance {
            break End::Converged;
        }
        if rr >= 0.25 * before || rr.is_nan() {
            break if rounding_limited(a, b, x, rr) { End::Rounding } else { End::Stagnated };
        }
        if iterations >= max_iterations {
            break End::Budget;
        }
        before = rr;
        let budget = max_iterations - iterations;
        let (used, curvature) = run(a, x, preconditioner, target, budget, vectors);
        iterations += used;
        rr = a.residual(b, x, &mut vectors.r);
        if let Some(curvature) = curvature {
            break if relative(rr) <= tolerance {
                End::Converged
            } else {
                End::Curvature(curvature)
            };
        }
    };
    Outcome { end, iterations, relative_residual: relative(rr) }
}

/// One run of the method from the residual in `vectors.r`. Returns the iterations, and `pᵀ A p`
/// where it was not positive.
fn run(
    a: &BlockMatrix,
    x: &mut [Vector3<f64>],
    preconditioner: &mut impl Preconditioner,
    target: f64,
    max_iterations: usize,
    vectors: &mut Vectors,
) -> (usize, Option<f64>) {
    let mut rz = preconditioner.apply(&vectors.r, &mut vectors.z);
    vectors.p.copy_from_slice(&vectors.z);
    for iteration in 0..max_iterations {
        let pq = a.multiply_dot(&vectors.p, &mut vectors.q);
        if pq <= 0.0 || pq.is_nan() {
            return (iteration, Some(pq));
        }
        let alpha = rz / pq;
        let (rr, rz_next) = preconditioner.advance(alpha, target, vectors, x);
        if rr <= target {
            return (iteration + 1, None);
        }
        let beta = rz_next / rz;
        rz = rz_next;
        for (p_i, z_i) in vectors.p.iter_mut().zip(&vectors.z) {
            *p_i = z_i + beta * *p_i;
        }
    }
    (max_iterations, None)
}

/// Whether a residual of squared norm `rr` is within a few roundings of what it is the difference of.
fn rounding_limited(a: &BlockMatrix, b: &[Vector3<f64>], x: &[Vector3<f64>], rr: f64) -> bool {
    let norm_a = a.row_sums().into_iter().fold(0.0, f64::max);
    let size = norm_a * dot(x, x).sqrt() + dot(b, b).sqrt();
    rr.sqrt() <= ROUNDINGS * f64::EPSILON * size
}
