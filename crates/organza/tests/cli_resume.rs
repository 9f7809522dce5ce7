//! A run that was cut short and continued has the same bits as one that was never interrupted.

mod cli_common;

use std::fs;
use std::io::Cursor;

use cli_common::*;
use io_mcap::{Checkpoint, Column, Recording, Status};

/// The folder, and the bytes of an uninterrupted run of six frames.
fn whole(name: &str) -> (Folder, Vec<u8>) {
    let folder = Folder::new(name);
    folder.write("two.json5", TWO);
    folder.good(&["simulate", "two.json5", "--quiet"]);
    let bytes = folder.read("two.mcap");
    // A resume needs the recording alone.
    fs::remove_file(folder.path("two.json5")).unwrap();
    (folder, bytes)
}

#[track_caller]
fn assert_equal_runs(folder: &Folder, a: &str, b: &str, what: &str) {
    let [a, b] = [a, b].map(|name| folder.path(name));
    let statuses = [&a, &b].map(|path| {
        let recording = Recording::open(path).unwrap();
        (recording.status(), recording.checkpoints().map(|c| c.frame).collect::<Vec<_>>())
    });
    assert_eq!(statuses[0], statuses[1], "{what}");
    assert_eq!(statuses[0].0, Status::Complete, "{what}");
    let [a_frames, b_frames] = [&a, &b].map(|path| frames(path));
    assert_eq!(a_frames.len(), b_frames.len(), "{what}");
    a_frames.iter().zip(&b_frames).for_each(|(a, b)| assert_same(a, b, what));
    let [mut a, mut b] = [a, b].map(|path| Recording::open(path).unwrap());
    for frame in statuses[0].1.iter().copied() {
        let [a, b] = [&mut a, &mut b].map(|recording| recording.checkpoint(frame).unwrap());
        assert!(bits(&a) == bits(&b), "{what}: checkpoint {frame}");
    }
}

/// Columns whose numbers compare by their bits: places that are not known yet are not numbers.
fn bits(checkpoint: &Checkpoint) -> Vec<(&str, Column)> {
    let column = |column: &Column| match column {
        Column::F64(values) => Column::U64(values.iter().map(|x| x.to_bits()).collect()),
        other => other.clone(),
    };
    checkpoint.columns.iter().map(|(name, values)| (&**name, column(values))).collect()
}

fn readable(bytes: &[u8]) -> Option<Recording<Cursor<&[u8]>>> {
    Recording::read(Cursor::new(bytes), Default::default()).ok()
}

#[test]
fn resumed_equals_uninterrupted() {
    let (folder, bytes) = whole("resume");
    // Where frames and checkpoints end, a little inside of each, and anywhere.
    let mut random = Random(1);
    let mut cuts: Vec<usize> = (0..5).map(|_| random.below(bytes.len())).collect();
    let mut seen = 0;
    for at in (0..bytes.len()).step_by(bytes.len() / 400) {
        let found = readable(&bytes[..at]);
        let now = found.map_or(0, |found| found.frames().len() + found.checkpoints().len());
        if now > seen {
            cuts.push(at);
            seen = now;
        }
    }
    cuts.extend([bytes.len() - 1, bytes.len() - 100]);
    assert!(cuts.len() >= 15, "{cuts:?}");

    let mut resumed = 0;
    for cut in cuts {
        folder.write("cut.mcap", &bytes[..cut]);
        let what = format!("cut at {cut} of {}", bytes.len());
        let ran = folder.run(&["resume", "cut.mcap"]);
        let readable = Recording::open(folder.path("cut.mcap"));
        if ran.code == 2 && readable.map_or(0, |r| r.frames().len()) == 0 {
            // Not even the header is whole: there is nothing to go on from, and nothing is changed.
            assert!(ran.err.starts_with("error: cut.mcap: "), "{what}: {}", ran.err);
            assert!(folder.read("cut.mcap") == bytes[..cut], "{what}");
            assert_eq!(folder.listing(), ["cut.mcap", "two.mcap", "two.png"]);
            continue;
        }
        assert_eq!(ran.code, 0, "{what}: {ran:?}");
        assert_equal_runs(&folder, "cut.mcap", "two.mcap", &what);
        assert_eq!(folder.read("cut.png"), folder.read("two.png"), "{what}");
        assert_eq!(folder.listing(), ["cut.mcap", "cut.png", "two.mcap", "two.png"], "{what}");
        fs::remove_file(folder.path("cut.png")).unwrap();
        resumed += 1;
    }
    assert!(resumed >= 10, "{resumed}");
}

#[test]
fn a_complete_recording_is_left_alone_or_continued_beyond_its_end() {
    let (folder, bytes) = whole("beyond");
    for args in [&["resume", "two.mcap"][..], &["resume", "two.mcap", "--frames", "3"]] {
        let ran = folder.good(args);
        assert!(ran.out.contains("two.mcap: complete to frame 6 already"), "{ran:?}");
        assert!(folder.read("two.mcap") == bytes);
    }
    // A goal that is no multiple of the interval leaves a checkpoint that no longer run has.
    folder.write("two.json5", TWO);
    folder.good(&["simulate", "two.json5", "--out", "five.mcap", "--frames", "5", "-q"]);
    folder.good(&["simulate", "two.json5", "--out", "eight.mcap", "--frames", "8", "-q"]);
    for short in ["two.mcap", "five.mcap"] {
        let ran = folder.good(&["resume", short, "--frames", "8"]);
        assert!(ran.err.contains("complete frames found, going on after frame"), "{ran:?}");
        assert_equal_runs(&folder, short, "eight.mcap", short);
    }
}

#[test]
fn settings_of_the_command_line_are_part_of_the_recording() {
    let folder = Folder::new("settings");
    folder.write("two.json5", TWO);
    let args = ["simulate", "two.json5", "--frames", "4", "--checkpoint-every", "3", "--quiet"];
    let sets = ["--set", "gravity=[1,0,-5]", "--set", "cloths[1].fabric=knit-light"];
    folder.good(&[&args[..], &sets].concat());
    fs::remove_file(folder.path("two.json5")).unwrap();
    let bytes = folder.read("two.mcap");
    for cut in [bytes.len() * 2 / 5, bytes.len() * 3 / 4, bytes.len() - 200] {
        folder.write("cut.mcap", &bytes[..cut]);
        folder.good(&["resume", "cut.mcap", "--quiet"]);
        assert_equal_runs(&folder, "cut.mcap", "two.mcap", &format!("cut at {cut}"));
    }
}

#[test]
fn a_scene_with_files_is_resumed_from_its_attachments() {
    let folder = Folder::new("files");
    folder.write("s/tri.json5", TRIANGLE);
    folder.write("s/scrap.obj", SCRAP);
    folder.good(&["simulate", "s/tri.json5", "--set", "recording.checkpoint_every_frames=1"]);
    fs::remove_dir_all(folder.path("s")).unwrap();
    let bytes = folder.read("tri.mcap");
    let two_frames =
        |cut: &usize| readable(&bytes[..*cut]).is_some_and(|found| found.frames().len() == 2);
    let cut = (0..bytes.len()).rev().step_by(50).find(two_frames).unwrap();
    folder.write("cut.mcap", &bytes[..cut]);
    folder.good(&["resume", "cut.mcap"]);
    assert_equal_runs(&folder, "cut.mcap", "tri.mcap", "from attachments");
    assert_eq!(frames(&folder.path("cut.mcap")).len(), 4);
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let folder = Folder::new("threads");
    folder.write("two.json5", TWO);
    // Enough faces for every parallel loop to be one.
    let larger = [
        "--set",
        "cloths[0].mesh.grid.cells=[24,24]",
        "--set",
        "cloths[0].remeshing.size_m.max=0.06",
    ];
    for threads in ["1", "2", "5"] {
        let out = format!("{threads}.mcap");
        let args =
            ["simulate", "two.json5", "--out", &out, "--threads", threads, "--frames", "4", "-q"];
        folder.good(&[&args[..], &larger].concat());
    }
    let faces = frames(&folder.path("1.mcap"))[4].report["faces"].as_u64().unwrap();
    assert!(faces > 600, "{faces}");
    for other in ["2.mcap", "5.mcap"] {
        assert_equal_runs(&folder, "1.mcap", other, other);
    }
}
