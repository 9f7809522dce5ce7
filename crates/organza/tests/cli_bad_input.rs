//! Bad input of every kind: exit code 2, the file and the place in the message, no panic, and nothing
//! left behind.

mod cli_common;

use cli_common::*;

/// A scene and its mesh, both good: `s.json5` and `a.obj`.
const SCENE: &str = "{frames: 2, substeps: 1,\ncloths: [{mesh: {obj: 'a.obj'}, fabric: 'denim'}]}";

/// Runs `args` beside the good scene with `files` added or replaced, and expects every `part` in the
/// message.
#[track_caller]
fn refused(name: &str, files: &[(&str, &[u8])], args: &[&str], parts: &[&str]) {
    let folder = Folder::new(&format!("bad/{name}"));
    folder.write("s.json5", SCENE);
    folder.write("a.obj", SCRAP);
    for (file, content) in files {
        folder.write(file, content);
    }
    let before = folder.listing();
    let ran = folder.run(args);
    assert_eq!(ran.code, 2, "{name}: {ran:?}");
    for part in parts {
        assert!(ran.err.contains(part), "{name}: no {part:?} in\n{}", ran.err);
    }
    assert_eq!(ran.out, "", "{name}");
    assert_eq!(folder.listing(), before, "{name}");
    for (file, content) in files {
        assert!(folder.read(file) == *content, "{name}: {file} was changed");
    }
}

#[track_caller]
fn table(cases: &[(&str, &str, &[&str])], command: &[&str], file: &str) {
    for (name, text, parts) in cases {
        refused(name, &[(file, text.as_bytes())], command, parts);
        let check: Vec<&str> =
            command.iter().map(|&a| if a == "simulate" { "check" } else { a }).collect();
        refused(name, &[(file, text.as_bytes())], &check, parts);
    }
}

#[test]
fn the_base_of_these_tests_is_good() {
    let folder = Folder::new("bad-base");
    folder.write("s.json5", SCENE);
    folder.write("a.obj", SCRAP);
    folder.good(&["simulate", "s.json5"]);
    assert_eq!(folder.listing(), ["a.obj", "s.json5", "s.mcap", "s.png"]);
}

#[test]
fn scenes() {
    const CLOTH: &str = "cloths: [{mesh: {obj: 'a.obj'}, fabric: 'denim'}]";
    let with = |cloth: &str| format!("{{frames: 1, cloths: [{{{cloth}}}]}}");
    let grid = "mesh: {grid: {size_m: [1, 1], cells: [2, 2]}}, ";
    let owned: Vec<(&str, String, &[&str])> = vec![
        ("empty", String::new(), &["s.json5:1:1: ", "cut short?"]),
        ("not-json", "frames = 3".into(), &["s.json5:1:"]),
        ("cut", SCENE[..40].into(), &["s.json5:2:"]),
        ("list", "[1, 2]".into(), &["s.json5:1:1: expected an object, got a list"]),
        (
            "no-cloth",
            "{frames: 3}".into(),
            &["s.json5:1:1: ", "cloths: a scene needs at least one cloth or fluid"],
        ),
        ("zero-frames", format!("{{frames: 0, {CLOTH}}}"), &["s.json5:1:10: frames: "]),
        ("negative-frames", format!("{{frames: -3, {CLOTH}}}"), &["s.json5:1:10: frames: "]),
        ("text-frames", format!("{{frames: 'many', {CLOTH}}}"), &["s.json5:1:10: frames: "]),
        (
            "misspelt",
            format!("{{framse: 3, {CLOTH}}}"),
            &["s.json5:1:2: ", "did you mean `frames`?"],
        ),
        ("nan", format!("{{frames: 3, gravity: [0, NaN, 0], {CLOTH}}}"), &["gravity[1]", "NaN"]),
        ("too-many-steps", format!("{{frames: 4000000000, {CLOTH}}}"), &["s.json5:1:10: frames: "]),
        ("zero-rate", format!("{{frames: 1, frames_per_second: 0, {CLOTH}}}"), &["s.json5:1:32: "]),
        ("no-such-mesh", with("mesh: {obj: 'b.obj'}, fabric: 'denim'"), &["s.json5:1:", "b.obj"]),
        ("no-such-fabric", with(&format!("{grid} fabric: 'denin'")), &["s.json5:1:", "`denim`"]),
        (
            "two-meshes",
            with("mesh: {obj: 'a.obj', disc: {radius_m: 1, rings: 2}}, fabric: 'denim'"),
            &["cloths[0].mesh: ", "exactly one"],
        ),
        (
            "negative-density",
            with(&format!(
                "{grid} fabric: {{custom: {{density_kg_per_m2: -0.2, stretching_n_per_m: {{warp: 9, weft: 9, shear: 3}}, bending_n_m: {{warp: 0, weft: 0, bias: 0}}}}}}"
            )),
            &["density_kg_per_m2: must be positive and finite, got -0.2"],
        ),
        (
            "absurd-stiffness",
            with(&format!(
                "{grid} fabric: {{custom: {{density_kg_per_m2: 0.2, stretching_n_per_m: {{warp: 1e30, weft: 9, shear: 3}}, bending_n_m: {{warp: 0, weft: 0, bias: 0}}}}}}"
            )),
            &["warp: ", "1e30"],
        ),
        (
            "huge-grid",
            with("mesh: {grid: {size_m: [1, 1], cells: [100000, 100000]}}, fabric: 'denim'"),
            &["cloths[0].mesh.grid.cells: "],
        ),
        (
            "fine-tunic",
            with(
                "mesh: {tunic: {width_m: 0.6, length_m: 0.8, armhole_m: 0.2, neck_width_m: 0.3, cell_m: 1e-5}}, fabric: 'denim'",
            ),
            &["cloths[0].mesh: ", "triangles are too many"],
        ),
        (
            "far-away",
            with(&format!("{grid} fabric: 'denim', transform: {{translate: [1e9, 0, 0]}}")),
            &["transform.translate"],
        ),
        (
            "reversed-limits",
            with(&format!("{grid} fabric: 'denim', strain_limits: [1.1, 0.9]")),
            &["strain_limits: reversed"],
        ),
        (
            "reversed-sizes",
            with(&format!("{grid} fabric: 'denim', remeshing: {{size_m: {{min: 1, max: 0.1}}}}")),
            &["remeshing.size_m: "],
        ),
        (
            "unsupported",
            format!("{{frames: 1, morphs: {{}}, {CLOTH}}}"),
            &["s.json5:1:13: morphs: not supported yet", "--allow-unsupported"],
        ),
        (
            "handle-without-cloth",
            format!("{{frames: 1, {CLOTH}, handles: [{{cloth: 'flag', select: 'all'}}]}}"),
            &["s.json5:1:", "handles[0].cloth: ", "flag"],
        ),
        (
            "handle-on-missing-vertex",
            format!("{{frames: 1, {CLOTH}, handles: [\n{{select: {{vertices: [1, 7]}}}}]}}"),
            &["s.json5:2:", "handles[0].select: ", "vertex 7"],
        ),
        (
            "blind-camera",
            format!("{{frames: 1, {CLOTH}, camera: {{position: [1, 1, 1], target: [1, 1, 1]}}}}"),
            &["camera.target: "],
        ),
        (
            "no-measurements",
            with(&format!("{grid} fabric: {{measured: 'm.json'}}")),
            &["fabric.measured: ", "m.json"],
        ),
    ];
    let cases: Vec<(&str, &str, &[&str])> = owned.iter().map(|(n, t, p)| (*n, &**t, *p)).collect();
    table(&cases, &["simulate", "s.json5"], "s.json5");
}

#[test]
fn meshes() {
    let cases: [(&str, &str, &[&str]); 15] = [
        ("obj-empty", "", &["a.obj: the OBJ file has no vertices"]),
        ("obj-no-faces", "v 0 0 0\n", &["a.obj: the OBJ file has no faces"]),
        ("obj-binary", "v 0 0 0\nv \0\0\0", &["a.obj: line 2: not text"]),
        (
            "obj-word",
            "v 0 0 0\nv one 0 0\nv 0 1 0\nf 1 2 3\n",
            &["a.obj: line 2: ", "not a number"],
        ),
        ("obj-short", "v 0 0\n", &["a.obj: line 1: 2 numbers after `v`"]),
        ("obj-nan", "v 0 0 NaN\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", &["a.obj: line 1: "]),
        ("obj-huge", "v 0 0 0\nv 1e12 0 0\nv 0 1 0\nf 1 2 3\n", &["a.obj: line 2: ", "1e12 m"]),
        ("obj-index", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", &["a.obj: line 4: ", "number 4"]),
        ("obj-zero-index", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", &["a.obj: line 4: "]),
        ("obj-two-corners", "v 0 0 0\nv 1 0 0\nf 1 2\n", &["a.obj: line 3: a face of 2 corners"]),
        (
            "obj-twice",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n",
            &["a.obj: line 4: ", "vertex 2 twice"],
        ),
        (
            "obj-turned-over",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\n",
            &["a.obj: line 4: ", "-5e-1 m²"],
        ),
        ("obj-flat", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", &["a.obj: line 4: ", "area 0e0 m²"]),
        (
            "obj-three-at-an-edge",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1 2 0\nf 1 2 3\nf 3 2 4\nf 3 2 5\n",
            &["a.obj: line 8: ", "not manifold"],
        ),
        (
            "obj-bow-tie",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n",
            &["a.obj: line 1: ", "several fans"],
        ),
    ];
    table(&cases, &["simulate", "s.json5"], "a.obj");
    // The place in the scene stands in front.
    refused(
        "obj-place",
        &[("a.obj", b"v")],
        &["check", "s.json5"],
        &["s.json5:2:23: cloths[0].mesh.obj: a.obj: line 1"],
    );
}

#[test]
fn materials() {
    let scene = SCENE.replace("'denim'", "{measured: 'm.json'}");
    let rows = ["[9, 1, 9, 3]"; 6].join(",");
    let bend = ["[1e-5, 1e-5, 1e-5, 1e-5, 1e-5]"; 3].join(",");
    let material = |density: &str, rows: &str| {
        format!("{{\"density\": {density},\n\"stretching\": [{rows}],\n\"bending\": [{bend}]}}")
    };
    for (name, text, parts) in [
        ("material-good", material("0.2", &rows), None),
        ("material-empty", String::new(), Some(["m.json:1:1: ", "cut short?"])),
        ("material-light", material("-1", &rows), Some(["m.json:1:", "density: "])),
        ("material-short", material("0.2", "[1, 2, 3, 4]"), Some(["m.json:2:", "stretching"])),
        (
            "material-nan",
            material("0.2", &rows.replacen('9', "NaN", 1)),
            Some(["m.json:2:", "NaN"]),
        ),
        ("material-cut", material("0.2", &rows)[..30].into(), Some(["m.json:2:", ""])),
    ] {
        let files = [("s.json5", scene.as_bytes()), ("m.json", text.as_bytes())];
        match parts {
            Some(parts) => refused(name, &files, &["simulate", "s.json5"], &parts),
            None => {
                let folder = Folder::new("bad-material-base");
                files.iter().for_each(|(name, content)| folder.write(name, content));
                folder.write("a.obj", SCRAP);
                folder.good(&["simulate", "s.json5"]);
            }
        }
    }
}

#[test]
fn arguments() {
    let cases: [(&[&str], &[&str]); 31] = [
        (&[], &["Usage: organza <COMMAND>"]),
        (&["simulte", "s.json5"], &["simulte", "similar", "simulate"]),
        (&["simulate"], &["SCENE"]),
        (&["simulate", "missing.json5"], &["missing.json5: ", "No such file"]),
        (&["simulate", "."], &[".: "]),
        (&["simulate", ".."], &["..: not the name of a scene file"]),
        (&["check", "."], &[".: cannot be read: "]),
        (&["simulate", "s.json5", "--frames", "0"], &["--frames", "0"]),
        (&["simulate", "s.json5", "--frames", "-1"], &["-1"]),
        (&["simulate", "s.json5", "--frames", "1e3"], &["--frames", "1e3"]),
        (&["simulate", "s.json5", "--frames", "4294967295"], &["4294967295 frames: ", "limit"]),
        (&["simulate", "s.json5", "--threads", "0"], &["--threads"]),
        (&["simulate", "s.json5", "--threads", "60000"], &["--threads"]),
        (&["simulate", "s.json5", "--checkpoint-every", "0"], &["--checkpoint-every"]),
        (&["simulate", "s.json5", "--set", "frames"], &["--set frames: expected PATH=VALUE"]),
        (&["simulate", "s.json5", "--set", "frames=0"], &["--set frames=0: frames: "]),
        (&["simulate", "s.json5", "--set", "cloths[3].fabric=denim"], &["no element 3"]),
        (&["simulate", "s.json5", "--set", "wnd.density=1"], &["wnd", "`wind`"]),
        (&["simulate", "s.json5", "--out", "no/such/run.mcap"], &["no/such/run.mcap: "]),
        (&["simulate", "s.json5", "--out", "."], &[".: a folder, not a file"]),
        (
            &["simulate", "s.json5", "--out", "no/..", "--overwrite"],
            &["no/..: a folder, not a file"],
        ),
        (&["simulate", "s.json5", "--out", "a.obj"], &["a.obj: exists already; use --overwrite"]),
        (&["simulate", "s.json5", "--out", "run.png"], &["run.png: ", "picture"]),
        (&["simulate", "s.json5", "--out", "s.json5", "--overwrite"], &["would replace the scene"]),
        (&["export", "s.json5", "--format", "stl", "--out", "o"], &["stl", "obj", "ply"]),
        (&["export", "s.json5", "--format", "obj"], &["--out"]),
        (&["render", "s.json5", "--out", "o", "--frames", "5..2"], &["5..2 holds no frame"]),
        (&["render", "s.json5", "--out", "o", "--frames", "first"], &["A..B", "first"]),
        (&["render", "s.json5", "--out", "o", "--size", "0x20"], &["--size", "1 to 16384 pixels"]),
        (&["render", "s.json5", "--out", "o", "--size", "large"], &["WIDTHxHEIGHT"]),
        (&["render", "s.json5", "--out", "o", "--view", "inside"], &["inside", "camera"]),
    ];
    for (k, (args, parts)) in cases.iter().enumerate() {
        refused(&format!("argument-{k}"), &[], args, parts);
    }
}

#[test]
fn recordings() {
    let folder = Folder::new("bad-recordings");
    folder.write("s.json5", SCENE);
    folder.write("a.obj", SCRAP);
    folder.good(&["simulate", "s.json5"]);
    let good = folder.read("s.mcap");
    let mut foreign = Vec::new();
    // A whole MCAP without anything of ours: magic, header, footer, magic.
    foreign.extend(&good[..8]);
    foreign.extend([1, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    foreign.extend([2, 20, 0, 0, 0, 0, 0, 0, 0]);
    foreign.extend([0; 20]);
    foreign.extend(&good[..8]);
    let mut later = good.clone();
    let at = later.windows(6).position(|w| w == b"format").unwrap();
    later[at + 10] = b'7';

    let commands: [&[&str]; 5] = [
        &["info", "r.mcap"],
        &["info", "r.mcap", "--json"],
        &["resume", "r.mcap"],
        &["export", "r.mcap", "--format", "obj", "--out", "o"],
        &["render", "r.mcap", "--out", "o"],
    ];
    let cases: [(&str, &[u8], &str); 7] = [
        ("zero-length", b"", "r.mcap: the file is empty (0 bytes)"),
        ("text", b"frame,time\n0,0\n", "r.mcap: not an MCAP file: it begins with"),
        ("magic-alone", &good[..8], "r.mcap: "),
        ("cut-in-header", &good[..100], "r.mcap: "),
        ("cut-in-magic", &good[..5], "r.mcap: not an MCAP file"),
        ("foreign", &foreign, "r.mcap: an MCAP file, but not a recording"),
        ("later-format", &later, "r.mcap: "),
    ];
    for (name, bytes, part) in cases {
        for (k, command) in commands.iter().enumerate() {
            refused(&format!("recording-{name}-{k}"), &[("r.mcap", bytes)], command, &[part]);
        }
    }
    for (k, command) in commands.iter().enumerate() {
        let missing = format!("recording-missing-{k}");
        refused(&missing, &[], command, &["r.mcap: cannot open the recording: No such file"]);
        let folder = format!("recording-folder-{k}");
        refused(&folder, &[("r.mcap/x", b"")], command, &["r.mcap: cannot "]);
    }
    for command in &commands[3..] {
        let args = [command, &["--frames", "10.."][..]].concat();
        let parts = ["r.mcap: none of the frames 10..: it holds frames 0 to 2"];
        refused("recording-frames", &[("r.mcap", &good)], &args, &parts);
        let args: Vec<&str> =
            command.iter().map(|&a| if a == "o" { "s.json5" } else { a }).collect();
        let parts = ["s.json5: cannot make this folder: "];
        refused("recording-out", &[("r.mcap", &good)], &args, &parts);
    }
    refused(
        "recording-poster",
        &[("s.png", b"a picture of mine")],
        &["simulate", "s.json5"],
        &["s.png: exists already; use --overwrite"],
    );
}

/// The attached scene is input as well: it may come from another version or be damaged with care.
#[test]
fn what_a_recording_carries() {
    use io_mcap::{Header, Overwrite, Recorder, Recording};
    let folder = Folder::new("bad-carried");
    folder.write("s.json5", SCENE);
    folder.write("a.obj", SCRAP);
    folder.good(&["simulate", "s.json5"]);
    let mut recording = Recording::open(folder.path("s.mcap")).unwrap();
    let header = recording.header().unwrap();
    let frame = recording.frame(0).unwrap();
    let changed = |change: &dyn Fn(&mut Header)| {
        let mut header = header.clone();
        change(&mut header);
        let path = folder.path("r.mcap");
        let mut recorder = Recorder::create(&path, header, Overwrite::Yes).unwrap();
        let garments: Vec<_> = frame.garments.iter().map(|g| g.borrowed()).collect();
        let frame = io_mcap::Frame {
            index: 0,
            time_s: 0.0,
            garments: &garments,
            obstacles: &[],
            fluid: None,
            camera: None,
            transforms: &[],
            report: &serde_json::json!({"frame": "none"}),
        };
        recorder.frame(&frame).unwrap();
        drop(recorder);
        folder.read("r.mcap")
    };
    type Change<'a> = &'a dyn Fn(&mut Header);
    let cases: [(&str, Change<'_>, &[&str]); 6] = [
        ("no-scene", &|h| h.attachments.clear(), &["r.mcap: no scene is attached"]),
        ("no-mesh", &|h| drop(h.attachments.pop()), &["r.mcap/scene/s.json5:2:", "`a.obj`"]),
        ("no-sets", &|h| drop(h.metadata.remove("sets")), &["r.mcap: its metadata has no `sets`"]),
        (
            "bad-sets",
            &|h| drop(h.metadata.insert("sets".into(), "{".into())),
            &["r.mcap: ", "sets"],
        ),
        (
            "no-frames",
            &|h| drop(h.metadata.insert("frames".into(), "0".into())),
            &["r.mcap: ", "frames"],
        ),
        (
            "bad-scene",
            &|h| h.attachments[0].data = SCENE.replace("frames: 2", "frames: 0").into_bytes(),
            &["r.mcap/scene/s.json5:1:10: frames: "],
        ),
    ];
    for (name, change, parts) in cases {
        let bytes = changed(change);
        refused(&format!("carried-{name}"), &[("r.mcap", &bytes)], &["resume", "r.mcap"], parts);
    }
    let bytes = changed(&|_| {});
    let parts = ["r.mcap: the report of frame 0 is of another form"];
    refused("carried-report", &[("r.mcap", &bytes)], &["info", "r.mcap"], &parts);
}

#[cfg(unix)]
#[test]
fn outputs_that_cannot_be_written() {
    use std::process::Stdio;
    // A device that is always full.
    if std::path::Path::new("/dev/full").exists() {
        let args = ["simulate", "s.json5", "--out", "/dev/full", "--overwrite"];
        refused("full-device", &[], &args, &["/dev/full: "]);
        assert!(std::path::Path::new("/dev/full").exists());
    }
    // A reader that goes away: no error, as in `organza info run.mcap | head`.
    let folder = Folder::new("bad-pipe");
    folder.write("s.json5", SCENE);
    folder.write("a.obj", SCRAP);
    folder.good(&["simulate", "s.json5", "--frames", "200"]);
    for args in
        [&["info", "s.mcap", "--json"][..], &["info", "s.mcap"], &["help"], &["check", "s.json5"]]
    {
        let mut child =
            folder.command(args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let ran = Ran::new(child.wait_with_output().unwrap());
        assert_eq!((ran.code, &*ran.err), (0, ""), "{args:?}");
    }
    // Nobody listens to messages either.
    let mut child =
        folder.command(&["simulate", "none.json5"]).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stderr.take());
    assert_eq!(child.wait().unwrap().code(), Some(2));
}
