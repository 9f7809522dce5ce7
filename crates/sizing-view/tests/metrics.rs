//! The sizing field as the remesher sees it.

mod common;

use common::{camera, crowd, look, sheet, still, wavy};
use mesh_core::{ClothState, World3, par};
use nalgebra::{UnitQuaternion, Vector2};
use proptest::prelude::*;
use remesh::{
    CornerMetrics, Metric, PhysicalSizing, RemeshSettings, SizingContext, SizingField, Uniform,
    adapt, remesh,
};
use sizing_view::{Camera, CameraPath, Sample, ViewFactors, ViewSettings, ViewSizing, window};

fn metrics<S: SizingField>(cloth: &ClothState, field: &S) -> Vec<Metric> {
    let context = SizingContext::new(cloth, None);
    cloth.mesh.triangle_ids().map(|t| field.metric(&context, t)).collect()
}

fn seen(cloth: &ClothState, samples: &[Sample], settings: &ViewSettings) -> ViewFactors {
    ViewFactors::evaluate(cloth, samples, settings).unwrap()
}

/// Where all is visible and well resolved, nothing changes, to the bit.
#[test]
fn a_near_camera_changes_nothing() {
    let cloth = wavy(1.0, 12);
    let camera = look([0.0, 0.0, 1.5], [0.0, 0.0, 0.0], 1.2);
    let settings = ViewSettings { size_min_px: 0.5, v_back: 1.0, ..ViewSettings::default() };
    let factors = seen(&cloth, &[Sample::new(camera)], &settings);
    let field = PhysicalSizing::default();
    assert_eq!(metrics(&cloth, &ViewSizing::new(field, &factors)), metrics(&cloth, &field));
    let off = ViewSettings { size_min_px: 0.0, ..settings };
    let factors = seen(&cloth, &[Sample::new(camera)], &off);
    assert_eq!(metrics(&cloth, &ViewSizing::new(field, &factors)), metrics(&cloth, &field));
}

/// Metrics of whatever a camera does not see are v² M, until `size_max`.
#[test]
fn coarsening_is_by_the_square_of_the_factor() {
    let cloth = sheet(1.0, 4);
    let field = Uniform { size: 0.02 };
    // From behind, and looking away.
    for (target, v) in [([0.0, 0.0, 0.0], 0.2), ([0.0, 0.0, -9.0], 0.01)] {
        let samples = [Sample::new(look([0.0, 0.1, -2.0], target, 1.0))];
        for size_max in [0.03, 10.0] {
            let settings = ViewSettings { size_max, ..ViewSettings::default() };
            let size = f64::min(0.02 / v, size_max);
            for m in metrics(&cloth, &ViewSizing::new(field, &seen(&cloth, &samples, &settings))) {
                let sizes = m.eigenvalues().map(|l| 1.0 / l.sqrt());
                assert!(sizes.iter().all(|s| (s / size - 1.0).abs() < 1e-12), "{sizes:?} {size}");
            }
        }
    }
}

/// The limit of a panel counts beside `size_max`, and the field's own wish goes before both.
#[test]
fn panels_have_limits_of_their_own() {
    let cloth = sheet(1.0, 4);
    let samples = [Sample::new(look([0.0, 0.1, -2.0], [0.0, 0.0, -9.0], 1.0))];
    let factors = seen(&cloth, &samples, &ViewSettings { size_max: 0.3, ..Default::default() });
    let no_limits: &[f64] = &[];
    for (limits, field, size) in
        [(&[0.1][..], 0.02, 0.1), (&[0.9], 0.02, 0.3), (no_limits, 0.02, 0.3), (&[0.1], 0.15, 0.15)]
    {
        let field = ViewSizing::new(Uniform { size: field }, &factors).with_limits(limits);
        for m in metrics(&cloth, &field) {
            let sizes = m.eigenvalues().map(|l| 1.0 / l.sqrt());
            assert!(sizes.iter().all(|s| (s / size - 1.0).abs() < 1e-12), "{sizes:?} {size}");
        }
    }
}

/// Edges of ℓ_min pixels: on a sheet seen at right angles, and along its direction of foreshortening
/// when it is turned.
#[test]
fn visible_cloth_has_edges_of_the_pixels_asked_for() {
    let settings = ViewSettings {
        size_min_px: 10.0,
        size_max: 100.0,
        aspect_min: 0.0,
        ..ViewSettings::default()
    };
    for turn in [0.0, 0.5, 1.0, 1.4] {
        let mut cloth = sheet(0.02, 1);
        let rotation = UnitQuaternion::from_axis_angle(&World3::x_axis(), turn);
        cloth.x.iter_mut().for_each(|x| *x = rotation * *x);
        let camera = look([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], 0.5);
        let factors = seen(&cloth, &[Sample::new(camera)], &settings);
        let pixel = 4.0 / camera.focal_px();
        for m in metrics(&cloth, &ViewSizing::new(Uniform { size: 1e-3 }, &factors)) {
            let [along, across] =
                [Vector2::x(), Vector2::y()].map(|u| 1.0 / m.size_squared(u).sqrt() / pixel);
            assert!((along / 10.0 - 1.0).abs() < 0.01, "{along} px");
            assert!((across * turn.cos() / 10.0 - 1.0).abs() < 0.01, "{across} px at {turn}");
        }
    }
}

/// Faces before a camera far away and at its feet in two shots: until the cut the bound of the far
/// camera counts, with that of the near one growing, and never the sum of both.
#[test]
fn the_bound_of_the_next_shot_comes_before_the_cut() {
    let (far, near) = (look([0.0, 0.0, 50.0], [0.0; 3], 0.5), look([0.0, 0.0, 2.0], [0.0; 3], 0.5));
    let shot = |start, camera| sizing_view::Shot {
        start,
        keys: vec![sizing_view::Key { time: start, camera }],
    };
    let path = CameraPath::new(vec![shot(0.0, far), shot(1.0, near)]).unwrap();
    let settings = ViewSettings { size_max: 10.0, ..ViewSettings::default() };
    let cloth = sheet(0.1, 1);
    let size_at = |time: f64| {
        let factors = seen(&cloth, &window(&path, time, 0.04, &settings), &settings);
        let m = metrics(&cloth, &ViewSizing::new(Uniform { size: 0.001 }, &factors))[0];
        1.0 / m.eigenvalues()[0].sqrt()
    };
    let pixels = |distance: f64| 4.0 * distance / far.focal_px();
    for (frames, expected) in [
        (-9.0, pixels(50.0)),
        (-4.5, pixels(2.0) / 0.1),
        (-2.5, pixels(2.0) / 0.5),
        (0.0, pixels(2.0)),
    ] {
        let size = size_at(1.0 + 0.04 * frames);
        assert!((size / expected - 1.0).abs() < 0.01, "{size} for {expected} at {frames}");
    }
}

/// What is far from one camera and behind another is as coarse as the first allows: the factor of one
/// is not combined with the pixels of the other.
#[test]
fn cameras_are_not_mixed() {
    let cloth = sheet(0.1, 1);
    let settings = ViewSettings { size_max: 10.0, ..ViewSettings::default() };
    let far = look([0.0, 0.0, 50.0], [0.0; 3], 0.5);
    let before = look([0.0, 0.0, 1.0], [0.0, 0.0, 9.0], 0.5);
    let of = |cameras: &[Camera]| {
        let samples: Vec<Sample> = cameras.iter().map(|&c| Sample::new(c)).collect();
        metrics(
            &cloth,
            &ViewSizing::new(Uniform { size: 0.002 }, &seen(&cloth, &samples, &settings)),
        )
    };
    assert_eq!(of(&[far, before]), of(&[far]));
    assert_eq!(of(&[before, far]), of(&[far]));
}

#[test]
fn factors_of_another_mesh_are_refused() {
    let mut cloth = sheet(1.0, 4);
    let settings = ViewSettings::default();
    let factors = seen(&cloth, &[Sample::new(look([0.0, 0.0, 2.0], [0.0; 3], 1.0))], &settings);
    let edge = cloth.mesh.edges().next().unwrap();
    cloth.split(edge).unwrap();
    let field = ViewSizing::new(Uniform { size: 0.1 }, &factors);
    let report = remesh(&mut cloth, &field, &RemeshSettings::default()).unwrap();
    assert!(report.n_bad_metrics > 30);
}

/// Koh2014 Fig. 4: the mean length of edges in the picture stays the same while the distance grows.
#[test]
fn edges_keep_their_length_in_the_picture() {
    let settings = ViewSettings { size_min_px: 12.0, size_max: 1.0, ..ViewSettings::default() };
    let mut means = Vec::new();
    for distance in [2.0, 4.0, 8.0, 16.0] {
        let mut cloth = wavy(3.0, 24);
        cloth.x.iter_mut().for_each(|x| x.z *= 0.5);
        let camera = look([0.0, -0.3 * distance, 0.95 * distance], [0.0; 3], 1.6);
        for _ in 0..3 {
            let factors = seen(&cloth, &[Sample::new(camera)], &settings);
            let field = ViewSizing::new(Uniform { size: 0.002 }, &factors);
            let mut corners =
                CornerMetrics::evaluate(&cloth, &field, &RemeshSettings::default()).unwrap();
            adapt(&mut cloth, &mut corners, &RemeshSettings::default()).unwrap();
        }
        let factors = still(&cloth, camera, &settings);
        assert!(factors.iter().filter(|&&v| v == 1.0).count() * 2 > factors.len());
        let to_camera = camera.world_from_camera().inverse();
        let picture = |p: World3| {
            let c = to_camera * (p - camera.position());
            c.xy() * (camera.focal_px() / c.z)
        };
        let lengths: Vec<f64> = cloth
            .mesh
            .edges()
            .filter(|h| factors[h.triangle().index()] == 1.0)
            .map(|h| {
                [cloth.mesh.origin(h), cloth.mesh.dest(h)].map(|v| picture(cloth.x[v.index()]))
            })
            .map(|[a, b]| (a - b).norm())
            .collect();
        means.push(lengths.iter().sum::<f64>() / lengths.len() as f64);
    }
    let (low, high) = means.iter().fold((f64::INFINITY, 0.0f64), |(l, h), &m| (l.min(m), h.max(m)));
    let middle = 0.5 * (low + high);
    println!("mean edges {means:?} px");
    assert!(high / middle < 1.25 && low / middle > 0.75, "mean edges {means:?} px");
}

/// Whatever a panel's ball decides at once is what every triangle would have been told.
#[test]
fn deciding_at_once_changes_no_factor() {
    let cloth = crowd(12, 6, 2.0);
    // The same triangles as one panel, whose ball decides nothing.
    let mesh = mesh_core::Mesh::new(
        cloth.x.len(),
        cloth.mesh.triangles().to_vec(),
        cloth.mesh.material().to_vec(),
        vec![0; cloth.mesh.n_triangles()],
    );
    let one = ClothState::at_rest(mesh.unwrap(), cloth.x.clone(), vec![0.2]).unwrap();
    let settings = ViewSettings::default();
    for (from, to) in [([0.0, -3.0, 2.0], [2.0, 0.0, 0.0]), ([5.0, 1.0, 1.0], [9.0, 0.0, 0.0])] {
        let camera = look(from, to, 0.8);
        let v = still(&cloth, camera, &settings);
        assert_eq!(v, still(&one, camera, &settings));
        assert!(v.contains(&1.0) && v.contains(&0.01));
    }
}

#[test]
fn threads_change_no_bit() {
    let cloth = crowd(5, 20, 1.5);
    let settings = ViewSettings::default();
    let samples: Vec<Sample> =
        [-1.0, 0.0, 2.0].map(|x| Sample::new(look([x, -3.0, 1.0], [x, 0.0, 0.0], 0.7))).into();
    let on = |n| {
        par::with_threads(n, || {
            let factors = seen(&cloth, &samples, &settings);
            let field = ViewSizing::new(PhysicalSizing::default(), &factors);
            let corners = CornerMetrics::evaluate(&cloth, &field, &RemeshSettings::default());
            (factors.clone(), corners.unwrap())
        })
    };
    assert_eq!(on(1).unwrap(), on(3).unwrap());
}

/// Cameras that are hardly ones: with hardly a field of view or nearly all of it, on the sheet and
/// along it, inside cloth, with one pixel, with everything behind.
fn degenerate() -> impl Strategy<Value = Camera> {
    let place = prop_oneof![
        Just(World3::zeros()),
        Just(World3::new(0.25, 0.0, 0.0)),
        Just(World3::new(0.3, 0.2, 1e-12)),
        common::point(1.0),
        common::point(1e9),
    ];
    let rotation = prop_oneof![
        Just(UnitQuaternion::identity()),
        Just(UnitQuaternion::from_euler_angles(std::f64::consts::FRAC_PI_2, 0.0, 0.0)),
        Just(UnitQuaternion::from_euler_angles(0.0, std::f64::consts::FRAC_PI_2, 0.0)),
        common::rotation(),
    ];
    let focal = prop_oneof![Just(1e-300), Just(1e300), (-9.0..9.0f64).prop_map(|e| 10f64.powf(e))];
    let near = prop_oneof![Just(1e-200), Just(1e50), (-9.0..3.0f64).prop_map(|e| 10f64.powf(e))];
    let size = || prop_oneof![Just(1u32), Just(u32::MAX), 1..2000u32];
    (place, rotation, focal, near, size(), size()).prop_map(|(at, turn, focal, near, w, h)| {
        Camera::new(at, turn, focal, [w, h]).unwrap().with_near(near).unwrap()
    })
}

/// Settings from one end to the other.
fn any_settings() -> impl Strategy<Value = ViewSettings> {
    let unit = || prop_oneof![Just(0.0), Just(1.0), 0.0..1.0f64];
    let px = prop_oneof![Just(0.0), Just(4.0), Just(1e6)];
    (unit(), unit(), unit(), prop_oneof![Just(0.0), 0.0..2.0f64], px, unit()).prop_map(
        |(v_back, v_hidden, out, margin, size_min_px, silhouette)| ViewSettings {
            v_back,
            v_hidden,
            v_out: out * f64::min(v_back, v_hidden),
            margin,
            size_min_px,
            silhouette,
            ..ViewSettings::default()
        },
    )
}

proptest! {
    #[test]
    fn degenerate_cameras_give_valid_metrics(
        cameras in prop::collection::vec((degenerate(), 0.0..=1.0f64), 1..4),
        settings in any_settings(),
        flat in prop::bool::ANY,
    ) {
        let mut cloth = wavy(1.0, 5);
        if flat {
            cloth.x.iter_mut().for_each(|x| x.z = 0.0);
        } else {
            // A triangle without area and a point upon another.
            cloth.x[3] = cloth.x[4];
        }
        let samples: Vec<Sample> =
            cameras.into_iter().map(|(c, weight)| Sample { weight, ..Sample::new(c) }).collect();
        let factors = ViewFactors::evaluate(&cloth, &samples, &settings).unwrap();
        prop_assert!(factors.values().iter().all(|v| (0.0..=1.0).contains(v)));
        let field = PhysicalSizing::default();
        let wanted = metrics(&cloth, &field);
        for (m, w) in metrics(&cloth, &ViewSizing::new(field, &factors)).into_iter().zip(wanted) {
            prop_assert!(m.is_valid(), "{m:?} of {w:?}");
            // Never finer than the field.
            let [large, _] = w.eigenvalues();
            prop_assert!(m.eigenvalues()[0] <= large * (1.0 + 1e-9), "{m:?} of {w:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn degenerate_cameras_give_valid_meshes(
        camera in prop_oneof![degenerate(), camera()], settings in any_settings(),
    ) {
        let mut cloth = wavy(1.0, 8);
        let limits = RemeshSettings { max_vertices: 2000, ..RemeshSettings::default() };
        for _ in 0..3 {
            let factors = seen(&cloth, &[Sample::new(camera)], &settings);
            let field = PhysicalSizing { size_min: 0.03, ..PhysicalSizing::default() };
            let report = remesh(&mut cloth, &ViewSizing::new(field, &factors), &limits).unwrap();
            prop_assert_eq!(report.n_bad_metrics, 0);
            cloth.mesh.validate().unwrap();
        }
    }
}
