//! Files made to do harm, or made by others: an error that says what and where, never a panic,
//! never more memory than the limits allow.

mod common;

use std::collections::BTreeMap;
use std::io::{Cursor, Read as _};

use common::*;
use io_mcap::{Error, Limits, Recording, Status};
use mcap::records::{MessageHeader, Metadata};
use prost::Message as _;

fn told(bytes: &[u8]) -> String {
    open(bytes).err().expect("opened").to_string()
}

#[test]
fn not_a_recording() {
    assert_eq!(told(b""), "the file is empty (0 bytes): not a recording");
    assert!(told(b"{ \"duration\": 2 }").starts_with("not an MCAP file: it begins with [7b"));
    assert!(told(&[0x89, b'M', b'C']).starts_with("not an MCAP file"));
    assert!(told(mcap::MAGIC).contains("in its 8 bytes"));

    let mut other = Cursor::new(Vec::new());
    let mut writer = mcap::Writer::new(&mut other).unwrap();
    let schema = writer.add_schema("a", "", &[]).unwrap();
    let channel = writer.add_channel(schema, "/cloth", "json", &BTreeMap::new()).unwrap();
    let header = MessageHeader { channel_id: channel, sequence: 0, log_time: 0, publish_time: 0 };
    writer.write_to_known_channel(&header, b"{}").unwrap();
    writer.finish().unwrap();
    drop(writer);
    let told = told(other.get_ref());
    assert!(told.starts_with("an MCAP file, but not a recording"), "{told}");

    let missing = Recording::open(path("missing.mcap")).err().unwrap().to_string();
    assert!(missing.contains("missing.mcap: cannot open the recording: "), "{missing}");
    let folder = Recording::open(env!("CARGO_TARGET_TMPDIR")).err().unwrap().to_string();
    assert!(folder.contains(env!("CARGO_TARGET_TMPDIR")), "{folder}");
}

#[test]
fn random_bytes() {
    let mut random = Random(5);
    let (whole, _) = recording_of(1);
    for n in (0..4000).step_by(13) {
        let mut bytes: Vec<u8> = (0..n).map(|_| random.next() as u8).collect();
        assert!(open(&bytes).is_err());
        // Behind a good beginning.
        bytes.splice(0..0, whole[..700].iter().copied());
        if let Ok(recording) = open(&bytes) {
            assert_eq!(recording.frames().len(), 0);
            assert!(!matches!(recording.status(), Status::Complete));
        }
    }
}

/// Offset of the first chunk of frame 1 in a recording of three.
fn with_chunk() -> (Vec<u8>, usize) {
    let (whole, lengths) = recording_of(3);
    assert_eq!(whole[lengths[0]], 6);
    (whole, lengths[0])
}

#[test]
fn a_chunk_that_claims_terabytes() {
    let (mut bytes, at) = with_chunk();
    // Behind opcode, length and two times: the size after decompression.
    bytes[at + 25..at + 33].copy_from_slice(&(3u64 << 40).to_le_bytes());
    let mut recording = open(&bytes).unwrap();
    let error = recording.frame(1).unwrap_err().to_string();
    let expected =
        format!("the chunk at byte {at} has 3298534883328 bytes, above the limit of 1073741824");
    assert_eq!(error, expected);
    assert!(matches!(recording.verify().unwrap(), Status::Damaged { frames_complete: 2, .. }));
    assert_eq!(frame_bits(&recording.frame(2).unwrap()), frame_bits(&frame(2)));

    // Below the limit, but more than comes out.
    bytes[at + 25..at + 33].copy_from_slice(&(1u64 << 29).to_le_bytes());
    let error = open(&bytes).unwrap().frame(1).unwrap_err().to_string();
    assert!(error.contains("but 536870912 bytes with CRC"), "{error}");
}

#[test]
fn a_chunk_that_expands_beyond_its_claim() {
    // A gigabyte of zeros in some tens of kilobytes, which claims to be 100 bytes.
    let bomb = zstd::encode_all(std::io::repeat(0).take(1 << 30), 1).unwrap();
    let (whole, at) = with_chunk();
    let mut bytes = whole[..at].to_vec();
    bytes.push(6);
    bytes.extend((8 + 8 + 8 + 4 + 8 + 8 + bomb.len() as u64).to_le_bytes());
    bytes.extend([0; 16]);
    bytes.extend(100u64.to_le_bytes());
    bytes.extend([0; 4]);
    bytes.extend(4u32.to_le_bytes());
    bytes.extend(b"zstd");
    bytes.extend((bomb.len() as u64).to_le_bytes());
    bytes.extend(&bomb);
    let recording = open(&bytes).unwrap();
    assert_eq!(recording.frames().len(), 1);
    let status = recording.status().to_string();
    assert!(status.contains("chunk of 101 bytes"), "{status}");
}

#[test]
fn limits_of_the_caller() {
    let (whole, lengths) = recording_of(3);
    let limits = Limits { chunk_bytes: 9000, attachment_bytes: 1000 };
    let mut recording = Recording::read(Cursor::new(&whole), limits).unwrap();
    let error = recording.attachment("flag.obj").unwrap_err().to_string();
    assert!(error.ends_with("has 20000 bytes, above the limit of 1000"), "{error}");
    let Error::TooLarge { what: "chunk", offset, limit: 9000, .. } =
        recording.frame(2).unwrap_err()
    else {
        panic!();
    };
    assert_eq!(offset, lengths[1] as u64);
}

#[test]
fn lengths_beyond_the_file() {
    let (whole, at) = with_chunk();
    for length in [u64::MAX, u64::MAX - 8, 1 << 63, whole.len() as u64, 0, 1, 39] {
        let mut bytes = whole.clone();
        bytes[at + 1..at + 9].copy_from_slice(&length.to_le_bytes());
        let mut recording = open(&bytes).unwrap();
        assert!(!matches!(recording.status(), Status::Complete));
        assert_eq!(frame_bits(&recording.frame(0).unwrap()), frame_bits(&frame(0)));
        assert!(recording.frame(1).is_err());
    }
    // The length of the compression name, and of the compressed data.
    for (place, width) in [(37, 4), (45, 8)] {
        let mut bytes = whole.clone();
        bytes[at + place..at + place + width].fill(0xff);
        let mut recording = open(&bytes).unwrap();
        assert!(recording.frame(1).is_err());
        assert_eq!(frame_bits(&recording.frame(2).unwrap()), frame_bits(&frame(2)));
    }
}

/// The metadata records of a real recording, but for attachments.
fn metadata() -> Vec<Metadata> {
    let recorder = io_mcap::Recorder::new(Vec::new(), io_mcap::Header::default()).unwrap();
    let bytes = recorder.finish().unwrap();
    let records = mcap::read::LinearReader::new(&bytes).unwrap();
    records
        .filter_map(|record| match record.unwrap() {
            mcap::records::Record::Metadata(metadata) => Some(metadata),
            _ => None,
        })
        .filter(|metadata| metadata.name != "organza.end")
        .collect()
}

/// A file with right CRCs everywhere, and these messages: topic, frame, content.
fn forged(messages: &[(&str, u32, Vec<u8>)]) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut writer = mcap::Writer::new(&mut file).unwrap();
    metadata().iter().for_each(|m| writer.write_metadata(m).unwrap());
    for (topic, sequence, data) in messages {
        let encoding = if *topic == "/report" { "json" } else { "protobuf" };
        let channel_id = writer.add_channel(0, topic, encoding, &BTreeMap::new()).unwrap();
        let header =
            MessageHeader { channel_id, sequence: *sequence, log_time: 0, publish_time: 0 };
        writer.write_to_known_channel(&header, data).unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    file.into_inner()
}

#[derive(Clone, PartialEq, prost::Message)]
struct Mark {
    #[prost(uint64, tag = "1")]
    frame: u64,
    #[prost(double, tag = "2")]
    time_s: f64,
    #[prost(uint64, tag = "3")]
    ordinal: u64,
    #[prost(uint32, tag = "4")]
    messages: u32,
}

fn mark(frame: u32, ordinal: u64, messages: u32) -> (&'static str, u32, Vec<u8>) {
    ("/frame", frame, Mark { frame: frame.into(), time_s: 0.0, ordinal, messages }.encode_to_vec())
}

fn report(frame: u32) -> (&'static str, u32, Vec<u8>) {
    ("/report", frame, b"{}".to_vec())
}

/// A message with these fields: number and bytes of each.
fn fields(fields: &[(u8, &[u8])]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (number, value) in fields {
        bytes.push(number << 3 | 2);
        bytes.push(u8::try_from(value.len()).unwrap());
        bytes.extend(*value);
    }
    bytes
}

/// A scene of one garment with `n` points (all at the origin) and these indices.
fn cloth(n: usize, indices: &[u32]) -> Vec<u8> {
    let indices: Vec<u8> = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
    let mut list: Vec<(u8, &[u8])> = vec![(2, &[]); n];
    list.push((5, &indices));
    fields(&[(2, &fields(&[(3, b"flag"), (12, &fields(&list))]))])
}

fn material(name: &[u8], pairs: usize, corners: &[u32]) -> Vec<u8> {
    let corners: Vec<u8> = corners.iter().flat_map(|i| i.to_le_bytes()).collect();
    let coordinates = vec![0; 16 * pairs];
    fields(&[(1, &fields(&[(1, name), (2, &coordinates), (3, &corners)]))])
}

#[test]
fn right_crcs_around_wrong_content() {
    let frame = |scene: Vec<u8>, coordinates: Vec<u8>| {
        let bytes = forged(&[
            ("/cloth", 0, scene),
            ("/cloth/material", 0, coordinates),
            mark(0, 0, 3),
            report(0),
        ]);
        open(&bytes).unwrap().frame(0)
    };
    let good = frame(cloth(3, &[0, 1, 2]), material(b"flag", 3, &[])).unwrap();
    assert_eq!(good.garments[0].points, [[0.0; 3]; 3]);
    let with_obstacle = |scene: Vec<u8>| {
        let messages = [
            ("/cloth", 0, cloth(3, &[0, 1, 2])),
            ("/cloth/material", 0, material(b"flag", 3, &[])),
            ("/obstacles", 0, scene),
            mark(0, 0, 4),
            report(0),
        ];
        open(&forged(&messages)).unwrap().frame(0)
    };
    let good = with_obstacle(cloth(3, &[2, 1, 0])).unwrap();
    assert_eq!(good.obstacles[0].triangles, [[2, 1, 0]]);
    let error = with_obstacle(cloth(3, &[2, 1, 3])).unwrap_err().to_string();
    assert!(error.contains("obstacle \"flag\": index 3 of 3 points"), "{error}");
    let wrong = |scene, coordinates, expected: &str| {
        let error = frame(scene, coordinates).unwrap_err().to_string();
        assert!(error.starts_with("damaged at byte ") && error.contains(expected), "{error}");
    };
    wrong(cloth(3, &[0, 1, 3]), material(b"flag", 3, &[]), "index 3 of 3 points");
    wrong(cloth(3, &[0, 1]), material(b"flag", 3, &[]), "2 indices, not a multiple of 3");
    wrong(cloth(3, &[0, 1, 2]), material(b"flag", 2, &[]), "2 pairs for 3 points");
    wrong(cloth(3, &[0, 1, 2]), material(b"flag", 2, &[0, 1]), "2 corners for 1 triangles");
    wrong(cloth(3, &[0, 1, 2]), material(b"flag", 2, &[0, 1, 2]), "corner with pair 2 of 2");
    wrong(cloth(3, &[0, 1, 2]), material(b"flog", 3, &[]), "those of \"flog\"");
    wrong(cloth(3, &[0, 1, 2]), Vec::new(), "1 garments drawn, 0 with material");
    wrong(cloth(3, &[0, 1, 2]), vec![0xff; 9], "/cloth/material: ");
    wrong(fields(&[(2, &fields(&[(3, b"flag")]))]), material(b"flag", 3, &[]), "0 triangle lists");
}

#[test]
fn right_crcs_around_wrong_order() {
    let status = |messages: &[(&str, u32, Vec<u8>)]| {
        let bytes = forged(messages);
        let mut recording = open(&bytes).unwrap();
        for index in 0..3 {
            assert!(recording.frame(index).is_err());
        }
        recording.status().to_string()
    };
    let says = |messages: &[(&str, u32, Vec<u8>)], expected: &str| {
        let status = status(messages);
        assert!(status.contains(expected), "{status}");
    };
    says(&[report(0)], "a report of frame 0 without its mark");
    says(&[mark(0, 0, 1), report(1)], "a report of frame 1 without its mark");
    says(&[mark(0, 0, 1), mark(1, 1, 1), report(1)], "frame 0 has no report");
    says(&[mark(1, 0, 1), report(1), mark(1, 1, 1), report(1)], "marked after frame Some(1)");
    says(&[mark(0, 0, 1), report(0), mark(1, 2, 1), report(1)], "is number 2, expected 1");
    says(&[mark(0, u64::MAX, 1), report(0), mark(1, 0, 1), report(1)], "is number 0, expected");
    says(&[("/frame", 0, vec![0xff; 3])], "frame mark: ");
    says(&[("/checkpoint", 0, vec![0; 40])], "does not end with its CRC");
    says(&[("/cloth", 0, Vec::new()), mark(0, 0, 5), report(0)], "2 of its 5 messages");
}

#[test]
fn another_format_is_named() {
    let mut file = Cursor::new(Vec::new());
    let mut writer = mcap::Writer::new(&mut file).unwrap();
    let entries = BTreeMap::from([("format".to_owned(), "2".to_owned())]);
    writer
        .write_metadata(&Metadata { name: "organza.recording".into(), metadata: entries })
        .unwrap();
    writer.finish().unwrap();
    drop(writer);
    assert_eq!(
        told(file.get_ref()),
        "the recording has format \"2\"; this version reads format \"1\""
    );
}

#[test]
fn chunks_of_other_writers_are_read() {
    // All messages in one chunk, without compression and message indexes, as another tool may
    // leave them.
    let (whole, _) = recording_of(5);
    let mut file = Cursor::new(Vec::new());
    let mut writer = mcap::WriteOptions::new()
        .compression(None)
        .chunk_size(None)
        .emit_message_indexes(false)
        .create(&mut file)
        .unwrap();
    let mut end = None;
    for record in mcap::read::LinearReader::new(&whole).unwrap() {
        match record.unwrap() {
            mcap::records::Record::Metadata(m) if m.name == "organza.end" => end = Some(m),
            mcap::records::Record::Metadata(m) => writer.write_metadata(&m).unwrap(),
            mcap::records::Record::Attachment { header, data, .. } => writer
                .attach(&mcap::Attachment {
                    log_time: 0,
                    create_time: 0,
                    name: header.name,
                    media_type: header.media_type,
                    data,
                })
                .unwrap(),
            _ => {}
        }
    }
    for message in mcap::MessageStream::new(&whole).unwrap() {
        writer.write(&message.unwrap()).unwrap();
    }
    writer.write_metadata(&end.unwrap()).unwrap();
    writer.finish().unwrap();
    drop(writer);
    let mut recording = Recording::read(file, Limits::default()).unwrap();
    assert_eq!(recording.status(), Status::Complete);
    for index in [4, 0, 2, 1, 3] {
        assert_eq!(frame_bits(&recording.frame(index).unwrap()), frame_bits(&frame(index)));
    }
    let read = recording.checkpoint(3).unwrap();
    assert_eq!(checkpoint_bits(&read), checkpoint_bits(&checkpoint(3)));
    assert_eq!(recording.header().unwrap(), header());
}
