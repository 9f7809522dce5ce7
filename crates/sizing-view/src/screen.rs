//! Resolution in the picture: the metric of pixels on material space, and the bound by it.

use crate::camera::Camera;
use mesh_core::World3;
use nalgebra::{Matrix2, Matrix2x3, Matrix3x2, Vector2};
use remesh::Metric;

/// S: how the picture of a triangle (px) changes with its material coordinates (m), as a matrix of
/// two rows (px/m). `corners` are in camera space (m), `inverse_edges` is as in
/// [`mesh_core::geometry::inverse_edges`].
///
/// The direction of view is that towards the middle of the triangle and the depth that of its
/// nearest corner, both not below the camera's nearest depth: finite for triangles that cross the
/// plane of the camera or lie behind it, and never too coarse for a long triangle that comes near.
pub(crate) fn screen_gradient(
    camera: &Camera,
    corners: &[World3; 3],
    inverse_edges: &Matrix2<f64>,
) -> Matrix2<f64> {
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    let least = corners[0].z.min(corners[1].z).min(corners[2].z);
    let depth = least.max(camera.near());
    let projection = projection(camera, &middle);
    let [p, q] = [corners[1] - corners[0], corners[2] - corners[0]];
    let columns = [projection * p, projection * q];
    Matrix2::from_columns(&columns) * inverse_edges * (camera.focal_px() / depth)
}

/// The derivative of the picture of a point `c` of camera space (m), in units of the focal length (px)
/// over its depth (m).
pub(crate) fn projection(camera: &Camera, c: &World3) -> Matrix2x3<f64> {
    let depth = c.z.max(camera.near());
    Matrix2x3::new(1.0, 0.0, -c.x / depth, 0.0, 1.0, -c.y / depth)
}

/// An upper bound of the largest singular value of S for an undistorted triangle anywhere in a ball
/// of camera space (px/m).
pub(crate) fn most_pixels(camera: &Camera, centre: World3, radius: f64) -> f64 {
    let depth = (centre.z - radius).max(camera.near());
    let reach = centre.norm() + radius;
    camera.focal_px() * (reach / depth).hypot(1.0) / depth
}

/// Koh2014 Eq. (5)–(8) without the inverse of S: M where it is coarser than N = RᵀR with R = S/ℓ_min
/// (1/m), N where that is, direction by direction in the basis that makes both diagonal. With M = P⁻ᵀ
/// diag(mᵢ) P⁻¹ and N = P⁻ᵀ diag(nᵢ) P⁻¹ it is P⁻ᵀ diag(min(mᵢ, nᵢ)) P⁻¹.
///
/// The paper inverts S, which on an edge-on triangle has no inverse. The same result needs one of M
/// only: M = L Lᵀ, R L⁻ᵀ = U diag(√b) Qᵀ, and L Q diag(min(1, b)) Qᵀ Lᵀ. M of rank 1 or 0 is the
/// limit. An R that is not finite, or whose square is not, bounds nothing.
pub fn bounded(m: Metric, r: &Matrix2<f64>) -> Metric {
    let [mx, mxy, my] = m.entries();
    if !((mx + my + mxy).is_finite() && r.sum().is_finite()) {
        return m;
    }
    let [p, q] = [r.column(0).into_owned(), r.column(1).into_owned()];
    let bound = if mx >= my {
        lesser([mx, mxy, my], p, q)
    } else {
        lesser([my, mxy, mx], q, p).map(|[x, xy, y]| [y, xy, x])
    };
    // A square beyond all numbers comes from an R that bounds nothing.
    let bound = bound.filter(|entries| entries.iter().sum::<f64>().is_finite());
    bound.map_or(m, |[xx, xy, yy]| Metric::new(xx, xy, yy))
}

/// [`bounded`] for M with its larger diagonal entry first and R as its columns; none where M itself is
/// the result.
fn lesser([mx, mxy, my]: [f64; 3], p: Vector2<f64>, q: Vector2<f64>) -> Option<[f64; 3]> {
    if mx <= 0.0 {
        return None;
    }
    // E = [[1, 0], [−s, 1]] makes E M Eᵀ = diag(mx, weak), and R Eᵀ has the columns p and q − s p.
    let s = mxy / mx;
    let weak = my - s * mxy;
    let across = q - p * s;
    let area = p.perp(&q);
    let [x, xy, y] = if weak > 1e-15 * my {
        let (p, across) = (p / mx.sqrt(), across / weak.sqrt());
        let b = Metric::new(p.norm_squared(), p.dot(&across), across.norm_squared());
        let ([large, _], [e, f]) = b.eigen();
        // Their product is known to the last digit, their sum to those of the larger one.
        let small = if large > 0.0 { area * area / (mx * weak) / large } else { 0.0 };
        if small >= 1.0 {
            return None;
        }
        let large = large.min(1.0);
        let of = |i: usize, k: usize| large * e[i] * e[k] + small * f[i] * f[k];
        [mx * of(0, 0), (mx * weak).sqrt() * of(0, 1), weak * of(1, 1)]
    } else {
        // M has one direction only: what N allows along it, whatever happens across.
        let along = match across.norm_squared() {
            0.0 => p.norm_squared(),
            square => area * area / square,
        };
        if along >= mx {
            return None;
        }
        [along, 0.0, 0.0]
    };
    Some([x, xy + s * x, y + s * (2.0 * xy + s * x)])
}

/// True if `a`ᵀ`a` − `b`ᵀ`b` has no negative eigenvalue.
#[inline]
pub(crate) fn dominates(a: &Matrix2<f64>, b: &Matrix2<f64>) -> bool {
    let d = a.tr_mul(a) - b.tr_mul(b);
    d.m11 >= 0.0 && d.m22 >= 0.0 && d.m11 * d.m22 >= d.m12 * d.m12
}

/// The triangular matrix R with RᵀR = M.
#[inline]
pub(crate) fn root(m: Metric) -> Matrix2<f64> {
    let [xx, xy, yy] = m.entries();
    let x = xx.max(0.0).sqrt();
    let along = if x > 0.0 { xy / x } else { 0.0 };
    Matrix2::new(x, along, 0.0, (yy - along * along).max(0.0).sqrt())
}

/// The triangular matrix R with RᵀR = FᵀF.
#[inline]
pub(crate) fn square(f: &Matrix3x2<f64>) -> Matrix2<f64> {
    let (p, q) = (f.column(0), f.column(1));
    let length = p.norm();
    let along = if length > 0.0 { q.dot(&p) / length } else { 0.0 };
    let foot = if length > 0.0 { p * (along / length) } else { p * 0.0 };
    Matrix2::new(length, along, 0.0, (q - foot).norm())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frustum::Frustum;
    use mesh_core::geometry::inverse_edges;
    use nalgebra::UnitQuaternion;

    /// Small triangles before the camera: S against what the projection itself does to their edges.
    #[test]
    fn screen_gradient_is_the_jacobian_of_the_projection() {
        let rotation = UnitQuaternion::from_euler_angles(0.3, -0.7, 2.0);
        let camera = Camera::new(World3::new(1.0, 2.0, 3.0), rotation, 900.0, [640, 480]).unwrap();
        let frustum = Frustum::new(&camera);
        for (x, y, z) in [(0.0, 0.0, 2.0), (0.4, -0.3, 1.5), (-2.0, 1.0, 7.0), (9.0, 0.0, 1.0)] {
            let at = camera.position() + rotation * World3::new(x, y, z);
            let size = 1e-6;
            let world = [[0.0, 0.1, 0.0], [1.0, 0.4, 0.9], [-0.3, 1.2, 0.5]]
                .map(|p| at + World3::from(p) * size);
            let u = [[0.0, 0.0], [1.1, 0.2], [-0.1, 0.9]].map(|u| Vector2::from(u) * size);
            let c = world.map(|p| frustum.camera_space(p));
            let seen = c.map(|p| p.xy() * (900.0 / p.z));
            let s = screen_gradient(&camera, &c, &inverse_edges(u));
            for k in 1..3 {
                let error = (s * (u[k] - u[0]) - (seen[k] - seen[0])).norm();
                assert!(error < 1e-4 * (seen[k] - seen[0]).norm(), "{error} at {x} {y} {z}");
            }
        }
    }

    #[test]
    fn most_pixels_is_a_bound() {
        let camera =
            Camera::new(World3::zeros(), UnitQuaternion::identity(), 500.0, [9, 9]).unwrap();
        let camera = camera.with_near(0.3).unwrap();
        let u = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]].map(Vector2::from);
        for k in 0..500 {
            let angle = f64::from(k);
            let centre = World3::new(angle.cos(), (2.0 * angle).sin(), (0.7 * angle).sin()) * 2.0;
            let turn = UnitQuaternion::from_euler_angles(angle, 1.7 * angle, 0.3 * angle);
            let c = u.map(|u| centre + turn * World3::new(u.x, u.y, 0.0));
            let s = screen_gradient(&camera, &c, &inverse_edges(u));
            let most = most_pixels(&camera, centre, 0.1);
            let got = s.singular_values().max();
            assert!(got <= most * (1.0 + 1e-12), "{got} above {most} at {centre}");
        }
    }

    #[test]
    fn root_has_the_metric_as_its_square() {
        for m in
            [Metric::new(4.0, 1.0, 2.0), Metric::new(0.0, 0.0, 3.0), Metric::new(1.0, 2.0, 4.0)]
        {
            let r = root(m);
            assert!((r.tr_mul(&r) - m.matrix()).norm() < 1e-14);
        }
    }

    #[test]
    fn square_has_the_gram_matrix() {
        for f in [
            Matrix3x2::new(1.0, 2.0, 3.0, -4.0, 0.5, 6.0),
            Matrix3x2::new(0.0, 1.0, 0.0, 2.0, 0.0, 3.0),
            Matrix3x2::zeros(),
        ] {
            let r = square(&f);
            assert!((r.tr_mul(&r) - f.tr_mul(&f)).norm() < 1e-14 * (1.0 + f.norm_squared()));
        }
    }
}
