//! Scenes of ARCSim: its own two where they are at hand, and made-up ones for every part of the
//! format.

use std::path::{Path, PathBuf};

use mesh_core::World3;
use organza::build::build;
use organza::contact::ContactSettings;
use organza::fabric::Fabric;
use organza::scene::format::{BendingModel, Integrator, Multipliers, Select};
use organza::scene::motion::{Interpolation, Turning};
use organza::scene::{
    Dialect, IssueKind, LoadOptions, Loaded, MeshSource, SceneErrors, Source, from_sources, load,
    parse,
};

/// ARCSim's folder, if it is at hand.
fn arcsim() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/arcsim");
    let folder = std::env::var_os("ORGANZA_ARCSIM").map_or(beside, PathBuf::from);
    let found = folder.join("conf/flag.json").is_file();
    if !found {
        eprintln!("skipped: no ARCSim scenes in {} (set ORGANZA_ARCSIM)", folder.display());
    }
    found.then_some(folder)
}

#[test]
fn arcsims_own_flag_is_read_unmodified() {
    let Some(folder) = arcsim() else { return };
    let loaded = load(&folder.join("conf/flag.json"), &LoadOptions::default())
        .unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(loaded.dialect, Dialect::Arcsim);
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);

    let scene = &loaded.scene;
    assert_eq!(scene.name, "flag");
    assert_eq!((scene.frames, scene.frames_per_second, scene.substeps), (500, 25.0, 8));
    assert_eq!(scene.step_s(), 0.005);
    assert_eq!(scene.gravity, [9.81, 0.0, 0.0]);
    assert_eq!(scene.up(), [-1.0, 0.0, 0.0]);
    let wind = scene.wind.unwrap();
    assert_eq!((wind.velocity, wind.density, wind.drag), ([10.0, 0.0, 0.0], 1.0, 0.0));

    let flag = &scene.cloths[0];
    let material_obj = None;
    assert_eq!(flag.mesh, MeshSource::Obj { obj: "meshes/flag.obj".to_owned(), material_obj });
    assert!(loaded.source("meshes/flag.obj").unwrap().starts_with(b"v 0 0 0"));
    let rotate = flag.transform.rotate.unwrap();
    assert_eq!((rotate.axis, rotate.degrees), ([0.0, 1.0, 0.0], 45.0));
    assert_eq!(flag.strain_limits, Some([0.95, 1.05]));
    assert_eq!(flag.multipliers, Multipliers { density: 2.0, stretching: 2.0, bending: 2.0 });
    let Fabric::Measured(fabric) = &flag.fabric else { panic!("{:?}", flag.fabric) };
    // Raw, as in the file: not doubled, and negative entries kept.
    assert_eq!(fabric.density, 0.284);
    assert_eq!(fabric.stretching[0], [31.146198, -12.802702, 44.028667, 31.896357]);
    assert_eq!(fabric.bending[2][4], 10.439938e-6);
    let remeshing = flag.remeshing.unwrap();
    assert_eq!((remeshing.size_m.min, remeshing.size_m.max), (0.02, 0.5));
    assert_eq!(remeshing.refine_compression, Some(0.01));

    let handle = &scene.handles[0];
    assert_eq!(handle.select, Select::Vertices(vec![0, 3]));
    assert_eq!(handle.stiffness_n_per_m, Some(1e3));
    assert_eq!(handle.end_s, f64::INFINITY);
    // ARCSim lets cloth touch itself.
    let contact = ContactSettings { thickness: 0.01, friction: 0.6, self_contact: true };
    assert_eq!((scene.contact, scene.obstacles.len()), (Some(contact), 0));

    // A resumed run reads what was attached, not the disk.
    let Source { name, bytes } = &loaded.sources[0];
    let again = parse(bytes, name, &LoadOptions::default(), &from_sources(&loaded.sources));
    assert_eq!(again.unwrap().scene, *scene);
}

#[test]
fn arcsims_own_sphere_is_read_unmodified() {
    let Some(folder) = arcsim() else { return };
    let loaded = load(&folder.join("conf/sphere.json"), &LoadOptions::default())
        .unwrap_or_else(|errors| panic!("{errors}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let built = build(&loaded).unwrap();
    let ball = &built.obstacles[0];
    assert_eq!((built.obstacles.len(), ball.name.as_str()), (1, "obstacle0"));
    assert_eq!((ball.triangles.len(), ball.n_vertices(), ball.friction), (1280, 642, 0.3));
    let contact = ContactSettings { thickness: 0.005, friction: 0.6, self_contact: true };
    assert_eq!(built.contact, Some(contact));
    // A sphere of 0.1 m, at these heights along y when its keyframes say so; the last for good.
    for (time, y) in [(0.0, 0.0), (1.0, 0.0), (3.0, -1.5), (5.0, 1.5), (7.0, -0.4), (9.0, -0.4)] {
        for x in ball.positions(time) {
            assert!(((x - World3::new(0.0, y, 0.0)).norm() - 0.1).abs() < 1e-5, "{time}: {x}");
        }
    }
    let scene = loaded.scene;
    assert_eq!((scene.frames, scene.substeps), (250, 8));
    assert_eq!(scene.handles[0].end_s, 7.0);
    assert_eq!(scene.handles[0].motion, None);
    // The air is still, and resists.
    let wind = scene.wind.unwrap();
    assert_eq!((wind.velocity, wind.density), ([0.0; 3], 1.0));
    assert_eq!(scene.cloths[0].transform.translate, [-0.5, -1.0, 0.5]);
    assert_eq!(scene.cloths[0].strain_limits, None);
}

#[test]
fn obstacles_motions_and_contact_are_translated() {
    let text = |more: &str| {
        with(
            &format!(
                r#""motions": [[{{"time": 1, "transform": {{"scale": 2}}}}, {{"time": 2}}]], {more}
"obstacles": [{{"mesh": "a.obj"}},
{{"mesh": "a.obj", "motion": 0, "transform": {{"translate": [1, 2, 3]}}, "start_time": 0}}],"#
            ),
            "",
            "",
        )
    };
    let scene = read(&text(r#""friction": 0.2, "obs_friction": 0.1,"#), &[], false).unwrap().scene;
    let contact = ContactSettings { thickness: 1e-3, friction: 0.2, self_contact: true };
    assert_eq!(scene.contact, Some(contact));
    let [first, second] = &scene.obstacles[..] else { panic!() };
    assert_eq!((first.friction, &first.motion), (0.1, &None));
    assert_eq!(second.transform.translate, [1.0, 2.0, 3.0]);
    let motion = second.motion.as_ref().unwrap();
    assert_eq!((motion.turning, motion.interpolation), (Turning::Shortest, Interpolation::Smooth));
    assert_eq!(motion.at(1.0).scaling(), 2.0);

    // One of both ways to keep things apart is enough, and without any nothing touches.
    for (disable, left) in [("[\"proximity\"]", 2), ("[\"collision\", \"proximity\"]", 0)] {
        let loaded = read(&text(&format!("\"disable\": {disable},")), &[], false).unwrap();
        assert_eq!(
            (loaded.scene.obstacles.len(), loaded.scene.contact.is_some()),
            (left, left > 0)
        );
        assert_eq!(loaded.warnings.len(), usize::from(left == 0), "{:?}", loaded.warnings);
    }

    complains(
        &text(r#""friction": -1, "magic": {"repulsion_thickness": 0},"#)
            .replace("\"motion\": 0", "\"motion\": 3")
            .replace("\"start_time\": 0", "\"start_time\": 0, \"end_time\": 0")
            .replace("{\"mesh\": \"a.obj\"}", "{\"mesh\": \"b.obj\"}"),
        &[],
        &[
            "c/s.json:1:116: friction: must be zero or more and finite, got -1",
            "c/s.json:1:153: magic.repulsion_thickness: must be positive and finite, got 0",
            "c/s.json:2:24: obstacles[0].mesh: there is no file `b.obj` among those attached",
            "c/s.json:3:29: obstacles[1].motion: there is no such motion, the scene has 1",
            "c/s.json:3:100: obstacles[1].end_time: 0 s is not after the start at 0 s",
        ],
    );
}

fn attached() -> Vec<Source> {
    let material = "{\"density\": 0.1, // light\n\"stretching\": [[9,1,9,3],[9,1,9,3],[9,1,9,3],\
        [9,1,9,3],[9,1,9,3],[9,1,9,3]], \"bending\": [[1,1,1,1,1],[1,1,1,1,1],[1,1,1,1,1]]}";
    [("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), ("m.json", material)]
        .map(|(name, text)| Source { name: name.to_owned(), bytes: text.as_bytes().to_vec() })
        .to_vec()
}

fn read(text: &str, sets: &[&str], allow_unsupported: bool) -> Result<Loaded, SceneErrors> {
    let sets = sets.iter().map(|set| (*set).to_owned()).collect();
    parse(text, "c/s.json", &LoadOptions { sets, allow_unsupported }, &from_sources(&attached()))
}

/// Line 1: the scene; line 2: the cloth; line 3: its material.
fn with(scene: &str, cloth: &str, material: &str) -> String {
    format!(
        "{{\"frame_time\": 0.1, \"end_time\": 2, {scene} \"cloths\": [{{\n\"mesh\": \"a.obj\", {cloth} \
         \"materials\": [{{\n\"data\": \"m.json\"{material}}}]}}]}}"
    )
}

#[track_caller]
fn complains(text: &str, sets: &[&str], expected: &[&str]) {
    let errors = read(text, sets, false).map(|loaded| loaded.scene).unwrap_err();
    let got: Vec<String> = errors
        .issues()
        .iter()
        .filter(|i| i.kind != IssueKind::Notice)
        .map(|i| i.to_string())
        .collect();
    assert_eq!(got, expected, "\nscene: {text}");
}

#[test]
fn everything_simulated_is_translated() {
    let text = with(
        r#""frame_steps": 4, "gravity": [0, -9.8, 0], "magic": {"handle_stiffness": 5e3},
           "disable": ["collision", "proximity", "plasticity", "popfilter"],
           "motions": [[], [{"time": 1}, {"time": 3, "transform": {"translate": [2, 0, 0], "rotate": [180, 0, 0, 2]}}]],
           "handles": [{"nodes": [2], "motion": 1, "start_time": 1, "end_time": 3}],
           "organza": {"name": "own", "integrator": "implicit-euler", "bending": "hinge",
                       "newton": {"max_iterations": 1}},"#,
        r#""transform": {"scale": 2, "rotate": [90, 1, 0, 0]},
           "velocity": {"linear": [1, 2, 3], "angular": [0, 0, 4], "origin": [5, 0, 0]},
           "remeshing": {"size": [0.1, 1]},"#,
        r#", "thicken": 3, "density_mult": 2, "bending_mult": 0.5, "damping": 1e-3, "yield_curv": 100"#,
    );
    let loaded = read(&text, &[], false).unwrap_or_else(|errors| panic!("{errors}"));
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    let scene = loaded.scene;
    assert_eq!(scene.name, "own");
    assert_eq!((scene.frames, scene.substeps), (20, 4));
    assert_eq!(scene.integrator, Integrator::ImplicitEuler);
    assert!(scene.newton.is_fast());
    let cloth = &scene.cloths[0];
    assert_eq!(cloth.bending, BendingModel::Hinge);
    assert_eq!(cloth.multipliers, Multipliers { density: 6.0, stretching: 3.0, bending: 1.5 });
    assert_eq!((cloth.damping.mass_per_s, cloth.damping.stiffness_s), (0.0, 1e-3));
    assert_eq!(cloth.transform.scale, 2.0);
    assert_eq!(cloth.initial_velocity, [1.0, 2.0, 3.0]);
    let spin = cloth.initial_spin.unwrap();
    assert_eq!((spin.angular_velocity, spin.center), ([0.0, 0.0, 4.0], [5.0, 0.0, 0.0]));
    let remeshing = cloth.remeshing.unwrap();
    assert_eq!((remeshing.refine_angle, remeshing.aspect_min), (None, 0.001));

    let handle = &scene.handles[0];
    assert_eq!(handle.stiffness_n_per_m, Some(5e3));
    let motion = handle.motion.as_ref().unwrap();
    assert_eq!(motion.interpolation, Interpolation::Smooth);
    // Half way: half the translation and half the turn.
    let half = motion.at(2.0);
    assert!((half.isometry.translation.vector.x - 1.0).abs() < 1e-15);
    assert!((half.isometry.rotation.angle().to_degrees() - 90.0).abs() < 1e-12);
    assert_eq!(motion.at(0.0), motion.at(1.0));
    assert_eq!(motion.at(9.0), motion.at(3.0));
}

#[test]
fn parts_can_be_disabled_and_time_can_be_written_in_two_ways() {
    let text = with(
        r#""disable": ["remeshing", "strainlimiting"], "end_frame": 3,"#,
        r#""remeshing": {"size": [0.1, 1]},"#,
        r#", "strain_limits": [0.9, 1.1]"#,
    );
    let scene = read(&text, &[], false).unwrap().scene;
    assert_eq!((scene.cloths[0].remeshing, scene.cloths[0].strain_limits), (None, None));
    assert_eq!(scene.frames, 3);

    let cloth = r#""cloths": [{"mesh": "a.obj", "materials": [{"data": "m.json"}]}]"#;
    let text = format!(r#"{{"timestep": 0.01, "save_frames": 5, "duration": 1, {cloth}}}"#);
    let scene = read(&text, &[], false).unwrap().scene;
    assert_eq!((scene.frames, scene.frames_per_second, scene.substeps), (20, 20.0, 5));

    let loaded = read(&format!(r#"{{"frame_time": 0.1, {cloth}}}"#), &[], false).unwrap();
    assert_eq!(loaded.scene.frames, 500);
    assert!(loaded.warnings.iter().any(|w| w.message.contains("names no end: 500 frames")));
}

#[test]
fn what_is_not_simulated_is_listed_with_its_place() {
    let text = with(
        r#""motions": [[{"time": 1, "velocity": {"rotate": [9, 0, 0, 1]}}]], "morphs": [{}],
"handles": [{"type": "glue", "nodes": [1, 2]}, {"label": 3}, {"nodes": [0], "motion": 0}],
"magic": {"preserve_creases": true, "rib_stiffening": 2},"#,
        "",
        r#", "yield_stretch": 200, "weakening": 0}, {"data": "m.json", "toughness": 1"#,
    );
    let expected = [
        (1, 74, "motions[0][0].velocity.rotate", "keyframes with a spin"),
        (1, 102, "morphs", "morphs"),
        (2, 14, "handles[0].type", "glue handles"),
        (2, 49, "handles[1].label", "handles by label"),
        (3, 11, "magic.preserve_creases", "creases kept by remeshing"),
        (3, 37, "magic.rib_stiffening", "rib stiffening"),
        (5, 19, "cloths[0].materials[0].yield_stretch", "plasticity"),
        (5, 58, "cloths[0].materials[1]", "several materials on one cloth"),
    ]
    .map(|(line, column, path, what)| {
        format!("c/s.json:{line}:{column}: {path}: not supported yet: {what}")
    });
    complains(&text, &[], &expected.each_ref().map(String::as_str));

    let loaded = read(&text, &[], true).unwrap_or_else(|errors| panic!("{errors}"));
    let left_out = loaded.warnings.iter().filter(|w| w.kind == IssueKind::Unsupported).count();
    assert_eq!(left_out, 8);
    // The handle on nodes stays.
    assert_eq!(loaded.scene.handles.len(), 1);
    assert_eq!(loaded.scene.handles[0].select, Select::Vertices(vec![0]));
}

#[test]
fn complaints_use_arcsims_own_words_and_places() {
    let cases = [
        (
            with("\"frame_step\": 2,", "", ""),
            "1:36: frame_step: unknown key `frame_step`, did you mean `frame_steps`?",
        ),
        (with("\"frame_steps\": 0,", "", ""), "1:51: frame_steps: must be at least 1, got 0"),
        (
            with("\"disable\": [\"colision\"],", "", ""),
            "1:48: disable[0]: unknown part `colision`, did you mean `collision`?",
        ),
        (
            with("\"wind\": {\"speed\": 1},", "", ""),
            "1:45: wind.speed: unknown key `speed`, expected one of density, velocity, drag",
        ),
        (
            with("\"handles\": [{\"nodes\": [1], \"cloth\": 2}],", "", ""),
            "1:72: handles[0].cloth: there is no cloth 2, the scene has 1",
        ),
        (
            with("\"handles\": [{\"nodes\": [1], \"motion\": 2}],", "", ""),
            "1:73: handles[0].motion: there is no such motion, the scene has 0",
        ),
        (
            with("\"handles\": [{\"nodes\": []}],", "", ""),
            "1:58: handles[0].nodes: selects no vertex",
        ),
        (with("\"handles\": [{}],", "", ""), "1:48: handles[0]: key `nodes` is missing"),
        (
            with("\"handles\": [{\"type\": \"nod\"}],", "", ""),
            "1:57: handles[0].type: unknown kind of handle `nod`, did you mean `node`?",
        ),
        (
            with("\"handles\": [{\"nodes\": [1]}], \"magic\": {\"handle_stiffness\": -1},", "", ""),
            "1:95: magic.handle_stiffness: must be positive and finite, got -1",
        ),
        (
            with(
                "\"motions\": [[{\"time\": 1}, {\"time\": 0}]], \"handles\": [{\"nodes\": [1], \"motion\": 0}],",
                "",
                "",
            ),
            "1:71: motions[0][1].time: 0 s is not after the keyframe before, 1 s",
        ),
        (
            with(
                "\"motions\": [[{\"time\": 1, \"transform\": {\"rotate\": [9, 0, 0, 0]}}]], \"handles\": [{\"nodes\": [1], \"motion\": 0}],",
                "",
                "",
            ),
            "1:85: motions[0][0].transform.rotate: is zero, so it has no direction",
        ),
        (
            with("", "\"transform\": {\"translate\": [0, 0, 1e9]},", ""),
            "2:52: cloths[0].transform.translate[2]: 1e9 m is beyond the limit of 1e6 m",
        ),
        (
            with("", "\"remeshing\": {\"size\": [0.2, 0.1]},", ""),
            "2:40: cloths[0].remeshing.size: min 0.2 is above max 0.1",
        ),
        (
            with("", "\"remeshing\": {\"size\": [0, 0.1]},", ""),
            "2:41: cloths[0].remeshing.size[0]: must be positive and finite, got 0",
        ),
        (
            with("", "\"remeshing\": {},", ""),
            "2:31: cloths[0].remeshing: key `size` is missing: [min, max] edge length",
        ),
        (
            with("", "\"velocity\": {\"linear\": [1e9, 0, 0]},", ""),
            "2:42: cloths[0].velocity.linear[0]: 1e9 m/s is beyond the limit of 1e4 m/s",
        ),
        (
            with("", "", ", \"thicken\": -1"),
            "3:30: cloths[0].materials[0].thicken: must be positive and finite, got -1",
        ),
        (
            with("", "", ", \"strain_limits\": [2, 1]"),
            "3:36: cloths[0].materials[0].strain_limits: reversed: the smallest stretch 2 is above the largest 1",
        ),
        (
            with("", "", "").replace("m.json", "x.json"),
            "3:9: cloths[0].materials[0].data: there is no file `x.json` among those attached",
        ),
        (
            with("", "", "").replace("a.obj", "b.obj"),
            "2:9: cloths[0].mesh: there is no file `b.obj` among those attached",
        ),
        (
            with("", "", "").replace("0.1", "0"),
            "1:16: frame_time: must be positive and finite, got 0",
        ),
        (
            with("", "", "").replace(": 2,", ": 0,"),
            "1:33: end_time: asks for 0 frames, must be at least 1 and below 4e9",
        ),
    ];
    for (text, expected) in cases {
        complains(&text, &[], &[&format!("c/s.json:{expected}")]);
    }
    complains(
        &with("", "", ""),
        &["cloths[0].materials[0].thicken=-1", "organza.linear_tolerance=7"],
        &[
            "--set cloths[0].materials[0].thicken=-1: cloths[0].materials[0].thicken: must be positive and \
             finite, got -1",
            "--set organza.linear_tolerance=7: organza.linear_tolerance: 7e0 is beyond the limit of 1e-1",
        ],
    );
}

#[test]
fn files_are_found_from_the_working_directory_the_scene_and_above() {
    let folder = std::env::temp_dir().join(format!("organza-arcsim-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("conf")).unwrap();
    for Source { name, bytes } in attached() {
        std::fs::write(folder.join(name), bytes).unwrap();
    }
    let scene = folder.join("conf/s.json");
    std::fs::write(&scene, with("", "", "")).unwrap();
    let loaded = load(&scene, &LoadOptions::default()).unwrap_or_else(|errors| panic!("{errors}"));
    let names: Vec<&str> = loaded.sources[1..].iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["m.json", "a.obj"]);

    std::fs::remove_file(folder.join("a.obj")).unwrap();
    let errors = load(&scene, &LoadOptions::default()).unwrap_err().to_string();
    let line = errors.lines().find(|line| line.contains("cloths[0].mesh: ")).unwrap();
    for place in ["looked for a.obj, ", "conf/a.obj, "] {
        assert!(line.contains(place), "{line}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
