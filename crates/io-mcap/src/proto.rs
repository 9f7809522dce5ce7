//! The messages on the wire: the Foxglove ones this crate writes, and our own.
//!
//! Only the fields that are written appear here; [`crate::schema`] describes the messages in
//! full. Vectors are [`Doubles`], which write every component: the plain encoding leaves out
//! a component equal to zero, and with it the sign of -0.0.

use prost::Message;
use prost::bytes::{Buf, BufMut};
use prost::encoding::{DecodeContext, WireType, double, skip_field};
use prost::{DecodeError, Oneof};
use prost_types::{Duration, Timestamp};

/// A message of `N` doubles, numbered from 1: a point, vector, quaternion or colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Doubles<const N: usize>(pub(crate) [f64; N]);

/// `foxglove.Point3`, `foxglove.Vector3`.
pub(crate) type Double3 = Doubles<3>;
/// `foxglove.Quaternion` (x, y, z, w), `foxglove.Color` (r, g, b, a).
pub(crate) type Double4 = Doubles<4>;

impl<const N: usize> Default for Doubles<N> {
    fn default() -> Self {
        Self([0.0; N])
    }
}

impl<const N: usize> Message for Doubles<N> {
    fn encode_raw(&self, buf: &mut impl BufMut) {
        for (tag, value) in (1..).zip(&self.0) {
            double::encode(tag, value, buf);
        }
    }

    fn merge_field(
        &mut self,
        tag: u32,
        wire_type: WireType,
        buf: &mut impl Buf,
        context: DecodeContext,
    ) -> Result<(), DecodeError> {
        match (tag as usize).checked_sub(1).and_then(|k| self.0.get_mut(k)) {
            Some(value) => double::merge(wire_type, value, buf, context),
            None => skip_field(wire_type, tag, buf, context),
        }
    }

    fn encoded_len(&self) -> usize {
        // One byte of key (tags are below 16) and eight of value each.
        9 * N
    }

    fn clear(&mut self) {
        *self = Self::default();
    }
}

/// `foxglove.SceneUpdate`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct SceneUpdate {
    #[prost(message, repeated, tag = "1")]
    pub(crate) deletions: Vec<SceneEntityDeletion>,
    #[prost(message, repeated, tag = "2")]
    pub(crate) entities: Vec<SceneEntity>,
}

/// `foxglove.SceneEntityDeletion`; the type is left at its default, `MATCHING_ID`.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct SceneEntityDeletion {
    #[prost(message, optional, tag = "1")]
    pub(crate) timestamp: Option<Timestamp>,
    #[prost(string, tag = "3")]
    pub(crate) id: String,
}

/// `foxglove.SceneEntity`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct SceneEntity {
    #[prost(message, optional, tag = "1")]
    pub(crate) timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    pub(crate) frame_id: String,
    #[prost(string, tag = "3")]
    pub(crate) id: String,
    #[prost(message, optional, tag = "4")]
    pub(crate) lifetime: Option<Duration>,
    #[prost(bool, tag = "5")]
    pub(crate) frame_locked: bool,
    #[prost(message, repeated, tag = "12")]
    pub(crate) triangles: Vec<TriangleListPrimitive>,
}

/// `foxglove.Pose`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Pose {
    #[prost(message, optional, tag = "1")]
    pub(crate) position: Option<Double3>,
    #[prost(message, optional, tag = "2")]
    pub(crate) orientation: Option<Double4>,
}

/// `foxglove.TriangleListPrimitive`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct TriangleListPrimitive {
    #[prost(message, optional, tag = "1")]
    pub(crate) pose: Option<Pose>,
    #[prost(message, repeated, tag = "2")]
    pub(crate) points: Vec<Double3>,
    #[prost(message, optional, tag = "3")]
    pub(crate) color: Option<Double4>,
    #[prost(fixed32, repeated, tag = "5")]
    pub(crate) indices: Vec<u32>,
}

/// `foxglove.PointCloud`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct PointCloud {
    #[prost(message, optional, tag = "1")]
    pub(crate) timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    pub(crate) frame_id: String,
    #[prost(message, optional, tag = "3")]
    pub(crate) pose: Option<Pose>,
    #[prost(fixed32, tag = "4")]
    pub(crate) point_stride: u32,
    #[prost(message, repeated, tag = "5")]
    pub(crate) fields: Vec<PackedElementField>,
    #[prost(bytes = "vec", tag = "6")]
    pub(crate) data: Vec<u8>,
}

/// `foxglove.PackedElementField`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct PackedElementField {
    #[prost(string, tag = "1")]
    pub(crate) name: String,
    #[prost(fixed32, tag = "2")]
    pub(crate) offset: u32,
    /// The `NumericType`.
    #[prost(int32, tag = "3")]
    pub(crate) r#type: i32,
}

/// `foxglove.FrameTransforms`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct FrameTransforms {
    #[prost(message, repeated, tag = "1")]
    pub(crate) transforms: Vec<FrameTransform>,
}

/// `foxglove.FrameTransform`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct FrameTransform {
    #[prost(message, optional, tag = "1")]
    pub(crate) timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    pub(crate) parent_frame_id: String,
    #[prost(string, tag = "3")]
    pub(crate) child_frame_id: String,
    #[prost(message, optional, tag = "4")]
    pub(crate) translation: Option<Double3>,
    #[prost(message, optional, tag = "5")]
    pub(crate) rotation: Option<Double4>,
}

/// `foxglove.CameraCalibration`; `d`, `k`, `r`, `p` are called D, K, R, P there.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct CameraCalibration {
    #[prost(message, optional, tag = "1")]
    pub(crate) timestamp: Option<Timestamp>,
    #[prost(string, tag = "9")]
    pub(crate) frame_id: String,
    #[prost(fixed32, tag = "2")]
    pub(crate) width: u32,
    #[prost(fixed32, tag = "3")]
    pub(crate) height: u32,
    #[prost(string, tag = "4")]
    pub(crate) distortion_model: String,
    #[prost(double, repeated, tag = "5")]
    pub(crate) d: Vec<f64>,
    #[prost(double, repeated, tag = "6")]
    pub(crate) k: Vec<f64>,
    #[prost(double, repeated, tag = "7")]
    pub(crate) r: Vec<f64>,
    #[prost(double, repeated, tag = "8")]
    pub(crate) p: Vec<f64>,
}

/// `organza.ClothMaterial`: the material coordinates of every garment of one frame.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct ClothMaterial {
    #[prost(message, repeated, tag = "1")]
    pub(crate) garments: Vec<GarmentMaterial>,
}

/// `organza.GarmentMaterial`; see [`crate::material`] for the packing.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct GarmentMaterial {
    #[prost(string, tag = "1")]
    pub(crate) name: String,
    #[prost(double, repeated, tag = "2")]
    pub(crate) coordinates: Vec<f64>,
    #[prost(fixed32, repeated, tag = "3")]
    pub(crate) corners: Vec<u32>,
}

/// `organza.FrameMark`: which frame the messages before it belong to.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct FrameMark {
    #[prost(uint64, tag = "1")]
    pub(crate) frame: u64,
    /// Optional in Rust so that every value is written as it is, -0.0 too.
    #[prost(double, optional, tag = "2")]
    pub(crate) time_s: Option<f64>,
    /// Frames recorded before this one: a gap tells of a lost frame.
    #[prost(uint64, tag = "3")]
    pub(crate) ordinal: u64,
    /// Messages of this frame without this mark.
    #[prost(uint32, tag = "4")]
    pub(crate) messages: u32,
}

/// `organza.Checkpoint` without its closing CRC; see [`crate::checkpoint`].
#[derive(Clone, PartialEq, Message)]
pub(crate) struct CheckpointBody {
    #[prost(uint64, tag = "1")]
    pub(crate) frame: u64,
    /// Optional for the same reason as in [`FrameMark`].
    #[prost(double, optional, tag = "2")]
    pub(crate) time_s: Option<f64>,
    #[prost(message, repeated, tag = "3")]
    pub(crate) columns: Vec<NamedColumn>,
}

/// `organza.Column`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct NamedColumn {
    #[prost(string, tag = "1")]
    pub(crate) name: String,
    #[prost(oneof = "ColumnValues", tags = "2, 3, 4, 5")]
    pub(crate) values: Option<ColumnValues>,
}

/// The values of an `organza.Column`.
#[derive(Clone, PartialEq, Oneof)]
pub(crate) enum ColumnValues {
    #[prost(message, tag = "2")]
    F64(DoubleList),
    #[prost(message, tag = "3")]
    U32(Fixed32List),
    #[prost(message, tag = "4")]
    U64(Fixed64List),
    #[prost(string, tag = "5")]
    Text(String),
}

/// `organza.DoubleList`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct DoubleList {
    #[prost(double, repeated, tag = "1")]
    pub(crate) values: Vec<f64>,
}

/// `organza.Fixed32List`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Fixed32List {
    #[prost(fixed32, repeated, tag = "1")]
    pub(crate) values: Vec<u32>,
}

/// `organza.Fixed64List`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Fixed64List {
    #[prost(fixed64, repeated, tag = "1")]
    pub(crate) values: Vec<u64>,
}
