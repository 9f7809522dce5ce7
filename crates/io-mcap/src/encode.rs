//! A frame as the messages of its topics.

use std::collections::BTreeSet;

use prost::Message as _;
use prost_types::{Duration, Timestamp};

use crate::proto::{
    CameraCalibration, ClothMaterial, Doubles, FrameTransform, FrameTransforms, Pose, SceneEntity,
    SceneEntityDeletion, SceneUpdate, TriangleListPrimitive,
};
use crate::topic::Topic;
use crate::{Camera, Error, Frame, Garment, material};

/// Frame of reference of everything that is drawn.
pub(crate) const WORLD: &str = "world";
/// Frame of reference of the camera.
pub(crate) const CAMERA: &str = "camera";

/// The messages of one frame except its mark.
pub(crate) struct EncodedFrame {
    pub(crate) geometry: Vec<(Topic, Vec<u8>)>,
    pub(crate) report: Vec<u8>,
}

/// Time on the clock of the file (ns), or what is wrong with it.
pub(crate) fn time_ns(time_s: f64) -> Result<u64, String> {
    let ns = (time_s * 1e9).round();
    // 2^63 ns are 292 years, and the seconds must fit the timestamps of the messages.
    if !(0.0..9.2e18).contains(&ns) {
        return Err(format!("time {time_s} s, which must lie from 0 to 9.2e9 s"));
    }
    Ok(ns as u64)
}

/// Encodes `frame`; `gone` names garments of the frame before that are to vanish from view.
pub(crate) fn encode(frame: &Frame<'_>, gone: &[&str]) -> Result<EncodedFrame, Error> {
    check(frame)?;
    let ns = time_ns(frame.time_s).map_err(|what| refuse(frame, what))?;
    let timestamp =
        Timestamp { seconds: (ns / 1_000_000_000) as i64, nanos: (ns % 1_000_000_000) as i32 };
    let scene = SceneUpdate {
        deletions: gone
            .iter()
            .map(|id| SceneEntityDeletion { timestamp: Some(timestamp), id: (*id).into() })
            .collect(),
        entities: frame.garments.iter().map(|g| entity(g, timestamp)).collect(),
    };
    let material = ClothMaterial {
        garments: frame
            .garments
            .iter()
            .map(|g| material::pack(g.name, g.points.len(), g.triangles, g.material))
            .collect(),
    };
    let mut geometry =
        vec![(Topic::Cloth, scene.encode_to_vec()), (Topic::Material, material.encode_to_vec())];
    let transforms = transforms(frame, timestamp);
    if !transforms.is_empty() {
        geometry.push((Topic::Transforms, FrameTransforms { transforms }.encode_to_vec()));
    }
    if let Some(camera) = &frame.camera {
        geometry.push((Topic::Camera, calibration(camera, timestamp).encode_to_vec()));
    }
    let report = serde_json::to_vec(frame.report)
        .map_err(|error| refuse(frame, format!("its report: {error}")))?;
    Ok(EncodedFrame { geometry, report })
}

fn refuse(frame: &Frame<'_>, what: impl std::fmt::Display) -> Error {
    Error::unrecordable(format!("frame {}: {what}", frame.index))
}

fn check(frame: &Frame<'_>) -> Result<(), Error> {
    if u32::try_from(frame.index).is_err() {
        return Err(refuse(frame, format!("the largest index is {}", u32::MAX)));
    }
    if !frame.report.is_object() {
        return Err(refuse(frame, "its report is not a JSON object"));
    }
    let mut names = BTreeSet::new();
    for garment in frame.garments {
        if garment.name.is_empty() || !names.insert(garment.name) {
            return Err(refuse(
                frame,
                format!("garment name {:?} is empty or used twice", garment.name),
            ));
        }
        check_garment(garment)
            .map_err(|what| refuse(frame, format!("garment {:?} has {what}", garment.name)))?;
    }
    let mut names = BTreeSet::from([WORLD, CAMERA]);
    for transform in frame.transforms {
        if transform.name.is_empty() || !names.insert(transform.name) {
            return Err(refuse(
                frame,
                format!("transform name {:?} is empty, taken or used twice", transform.name),
            ));
        }
    }
    Ok(())
}

fn check_garment(garment: &Garment<'_>) -> Result<(), String> {
    let (n_points, n_triangles) = (garment.points.len(), garment.triangles.len());
    // Corner numbers are u32 too, with one value spare.
    if n_points.max(3 * n_triangles) >= u32::MAX as usize {
        return Err(format!("{n_points} points and {n_triangles} triangles, too many"));
    }
    if garment.material.len() != n_triangles {
        return Err(format!(
            "material coordinates for {} triangles, but {n_triangles} triangles",
            garment.material.len()
        ));
    }
    match garment.triangles.iter().position(|t| t.iter().any(|&p| p as usize >= n_points)) {
        Some(t) => Err(format!("triangle {t} = {:?}, but {n_points} points", garment.triangles[t])),
        None => Ok(()),
    }
}

fn entity(garment: &Garment<'_>, timestamp: Timestamp) -> SceneEntity {
    let still = Pose {
        position: Some(Doubles([0.0; 3])),
        orientation: Some(Doubles([0.0, 0.0, 0.0, 1.0])),
    };
    SceneEntity {
        timestamp: Some(timestamp),
        frame_id: WORLD.into(),
        id: garment.name.into(),
        // Zero: until replaced.
        lifetime: Some(Duration::default()),
        frame_locked: true,
        triangles: vec![TriangleListPrimitive {
            pose: Some(still),
            points: garment.points.iter().map(|p| Doubles(*p)).collect(),
            color: Some(Doubles(garment.color.map(f64::from))),
            indices: garment.triangles.as_flattened().to_vec(),
        }],
    }
}

fn transforms(frame: &Frame<'_>, timestamp: Timestamp) -> Vec<FrameTransform> {
    let transform = |name: &str, translation, rotation| FrameTransform {
        timestamp: Some(timestamp),
        parent_frame_id: WORLD.into(),
        child_frame_id: name.into(),
        translation: Some(Doubles(translation)),
        rotation: Some(Doubles(rotation)),
    };
    let named = frame.transforms.iter().map(|t| transform(t.name, t.translation, t.rotation));
    let camera = frame.camera.iter().map(|c| transform(CAMERA, c.position, c.rotation));
    named.chain(camera).collect()
}

fn calibration(camera: &Camera, timestamp: Timestamp) -> CameraCalibration {
    let ([fx, fy], [cx, cy]) = (camera.focal_px, camera.center_px);
    CameraCalibration {
        timestamp: Some(timestamp),
        frame_id: CAMERA.into(),
        width: camera.width_px,
        height: camera.height_px,
        distortion_model: "plumb_bob".into(),
        d: vec![0.0; 5],
        k: vec![fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
        r: vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p: vec![fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
    }
}
