//! The messages of a frame as a frame.

use prost::Message;

use crate::encode::{CAMERA, Shown};
use crate::frame::{OwnedFrame, OwnedGarment, OwnedObstacle, OwnedTransform};
use crate::proto::{
    CameraCalibration, ClothMaterial, Doubles, FrameTransforms, GarmentMaterial, SceneEntity,
    SceneUpdate,
};
use crate::topic::Topic;
use crate::{Camera, FrameInfo, fluid, material};

/// The frame in `geometry` and `report`, or what is wrong with them.
pub(crate) fn decode(
    info: FrameInfo,
    geometry: &[(Topic, Vec<u8>)],
    report: &[u8],
) -> Result<OwnedFrame, String> {
    let find = |topic| geometry.iter().find(|(t, _)| *t == topic).map(|(_, bytes)| &**bytes);
    let required =
        |topic: Topic| find(topic).ok_or_else(|| format!("no message on {}", topic.name()));
    let scene: SceneUpdate = message(Topic::Cloth, required(Topic::Cloth)?)?;
    let packed: ClothMaterial = message(Topic::Material, required(Topic::Material)?)?;
    if scene.entities.len() != packed.garments.len() {
        return Err(format!(
            "{} garments drawn, {} with material coordinates",
            scene.entities.len(),
            packed.garments.len()
        ));
    }
    let garments = scene
        .entities
        .into_iter()
        .zip(&packed.garments)
        .map(|(entity, packed)| garment(entity, packed))
        .collect::<Result<_, _>>()?;

    let obstacles = match find(Topic::Obstacles) {
        Some(bytes) => message::<SceneUpdate>(Topic::Obstacles, bytes)?.entities,
        None => Vec::new(),
    };
    let obstacles = obstacles.into_iter().map(obstacle).collect::<Result<_, _>>()?;

    let fluid = match find(Topic::Fluid) {
        Some(bytes) => {
            let particles = fluid::unpack(&message(Topic::Fluid, bytes)?);
            Some(particles.map_err(|what| format!("{}: {what}", Topic::Fluid.name()))?)
        }
        None => None,
    };

    let mut transforms = Vec::new();
    let mut camera_pose = None;
    if let Some(bytes) = find(Topic::Transforms) {
        for t in message::<FrameTransforms>(Topic::Transforms, bytes)?.transforms {
            let translation = t.translation.unwrap_or_default().0;
            let Doubles(rotation) = t.rotation.unwrap_or_default();
            if t.child_frame_id == CAMERA {
                camera_pose = Some((translation, rotation));
            } else {
                transforms.push(OwnedTransform { name: t.child_frame_id, translation, rotation });
            }
        }
    }
    let camera = match find(Topic::Camera) {
        Some(bytes) => {
            let pose = camera_pose.ok_or("a camera without its transform")?;
            Some(camera(&message(Topic::Camera, bytes)?, pose)?)
        }
        None => None,
    };
    let report = decode_report(report)?;
    let FrameInfo { index, time_s } = info;
    Ok(OwnedFrame { index, time_s, garments, obstacles, fluid, camera, transforms, report })
}

pub(crate) fn decode_report(bytes: &[u8]) -> Result<serde_json::Value, String> {
    serde_json::from_slice(bytes).map_err(|e| format!("{}: {e}", Topic::Report.name()))
}

/// Names of what the messages of a frame draw.
pub(crate) fn shown(geometry: &[(Topic, Vec<u8>)]) -> Result<Shown, String> {
    let names = |topic: Topic| -> Result<Vec<String>, String> {
        let Some((_, bytes)) = geometry.iter().find(|(t, _)| *t == topic) else {
            return Ok(Vec::new());
        };
        let scene: SceneUpdate = message(topic, bytes)?;
        Ok(scene.entities.into_iter().map(|entity| entity.id).collect())
    };
    Ok(Shown { garments: names(Topic::Cloth)?, obstacles: names(Topic::Obstacles)? })
}

fn message<M: Message + Default>(topic: Topic, bytes: &[u8]) -> Result<M, String> {
    M::decode(bytes).map_err(|e| format!("{}: {e}", topic.name()))
}

fn garment(entity: SceneEntity, packed: &GarmentMaterial) -> Result<OwnedGarment, String> {
    let name = entity.id.clone();
    let told = |what: String| format!("garment {name:?}: {what}");
    if packed.name != name {
        return Err(told(format!("its material coordinates are those of {:?}", packed.name)));
    }
    let OwnedObstacle { name: _, points, triangles, color } = mesh(entity).map_err(told)?;
    let material = material::unpack(packed, points.len(), &triangles).map_err(told)?;
    Ok(OwnedGarment { name, points, triangles, material, color })
}

fn obstacle(entity: SceneEntity) -> Result<OwnedObstacle, String> {
    let name = entity.id.clone();
    mesh(entity).map_err(|what| format!("obstacle {name:?}: {what}"))
}

/// What is drawn of an entity, or what is wrong with it.
fn mesh(entity: SceneEntity) -> Result<OwnedObstacle, String> {
    let [list]: [_; 1] = entity
        .triangles
        .try_into()
        .map_err(|lists: Vec<_>| format!("{} triangle lists instead of 1", lists.len()))?;
    let points: Vec<[f64; 3]> = list.points.into_iter().map(|Doubles(p)| p).collect();
    let (triangles, rest) = list.indices.as_chunks::<3>();
    if !rest.is_empty() {
        return Err(format!("{} indices, not a multiple of 3", list.indices.len()));
    }
    if let Some(p) = list.indices.iter().find(|&&p| p as usize >= points.len()) {
        return Err(format!("index {p} of {} points", points.len()));
    }
    let triangles = triangles.to_vec();
    let Doubles(color) = list.color.unwrap_or_default();
    Ok(OwnedObstacle { name: entity.id, points, triangles, color: color.map(|c| c as f32) })
}

fn camera(
    calibration: &CameraCalibration,
    (position, rotation): ([f64; 3], [f64; 4]),
) -> Result<Camera, String> {
    let &[fx, _, cx, _, fy, cy, _, _, _] = &calibration.k[..] else {
        return Err(format!("a camera matrix of {} numbers instead of 9", calibration.k.len()));
    };
    Ok(Camera {
        width_px: calibration.width,
        height_px: calibration.height,
        focal_px: [fx, fy],
        center_px: [cx, cy],
        position,
        rotation,
    })
}
