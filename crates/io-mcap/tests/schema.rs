//! The descriptions in a recording are those of the messages, and Foxglove's are as published.

mod common;

use std::collections::{BTreeMap, BTreeSet};

use common::recording_of;
use prost::Message as _;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FileDescriptorSet};

/// Schema of every topic of a recording, by schema name.
fn schemas() -> BTreeMap<String, (String, Vec<u8>)> {
    let (bytes, _) = recording_of(3);
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let schemas = summary.channels.values().map(|channel| {
        let schema = channel.schema.as_ref().unwrap();
        assert_eq!(channel.message_encoding == "protobuf", schema.encoding == "protobuf");
        (schema.name.clone(), (schema.encoding.clone(), schema.data.to_vec()))
    });
    schemas.collect()
}

fn file_set(name: &str) -> FileDescriptorSet {
    let (encoding, data) = &schemas()[name];
    assert_eq!(encoding, "protobuf");
    FileDescriptorSet::decode(&data[..]).unwrap()
}

/// Messages of a set by full name, without the leading dot.
fn messages(set: &FileDescriptorSet) -> BTreeMap<String, DescriptorProto> {
    let of_file = |file: &prost_types::FileDescriptorProto| {
        let package = file.package().to_owned();
        file.message_type.clone().into_iter().map(move |m| (format!("{package}.{}", m.name()), m))
    };
    set.file.iter().flat_map(of_file).collect()
}

#[test]
fn foxglove_messages_are_as_published() {
    let mut described = BTreeSet::new();
    for name in [
        "foxglove.SceneUpdate",
        "foxglove.FrameTransforms",
        "foxglove.CameraCalibration",
        "foxglove.PointCloud",
    ] {
        for (name, message) in messages(&file_set(name)) {
            if !name.starts_with("foxglove.") {
                continue;
            }
            for field in &message.field {
                let count = if field.label() == Label::Repeated { "many" } else { "one" };
                let kind = match field.type_name() {
                    "" => match field.r#type() {
                        Type::Double => "double",
                        Type::Fixed32 => "fixed32",
                        Type::Bool => "bool",
                        Type::String => "string",
                        Type::Bytes => "bytes",
                        other => panic!("{other:?}"),
                    },
                    name => &name[1..],
                };
                let (number, field) = (field.number(), field.name());
                described.insert(format!("{name} {number} {field} {count} {kind}"));
            }
            for choice in &message.enum_type {
                for value in &choice.value {
                    let (number, value) = (value.number(), value.name());
                    described.insert(format!("{name}.{} {number} {value}", choice.name()));
                }
            }
        }
    }
    let published: BTreeSet<String> = include_str!("data/foxglove_fields.txt")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(str::to_owned)
        .collect();
    assert_eq!(described, published);
}

#[test]
fn every_description_is_whole_and_in_order() {
    for (name, (encoding, data)) in schemas() {
        if encoding == "jsonschema" {
            let schema: serde_json::Value = serde_json::from_slice(&data).unwrap();
            assert_eq!(schema["type"], "object");
            continue;
        }
        let set = FileDescriptorSet::decode(&data[..]).unwrap();
        let known = messages(&set);
        assert!(known.contains_key(&name), "{name}");
        let mut seen = BTreeSet::new();
        for file in &set.file {
            assert_eq!(file.syntax(), "proto3");
            assert!(file.dependency.iter().all(|d| seen.contains(d)), "{}", file.name());
            assert!(seen.insert(file.name().to_owned()), "{} twice", file.name());
            for message in &file.message_type {
                for field in message.field.iter().filter(|f| f.r#type() == Type::Message) {
                    assert!(known.contains_key(&field.type_name()[1..]), "{}", field.type_name());
                }
            }
        }
    }
}

/// Walks through an encoded message and asserts that its description knows every field, with
/// the wire type found. Returns how many fields it met.
fn walk(name: &str, mut bytes: &[u8], known: &BTreeMap<String, DescriptorProto>) -> usize {
    use prost::encoding::{WireType, decode_key, decode_varint};
    let mut n = 0;
    while !bytes.is_empty() {
        let (number, wire_type) = decode_key(&mut bytes).unwrap();
        let field = known[name].field.iter().find(|f| f.number() == number as i32);
        let field = field.unwrap_or_else(|| panic!("{name} has no field {number}"));
        let packed = field.label() == Label::Repeated;
        let expected = match field.r#type() {
            Type::Message | Type::String | Type::Bytes => WireType::LengthDelimited,
            _ if packed => WireType::LengthDelimited,
            Type::Double | Type::Fixed64 => WireType::SixtyFourBit,
            Type::Fixed32 => WireType::ThirtyTwoBit,
            _ => WireType::Varint,
        };
        assert_eq!(wire_type, expected, "{name}.{}", field.name());
        let length = match wire_type {
            WireType::Varint => decode_varint(&mut bytes).map(|_| 0).unwrap(),
            WireType::SixtyFourBit => 8,
            WireType::ThirtyTwoBit => 4,
            _ => decode_varint(&mut bytes).unwrap() as usize,
        };
        let (value, rest) = bytes.split_at(length);
        bytes = rest;
        n += 1;
        if field.r#type() == Type::Message {
            n += walk(&field.type_name()[1..], value, known);
        }
    }
    n
}

#[test]
fn every_written_field_is_described() {
    let (bytes, _) = recording_of(3);
    let mut fields = BTreeMap::new();
    for message in mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap) {
        let schema = message.channel.schema.as_ref().unwrap();
        if schema.encoding == "protobuf" {
            let known = messages(&FileDescriptorSet::decode(&schema.data[..]).unwrap());
            let n = walk(&schema.name, &message.data, &known);
            *fields.entry(schema.name.clone()).or_insert(0) += n;
        }
    }
    assert_eq!(fields.len(), 7, "{fields:?}");
    assert!(fields.values().all(|&n| n > 0));
    assert!(fields["foxglove.SceneUpdate"] > 1000);
}
