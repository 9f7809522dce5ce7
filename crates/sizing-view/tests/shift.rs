//! How far edits may move what shows.

mod common;

use common::{camera, look, point, sheet, wavy};
use mesh_core::{ClothState, World3};
use nalgebra::Matrix3;
use proptest::prelude::*;
use sizing_view::{Camera, DepthBuffer, Frustum, Sample, ViewSettings, shift_metrics};

/// Where a point is in the picture (px).
fn picture(camera: &Camera, x: World3) -> nalgebra::Vector2<f64> {
    let c = Frustum::new(camera).camera_space(x);
    c.xy() * (camera.focal_px() / c.z)
}

fn metrics(cloth: &ClothState, camera: Camera, settings: &ViewSettings) -> Vec<Matrix3<f64>> {
    shift_metrics(cloth, &[Sample::new(camera)], settings)
}

const OVER: [f64; 3] = [0.3, -0.4, 2.0];

/// The square root of dᵀ N d is the way in the picture over the limit.
#[test]
fn the_metric_is_the_square_of_the_way_in_the_picture() {
    let (cloth, camera) = (wavy(1.0, 6), look(OVER, [0.0; 3], 1.0));
    for limit in [0.5, 1.0, 3.0] {
        let settings = ViewSettings { shift_max_px: limit, ..ViewSettings::default() };
        for (x, metric) in cloth.x.iter().zip(metrics(&cloth, camera, &settings)) {
            for d in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.6, -0.3, 0.7]] {
                let d = World3::from(d) * 1e-6;
                let way = (picture(&camera, x + d) - picture(&camera, x - d)).norm() / 2.0;
                let got = d.dot(&(metric * d)).sqrt();
                let expected = way / limit;
                // Along the line of sight nothing is left but rounding.
                assert!((got - expected).abs() < 1e-6 * expected + 1e-10, "{got} {expected}");
            }
            let sight = x - World3::from(OVER);
            // Entries that cancel are rounded.
            assert!(sight.dot(&(metric * sight)) < 1e-14 * metric.trace() * sight.norm_squared());
        }
    }
}

#[test]
fn only_what_shows_now_is_limited() {
    let (cloth, above) = (sheet(1.0, 4), look(OVER, [0.0; 3], 1.0));
    let fine = ViewSettings::default();
    let limited = |samples: &[Sample], settings: &ViewSettings| {
        let metrics = shift_metrics(&cloth, samples, settings);
        metrics.iter().filter(|m| **m != Matrix3::zeros()).count()
    };
    let all = cloth.x.len();
    assert_eq!(limited(&[Sample::new(above)], &fine), all);
    // From below, in the past or future, behind something, beside the picture: none.
    let below = Sample::new(look([0.3, -0.4, -2.0], [0.0; 3], 1.0));
    assert_eq!(limited(std::slice::from_ref(&below), &fine), 0);
    assert_eq!(limited(&[below], &ViewSettings { v_back: 1.0, ..fine }), all);
    assert_eq!(limited(&[Sample { weight: 0.8, ..Sample::new(above) }], &fine), 0);
    let mut depth = DepthBuffer::new(&above, 100, 0.02).unwrap();
    let wall = [[-1.0, -1.0, 1.0], [1.5, -1.0, 1.0], [0.2, 1.5, 1.0]];
    depth.draw(&wall.map(World3::from));
    assert_eq!(limited(&[Sample { depth: Some(depth), ..Sample::new(above) }], &fine), 0);
    assert_eq!(limited(&[Sample::new(look(OVER, [5.0, 0.0, 0.0], 0.5))], &fine), 0);
    // A part: the picture ends over the sheet, and triangles across its edge count.
    let part = limited(&[Sample::new(look([0.5, 0.5, 2.0], [0.5, 0.501, 0.0], 0.1))], &fine);
    assert!((3..8).contains(&part), "{part}");
    // Two cameras limit together.
    let side = look([-1.0, 0.0, 1.5], [0.0; 3], 1.0);
    let [one, other] = [above, side].map(|camera| metrics(&cloth, camera, &fine));
    let both = shift_metrics(&cloth, &[above, side].map(Sample::new), &fine);
    for ((one, other), both) in one.iter().zip(&other).zip(&both) {
        assert!((one + other - both).norm() <= 1e-12 * both.norm());
    }
    // Without a limit nothing is worked out.
    let off = ViewSettings { shift_max_px: 0.0, ..fine };
    assert!(metrics(&cloth, above, &off).is_empty());
    let text = ViewSettings { shift_max_px: f64::NAN, ..fine }.check().unwrap_err().to_string();
    assert!(text.contains("shift_max_px"), "{text}");
}

proptest! {
    /// Whatever the camera, the metrics are finite and not negative.
    #[test]
    fn metrics_are_valid_for_all_cameras(camera in camera(), d in point(1.0)) {
        for metric in metrics(&wavy(1.0, 4), camera, &ViewSettings::default()) {
            prop_assert!(metric.iter().all(|x| x.is_finite()));
            prop_assert!(d.dot(&(metric * d)) >= -1e-12 * metric.trace());
        }
    }
}
