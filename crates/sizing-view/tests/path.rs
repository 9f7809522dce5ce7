//! Camera paths: interpolation, order of times, prediction.

mod common;

use common::{camera, crowd, look};
use mesh_core::World3;
use nalgebra::UnitQuaternion;
use proptest::prelude::*;
use sizing_view::{Camera, CameraPath, Key, Shot, ViewError, ViewFactors, ViewSettings, window};

fn path(keys: Vec<Key>) -> CameraPath {
    CameraPath::new(vec![Shot { start: 0.0, keys }]).unwrap()
}

#[test]
fn between_keys_all_goes_at_constant_rate() {
    let rotation = |angle| UnitQuaternion::from_axis_angle(&World3::z_axis(), angle);
    let camera =
        |x, angle, focal, size| Camera::new(World3::x() * x, rotation(angle), focal, size).unwrap();
    let path = path(vec![
        Key { time: 1.0, camera: camera(0.0, 0.0, 100.0, [100, 100]) },
        Key { time: 3.0, camera: camera(4.0, 1.0, 600.0, [200, 200]) },
    ]);
    let quarter = path.at(1.5);
    assert!((quarter.position() - World3::x()).norm() < 1e-15);
    assert!(quarter.world_from_camera().angle_to(&rotation(0.25)) < 1e-15);
    // From one picture height to three.
    assert!((quarter.focal_px() - 150.0).abs() < 1e-12);
    assert_eq!(quarter.resolution(), [100, 100]);
    assert_eq!(path.at(3.0).resolution(), [200, 200]);
    assert_eq!([path.at(0.0), path.at(9.0)], [path.at(1.0), path.at(3.0)]);
}

#[test]
fn times_must_increase() {
    let camera = look([0.0; 3], [1.0; 3], 1.0);
    let shot = |start: f64, times: &[f64]| Shot {
        start,
        keys: times.iter().map(|&time| Key { time, camera }).collect(),
    };
    let error = |shots| CameraPath::new(shots).unwrap_err();
    assert_eq!(error(vec![]), ViewError::Empty { shot: 0 });
    assert_eq!(error(vec![shot(0.0, &[0.0]), shot(1.0, &[])]), ViewError::Empty { shot: 1 });
    let order = ViewError::Order { shot: 1, previous: 2.0, time: 2.0 };
    assert_eq!(error(vec![shot(0.0, &[0.0]), shot(1.0, &[2.0, 2.0])]), order);
    assert_eq!(error(vec![shot(2.0, &[0.0]), shot(2.0, &[2.0])]), order);
    assert!(error(vec![shot(f64::NAN, &[0.0])]).to_string().contains("finite"));
}

/// A camera on a circle, looking along it.
fn riding(time: f64) -> Key {
    let (s, c) = time.sin_cos();
    let at = World3::new(c, s, 0.0) * 3.0;
    let camera = Camera::looking_at(at, at + World3::new(-s, c, 0.0), World3::z(), 1.0, [64, 48]);
    Key { time, camera: camera.unwrap() }
}

#[test]
fn a_guess_goes_on_as_before() {
    let (before, now) = (riding(0.9), riding(0.94));
    let path = CameraPath::predicted(before, now, 0.2).unwrap();
    assert_eq!(path.at(0.94), now.camera);
    for (time, share) in [(0.98, 1.0), (1.0, 1.5), (1.14, 5.0)] {
        let guess = path.at(time);
        let along = now.camera.position() - before.camera.position();
        assert!((guess.position() - now.camera.position() - along * share).norm() < 1e-12);
        // Turning at constant rate is what the camera really does.
        let turned = riding(time).camera.world_from_camera();
        assert!(guess.world_from_camera().angle_to(&turned) < 1e-7);
        assert_eq!(guess.focal_px(), now.camera.focal_px());
    }
    // The error of the place grows with the square of the time: a² / 2 · radius.
    let miss = (path.at(1.14).position() - riding(1.14).camera.position()).norm();
    assert!(miss < 0.2 * 0.24 / 2.0 * 3.0 * 1.05 && miss > 0.01, "{miss}");
    assert!(CameraPath::predicted(now, before, 0.2).is_err());
    assert!(CameraPath::predicted(before, now, f64::NAN).is_err());
    assert!(CameraPath::predicted(before, now, 1e6).is_err());
}

/// Over a path with an even ride, a stop and a cut, the cameras to come are foreseen while it is even,
/// late where it changes, and not at all before the cut.
#[test]
fn a_path_is_foreseen_from_its_past() {
    let key = |time: f64, x: f64| Key { time, camera: look([x, -4.0, 1.0], [x, 0.0, 1.0], 0.8) };
    let path = CameraPath::new(vec![
        Shot { start: 0.0, keys: vec![key(0.0, 0.0), key(1.0, 4.0)] },
        Shot { start: 2.0, keys: vec![key(2.0, -6.0)] },
    ])
    .unwrap();
    let miss = |time: f64| {
        let foreseen = path.foreseen(time, 0.04, 5.0).unwrap();
        (foreseen.at(time + 0.16).position() - path.at(time + 0.16).position()).norm()
    };
    assert!(miss(0.4) < 1e-12);
    assert!((miss(0.96) - 0.12 * 4.0).abs() < 1e-9, "it goes on where the camera stops");
    assert!(miss(1.2) < 1e-12);
    assert!(miss(1.96) > 9.0, "nobody foresees a cut");
    assert!(miss(2.0) < 1e-12, "after a cut the camera is taken to stay");
}

/// Cloth that comes into the picture: how much of it a guess would have kept too coarse.
#[test]
fn what_comes_into_the_picture_is_foreseen() {
    let cloth = crowd(8, 12, 1.1);
    let settings = ViewSettings::default();
    let frame = 0.04;
    let ride = |speed: &dyn Fn(f64) -> f64| {
        let mut x = -3.0;
        let keys = (0..=75).map(|k| {
            let time = f64::from(k) * frame;
            x += speed(time) * frame;
            let camera = look([x, -4.0, 3.0], [x, 0.0, 0.0], 0.6);
            Key { time, camera }
        });
        path(keys.collect())
    };
    let missed = |path: &CameraPath| {
        let (mut late, mut all) = (0usize, 0usize);
        for k in 1..70 {
            let time = f64::from(k) * frame;
            let factors = |path: &CameraPath| {
                let samples = window(path, time, frame, &settings);
                ViewFactors::evaluate(&cloth, &samples, &settings).unwrap()
            };
            let guess = path.foreseen(time, frame, settings.window).unwrap();
            let (known, guessed) = (factors(path), factors(&guess));
            for (known, guessed) in known.values().iter().zip(guessed.values()) {
                all += usize::from(*known > 0.5);
                late += usize::from(*known > 0.5 && *guessed < 0.9 * known);
            }
        }
        late as f64 / all as f64
    };
    let even = missed(&ride(&|_| 2.0));
    let uneven = missed(&ride(&|time| 2.0 + 6.0 * (15.0 * time).sin()));
    println!("missed by the predicted camera: even {even:.4} of the triangles, uneven {uneven:.4}");
    assert!(even < 1e-3, "{even}");
    // At 9 g.
    assert!(uneven > 0.0 && uneven < 0.1, "{uneven}");
}

/// Also faster than half a turn over the horizon.
#[test]
fn a_guess_can_go_around() {
    let turn = |angle: f64| {
        let rotation = UnitQuaternion::from_axis_angle(&World3::y_axis(), angle);
        Camera::new(World3::zeros(), rotation, 100.0, [10, 10]).unwrap()
    };
    let key = |time, angle| Key { time, camera: turn(angle) };
    let path = CameraPath::predicted(key(0.0, 0.0), key(0.1, 2.0), 0.5).unwrap();
    for k in 1..=5 {
        let (time, angle) = (0.1 + 0.1 * f64::from(k), 2.0 + 2.0 * f64::from(k));
        let error = path.at(time).world_from_camera().angle_to(&turn(angle).world_from_camera());
        assert!(error < 1e-7, "{error} at {time} s");
    }
}

proptest! {
    #[test]
    fn cameras_between_are_cameras(a in camera(), b in camera(), share in 0.0..1.0f64) {
        let path = path(vec![Key { time: 0.0, camera: a }, Key { time: 1.0, camera: b }]);
        let c = path.at(share);
        let rotation = c.world_from_camera();
        prop_assert!((rotation.norm() - 1.0).abs() < 1e-9);
        let made = Camera::new(c.position(), rotation, c.focal_px(), c.resolution()).unwrap();
        prop_assert_eq!(made.with_near(c.near()).unwrap(), c);
    }
}
