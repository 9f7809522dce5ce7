//! A recording continued after a cut is the one that would have been without it.

mod common;

use std::fs;

use common::*;
use io_mcap::{Error, Overwrite, Recorder, Recording, Status};

const N_FRAMES: u64 = 8;

#[test]
fn continued_equals_uninterrupted() {
    let (whole, lengths) = recording_of(N_FRAMES);
    let mut random = Random(7);
    let mut cuts: Vec<usize> =
        (0..8).map(|_| lengths[3] + random.below(whole.len() - lengths[3])).collect();
    cuts.extend([lengths[3], lengths[5], lengths[5] + 1, whole.len()]);
    for (k, cut) in cuts.into_iter().enumerate() {
        let path = path(&format!("resume-{k}.mcap"));
        fs::write(&path, &whole[..cut]).unwrap();
        for up_to in [3, 0] {
            let mut recorder = Recorder::resume(&path, up_to).unwrap();
            assert_eq!(recorder.last_frame().unwrap().index, up_to);
            // Before anything is added, the file holds what was kept.
            let mut kept = Recording::open(&path).unwrap();
            assert_eq!(kept.frames().len() as u64, up_to + 1);
            assert_eq!(frame_bits(&kept.frame(up_to).unwrap()), frame_bits(&frame(up_to)));
            assert!(fs::read(&path).unwrap() == whole[..lengths[up_to as usize]]);
            for index in up_to + 1..N_FRAMES {
                record(&mut recorder, index);
            }
            recorder.finish().unwrap();
            assert!(fs::read(&path).unwrap() == whole, "cut at {cut}, continued at {up_to}");
        }
    }
}

#[test]
fn a_frame_without_its_checkpoint_can_be_continued() {
    let (whole, lengths) = recording_of(4);
    // Frame 3 is there, its checkpoint is cut.
    let bytes = &whole[..lengths[3] - 300];
    let path = path("no-checkpoint.mcap");
    fs::write(&path, bytes).unwrap();
    let mut recorder = Recorder::resume(&path, 3).unwrap();
    recorder.checkpoint(&checkpoint(3)).unwrap();
    recorder.finish().unwrap();
    assert!(fs::read(&path).unwrap() == whole);
}

#[test]
fn garments_gone_since_the_cut_are_deleted_from_view() {
    let path = path("gone.mcap");
    let mut recorder = Recorder::create(&path, header(), Overwrite::No).unwrap();
    record(&mut recorder, 0);
    drop(recorder);
    let mut recorder = Recorder::resume(&path, 0).unwrap();
    let mut next = frame(1);
    next.garments.remove(1);
    lend(&next, |f| recorder.frame(f)).unwrap();
    recorder.finish().unwrap();
    let bytes = fs::read(&path).unwrap();
    let updates = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap);
    let last = updates.filter(|m| m.channel.topic == "/cloth").last().unwrap();
    // Field 1, a deletion, with field 3, the name.
    assert_eq!(last.data[0], 1 << 3 | 2);
    let deletion = &last.data[2..2 + usize::from(last.data[1])];
    assert!(deletion.ends_with(b"\x1a\x04tube"), "{deletion:?}");
}

#[test]
fn what_cannot_be_continued_stays_as_it_was() {
    let (whole, lengths) = recording_of(5);
    let refused = |name: &str, bytes: &[u8], up_to| {
        let path = path(name);
        fs::write(&path, bytes).unwrap();
        let error = Recorder::resume(&path, up_to).err().unwrap();
        assert!(fs::read(&path).unwrap() == bytes, "{name} has changed");
        assert!(!path.with_extension("mcap.partial").exists(), "{name}");
        assert!(error.to_string().contains(name), "{error}");
        match error {
            Error::InFile { source, .. } => *source,
            other => panic!("{other}"),
        }
    };
    assert!(matches!(refused("late.mcap", &whole, 5), Error::NoFrame { frame: 5, .. }));
    assert!(matches!(refused("cut.mcap", &whole[..lengths[2]], 3), Error::NoFrame { .. }));
    assert!(matches!(refused("other.mcap", b"text", 0), Error::NotMcap { .. }));
    // A header that is cut.
    let header = refused("header.mcap", &whole[..400], 0);
    assert!(matches!(header, Error::NoFrame { .. }), "{header}");
    // Damage in the meshes of frame 2, which shows only when they are read.
    let mut damaged = whole.clone();
    damaged[lengths[1] + 500] ^= 1;
    let error = refused("damaged.mcap", &damaged, 4);
    assert!(matches!(&error, Error::Damaged { offset, .. } if *offset == lengths[1] as u64));
    // The same in a cut file, where the damaged frame is not listed.
    let error = refused("damaged-cut.mcap", &damaged[..lengths[4]], 4);
    assert!(error.to_string().contains("frames are missing before frame 3"), "{error}");
    // Before the damage it can be continued.
    let path = path("damaged-later.mcap");
    fs::write(&path, &damaged).unwrap();
    drop(Recorder::resume(&path, 1).unwrap());
    let mut recording = Recording::open(&path).unwrap();
    assert!(matches!(recording.verify().unwrap(), Status::Cut { frames_complete: 2, .. }));
}

#[test]
#[cfg(unix)]
fn a_link_stays_a_link() {
    let (whole, _) = recording_of(3);
    let (path, link) = (path("linked.mcap"), path("link.mcap"));
    fs::write(&path, &whole).unwrap();
    std::os::unix::fs::symlink(&path, &link).unwrap();
    let mut recorder = Recorder::resume(&link, 0).unwrap();
    (1..3).for_each(|index| record(&mut recorder, index));
    recorder.finish().unwrap();
    assert!(link.is_symlink() && fs::read(&path).unwrap() == whole);
}

#[test]
fn a_copy_left_behind_is_in_nobodys_way() {
    let (whole, _) = recording_of(3);
    let path = path("leftover.mcap");
    fs::write(&path, &whole).unwrap();
    let partial = path.with_extension("mcap.partial");
    // What a kill in the middle of the copy leaves.
    fs::write(&partial, &whole[..1000]).unwrap();
    assert_eq!(Recording::open(&path).unwrap().status(), Status::Complete);
    let mut recorder = Recorder::resume(&path, 1).unwrap();
    assert!(!partial.exists());
    record(&mut recorder, 2);
    recorder.finish().unwrap();
    assert!(fs::read(&path).unwrap() == whole);
}
