//! Scenes with values out of range: each complaint must name the place and the numbers.

mod scene_help;
use scene_help::{cloth_complains, complains, scene_complains, whole_cloth_complains, with};

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
            "s.json5:3:75: cloths: a scene needs at least one cloth or fluid",
        ],
    );
    complains(
        &with("substeps: 1000000,", ""),
        &["frames=2000"],
        &[
            "--set frames=2000: frames: 2000 frames of 1000000 substeps: 2e9 steps is beyond the limit of \
           1e9 steps",
        ],
    );
    scene_complains(
        "frames_per_second: 1e-9,",
        "s.json5:1:32: frames_per_second: 1e-9 1/s is below the limit of 1e-6 1/s",
    );
}

#[test]
fn gravity_wind_camera() {
    scene_complains(
        "gravity: [0, 0, -1e5],",
        "s.json5:1:29: gravity[2]: -1e5 m/s² is beyond the limit of 1e4 m/s²",
    );
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
    let none = "must have exactly one of obj, grid, disc, tube, skirt, tunic, poncho, garment; has";
    whole_cloth_complains(
        "mesh: {}, fabric: 'swim'",
        &[&format!("s.json5:2:8: cloths[0].mesh: {none} 0")],
    );
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
        &[
            "s.json5:2:39: cloths[0].mesh.grid.cells: 2e8 triangles is beyond the limit of 4e6 triangles",
        ],
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
        "mesh: {tunic: {width_m: 0.6, length_m: 0.8, armhole_m: 0.9, neck_width_m: 0.7,\n \
         neck_depth_m: [0.5, -1], sleeve_m: 0, cell_m: 1e-9}}, fabric: 'swim'",
        &[
            "s.json5:2:57: cloths[0].mesh.tunic.armhole_m: 0.9 m is not below the length of the \
             garment, 0.8 m",
            "s.json5:2:76: cloths[0].mesh.tunic.neck_width_m: 0.7 m is not below the width of the \
             garment, 0.6 m",
            "s.json5:3:17: cloths[0].mesh.tunic.neck_depth_m[0]: must lie between 0 and half of the \
             length, got 0.5",
            "s.json5:3:22: cloths[0].mesh.tunic.neck_depth_m[1]: must lie between 0 and half of the \
             length, got -1",
            "s.json5:3:37: cloths[0].mesh.tunic.sleeve_m: must be positive and finite, got 0",
            "s.json5:3:48: cloths[0].mesh.tunic.cell_m: 1e-9 m is below the limit of 1e-6 m",
        ],
    );
    whole_cloth_complains(
        "mesh: {tunic: {width_m: 0.6, hem_width: 0.7}}, fabric: 'swim'",
        &[
            "s.json5:2:16: cloths[0].mesh.tunic: key `length_m` is missing",
            "s.json5:2:31: cloths[0].mesh.tunic.hem_width: unknown key `hem_width`, did you mean \
             `hem_width_m`?",
        ],
    );
    whole_cloth_complains(
        "mesh: {poncho: {width_m: 1, length_m: -1, neck_width_m: 1, cell_m: 0.1}}, fabric: 'swim'",
        &[
            "s.json5:2:40: cloths[0].mesh.poncho.length_m: must be positive and finite, got -1",
            "s.json5:2:58: cloths[0].mesh.poncho.neck_width_m: 1 m is not below the width of the \
             garment, 1 m",
        ],
    );
    whole_cloth_complains(
        "mesh: {grid: {size_m: [1e5, 1], cells: [1, 1]}}, transform: {scale: 100}, fabric: 'swim'",
        &[
            "s.json5:2:70: cloths[0].transform.scale: the cloth as scaled: 1e7 m is beyond the limit of 1e6 m",
        ],
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
        &[
            "s.json5:4:15: cloths[0].fabric.custom.bending_n_m: some stiffness is zero: give all three, or \
           zero for all three",
        ],
    );
    for (cloth, expected) in cases {
        whole_cloth_complains(&cloth, &[&format!("s.json5:{expected}")]);
    }
    cloth_complains(
        "thicken: 0",
        "s.json5:2:49: cloths[0].thicken: must be positive and finite, got 0",
    );
    cloth_complains(
        "multipliers: {bending: 1e9}",
        "s.json5:2:63: cloths[0].multipliers.bending: must lie between 1/1e6 and 1e6, got 1e9",
    );
    whole_cloth_complains(
        &format!("thicken: 100, {}", custom("0.2", "warp: 1e11, weft: 1e3, shear: 1", bending)),
        &[
            "s.json5:2:11: cloths[0].thicken: 100000000000 times 100: 1e13 N/m is beyond the limit of 1e12 N/m",
        ],
    );
}

#[test]
fn files_with_measurements() {
    let cases = [
        (
            "none.json",
            "s.json5:2:43: cloths[0].fabric.measured: there is no file `none.json` among those attached",
        ),
        ("light.json", "light.json:2:12: density: must be positive and finite, got -0.2"),
        ("short.json", "short.json:3:15: stretching: expected a list of 6, got a list of 1"),
        ("narrow.json", "narrow.json:4:13: bending[0]: expected a list of 5, got a list of 2"),
        ("nan.json", "nan.json:3:26: stretching[0][3]: must be a finite number, got NaN"),
        (
            "stiff.json",
            "stiff.json:3:17: stretching[0][0]: 1e13 N/m is beyond the limit of 1e12 N/m",
        ),
        ("cut.json", "cut.json:1:17: not JSON5: the text ends while parsing object"),
        ("typo.json", "typo.json:2:1: densty: unknown key `densty`, did you mean `density`?"),
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
        &with(
            "",
            "remeshing: {size_m: {min: 0, max: 0.1}, refine_angle: -1, aspect_min: 1,\n \
            hysteresis: -1, max_vertices: 2}",
        ),
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
    handles(
        "{cloth: 1, select: 'all'}",
        "s.json5:2:9: handles[0].cloth: there is no cloth 1, the scene has 1",
    );
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
