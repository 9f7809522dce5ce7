//! What is recorded is read back with the same bits; what cannot be recorded is refused.

mod common;

use std::io::{self, Read, Seek, Write};

use common::*;
use io_mcap::{Error, FrameInfo, Header, Limits, Overwrite, Recorder, Recording, Status};
use prost::Message as _;

#[test]
fn every_bit_comes_back() {
    let (bytes, _) = recording_of(10);
    let mut recording = open(&bytes).unwrap();
    assert_eq!(recording.status(), Status::Complete);
    assert_eq!(recording.verify().unwrap(), Status::Complete);
    let expected: Vec<_> =
        (0..10).map(|i| FrameInfo { index: i, time_s: frame(i).time_s }).collect();
    assert_eq!(recording.frames().collect::<Vec<_>>(), expected);
    // In no particular order.
    for i in [7, 0, 9, 3, 3, 1, 2, 4, 5, 6, 8] {
        assert_eq!(frame_bits(&recording.frame(i).unwrap()), frame_bits(&frame(i)));
        assert_eq!(recording.report(i).unwrap(), frame(i).report);
    }
    let at: Vec<_> = recording.checkpoints().map(|c| c.frame).collect();
    assert_eq!(at, [0, 3, 6, 9]);
    for i in at {
        let checkpoint = recording.checkpoint(i).unwrap();
        assert_eq!(checkpoint_bits(&checkpoint), checkpoint_bits(&common::checkpoint(i)));
    }
    assert_eq!(recording.header().unwrap(), header());
    assert_eq!(recording.attachment("flag.obj").unwrap(), header().attachments[1].data);
    let sizes: Vec<_> = recording.attachments().into_iter().map(|a| a.bytes).collect();
    assert_eq!(sizes, [700, 20_000]);
    assert_eq!(recording.software(), "organza 0.1.0");
}

#[test]
fn the_same_frames_give_the_same_bytes() {
    assert!(recording_of(4).0 == recording_of(4).0);
}

#[test]
fn what_is_missing_is_named() {
    let (bytes, _) = recording_of(4);
    let mut recording = open(&bytes).unwrap();
    let told = |e: Error| e.to_string();
    assert_eq!(
        told(recording.frame(4).unwrap_err()),
        "frame 4 is not in the recording, which holds 4 frames from 0 to 3"
    );
    assert_eq!(
        told(recording.checkpoint(1).unwrap_err()),
        "no checkpoint at frame 1; there are 0, 3"
    );
    assert_eq!(
        told(recording.attachment("x").unwrap_err()),
        "no attachment named \"x\" in the recording; there are \"flag.json5\", \"flag.obj\""
    );
}

#[test]
fn an_empty_recording_is_a_recording() {
    let bytes = Recorder::new(Vec::new(), Header::default()).unwrap().finish().unwrap();
    let mut recording = open(&bytes).unwrap();
    assert_eq!(recording.status(), Status::Complete);
    assert_eq!(recording.frames().len(), 0);
    assert_eq!(
        recording.frame(0).unwrap_err().to_string(),
        "frame 0 is not in the recording, which holds no frame"
    );
}

#[test]
fn a_recorder_dropped_early_leaves_a_file_that_tells() {
    let shared = Shared::default();
    let mut recorder = Recorder::new(shared.clone(), header()).unwrap();
    record(&mut recorder, 0);
    drop(recorder);
    let bytes = shared.bytes();
    let status = open(&bytes).unwrap().status();
    let Status::Cut { frames_complete: 1, bytes_lost: 0, reason } = status else {
        panic!("{status}");
    };
    assert!(reason.contains("closed before the run ended"), "{reason}");
    // Viewers have their summary all the same.
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    assert_eq!(summary.stats.unwrap().message_count, 8);
}

/// Counts the bytes read through it.
struct Counting<R>(R, std::sync::Arc<std::sync::atomic::AtomicU64>);

impl<R: Read> Read for Counting<R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let n = self.0.read(bytes)?;
        self.1.fetch_add(n as u64, std::sync::atomic::Ordering::Relaxed);
        Ok(n)
    }
}

impl<R: Seek> Seek for Counting<R> {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

#[test]
fn reports_are_listed_without_reading_the_meshes() {
    let mut recorder = Recorder::new(Vec::new(), Header::default()).unwrap();
    for index in 0..5 {
        let mut frame = frame(index);
        frame.garments = vec![sheet("big", 150, false, &mut Random(index))];
        lend(&frame, |f| recorder.frame(f)).unwrap();
    }
    let bytes = recorder.finish().unwrap();
    let count = std::sync::Arc::default();
    let reader = Counting(io::Cursor::new(&bytes), std::sync::Arc::clone(&count));
    let mut recording = Recording::read(reader, Limits::default()).unwrap();
    for index in 0..5 {
        assert_eq!(recording.report(index).unwrap(), frame(index).report);
    }
    let read = count.load(std::sync::atomic::Ordering::Relaxed);
    assert!(read * 5 < bytes.len() as u64, "{read} of {} bytes were read", bytes.len());
}

#[test]
fn what_vanishes_is_deleted_from_view() {
    #[derive(Clone, PartialEq, prost::Message)]
    struct Deletion {
        #[prost(string, tag = "3")]
        id: String,
    }
    #[derive(Clone, PartialEq, prost::Message)]
    struct Update {
        #[prost(message, repeated, tag = "1")]
        deletions: Vec<Deletion>,
    }
    let mut recorder = Recorder::new(Vec::new(), Header::default()).unwrap();
    for index in 0..4 {
        let mut frame = frame(index);
        if index >= 2 {
            frame.garments.remove(0);
            frame.obstacles.clear();
        }
        lend(&frame, |f| recorder.frame(f)).unwrap();
    }
    let bytes = recorder.finish().unwrap();
    let deleted = |topic: &str| -> Vec<Vec<String>> {
        mcap::MessageStream::new(&bytes)
            .unwrap()
            .map(Result::unwrap)
            .filter(|m| m.channel.topic == topic)
            .map(|m| Update::decode(&*m.data).unwrap().deletions)
            .map(|deletions| deletions.into_iter().map(|d| d.id).collect())
            .collect()
    };
    assert_eq!(deleted("/cloth"), [vec![], vec![], vec!["flag".to_owned()], vec![]]);
    // None in frame 0, one in frame 1, which is then removed by a message of its own.
    assert_eq!(deleted("/obstacles"), [vec![], vec!["rock-0".to_owned()]]);
}

#[test]
fn what_cannot_be_recorded_is_refused_and_recording_goes_on() {
    let mut recorder = Recorder::new(Vec::new(), Header::default()).unwrap();
    record(&mut recorder, 1);
    let mut refuse = |change: &dyn Fn(&mut io_mcap::OwnedFrame), expected: &str| {
        let mut frame = frame(2);
        change(&mut frame);
        let error = lend(&frame, |f| recorder.frame(f)).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    };
    refuse(&|f| f.index = 1, "frame 1: the last one was frame 1");
    refuse(&|f| f.index = 1 << 32, "the largest index is 4294967295");
    refuse(&|f| f.time_s = 0.05, "its time is 0.05 s, that of the last one 0.1 s");
    refuse(&|f| f.time_s = f64::NAN, "time NaN s");
    refuse(&|f| f.time_s = -1.0, "time -1 s");
    refuse(&|f| f.time_s = 1e11, "time 100000000000 s");
    refuse(&|f| f.report = serde_json::json!([1]), "not a JSON object");
    refuse(&|f| f.obstacles[1].name = "rock-0".into(), "\"rock-0\" is empty or used twice");
    refuse(&|f| f.obstacles[0].triangles[2] = [0, 1, 4], "triangle 2 = [0, 1, 4], but 4 points");
    refuse(&|f| f.garments[1].name = "flag".into(), "\"flag\" is empty or used twice");
    refuse(&|f| f.garments[0].name = String::new(), "\"\" is empty or used twice");
    refuse(&|f| f.garments[1].triangles[5][2] = 49, "triangle 5 = [");
    refuse(&|f| f.garments[1].material.truncate(71), "for 71 triangles, but 72 triangles");
    refuse(&|f| f.transforms[0].name = "camera".into(), "\"camera\" is empty, taken");
    refuse(&|f| f.transforms[1].name = "sphere-0".into(), "\"sphere-0\" is empty, taken");
    let early = recorder.checkpoint(&checkpoint(0)).unwrap_err().to_string();
    assert!(early.contains("the last frame is 1"), "{early}");
    recorder.checkpoint(&checkpoint(1)).unwrap();
    let twice = recorder.checkpoint(&checkpoint(1)).unwrap_err().to_string();
    assert!(twice.contains("there is one already"), "{twice}");
    record(&mut recorder, 2);
    let bytes = recorder.finish().unwrap();
    let mut recording = open(&bytes).unwrap();
    assert_eq!(recording.status(), Status::Complete);
    assert_eq!(frame_bits(&recording.frame(2).unwrap()), frame_bits(&frame(2)));
}

#[test]
fn a_file_is_created_late_and_never_replaced_unasked() {
    let path = path("late.mcap");
    let new = |overwrite| Recorder::create(&path, header(), overwrite);
    let mut recorder = new(Overwrite::No).unwrap();
    // A frame that is refused is no reason to create a file.
    let mut bad = frame(0);
    bad.time_s = -1.0;
    lend(&bad, |f| recorder.frame(f)).unwrap_err();
    drop(recorder);
    assert!(!path.exists());

    let mut recorder = new(Overwrite::No).unwrap();
    record(&mut recorder, 0);
    assert!(path.exists());
    recorder.finish().unwrap().sync().unwrap();
    let error = new(Overwrite::No).err().unwrap();
    assert!(error.to_string().ends_with("overwriting it was not asked for"), "{error}");
    assert!(error.to_string().contains("late.mcap"), "{error}");

    let recorder = new(Overwrite::Yes).unwrap();
    drop(recorder);
    assert_eq!(Recording::open(&path).unwrap().frames().len(), 1);
    let mut recorder = new(Overwrite::Yes).unwrap();
    (0..2).for_each(|i| record(&mut recorder, i));
    recorder.finish().unwrap();
    assert_eq!(Recording::open(&path).unwrap().frames().len(), 2);

    // A file that turns up in between is not replaced either.
    std::fs::remove_file(&path).unwrap();
    let mut recorder = new(Overwrite::No).unwrap();
    std::fs::write(&path, "mine").unwrap();
    lend(&frame(0), |f| recorder.frame(f)).unwrap_err();
    assert!(matches!(lend(&frame(0), |f| recorder.frame(f)), Err(Error::Stopped)));
    drop(recorder);
    assert_eq!(std::fs::read(&path).unwrap(), b"mine");

    let missing = path.join("no/such/folder.mcap");
    assert!(Recorder::create(missing, header(), Overwrite::Yes).is_err());
    assert!(Recorder::create(path.parent().unwrap(), header(), Overwrite::Yes).is_err());
}

/// Takes `0` bytes, then refuses.
struct Full(usize, Shared);

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n = bytes.len().min(self.0);
        if n == 0 {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.0 -= n;
        self.1.write(&bytes[..n])
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[test]
fn a_full_disk_stops_the_recorder_and_keeps_the_frames() {
    let (whole, lengths) = recording_of(5);
    for room in [0, 100, lengths[0] / 2, lengths[1] + 10, lengths[2] - 1, lengths[3] + 900] {
        let shared = Shared::default();
        let mut recorder = Recorder::new(Full(room, shared.clone()), header()).unwrap();
        let failed = (0..5)
            .find(|&i| {
                lend(&frame(i), |f| recorder.frame(f)).is_err()
                    || (i.is_multiple_of(3) && recorder.checkpoint(&checkpoint(i)).is_err())
            })
            .expect("the disk is too small");
        assert!(matches!(lend(&frame(9), |f| recorder.frame(f)), Err(Error::Stopped)));
        assert!(matches!(recorder.finish().err().unwrap(), Error::Stopped));
        let bytes = shared.bytes();
        assert_eq!(bytes, whole[..room], "what is there is a beginning of the recording");
        if let Ok(mut recording) = open(&bytes) {
            assert!(recording.frames().len() as u64 >= failed);
            for index in 0..failed {
                assert_eq!(frame_bits(&recording.frame(index).unwrap()), frame_bits(&frame(index)));
            }
        }
    }
}
