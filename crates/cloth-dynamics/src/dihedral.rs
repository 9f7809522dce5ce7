//! The dihedral angle of a hinge with its exact first and second derivatives.
//!
//! Corners (a, b, c, d): the edge a–b and the apexes c, d of the triangles (a, b, c) and (b, a, d).
//! With the unnormalised normals n_c, n_d and the edge e = b − a the gradient at an apex is
//! −p, p = |e| n_c/|n_c|², and the edge's ends share it by the foot point s of the apex:
//! ∇_c θ = −p, ∇_d θ = −q, ∇_a θ = (1 − s_c) p + (1 − s_d) q, ∇_b θ = s_c p + s_d q.

use mesh_core::World3;
use nalgebra::Matrix3;

/// Gradient of the angle (1/m) at (a, b, c, d). Zero if a triangle is degenerate.
pub(crate) fn gradient(x: &[World3; 4]) -> [World3; 4] {
    let [a, b, c, d] = *x;
    let e = b - a;
    let (n_c, n_d) = (e.cross(&(c - a)), (d - a).cross(&e));
    let (nn_c, nn_d, ee) = (n_c.norm_squared(), n_d.norm_squared(), e.norm_squared());
    if nn_c < f64::MIN_POSITIVE || nn_d < f64::MIN_POSITIVE {
        return [World3::zeros(); 4];
    }
    let length = ee.sqrt();
    let (p, q) = (n_c * (length / nn_c), n_d * (length / nn_d));
    let (s_c, s_d) = ((c - a).dot(&e) / ee, (d - a).dot(&e) / ee);
    [p * (1.0 - s_c) + q * (1.0 - s_d), p * s_c + q * s_d, -p, -q]
}

/// The matrix of w ↦ v × w.
fn cross(v: &World3) -> Matrix3<f64> {
    Matrix3::new(0.0, -v.z, v.y, v.z, 0.0, -v.x, -v.y, v.x, 0.0)
}

/// Second derivatives of the angle (1/m²): blocks `[i][j]` = ∂(∇ᵢθ)/∂xⱼ for (a, b, c, d). Zero if
/// a triangle is degenerate.
pub(crate) fn hessian(x: &[World3; 4]) -> [[Matrix3<f64>; 4]; 4] {
    let [a, b, c, d] = *x;
    let e = b - a;
    let ee = e.norm_squared();
    let mut out = [[Matrix3::zeros(); 4]; 4];
    // Both sides have the same form: the apex's own normal turned the same way round the edge.
    for (apex, index, sign) in [(c, 2, 1.0), (d, 3, -1.0)] {
        let r = apex - a;
        let n = e.cross(&r) * sign;
        let nn = n.norm_squared();
        if nn < f64::MIN_POSITIVE || ee == 0.0 {
            return [[Matrix3::zeros(); 4]; 4];
        }
        let length = ee.sqrt();
        let p = n * (length / nn);
        let s = r.dot(&e) / ee;
        // dn = sign (de × r + e × dr), with de = db − da and dr = dapex − da.
        let (dn_e, dn_r) = (cross(&r) * -sign, cross(&e) * sign);
        let dp_dn = (Matrix3::identity() - n * n.transpose() * (2.0 / nn)) * (length / nn);
        let dp_e = dp_dn * dn_e + n * e.transpose() / (length * nn);
        let dp_r = dp_dn * dn_r;
        let ds_e = (r - e * (2.0 * s)).transpose() / ee;
        let ds_r = e.transpose() / ee;
        // Columns: derivative with respect to a, b and the apex.
        let dp = [(0, -dp_e - dp_r), (1, dp_e), (index, dp_r)];
        let ds = [-ds_e - ds_r, ds_e, ds_r];
        for ((j, dp), ds) in dp.into_iter().zip(ds) {
            out[0][j] += dp * (1.0 - s) - p * ds;
            out[1][j] += dp * s + p * ds;
            out[index][j] -= dp;
        }
    }
    out
}
