//! The measured, data-driven stretching of Wang, O'Brien and Ramamoorthi 2011.
//!
//! A file gives the stiffness tensor for small strain (row 0) and, at a stretch of 7/6, for five
//! directions of the largest stretch (0°, 22.5°, 45°, 67.5°, 90° from the warp). The measured law is
//! a stress K(E) E; it is not the gradient of any energy. We take the potential
//!
//!   ψ(E) = ∫₀¹ E : K(tE) : t E dt = q₀(E) + 2 W(e) (Q(E, c) − q₀(E)),
//!
//! whose stress along the direction of loading is the measured one, so that steps have an energy
//! that cannot rise. Here q are the quadratic forms ½ E:K:E of the rows, e the largest principal
//! strain, c = cos 2θ its direction, and W the integral of the linear ramp between the two
//! amplitudes. Between directions the rows are blended with smooth convex weights in c.

use super::{Law, Response};
use nalgebra::{Matrix3, Vector3};

/// Largest principal Green strain at which the directional rows hold: a stretch of 7/6.
const RAMP: f64 = 0.5 * (49.0 / 36.0 - 1.0);
/// Rounds off the corner where both principal strains agree and no direction is largest.
const ROUND: f64 = 5e-3;
/// cos 2θ of the five measured directions.
const DIRECTIONS: [f64; 5] =
    [1.0, std::f64::consts::FRAC_1_SQRT_2, 0.0, -std::f64::consts::FRAC_1_SQRT_2, -1.0];

/// Data-driven stretching.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredMembrane {
    rows: Box<[Matrix3<f64>; 6]>,
    /// How many rows had to be changed to be positive semi-definite.
    repaired: usize,
}

/// A blend of directional rows: value and derivatives with respect to c.
struct Blend {
    /// The two rows and the weight of the second.
    rows: [usize; 2],
    w: f64,
    dw: f64,
    ddw: f64,
}

impl MeasuredMembrane {
    /// From the six rows (C11, C12, C22, C33) of a file, in N/m as written there, each multiplied
    /// by `scale`. The file's tensor convention doubles all constants against ours, where the shear
    /// constant multiplies the engineering strain 2 E₁₂ (see `docs/decisions.md`). Rows that are
    /// not positive semi-definite (several published ones are not) are projected.
    pub fn new(table: &[[f64; 4]; 6], scale: f64) -> Self {
        let mut repaired = 0;
        let rows = table.map(|[c11, c12, c22, c33]| {
            let [a, c, s] = [2.0 * c11, 2.0 * c22, c33].map(|k| (k * scale).max(0.0));
            let limit = 0.99 * (a * c).sqrt();
            let b = (2.0 * c12 * scale).clamp(-limit, limit);
            if a != 2.0 * c11 * scale
                || c != 2.0 * c22 * scale
                || s != c33 * scale
                || b != 2.0 * c12 * scale
            {
                repaired += 1;
            }
            Matrix3::new(a, b, 0.0, b, c, 0.0, 0.0, 0.0, s)
        });
        MeasuredMembrane { rows: Box::new(rows), repaired }
    }

    /// How many of the six rows were not positive semi-definite and were projected.
    pub fn repaired_rows(&self) -> usize {
        self.repaired
    }

    fn blend(c: f64) -> Blend {
        let k = DIRECTIONS[1..4].iter().take_while(|&&node| c < node).count();
        let width = DIRECTIONS[k + 1] - DIRECTIONS[k];
        let t = (c - DIRECTIONS[k]) / width;
        // Quintic smoothstep: the second derivative is continuous at the measured directions.
        Blend {
            rows: [k + 1, k + 2],
            w: t * t * t * (10.0 + t * (6.0 * t - 15.0)),
            dw: 30.0 * t * t * (1.0 + t * (t - 2.0)) / width,
            ddw: 60.0 * t * (1.0 + t * (2.0 * t - 3.0)) / (width * width),
        }
    }

    /// 2 W and its first two derivatives with respect to the largest principal strain.
    fn ramp(e: f64) -> [f64; 3] {
        if e <= 0.0 {
            [0.0; 3]
        } else if e < RAMP {
            [2.0 * e / (3.0 * RAMP), 2.0 / (3.0 * RAMP), 0.0]
        } else {
            let q = RAMP * RAMP / (e * e);
            [1.0 - q / 3.0, 2.0 * q / (3.0 * e), -2.0 * q / (e * e)]
        }
    }
}

/// What the first derivative of the energy is made of.
struct FirstOrder {
    /// Radius of Mohr's circle, and its half difference and shear over the radius.
    r: f64,
    rd: f64,
    rs: f64,
    /// 2 W and its derivatives.
    ramp: [f64; 3],
    blend: Blend,
    /// Gradients of e = p + r and c = d/r.
    grad_e: Vector3<f64>,
    grad_c: Vector3<f64>,
    s_0: Vector3<f64>,
    s_12: Vector3<f64>,
    q_12: f64,
    /// Q − q₀ and its gradient.
    excess: f64,
    grad_excess: Vector3<f64>,
}

impl FirstOrder {
    fn stress(&self) -> Vector3<f64> {
        let [ramp, d_ramp, _] = self.ramp;
        self.s_0 + self.grad_excess * ramp + self.grad_e * (d_ramp * self.excess)
    }
}

impl MeasuredMembrane {
    /// `None` where nothing but the first row counts.
    fn first_order(&self, a: &Vector3<f64>) -> Option<FirstOrder> {
        // Mean strain p, half difference d, shear s; r is the radius of Mohr's circle.
        let (p, d, s) = (0.5 * (a.x + a.y), 0.5 * (a.x - a.y), 0.5 * a.z);
        let r = (d * d + s * s + ROUND * ROUND).sqrt();
        let ramp = Self::ramp(p + r - ROUND);
        if ramp[0] == 0.0 {
            return None;
        }
        let (rd, rs) = (d / r, s / r);
        // From (p, d, s) to (a₁₁, a₂₂, 2a₁₂).
        let gradient = |p: f64, d: f64, s: f64| Vector3::new(0.5 * (p + d), 0.5 * (p - d), 0.5 * s);
        let grad_c = gradient(0.0, (1.0 - rd * rd) / r, -rd * rs / r);
        let blend = Self::blend(rd);
        let s_0 = self.rows[0] * a;
        let [s_1, s_2] = blend.rows.map(|row| self.rows[row] * a);
        let s_12 = s_2 - s_1;
        let q_12 = 0.5 * a.dot(&s_12);
        Some(FirstOrder {
            r,
            rd,
            rs,
            ramp,
            grad_e: gradient(1.0, rd, rs),
            excess: 0.5 * a.dot(&(s_1 - s_0)) + blend.w * q_12,
            grad_excess: s_1 + s_12 * blend.w - s_0 + grad_c * (blend.dw * q_12),
            grad_c,
            blend,
            s_0,
            s_12,
            q_12,
        })
    }
}

impl Law for MeasuredMembrane {
    fn energy(&self, a: &Vector3<f64>) -> f64 {
        let quadratic = |row: usize| 0.5 * a.dot(&(self.rows[row] * a));
        let (p, d, s) = (0.5 * (a.x + a.y), 0.5 * (a.x - a.y), 0.5 * a.z);
        let r = (d * d + s * s + ROUND * ROUND).sqrt();
        let [ramp, ..] = Self::ramp(p + r - ROUND);
        let q_0 = quadratic(0);
        if ramp == 0.0 {
            return q_0;
        }
        let blend = Self::blend(d / r);
        let [q_1, q_2] = blend.rows.map(quadratic);
        q_0 + ramp * (q_1 + blend.w * (q_2 - q_1) - q_0)
    }

    fn stress(&self, a: &Vector3<f64>) -> Vector3<f64> {
        match self.first_order(a) {
            Some(first) => first.stress(),
            None => self.rows[0] * a,
        }
    }

    fn response(&self, a: &Vector3<f64>) -> Response {
        let Some(first) = self.first_order(a) else {
            let stress = self.rows[0] * a;
            return Response { energy: 0.5 * a.dot(&stress), stress, tangent: self.rows[0] };
        };
        let FirstOrder { r, rd, rs, ramp: [ramp, d_ramp, dd_ramp], .. } = first;
        let FirstOrder { grad_e, grad_c, grad_excess, excess, q_12, s_12, .. } = first;
        let hessian =
            |dd: f64, ds: f64, ss: f64| Matrix3::new(dd, -dd, ds, -dd, dd, -ds, ds, -ds, ss) * 0.25;
        let hess_e = hessian((1.0 - rd * rd) / r, -rd * rs / r, (1.0 - rs * rs) / r);
        let hess_c = hessian(
            -3.0 * rd * (1.0 - rd * rd) / (r * r),
            rs * (3.0 * rd * rd - 1.0) / (r * r),
            rd * (3.0 * rs * rs - 1.0) / (r * r),
        );

        let blend = &first.blend;
        let [k_1, k_2] = blend.rows.map(|row| &self.rows[row]);
        let k_excess = k_1 + (k_2 - k_1) * blend.w - self.rows[0];
        let (q_c, q_cc, s_c) = (blend.dw * q_12, blend.ddw * q_12, s_12 * blend.dw);
        let outer = |u: &Vector3<f64>, v: &Vector3<f64>| u * v.transpose() + v * u.transpose();
        let hess_excess =
            k_excess + outer(&grad_c, &s_c) + grad_c * grad_c.transpose() * q_cc + hess_c * q_c;
        Response {
            energy: 0.5 * a.dot(&first.s_0) + ramp * excess,
            stress: first.stress(),
            tangent: self.rows[0]
                + hess_excess * ramp
                + outer(&grad_e, &grad_excess) * d_ramp
                + (grad_e * grad_e.transpose() * dd_ramp + hess_e * d_ramp) * excess,
        }
    }

    fn at_rest(&self) -> Matrix3<f64> {
        self.rows[0]
    }
}
