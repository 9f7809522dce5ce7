//! Closest points against the condition that defines them, on ordinary and degenerate elements, and
//! derivatives against finite differences, at random places and just off the degenerate ones.

use collision::distance::{self, Derivatives, EdgeEdgeFeature, VertexTriangleFeature};
use mesh_core::World3;
use proptest::prelude::*;

fn point() -> impl Strategy<Value = World3> {
    let coarse = prop::array::uniform3(-2i32..=2).prop_map(|c| World3::from(c.map(f64::from)));
    let fine = prop::array::uniform3(-1.0..1.0f64).prop_map(World3::from);
    prop_oneof![coarse, fine]
}

/// Four points; often with coincidences, often nearly degenerate.
fn points() -> impl Strategy<Value = [World3; 4]> {
    let nearly =
        (prop::array::uniform4(point()), 0usize..5, -16..0i32).prop_map(|(mut x, kind, size)| {
            let off = x[3] * 10f64.powi(size);
            match kind {
                // A triangle without much height, parallel edges, a short edge, a sliver, all in a plane.
                0 => x[3] = (x[1] + x[2]) * 0.5 + off,
                1 => x[3] = x[2] + (x[1] - x[0]) + off,
                2 => x[3] = x[2] + off,
                3 => x[2] = x[1] + off,
                _ => x.iter_mut().for_each(|p| p.z *= 10f64.powi(size)),
            }
            x
        });
    prop_oneof![prop::array::uniform4(point()), nearly]
}

/// Asserts that `offset` is the shortest way between the convex hulls: all of the hull of differences
/// lies beyond the plane through it. The first `n` points belong to the first body.
fn assert_optimal(x: &[World3; 4], n: usize, w: &[f64; 4], offset: &World3, squared: f64) {
    let size = (0..n).flat_map(|i| (n..4).map(move |j| (x[i] - x[j]).norm())).fold(0.0, f64::max);
    // Offsets are sums of a few vectors up to this size: their error is a few digits of it.
    let tolerance = 16.0 * f64::EPSILON * size;
    let sum: World3 = (0..4).map(|i| (x[i] - x[3]) * w[i]).sum();
    assert!((sum - offset).norm() <= tolerance, "weights {w:?} give {sum}, not {offset}");
    assert!((w[..n].iter().sum::<f64>() - 1.0).abs() < 1e-14 && w[..n].iter().all(|&w| w >= 0.0));
    assert!((w[n..].iter().sum::<f64>() + 1.0).abs() < 1e-14 && w[n..].iter().all(|&w| w <= 0.0));
    assert_eq!(squared, offset.norm_squared());
    for i in 0..n {
        for j in n..4 {
            let beyond = offset.dot(&(x[i] - x[j])) - squared;
            assert!(beyond >= -tolerance * size, "{beyond:e} at {i}, {j}, size {size}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn closest_points_of_vertex_and_triangle(x in points()) {
        let c = distance::vertex_triangle(&x);
        assert_optimal(&x, 1, &c.weights, &c.offset, c.squared);
        let in_use = |k: usize| c.weights[1 + k] != 0.0;
        match c.feature {
            VertexTriangleFeature::Corner(k) => prop_assert_eq!(c.weights[1 + k], -1.0),
            VertexTriangleFeature::Edge(k) => prop_assert!(in_use(k) && in_use((k + 1) % 3)),
            VertexTriangleFeature::Face => prop_assert!((0..3).all(in_use)),
        }
    }

    #[test]
    fn closest_points_of_edges(x in points()) {
        let c = distance::edge_edge(&x);
        assert_optimal(&x, 2, &c.weights, &c.offset, c.squared);
        let w = c.weights;
        match c.feature {
            EdgeEdgeFeature::Ends(i, j) => prop_assert_eq!((w[i], w[2 + j]), (1.0, -1.0)),
            EdgeEdgeFeature::EndInside(i) => prop_assert!(w[i] == 1.0 && w[2] * w[3] > 0.0),
            EdgeEdgeFeature::InsideEnd(j) => prop_assert!(w[2 + j] == -1.0 && w[0] * w[1] > 0.0),
            EdgeEdgeFeature::Inside => prop_assert!(w[0] * w[1] > 0.0 && w[2] * w[3] > 0.0),
        }
    }

    #[test]
    fn sizes_do_not_matter(x in points(), power in -40..40i32) {
        // Powers of two change no digit, so nothing may be compared with a fixed length.
        let scale = 2f64.powi(power);
        let small = x.map(|x| x * scale);
        let (a, b) = (distance::vertex_triangle(&x), distance::vertex_triangle(&small));
        prop_assert_eq!((a.feature, a.weights, a.offset * scale), (b.feature, b.weights, b.offset));
        let (a, b) = (distance::edge_edge(&x), distance::edge_edge(&small));
        prop_assert_eq!((a.feature, a.weights, a.offset * scale), (b.feature, b.weights, b.offset));
    }

    #[test]
    fn places_do_not_matter(units in prop::array::uniform4(prop::array::uniform3(-4096i32..4096))) {
        // Details of 1e-6 m, made of units of 2⁻³², at coordinates of 1e6 m: exact in both places.
        let local = units.map(|p| World3::from(p.map(|c| f64::from(c) * 2f64.powi(-32))));
        let far = local.map(|x| x + World3::new(1048576.0, -1048576.0, 1048576.0));
        prop_assert_eq!(distance::vertex_triangle(&local), distance::vertex_triangle(&far));
        prop_assert_eq!(distance::edge_edge(&local), distance::edge_edge(&far));
    }
}

#[test]
fn short_edges_that_cross() {
    // At l = 1e-4 m, a distance with an absolute threshold gave 0.27 l here instead of 0.1 l.
    for l in [1.0, 1e-4, 1e-9, 1e-30] {
        let x = [
            World3::new(-0.5, 0.0, 0.0),
            World3::new(0.5, 0.0, 0.0),
            World3::new(0.0, -0.5, 0.1),
            World3::new(0.0, 0.5, 0.1),
        ];
        let c = distance::edge_edge(&x.map(|x| x * l));
        assert_eq!(c.feature, EdgeEdgeFeature::Inside);
        assert!((c.distance() / l - 0.1).abs() < 1e-15);
    }
}

/// Compares derivatives with central differences of step `h`: `relative` bounds the error of each
/// against the largest, beside the error of the difference itself. That is a third of what doubling
/// the step changes, and as much again for rounding.
fn assert_derivatives<const N: usize>(
    of: impl Fn(&[World3; N]) -> Derivatives<N>,
    x: [World3; N],
    h: f64,
    relative: f64,
) {
    let at = of(&x);
    let largest_first = at.gradient.iter().map(|g| g.amax()).fold(0.0, f64::max);
    let largest_second = at.hessian.iter().flatten().map(|b| b.amax()).fold(0.0, f64::max);
    for i in 0..N {
        for k in 0..3 {
            let moved = |by: f64| {
                let mut y = x;
                y[i][k] += by;
                of(&y)
            };
            let (near, far) = ([moved(h), moved(-h)], [moved(2.0 * h), moved(-2.0 * h)]);
            let slope = (near[0].squared - near[1].squared) / (2.0 * h);
            let coarse = (far[0].squared - far[1].squared) / (4.0 * h);
            let error = (slope - at.gradient[i][k]).abs();
            let allowed = relative * largest_first + (slope - coarse).abs();
            assert!(error <= allowed, "first: {error:e} of {largest_first:e}, not {allowed:e}");
            for j in 0..N {
                let slope = (near[0].gradient[j] - near[1].gradient[j]) / (2.0 * h);
                let coarse = (far[0].gradient[j] - far[1].gradient[j]) / (4.0 * h);
                let error = (slope - at.hessian[j][i].column(k)).amax();
                let allowed = relative * largest_second + (slope - coarse).amax();
                assert!(
                    error <= allowed,
                    "second: {error:e} of {largest_second:e}, not {allowed:e}"
                );
            }
        }
    }
    // Moving everything together changes nothing.
    let sum: World3 = at.gradient.iter().sum();
    assert!(sum.norm() <= 1e-13 * largest_first);
}

/// Points at least 0.3 off all degenerate places of what follows.
fn sound(x: &[World3; 4]) -> bool {
    let volume = |a: World3, b: World3| a.cross(&b).norm();
    volume(x[2] - x[1], x[3] - x[1]) > 0.3 && volume(x[1] - x[0], x[3] - x[2]) > 0.3
}

proptest! {
    #[test]
    fn derivatives_at_random(x in prop::array::uniform4(prop::array::uniform3(-1.0..1.0f64))) {
        let x = x.map(World3::from);
        prop_assume!(sound(&x));
        assert_derivatives(distance::point_point, [x[0], x[1]], 1e-5, 1e-9);
        assert_derivatives(distance::point_line, [x[0], x[2], x[3]], 1e-5, 1e-7);
        assert_derivatives(distance::point_plane, x, 1e-5, 1e-7);
        assert_derivatives(distance::line_line, x, 1e-5, 1e-7);
    }

    /// A sliver of height d, lines that cross at an angle d, a point d from the line or plane.
    #[test]
    fn derivatives_just_off_degenerate(
        x in prop::array::uniform4(prop::array::uniform3(-1.0..1.0f64)),
        size in 1..5i32,
    ) {
        let x = x.map(World3::from);
        prop_assume!(sound(&x));
        let d = 10f64.powi(-size);
        let (e, off) = (x[3] - x[2], (x[2] - x[1]).cross(&(x[3] - x[1])).normalize() * d);
        let on_plane = x[1] * 0.3 + x[2] * 0.5 + x[3] * 0.2;
        let on_line = x[2] * 0.6 + x[3] * 0.4;
        // The step is small against what is nearly zero.
        let h = 1e-4 * d;
        assert_derivatives(distance::point_line, [on_line + off, x[2], x[3]], h, 1e-6);
        assert_derivatives(distance::point_plane, [on_plane + off, x[1], x[2], x[3]], h, 1e-6);
        assert_derivatives(distance::point_plane, [x[0], on_line + off, x[2], x[3]], h, 1e-5);
        assert_derivatives(distance::line_line, [x[0], x[0] + e + off, x[2], x[3]], h, 1e-5);
        // A short line, and two points that nearly coincide.
        assert_derivatives(distance::point_line, [x[0], x[2], x[2] + off], h, 1e-6);
        assert_derivatives(distance::point_point, [x[0], x[0] + off], h, 1e-6);
    }

    /// The gradient of the distance itself is the offset by the weights, whatever the features.
    #[test]
    fn weights_and_offset_are_the_gradient(x in prop::array::uniform4(prop::array::uniform3(-1.0..1.0f64))) {
        let x = x.map(World3::from);
        let h = 1e-6;
        type Of = fn(&[World3; 4]) -> (f64, [f64; 4], World3);
        let both: [Of; 2] = [
            |x| { let c = distance::vertex_triangle(x); (c.squared, c.weights, c.offset) },
            |x| { let c = distance::edge_edge(x); (c.squared, c.weights, c.offset) },
        ];
        for of in both {
            let (_, w, offset) = of(&x);
            for i in 0..4 {
                for k in 0..3 {
                    let moved = |by: f64| { let mut y = x; y[i][k] += by; of(&y).0 };
                    let slope = (moved(h) - moved(-h)) / (2.0 * h);
                    // Second differences may jump, where the features change, by the curvature 1/sin.
                    prop_assert!((slope - 2.0 * w[i] * offset[k]).abs() < 1e-3);
                }
            }
        }
    }
}

#[test]
fn features_agree_with_their_distances() {
    let x = [[0.1, 0.2, 0.5], [0.0, 0.0, 0.0], [1.0, 0.0, 0.1], [0.0, 1.0, -0.1]].map(World3::from);
    let face = distance::vertex_triangle(&x);
    assert_eq!(face.feature, VertexTriangleFeature::Face);
    assert!((face.squared - distance::point_plane(&x).squared).abs() < 1e-16);
    let x = [[0.1, 0.2, 0.0], [0.9, 0.1, 0.0], [0.5, -1.0, 0.3], [0.4, 1.0, 0.2]].map(World3::from);
    let inside = distance::edge_edge(&x);
    assert_eq!(inside.feature, EdgeEdgeFeature::Inside);
    assert!((inside.squared - distance::line_line(&x).squared).abs() < 1e-16);
}

#[test]
fn the_factor_for_parallel_edges() {
    let rest = [1.25, 0.8];
    // |u × v|² of edges of length 1 at a small angle is its square; the factor ends at 1e-3.
    let at = |angle: f64| -> [World3; 4] {
        [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.2, 0.1, 0.3],
            [0.2 + angle.cos(), 0.1 + angle.sin(), 0.3],
        ]
        .map(World3::from)
    };
    let value = |x: &[World3; 4]| distance::parallel_edges(x, rest).value;
    assert_eq!(value(&at(0.0)), 0.0);
    assert_eq!(value(&at(0.04)), 1.0);
    assert!(value(&at(0.0316)) > 0.99999 && value(&at(0.0316)) < 1.0);
    for angle in [1e-6, 1e-3, 0.01, 0.02, 0.031, 0.0316] {
        let x = at(angle);
        let m = distance::parallel_edges(&x, rest);
        let largest = m.hessian.iter().flatten().map(|b| b.amax()).fold(0.0, f64::max);
        let h = 1e-7;
        for i in 0..4 {
            for k in 0..3 {
                let moved = |by: f64| {
                    let mut y = x;
                    y[i][k] += by;
                    distance::parallel_edges(&y, rest)
                };
                let (plus, minus) = (moved(h), moved(-h));
                let slope = (plus.value - minus.value) / (2.0 * h);
                assert!((slope - m.gradient[i][k]).abs() < 1e-6 * largest, "{angle}: first");
                for j in 0..4 {
                    let slope = (plus.gradient[j] - minus.gradient[j]) / (2.0 * h);
                    let error = (slope - m.hessian[j][i].column(k)).amax();
                    assert!(error < 1e-4 * largest, "{angle}: second {error:e} of {largest:e}");
                }
            }
        }
    }
}
