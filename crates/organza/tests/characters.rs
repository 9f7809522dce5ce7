//! Characters, what they wear, and crowds in scenes.

use organza::scene::{LoadOptions, Loaded, from_sources, parse};
use organza::world::World;

fn scene(extra: &str) -> Result<Loaded, String> {
    let text = format!("{{frames: 5, substeps: 4, integrator: 'implicit-euler', {extra}}}");
    parse(text, "s", &LoadOptions::default(), &from_sources(&[])).map_err(|e| e.to_string())
}

const ANNA: &str = "obstacles: [{name: 'anna', mesh: {character: {motion: 'walk', start_s: 0,
    ease_s: 0.1, cell_m: 0.04}},
    transform: {scale: 1.1, rotate: {axis: [0, 0, 1], degrees: 90}, translate: [3, 0, 0]}}],";

fn dressed(kind: &str) -> String {
    format!(
        "{ANNA} cloths: [{{fabric: 'woven-light',
           mesh: {{garment: {{kind: '{kind}', on: 'anna', cell_m: 0.05}}}}}}]"
    )
}

#[test]
fn garments_start_on_their_characters() {
    for kind in ["dress", "skirt", "trousers", "jacket", "belt"] {
        let mut world = World::new(&scene(&dressed(kind)).unwrap()).unwrap();
        assert_eq!(world.crossings(0), None, "{kind}");
        // Around the character: turned by 90° it looks along x, at x = 3 and scaled.
        let middle = world.cloth.x.iter().sum::<mesh_core::World3>() / world.cloth.x.len() as f64;
        assert!((middle.x - 3.0).abs() < 0.1 && middle.y.abs() < 0.1, "{kind}: {middle}");
        let body = &world.obstacles[0];
        assert!(body.is_moving());
        let top = body.positions(0.0).iter().map(|x| x.z).fold(0.0, f64::max);
        assert!((1.75..2.0).contains(&top), "{top}");
        let report = world.advance().unwrap();
        assert_eq!((report.crossings, report.frame), (Some(0), 1), "{kind}");
    }
}

#[test]
fn panels_and_borders_have_names() {
    let select = |what: &str| {
        let handles = format!("{}, handles: [{{select: {{{what}}}}}]", dressed("dress"));
        World::new(&scene(&handles).unwrap()).unwrap().handles.list()[0].held.len()
    };
    assert!(select("borders: ['neck']") > 4);
    assert!(select("panels: ['skirt-front']") > 20);
}

#[test]
fn crowds_have_phases_and_clothes_of_their_own() {
    let crowd = |count: u32| {
        format!(
            "cloths: [], crowd: {{count: {count}, columns: 2, spacing_m: [2, 3],
               character: {{motion: 'dance', cell_m: 0.04, seed: 4}}, motions: ['turn', 'kick', 'walk'],
               cloths: [{{fabric: 'swim', mesh: {{garment: {{kind: 'skirt', cell_m: 0.06}}}}}},
                        {{fabric: 'denim', mesh: {{garment: {{kind: 'belt', cell_m: 0.06}}}}}}]}}"
        )
    };
    let loaded = scene(&crowd(3)).unwrap();
    let world = World::new(&loaded).unwrap();
    let names: Vec<&str> = world.obstacles.iter().map(|o| o.name.as_str()).collect();
    assert_eq!(names, ["crowd0", "crowd1", "crowd2"]);
    let cloths: Vec<&str> = world.garments.iter().map(|g| g.name.as_str()).collect();
    assert_eq!(cloths, names);
    assert_eq!(world.crossings(0), None);
    // Two side by side, and one behind them.
    let place = |k: usize| loaded.scene.obstacles[k].transform.translate;
    assert_eq!(
        [place(0), place(1), place(2)],
        [[-1.0, -1.5, 0.0], [1.0, -1.5, 0.0], [-1.0, 1.5, 0.0]]
    );
    let sources: Vec<_> = loaded.scene.obstacles.iter().map(|o| format!("{:?}", o.mesh)).collect();
    assert!(
        sources[0].contains("Turn") && sources[1].contains("Kick") && sources[2].contains("Walk")
    );
    assert!(sources[0].contains("seed: 4") && sources[2].contains("seed: 6"));
    // Nobody moves another one: the first is the same however many there are.
    let alone = scene(&crowd(1)).unwrap();
    assert_eq!(alone.scene.obstacles[0].mesh, loaded.scene.obstacles[0].mesh);
}

#[test]
fn mistakes_are_named_with_their_place() {
    let character = |what: &str| {
        format!(
            "obstacles: [{{mesh: {{character: {{{what}}}}}}}],
             cloths: [{{fabric: 'swim', mesh: {{grid: {{size_m: [1, 1], cells: [1, 1]}}}}}}]"
        )
    };
    let crowd = |what: &str| format!("cloths: [], crowd: {{{what}}}");
    let skirt = "cloths: [{fabric: 'swim', mesh: {garment: {kind: 'skirt'}}}]";
    for (text, words) in [
        (character("cell_m: 0.5"), "obstacles[0].mesh.character.cell_m: must lie between"),
        (character("motion: 'fly'"), "fly"),
        (character("phase: 1e9"), "obstacles[0].mesh.character.phase"),
        (character("ease_s: -1"), "obstacles[0].mesh.character.ease_s: must be zero or more"),
        (character("sed: 3"), "unknown key `sed`, did you mean `seed`?"),
        (dressed("skrit"), "skrit"),
        (
            dressed("skirt").replace("on: 'anna'", "on: 'anne'"),
            "no character `anne`, did you mean `anna`?",
        ),
        (dressed("skirt").replace("on: 'anna',", ""), "cloths[0].mesh.garment: needs `on`"),
        (dressed("skirt").replace("0.05", "5"), "cloths[0].mesh.garment.cell_m: must lie between"),
        (crowd(&format!("count: 0, {skirt}")), "crowd.count: must be at least 1"),
        (crowd(&format!("count: 100000, {skirt}")), "beyond the limit of 1000"),
        (crowd("count: 2, cloths: []"), "at least one cloth"),
        (
            crowd(&format!("count: 2, {}", skirt.replace("kind:", "on: 'anna', kind:"))),
            "crowd.cloths[0].mesh.garment.on: goes without saying",
        ),
        (
            crowd("count: 2, cloths: [{fabric: 'swim', mesh: {disc: {radius_m: 1, rings: 3}}}]"),
            "crowd.cloths[0].mesh: a crowd wears garments alone",
        ),
        (
            format!("{}, crowd: {{count: 2, {skirt}}}", dressed("skirt").replace("anna", "crowd1")),
            "crowd: `crowd1` is the name of something else already",
        ),
    ] {
        let error = scene(&text).map(|_| ()).unwrap_err();
        assert!(error.contains(words), "`{words}` is not in: {error}");
    }
}
