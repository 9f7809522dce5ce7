//! Recordings of killed runs: every frame that was complete is read back, and the message is clear.

mod cli_common;

use cli_common::*;
use io_mcap::Recording;

fn recording(name: &str) -> (Folder, Vec<u8>) {
    let folder = Folder::new(name);
    folder.write("two.json5", TWO);
    folder.good(&["simulate", "two.json5", "--quiet"]);
    let bytes = folder.read("two.mcap");
    (folder, bytes)
}

#[test]
fn killed_at_twenty_random_bytes() {
    let (folder, bytes) = recording("killed");
    let all = frames(&folder.path("two.mcap"));
    // Where each frame is complete, found by cutting at every place.
    let count = |at: usize| {
        let recording = Recording::read(std::io::Cursor::new(&bytes[..at]), Default::default());
        recording.map_or(0, |recording| recording.frames().len())
    };
    let ends: Vec<usize> = (1..=all.len())
        .map(|n| {
            let (mut low, mut high) = (0, bytes.len());
            while high - low > 1 {
                let middle = (low + high) / 2;
                if count(middle) >= n { high = middle } else { low = middle }
            }
            high
        })
        .collect();
    assert!(ends.is_sorted(), "{ends:?}");

    let mut random = Random(20);
    for _ in 0..20 {
        let cut = random.below(bytes.len());
        folder.write("cut.mcap", &bytes[..cut]);
        let complete = ends.iter().filter(|&&end| end <= cut).count();
        let ran = folder.run(&["info", "cut.mcap"]);
        if complete == 0 {
            assert!(
                ran.code == 2 || ran.out.contains("cut short: 0 frames can be read"),
                "{ran:?}"
            );
            assert!(ran.code == 0 || ran.err.starts_with("error: cut.mcap: "), "{}", ran.err);
            continue;
        }
        assert_eq!(ran.code, 0, "{ran:?}");
        let message = format!("cut short: {complete} frames can be read");
        assert!(ran.out.contains(&message) && ran.out.contains("at byte "), "{}", ran.out);
        assert!(ran.out.contains(&format!("{complete} of 7 frames")), "{}", ran.out);

        let read = frames(&folder.path("cut.mcap"));
        assert_eq!(read.len(), complete);
        read.iter().zip(&all).for_each(|(a, b)| assert!(a == b, "frame {}", a.index));
        let out = format!("at-{cut}");
        let ran = folder.good(&["export", "cut.mcap", "--format", "ply", "--out", &out]);
        assert!(ran.err.contains(&format!("warning: cut.mcap: {message}")), "{}", ran.err);
        assert_eq!(std::fs::read_dir(folder.path(&out)).unwrap().count(), complete);
    }
}

#[test]
fn damage_is_told_and_made_good() {
    let (folder, bytes) = recording("damaged");
    let all = frames(&folder.path("two.mcap"));
    let (mut lost, mut repaired) = (0, 0);
    for k in 1..12 {
        let at = k * bytes.len() / 12;
        let mut broken = bytes.clone();
        broken[at] ^= 0x10;
        folder.write("broken.mcap", &broken);
        let mut recording = Recording::open(folder.path("broken.mcap")).unwrap();
        recording.verify().unwrap();
        let left: Vec<u64> = recording.frames().map(|f| f.index).collect();
        let missing = (0..7).find(|k| !left.contains(k));
        if let Some(missing) = missing {
            // Nothing is made of what is damaged, and the message has the place.
            let frame = missing.to_string();
            let args = ["export", "broken.mcap", "--format=obj", "--out=o", "--frames", &frame];
            let ran = folder.run(&args);
            assert_eq!(ran.code, 2, "at {at}: {ran:?}");
            assert!(ran.err.contains("broken.mcap: damaged at byte "), "at {at}: {ran:?}");
            assert!(!folder.path(&format!("o/frame_{missing:05}.obj")).exists());
            lost += 1;
        }
        let ran = folder.good(&["resume", "broken.mcap"]);
        if ran.out.contains("complete to frame 6 already") {
            continue;
        }
        let now = frames(&folder.path("broken.mcap"));
        assert_eq!(now.len(), all.len(), "at {at}");
        now.iter().zip(&all).for_each(|(a, b)| assert_same(a, b, &format!("at {at}")));
        repaired += 1;
    }
    assert!(lost >= 3 && repaired >= lost, "{lost} {repaired}");
}

/// The file may grow to 120 blocks of 512 bytes (or of 1024 in some shells); then the system refuses
/// to write, or kills.
#[cfg(unix)]
mod full {
    use super::*;
    use std::process::Command;

    fn limited(folder: &Folder, trap: &str) -> std::process::Output {
        let script = format!("{trap} ulimit -f 120; exec \"$0\" \"$@\"");
        Command::new("sh")
            .args(["-c", &script, env!("CARGO_BIN_EXE_organza"), "simulate", "two.json5"])
            .current_dir(folder.path(""))
            .output()
            .unwrap()
    }

    fn assert_continues(folder: &Folder) {
        let kept = frames(&folder.path("two.mcap"));
        assert!((1..7).contains(&kept.len()), "{} frames", kept.len());
        folder.good(&["simulate", "two.json5", "--out", "whole.mcap", "-q"]);
        let all = frames(&folder.path("whole.mcap"));
        kept.iter().zip(&all).for_each(|(a, b)| assert_same(a, b, "kept"));
        folder.good(&["resume", "two.mcap"]);
        let resumed = frames(&folder.path("two.mcap"));
        assert_eq!(resumed.len(), all.len());
        resumed.iter().zip(&all).for_each(|(a, b)| assert_same(a, b, "resumed"));
    }

    #[test]
    fn a_full_disk_ends_the_run_with_a_message() {
        let folder = Folder::new("full");
        folder.write("two.json5", TWO);
        let ran = Ran::new(limited(&folder, "trap '' XFSZ;"));
        assert_eq!(ran.code, 1, "{ran:?}");
        assert!(ran.err.contains("error: two.mcap: "), "{ran:?}");
        assert!(ran.err.contains("two.mcap keeps frames 0 to "), "{ran:?}");
        assert!(ran.err.contains("`organza resume two.mcap` continues it"), "{ran:?}");
        assert_eq!(folder.listing(), ["two.json5", "two.mcap"]);
        let kept = frames(&folder.path("two.mcap")).len() - 1;
        assert!(ran.err.contains(&format!("keeps frames 0 to {kept};")), "{kept}: {ran:?}");
        assert_continues(&folder);
    }

    #[test]
    fn a_run_killed_by_the_system_keeps_its_frames() {
        let folder = Folder::new("signal");
        folder.write("two.json5", TWO);
        let output = limited(&folder, "");
        assert!(output.status.code().is_none(), "not killed: {output:?}");
        assert_continues(&folder);
    }
}
