//! Bad scenes: each complaint must name the place and say what is wrong, with the numbers.

use organza::scene::{IssueKind, LoadOptions, SceneErrors, Source, from_sources, load, parse};

/// Files that scenes of these tests may name.
fn attached() -> Vec<Source> {
    let row = "[9, 1, 9, 3]";
    let good_rows = [row; 6].join(", ");
    let bend = "[1e-5, 1e-5, 1e-5, 1e-5, 1e-5]";
    let material = |density: &str, stretching: &str, bending: &str| {
        format!("{{\n\"density\": {density},\n\"stretching\": [{stretching}],\n\"bending\": [{bending}]\n}}")
    };
    let good_bend = [bend; 3].join(", ");
    [
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_owned()),
        ("good.json", material("0.2", &good_rows, &good_bend)),
        ("light.json", material("-0.2", &good_rows, &good_bend)),
        ("short.json", material("0.2", row, &good_bend)),
        ("narrow.json", material("0.2", &good_rows, "[1, 2], [1, 2], [1, 2]")),
        ("nan.json", material("0.2", &good_rows.replacen('3', "NaN", 1), &good_bend)),
        ("stiff.json", material("0.2", &good_rows.replacen('9', "1e13", 1), &good_bend)),
        ("typo.json", material("0.2", &good_rows, &good_bend).replace("density", "densty")),
        ("cut.json", "{\"density\": 0.2,".to_owned()),
    ]
    .into_iter()
    .map(|(name, text)| Source { name: name.to_owned(), bytes: text.into_bytes() })
    .collect()
}

fn errors_of(text: &[u8], sets: &[&str]) -> SceneErrors {
    let options = LoadOptions {
        sets: sets.iter().map(|set| (*set).to_owned()).collect(),
        allow_unsupported: false,
    };
    match parse(text, "s.json5", &options, &from_sources(&attached())) {
        Ok(loaded) => panic!("{:?} is accepted: {:?}", String::from_utf8_lossy(text), loaded.scene),
        Err(errors) => errors,
    }
}

/// Asserts that the complaints are exactly these lines.
#[track_caller]
fn complains(text: &str, sets: &[&str], expected: &[&str]) {
    let errors = errors_of(text.as_bytes(), sets);
    let got: Vec<String> = errors.issues().iter().map(ToString::to_string).collect();
    assert_eq!(got, expected, "\nscene: {text}\nsets: {sets:?}");
}

/// Line 1: the scene with `scene` added; line 2: its cloth with `cloth` added.
fn with(scene: &str, cloth: &str) -> String {
    format!("{{frames: 2, {scene} cloths: [\n{{mesh: {{obj: 'a.obj'}}, fabric: 'swim', {cloth}}}]}}")
}

#[track_caller]
fn scene_complains(scene: &str, expected: &str) {
    complains(&with(scene, ""), &[], &expected.split('\n').collect::<Vec<_>>());
}

#[track_caller]
fn cloth_complains(cloth: &str, expected: &str) {
    complains(&with("", cloth), &[], &[expected]);
}

/// A scene whose only cloth is all of `cloth`.
#[track_caller]
fn whole_cloth_complains(cloth: &str, expected: &[&str]) {
    complains(&format!("{{frames: 1, cloths: [\n{{{cloth}}}]}}"), &[], expected);
}

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
    complains("{frames: 1,\n  cloths: [", &[], &["s.json5:2:12: the text ends where a value is expected; is the file empty or cut short?"]);
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
    scene_complains("substeps: '8',", "s.json5:1:23: substeps: expected a whole number of at least 0, got text \"8\"");
    scene_complains("substeps: 8.5,", "s.json5:1:23: substeps: expected a whole number of at least 0, got `8.5`");
    scene_complains("substeps: -8,", "s.json5:1:23: substeps: expected a whole number of at least 0, got `-8`");
    scene_complains("gravity: -9.8,", "s.json5:1:22: gravity: expected a list of 3, got `-9.8`");
    scene_complains("gravity: [0, -9.8],", "s.json5:1:22: gravity: expected a list of 3, got a list of 2");
    scene_complains("gravity: [0, 0, null],", "s.json5:1:29: gravity[2]: expected a number, got nothing (null)");
    scene_complains("name: ['a'],", "s.json5:1:19: name: expected a text, got a list");
    scene_complains("wind: [[1, 0, 0], 1, 0],", "s.json5:1:19: wind: expected an object, got a list");
    scene_complains("wind: true,", "s.json5:1:19: wind: expected an object, got `true`");
    cloth_complains("strain_limits: [0.9],", "s.json5:2:55: cloths[0].strain_limits: expected a list of 2, got a list of 1");
    cloth_complains(
        "remeshing: {size_m: [0.1, 0.2]}",
        "s.json5:2:60: cloths[0].remeshing.size_m: expected an object, got a list",
    );
    whole_cloth_complains(
        "mesh: {obj: 'a.obj'}, fabric: 3",
        &["s.json5:2:32: cloths[0].fabric: expected the name of a choice, or an object with one key, got `3`"],
    );
}

#[test]
fn unknown_and_missing_keys() {
    scene_complains("substep: 8,", "s.json5:1:13: substep: unknown key `substep`, did you mean `substeps`?");
    cloth_complains(
        "densty: 1",
        "s.json5:2:40: cloths[0].densty: unknown key `densty`, expected one of name, mesh, transform, \
         fabric, thicken, multipliers, strain_limits, bending, damping, initial_velocity, \
         initial_spin, remeshing",
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
            "s.json5:2:49: cloths[0].fabric.swim: expected a name alone, without a value",
            "s.json5:2:55: substep: unknown key `substep`, did you mean `substeps`?",
            "s.json5:2:77: handles[0]: key `select` is missing",
        ],
    );
    complains("{cloths: []}", &[], &["s.json5:1:1: key `frames` is missing"]);
    complains("{frames: 1}", &[], &["s.json5:1:1: key `cloths` is missing"]);
    // A key may hold what would break a message.
    scene_complains("'a`, expected `b': 1,", "s.json5:1:13: a`, expected `b: unknown key `a`, expected `b`, \
        expected one of $schema, name, frames, frames_per_second, substeps, gravity, wind, integrator, \
        newton, linear_solver, linear_tolerance, cloths, handles, camera, recording");
}

#[test]
fn unknown_choices() {
    whole_cloth_complains(
        "mesh: {obj: 'a.obj'}, fabric: 'knit-hevy'",
        &["s.json5:2:32: cloths[0].fabric: unknown choice `knit-hevy`, did you mean `knit-heavy`? (one of \
           woven-light, woven-firm, denim, knit-light, knit-interlock, knit-heavy, swim, measured, custom)"],
    );
    for (fabric, got) in [("'measured'", "a name alone"), ("{measured: 'a', swim: null}", "an object")] {
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
fn time_and_solver() {
    complains(
        "{frames: 0, substeps: 0, frames_per_second: 0,\n recording: {checkpoint_every_frames: 0},\n \
         newton: {max_iterations: 0, tolerance: -1}, linear_tolerance: 1, cloths: []}",
        &[],
        &[
            "s.json5:1:10: frames: must be at least 1, got 0",
            "s.json5:1:23: substeps: must be at least 1, got 0",
            "s.json5:1:45: frames_per_second: must be positive and finite, got 0",
            "s.json5:2:39: recording.checkpoint_every_frames: must be at least 1, got 0",
            "s.json5:3:27: newton.max_iterations: must be at least 1, got 0",
            "s.json5:3:41: newton.tolerance: must be positive and finite, got -1",
            "s.json5:3:64: linear_tolerance: 1e0 is beyond the limit of 1e-1",
            "s.json5:3:75: cloths: a scene needs at least one cloth",
        ],
    );
    complains(
        &with("substeps: 1000000,", ""),
        &["frames=2000"],
        &["--set frames=2000: frames: 2000 frames of 1000000 substeps: 2e9 steps is beyond the limit of \
           1e9 steps"],
    );
    scene_complains(
        "frames_per_second: 1e-9,",
        "s.json5:1:32: frames_per_second: 1e-9 1/s is below the limit of 1e-6 1/s",
    );
}

#[test]
fn gravity_wind_camera() {
    scene_complains("gravity: [0, 0, -1e5],", "s.json5:1:29: gravity[2]: -1e5 m/s² is beyond the limit of 1e4 m/s²");
    scene_complains(
        "wind: {velocity: [1, 0, 0], density: -1},",
        "s.json5:1:50: wind.density: must be zero or more and finite, got -1",
    );
    scene_complains(
        "wind: {velocity: [1e7, 0, 0]},",
        "s.json5:1:31: wind.velocity[0]: 1e7 m/s is beyond the limit of 1e4 m/s",
    );
    scene_complains(
        "camera: {position: [1, 1, 1], target: [1, 1, 1]},",
        "s.json5:1:51: camera.target: is where the camera stands",
    );
    scene_complains(
        "camera: {position: [1, 1, 1], target: [1, 1, 0]},",
        "s.json5:1:21: camera.up: is parallel to the direction of view or zero; give an `up` across the view",
    );
    scene_complains(
        "camera: {position: [1, 1, 1], target: [0, 1, 1], vertical_fov_deg: 180},",
        "s.json5:1:80: camera.vertical_fov_deg: must lie between 1 and 170, got 180",
    );
    scene_complains(
        "camera: {position: [1, 1, 1], target: [0, 1, 1], resolution: [100000, 0]},",
        "s.json5:1:75: camera.resolution[0]: 1e5 pixels is beyond the limit of 1.6384e4 pixels\n\
         s.json5:1:83: camera.resolution[1]: must be at least 1, got 0",
    );
}

#[test]
fn meshes() {
    let none = "must have exactly one of obj, grid, disc, tube, skirt; has";
    whole_cloth_complains("mesh: {}, fabric: 'swim'", &[&format!("s.json5:2:8: cloths[0].mesh: {none} 0")]);
    whole_cloth_complains(
        "mesh: {obj: 'a.obj', disc: {radius_m: 1, rings: 1}}, fabric: 'swim'",
        &[&format!("s.json5:2:8: cloths[0].mesh: {none} 2")],
    );
    whole_cloth_complains(
        "mesh: {obj: 'b.obj'}, fabric: 'swim'",
        &["s.json5:2:14: cloths[0].mesh.obj: there is no file `b.obj` among those attached"],
    );
    whole_cloth_complains(
        "mesh: {material_obj: 'a.obj', disc: {radius_m: 1, rings: 1}}, fabric: 'swim'",
        &["s.json5:2:23: cloths[0].mesh.material_obj: needs `obj`, whose flat pattern it is"],
    );
    whole_cloth_complains(
        "mesh: {grid: {size_m: [0, -1], cells: [0, 2]}}, fabric: 'swim'",
        &[
            "s.json5:2:25: cloths[0].mesh.grid.size_m[0]: must be positive and finite, got 0",
            "s.json5:2:28: cloths[0].mesh.grid.size_m[1]: must be positive and finite, got -1",
            "s.json5:2:41: cloths[0].mesh.grid.cells[0]: must be at least 1, got 0",
        ],
    );
    whole_cloth_complains(
        "mesh: {grid: {size_m: [1, 1], cells: [10000, 10000]}}, fabric: 'swim'",
        &["s.json5:2:39: cloths[0].mesh.grid.cells: 2e8 triangles is beyond the limit of 4e6 triangles"],
    );
    whole_cloth_complains(
        "mesh: {disc: {radius_m: 1e7, rings: 4000000000}}, fabric: 'swim'",
        &[
            "s.json5:2:26: cloths[0].mesh.disc.radius_m: 1e7 m is beyond the limit of 1e6 m",
            "s.json5:2:38: cloths[0].mesh.disc.rings: 9.6e19 triangles is beyond the limit of 4e6 triangles",
        ],
    );
    whole_cloth_complains(
        "mesh: {tube: {radius_m: 1, length_m: 0, segments: [2, 1]}}, fabric: 'swim'",
        &[
            "s.json5:2:39: cloths[0].mesh.tube.length_m: must be positive and finite, got 0",
            "s.json5:2:53: cloths[0].mesh.tube.segments[0]: must be at least 3, got 2",
        ],
    );
    whole_cloth_complains(
        "mesh: {skirt: {waist_m: 0.7, hem_m: 7, length_m: 1e-9, cells: [4, 4]}}, fabric: 'swim'",
        &[
            "s.json5:2:51: cloths[0].mesh.skirt.length_m: 1e-9 m is below the limit of 1e-6 m",
            "s.json5:2:51: cloths[0].mesh.skirt.length_m: 0.000000001 m is too short for hem 7 m and waist \
             0.7 m: their radii differ by 1.0026761414789407 m",
        ],
    );
    whole_cloth_complains(
        "mesh: {grid: {size_m: [1e5, 1], cells: [1, 1]}}, transform: {scale: 100}, fabric: 'swim'",
        &["s.json5:2:70: cloths[0].transform.scale: the cloth as scaled: 1e7 m is beyond the limit of 1e6 m"],
    );
}

#[test]
fn transforms() {
    cloth_complains(
        "transform: {scale: 0}",
        "s.json5:2:59: cloths[0].transform.scale: must be positive and finite, got 0",
    );
    cloth_complains(
        "transform: {translate: [0, 1e7, 0]}",
        "s.json5:2:67: cloths[0].transform.translate[1]: 1e7 m is beyond the limit of 1e6 m",
    );
    cloth_complains(
        "transform: {rotate: {axis: [0, 0, 0], degrees: 5}}",
        "s.json5:2:67: cloths[0].transform.rotate.axis: is zero, so it has no direction",
    );
}

/// A cloth with a custom fabric; the numbers start in line 2, column 42.
fn custom(density: &str, stretching: &str, bending: &str) -> String {
    format!(
        "mesh: {{obj: 'a.obj'}}, fabric: {{custom: {{density_kg_per_m2: {density},\n stretching_n_per_m: \
         {{{stretching}}},\n bending_n_m: {{{bending}}}}}}}"
    )
}

#[test]
fn fabrics() {
    let stretching = "warp: 100, weft: 200, coupling: 20, shear: 50";
    let bending = "warp: 1e-5, weft: 2e-5, bias: 1e-5";
    let cases = [
        (
            custom("-0.2", stretching, bending),
            "2:61: cloths[0].fabric.custom.density_kg_per_m2: must be positive and finite, got -0.2",
        ),
        (
            custom("1e9", stretching, bending),
            "2:61: cloths[0].fabric.custom.density_kg_per_m2: 1e9 kg/m² is beyond the limit of 1e4 kg/m²",
        ),
        (
            custom("0.2", "warp: 1e15, weft: 200, shear: 50", bending),
            "3:29: cloths[0].fabric.custom.stretching_n_per_m.warp: 1e15 N/m is beyond the limit of 1e12 N/m",
        ),
        (
            custom("0.2", "warp: 100, weft: 0, shear: 50", bending),
            "3:40: cloths[0].fabric.custom.stretching_n_per_m.weft: must be positive and finite, got 0",
        ),
        (
            custom("0.2", "warp: 100, weft: 400, coupling: -200, shear: 50", bending),
            "3:55: cloths[0].fabric.custom.stretching_n_per_m.coupling: -200 makes the energy negative for \
             some strain: must be smaller in size than √(warp · weft) = 200 N/m",
        ),
        (
            custom("0.2", stretching, "warp: -1e-5, weft: 1, bias: 1"),
            "4:22: cloths[0].fabric.custom.bending_n_m.warp: must be zero or more and finite, got -0.00001",
        ),
    ];
    whole_cloth_complains(
        &custom("0.2", stretching, "warp: 1e-5, weft: 0, bias: 0"),
        &["s.json5:4:15: cloths[0].fabric.custom.bending_n_m: some stiffness is zero: give all three, or \
           zero for all three"],
    );
    for (cloth, expected) in cases {
        whole_cloth_complains(&cloth, &[&format!("s.json5:{expected}")]);
    }
    cloth_complains("thicken: 0", "s.json5:2:49: cloths[0].thicken: must be positive and finite, got 0");
    cloth_complains(
        "multipliers: {bending: 1e9}",
        "s.json5:2:63: cloths[0].multipliers.bending: must lie between 1/1e6 and 1e6, got 1e9",
    );
    whole_cloth_complains(
        &format!("thicken: 100, {}", custom("0.2", "warp: 1e11, weft: 1e3, shear: 1", bending)),
        &["s.json5:2:11: cloths[0].thicken: 100000000000 times 100: 1e13 N/m is beyond the limit of 1e12 N/m"],
    );
}

#[test]
fn files_with_measurements() {
    let cases = [
        ("none.json", "s.json5:2:43: cloths[0].fabric.measured: there is no file `none.json` among those attached"),
        ("light.json", "light.json:2:12: density: must be positive and finite, got -0.2"),
        ("short.json", "short.json:3:15: stretching: expected a list of 6, got a list of 1"),
        ("narrow.json", "narrow.json:4:13: bending[0]: expected a list of 5, got a list of 2"),
        ("nan.json", "nan.json:3:26: stretching[0][3]: must be a finite number, got NaN"),
        ("stiff.json", "stiff.json:3:17: stretching[0][0]: 1e13 N/m is beyond the limit of 1e12 N/m"),
        ("cut.json", "cut.json:1:17: not JSON5: the text ends while parsing object"),
        (
            "typo.json",
            "typo.json:2:1: densty: unknown key `densty`, did you mean `density`?",
        ),
    ];
    for (file, expected) in cases {
        let cloth = format!("mesh: {{obj: 'a.obj'}}, fabric: {{measured: '{file}'}}");
        whole_cloth_complains(&cloth, &expected.split('\n').collect::<Vec<_>>());
    }
}

#[test]
fn cloth_limits_and_remeshing() {
    cloth_complains(
        "strain_limits: [1.05, 0.95]",
        "s.json5:2:55: cloths[0].strain_limits: reversed: the smallest stretch 1.05 is above the largest 0.95",
    );
    cloth_complains(
        "strain_limits: [1.1, 1.2]",
        "s.json5:2:55: cloths[0].strain_limits: must lie below and above the rest state 1, got [1.1, 1.2]",
    );
    cloth_complains(
        "damping: {mass_per_s: -1}",
        "s.json5:2:62: cloths[0].damping.mass_per_s: must be zero or more and finite, got -1",
    );
    cloth_complains(
        "initial_velocity: [0, 1e9, 0]",
        "s.json5:2:62: cloths[0].initial_velocity[1]: 1e9 m/s is beyond the limit of 1e4 m/s",
    );
    cloth_complains(
        "initial_spin: {angular_velocity: [0, 0, 1e9]}",
        "s.json5:2:80: cloths[0].initial_spin.angular_velocity[2]: 1e9 rad/s is beyond the limit of 1e4 rad/s",
    );
    cloth_complains(
        "remeshing: {size_m: {min: 0.2, max: 0.1}}",
        "s.json5:2:60: cloths[0].remeshing.size_m: min 0.2 is above max 0.1",
    );
    complains(
        &with("", "remeshing: {size_m: {min: 0, max: 0.1}, refine_angle: -1, aspect_min: 1,\n \
            hysteresis: -1, max_vertices: 2}"),
        &[],
        &[
            "s.json5:2:66: cloths[0].remeshing.size_m.min: must be positive and finite, got 0",
            "s.json5:2:94: cloths[0].remeshing.refine_angle: must be positive and finite, got -1",
            "s.json5:2:110: cloths[0].remeshing.aspect_min: must lie between 0.001 and 0.5, got 1",
            "s.json5:3:14: cloths[0].remeshing.hysteresis: must be at least 0 and below 1, got -1",
            "s.json5:3:32: cloths[0].remeshing.max_vertices: must be at least 3, got 2",
        ],
    );
}

#[test]
fn names_and_handles() {
    let cloth = "{mesh: {obj: 'a.obj'}, fabric: 'swim', name: 'flag'}";
    complains(
        &format!("{{frames: 1, cloths: [{cloth},\n{cloth}]}}"),
        &[],
        &["s.json5:2:46: cloths[1].name: `flag` is the name of cloths[0] already"],
    );
    let handles = |handles: &str, expected: &str| {
        let text = format!("{{frames: 1, cloths: [{cloth}], handles: [\n{handles}]}}");
        complains(&text, &[], &expected.split('\n').collect::<Vec<_>>());
    };
    handles(
        "{cloth: 'falg', select: 'all'}",
        "s.json5:2:9: handles[0].cloth: there is no cloth `falg`, did you mean `flag`?",
    );
    handles("{cloth: 1, select: 'all'}", "s.json5:2:9: handles[0].cloth: there is no cloth 1, the scene has 1");
    handles(
        "{cloth: -1, select: 'all'}",
        "s.json5:2:9: handles[0].cloth: expected the name or the number of a cloth, got `-1`",
    );
    handles("{select: {vertices: []}}", "s.json5:2:10: handles[0].select: selects no vertex");
    handles(
        "{select: {box: {min: [0, 1], max: [1, 0]}}}",
        "s.json5:2:16: handles[0].select.box: v: min 1 is above max 0",
    );
    handles(
        "{select: 'all', start_s: 2, end_s: 1}",
        "s.json5:2:36: handles[0].end_s: 1 s is not after the start at 2 s",
    );
    handles(
        "{select: 'all', stiffness_n_per_m: 1e13}",
        "s.json5:2:36: handles[0].stiffness_n_per_m: 1e13 N/m is beyond the limit of 1e12 N/m",
    );
    handles(
        "{select: 'all', motion: {keyframes: []}}",
        "s.json5:2:37: handles[0].motion.keyframes: a motion needs at least one keyframe",
    );
    handles(
        "{select: 'all', motion: {keyframes: [{time_s: 1}, {time_s: 1, transform: {scale: -1}}]}}",
        "s.json5:2:60: handles[0].motion.keyframes[1].time_s: 1 s is not after the keyframe before, 1 s\n\
         s.json5:2:82: handles[0].motion.keyframes[1].transform.scale: must be positive and finite, got -1",
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
    let text = with(
        "obstacles: [{}], self_contact: true, fluid: null, friction: false,",
        "plasticity: {yield: 1}",
    );
    let errors = errors_of(text.as_bytes(), &[]);
    assert_eq!(
        errors.to_string(),
        "s.json5:1:13: obstacles: not supported yet: obstacles\n\
         s.json5:1:30: self_contact: not supported yet: contact of cloth with itself\n\
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
    std::fs::write(&scene, "{frames: 1, cloths: [{mesh: {obj: 'no/a.obj'}, fabric: 'swim'}]}").unwrap();
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
