//! The project's own scenes, the published schema, and reading from disk and from attachments.

use std::path::{Path, PathBuf};

use organza::fabric::Fabric;
use organza::scene::format::{Corner, Integrator, LinearSolver, Select};
use organza::scene::{
    Dialect, LoadOptions, Loaded, MeshSource, Source, from_sources, json_schema, load, parse,
};

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

fn own(name: &str, sets: &[&str]) -> Loaded {
    let options = LoadOptions {
        sets: sets.iter().map(|set| (*set).to_owned()).collect(),
        allow_unsupported: false,
    };
    load(&scenes().join(name), &options).unwrap_or_else(|errors| panic!("{errors}"))
}

#[test]
fn flag_is_the_flag_of_narain_2012() {
    let loaded = own("flag.json5", &[]);
    assert_eq!(loaded.dialect, Dialect::Organza);
    assert!(loaded.warnings.is_empty());
    let scene = loaded.scene;
    assert_eq!((scene.frames, scene.substeps), (500, 8));
    assert_eq!(scene.step_s(), 0.005);
    assert_eq!(scene.frame_s(), 0.04);
    assert_eq!(scene.up(), [0.0, 0.0, 1.0]);
    assert_eq!(scene.wind.unwrap().velocity, [10.0, 0.0, 0.0]);
    assert_eq!(scene.integrator, Integrator::ImplicitEuler);
    assert_eq!(scene.linear_solver, LinearSolver::Auto);
    let flag = &scene.cloths[0];
    assert_eq!(flag.strain_limits, Some([0.95, 1.05]));
    assert_eq!(flag.multipliers.density, 2.0);
    assert_eq!(flag.multipliers.bending, 2.0);
    let MeshSource::Grid(grid) = &flag.mesh else { panic!("{:?}", flag.mesh) };
    assert_eq!(grid.size_m, [3.0, 2.0]);
    let remeshing = flag.remeshing.unwrap();
    assert_eq!((remeshing.size_m.min, remeshing.size_m.max), (0.02, 0.5));

    // Upright: the pattern's u goes along y, its v up along z, and the normal along the wind.
    let place = flag.transform.similarity();
    let near = |p: [f64; 3], q: [f64; 3]| {
        (nalgebra::Point3::from(p) - place * nalgebra::Point3::from(q)).norm() < 1e-15
    };
    assert!(near([0.0, 3.0, 2.0], [3.0, 2.0, 0.0]));
    assert!(near([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]));
    // The corners held are the ends of a short side.
    let handle = &scene.handles[0];
    assert_eq!(handle.select, Select::Corners(vec![Corner::LowerLeft, Corner::UpperLeft]));
    assert_eq!(
        (handle.start_s, handle.end_s, handle.stiffness_n_per_m),
        (0.0, f64::INFINITY, None)
    );
}

#[test]
fn hang_is_the_sheet_of_the_peers() {
    let scene = own("hang.json5", &[]).scene;
    let Fabric::Orthotropic(fabric) = &scene.cloths[0].fabric else { panic!() };
    let c = fabric.stretching_n_per_m;
    // Y = 1000 N/m and Poisson's ratio 0.3, to the digits written.
    let ratio = c.coupling / c.warp;
    assert!((ratio - 0.3).abs() < 1e-5);
    assert!((c.warp * (1.0 - ratio * ratio) - 1000.0).abs() < 0.01);
    assert!((c.shear * 2.0 * (1.0 + ratio) - 1000.0).abs() < 0.02);
    assert!(scene.cloths[0].remeshing.is_some());
    assert!(scene.step_s() < 0.0081);
}

#[test]
fn cantilever_resolves_its_boundary_layer() {
    let scene = own("cantilever.json5", &[]).scene;
    let strip = &scene.cloths[0];
    assert_eq!(strip.remeshing, None);
    let Fabric::Orthotropic(fabric) = &strip.fabric else { panic!() };
    let MeshSource::Grid(grid) = &strip.mesh else { panic!() };
    let Select::Box(clamp) = &scene.handles[0].select else { panic!() };
    let length_m = grid.size_m[0] - clamp.max[0];
    let gamma = fabric.density_kg_per_m2 * 9.81 * length_m.powi(3) / fabric.bending_n_m.warp;
    assert!((gamma - 57.0).abs() < 1.0, "{gamma}");
    let element_m = grid.size_m[0] / f64::from(grid.cells[0]);
    assert!(element_m <= 0.5 * length_m / gamma.sqrt(), "{element_m}");
    // A clamp needs at least two rows of vertices.
    assert!(clamp.max[0] >= 2.0 * element_m);
}

#[test]
fn sphere_moves_as_that_of_narain_2012() {
    let loaded = own("sphere.json5", &[]);
    let built = organza::build::build(&loaded).unwrap();
    let contact = built.contact.unwrap();
    assert!(contact.self_contact && contact.thickness == 0.005);
    let [ball] = &built.obstacles[..] else { panic!() };
    for (time, y) in [(0.0, 0.0), (2.0, 0.0), (3.0, -1.5), (5.0, 1.5), (6.0, 0.0), (8.0, -0.4)] {
        for x in ball.positions(time) {
            let from = x - mesh_core::World3::new(0.0, y, 0.0);
            assert!((from.norm() - 0.1).abs() < 1e-12, "{time}: {x}");
        }
    }
    // Nothing touches at the start, and the corners held are above the ball.
    let distance = |x: &mesh_core::World3| x.norm() - 0.1;
    assert!(built.cloth.x.iter().map(distance).fold(f64::INFINITY, f64::min) > 0.3);
    assert_eq!(built.handles.names().len(), 2);
    assert_eq!(loaded.scene.handles[0].end_s, 7.0);
}

#[test]
fn drape_starts_free_above_its_sphere() {
    let built = organza::build::build(&own("drape.json5", &[])).unwrap();
    let [ball] = &built.obstacles[..] else { panic!() };
    assert!(!ball.is_moving());
    assert!(ball.positions(3.0).iter().all(|x| (x.norm() - 0.25).abs() < 1e-12));
    let lowest = built.cloth.x.iter().map(|x| x.norm()).fold(f64::INFINITY, f64::min);
    assert!((lowest - 0.3).abs() < 1e-12, "{lowest}");
    assert!(built.contact.unwrap().self_contact);
}

#[test]
fn values_can_be_set_from_the_command_line() {
    let scene = own(
        "hang.json5",
        &[
            "cloths[0].remeshing=null",
            "cloths[0].mesh.grid.cells=[63, 63]",
            "cloths[0].fabric=denim",
            "cloths[0].damping.stiffness_s=1e-3",
            "integrator=implicit-euler",
            "newton.max_iterations=1",
            "frames=3",
        ],
    )
    .scene;
    assert_eq!(scene.frames, 3);
    assert_eq!(scene.integrator, Integrator::ImplicitEuler);
    assert!(scene.newton.is_fast());
    let sheet = &scene.cloths[0];
    assert_eq!(sheet.remeshing, None);
    assert_eq!(sheet.damping.stiffness_s, 1e-3);
    assert_eq!(sheet.fabric.density_kg_per_m2(), 0.32);
    let MeshSource::Grid(grid) = &sheet.mesh else { panic!() };
    assert_eq!(grid.cells, [63, 63]);
}

/// The schema is generated from the types. To bring the file up to date, run this test with
/// `ORGANZA_BLESS=1`.
#[test]
fn published_schema_is_the_generated_one() {
    let path = scenes().join("scene.schema.json");
    let generated = json_schema();
    if std::env::var_os("ORGANZA_BLESS").is_some() {
        let text = serde_json::to_string_pretty(&generated).unwrap();
        std::fs::write(&path, text + "\n").unwrap();
    }
    let text = std::fs::read_to_string(&path).unwrap();
    let published: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert!(published == generated, "scenes/scene.schema.json is out of date; see this test");
}

#[test]
fn schema_tells_every_key_and_its_unit() {
    let schema = json_schema();
    let mut described = 0;
    let mut open = vec![&schema];
    while let Some(value) = open.pop() {
        if let Some(properties) = value.get("properties").and_then(|p| p.as_object()) {
            for (key, property) in properties {
                // A choice with a value is an object of one key, described as a whole.
                let told = property.get("description").or_else(|| value.get("description"));
                assert!(told.is_some(), "`{key}` has no description");
                described += 1;
            }
        }
        match value {
            serde_json::Value::Object(object) => open.extend(object.values()),
            serde_json::Value::Array(list) => open.extend(list),
            _ => {}
        }
    }
    assert!(described > 60, "{described} keys");
}

#[test]
fn the_smallest_scene_of_the_documentation_is_a_scene() {
    let text = include_str!("../../../docs/scenes.md");
    let (_, rest) = text.split_once("```json5\n").unwrap();
    let (smallest, rest) = rest.split_once("```").unwrap();
    let options = LoadOptions::default();
    let scene = parse(smallest, "smallest", &options, &from_sources(&[])).unwrap().scene;
    assert_eq!((scene.frames, scene.frames_per_second, scene.substeps), (50, 25.0, 8));
    assert_eq!((scene.gravity, scene.wind), ([0.0, 0.0, -9.81], None));
    assert_eq!((scene.cloths[0].remeshing, scene.handles[0].cloth), (None, 0));

    // The custom fabric of the second block.
    let (_, rest) = rest.split_once("fabric: { custom: {").unwrap();
    let (custom, _) = rest.split_once("\n} }").unwrap();
    let options =
        LoadOptions { sets: vec![format!("cloths[0].fabric={{custom: {{{custom}}}}}")], ..options };
    let scene = parse(smallest, "smallest", &options, &from_sources(&[])).unwrap().scene;
    assert_eq!(scene.cloths[0].fabric.density_kg_per_m2(), 0.2);
}

#[test]
fn attached_sources_replace_the_disk() {
    let folder = std::env::temp_dir().join(format!("organza-scene-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("meshes")).unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    let material = r#"{ // a comment
        "density": 0.2,
        "stretching": [[9,1,9,3],[9,1,9,3],[9,1,9,-3],[9,1,9,3],[9,1,9,3],[9,1,9,3]],
        "bending": [[1,1,1,1,1],[1,1,1,1,1],[1,1,1,1,1]] }"#;
    write("meshes/a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("cloth.json", material);
    write(
        "two.json5",
        "{frames: 2, cloths: [
            {mesh: {obj: 'meshes/a.obj'}, fabric: {measured: 'cloth.json'}},
            {mesh: {obj: 'meshes/a.obj', material_obj: 'meshes/a.obj'}, fabric: 'swim'}]}",
    );
    let path = folder.join("two.json5");
    let first = load(&path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    std::fs::remove_dir_all(&folder).unwrap();

    // Each file once, the scene first, names as the scene wrote them.
    let names: Vec<&str> = first.sources.iter().map(|source| source.name.as_str()).collect();
    assert_eq!(names, [path.to_str().unwrap(), "cloth.json", "meshes/a.obj"]);
    assert_eq!(first.source("cloth.json"), Some(material.as_bytes()));
    assert_eq!(first.source(path.to_str().unwrap()), None);
    assert_eq!(first.scene.name, "two");
    assert_eq!(first.scene.cloths[1].name, "cloth1");

    let Source { name, bytes } = &first.sources[0];
    let options = LoadOptions::default();
    let again = parse(bytes, name, &options, &from_sources(&first.sources)).unwrap();
    assert_eq!(again.scene, first.scene);
    assert_eq!(again.sources, first.sources);
}

/// Names of files are relative to the scene, that of the scene is not.
#[test]
fn a_file_may_be_called_as_the_scene_is() {
    let text = "{frames: 1, cloths: [{mesh: {obj: 'flag'}, fabric: 'swim'}]}";
    let mesh =
        Source { name: "flag".into(), bytes: b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".into() };
    let options = LoadOptions::default();
    let loaded = parse(text, "flag", &options, &from_sources(std::slice::from_ref(&mesh))).unwrap();
    assert_eq!(loaded.source("flag"), Some(&*mesh.bytes));
    organza::world::World::new(&loaded).unwrap();
}

#[test]
fn later_stages_can_point_into_the_file() {
    let text = "{frames: 1,\n cloths: [{mesh: {obj: 'a.obj'}, fabric: 'swim'}]}";
    let sources = [Source { name: "a.obj".to_owned(), bytes: Vec::new() }];
    let options = LoadOptions { sets: vec!["frames=2".to_owned()], allow_unsupported: false };
    let loaded = parse(text, "s.json5", &options, &from_sources(&sources)).unwrap();
    let kind = organza::scene::IssueKind::Value;
    let issue = loaded.places.issue(kind, "cloths[0].mesh.obj", "has no face");
    assert_eq!(issue.to_string(), "s.json5:2:24: cloths[0].mesh.obj: has no face");
    let issue = loaded.places.issue(kind, "frames", "too many");
    assert_eq!(issue.to_string(), "--set frames=2: frames: too many");
}
