//! The scenes of contact: that they are what they say, start free of crossings, and move.

use std::path::Path;

use mesh_core::World3;
use organza::scene::{LoadOptions, Loaded, load};
use organza::world::World;

fn own(name: &str, sets: &[&str]) -> Loaded {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
    let sets = sets.iter().map(|set| (*set).to_owned()).collect();
    let options = LoadOptions { sets, allow_unsupported: false };
    let loaded = load(&path, &options).unwrap_or_else(|errors| panic!("{errors}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    loaded
}

/// The world of a scene after some frames, nothing crossing anything in any of them.
fn after(loaded: &Loaded, frames: u64) -> World {
    let mut world = World::new(loaded).unwrap_or_else(|e| panic!("{e}"));
    for frame in 1..=frames {
        world.advance().unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(world.crossings(frame), None, "{frame}");
    }
    world
}

fn middle(points: &[World3]) -> World3 {
    points.iter().sum::<World3>() / points.len() as f64
}

#[test]
fn twist_makes_ten_turns() {
    let loaded = own("twist.json5", &["cloths[0].mesh.tube.segments=[12, 20]"]);
    let ends: Vec<_> = loaded.scene.handles.iter().map(|h| h.motion.clone().unwrap()).collect();
    let [lower, upper] = &ends[..] else { panic!() };
    // Turns by hundredths of the time, each less than half a turn, add up to ten.
    let step = |k: u32| {
        let turn = |k: u32| {
            let t = 10.0 * f64::from(k) / 100.0;
            lower.at(t).isometry.rotation.inverse() * upper.at(t).isometry.rotation
        };
        (turn(k).inverse() * turn(k + 1)).angle()
    };
    let turns: f64 = (0..100).map(step).sum::<f64>() / std::f64::consts::TAU;
    assert!((turns - 10.0).abs() < 1e-9, "{turns}");

    // Both ends turn about the axis of the cylinder, and keep their radius.
    let world = after(&loaded, 12);
    for handle in world.handles.list() {
        assert_eq!(handle.held.len(), 12);
        for &(vertex, home) in &handle.held {
            let (x, home) = (world.cloth.x[vertex as usize], home.unwrap());
            assert!((x.yz().norm() - 0.08).abs() < 1e-9, "{x}");
            assert!((x.yz() - home.yz()).norm() > 0.01, "{x} {home}");
        }
    }
}

#[test]
fn pile_is_ten_sheets_that_fall() {
    let sets: Vec<String> =
        (0..10).map(|k| format!("cloths[{k}].mesh.grid.cells=[3, 3]")).collect();
    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
    let loaded = own("pile.json5", &sets);
    assert_eq!(loaded.scene.cloths.len(), 10);
    let start = World::new(&loaded).unwrap();
    // Level, six centimetres apart, and none right above another.
    let sheets: Vec<World3> = start.cloth.x.chunks(16).map(middle).collect();
    for (k, pair) in sheets.windows(2).enumerate() {
        let way = pair[1] - pair[0];
        assert!((way.z - 0.06).abs() < 1e-12 && way.xy().norm() > 0.01, "{k}: {way}");
    }
    let world = after(&loaded, 3);
    let lowest = world.cloth.x.iter().map(|x| x.z).fold(f64::INFINITY, f64::min);
    assert!(lowest > 0.0, "{lowest}");
    assert!(middle(&world.cloth.x).z < middle(&start.cloth.x).z - 0.03);
}

#[test]
fn funnel_is_drawn_through_its_ring() {
    let loaded = own("funnel.json5", &["cloths[0].mesh.grid.cells=[14, 14]"]);
    let world = after(&loaded, 14);
    let ring = &world.obstacles[0];
    assert!(!ring.is_moving());
    let hole = ring.positions(0.0).iter().map(|x| x.xy().norm()).fold(f64::INFINITY, f64::min);
    assert!((hole - 0.1).abs() < 1e-3, "{hole}");
    // What is held goes down in the middle of it.
    let [handle] = world.handles.list() else { panic!() };
    for &(vertex, _) in &handle.held {
        let x = world.cloth.x[vertex as usize];
        assert!(x.xy().norm() < 0.05 && x.z < 0.03, "{x}");
    }
    let motion = loaded.scene.handles[0].motion.as_ref().unwrap();
    assert_eq!(motion.at(4.0).isometry.translation.vector.z, -0.9);
}

#[test]
fn pinch_leaves_less_room_than_the_cloth_wants() {
    let loaded = own("pinch.json5", &["cloths[0].mesh.grid.cells=[10, 10]"]);
    let world = after(&loaded, 4);
    let thickness = world.contact.unwrap().thickness;
    let [left, right] = &world.obstacles[..] else { panic!() };
    let gap = |time: f64| {
        let most = |x: Vec<World3>| x.iter().map(|x| x.y).fold(f64::NEG_INFINITY, f64::max);
        let least = |x: Vec<World3>| x.iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
        least(right.positions(time)) - most(left.positions(time))
    };
    assert!(gap(0.0) > 0.3);
    for time in [1.2, 1.6, 2.5, 3.5, 5.0] {
        let gap = gap(time);
        assert!(gap > 1.25 * thickness && gap < 1.75 * thickness, "{time}: {gap}");
    }
    // They are what holds it when its corners are let go.
    assert!(loaded.scene.handles[0].end_s > 1.2);
}
