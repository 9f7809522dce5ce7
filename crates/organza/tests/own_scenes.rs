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

/// Coarse garments that stay as they are, so that the first frames of the scenes with characters cost
/// little.
fn coarse(cloths: &[&str]) -> Vec<String> {
    let coarse = |cloth: &&str| {
        [format!("{cloth}.mesh.garment.cell_m=0.06"), format!("{cloth}.remeshing.size_m.min=0.05")]
    };
    cloths.iter().flat_map(coarse).collect()
}

fn own_coarse(name: &str, cloths: &[&str], sets: &[&str]) -> Loaded {
    let all = coarse(cloths);
    let all: Vec<&str> = all.iter().map(String::as_str).chain(sets.iter().copied()).collect();
    own(name, &all)
}

#[test]
fn dancers_and_karate_start_dressed_and_stay_so() {
    for (name, cloths, panels) in [
        ("dancer.json5", &["cloths[0]"][..], 4),
        ("jump-cut.json5", &["cloths[0]"], 4),
        ("distance.json5", &["cloths[0]"], 4),
        ("karate.json5", &["cloths[0]", "cloths[1]"], 10),
    ] {
        let sets = ["cloths[0].remeshing.size_m.max=0.1", "view.size_min_px=0"];
        let loaded = own_coarse(name, cloths, &sets);
        assert_eq!(World::new(&loaded).unwrap().crossings(0), None, "{name}");
        let world = after(&loaded, 3);
        assert_eq!(world.cloth.densities().len(), panels, "{name}");
        let [body] = &world.obstacles[..] else { panic!("{name}") };
        assert!(body.is_moving());
        // It is worn: around the body between knees and shoulders.
        let middle = middle(&world.cloth.x);
        assert!(middle.xy().norm() < 0.1 && (0.6..1.3).contains(&middle.z), "{name}: {middle}");
        assert!(loaded.scene.view.is_some());
    }
}

#[test]
fn cuts_are_where_the_scenes_say() {
    let cuts = |name: &str| own(name, &[]).scene.camera_path.unwrap().shots().len() - 1;
    assert_eq!([cuts("karate.json5"), cuts("jump-cut.json5"), cuts("dancer.json5")], [3, 1, 0]);
    // Eight times the distance.
    let path = own("distance.json5", &[]).scene.camera_path.unwrap();
    let far = |time: f64| path.at(time).position().xy().norm();
    assert!((far(6.0) / far(0.0) - 8.0).abs() < 1e-9);
}

#[test]
fn groups_have_as_many_as_wanted() {
    let dancers = own("dancers.json5", &[]);
    assert_eq!((dancers.scene.cloths.len(), dancers.scene.obstacles.len()), (10, 10));
    let crowd = own("crowd.json5", &["crowd.count=7"]);
    assert_eq!((crowd.scene.cloths.len(), crowd.scene.obstacles.len()), (7, 7));
    let cloths = ["crowd.cloths[0]", "crowd.cloths[1]", "crowd.cloths[2]"];
    let world = after(&own_coarse("crowd.json5", &cloths, &["crowd.count=3"]), 2);
    assert_eq!(world.garments.len(), 3);
}

#[test]
fn dancers_begin_to_dance_without_being_caught() {
    // Solved by a few iterations, which is where contacts used to be passed.
    let loaded = own_coarse("dancers.json5", &["crowd.cloths[0]"], &["crowd.count=4"]);
    let mut world = World::new(&loaded).unwrap();
    let mut n_bent = 0;
    for frame in 1..=24 {
        let report = world.advance().unwrap();
        assert_eq!((report.yielded, report.crossings), (0, Some(0)), "{frame}");
        n_bent += report.shortened_ways;
    }
    assert!(n_bent < 100, "{n_bent}");
}
