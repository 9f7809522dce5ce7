//! Transforms and keyframed motions, and the project's own fabrics.

use nalgebra::{Point3, Similarity3};
use organza::fabric::{Fabric, OrthotropicFabric, preset};
use organza::scene::format::FabricChoice;
use organza::scene::motion::{AxisAngle, Interpolation, Keyframe, Motion, Transform, Turning};
use organza::scene::{LoadOptions, from_sources, parse};

fn turned(degrees: f64) -> Transform {
    Transform { rotate: Some(AxisAngle { axis: [0.0, 0.0, 2.0], degrees }), ..Transform::default() }
}

fn moved(x: f64) -> Transform {
    Transform { translate: [x, 0.0, 0.0], ..Transform::default() }
}

fn motion(interpolation: Interpolation, keys: &[(f64, Transform)]) -> Motion {
    let keyframes = keys.iter().map(|&(time_s, transform)| Keyframe::new(time_s, transform));
    Motion { interpolation, turning: Turning::AxisAngle, keyframes: keyframes.collect() }
}

/// Where a point off all axes goes.
fn image(map: Similarity3<f64>) -> Point3<f64> {
    map * Point3::new(1.0, 2.0, 3.0)
}

#[test]
fn transforms_scale_then_rotate_then_translate() {
    let transform = Transform { scale: 2.0, translate: [10.0, 0.0, 0.0], ..turned(90.0) };
    // (1, 2, 3) → (2, 4, 6) → (−4, 2, 6) → (6, 2, 6)
    assert!((image(transform.similarity()) - Point3::new(6.0, 2.0, 6.0)).norm() < 1e-14);
    assert_eq!(image(Transform::default().similarity()), Point3::new(1.0, 2.0, 3.0));
}

#[test]
fn motions_meet_their_keyframes_and_rest_outside() {
    for interpolation in [Interpolation::Linear, Interpolation::Smooth] {
        let keys = [(1.0, moved(0.0)), (2.0, turned(70.0)), (4.0, moved(-3.0))];
        let motion = motion(interpolation, &keys);
        for (time_s, transform) in keys {
            let gap = image(motion.at(time_s)) - image(transform.similarity());
            assert!(gap.norm() < 1e-14, "{interpolation:?} at {time_s}: {gap}");
        }
        assert_eq!(motion.at(-5.0), motion.at(1.0));
        assert_eq!(motion.at(50.0), motion.at(4.0));
        // Continuous at keyframes from both sides.
        for (time_s, _) in keys {
            let gap = image(motion.at(time_s - 1e-9)) - image(motion.at(time_s + 1e-9));
            assert!(gap.norm() < 1e-7);
        }
    }
}

#[test]
fn linear_motion_has_constant_speed_over_any_number_of_turns() {
    let motion = motion(Interpolation::Linear, &[(0.0, turned(0.0)), (2.0, turned(720.0))]);
    for (t, degrees) in [(0.25, 90.0), (0.5, 180.0), (1.25, 450.0), (1.75, 630.0)] {
        let gap = image(motion.at(t)) - image(turned(degrees).similarity());
        assert!(gap.norm() < 1e-13, "{t}: {gap}");
    }
}

#[test]
fn smooth_motion_has_no_jump_of_speed_and_rests_at_its_ends() {
    let keys = [(0.0, moved(0.0)), (1.0, moved(2.0)), (3.0, moved(3.0)), (4.0, moved(-1.0))];
    let motion = motion(Interpolation::Smooth, &keys);
    let h = 1e-6;
    let speed = |a: f64, b: f64| (image(motion.at(b)).x - image(motion.at(a)).x) / (b - a);
    for t in [0.0, 1.0, 3.0, 4.0] {
        let (before, after) = (speed(t - h, t), speed(t, t + h));
        assert!((before - after).abs() < 1e-4, "{t}: {before} {after}");
    }
    assert!(speed(0.0, h).abs() < 1e-4);
    // At a keyframe between others, the slope between its neighbours: (3 − 0) / 3.
    assert!((speed(1.0 - h, 1.0 + h) - 1.0).abs() < 1e-4);
}

/// About x, then about y: the axes differ from keyframe to keyframe.
fn tumbling(turning: Turning) -> Motion {
    let about = |axis, degrees| Transform {
        rotate: Some(AxisAngle { axis, degrees }),
        ..Transform::default()
    };
    let keys = [
        (0.0, Transform::default()),
        (1.0, about([1.0, 0.0, 0.0], 100.0)),
        (3.0, about([0.0, 1.0, 0.0], 250.0)),
        (4.0, about([0.0, 0.0, 1.0], -170.0)),
    ];
    Motion { turning, ..motion(Interpolation::Smooth, &keys) }
}

#[test]
fn shortest_rotations_meet_their_keyframes_without_a_jump_of_speed() {
    let motion = tumbling(Turning::Shortest);
    let h = 1e-6;
    let speed = |a: f64, b: f64| (image(motion.at(b)) - image(motion.at(a))) / (b - a);
    for key in &motion.keyframes {
        let t = key.time_s;
        assert!((image(motion.at(t)) - image(key.transform.similarity())).norm() < 1e-14);
        let jump = speed(t - h, t) - speed(t, t + h);
        assert!(jump.norm() < 1e-3, "{t}: {jump}");
    }
    assert_eq!(motion.at(-1.0), motion.at(0.0));
    assert_eq!(motion.at(9.0), motion.at(4.0));
    assert!(speed(0.0, h).norm() < 1e-4);
}

#[test]
fn rotations_go_the_shorter_way_or_as_many_turns_as_written() {
    let half = |turning, degrees| {
        let keys = [(0.0, turned(0.0)), (2.0, turned(degrees))];
        let motion = Motion { turning, ..motion(Interpolation::Smooth, &keys) };
        motion.at(1.0)
    };
    for (degrees, shorter) in [(90.0, 45.0), (300.0, -30.0), (-200.0, 80.0), (710.0, -5.0)] {
        for (turning, middle) in [(Turning::Shortest, shorter), (Turning::AxisAngle, 0.5 * degrees)]
        {
            let gap = image(half(turning, degrees)) - image(turned(middle).similarity());
            assert!(gap.norm() < 1e-13, "{turning:?} {degrees}: {gap}");
        }
    }
}

#[test]
fn scale_changes_smoothly_too() {
    let sized = |scale| Transform { scale, ..Transform::default() };
    let motion = motion(Interpolation::Smooth, &[(0.0, sized(1.0)), (1.0, sized(3.0))]);
    assert_eq!(motion.at(0.5).scaling(), 2.0);
    assert!(motion.is_moving());
    let still = Motion { keyframes: vec![motion.keyframes[0]; 1], ..motion };
    assert!(!still.is_moving());
}

#[test]
fn a_handle_moves_its_points_relative_to_where_it_took_hold() {
    let keys = [(0.0, moved(5.0)), (1.0, moved(7.0))];
    let motion = motion(Interpolation::Linear, &keys);
    let relative = motion.at(0.75) * motion.at(0.5).inverse();
    assert!((image(relative) - Point3::new(1.5, 2.0, 3.0)).norm() < 1e-14);
}

const NAMED: [(FabricChoice, &str); 7] = [
    (FabricChoice::WovenLight, "woven-light"),
    (FabricChoice::WovenFirm, "woven-firm"),
    (FabricChoice::Denim, "denim"),
    (FabricChoice::KnitLight, "knit-light"),
    (FabricChoice::KnitInterlock, "knit-interlock"),
    (FabricChoice::KnitHeavy, "knit-heavy"),
    (FabricChoice::Swim, "swim"),
];

#[test]
fn named_fabrics_are_stable_and_within_the_measured_ranges() {
    for (choice, name) in NAMED {
        let fabric: OrthotropicFabric = preset(&choice).unwrap();
        let (c, b) = (fabric.stretching_n_per_m, fabric.bending_n_m);
        assert!(c.warp * c.weft > 2.0 * c.coupling.powi(2), "{name}: nearly indefinite");
        // The extremes over the fabrics of Wang2011.
        assert!((0.1..0.33).contains(&fabric.density_kg_per_m2), "{name}");
        for stiffness in [c.warp, c.weft] {
            assert!((40.0..2200.0).contains(&stiffness), "{name}: {stiffness}");
        }
        assert!((15.0..130.0).contains(&c.shear), "{name}");
        for stiffness in [b.warp, b.weft, b.bias] {
            assert!((7e-6..3e-4).contains(&stiffness), "{name}: {stiffness}");
        }

        let text = format!(
            "{{frames: 1, cloths: [{{mesh: {{disc: {{radius_m: 1, rings: 2}}}}, fabric: '{name}'}}]}}"
        );
        let loaded = parse(text, "s", &LoadOptions::default(), &from_sources(&[])).unwrap();
        assert_eq!(loaded.scene.cloths[0].fabric, Fabric::Orthotropic(fabric));
    }
}
