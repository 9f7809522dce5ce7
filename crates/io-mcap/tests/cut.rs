//! A recording cut anywhere gives back every frame that was complete before the cut.

mod common;

use std::collections::BTreeSet;

use common::*;
use io_mcap::{Error, Status};

const N_FRAMES: u64 = 10;

/// Opens the first `cut` bytes and compares everything with what was recorded. `lengths[i]` is
/// the length of the file once frame `i` was recorded.
fn check(whole: &[u8], lengths: &[usize], cut: usize) {
    let complete = lengths.iter().filter(|&&length| length <= cut).count();
    let mut recording = match open(&whole[..cut]) {
        Ok(recording) => recording,
        Err(Error::Empty) if cut == 0 => return,
        Err(Error::NotMcap { .. }) if cut < 8 => return,
        Err(Error::NotRecording { bytes }) if bytes == cut as u64 && cut < 400 => return,
        Err(error) => panic!("cut at {cut}: {error}"),
    };
    let frames: Vec<_> = recording.frames().map(|f| f.index).collect();
    // A frame counts as recorded once its checkpoint, if it has one, is flushed too, so the cut
    // may leave one frame more than `complete`.
    assert!((complete..=complete + 1).contains(&frames.len()), "cut at {cut}: {frames:?}");
    for (expected, index) in (0..).zip(frames) {
        assert_eq!(index, expected);
        assert_eq!(frame_bits(&recording.frame(index).unwrap()), frame_bits(&frame(index)));
    }
    let checkpoints: Vec<_> = recording.checkpoints().map(|c| c.frame).collect();
    assert!(checkpoints.len() >= complete.div_ceil(3), "cut at {cut}: {checkpoints:?}");
    for index in checkpoints {
        let read = recording.checkpoint(index).unwrap();
        assert_eq!(checkpoint_bits(&read), checkpoint_bits(&checkpoint(index)));
    }
    let status = recording.status();
    let Status::Cut { frames_complete, bytes_lost, ref reason } = status else {
        panic!("cut at {cut}: {status}");
    };
    assert_eq!(frames_complete, recording.frames().len() as u64);
    assert!(bytes_lost <= cut as u64);
    assert!(reason.starts_with("at byte ") && !reason.contains("damage"), "{reason}");
    if complete > 0 {
        let lost = cut - lengths[complete - 1];
        assert!(bytes_lost <= lost as u64, "cut at {cut}: {bytes_lost} of {lost} bytes lost");
        assert_eq!(recording.header().unwrap(), header());
    }
}

#[test]
fn at_random_places() {
    let (whole, lengths) = recording_of(N_FRAMES);
    let mut random = Random(2024);
    for _ in 0..40 {
        check(&whole, &lengths, random.below(whole.len()));
    }
}

#[test]
fn at_every_record_and_next_to_it() {
    let (whole, lengths) = recording_of(N_FRAMES);
    let mut cuts: BTreeSet<usize> = (0..9).collect();
    let mut offset = 8;
    let mut n_chunks = 0;
    while offset < whole.len() - 8 {
        let length = u64::from_le_bytes(whole[offset + 1..offset + 9].try_into().unwrap());
        n_chunks += usize::from(whole[offset] == 6);
        cuts.extend([offset - 1, offset, offset + 1, offset + 9]);
        offset += 9 + length as usize;
    }
    assert_eq!(n_chunks, 1 + 2 * 10 + 4, "channels, frames, checkpoints");
    cuts.extend(whole.len() - 9..whole.len());
    for cut in cuts {
        check(&whole, &lengths, cut);
    }
}

#[test]
fn an_end_of_zeros_is_a_cut_too() {
    // What a loss of power may leave.
    let (whole, lengths) = recording_of(4);
    let mut bytes = whole[..lengths[2] + 100].to_vec();
    bytes.resize(whole.len() + 5000, 0);
    let mut recording = open(&bytes).unwrap();
    assert_eq!(recording.frames().len(), 3);
    assert_eq!(frame_bits(&recording.frame(2).unwrap()), frame_bits(&frame(2)));
    let Status::Cut { bytes_lost, .. } = recording.status() else { panic!() };
    assert_eq!(bytes_lost as usize, bytes.len() - lengths[2]);
}

#[test]
fn the_message_says_where_and_what() {
    let (whole, lengths) = recording_of(3);
    let cut = lengths[1] + 50;
    let Status::Cut { frames_complete: 2, bytes_lost: 50, reason } =
        open(&whole[..cut]).unwrap().status()
    else {
        panic!();
    };
    let start = format!("at byte {}: a record (chunk) of ", lengths[1]);
    assert!(reason.starts_with(&start) && reason.ends_with(" bytes, 41 are left"), "{reason}");
    let status = open(&whole[..cut]).unwrap().status().to_string();
    assert!(status.starts_with("cut short: 2 frames can be read, 50 bytes are lost"), "{status}");
}
