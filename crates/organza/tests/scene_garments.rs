//! Garments of a scene: their meshes.

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
