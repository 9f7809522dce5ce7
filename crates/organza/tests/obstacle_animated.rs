//! Obstacles by one file a frame, and obstacles that come and go.

mod cli_common;
mod scene_help;

use cli_common::*;
use mesh_core::World3;
use organza::build::{Built, build};
use organza::export::{Format, export};
use organza::record::{FrameRange, Resumed, Run, RunOptions, place, resume};
use organza::scene::{self, LoadOptions, Source, from_sources, parse};
use organza::world::World;
use scene_help::{attached, complains, with};

fn frame(z: f64) -> String {
    // A vertex that no face uses is none.
    format!("v 9 9 9\nv 0 0 {z}\nv 1 0 {z}\nv 0 1 {z}\nf 2 3 4\n")
}

/// Ten frames a second, at heights 0, 1, 3.
const SEQUENCE: &str = "obj_sequence: {files: 'f/%03d.obj', frames: [7, 9], frames_per_second: 10, \
                        start_s: 1}";

fn frames() -> Vec<Source> {
    let files = [(7, 0.0), (8, 1.0), (9, 3.0)];
    let source = |(k, z)| Source { name: format!("f/{k:03}.obj"), bytes: frame(z).into() };
    attached().into_iter().chain(files.map(source)).collect()
}

fn build_with(scene: &str, sources: &[Source]) -> Result<Built, String> {
    let options = LoadOptions::default();
    let loaded = parse(with(scene, ""), "s.json5", &options, &from_sources(sources))
        .map_err(|e| e.to_string())?;
    build(&loaded).map_err(|e| place(&loaded, &e).to_string())
}

#[test]
fn frames_are_joined_by_straight_ways() {
    let scene = format!(
        "obstacles: [{{mesh: {{{SEQUENCE}}}, transform: {{scale: 2}}, motion: {{interpolation: 'linear',
        keyframes: [{{time_s: 0}}, {{time_s: 2, transform: {{translate: [4, 0, 0]}}}}]}}}}],"
    );
    let built = build_with(&scene, &frames()).unwrap_or_else(|e| panic!("{e}"));
    let body = &built.obstacles[0];
    assert!(body.is_moving());
    assert_eq!((body.n_vertices(), &body.triangles[..]), (3, &[[0, 1, 2]][..]));
    for (time, z) in
        [(0.0, 0.0), (1.0, 0.0), (1.05, 1.0), (1.1, 2.0), (1.15, 4.0), (1.2, 6.0), (9.0, 6.0)]
    {
        let x = body.positions(time);
        let expected = World3::new(2.0 + f64::min(2.0 * time, 4.0), 0.0, z);
        assert!((x[1] - expected).norm() < 1e-12, "{time}: {} {expected}", x[1]);
    }
}

#[test]
fn bad_sequences_are_complained_of_at_their_place() {
    let text = |sequence: &str| {
        with(&format!("obstacles: [\n{{mesh: {{obj_sequence: {{{sequence}}}}}}}],"), "")
    };
    let more = "frames: [0, 1], frames_per_second: 25";
    for (sequence, expected) in [
        (
            format!("files: 'a.obj', {more}"),
            "s.json5:2:31: obstacles[0].mesh.obj_sequence.files: `a.obj` is no name with a number: it has \
             no place for one, such as `%04d`",
        ),
        (
            format!("files: '%d.obj', {more}"),
            "s.json5:2:31: obstacles[0].mesh.obj_sequence.files: there is no file `0.obj` among those \
             attached",
        ),
        (
            "files: '%d.obj', frames: [2, 1], frames_per_second: 25".into(),
            "s.json5:2:49: obstacles[0].mesh.obj_sequence.frames: the first, 2, is above the last, 1",
        ),
        (
            "files: '%d.obj', frames: [0, 10000], frames_per_second: 25".into(),
            "s.json5:2:49: obstacles[0].mesh.obj_sequence.frames: 1.0001e4 frames is beyond the limit of \
             1e4 frames",
        ),
        (
            "files: 7, frames: [0, 1], frames_per_second: 1".into(),
            "s.json5:2:31: obstacles[0].mesh.obj_sequence.files: expected a text, got `7`",
        ),
    ] {
        complains(&text(&sequence), &[], &[expected]);
    }
    // Frames that do not fit the first.
    let scene = format!("obstacles: [{{mesh: {{{SEQUENCE}}}}}],");
    let error = |from: &str, to: &str| {
        let mut sources = frames();
        let source = sources.iter_mut().find(|s| s.name == "f/009.obj").unwrap();
        let text = String::from_utf8(source.bytes.clone()).unwrap().replace(from, to);
        source.bytes = text.into_bytes();
        build_with(&scene, &sources).map(|_| ()).unwrap_err()
    };
    for (from, to, expected) in [
        ("v 9 9 9\n", "", "f/009.obj: line 4: a corner refers to `v` number 4, but there are 3"),
        ("v 9 9 9\n", "v 9 9 9\nv 9 9 9\n", "f/009.obj: has 5 vertices, and f/007.obj has 4"),
        ("f 2 3 4\n", "f 2 3 4\nf 2 3 4\n", "f/009.obj: has 2 triangles, and f/007.obj has 1"),
        ("f 2 3 4", "f 3 2 4", "f/009.obj: line 5: a face is another than in f/007.obj"),
    ] {
        let got = error(from, to);
        assert!(got.ends_with(expected) && got.contains("obstacles[0].mesh: "), "{got}");
    }
}

#[test]
fn bad_times_are_complained_of_at_their_place() {
    for (more, expected) in [
        (
            "start_s: -1",
            "s.json5:2:33: obstacles[0].start_s: must be zero or more and finite, got -1",
        ),
        (
            "thickness_m: 0",
            "s.json5:2:37: obstacles[0].thickness_m: must be positive and finite, got 0",
        ),
        ("end_s: 0", "s.json5:2:31: obstacles[0].end_s: 0 s is not after the start at 0 s"),
        (
            "motion: {keyframes: [{time_s: 0, transform: {scale: 0}}]}",
            "s.json5:2:76: obstacles[0].motion.keyframes[0].transform.scale: must be positive and finite, got 0",
        ),
        (
            "motion: {interpolation: 'linear', keyframes: [{time_s: 0, velocity: {scale: 1}}]}",
            "s.json5:2:92: obstacles[0].motion.keyframes[0].velocity: a linear motion has its velocity \
             from its keyframes alone",
        ),
    ] {
        let text = with(&format!("obstacles: [\n{{mesh: {{obj: 'a.obj'}}, {more}}}],"), "");
        complains(&text, &[], &[expected]);
    }
    for (more, expected) in [
        (
            "fade_s: 1, end_s: 2",
            "s.json5:2:30: handles[0].fade_s: only springs with an end fade: give `stiffness_n_per_m`, `end_s`",
        ),
        (
            "start_s: 1, motion: {keyframes: [{time_s: 1, transform: {scale: 0}}]}",
            "s.json5:2:42: handles[0].motion: its scale is 0 when the handle takes hold",
        ),
    ] {
        complains(
            &with(&format!("handles: [\n{{select: 'boundary', {more}}}],"), ""),
            &[],
            &[expected],
        );
    }
}

/// A sheet falls on a shelf that is there from 0.1 s to 0.3 s only; a second shelf below stays.
const SHELF: &str = r#"{
  frames: 20, frames_per_second: 25, substeps: 4, recording: { checkpoint_every_frames: 3 },
  cloths: [{ mesh: { grid: { size_m: [0.3, 0.3], cells: [3, 3] } }, fabric: "denim",
    transform: { translate: [-0.15, -0.15, 0.12] } }],
  obstacles: [
    { name: "shelf", mesh: { plane: { size_m: [1, 1] } }, start_s: 0.1, end_s: 0.3 },
    { name: "floor", mesh: { plane: { size_m: [2, 2] } }, transform: { translate: [0, 0, -0.4] } },
  ],
}"#;

fn load_shelf(folder: &Folder) -> scene::Loaded {
    folder.write("s.json5", SHELF);
    let loaded = scene::load(&folder.path("s.json5"), &LoadOptions::default());
    loaded.unwrap_or_else(|e| panic!("{e}"))
}

fn record(loaded: &scene::Loaded, path: &std::path::Path, frames: u32) {
    let options = RunOptions { frames: Some(frames), checkpoint_every: None, overwrite: true };
    let mut run = Run::start(loaded, &LoadOptions::default(), path, &options).unwrap();
    while run.next_frame().unwrap().is_some() {}
    run.finish().unwrap();
}

#[test]
fn what_comes_holds_and_what_goes_lets_fall() {
    let folder = Folder::new("shelf");
    let loaded = load_shelf(&folder);
    let [whole, part] = ["whole.mcap", "part.mcap"].map(|name| folder.path(name));
    record(&loaded, &whole, 20);
    let frames_of_whole = cli_common::frames(&whole);
    for frame in &frames_of_whole {
        let names: Vec<&str> = frame.obstacles.iter().map(|o| o.name.as_str()).collect();
        let there = frame.time_s > 0.1 && frame.time_s < 0.301;
        assert_eq!(names.contains(&"shelf"), there, "{}", frame.time_s);
        assert!(names.contains(&"floor"));
    }
    // It would have fallen by 0.44 m after 0.3 s.
    let lowest = |k: usize| {
        let points = frames_of_whole[k].garments[0].points.iter();
        points.map(|x| x[2]).fold(f64::INFINITY, f64::min)
    };
    assert!(lowest(7) > 0.0, "{}", lowest(7));
    assert!(lowest(20) < -0.05, "{}", lowest(20));
    // Another run that was cut while the shelf was there has the same bits.
    record(&loaded, &part, 5);
    let Resumed::Continues { run, .. } = resume(&part, Some(20)).unwrap() else { panic!() };
    let mut run = *run;
    while run.next_frame().unwrap().is_some() {}
    run.finish().unwrap();
    let resumed = cli_common::frames(&part);
    assert_eq!(resumed.len(), 21);
    frames_of_whole.iter().zip(&resumed).for_each(|(a, b)| assert_same(a, b, "resumed"));
    // There is a file of obstacles for every frame, however many there are.
    let out = folder.path("out");
    let range: FrameRange = "0..4".parse().unwrap();
    let written = export(&whole, Format::Obj, range, &out, false, |_, _| {}).unwrap();
    assert_eq!(written.files, 8);
    let groups = |k: u32| {
        mesh_core::obj::read(&folder.read(&format!("out/obstacles_{k:05}.obj"))).unwrap().groups
    };
    assert_eq!(
        (groups(2), groups(3)),
        (vec!["floor".into()], vec!["shelf".into(), "floor".into()])
    );
    let told = folder.good(&["check", "s.json5"]).out;
    let line =
        "obstacle shelf: 4 vertices, 2 faces, still, friction 0.3, from 0.1 s on, until 0.3 s\n";
    assert!(told.contains(line), "{told}");
}

#[test]
fn coming_into_cloth_is_told_and_the_cloth_is_led_out() {
    let text = SHELF.replace("0.12] } }]", "-0.1], rotate: { axis: [1, 0, 0], degrees: 90 } } }]");
    let text = text.replace("end_s: 0.3", "end_s: 3");
    let loaded = parse(text, "s", &LoadOptions::default(), &from_sources(&[])).unwrap();
    let mut world = World::new(&loaded).unwrap();
    for _ in 0..2 {
        let report = world.advance().unwrap();
        assert!(report.warnings.is_empty() && report.crossings == Some(0));
    }
    let report = world.advance().unwrap();
    let [warning] = &report.warnings[..] else { panic!("{:?}", report.warnings) };
    let start = "obstacle `shelf` appears at 0.1 s where cloth is: ";
    assert!(warning.starts_with(start), "{warning}");
    assert!(!report.skipped.iter().any(|stage| stage.starts_with("untangling")));
    let free = (0..20).find(|_| world.advance().unwrap().crossings == Some(0));
    assert!(free.is_some());
    let report = world.advance().unwrap();
    assert!(report.crossings == Some(0) && report.warnings.is_empty());
    assert!(report.skipped.iter().any(|stage| stage.starts_with("untangling")));
}

/// Three sheets at rest on a floor, each of its own thickness: every gap is that of its pair.
#[test]
fn every_pair_keeps_its_own_distance() {
    let cloth = |name: &str, z: f64, thickness: &str| {
        format!(
            "{{name: '{name}', mesh: {{grid: {{size_m: [0.4, 0.4], cells: [2, 2]}}}}, fabric: 'denim', \
             damping: {{mass_per_s: 20, stiffness_s: 1e-3}}, transform: {{translate: [0, 0, {z}]}}, {thickness}}}"
        )
    };
    let text = format!(
        "{{frames: 20, integrator: 'implicit-euler', cloths: [{}, {}, {}], contact: {{thickness_m: 0.004}},
        obstacles: [{{mesh: {{plane: {{size_m: [2, 2]}}}}, thickness_m: 0.01}}]}}",
        cloth("a", 0.02, "thickness_m: 0.002"),
        cloth("b", 0.04, ""),
        cloth("c", 0.06, "thickness_m: 0.02"),
    );
    let loaded = parse(text, "s", &LoadOptions::default(), &from_sources(&[]));
    let mut world = World::new(&loaded.unwrap_or_else(|e| panic!("{e}"))).unwrap();
    for _ in 0..20 {
        world.advance().unwrap_or_else(|e| panic!("{e}"));
    }
    let heights: Vec<f64> =
        world.cloth.x.chunks(9).map(|x| x.iter().map(|x| x.z).sum::<f64>() / 9.0).collect();
    let gaps = [heights[0], heights[1] - heights[0], heights[2] - heights[1]];
    // Barriers begin at the thickness; a light sheet rests a little below.
    for (gap, thickness) in gaps.into_iter().zip([0.006, 0.003, 0.012]) {
        assert!(gap > 0.6 * thickness && gap < 1.05 * thickness, "{gaps:?} {thickness}");
    }
}
