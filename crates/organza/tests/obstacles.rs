//! Obstacles in recordings, pictures, exports and in what the commands print.

mod cli_common;

use std::path::Path;

use cli_common::*;
use io_mcap::{OwnedFrame, OwnedObstacle};
use organza::export::{Format, export};
use organza::picture::{self, PictureOptions, View};
use organza::record::{FrameRange, Resumed, Run, RunOptions, resume};
use organza::render::Size;
use organza::scene::{self, LoadOptions, Loaded};

/// A sheet high above what happens here: a box that moves along x, and a wedge from a file.
const SCENE: &str = r#"{
  frames: 4, substeps: 1, recording: { checkpoint_every_frames: 2 },
  cloths: [{ name: "ball", mesh: { grid: { size_m: [1, 1], cells: [4, 4] } }, fabric: "denim",
    transform: { translate: [0, 0, 2] } }],
  obstacles: [
    { name: "ball", mesh: { box: { size_m: [0.4, 0.4, 0.4] } }, motion: { interpolation: "linear",
      keyframes: [{ time_s: 0 }, { time_s: 0.16, transform: { translate: [1.6, 0, 0] } }] } },
    { name: "wedge # 1", mesh: { obj: "wedge.obj" }, friction: 0.7,
      transform: { translate: [0, 1, 0] } },
  ],
}"#;

/// Three triangles at one edge, which no cloth could have.
const WEDGE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\nf 1 2 3\nf 1 2 4\nf 1 2 5\n";

fn load(folder: &Folder) -> Loaded {
    folder.write("s.json5", SCENE);
    folder.write("wedge.obj", WEDGE);
    scene::load(&folder.path("s.json5"), &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn record(loaded: &Loaded, path: &Path, frames: u32) {
    let options = RunOptions { frames: Some(frames), checkpoint_every: None, overwrite: true };
    let run = Run::start(loaded, &LoadOptions::default(), path, &options);
    end(run.unwrap_or_else(|e| panic!("{e}")));
}

fn end(mut run: Run) {
    while run.next_frame().unwrap().is_some() {}
    run.finish().unwrap();
}

/// A recording of all frames in a folder of its own.
fn recorded(name: &str) -> (Folder, Vec<OwnedFrame>) {
    let folder = Folder::new(name);
    let path = folder.path("run.mcap");
    record(&load(&folder), &path, 4);
    let frames = frames(&path);
    (folder, frames)
}

#[test]
fn every_frame_holds_the_obstacles_where_they_are() {
    let (_, frames) = recorded("obstacles-recorded");
    assert_eq!(frames.len(), 5);
    for frame in &frames {
        let [cube, wedge] = &frame.obstacles[..] else { panic!("{:?}", frame.obstacles) };
        assert_eq!((cube.name.as_str(), wedge.name.as_str()), ("ball", "wedge # 1"));
        assert_eq!((cube.points.len(), cube.triangles.len()), (8, 12));
        assert_eq!(wedge.triangles, [[0, 1, 2], [0, 1, 3], [0, 1, 4]]);
        assert_eq!(wedge.points, frames[0].obstacles[1].points);
        assert_ne!(cube.color, frame.garments[0].color);
        let middle = cube.points.iter().map(|x| x[0]).sum::<f64>() / 8.0;
        assert!((middle - 10.0 * frame.time_s).abs() < 1e-12, "{} {middle}", frame.time_s);
    }
}

#[test]
fn a_run_that_goes_on_has_the_same_bits() {
    let folder = Folder::new("obstacles-resumed");
    let loaded = load(&folder);
    let [whole, part] = ["whole.mcap", "part.mcap"].map(|name| folder.path(name));
    record(&loaded, &whole, 4);
    record(&loaded, &part, 3);
    let Resumed::Continues { from: 2, run, .. } = resume(&part, Some(4)).unwrap() else {
        panic!("frames 3 and 4 are to be made");
    };
    end(*run);
    let [whole, part] = [&whole, &part].map(|path| frames(path));
    assert_eq!(whole.len(), part.len());
    whole.iter().zip(&part).for_each(|(a, b)| assert_same(a, b, "resumed"));
}

#[test]
fn obj_files_beside_those_of_the_cloth() {
    let (folder, frames) = recorded("obstacles-obj");
    let (run, out) = (folder.path("run.mcap"), folder.path("out"));
    let range: FrameRange = "3..5".parse().unwrap();
    let written = export(&run, Format::Obj, range, &out, false, |_, _| {}).unwrap();
    assert_eq!(written.files, 4);
    let names: Vec<String> =
        folder.listing().into_iter().filter(|n| n.starts_with("out/")).collect();
    assert_eq!(
        names,
        [
            "out/frame_00003.obj",
            "out/frame_00004.obj",
            "out/obstacles_00003.obj",
            "out/obstacles_00004.obj"
        ]
    );
    for frame in &frames[3..] {
        let bytes = folder.read(&format!("out/obstacles_{:05}.obj", frame.index));
        let file = mesh_core::obj::read(&bytes).unwrap();
        assert_eq!(file.groups, ["ball", "wedge___1"]);
        let points: Vec<[f64; 3]> = file.positions.iter().map(|x| (*x).into()).collect();
        let [cube, wedge] = &frame.obstacles[..] else { panic!() };
        assert_eq!(points, [&cube.points[..], &wedge.points].concat());
        let moved = wedge.triangles.iter().map(|t| t.map(|v| v + 8));
        let triangles: Vec<[u32; 3]> = cube.triangles.iter().copied().chain(moved).collect();
        assert_eq!(file.triangles, triangles);
        // The cloth's file is that of a scene without obstacles.
        let cloth =
            mesh_core::obj::read(&folder.read(&format!("out/frame_{:05}.obj", frame.index)));
        assert_eq!(cloth.unwrap().groups, ["ball"]);
    }
    let again = export(&run, Format::Obj, range, &out, false, |_, _| {}).unwrap_err().to_string();
    assert!(again.contains("frame_00003.obj: exists already"), "{again}");
    std::fs::remove_file(out.join("frame_00003.obj")).unwrap();
    let again = export(&run, Format::Obj, "3".parse().unwrap(), &out, false, |_, _| {});
    assert!(again.unwrap_err().to_string().contains("obstacles_00003.obj: exists already"));
}

#[test]
fn ply_files_beside_those_of_the_cloth() {
    let (folder, frames) = recorded("obstacles-ply");
    let (run, out) = (folder.path("run.mcap"), folder.path("out"));
    export(&run, Format::Ply, "2".parse().unwrap(), &out, false, |_, _| {}).unwrap();
    let bytes = folder.read("out/obstacles_00002.ply");
    let header = "ply\nformat binary_little_endian 1.0\ncomment obstacle 0 ball\n\
        comment obstacle 1 wedge # 1\nelement vertex 13\nproperty double x\nproperty double y\n\
        property double z\nelement face 15\nproperty list uchar int vertex_indices\n\
        property int obstacle\nend_header\n";
    let (got, body) = bytes.split_at(header.len());
    assert_eq!(String::from_utf8_lossy(got), header);
    let (vertices, faces) = body.split_at(24 * 13);
    let numbers = vertices.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap()));
    let expected = frames[2].obstacles.iter().flat_map(|o| o.points.as_flattened());
    assert!(numbers.eq(expected.copied()));
    let face = |k: usize| -> Vec<i32> {
        let face = &faces[17 * k..17 * (k + 1)];
        assert_eq!(face[0], 3);
        face[1..].chunks_exact(4).map(|b| i32::from_le_bytes(b.try_into().unwrap())).collect()
    };
    let first = frames[2].obstacles[0].triangles[0].map(|v| v as i32);
    assert_eq!(face(0), [&first[..], &[0]].concat());
    assert_eq!(face(14), [8, 9, 12, 1]);
    assert_eq!(faces.len(), 17 * 15);
    assert!(folder.path("out/frame_00002.ply").exists());
}

#[test]
fn broken_numbers_are_refused_by_name() {
    let broken = OwnedObstacle {
        name: "rock".into(),
        points: vec![[0.0; 3], [f64::NAN; 3]],
        triangles: Vec::new(),
        color: [1.0; 4],
    };
    for format in [Format::Obj, Format::Ply] {
        let mut out = Vec::new();
        let error = format.write_obstacles(&mut out, std::slice::from_ref(&broken)).unwrap_err();
        assert_eq!(error.to_string(), "obstacle \"rock\": the position of point 1 is not finite");
        assert!(out.is_empty());
    }
}

#[test]
fn pictures_show_obstacles_in_grey() {
    let (folder, _) = recorded("obstacles-drawn");
    let (run, out) = (folder.path("run.mcap"), folder.path("out"));
    let size = Some(Size::new(160, 120));
    let options = PictureOptions { view: Some(View::Outside), size, ..PictureOptions::default() };
    picture::render(&run, "0".parse().unwrap(), &options, &out, false, |_, _| {}).unwrap();
    let file = std::fs::File::open(out.join("frame_00000.png")).unwrap();
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    // The sheet is blue, and everything grey and darker than the backdrop is obstacle or shadow.
    let rows = pixels.chunks_exact(3 * 160);
    let grey = |p: &[u8], edge: &[u8]| {
        let spread = p.iter().max().unwrap() - p.iter().min().unwrap();
        spread < 20 && p.iter().zip(edge).any(|(a, b)| a.abs_diff(*b) > 30)
    };
    let n: usize = rows.map(|row| row.chunks_exact(3).filter(|p| grey(p, &row[..3])).count()).sum();
    assert!(n > 300, "{n} grey pixels");
}

#[test]
fn check_and_info_know_them() {
    let (folder, _) = recorded("obstacles-told");
    let told = folder.good(&["check", "s.json5"]).out;
    for line in [
        "obstacle ball: 8 vertices, 12 faces, moving, friction 0.3\n",
        "obstacle wedge # 1: 5 vertices, 3 faces, still, friction 0.7\n",
        "contact: thickness 0.005 m; cloth on cloth: none\n",
    ] {
        assert!(told.contains(line), "{line}: {told}");
    }
    let told = folder.good(&["info", "run.mcap"]).out;
    assert!(told.contains("obstacles: ball, wedge # 1\nattached: "), "{told}");
    let told = folder.good(&["info", "run.mcap", "--json"]).out;
    let told: serde_json::Value = serde_json::from_str(&told).unwrap();
    assert_eq!(told["obstacles"], serde_json::json!(["ball", "wedge # 1"]));
}
