//! Viewpoints that frame a scene, and boxes around it.

use super::super::lens::Lens;
use super::super::{Bounds, ColourMap, VIRIDIS};
use super::*;

/// Where a point lies in the picture: column, row (px), depth.
fn place(viewpoint: &Viewpoint, size: Size, point: [f64; 3]) -> [f64; 3] {
    let lens = Lens::new(viewpoint, size).unwrap();
    let p = lens.project(lens.eye_space(point).unwrap());
    [p.x / p.z, p.y / p.z, p.z]
}

#[test]
fn fit_keeps_all_points_inside_and_uses_the_room() {
    let mut random = Random(3);
    for round in 0..400 {
        let size = [Size::new(960, 540), Size::new(300, 400), Size::new(64, 64)][round % 3];
        let scale = 10_f64.powf(random.within(-6.0, 6.0));
        let offset = random.point(10.0 * scale);
        let stretch: [f64; 3] = std::array::from_fn(|_| 10_f64.powf(random.within(-1.5, 0.0)));
        let up = random.point(3.0);
        let points: Vec<[f64; 3]> = (0..60)
            .map(|_| {
                let p = random.point(1.0);
                std::array::from_fn(|k| offset[k] + scale * stretch[k] * p[k])
            })
            .collect();
        let viewpoint = Viewpoint::fit(points.iter().copied(), up, size);
        let places: Vec<_> = points.iter().map(|&p| place(&viewpoint, size, p)).collect();
        let (width, height) = (f64::from(size.width), f64::from(size.height));
        let mut used = [0.0_f64; 2];
        let mut edges = [f64::INFINITY, f64::INFINITY, 0.0_f64, 0.0_f64];
        for [x, y, depth] in &places {
            assert!(*depth > 2.0 * Lens::NEAR, "round {round}: depth {depth}");
            assert!((0.0..width).contains(x), "round {round}: column {x} of {width}");
            assert!((0.0..height).contains(y), "round {round}: row {y} of {height}");
            edges = [edges[0].min(*x), edges[1].min(*y), edges[2].max(*x), edges[3].max(*y)];
        }
        used[0] = (edges[2] - edges[0]) / width;
        used[1] = (edges[3] - edges[1]) / height;
        assert!(used[0].max(used[1]) > 0.72, "round {round}: only {used:?} of the picture used");
        for (low, high, whole) in [(edges[0], edges[2], width), (edges[1], edges[3], height)] {
            let off = ((low + high) / 2.0 / whole - 0.5).abs();
            assert!(off < 0.06, "round {round}: {off} off the middle");
        }
        // Up in the world is up in the picture.
        let above: [f64; 3] = std::array::from_fn(|k| points[0][k] + 0.01 * scale * up[k]);
        assert!(place(&viewpoint, size, above)[1] < places[0][1], "round {round}: upside down");
    }
}

#[test]
fn fit_looks_at_the_broad_side() {
    let size = Size::new(640, 360);
    // A flag in the plane x = 0 and one in the plane y = 0.
    for axis in [0, 1] {
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]]
            .map(|[along, z]| if axis == 0 { [0.0, along, z] } else { [along, 0.0, z] });
        let Viewpoint { eye, target, .. } = Viewpoint::fit(corners, [0.0, 0.0, 1.0], size);
        let towards: Vec<f64> = (0..3).map(|k| (eye[k] - target[k]).abs()).collect();
        assert!(towards[axis] > 1.5 * towards[1 - axis], "axis {axis}: {towards:?}");
        assert!(eye[2] > target[2], "the eye is raised");
    }
}

#[test]
fn fit_survives_poor_input() {
    let size = Size::new(64, 48);
    let nan = f64::NAN;
    let line: Vec<[f64; 3]> = (0..9).map(|i| [0.0, 0.0, f64::from(i)]).collect();
    let cases: [&[[f64; 3]]; 6] = [
        &[],
        &[[nan, 0.0, 0.0]],
        &[[5.0, 5.0, 5.0]],
        &[[1e300, 0.0, 0.0], [1.0, f64::INFINITY, 0.0], [2.0, 3.0, 4.0]],
        &line,
        &[[0.0; 3], [1e50, -1e50, 1e50]],
    ];
    for points in cases {
        for up in [[0.0, 0.0, 1.0], [0.0; 3], [nan, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1e-200, 0.0]]
        {
            let viewpoint = Viewpoint::fit(points.iter().copied(), up, size);
            assert!(Lens::new(&viewpoint, size).is_ok(), "{points:?}, up {up:?}: {viewpoint:?}");
            for point in points.iter().filter(|p| p.iter().all(|x| x.abs() < 1e60)) {
                let [x, y, _] = place(&viewpoint, size, *point);
                assert!((0.0..64.0).contains(&x) && (0.0..48.0).contains(&y), "{x} {y}");
            }
        }
    }
    // A picture without area still gives a usable viewpoint.
    let viewpoint = Viewpoint::fit(line, [0.0, 0.0, 1.0], Size::new(0, 0));
    assert!(Lens::new(&viewpoint, size).is_ok());
}

#[test]
fn bounds_hold_every_sound_point() {
    let mut bounds = Bounds::EMPTY;
    assert!(bounds.is_empty());
    assert_eq!(bounds.lowest([0.0, 0.0, 1.0]), None);
    bounds.extend([[1.0, -2.0, 3.0], [f64::NAN, -9.0, 0.0], [-1.0, 5.0, 0.5]]);
    assert_eq!(bounds, Bounds { min: [-1.0, -2.0, 0.5], max: [1.0, 5.0, 3.0] });
    assert_eq!(bounds.lowest([0.0, 0.0, 2.0]), Some(0.5));
    assert_eq!(bounds.lowest([0.0, -1.0, 0.0]), Some(-5.0));
    assert_eq!(bounds.lowest([0.0; 3]), None);
    assert_eq!(Bounds::of(bounds.corners()), bounds);
}

#[test]
fn viridis_grows_evenly_brighter() {
    let luminance = |[r, g, b]: Rgb| {
        let linear = |c: u8| (f64::from(c) / 255.0).powf(2.2);
        (0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b)).cbrt()
    };
    let values: Vec<f64> =
        (0..=100).map(|i| luminance(VIRIDIS.colour(f64::from(i) / 100.0))).collect();
    let step = (values[100] - values[0]) / 100.0;
    for pair in values.windows(2) {
        let change = pair[1] - pair[0];
        assert!((0.2..2.0).contains(&(change / step)), "step of {change} beside {step}");
    }
    assert_eq!(VIRIDIS.colour(-3.0), [68, 1, 84]);
    assert_eq!(VIRIDIS.colour(f64::INFINITY), [253, 231, 37]);
    assert_eq!(VIRIDIS.colour(f64::NAN), VIRIDIS.undefined);
    assert_eq!(VIRIDIS.colour_in(7.0, 5.0, 9.0), VIRIDIS.colour(0.5));
    assert_eq!(VIRIDIS.colour_in(7.0, 7.0, 7.0), VIRIDIS.colour(0.5));
    assert_eq!(VIRIDIS.colour_in(f64::INFINITY, 5.0, 9.0), VIRIDIS.undefined);
    let empty = ColourMap { stops: &[], undefined: [1, 2, 3] };
    assert_eq!(empty.colour(0.5), [1, 2, 3]);
}
