//! Bad files of animated obstacles: exit code 2, the file and the place in the message, and nothing
//! left behind.

mod cli_common;

use cli_common::*;

#[test]
fn files_of_animated_obstacles() {
    let scene = |mesh: &str| {
        format!(
            "{{frames: 2, cloths: [{{mesh: {{obj: 'a.obj'}}, fabric: 'denim'}}],\nobstacles: [{{mesh: {mesh}}}]}}"
        )
    };
    let sequence =
        scene("{obj_sequence: {files: 'f%d.obj', frames: [1, 2], frames_per_second: 9}}");
    let gltf = scene("{gltf: {file: 'body.glb'}}");
    let motions = "{\"frame_time\": 0.1, \"end_time\": 1,\n\"motions\": {\"motfile\": \"a.mot\", \"fps\": 30},\n\
                   \"obstacles\": \"body%d.obj\", \"cloths\": [{\"mesh\": \"a.obj\", \"materials\": []}]}";
    let good = SCRAP.as_bytes();
    // Name, scene, files beside it, parts of the message.
    type Case<'a> = (&'a str, &'a str, &'a [(&'a str, &'a [u8])], &'a [&'a str]);
    let cases: [Case<'_>; 6] = [
        (
            "frame-missing",
            &sequence,
            &[("f1.obj", good)],
            &["s.json5:2:43: obstacles[0].mesh.obj_sequence.files: there is no file `f2.obj`"],
        ),
        (
            "frame-differs",
            &sequence,
            &[
                ("f1.obj", good),
                ("f2.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n"),
            ],
            &["s.json5:2:20: obstacles[0].mesh: f2.obj: has "],
        ),
        (
            "no-gltf",
            &gltf,
            &[],
            &["s.json5:2:34: obstacles[0].mesh.gltf.file: there is no file `body.glb`"],
        ),
        (
            "bad-gltf",
            &gltf,
            &[("body.glb", b"glTF\x02\0\0\0")],
            &[
                "s.json5:2:34: obstacles[0].mesh.gltf.file: `body.glb` is not glTF: the header is cut off",
            ],
        ),
        (
            "no-bodies",
            motions,
            &[("a.mot", b"NumFrames: 1\nbody[0] position\n0 0\n")],
            &[
                "s.json5:2:24: motions.motfile: `a.mot`: line 3: expected 3 numbers of position",
                "s.json5:3:14: obstacles: there is no file `body0.obj` (looked for ",
            ],
        ),
        (
            "endless-frames",
            &scene(
                "{obj_sequence: {files: 'f%d.obj', frames: [0, 4294967295], frames_per_second: 9}}",
            ),
            &[],
            &[
                "s.json5:2:62: obstacles[0].mesh.obj_sequence.frames: 4.294967296e9 frames is beyond the limit",
            ],
        ),
    ];
    for (name, scene, files, parts) in cases {
        let mut files = files.to_vec();
        files.extend([("s.json5", scene.as_bytes()), ("a.obj", good)]);
        let folder = Folder::new(&format!("bad-bodies/{name}"));
        files.iter().for_each(|(file, content)| folder.write(file, content));
        let before = folder.listing();
        for command in ["check", "simulate"] {
            let ran = folder.run(&[command, "s.json5"]);
            assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{name}: {ran:?}");
            for part in parts {
                assert!(ran.err.contains(part), "{name}: no {part:?} in\n{}", ran.err);
            }
            assert_eq!(folder.listing(), before, "{name}");
        }
    }
}
