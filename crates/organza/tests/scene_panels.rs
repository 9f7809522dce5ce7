//! Panels by name: fabrics and handles on groups of a mesh file and on parts of garments.

mod cli_common;

use cli_common::Folder;
use organza::scene::{self, LoadOptions, Loaded, Source};
use organza::world::World;

/// Three squares side by side, along x.
const STRIP: &str = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 3 1 0\n\
    o Left.part\nf 1 2 6 5\ng middle\nf 2 3 7 6\ng Left.part\nf 3 4 8 7\n";

fn load(cloth: &str, select: &str) -> Result<Loaded, String> {
    let text = format!(
        "{{frames: 2, substeps: 1, cloths: [{{fabric: 'denim', {cloth}}}],\n\
         handles: [{{select: {select}}}]}}"
    );
    let files = [Source { name: "strip.obj".into(), bytes: STRIP.into() }];
    scene::parse(text, "s.json5", &LoadOptions::default(), &scene::from_sources(&files))
        .map_err(|e| e.to_string())
}

fn world(cloth: &str, select: &str) -> Result<World, String> {
    let loaded = load(cloth, select)?;
    World::new(&loaded).map_err(|e| organza::record::place(&loaded, &e).to_string())
}

fn held(world: &World) -> Vec<u64> {
    world.handles.list()[0].held.iter().map(|&(v, _)| v).collect()
}

#[test]
fn groups_of_a_file_are_panels() {
    let strip = "mesh: {obj: 'strip.obj'}";
    let plain = world(strip, "{panels: ['middle']}").unwrap();
    assert_eq!((held(&plain), plain.garments[0].panels.clone()), (vec![1, 2, 5, 6], 0..2));
    assert_eq!(plain.cloth.densities(), [0.32, 0.32]);
    let both = world(strip, "{panels: ['middle', 'Left.part']}").unwrap();
    assert_eq!(held(&both).len(), 8);

    let other = "mesh: {obj: 'strip.obj'}, thicken: 2, panel_fabrics: {'Left.part': 'knit-light'}";
    let other = world(other, "{panels: ['Left.part']}").unwrap();
    assert_eq!((held(&other).len(), other.cloth.densities()), (8, &[0.22, 0.64][..]));
    assert!((other.cloth.total_mass() - (2.0 * 0.22 + 0.64)).abs() < 1e-12);
}

#[test]
fn parts_of_garments_are_panels() {
    let tunic = "mesh: {tunic: {width_m: 0.6, length_m: 0.8, armhole_m: 0.2, neck_width_m: 0.2, \
                 sleeve_m: 0.3, cell_m: 0.1}}, panel_fabrics: {front: 'swim'}";
    let mut tunic = world(tunic, "{panels: ['right-sleeve']}").unwrap();
    assert_eq!(tunic.cloth.densities(), [0.2, 0.32, 0.32, 0.32]);
    let x: Vec<f64> = held(&tunic).iter().map(|&v| tunic.cloth.x[v as usize].x).collect();
    assert!(x.len() == 16 && x.iter().all(|&x| x > 0.3 - 1e-12), "{x:?}");
    tunic.advance().unwrap();

    let skirt =
        "mesh: {skirt: {panels: 3, waist_m: 0.6, hem_m: 1.2, length_m: 0.4, cells: [2, 4]}}";
    assert_eq!(held(&world(skirt, "{panels: ['2']}").unwrap()).len(), 3 * 5);
}

#[test]
fn panels_that_are_not_there_are_named() {
    let strip = "mesh: {obj: 'strip.obj'}";
    for (more, select, message) in [
        ("", "{panels: ['midle']}", "2:20: handles[0].select: there is no panel `midle`, did you mean `middle`?"),
        ("", "{panels: []}", "2:20: handles[0].select: selects no vertex"),
        (
            ", panel_fabrics: {right: 'swim'}",
            "'all'",
            "cloths[0].panel_fabrics: there is no panel `right`, expected one of Left.part, middle",
        ),
        (
            ", panel_fabrics: {'Left.part': 'silk'}",
            "'all'",
            "cloths[0].panel_fabrics.Left.part: unknown choice `silk`",
        ),
        (
            ", panel_fabrics: {middle: {measured: 'none.json'}}",
            "'all'",
            "cloths[0].panel_fabrics.middle.measured: there is no file `none.json`",
        ),
        (
            ", panel_fabrics: {middle: {custom: {density_kg_per_m2: -1,
              stretching_n_per_m: {warp: 9, weft: 9, shear: 3}, bending_n_m: {warp: 0, weft: 0, bias: 0}}}}",
            "'all'",
            "cloths[0].panel_fabrics.middle.custom.density_kg_per_m2: must be positive and finite, got -1",
        ),
    ] {
        let error = world(&format!("{strip}{more}"), select).map(|_| ()).unwrap_err();
        assert!(error.starts_with("s.json5:") && error.contains(message), "{error}");
    }
}

#[test]
fn check_weighs_panels_by_their_own_fabric() {
    let folder = Folder::new("panels");
    folder.write("strip.obj", STRIP);
    folder.write(
        "s.json5",
        "{frames: 1, cloths: [{fabric: 'denim', mesh: {obj: 'strip.obj'},
          panel_fabrics: {middle: 'knit-light'}}]}",
    );
    let out = folder.good(&["check", "s.json5"]).out;
    assert!(out.contains("3.0000 m², 0.7500 kg"), "{out}");
    assert!(out.contains("panels of other fabrics: middle"), "{out}");
}

/// A pattern that is good by itself and vanishes once it is scaled.
#[test]
fn the_cloth_that_does_not_fit_is_named() {
    let text = "{frames: 1, cloths: [
        {fabric: 'denim', mesh: {grid: {size_m: [1, 1], cells: [1, 1]}}},
        {fabric: 'denim', name: 'speck', mesh: {obj: 'speck.obj'}, transform: {scale: 1e-6}}]}";
    let speck = "v 0 0 0\nv 1e-158 0 0\nv 0 1e-158 0\nf 1 2 3\n";
    let files = [Source { name: "speck.obj".into(), bytes: speck.into() }];
    let options = LoadOptions::default();
    let loaded = scene::parse(text, "s.json5", &options, &scene::from_sources(&files)).unwrap();
    let error = World::new(&loaded).unwrap_err();
    assert!(error.to_string().starts_with("cloth `speck`: triangle 2 has area"), "{error}");
    let placed = organza::record::place(&loaded, &error).to_string();
    assert!(placed.starts_with("s.json5:3:") && placed.contains("cloths[1].mesh: "), "{placed}");
}
