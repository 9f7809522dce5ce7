//! Flipped bits: what is read is right, or it is not read.

mod common;

use std::panic::{AssertUnwindSafe, catch_unwind};

use common::*;
use io_mcap::{Error, Status};

const N_FRAMES: u64 = 6;

/// Reads everything that can be read and compares it. Returns the number of frames read.
fn read_all(bytes: &[u8]) -> Result<u64, Error> {
    let mut recording = open(bytes)?;
    let reported = recording.status();
    let frames: Vec<_> = recording.frames().collect();
    let mut n_read = 0;
    for info in &frames {
        assert_eq!(info.time_s.to_bits(), frame(info.index).time_s.to_bits());
        if let Ok(report) = recording.report(info.index) {
            assert_eq!(report, frame(info.index).report);
        }
        if let Ok(read) = recording.frame(info.index) {
            assert_eq!(frame_bits(&read), frame_bits(&frame(info.index)));
            n_read += 1;
        }
    }
    for info in recording.checkpoints().collect::<Vec<_>>() {
        assert_eq!(info.time_s.to_bits(), checkpoint(info.frame).time_s.to_bits());
        if let Ok(read) = recording.checkpoint(info.frame) {
            assert_eq!(checkpoint_bits(&read), checkpoint_bits(&checkpoint(info.frame)));
        }
    }
    assert_eq!(recording.software(), header().software);
    if !recording.metadata().is_empty() {
        assert_eq!(*recording.metadata(), header().metadata);
    }
    for attachment in recording.attachments() {
        let original = header().attachments.into_iter().find(|a| a.name == attachment.name);
        assert_eq!(attachment.media_type, original.as_ref().unwrap().media_type);
        assert_eq!(recording.attachment(&attachment.name).unwrap(), original.unwrap().data);
    }

    // Checked in full, everything that is listed can be read, and nothing is lost unsaid.
    let verified = recording.verify()?;
    for info in recording.frames().collect::<Vec<_>>() {
        recording.frame(info.index).unwrap();
    }
    assert!(recording.frames().len() as u64 <= n_read);
    if verified == Status::Complete {
        assert_eq!(reported, Status::Complete);
        assert_eq!(recording.frames().len() as u64, N_FRAMES);
        assert_eq!(recording.checkpoints().len(), 2);
        assert_eq!(recording.header().unwrap(), header());
    }
    Ok(n_read)
}

/// Runs `read_all`, naming the damage if it fails.
fn check(bytes: &[u8], damage: &str) -> Result<u64, Error> {
    catch_unwind(AssertUnwindSafe(|| read_all(bytes))).unwrap_or_else(|_| panic!("{damage}"))
}

#[test]
fn one_flipped_bit() {
    let (whole, _) = recording_of(N_FRAMES);
    assert_eq!(read_all(&whole).unwrap(), N_FRAMES);
    let mut random = Random(1);
    let mut unreadable = 0;
    for _ in 0..500 {
        let (at, bit) = (random.below(whole.len()), random.below(8));
        let mut bytes = whole.clone();
        bytes[at] ^= 1 << bit;
        match check(&bytes, &format!("byte {at}, bit {bit}")) {
            // Only the length of a record, which hides all that follows, costs more than one
            // frame; those of messages are inside the chunks.
            Ok(n) => unreadable += u64::from(n < N_FRAMES - 1),
            Err(_) => unreadable += 1,
        }
    }
    assert!(unreadable < 10, "{unreadable} of 500 flips cost more than a frame");
}

/// Bytes outside the compressed data: heads of records, headers of chunks, indexes, summary.
fn structural(whole: &[u8]) -> Vec<usize> {
    let mut places: Vec<usize> = (0..8).collect();
    let mut offset = 8;
    while offset < whole.len() - 8 {
        let length = u64::from_le_bytes(whole[offset + 1..offset + 9].try_into().unwrap());
        let end = offset + 9 + length as usize;
        places.extend(offset..end.min(offset + 80));
        offset = end;
    }
    places.extend(offset..whole.len());
    places
}

#[test]
fn structure_overwritten() {
    let (whole, _) = recording_of(N_FRAMES);
    let places = structural(&whole);
    let mut random = Random(2);
    for _ in 0..600 {
        let at = places[random.below(places.len())];
        let value = [0, 1, 0x7f, 0x80, 0xff, random.next() as u8][random.below(6)];
        let mut bytes = whole.clone();
        bytes[at] = value;
        let _ = check(&bytes, &format!("byte {at} set to {value}"));
    }
}

#[test]
fn long_damage() {
    let (whole, _) = recording_of(N_FRAMES);
    let mut random = Random(3);
    for _ in 0..100 {
        let at = random.below(whole.len());
        let end = (at + 1 + random.below(5000)).min(whole.len());
        let mut bytes = whole.clone();
        match random.below(3) {
            0 => bytes[at..end].fill(0),
            1 => bytes[at..end].iter_mut().for_each(|b| *b = random.next() as u8),
            _ => drop(bytes.drain(at..end)),
        }
        let _ = check(&bytes, &format!("bytes {at} to {end}"));
    }
}

#[test]
fn damage_is_placed() {
    let (whole, lengths) = recording_of(N_FRAMES);
    let mut bytes = whole.clone();
    bytes[lengths[1] + 400] ^= 4;
    let mut recording = open(&bytes).unwrap();
    // The meshes of a whole file are not read when it is opened.
    assert_eq!(recording.status(), Status::Complete);
    let Error::Damaged { offset, .. } = recording.frame(2).unwrap_err() else { panic!() };
    assert_eq!(offset, lengths[1] as u64);
    assert_eq!(frame_bits(&recording.frame(3).unwrap()), frame_bits(&frame(3)));
    let Status::Damaged { frames_complete: 5, reason } = recording.verify().unwrap() else {
        panic!();
    };
    assert!(reason.starts_with(&format!("at byte {}: chunk", lengths[1])), "{reason}");
    assert!(reason.contains("frame 2 is lost: 1 of its"), "{reason}");
    // In a cut file everything is read when it is opened.
    let cut = open(&bytes[..lengths[4]]).unwrap();
    assert_eq!(cut.frames().map(|f| f.index).collect::<Vec<_>>(), [0, 1, 3, 4]);
    let Status::Cut { frames_complete: 4, bytes_lost: 0, reason } = cut.status() else {
        panic!("{}", cut.status());
    };
    assert!(reason.contains("and damage: at byte"), "{reason}");
}
