//! Protobuf descriptions of every recorded message, written into the file so that any reader
//! of MCAP can decode it without this crate.
//!
//! The Foxglove messages are described as published in the `foxglove-sdk` repository
//! (`schemas/proto/foxglove`): one file per message, with every field, also those this crate
//! never writes. A test compares the table with the published numbers.

mod table;

use prost::Message as _;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{
    DescriptorProto, EnumDescriptorProto, EnumValueDescriptorProto, FieldDescriptorProto,
    FileDescriptorProto, FileDescriptorSet, OneofDescriptorProto,
};

use table::{Count, Description, Field, Kind, MESSAGES};

/// The serialised `FileDescriptorSet` of the message called `full_name`, with everything it
/// needs, each file after those it depends on. Empty for a name that is not in the table.
pub(crate) fn descriptor_set(full_name: &str) -> Vec<u8> {
    let mut files = Vec::new();
    if let Some(message) = find(full_name) {
        add_file(message, &mut files);
    }
    FileDescriptorSet { file: files }.encode_to_vec()
}

fn find(full_name: &str) -> Option<&'static Description> {
    MESSAGES.iter().find(|m| {
        full_name.strip_prefix(m.package).and_then(|rest| rest.strip_prefix('.')) == Some(m.name)
    })
}

/// Messages named by the fields of `message`, each once, in field order.
fn parts(message: &Description) -> Vec<&'static Description> {
    let mut parts: Vec<&'static Description> = Vec::new();
    for Field(.., kind) in message.fields {
        if let Kind::Of(name) = kind
            && let Some(part) = find(name)
            && !parts.iter().any(|p| std::ptr::eq(*p, part))
        {
            parts.push(part);
        }
    }
    parts
}

fn add_file(message: &Description, files: &mut Vec<FileDescriptorProto>) {
    let name = file_name(message);
    if files.iter().any(|f| f.name() == name) {
        return;
    }
    let parts = parts(message);
    for part in &parts {
        add_file(part, files);
    }
    files.push(FileDescriptorProto {
        name: Some(name),
        package: Some(message.package.into()),
        dependency: parts.iter().map(|p| file_name(p)).collect(),
        message_type: vec![descriptor(message)],
        syntax: Some("proto3".into()),
        ..Default::default()
    });
}

/// The published path: `foxglove/Color.proto`, `google/protobuf/timestamp.proto`.
fn file_name(message: &Description) -> String {
    let name = match message.package {
        "google.protobuf" => message.name.to_lowercase(),
        _ => message.name.to_owned(),
    };
    format!("{}/{name}.proto", message.package.replace('.', "/"))
}

fn descriptor(message: &Description) -> DescriptorProto {
    let has_oneof = message.fields.iter().any(|Field(_, _, count, _)| *count == Count::OneOf);
    DescriptorProto {
        name: Some(message.name.into()),
        field: message.fields.iter().map(|f| field_descriptor(message, f)).collect(),
        enum_type: message.choices.iter().map(|(name, values)| choice(name, values)).collect(),
        oneof_decl: has_oneof
            .then(|| OneofDescriptorProto { name: Some("values".into()), options: None })
            .into_iter()
            .collect(),
        ..Default::default()
    }
}

fn choice(name: &str, values: &[&str]) -> EnumDescriptorProto {
    let value = |(number, name): (i32, &&str)| EnumValueDescriptorProto {
        name: Some((*name).into()),
        number: Some(number),
        options: None,
    };
    EnumDescriptorProto {
        name: Some(name.into()),
        value: (0..).zip(values).map(value).collect(),
        ..Default::default()
    }
}

fn field_descriptor(message: &Description, field: &Field) -> FieldDescriptorProto {
    let Field(name, number, count, kind) = field;
    let (r#type, type_name) = match kind {
        Kind::Double => (Type::Double, None),
        Kind::Fixed32 => (Type::Fixed32, None),
        Kind::Fixed64 => (Type::Fixed64, None),
        Kind::Uint32 => (Type::Uint32, None),
        Kind::Uint64 => (Type::Uint64, None),
        Kind::Int32 => (Type::Int32, None),
        Kind::Int64 => (Type::Int64, None),
        Kind::Bool => (Type::Bool, None),
        Kind::Text => (Type::String, None),
        Kind::Bytes => (Type::Bytes, None),
        Kind::Of(name) => (Type::Message, Some(format!(".{name}"))),
        Kind::Choice(name) => {
            (Type::Enum, Some(format!(".{}.{}.{name}", message.package, message.name)))
        }
    };
    let label = if *count == Count::Many { Label::Repeated } else { Label::Optional };
    FieldDescriptorProto {
        name: Some((*name).into()),
        number: Some(*number),
        label: Some(label as i32),
        r#type: Some(r#type as i32),
        type_name,
        oneof_index: (*count == Count::OneOf).then_some(0),
        ..Default::default()
    }
}
