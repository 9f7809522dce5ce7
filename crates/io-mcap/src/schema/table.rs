//! The fields of every message: Foxglove's as published, and our own.

use Count::{Many, One, OneOf};
use Kind::{Bool, Bytes, Choice, Double, Fixed32, Fixed64, Int32, Int64, Of, Text, Uint32, Uint64};

/// What a field holds.
#[derive(Clone, Copy)]
pub(super) enum Kind {
    Double,
    Fixed32,
    Fixed64,
    Uint32,
    Uint64,
    Int32,
    Int64,
    Bool,
    Text,
    Bytes,
    /// A message, by full name.
    Of(&'static str),
    /// An enumeration declared inside the message, by short name.
    Choice(&'static str),
}

/// How often a field may appear.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Count {
    One,
    Many,
    /// At most one of the fields so marked (a `oneof` called `values`).
    OneOf,
}

/// Name, number, how often, what.
pub(super) struct Field(pub(super) &'static str, pub(super) i32, pub(super) Count, pub(super) Kind);

/// One message and its fields.
pub(super) struct Description {
    pub(super) package: &'static str,
    pub(super) name: &'static str,
    pub(super) fields: &'static [Field],
    /// Enumerations declared inside the message, values numbered from 0.
    pub(super) choices: &'static [(&'static str, &'static [&'static str])],
}

const fn foxglove(name: &'static str, fields: &'static [Field]) -> Description {
    Description { package: "foxglove", name, fields, choices: &[] }
}

const fn organza(name: &'static str, fields: &'static [Field]) -> Description {
    Description { package: "organza", name, fields, choices: &[] }
}

const TIMESTAMP: Kind = Of("google.protobuf.Timestamp");
const DURATION: Kind = Of("google.protobuf.Duration");
const POSE: Kind = Of("foxglove.Pose");
const POINT3: Kind = Of("foxglove.Point3");
const VECTOR3: Kind = Of("foxglove.Vector3");
const QUATERNION: Kind = Of("foxglove.Quaternion");
const COLOR: Kind = Of("foxglove.Color");

const SECONDS_AND_NANOS: &[Field] =
    &[Field("seconds", 1, One, Int64), Field("nanos", 2, One, Int32)];
const XYZ: &[Field] =
    &[Field("x", 1, One, Double), Field("y", 2, One, Double), Field("z", 3, One, Double)];

/// Every message that may appear in a recording.
pub(super) const MESSAGES: &[Description] = &[
    Description {
        package: "google.protobuf",
        name: "Timestamp",
        fields: SECONDS_AND_NANOS,
        choices: &[],
    },
    Description {
        package: "google.protobuf",
        name: "Duration",
        fields: SECONDS_AND_NANOS,
        choices: &[],
    },
    foxglove("Point3", XYZ),
    foxglove("Vector3", XYZ),
    foxglove(
        "Quaternion",
        &[
            Field("x", 1, One, Double),
            Field("y", 2, One, Double),
            Field("z", 3, One, Double),
            Field("w", 4, One, Double),
        ],
    ),
    foxglove(
        "Color",
        &[
            Field("r", 1, One, Double),
            Field("g", 2, One, Double),
            Field("b", 3, One, Double),
            Field("a", 4, One, Double),
        ],
    ),
    foxglove("KeyValuePair", &[Field("key", 1, One, Text), Field("value", 2, One, Text)]),
    foxglove(
        "Pose",
        &[Field("position", 1, One, VECTOR3), Field("orientation", 2, One, QUATERNION)],
    ),
    foxglove(
        "ArrowPrimitive",
        &[
            Field("pose", 1, One, POSE),
            Field("shaft_length", 2, One, Double),
            Field("shaft_diameter", 3, One, Double),
            Field("head_length", 4, One, Double),
            Field("head_diameter", 5, One, Double),
            Field("color", 6, One, COLOR),
        ],
    ),
    foxglove(
        "CubePrimitive",
        &[
            Field("pose", 1, One, POSE),
            Field("size", 2, One, VECTOR3),
            Field("color", 3, One, COLOR),
        ],
    ),
    foxglove(
        "SpherePrimitive",
        &[
            Field("pose", 1, One, POSE),
            Field("size", 2, One, VECTOR3),
            Field("color", 3, One, COLOR),
        ],
    ),
    foxglove(
        "CylinderPrimitive",
        &[
            Field("pose", 1, One, POSE),
            Field("size", 2, One, VECTOR3),
            Field("bottom_scale", 3, One, Double),
            Field("top_scale", 4, One, Double),
            Field("color", 5, One, COLOR),
        ],
    ),
    Description {
        package: "foxglove",
        name: "LinePrimitive",
        fields: &[
            Field("type", 1, One, Choice("Type")),
            Field("pose", 2, One, POSE),
            Field("thickness", 3, One, Double),
            Field("scale_invariant", 4, One, Bool),
            Field("points", 5, Many, POINT3),
            Field("color", 6, One, COLOR),
            Field("colors", 7, Many, COLOR),
            Field("indices", 8, Many, Fixed32),
        ],
        choices: &[("Type", &["LINE_STRIP", "LINE_LOOP", "LINE_LIST"])],
    },
    foxglove(
        "TriangleListPrimitive",
        &[
            Field("pose", 1, One, POSE),
            Field("points", 2, Many, POINT3),
            Field("color", 3, One, COLOR),
            Field("colors", 4, Many, COLOR),
            Field("indices", 5, Many, Fixed32),
        ],
    ),
    foxglove(
        "TextPrimitive",
        &[
            Field("pose", 1, One, POSE),
            Field("billboard", 2, One, Bool),
            Field("font_size", 3, One, Double),
            Field("scale_invariant", 4, One, Bool),
            Field("color", 5, One, COLOR),
            Field("text", 6, One, Text),
        ],
    ),
    foxglove(
        "ModelPrimitive",
        &[
            Field("pose", 1, One, POSE),
            Field("scale", 2, One, VECTOR3),
            Field("color", 3, One, COLOR),
            Field("override_color", 4, One, Bool),
            Field("url", 5, One, Text),
            Field("media_type", 6, One, Text),
            Field("data", 7, One, Bytes),
        ],
    ),
    foxglove(
        "SceneEntity",
        &[
            Field("timestamp", 1, One, TIMESTAMP),
            Field("frame_id", 2, One, Text),
            Field("id", 3, One, Text),
            Field("lifetime", 4, One, DURATION),
            Field("frame_locked", 5, One, Bool),
            Field("metadata", 6, Many, Of("foxglove.KeyValuePair")),
            Field("arrows", 7, Many, Of("foxglove.ArrowPrimitive")),
            Field("cubes", 8, Many, Of("foxglove.CubePrimitive")),
            Field("spheres", 9, Many, Of("foxglove.SpherePrimitive")),
            Field("cylinders", 10, Many, Of("foxglove.CylinderPrimitive")),
            Field("lines", 11, Many, Of("foxglove.LinePrimitive")),
            Field("triangles", 12, Many, Of("foxglove.TriangleListPrimitive")),
            Field("texts", 13, Many, Of("foxglove.TextPrimitive")),
            Field("models", 14, Many, Of("foxglove.ModelPrimitive")),
        ],
    ),
    Description {
        package: "foxglove",
        name: "SceneEntityDeletion",
        fields: &[
            Field("timestamp", 1, One, TIMESTAMP),
            Field("type", 2, One, Choice("Type")),
            Field("id", 3, One, Text),
        ],
        choices: &[("Type", &["MATCHING_ID", "ALL"])],
    },
    foxglove(
        "SceneUpdate",
        &[
            Field("deletions", 1, Many, Of("foxglove.SceneEntityDeletion")),
            Field("entities", 2, Many, Of("foxglove.SceneEntity")),
        ],
    ),
    Description {
        package: "foxglove",
        name: "PackedElementField",
        fields: &[
            Field("name", 1, One, Text),
            Field("offset", 2, One, Fixed32),
            Field("type", 3, One, Choice("NumericType")),
        ],
        choices: &[(
            "NumericType",
            &[
                "UNKNOWN", "UINT8", "INT8", "UINT16", "INT16", "UINT32", "INT32", "FLOAT32",
                "FLOAT64",
            ],
        )],
    },
    foxglove(
        "PointCloud",
        &[
            Field("timestamp", 1, One, TIMESTAMP),
            Field("frame_id", 2, One, Text),
            Field("pose", 3, One, POSE),
            Field("point_stride", 4, One, Fixed32),
            Field("fields", 5, Many, Of("foxglove.PackedElementField")),
            Field("data", 6, One, Bytes),
        ],
    ),
    foxglove(
        "FrameTransform",
        &[
            Field("timestamp", 1, One, TIMESTAMP),
            Field("parent_frame_id", 2, One, Text),
            Field("child_frame_id", 3, One, Text),
            Field("translation", 4, One, VECTOR3),
            Field("rotation", 5, One, QUATERNION),
        ],
    ),
    foxglove("FrameTransforms", &[Field("transforms", 1, Many, Of("foxglove.FrameTransform"))]),
    foxglove(
        "CameraCalibration",
        &[
            Field("timestamp", 1, One, TIMESTAMP),
            Field("frame_id", 9, One, Text),
            Field("width", 2, One, Fixed32),
            Field("height", 3, One, Fixed32),
            Field("distortion_model", 4, One, Text),
            Field("D", 5, Many, Double),
            Field("K", 6, Many, Double),
            Field("R", 7, Many, Double),
            Field("P", 8, Many, Double),
        ],
    ),
    organza(
        "GarmentMaterial",
        &[
            Field("name", 1, One, Text),
            Field("coordinates", 2, Many, Double),
            Field("corners", 3, Many, Fixed32),
        ],
    ),
    organza("ClothMaterial", &[Field("garments", 1, Many, Of("organza.GarmentMaterial"))]),
    organza(
        "FrameMark",
        &[
            Field("frame", 1, One, Uint64),
            Field("time_s", 2, One, Double),
            Field("ordinal", 3, One, Uint64),
            Field("messages", 4, One, Uint32),
        ],
    ),
    organza("DoubleList", &[Field("values", 1, Many, Double)]),
    organza("Fixed32List", &[Field("values", 1, Many, Fixed32)]),
    organza("Fixed64List", &[Field("values", 1, Many, Fixed64)]),
    organza(
        "Column",
        &[
            Field("name", 1, One, Text),
            Field("f64", 2, OneOf, Of("organza.DoubleList")),
            Field("u32", 3, OneOf, Of("organza.Fixed32List")),
            Field("u64", 4, OneOf, Of("organza.Fixed64List")),
            Field("text", 5, OneOf, Text),
        ],
    ),
    organza(
        "Checkpoint",
        &[
            Field("frame", 1, One, Uint64),
            Field("time_s", 2, One, Double),
            Field("columns", 3, Many, Of("organza.Column")),
            Field("crc32", 15, One, Fixed32),
        ],
    ),
];
