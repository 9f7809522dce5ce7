//! The point of a triangle that is closest to another point.

use nalgebra::Vector3;

/// Barycentric coordinates (1) of the point of a triangle closest to `p` (Ericson2005 §5.1.5). Of a
/// triangle without area it is a point of its longest edge.
pub(super) fn closest(p: &Vector3<f64>, [a, b, c]: &[Vector3<f64>; 3]) -> [f64; 3] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let s = d1 / (d1 - d3);
        return [1.0 - s, s, 0.0];
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let s = d2 / (d2 - d6);
        return [1.0 - s, 0.0, s];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let s = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - s, s];
    }
    let sum = va + vb + vc;
    [va / sum, vb / sum, vc / sum]
}

/// The point with these barycentric coordinates.
pub(super) fn at(weights: &[f64; 3], [a, b, c]: &[Vector3<f64>; 3]) -> Vector3<f64> {
    a * weights[0] + b * weights[1] + c * weights[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Vector3<f64>> {
        [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(Vector3::from)
    }

    proptest! {
        #[test]
        fn no_point_of_the_triangle_is_closer(
            p in point(),
            triangle in [point(), point(), point()],
            (s, t) in (0.0..1.0f64, 0.0..1.0f64),
        ) {
            let found = closest(&p, &triangle);
            prop_assert!((found.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            prop_assert!(found.iter().all(|w| *w >= 0.0));
            let distance = (at(&found, &triangle) - p).norm();
            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
            let other = (at(&[1.0 - s - t, s, t], &triangle) - p).norm();
            prop_assert!(distance <= other + 1e-9, "{} at {:?}, but {}", distance, found, other);
        }
    }
}
