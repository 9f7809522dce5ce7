//! Scenes that cannot be read: each complaint must name the place and say what is wrong.

use organza::scene::{IssueKind, LoadOptions, from_sources, load, parse};

mod scene_help;
use scene_help::{attached, cloth_complains, complains, errors_of, scene_complains};
use scene_help::{whole_cloth_complains, with};

#[test]
fn the_base_of_these_tests_is_a_good_scene() {
    let options = LoadOptions::default();
    parse(with("", ""), "s.json5", &options, &from_sources(&attached())).unwrap();
}

#[test]
fn text_that_is_not_json5() {
    let empty = "the text ends where a value is expected; is the file empty or cut short?";
    for text in ["", "  \n", "// only a comment\n"] {
        let error = errors_of(text.as_bytes(), &[]).to_string();
        assert!(error.starts_with("s.json5:") && error.ends_with(empty), "{error}");
    }
    complains(
        "{frames: 1,\n  cloths: [",
        &[],
        &["s.json5:2:12: the text ends where a value is expected; is the file empty or cut short?"],
    );
    complains("{frames: 1\n cloths: []}", &[], &["s.json5:2:2: not JSON5: expected comma"]);
    complains("{frames = 1}", &[], &["s.json5:1:9: not JSON5: expected colon"]);
    complains("{frames: 1} x", &[], &["s.json5:1:13: not JSON5: trailing characters"]);
    complains("{frames: 1e, cloths: []}", &[], &["s.json5:1:10: invalid float literal"]);
    complains("{name: 'a\nb'}", &[], &["s.json5:1:10: not JSON5: line terminator in string"]);
    complains("{frames: 012}", &[], &["s.json5:1:10: not JSON5: leading zero"]);
    let error = errors_of(b"{\nname: '\xff\xfe'}", &[]).to_string();
    assert_eq!(error, "s.json5:2:8: not UTF-8 text: byte 0xff at offset 9");
}

#[test]
fn nesting_is_limited_and_never_overflows_the_stack() {
    for (open, n) in [("[", 65), ("[", 1_000_000), ("{a:", 65), ("{a:", 1_000_000)] {
        let error = errors_of(open.repeat(n).as_bytes(), &[]).to_string();
        assert!(error.contains("nested deeper than 64 levels"), "{error}");
    }
    // 64 levels are read, and are not a scene.
    let deep = format!("{}{}", "[".repeat(64), "]".repeat(64));
    complains(&deep, &[], &["s.json5:1:1: expected an object, got a list"]);
}

#[test]
fn numbers_that_are_not_finite_and_keys_given_twice() {
    complains(
        "{frames: 0, gravity: [NaN, 0, -Infinity],\n frames: 1, name: 1e999}",
        &[],
        &[
            "s.json5:1:23: gravity[0]: must be a finite number, got NaN",
            "s.json5:1:31: gravity[2]: must be a finite number, got -inf",
            "s.json5:2:2: frames: key `frames` is given twice",
            "s.json5:2:19: name: must be a finite number, got inf",
        ],
    );
}

#[test]
fn wrong_types() {
    complains("[1]", &[], &["s.json5:1:1: expected an object, got a list"]);
    complains("7", &[], &["s.json5:1:1: expected an object, got `7`"]);
    scene_complains(
        "substeps: '8',",
        "s.json5:1:23: substeps: expected a whole number of at least 0, got text \"8\"",
    );
    scene_complains(
        "substeps: 8.5,",
        "s.json5:1:23: substeps: expected a whole number of at least 0, got `8.5`",
    );
    scene_complains(
        "substeps: -8,",
        "s.json5:1:23: substeps: expected a whole number of at least 0, got `-8`",
    );
    scene_complains("gravity: -9.8,", "s.json5:1:22: gravity: expected a list of 3, got `-9.8`");
    scene_complains(
        "gravity: [0, -9.8],",
        "s.json5:1:22: gravity: expected a list of 3, got a list of 2",
    );
    scene_complains(
        "gravity: [0, 0, null],",
        "s.json5:1:29: gravity[2]: expected a number, got nothing (null)",
    );
    scene_complains("name: ['a'],", "s.json5:1:19: name: expected a text, got a list");
    scene_complains(
        "wind: [[1, 0, 0], 1, 0],",
        "s.json5:1:19: wind: expected an object, got a list",
    );
    scene_complains("wind: true,", "s.json5:1:19: wind: expected an object, got `true`");
    cloth_complains(
        "strain_limits: [0.9],",
        "s.json5:2:55: cloths[0].strain_limits: expected a list of 2, got a list of 1",
    );
    cloth_complains(
        "remeshing: {size_m: [0.1, 0.2]}",
        "s.json5:2:60: cloths[0].remeshing.size_m: expected an object, got a list",
    );
    whole_cloth_complains(
        "mesh: {obj: 'a.obj'}, fabric: 3",
        &[
            "s.json5:2:32: cloths[0].fabric: expected the name of a choice, or an object with one key, got `3`",
        ],
    );
}

#[test]
fn unknown_and_missing_keys() {
    scene_complains(
        "substep: 8,",
        "s.json5:1:13: substep: unknown key `substep`, did you mean `substeps`?",
    );
    cloth_complains(
        "densty: 1",
        "s.json5:2:40: cloths[0].densty: unknown key `densty`, expected one of name, mesh, transform, \
         fabric, panel_fabrics, thicken, multipliers, thickness_m, strain_limits, tension_field, bending, damping, \
         initial_velocity, initial_spin, remeshing, restraint",
    );
    cloth_complains(
        "damping: {stiffness: 1}",
        "s.json5:2:50: cloths[0].damping.stiffness: unknown key `stiffness`, did you mean `stiffness_s`?",
    );
    whole_cloth_complains(
        "mesh: {gird: {}}, fabric: 'swim'",
        &["s.json5:2:9: cloths[0].mesh.gird: unknown key `gird`, did you mean `grid`?"],
    );
    whole_cloth_complains(
        "mesh: {obj: 'a.obj'}, fabric: {custom: {density: 1, bending: 2, stretching_n_per_m: {warp: 1, weft: 1, \
         shear: 1}}}",
        &[
            "s.json5:2:42: cloths[0].fabric.custom.density: unknown key `density`, did you mean \
             `density_kg_per_m2`?",
            "s.json5:2:54: cloths[0].fabric.custom.bending: unknown key `bending`, did you mean \
             `bending_n_m`?",
        ],
    );
    // Everything of the wrong type is found at once, and nothing that follows from it.
    complains(
        "{frames: 1, gravity: [0, 'x', 0], wind: 3, newton: {tolerance: 'y', max_iterations: 1.5}, \n cloths: \
         [{mesh: {obj: 'a.obj'}, fabric: {swim: 1}}], substep: 1, handles: [{}]}",
        &[],
        &[
            "s.json5:1:26: gravity[1]: expected a number, got text \"x\"",
            "s.json5:1:41: wind: expected an object, got `3`",
            "s.json5:1:64: newton.tolerance: expected a number, got text \"y\"",
            "s.json5:1:85: newton.max_iterations: expected a whole number of at least 0, got `1.5`",
            "s.json5:2:49: cloths[0].fabric.swim: expected a name alone, without a value, got `1`",
            "s.json5:2:55: substep: unknown key `substep`, did you mean `substeps`?",
            "s.json5:2:77: handles[0]: key `select` is missing",
        ],
    );
    complains("{cloths: []}", &[], &["s.json5:1:1: key `frames` is missing"]);
    complains(
        "{frames: 1}",
        &[],
        &["s.json5:1:1: cloths: a scene needs at least one cloth or fluid"],
    );
    // A key may hold what would break a message.
    scene_complains(
        "'a`, expected `b': 1,",
        "s.json5:1:13: a`, expected `b: unknown key `a`, expected `b`, \
        expected one of $schema, name, frames, frames_per_second, substeps, gravity, wind, integrator, \
        newton, linear_solver, linear_tolerance, cloths, handles, obstacles, crowd, fluids, contact, camera, \
        shots, view, restraint, recording",
    );
}

#[test]
fn unknown_choices() {
    whole_cloth_complains(
        "mesh: {obj: 'a.obj'}, fabric: 'knit-hevy'",
        &[
            "s.json5:2:32: cloths[0].fabric: unknown choice `knit-hevy`, did you mean `knit-heavy`? (one of \
           woven-light, woven-firm, denim, knit-light, knit-interlock, knit-heavy, swim, measured, custom)",
        ],
    );
    for (fabric, got) in
        [("'measured'", "a name alone"), ("{measured: 'a', swim: null}", "an object")]
    {
        let cloth = format!("mesh: {{obj: 'a.obj'}}, fabric: {fabric}");
        let errors = errors_of(format!("{{frames: 1, cloths: [{{{cloth}}}]}}").as_bytes(), &[]);
        let error = errors.to_string();
        assert!(error.starts_with("s.json5:1:53: cloths[0].fabric"), "{error}");
        assert!(error.contains("an object with one key") && error.ends_with(got), "{error}");
    }
    scene_complains(
        "integrator: 'rk4',",
        "s.json5:1:25: integrator: unknown choice `rk4`, expected one of implicit-euler, sdirk2",
    );
    scene_complains(
        "linear_solver: 'cholesy',",
        "s.json5:1:28: linear_solver: unknown choice `cholesy`, did you mean `cholesky`? (one of auto, \
         cholesky, stale-cholesky, pcg)",
    );
    scene_complains(
        "handles: [{select: {corners: ['top']}}],",
        "s.json5:1:43: handles[0].select.corners[0]: unknown choice `top`, expected one of lower-left, \
         lower-right, upper-right, upper-left",
    );
}

#[test]
fn complaints_about_set_values_name_the_argument() {
    complains(
        &with("", "thicken: 2"),
        &["cloths[0].thicken=-1", "cloths[0].damping.mass_per_s=x", "substep=3"],
        &[
            "--set cloths[0].damping.mass_per_s=x: cloths[0].damping.mass_per_s: expected a number, got \
             text \"x\"",
            "--set substep=3: substep: unknown key `substep`, did you mean `substeps`?",
        ],
    );
    complains(
        &with("", ""),
        &["cloths[0].strain_limits=[2, 1]", "cloths[0].thicken=-1", "cloths[0].thicken=-2"],
        &[
            "--set cloths[0].strain_limits=[2, 1]: cloths[0].strain_limits: reversed: the smallest stretch 2 \
             is above the largest 1",
            "--set cloths[0].thicken=-2: cloths[0].thicken: must be positive and finite, got -2",
        ],
    );
    complains(
        &with("", ""),
        &["cloths[1].name=a", "frames.x=1"],
        &[
            "--set cloths[1].name=a: cloths[1].name: `cloths` has 1 elements, no element 1",
            "--set frames.x=1: frames.x: `frames` is a number, not an object",
        ],
    );
}

#[test]
fn what_is_not_supported_is_an_error_or_a_warning() {
    let text = with("cameras: [{}], morphs: true,", "plasticity: {yield: 1}");
    let errors = errors_of(text.as_bytes(), &[]);
    assert_eq!(
        errors.to_string(),
        "s.json5:1:13: cameras: not supported yet: several cameras\n\
         s.json5:1:28: morphs: not supported yet: morphs\n\
         s.json5:2:40: cloths[0].plasticity: not supported yet: plastic deformation\n\
         use --allow-unsupported to run without what is not supported yet"
    );
    let options = LoadOptions { allow_unsupported: true, ..LoadOptions::default() };
    let loaded = parse(&text, "s.json5", &options, &from_sources(&attached())).unwrap();
    assert_eq!(loaded.warnings, errors.issues());
    assert!(loaded.warnings.iter().all(|warning| warning.kind == IssueKind::Unsupported));

    // What is wrong stays wrong.
    let options = LoadOptions { sets: vec!["frames=0".to_owned()], ..options };
    let errors = parse(&text, "s.json5", &options, &from_sources(&attached())).unwrap_err();
    assert_eq!(errors.to_string(), "--set frames=0: frames: must be at least 1, got 0");
}

#[test]
fn very_long_and_very_many_mistakes_stay_readable_and_quick() {
    let long = "k".repeat(1_000_000);
    let error = errors_of(with(&format!("{long}: 1,"), "").as_bytes(), &[]).to_string();
    assert!(error.len() < 3000, "{} bytes", error.len());
    assert!(error.starts_with("s.json5:1:13: kkk") && error.contains('…'));

    let keys: String = (0..10_000).map(|i| format!("x{i}: 1,")).collect();
    let errors = errors_of(with(&keys, "").as_bytes(), &[]);
    assert_eq!(errors.issues().len(), 50);

    let cloth = "{mesh: {obj: 'a.obj'}, fabric: 'swim', thicken: 0, name: 'a'},\n";
    let text = format!("{{frames: 1, cloths: [{}]}}", cloth.repeat(1000));
    let errors = errors_of(text.as_bytes(), &[]);
    assert_eq!(errors.issues().len(), 51);
    // 999 names used before, and a thickness for each.
    assert_eq!(errors.issues()[50].to_string(), "s.json5: and 1949 more complaints");
    let text = format!("{{frames: 1, cloths: [{}]}}", cloth.repeat(10_001));
    complains(&text, &[], &["s.json5:1:21: cloths: has 10001 elements, beyond the limit of 10000"]);
}

#[test]
fn files_that_cannot_be_read() {
    let folder = std::env::temp_dir().join(format!("organza-bad-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let options = LoadOptions::default();
    let missing = folder.join("none.json5");
    let error = load(&missing, &options).unwrap_err().to_string();
    assert!(error.starts_with(&format!("{}: cannot be read: ", missing.display())), "{error}");
    let error = load(&folder, &options).unwrap_err().to_string();
    assert!(error.contains("cannot be read"), "{error}");

    let scene = folder.join("s.json5");
    std::fs::write(&scene, "{frames: 1, cloths: [{mesh: {obj: 'no/a.obj'}, fabric: 'swim'}]}")
        .unwrap();
    let error = load(&scene, &options).unwrap_err().to_string();
    let (scene, wanted) = (scene.display(), folder.join("no/a.obj"));
    assert_eq!(
        error,
        format!(
            "{scene}:1:35: cloths[0].mesh.obj: there is no file `no/a.obj` (looked for {})",
            wanted.display()
        )
    );
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn any_cut_of_a_scene_gives_an_error_and_no_panic() {
    let text = include_str!("../../../scenes/flag.json5");
    let options = LoadOptions::default();
    for cut in (0..text.len()).filter(|cut| text.is_char_boundary(*cut)) {
        let part = &text[..cut];
        // Only what follows the last brace may be missing.
        let whole = text[cut..].trim().is_empty();
        let result = parse(part, "s.json5", &options, &from_sources(&[]));
        assert_eq!(result.is_ok(), whole, "cut at {cut}");
    }
    // Bytes replaced one at a time: any outcome but a panic or an empty error.
    for at in 0..text.len() {
        for byte in [b'}', b'[', b'"', b'-', b'9', 0xff] {
            let mut bytes = text.as_bytes().to_vec();
            bytes[at] = byte;
            if let Err(errors) = parse(&bytes, "s.json5", &options, &from_sources(&[])) {
                assert!(!errors.issues().is_empty());
            }
        }
    }
}
