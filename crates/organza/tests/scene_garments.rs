//! Garments of a scene: their meshes, and what handles find on them.

use std::collections::BTreeSet;

use mesh_core::generate::boundary_loops;
use organza::scene::{self, LoadOptions};
use organza::world::World;

fn world(mesh: &str, select: &str) -> Result<World, String> {
    let text = format!(
        "{{frames: 1, substeps: 1, cloths: [{{mesh: {mesh}, fabric: 'denim'}}],\n\
         handles: [{{select: {select}}}]}}"
    );
    let options = LoadOptions::default();
    let loaded = scene::parse(text, "s.json5", &options, &scene::from_sources(&[]))
        .map_err(|e| e.to_string())?;
    World::new(&loaded).map_err(|e| organza::record::place(&loaded, &e).to_string())
}

const TUNIC: &str =
    "{tunic: {width_m: 0.6, length_m: 0.8, armhole_m: 0.2, neck_width_m: 0.2, cell_m: 0.1}}";
const SLEEVES: &str = "{tunic: {width_m: 0.6, length_m: 0.8, armhole_m: 0.2, neck_width_m: 0.2,
    neck_depth_m: [0.1, 0], hem_width_m: 0.8, sleeve_m: 0.3, cell_m: 0.1}}";
const PONCHO: &str = "{poncho: {width_m: 1, length_m: 0.7, neck_width_m: 0.3, cell_m: 0.1}}";

#[test]
fn tunics_and_ponchos_are_built_and_move() {
    for (mesh, width, length) in [(TUNIC, 0.6, 0.8), (PONCHO, 1.0, 0.7)] {
        let world = world(mesh, "'boundary'").unwrap();
        assert_eq!(world.garments[0].panels, 0..2);
        assert!((world.cloth.mesh.total_area() - 2.0 * width * length).abs() < 1e-12);
        let low = world.cloth.x.iter().map(|x| x.z).fold(0.0, f64::min);
        assert!((low + length).abs() < 1e-12);
    }
    let mut world = world(SLEEVES, "'boundary'").unwrap();
    assert_eq!(world.garments[0].panels, 0..4);
    let reach = world.cloth.x.iter().map(|x| x.x).fold(0.0, f64::max);
    assert!((reach - 0.6).abs() < 1e-12);
    let report = world.advance().unwrap();
    assert_eq!(report.retries, 0);
    world.cloth.mesh.validate().unwrap();
}

/// Places in space of what a handle selects (m).
#[track_caller]
fn held(mesh: &str, select: &str) -> Vec<[f64; 3]> {
    let world = world(mesh, select).unwrap_or_else(|e| panic!("{mesh} {select}: {e}"));
    world.handles.list()[0].held.iter().map(|&(v, _)| world.cloth.x[v as usize].into()).collect()
}

/// Asserts that each selection finds one whole loop of the boundary, at the height z (m).
#[track_caller]
fn finds_loops(mesh: &str, cases: &[(&str, f64)]) {
    for (select, z) in cases {
        let world = world(mesh, select).unwrap_or_else(|e| panic!("{mesh} {select}: {e}"));
        let held: BTreeSet<u64> = world.handles.list()[0].held.iter().map(|&(v, _)| v).collect();
        let mut loops = boundary_loops(&world.cloth.mesh).into_iter();
        let found =
            loops.any(|l| l.iter().map(|v| u64::from(v.0)).collect::<BTreeSet<_>>() == held);
        assert!(found, "{mesh} {select}: {held:?}");
        let level = held.iter().map(|&v| world.cloth.x[v as usize].z);
        assert!(level.into_iter().all(|x| (x - z).abs() < 1e-12), "{mesh} {select}");
    }
}

#[test]
fn sides_of_garments_are_whole_openings() {
    let drop = (0.4f64.powi(2) - (0.6 / std::f64::consts::TAU).powi(2)).sqrt();
    for panels in [1, 3] {
        let skirt = format!(
            "{{skirt: {{panels: {panels}, waist_m: 0.6, hem_m: 1.2, length_m: 0.4, cells: [6, 4]}}}}"
        );
        let cases = [
            ("{sides: ['upper']}", 0.0),
            ("{borders: ['waist']}", 0.0),
            ("{sides: ['lower']}", -drop),
            ("{borders: ['hem']}", -drop),
        ];
        // The radius of the polygon's corners is that of the wanted circumference.
        finds_loops(&skirt, &cases);
        assert_eq!(held(&skirt, "{sides: ['upper']}").len(), 6 * panels);
        assert_eq!(held(&skirt, "{borders: ['waist', 'hem', 'waist']}").len(), 12 * panels);
    }
    let tube = "{tube: {radius_m: 0.2, length_m: 0.5, segments: [8, 3]}}";
    finds_loops(tube, &[("{sides: ['lower']}", 0.0), ("{borders: ['upper']}", 0.5)]);
    finds_loops(TUNIC, &[("{sides: ['lower']}", -0.8), ("{borders: ['neck']}", 0.0)]);
    finds_loops(SLEEVES, &[("{borders: ['hem']}", -0.8)]);
    assert!(held(SLEEVES, "{borders: ['right-cuff']}").iter().all(|x| (x[0] - 0.6).abs() < 1e-12));
    assert!(held(TUNIC, "{borders: ['left-armhole']}").iter().all(|x| (x[0] + 0.3).abs() < 1e-12));
    finds_loops(PONCHO, &[("{borders: ['neck']}", 0.0)]);
}

#[test]
fn sides_of_a_grid_are_straight() {
    let grid = "{grid: {size_m: [3, 2], cells: [3, 2]}}";
    for (side, axis, at, n) in
        [("left", 0, 0.0, 3), ("right", 0, 3.0, 3), ("lower", 1, 0.0, 4), ("upper", 1, 2.0, 4)]
    {
        for key in ["sides", "borders"] {
            let held = held(grid, &format!("{{{key}: ['{side}']}}"));
            assert!(held.len() == n && held.iter().all(|x| x[axis] == at), "{side}: {held:?}");
        }
    }
    assert_eq!(held(grid, "{sides: ['left', 'lower']}").len(), 6);
}

#[test]
fn what_is_not_there_is_named() {
    let tube = "{tube: {radius_m: 0.2, length_m: 0.5, segments: [8, 3]}}";
    let skirt = "{skirt: {waist_m: 0.6, hem_m: 1.2, length_m: 0.4, cells: [6, 4]}}";
    for (mesh, select, message) in [
        (tube, "{sides: ['left']}", "no side `left`; its borders are lower, upper"),
        (skirt, "{borders: ['wais']}", "no border `wais`, did you mean `waist`?"),
        (skirt, "{borders: ['left']}", "no border `left`, expected one of hem, waist"),
        (skirt, "{borders: []}", "selects no vertex"),
        (skirt, "{sides: ['middle']}", "`middle`"),
        (PONCHO, "{sides: ['lower']}", "no side `lower`; its borders are neck, outline"),
    ] {
        let error = world(mesh, select).unwrap_err();
        assert!(error.starts_with("s.json5:2:") && error.contains(message), "{error}");
        assert!(error.contains("handles[0].select"), "{error}");
    }
}

/// Whatever the remesher puts into the waist while it is held is held, too.
#[test]
fn a_held_waist_stays_held_while_the_mesh_adapts() {
    let text = "{frames: 3, substeps: 1, cloths: [{fabric: 'denim',
      mesh: {skirt: {panels: 2, waist_m: 0.6, hem_m: 1.2, length_m: 0.4, cells: [6, 4]}},
      remeshing: {size_m: {min: 0.02, max: 0.03}}}],
      handles: [{select: {borders: ['waist']}}]}";
    let options = LoadOptions::default();
    let loaded = scene::parse(text, "s.json5", &options, &scene::from_sources(&[])).unwrap();
    let mut world = World::new(&loaded).unwrap();
    for _ in 0..3 {
        world.advance().unwrap();
    }
    let held = &world.handles.list()[0].held;
    let names: BTreeSet<u64> = held.iter().map(|&(v, _)| v).collect();
    let uids = world.cloth.mesh.uids();
    let waist = (0..uids.len()).filter(|&v| names.contains(&uids[v]));
    let places: Vec<_> = waist.map(|v| world.cloth.x[v]).collect();
    assert!(places.len() == held.len() && places.len() > 12, "{}", places.len());
    assert!(places.iter().all(|x| x.z == 0.0));
}
