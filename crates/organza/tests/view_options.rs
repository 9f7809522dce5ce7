//! What a scene may say of views beyond one camera: occlusion, more cameras, cameras from glTF files.

use base64::Engine;
use mesh_core::World3;
use organza::report::FrameReport;
use organza::scene::{LoadOptions, Loaded, Source, from_sources, parse};
use organza::world::World;

/// A sheet of a square metre in the plane z = 0 that is meshed at 40 mm where nothing else is wanted.
fn scene(extra: &str, sources: &[Source]) -> Result<Loaded, String> {
    let text = format!(
        "{{frames: 10, frames_per_second: 25, substeps: 1, gravity: [0, 0, 0], {extra}
          cloths: [{{fabric: 'denim', mesh: {{grid: {{size_m: [1, 1], cells: [8, 8]}}}},
                     remeshing: {{size_m: {{min: 0.01, max: 0.04}}}}}}]}}"
    );
    parse(text, "s", &LoadOptions::default(), &from_sources(sources)).map_err(|e| e.to_string())
}

fn run(extra: &str, frames: usize) -> (World, FrameReport) {
    let mut world = World::new(&scene(extra, &[]).unwrap()).unwrap();
    let reports: Vec<_> = (0..frames).map(|_| world.advance().unwrap()).collect();
    (world, reports.into_iter().last().unwrap())
}

const OVER: &str = "camera: {position: [0.5, 0.5, 1.5], target: [0.5, 0.5, 0], up: [0, 1, 0]},";
const AWAY: &str = "camera: {position: [0.5, 0.5, 1.5], target: [0.5, 0.5, 9], up: [0, 1, 0]},";
/// Between camera and sheet, over the half of the sheet where x is smaller.
const LID: &str = "obstacles: [{mesh: {box: {size_m: [1, 2, 0.02]}},
                                transform: {translate: [0, 0.5, 0.2]}}],";

#[test]
fn cloth_behind_a_body_is_coarse() {
    let (_, open) = run(&format!("{OVER} {LID} view: {{}},"), 3);
    let view = open.view.unwrap();
    assert_eq!((view.visible, view.mean_factor), (open.faces, 1.0));

    let (world, hidden) = run(&format!("{OVER} {LID} view: {{occlusion: true}},"), 3);
    let view = hidden.view.unwrap();
    assert!(view.mean_factor < 0.95 && hidden.faces * 10 < open.faces * 8, "{hidden:?}");
    // What is seen is as fine as ever, what is hidden is not.
    let longest = |hidden: bool| {
        let mesh = &world.cloth.mesh;
        let middle =
            |h| (world.cloth.x[mesh.origin(h).index()] + world.cloth.x[mesh.dest(h).index()]) * 0.5;
        // The edge of the lid hides up to x = 0.5 · 1.5/1.3.
        let of =
            mesh.edges().filter(|&h| if hidden { middle(h).x < 0.4 } else { middle(h).x > 0.65 });
        of.map(|h| mesh.material_edge(h).norm()).fold(0.0, f64::max)
    };
    assert!(longest(false) < 0.04 * (1.0 + 1e-9) && longest(true) > 0.08);

    // Without anything in the way it changes nothing, to the bit.
    let (plain, _) = run(&format!("{OVER} view: {{}},"), 3);
    let (same, _) = run(&format!("{OVER} view: {{occlusion: true}},"), 3);
    assert_eq!(plain.cloth, same.cloth);
}

#[test]
fn a_camera_that_is_guessed_knows_its_past_alone() {
    // One that stands still holds no surprise.
    let (known, _) = run(&format!("{OVER} view: {{}},"), 3);
    let (guessed, _) = run(&format!("{OVER} view: {{predicted: true}},"), 3);
    assert_eq!(known.cloth, guessed.cloth);

    // Neither is a cut foreseen, at 0.16 s, nor missed afterwards.
    let cut = "camera: {position: [0.5, 0.5, 1.5], target: [0.5, 0.5, 9], up: [0, 1, 0]}, shots: [
        {keyframes: [{time_s: 0, position: [0.5, 0.5, 1.5], target: [0.5, 0.5, 9], up: [0, 1, 0]}]},
        {start_s: 0.16, keyframes:
            [{time_s: 0.16, position: [0.5, 0.5, 1.5], target: [0.5, 0.5, 0], up: [0, 1, 0]}]}],";
    let factor = |extra: &str, frames: usize| {
        run(&format!("{cut} {extra}"), frames).1.view.unwrap().mean_factor
    };
    let guess = "view: {predicted: true},";
    assert!(factor("view: {},", 3) > 0.7, "{}", factor("view: {},", 3));
    assert!(factor(guess, 3) < 0.05, "{}", factor(guess, 3));
    assert_eq!(factor(guess, 4), 1.0);
}

#[test]
fn of_several_cameras_the_finest_wins() {
    let (over, _) = run(&format!("{OVER} view: {{}},"), 3);
    let more = format!("cameras: [{{{OVER}}}]");
    let (both, report) = run(&format!("{AWAY} view: {{{more}}},"), 3);
    assert_eq!(report.view.unwrap().visible, report.faces);
    assert_eq!(both.cloth, over.cloth);
    // The other way around as well.
    let (both, _) = run(&format!("{OVER} view: {{cameras: [{{{AWAY}}}]}},"), 3);
    assert_eq!(both.cloth, over.cloth);
}

/// A camera 5 m before the origin that goes 2 m to the right between 0 and 1 s, in a file whose y axis
/// is up.
fn gltf(camera: &str) -> Source {
    let numbers: [f32; 8] = [0.0, 1.0, 0.0, 0.0, 5.0, 2.0, 0.0, 5.0];
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    let data = base64::engine::general_purpose::STANDARD.encode(bytes);
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}],
            "nodes": [{{"name": "rig", "children": [1]}}, {{"name": "eye", "camera": 0}}],
            "cameras": [{camera}],
            "buffers": [{{"byteLength": 32, "uri": "data:application/octet-stream;base64,{data}"}}],
            "bufferViews": [{{"buffer": 0, "byteOffset": 0, "byteLength": 8}},
                            {{"buffer": 0, "byteOffset": 8, "byteLength": 24}}],
            "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR"}},
                          {{"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3"}}],
            "animations": [{{"name": "pan", "samplers": [{{"input": 0, "output": 1}}],
              "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "translation"}}}}]}}]}}"#
    );
    Source { name: "shot.gltf".into(), bytes: text.into_bytes() }
}

const WIDE: &str = r#"{"name": "wide", "type": "perspective",
                       "perspective": {"yfov": 0.7, "znear": 0.1}}"#;

fn followed(what: &str) -> Result<Loaded, String> {
    let turned = "transform: {rotate: {axis: [1, 0, 0], degrees: 90}}";
    let shot = format!("shots: [{{gltf: {{file: 'shot.gltf', {what} {turned}}}}}],");
    scene(&format!("{OVER} {shot} view: {{}},"), &[gltf(WIDE)])
}

#[test]
fn cameras_of_gltf_files_are_followed() {
    for what in [
        "start_s: 0.2,",
        "start_s: 0.2, camera: 'eye',",
        "start_s: 0.2, camera: 'wide', animation: 'pan',",
    ] {
        let loaded = followed(what).unwrap();
        let path = loaded.scene.camera_path.unwrap();
        for (time, x) in [(0.0, 0.0), (0.2, 0.0), (0.36, 0.32), (0.4, 0.4), (1.2, 2.0), (3.0, 2.0)]
        {
            let (eye, y) = (World3::new(x, -5.0, 0.0), World3::y());
            let (z, size) = (World3::z(), [1280, 720]);
            let expected = sizing_view::Camera::looking_at(eye, eye + y, z, 0.7, size).unwrap();
            let camera = path.at(time);
            assert!((camera.position() - eye).norm() < 1e-6, "{time}: {}", camera.position());
            assert!(camera.world_from_camera().angle_to(&expected.world_from_camera()) < 1e-6);
            assert!((camera.focal_px() / expected.focal_px() - 1.0).abs() < 1e-6);
        }
    }
}

#[test]
fn mistakes_are_named() {
    for (what, words) in [
        ("camera: 'eyes',", "there is no camera `eyes`, did you mean `eye`?"),
        ("animation: 'tilt',", "there is no animation `tilt`"),
        ("start_s: 1e12,", "start_s"),
        ("fille: 1,", "fille"),
    ] {
        let error = followed(what).map(|_| ()).unwrap_err();
        assert!(error.contains(words), "`{words}` is not in: {error}");
    }
    let shot = "shots: [{gltf: {file: 'shot.gltf'}}],";
    for (camera, words) in [
        (r#"{"type": "perspective", "perspective": {"yfov": 0.0, "znear": 0.1}}"#, "opening angle"),
        (
            r#"{"type": "orthographic",
                "orthographic": {"xmag": 1, "ymag": 1, "zfar": 9, "znear": 1}}"#,
            "has no perspective",
        ),
    ] {
        let error = scene(&format!("{OVER} {shot}"), &[gltf(camera)]).map(|_| ()).unwrap_err();
        assert!(error.contains(words), "`{words}` is not in: {error}");
    }
    for (extra, words) in [
        ("view: {occlusion: 1},", "occlusion"),
        ("view: {occlusion: true, v_hidden: 2},", "v_hidden is 2"),
        ("view: {cameras: [{camera: {position: [0, 0, 0], target: [0, 0, 0]}}]},", "cameras[0]"),
        ("view: {predicted: 1},", "predicted"),
        ("view: {shift_max_px: -1},", "shift_max_px is -1"),
        ("shots: [{}],", "exactly one of keyframes, gltf"),
        ("shots: [{gltf: {file: 'none.gltf'}}],", "none.gltf"),
    ] {
        let error = scene(&format!("{OVER} {extra}"), &[]).map(|_| ()).unwrap_err();
        assert!(error.contains(words), "`{words}` is not in: {error}");
    }
}
