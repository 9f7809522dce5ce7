//! A run whose steps fail: exit code 1, a message with frame and time, and whatever was recorded
//! before is whole.

mod cli_common;

use cli_common::*;
use io_mcap::Recording;

/// A scrap of cloth so small that moving a corner by a millimetre stretches it beyond what a number
/// can hold. It is at rest for two frames; then a handle pulls.
const SCENE: &str = "{
  frames: 6, frames_per_second: 25, substeps: 2, gravity: [0, 0, 0],
  cloths: [{ name: 'speck', mesh: { obj: 'speck.obj' }, fabric: 'denim' }],
  handles: [{ select: { vertices: [0] }, motion: { interpolation: 'linear', keyframes: [
    { time_s: 0.08 }, { time_s: 0.2, transform: { translate: [1, 0, 0] } } ] } }],
  recording: { checkpoint_every_frames: 1 },
}";

#[test]
fn a_failing_step_ends_the_run_and_keeps_what_was_before() {
    let folder = Folder::new("failed");
    folder.write("speck.json5", SCENE);
    folder.write("speck.obj", "v 0 0 0\nv 1e-90 0 0\nv 0 1e-90 0\nf 1 2 3\n");
    let ran = folder.run(&["simulate", "speck.json5"]);
    assert_eq!((ran.code, ran.out.as_str()), (1, ""), "{ran:?}");
    for part in [
        "error: frame 3: the step at 0.08 s failed even when cut to ",
        "the energy of the cloth is not finite at time 0.08",
        "speck.mcap keeps frames 0 to 2",
        "--set substeps=",
    ] {
        assert!(ran.err.contains(part), "no {part:?} in\n{}", ran.err);
    }
    assert_eq!(folder.listing(), ["speck.json5", "speck.mcap", "speck.obj"]);

    let check = |what: &str| {
        let read = frames(&folder.path("speck.mcap"));
        assert_eq!(read.iter().map(|f| f.index).collect::<Vec<_>>(), [0, 1, 2], "{what}");
        for frame in &read {
            assert_eq!(frame.garments[0].points, read[0].garments[0].points, "{what}");
        }
        let mut recording = Recording::open(folder.path("speck.mcap")).unwrap();
        for frame in 0..3 {
            assert_eq!(recording.checkpoint(frame).unwrap().frame, frame, "{what}");
        }
        let info = folder.good(&["info", "speck.mcap"]);
        assert!(info.out.contains("cut short: 3 frames can be read"), "{}", info.out);
        assert!(info.out.contains("3 of 7 frames"), "{}", info.out);
    };
    check("simulate");
    let bytes = folder.read("speck.mcap");
    folder.good(&["export", "speck.mcap", "--format", "obj", "--out", "meshes"]);

    // It lay in the scene, so another try ends at the same place.
    let again = folder.run(&["resume", "speck.mcap", "--quiet"]);
    assert_eq!((again.code, again.out.as_str()), (1, ""), "{again:?}");
    assert!(again.err.contains("frame 3: the step at 0.08 s failed"), "{}", again.err);
    check("resume");
    assert_eq!(folder.read("speck.mcap").len(), bytes.len());
}
