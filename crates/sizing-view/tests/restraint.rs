//! Restraint by view: nothing that shows moves less than it should, and nothing wakes late.

mod common;

use arps::{Law, Particle, Restraint};
use mesh_core::World3;
use proptest::prelude::*;
use sizing_view::{
    Camera, CameraPath, DepthBuffer, Key, PixelThresholds, Sample, Shot, ViewRestraint,
    ViewSettings, pixel_speeds, window,
};

const FRAME: f64 = 0.04;

fn camera(from: World3, to: World3) -> Camera {
    Camera::looking_at(from, to, World3::z(), 0.7, [640, 480]).unwrap()
}

fn point(size: f64) -> impl Strategy<Value = World3> {
    [-size..size, -size..size, -size..size].prop_map(|[x, y, z]| World3::new(x, y, z))
}

/// Camera space coordinates of a point in the picture; none outside.
fn seen(camera: &Camera, x: &World3) -> Option<World3> {
    let c = camera.world_from_camera().inverse() * (x - camera.position());
    let [w, h] = camera.resolution().map(f64::from);
    let inside = |p: f64, side: f64| camera.focal_px() * p.abs() <= 0.5 * side * c.z;
    (c.z >= camera.near() && inside(c.x, w) && inside(c.y, h)).then_some(c)
}

fn pixel(camera: &Camera, x: &World3) -> World3 {
    let c = camera.world_from_camera().inverse() * (x - camera.position());
    World3::new(c.x / c.z, c.y / c.z, 0.0) * camera.focal_px()
}

/// Two shots with a cut between them at 1 s.
fn cut(a: Camera, b: Camera) -> CameraPath {
    let shot = |start, camera| Shot { start, keys: vec![Key { time: start, camera }] };
    CameraPath::new(vec![shot(0.0, a), shot(1.0, b)]).unwrap()
}

proptest! {
    /// What any camera of the window sees has a threshold at least as strict as at the depth at which
    /// it is seen, whatever the weight of the sample.
    #[test]
    fn what_shows_in_the_window_is_judged_at_its_depth(
        eyes in [point(3.0), point(3.0)],
        x in proptest::collection::vec(point(3.0), 1..40),
        before in 0.0..12.0f64,
    ) {
        prop_assume!(eyes.iter().all(|eye| eye.norm() > 0.1));
        let path = cut(camera(eyes[0], World3::zeros()), camera(eyes[1], World3::zeros()));
        let settings = ViewSettings::default();
        let samples = window(&path, 1.0 - before * FRAME, FRAME, &settings);
        let speeds = pixel_speeds(&x, &samples, FRAME, &settings).unwrap();
        for (x, speed) in x.iter().zip(&speeds) {
            for sample in &samples {
                if let Some(c) = seen(&sample.camera, x) {
                    let at_depth = c.z / (sample.camera.focal_px() * FRAME);
                    prop_assert!(*speed <= at_depth * (1.0 + 1e-12), "{speed} {at_depth}");
                }
            }
        }
    }

    /// At the speed of a pixel per frame nothing in the picture moves by more, whatever its direction,
    /// and it does in one.
    #[test]
    fn a_pixel_per_frame_is_one(
        eye in point(3.0), x in point(1.0), way in point(1.0),
    ) {
        prop_assume!(eye.norm() > 2.0 && way.norm() > 0.1);
        let camera = camera(eye, World3::zeros());
        let Some(c) = seen(&camera, &x) else { return Ok(()) };
        let samples = [Sample::new(camera)];
        let speed = pixel_speeds(&[x], &samples, FRAME, &ViewSettings::default()).unwrap()[0];
        let most = |way: World3| {
            let small = 1e-4;
            let moved = x + way.normalize() * (speed * FRAME * small);
            (pixel(&camera, &moved) - pixel(&camera, &x)).norm() / small
        };
        prop_assert!(most(way) <= 1.0 + 1e-3);
        // Away from the middle of the picture, across the line of sight.
        let radial = World3::new(c.x, c.y, 0.0);
        prop_assume!(radial.norm() > 1e-2);
        let outwards = radial.normalize() * c.z - World3::z() * radial.norm();
        let share = most(camera.world_from_camera() * outwards);
        prop_assert!((share - 1.0).abs() < 1e-3, "{share}");
    }
}

#[test]
fn nothing_wakes_late_at_a_cut() {
    let (x, y) = (World3::x(), World3::y());
    // The second shot shows what is far outside of the first.
    let path = cut(camera(-y * 3.0, World3::zeros()), camera(x * 20.0 - y * 3.0, x * 20.0));
    let settings = ViewSettings::default();
    let speed = |time: f64| {
        let samples = window(&path, time, FRAME, &settings);
        pixel_speeds(&[x * 20.0], &samples, FRAME, &settings).unwrap()[0]
    };
    let shown = speed(1.0);
    // Five frames before the cut it is as if it were seen; before that, nobody looks.
    assert!(speed(1.0 - 4.9 * FRAME) <= shown);
    assert!(speed(1.0 - 5.1 * FRAME) > 100.0 * shown);
}

#[test]
fn off_screen_and_hidden_particles_rest_sooner() {
    let settings = ViewSettings::default();
    let camera = camera(-World3::y() * 3.0, World3::zeros());
    let mut depth = DepthBuffer::new(&camera, 180, 0.02).unwrap();
    // A wall a metre before the camera, over the left half of the picture.
    let corner = |x: f64, z: f64| World3::new(x, -2.0, z);
    depth.draw(&[corner(-9.0, -9.0), corner(0.0, -9.0), corner(0.0, 9.0)]);
    depth.draw(&[corner(-9.0, -9.0), corner(0.0, 9.0), corner(-9.0, 9.0)]);
    let samples = [Sample { depth: Some(depth), ..Sample::new(camera) }];
    let at = |x: f64| World3::new(x, 0.0, 0.0);
    let nan = World3::new(f64::NAN, 0.0, 0.0);
    let x = [at(0.5), at(-0.5), at(2.0), at(5.0), World3::y() * -9.0, nan];
    let speeds = pixel_speeds(&x, &samples, FRAME, &settings).unwrap();
    assert!((speeds[1] / speeds[0] - 1.0 / settings.v_hidden).abs() < 1e-9, "{speeds:?}");
    assert!(speeds[3] > speeds[2] && speeds[2] > 10.0 * speeds[0]);
    assert!(speeds[4] > 10.0 * speeds[0]);
    assert_eq!(speeds[5], 0.0);

    let thresholds = PixelThresholds::new(Law::Ramp, 0.1, 0.5, 0.05).unwrap();
    let policy = ViewRestraint { thresholds, pixel_speeds: speeds.clone() };
    let held = |index| policy.at(&Particle { index, mass: 2.0, x: World3::zeros(), time: 0.0 });
    assert!((held(0).p_r() / (2.0 * 0.1 * speeds[0]) - 1.0).abs() < 1e-12);
    // Not above what was set, and beyond the list, or where nothing is known, not at all.
    assert!((held(3).p_r() - 2.0 * 0.05).abs() < 1e-12);
    assert!((held(3).p_f() / held(3).p_r() - 5.0).abs() < 1e-9);
    assert!(held(5).is_free() && held(99).is_free());
}

#[test]
fn what_cannot_be_judged_is_refused() {
    let settings = ViewSettings::default();
    let samples = [Sample::new(camera(World3::x(), World3::zeros()))];
    assert!(pixel_speeds(&[], &[], FRAME, &settings).is_err());
    for frame in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(pixel_speeds(&[], &samples, frame, &settings).is_err());
    }
    for (rest, full, most) in [(1.0, 0.5, 1.0), (-1.0, 1.0, 1.0), (0.1, 0.5, f64::NAN)] {
        assert!(PixelThresholds::new(Law::Ramp, rest, full, most).is_err());
    }
}
