//! View factors in space and time: Koh2014 Eq. (3) and (4), against tables and as properties.

mod common;

use common::{camera, crowd, look, raw, reference, still, triangle, wavy};
use mesh_core::{ClothState, TriangleId, World3};
use proptest::prelude::*;
use sizing_view::{
    Camera, CameraPath, Frustum, Key, Sample, Shot, ViewFactors, ViewSettings, window,
};

/// view_factor_spatial.csv of the reference tables: distance (m), v of a front, v of a back.
const SPATIAL: [[f64; 3]; 7] = [
    [0.0, 1.0, 0.2],
    [1e-9, 0.999999997525, 0.199999999525],
    [0.1, 0.7525, 0.1525],
    [0.2, 0.505, 0.105],
    [0.399999, 0.010002475000000066, 0.010000475000000009],
    [0.4, 0.01, 0.01],
    [10.0, 0.01, 0.01],
];

/// A triangle whose nearest point to the frustum of [`beside`] is a corner at distance `d` from its
/// right side; seen from the front or the back.
fn at_distance(d: f64, front: bool) -> ClothState {
    // The right side of 90° goes through (1, 1, 0); its normal points along (1, −1, 0).
    let out = World3::new(1.0, -1.0, 0.0).normalize();
    let corner = World3::new(3.0, 3.0, 0.0) + out * d;
    let [b, c] = [World3::new(0.01, 0.0, 0.0), World3::new(0.0, 0.0, 0.01)];
    let [b, c] = if front { [corner + b, corner + c] } else { [corner + c, corner + b] };
    triangle([corner, b, c])
}

fn beside() -> Camera {
    let (eye, y, z) = (World3::zeros(), World3::y(), World3::z());
    Camera::looking_at(eye, y, z, std::f64::consts::FRAC_PI_2, [100, 100]).unwrap()
}

fn check_spatial(row: &[f64]) {
    for (front, expected) in [(true, row[1]), (false, row[2])] {
        let v = still(&at_distance(row[0], front), beside(), &raw())[0];
        assert!((v - expected).abs() < 1e-12, "{v} at {} m, not {expected}", row[0]);
    }
}

#[test]
fn falls_with_the_distance_as_the_table_says() {
    SPATIAL.iter().for_each(|row| check_spatial(row));
    for row in reference("view_factor_spatial.csv").unwrap_or_default() {
        check_spatial(&row);
    }
}

const FRAME: f64 = 0.04;

/// Looks away until `cut`, then at the origin.
fn jump(cut: f64) -> CameraPath {
    let shot = |start, camera| Shot { start, keys: vec![Key { time: start, camera }] };
    let [away, towards] =
        [[0.0, 0.0, 20.0], [0.0, 0.0, 0.0]].map(|to| look([0.0, 0.0, 5.0], to, 0.5));
    CameraPath::new(vec![shot(0.0, away), shot(cut, towards)]).unwrap()
}

fn check_cut(frames: f64, expected: f64) {
    let cut = 3.0 + 0.3 * FRAME;
    let samples = window(&jump(cut), cut + frames * FRAME, FRAME, &raw());
    let v = ViewFactors::evaluate(&wavy(0.5, 2), &samples, &raw()).unwrap().values().to_vec();
    for v in v {
        assert!((v - expected).abs() < 1e-9, "{v} at {frames} frames, not {expected}");
    }
}

/// view_factor_jump_cut.csv of the reference tables, and its closed form.
#[test]
fn rises_before_a_cut_as_the_table_says() {
    for (frames, v) in [(-8.0, 0.01), (-5.0, 0.01), (-4.5, 0.1), (-4.0, 0.2), (-0.5, 0.9)] {
        check_cut(frames, v);
    }
    for k in 0..60 {
        let frames = -6.0 + 0.1 * f64::from(k);
        check_cut(frames, (1.0 + frames / 5.0).max(0.01));
    }
    for frames in [0.0, 0.5, 3.0] {
        check_cut(frames, 1.0);
    }
    for row in reference("view_factor_jump_cut.csv").unwrap_or_default() {
        check_cut(row[0], row[1]);
    }
}

#[test]
fn the_frame_of_a_cut_shows_the_new_shot() {
    // 0.1 + 0.2 is not 0.3.
    let path = jump(0.3);
    assert_eq!(path.at(0.1 + 0.2), path.shots()[1].keys[0].camera);
    assert_eq!(path.at(0.3 - 2e-10), path.shots()[1].keys[0].camera);
    assert_eq!(path.at(0.3 - 1e-6), path.shots()[0].keys[0].camera);
    assert_eq!(path.at(-7.0), path.shots()[0].keys[0].camera);
}

/// Cloth that leaves the picture at a cut is not kept fine after it, but is until then.
#[test]
fn falls_at_once_after_a_cut() {
    let shots = jump(1.0).shots().to_vec();
    let shot = |k: usize, start| Shot { start, ..shots[k].clone() };
    let path = CameraPath::new(vec![shot(1, 0.0), shot(0, 1.0)]).unwrap();
    let at = |time| {
        let samples = window(&path, time, FRAME, &raw());
        ViewFactors::evaluate(&wavy(0.5, 2), &samples, &raw()).unwrap().values()[0]
    };
    assert_eq!([at(0.5), at(1.0 - 1e-6), at(1.0)], [1.0, 1.0, 0.01]);
}

#[test]
fn a_still_camera_is_one_sample() {
    let path = CameraPath::still(beside());
    assert_eq!(window(&path, 0.3, FRAME, &raw()).len(), 1);
    let samples = window(&jump(1.0), 1.0 - 2.5 * FRAME, FRAME, &raw());
    let weights: Vec<f64> = samples.iter().map(|s| s.weight).collect();
    assert_eq!(weights.len(), 2);
    assert!((weights[0], weights[1] - 0.5).0 == 1.0 && (weights[1] - 0.5).abs() < 1e-9);
}

/// The rule of the silhouette raises the side that is seen less to the mean, and nothing else.
#[test]
fn silhouettes_are_smoothed() {
    // A roof: one half faces the camera, one does not.
    let mut cloth = common::sheet(1.0, 2);
    for x in &mut cloth.x {
        x.z = -x.x.abs() * 3.0;
    }
    let camera = look([8.0, 0.0, 0.0], [0.0, 0.0, 0.0], 0.5);
    let plain = still(&cloth, camera, &raw());
    assert!(plain.iter().all(|&v| v == 1.0 || v == 0.2));
    let smoothed = still(&cloth, camera, &ViewSettings::default());
    let mut n = [0; 3];
    for t in cloth.mesh.triangle_ids() {
        let (old, new) = (plain[t.index()], smoothed[t.index()]);
        let across = (0..3).filter_map(|k| cloth.mesh.twin(t.half_edge(k)));
        let beside_front = across.map(|g| plain[g.triangle().index()]).any(|v| v == 1.0);
        let kind = if old == 1.0 { 0 } else { 1 + usize::from(beside_front) };
        assert_eq!(new, [1.0, 0.2, 0.6][kind]);
        n[kind] += 1;
    }
    assert_eq!(n, [4, 2, 2]);
}

#[test]
fn normals_tell_front_from_back() {
    let cloth = common::sheet(1.0, 3);
    for (z, v) in [(5.0, 1.0), (-5.0, 0.2), (1e-9, 1.0)] {
        let camera = look([3.0, 0.0, z], [0.0, 0.0, 0.0], 1.0);
        assert_eq!(still(&cloth, camera, &raw()), vec![v; 18], "from z = {z}");
    }
    // Exactly along the sheet: nothing faces away.
    let camera = look([3.0, 0.0, 0.0], [0.0, 0.0, 0.0], 1.0);
    assert_eq!(still(&cloth, camera, &raw()), vec![1.0; 18]);
}

#[test]
fn bad_settings_are_named() {
    let cloth = common::sheet(1.0, 1);
    let message = |settings: &ViewSettings, weight: f64| {
        let sample = Sample { weight, ..Sample::new(beside()) };
        ViewFactors::evaluate(&cloth, &[sample], settings).unwrap_err().to_string()
    };
    let fine = ViewSettings::default();
    assert!(message(&ViewSettings { v_back: 1.5, ..fine }, 1.0).starts_with("v_back is 1.5"));
    assert!(message(&ViewSettings { v_out: 0.3, ..fine }, 1.0).starts_with("v_out is 0.3"));
    assert!(message(&ViewSettings { margin: f64::NAN, ..fine }, 1.0).contains("margin"));
    assert!(message(&ViewSettings { window: -1.0, ..fine }, 1.0).contains("window"));
    assert!(message(&ViewSettings { size_min_px: -1.0, ..fine }, 1.0).contains("size_min_px"));
    assert!(message(&ViewSettings { size_max: 0.0, ..fine }, 1.0).contains("size_max"));
    assert!(message(&fine, 1.1).contains("weight"));
    assert!(ViewFactors::evaluate(&cloth, &[], &fine).unwrap_err().to_string().contains("camera"));
}

/// One to three shots of one to three cameras within half a second.
fn path() -> impl Strategy<Value = CameraPath> {
    let shot = prop::collection::vec((camera(), 0.01..0.2f64), 1..4);
    prop::collection::vec((shot, 0.05..0.2f64), 1..4).prop_map(|shots| {
        let mut start = 0.0;
        let shots = shots.into_iter().map(|(cameras, length)| {
            let mut time = start;
            start += length;
            let mut key = |(camera, step): (Camera, f64)| {
                time += step;
                Key { time, camera }
            };
            Shot { start: start - length, keys: cameras.into_iter().map(&mut key).collect() }
        });
        CameraPath::new(shots.collect()).unwrap()
    })
}

/// ṽ of Eq. (3) from its parts.
fn spatial(cloth: &ClothState, camera: &Camera, settings: &ViewSettings) -> Vec<f64> {
    let frustum = Frustum::new(camera);
    let one = |t: TriangleId| {
        let corners @ [a, b, c] = cloth.corners(t);
        let away = (b - a).cross(&(c - a)).dot(&(a - camera.position())) > 0.0;
        let v_fb = if away { settings.v_back } else { 1.0 };
        settings.smoothed(v_fb, frustum.distance(&corners))
    };
    cloth.mesh.triangle_ids().map(one).collect()
}

proptest! {
    /// v(t) ≥ w(τ) ṽ(t + τ) at the frames and at both sides of cuts, and v is no more than the
    /// greatest of them; what is visible now has v = 1.
    #[test]
    fn is_the_greatest_of_the_window(path in path(), time in 0.0..0.5f64, long in 0.0..8.0f64) {
        let cloth = crowd(3, 4, 1.5);
        let settings = ViewSettings { window: long, ..raw() };
        let samples = window(&path, time, FRAME, &settings);
        let factors = ViewFactors::evaluate(&cloth, &samples, &settings).unwrap();
        let now = spatial(&cloth, &path.at(time), &settings);
        let mut expected = now.clone();
        let mut see = |camera: Camera, tau: f64| {
            let seen = spatial(&cloth, &camera, &settings);
            for (most, v) in expected.iter_mut().zip(seen) {
                *most = most.max(v * (1.0 - tau / (long * FRAME)));
            }
        };
        for k in 1..8 {
            let tau = f64::from(k) * FRAME;
            if tau < long * FRAME {
                see(path.at(time + tau), tau);
            }
        }
        for k in 1..path.shots().len() {
            let cut = path.shots()[k].start;
            let tau = cut - time;
            if tau > 1e-9 && tau < long * FRAME {
                // Both sides: the path without the new shot, and with it.
                see(CameraPath::new(path.shots()[..k].to_vec()).unwrap().at(cut), tau);
                see(path.at(cut), tau);
            }
        }
        for t in 0..now.len() {
            let v = factors.values()[t];
            prop_assert!(v >= now[t], "{v} below {} of now", now[t]);
            prop_assert!((v - expected[t]).abs() < 1e-6, "{v}, not {}", expected[t]);
            if now[t] == 1.0 {
                prop_assert!(v == 1.0);
            }
        }
    }

    /// Of several cameras the finest wins, and smoothing silhouettes coarsens nothing.
    #[test]
    fn several_cameras(one in camera(), other in camera()) {
        let cloth = crowd(3, 4, 1.5);
        let samples = [one, other].map(Sample::new);
        let evaluate = |samples: &[Sample], settings: &ViewSettings| {
            ViewFactors::evaluate(&cloth, samples, settings).unwrap().values().to_vec()
        };
        let both = evaluate(&samples, &raw());
        let each = [0, 1].map(|k| evaluate(&samples[k..=k], &raw()));
        let smoothed = evaluate(&samples, &ViewSettings::default());
        for t in 0..both.len() {
            prop_assert_eq!(both[t], each[0][t].max(each[1][t]));
            prop_assert!(smoothed[t] >= both[t] && smoothed[t] <= 1.0);
        }
    }
}
