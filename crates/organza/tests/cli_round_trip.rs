//! Simulate, then look at the recording with every other command.

mod cli_common;

use std::io::BufReader;

use cli_common::*;
use io_mcap::OwnedGarment;
use serde_json::Value;

fn simulated(name: &str) -> Folder {
    let folder = Folder::new(name);
    folder.write("two.json5", TWO);
    let ran = folder.good(&["simulate", "two.json5"]);
    assert!(ran.out.contains("6 frames in ") && ran.out.contains("picture: two.png"), "{ran:?}");
    assert_eq!(folder.listing(), ["two.json5", "two.mcap", "two.png"]);
    folder
}

#[test]
fn simulate_records_every_frame_with_its_report_and_scene() {
    let folder = simulated("record");
    let frames = frames(&folder.path("two.mcap"));
    assert_eq!(frames.iter().map(|f| f.index).collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5, 6]);
    for frame in &frames {
        let faces: usize = frame.garments.iter().map(|g| g.triangles.len()).sum();
        assert_eq!(frame.report["faces"], faces);
        assert_eq!(frame.report["frame"], frame.index);
        assert!((frame.time_s - 0.04 * frame.index as f64).abs() < 1e-12);
        let names: Vec<&str> = frame.garments.iter().map(|g| g.name.as_str()).collect();
        assert_eq!(names, ["sheet", "skirt"]);
        assert_ne!(frame.garments[0].color, frame.garments[1].color);
        for garment in &frame.garments {
            // Every point belongs to a triangle, and the material area never changes.
            let mut used = vec![false; garment.points.len()];
            garment.triangles.as_flattened().iter().for_each(|&v| used[v as usize] = true);
            assert!(used.iter().all(|&used| used));
            let [now, first] = [garment, find(&frames[0].garments, &garment.name)].map(area);
            assert!((now / first - 1.0).abs() < 1e-12, "{now} {first}");
        }
    }
    // Both garments fall, and the mesh adapts.
    let lowest = |g: &OwnedGarment| g.points.iter().map(|x| x[2]).fold(f64::INFINITY, f64::min);
    for name in ["sheet", "skirt"] {
        let [a, b] = [&frames[0], &frames[6]].map(|f| lowest(find(&f.garments, name)));
        assert!(b < a - 0.05, "{name}: from {a} m to {b} m");
    }
    assert_ne!(frames[0].report["faces"], frames[6].report["faces"]);

    let mut recording = io_mcap::Recording::open(folder.path("two.mcap")).unwrap();
    assert_eq!(recording.attachment("scene/two.json5").unwrap(), TWO.as_bytes());
    let checkpoints: Vec<u64> = recording.checkpoints().map(|c| c.frame).collect();
    assert_eq!(checkpoints, [0, 2, 4, 6]);
}

fn find<'a>(garments: &'a [OwnedGarment], name: &str) -> &'a OwnedGarment {
    garments.iter().find(|g| g.name == name).unwrap()
}

fn area(garment: &OwnedGarment) -> f64 {
    let one = |[a, b, c]: &[[f64; 2]; 3]| {
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    };
    garment.material.iter().map(one).sum()
}

#[test]
fn info_tells_frames_totals_and_what_was_skipped() {
    let folder = simulated("info");
    let text = folder.good(&["info", "two.mcap"]).out;
    for part in ["complete; 7 of 7 frames", "checkpoints: 0, 2, 4, 6", "attached: scene/two.json5"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(text.contains("skipped: strain limits: none in the scene"), "{text}");

    let json: Value =
        serde_json::from_str(&folder.good(&["info", "two.mcap", "--json"]).out).unwrap();
    assert_eq!(json["status"]["state"], "complete");
    assert_eq!(json["frames_planned"], 6);
    let reports = json["frames"].as_array().unwrap();
    assert_eq!(reports.len(), 7);
    let faces: Vec<f64> = reports[1..].iter().map(|r| r["faces"].as_f64().unwrap()).collect();
    let total = &json["totals"]["faces"];
    let mean = faces.iter().sum::<f64>() / 6.0;
    assert!((total["mean"].as_f64().unwrap() - mean).abs() < 1e-9, "{total}");
    assert_eq!(total["max"].as_f64().unwrap(), faces.iter().copied().fold(0.0, f64::max));
    assert_eq!(json["totals"]["substeps"]["sum"], 12.0);
    assert!(json["totals"]["seconds.total"]["min"].as_f64().unwrap() > 0.0);
    // The stages are inside the frame.
    let seconds = &reports[3]["seconds"];
    let stages = ["build", "assembly", "linear", "energy", "sizing", "remesh"];
    let sum: f64 = stages.iter().map(|s| seconds[s].as_f64().unwrap()).sum();
    assert!(sum > 0.0 && sum <= seconds["total"].as_f64().unwrap(), "{seconds}");
}

#[test]
fn exported_obj_has_the_bits_of_the_recording() {
    let folder = simulated("obj");
    let args = ["export", "two.mcap", "--format", "obj", "--out", "a/b", "--frames", "2..5"];
    let ran = folder.good(&args);
    assert_eq!(ran.out, "3 obj files in a/b\n");
    let names: Vec<String> =
        folder.listing().into_iter().filter(|n| n.starts_with("a/b/")).collect();
    assert_eq!(names, ["a/b/frame_00002.obj", "a/b/frame_00003.obj", "a/b/frame_00004.obj"]);

    let recorded = frames(&folder.path("two.mcap"));
    for frame in &recorded[2..5] {
        let text = folder.text(&format!("a/b/frame_{:05}.obj", frame.index));
        let mut garments = frame.garments.iter();
        let mut garment: Option<&OwnedGarment> = None;
        let (mut points, mut textures) = (Vec::new(), Vec::new());
        let (mut first, mut face) = (0, 0);
        for line in text.lines() {
            let words: Vec<&str> = line.split(' ').collect();
            let numbers = || words[1..].iter().map(|w| w.parse::<f64>().unwrap());
            match words[0] {
                "g" => {
                    garment = garments.next();
                    assert_eq!(words[1], garment.unwrap().name);
                    (first, face) = (points.len(), 0);
                }
                "v" => points.push(numbers().map(f64::to_bits).collect::<Vec<_>>()),
                "vt" => textures.push(numbers().map(f64::to_bits).collect::<Vec<_>>()),
                "f" => {
                    let garment = garment.unwrap();
                    for (k, corner) in words[1..].iter().enumerate() {
                        let (v, vt) = corner.split_once('/').unwrap();
                        let [v, vt] = [v, vt].map(|n| n.parse::<usize>().unwrap() - 1);
                        assert_eq!(v - first, garment.triangles[face][k] as usize);
                        let u = garment.material[face][k].map(f64::to_bits);
                        assert_eq!(textures[vt], u);
                    }
                    face += 1;
                }
                other => panic!("unknown line {other}"),
            }
        }
        let expected: Vec<Vec<u64>> = frame
            .garments
            .iter()
            .flat_map(|g| g.points.iter().map(|x| x.map(f64::to_bits).to_vec()))
            .collect();
        assert_eq!(points, expected);
        let faces: usize = frame.garments.iter().map(|g| g.triangles.len()).sum();
        assert_eq!(text.lines().filter(|l| l.starts_with("f ")).count(), faces);
    }

    // What is there is not written over, and nothing else is written then.
    std::fs::remove_file(folder.path("a/b/frame_00002.obj")).unwrap();
    let again = folder.run(&args);
    assert_eq!(again.code, 2);
    assert!(again.err.contains("frame_00003.obj: exists already"), "{}", again.err);
    assert!(!folder.path("a/b/frame_00002.obj").exists());
    folder.good(&[&args[..], &["--overwrite"]].concat());
    assert!(folder.path("a/b/frame_00002.obj").exists());
}

#[test]
fn exported_ply_has_the_bits_of_the_recording() {
    let folder = simulated("ply");
    folder.good(&["export", "two.mcap", "--format", "ply", "--out", "p", "--frames", "6"]);
    let frame = frames(&folder.path("two.mcap")).pop().unwrap();
    let bytes = folder.read("p/frame_00006.ply");
    let marker = b"end_header\n";
    let at = bytes.windows(marker.len()).position(|w| w == marker).unwrap();
    let (header, mut body) =
        (std::str::from_utf8(&bytes[..at]).unwrap(), &bytes[at + marker.len()..]);
    let points: Vec<[f64; 3]> = frame.garments.iter().flat_map(|g| g.points.clone()).collect();
    let faces: usize = frame.garments.iter().map(|g| g.triangles.len()).sum();
    assert!(header.starts_with("ply\nformat binary_little_endian 1.0\n"), "{header}");
    assert!(header.contains(&format!("element vertex {}\n", points.len())), "{header}");
    assert!(header.contains(&format!("element face {faces}\n")), "{header}");
    assert!(header.contains("comment garment 1 skirt\n"), "{header}");
    let mut take = |n: usize| {
        let (head, tail) = body.split_at(n);
        body = tail;
        head
    };
    for x in points.as_flattened() {
        assert_eq!(take(8), x.to_le_bytes());
    }
    let mut first = 0;
    for (k, garment) in frame.garments.iter().enumerate() {
        for (t, u) in garment.triangles.iter().zip(&garment.material) {
            assert_eq!(take(1), [3]);
            t.iter().for_each(|v| assert_eq!(take(4), (first + v).to_le_bytes()));
            assert_eq!(take(1), [6]);
            u.as_flattened().iter().for_each(|c| assert_eq!(take(4), (*c as f32).to_le_bytes()));
            assert_eq!(take(4), (k as i32).to_le_bytes());
        }
        first += garment.points.len() as u32;
    }
    assert!(body.is_empty());
}

fn picture(folder: &Folder, name: &str) -> ([u32; 2], Vec<u8>) {
    let file = std::fs::File::open(folder.path(name)).unwrap();
    let mut reader = png::Decoder::new(BufReader::new(file)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    ([info.width, info.height], pixels)
}

/// Number of pixels that differ from those of the column at the left edge: what the backdrop, which
/// is even along a row to a few steps of brightness, does not explain.
fn drawn(size: [u32; 2], pixels: &[u8]) -> usize {
    let width = size[0] as usize;
    let rows = pixels.chunks_exact(3 * width);
    rows.map(|row| {
        let edge = &row[..3];
        row.chunks_exact(3).filter(|p| p.iter().zip(edge).any(|(a, b)| a.abs_diff(*b) > 40)).count()
    })
    .sum()
}

#[test]
fn render_draws_every_frame() {
    let folder = simulated("render");
    folder.good(&["render", "two.mcap", "--out", "p", "--size", "160x90", "--frames", "4.."]);
    let names: Vec<String> = folder.listing().into_iter().filter(|n| n.starts_with("p/")).collect();
    assert_eq!(names, ["p/frame_00004.png", "p/frame_00005.png", "p/frame_00006.png"]);
    let (size, plain) = picture(&folder, "p/frame_00004.png");
    assert_eq!(size, [160, 90]);
    assert!(drawn(size, &plain) > 200, "{} pixels drawn", drawn(size, &plain));
    let (size, poster) = picture(&folder, "two.png");
    assert_eq!(size, [1280, 720]);
    assert!(drawn(size, &poster) > 10_000, "{} pixels drawn", drawn(size, &poster));

    let others = [["--wireframe", "--view=outside"], ["--color=stretch", "--view=outside"]];
    for (k, more) in others.iter().enumerate() {
        let out = format!("q{k}");
        let args = ["render", "two.mcap", "--out", &out, "--size=160x90", "--frames=4"];
        folder.good(&[&args[..], more].concat());
        let (_, pixels) = picture(&folder, &format!("{out}/frame_00004.png"));
        assert_ne!(pixels, plain, "{more:?}");
    }
    // There is no camera in this scene.
    let ran = folder.run(&["render", "two.mcap", "--out", "r", "--view", "camera"]);
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("two.mcap: frame 0 has no camera"), "{}", ran.err);
    assert!(!folder.path("r").exists());
}

#[test]
fn the_camera_of_the_scene_takes_the_poster_and_pictures() {
    let folder = Folder::new("camera");
    folder.write("s/tri.json5", TRIANGLE);
    // Upright, in front of the camera.
    folder
        .write("s/scrap.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    folder.good(&[
        "simulate",
        "s/tri.json5",
        "--out",
        "run.mcap",
        "--frames",
        "1",
        "--set",
        "gravity=[0,0,-0.001]",
    ]);
    let (size, poster) = picture(&folder, "run.png");
    assert_eq!(size, [64, 48]);
    folder.good(&["render", "run.mcap", "--out", "p", "--frames", "1"]);
    let (_, pixels) = picture(&folder, "p/frame_00001.png");
    // The floor differs: that of the sequence is not that of the frame. Look at the triangle, whose
    // right angle is half a metre to the left of the middle: 48 px / (2 · 4 m · tan 20°) = 16 px/m.
    let at = |pixels: &[u8], x: usize, y: usize| pixels[3 * (64 * y + x)..][..3].to_vec();
    for (x, y, inside) in
        [(27, 20, true), (36, 21, true), (27, 5, false), (22, 20, false), (38, 12, false)]
    {
        assert_eq!(at(&poster, x, y), at(&pixels, x, y), "{x} {y}");
        let [r, _, b] = at(&pixels, x, y)[..] else { panic!() };
        assert_eq!(r.abs_diff(b) > 30, inside, "{x} {y}: {:?}", at(&pixels, x, y));
    }
}

#[test]
fn check_builds_without_running() {
    let folder = Folder::new("check");
    folder.write("two.json5", TWO);
    let ran = folder.good(&["check", "two.json5", "--set", "substeps=5"]);
    for part in [
        "two.json5: a good scene of Organza, named two",
        "5 steps a frame of 0.008 s",
        "cloth sheet: 169 vertices, 288 faces, 1.0000 m²",
        "remeshing: edges from 0.05 m to 0.2 m",
        "wind: [3.0, 1.0, 0.0] m/s",
    ] {
        assert!(ran.out.contains(part), "{part}: {}", ran.out);
    }
    assert_eq!(folder.listing(), ["two.json5"]);
}

#[test]
fn what_is_not_supported_is_left_out_only_when_allowed() {
    let folder = Folder::new("unsupported");
    folder.write("scrap.obj", SCRAP);
    folder.write("t.json5", TRIANGLE.replacen('{', "{ morphs: [{ depth_m: 1 }],", 1));
    for command in ["simulate", "check"] {
        let ran = folder.run(&[command, "t.json5"]);
        assert_eq!(ran.code, 2, "{ran:?}");
        assert!(ran.err.contains("t.json5:1:3: morphs: not supported yet"), "{ran:?}");
        assert_eq!(folder.listing(), ["scrap.obj", "t.json5"]);
    }
    for command in ["check", "simulate"] {
        let ran = folder.good(&[command, "t.json5", "--allow-unsupported"]);
        assert!(ran.err.contains("warning: t.json5:1:3: morphs"), "{ran:?}");
    }
}

#[test]
fn help_and_version() {
    let folder = Folder::new("help");
    let ran = folder.good(&["--version"]);
    assert_eq!(ran.out, concat!("organza ", env!("CARGO_PKG_VERSION"), "\n"));
    for command in ["simulate", "resume", "info", "check", "export", "render"] {
        let ran = folder.good(&[command, "--help"]);
        let (usage, example) =
            (format!("Usage: organza {command} "), format!("  organza {command} "));
        assert!(ran.out.contains(&usage) && ran.out.contains(&example), "{}", ran.out);
    }
}
