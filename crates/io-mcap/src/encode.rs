//! A frame as the messages of its topics.

use std::collections::BTreeSet;

use prost::Message as _;
use prost_types::{Duration, Timestamp};

use crate::proto::{
    CameraCalibration, ClothMaterial, Doubles, FrameTransform, FrameTransforms, Pose, SceneEntity,
    SceneEntityDeletion, SceneUpdate, TriangleListPrimitive,
};
use crate::topic::Topic;
use crate::{Camera, Error, Frame, Garment, Obstacle, fluid, material};

/// Frame of reference of everything that is drawn.
pub(crate) const WORLD: &str = "world";
/// Frame of reference of the camera.
pub(crate) const CAMERA: &str = "camera";

/// The messages of one frame except its mark.
pub(crate) struct EncodedFrame {
    pub(crate) geometry: Vec<(Topic, Vec<u8>)>,
    pub(crate) report: Vec<u8>,
}

/// Names of what a frame shows.
#[derive(Debug, Default)]
pub(crate) struct Shown {
    pub(crate) garments: Vec<String>,
    pub(crate) obstacles: Vec<String>,
}

impl Shown {
    pub(crate) fn by(frame: &Frame<'_>) -> Self {
        Self {
            garments: frame.garments.iter().map(|g| g.name.to_owned()).collect(),
            obstacles: frame.obstacles.iter().map(|o| o.name.to_owned()).collect(),
        }
    }
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

/// Encodes `frame`; what `before` names and the frame does not is to vanish from view.
pub(crate) fn encode(frame: &Frame<'_>, before: &Shown) -> Result<EncodedFrame, Error> {
    check(frame)?;
    let ns = time_ns(frame.time_s).map_err(|what| refuse(frame, what))?;
    let timestamp =
        Timestamp { seconds: (ns / 1_000_000_000) as i64, nanos: (ns % 1_000_000_000) as i32 };
    let garments = frame.garments.iter().map(Drawn::from).collect();
    let cloth = scene(garments, &before.garments, timestamp);
    let material = ClothMaterial {
        garments: frame
            .garments
            .iter()
            .map(|g| material::pack(g.name, g.points.len(), g.triangles, g.material))
            .collect(),
    };
    let mut geometry =
        vec![(Topic::Cloth, cloth.encode_to_vec()), (Topic::Material, material.encode_to_vec())];
    let obstacles = frame.obstacles.iter().map(Drawn::from).collect();
    let obstacles = scene(obstacles, &before.obstacles, timestamp);
    if obstacles != SceneUpdate::default() {
        geometry.push((Topic::Obstacles, obstacles.encode_to_vec()));
    }
    if let Some(particles) = frame.fluid {
        geometry.push((Topic::Fluid, fluid::pack(particles, timestamp).encode_to_vec()));
    }
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
        check_mesh(&Drawn::from(garment))
            .and_then(|()| check_material(garment))
            .map_err(|what| refuse(frame, format!("garment {:?} has {what}", garment.name)))?;
    }
    let mut names = BTreeSet::new();
    for obstacle in frame.obstacles {
        if obstacle.name.is_empty() || !names.insert(obstacle.name) {
            let what = format!("obstacle name {:?} is empty or used twice", obstacle.name);
            return Err(refuse(frame, what));
        }
        check_mesh(&Drawn::from(obstacle))
            .map_err(|what| refuse(frame, format!("obstacle {:?} has {what}", obstacle.name)))?;
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

/// What garments and obstacles have in common.
struct Drawn<'a> {
    name: &'a str,
    points: &'a [[f64; 3]],
    triangles: &'a [[u32; 3]],
    color: [f32; 4],
}

impl<'a> From<&Garment<'a>> for Drawn<'a> {
    fn from(garment: &Garment<'a>) -> Self {
        let Garment { name, points, triangles, color, .. } = *garment;
        Self { name, points, triangles, color }
    }
}

impl<'a> From<&Obstacle<'a>> for Drawn<'a> {
    fn from(obstacle: &Obstacle<'a>) -> Self {
        let Obstacle { name, points, triangles, color } = *obstacle;
        Self { name, points, triangles, color }
    }
}

fn check_mesh(mesh: &Drawn<'_>) -> Result<(), String> {
    let (n_points, n_triangles) = (mesh.points.len(), mesh.triangles.len());
    // Corner numbers are u32 too, with one value spare.
    if n_points.max(3 * n_triangles) >= u32::MAX as usize {
        return Err(format!("{n_points} points and {n_triangles} triangles, too many"));
    }
    match mesh.triangles.iter().position(|t| t.iter().any(|&p| p as usize >= n_points)) {
        Some(t) => Err(format!("triangle {t} = {:?}, but {n_points} points", mesh.triangles[t])),
        None => Ok(()),
    }
}

fn check_material(garment: &Garment<'_>) -> Result<(), String> {
    let (n, n_triangles) = (garment.material.len(), garment.triangles.len());
    if n == n_triangles {
        return Ok(());
    }
    Err(format!("material coordinates for {n} triangles, but {n_triangles} triangles"))
}

/// The update that draws `meshes` and removes what only the frame `before` showed.
fn scene(meshes: Vec<Drawn<'_>>, before: &[String], timestamp: Timestamp) -> SceneUpdate {
    let names: BTreeSet<&str> = meshes.iter().map(|mesh| mesh.name).collect();
    let gone = before.iter().filter(|id| !names.contains(id.as_str()));
    SceneUpdate {
        deletions: gone
            .map(|id| SceneEntityDeletion { timestamp: Some(timestamp), id: id.clone() })
            .collect(),
        entities: meshes.iter().map(|mesh| entity(mesh, timestamp)).collect(),
    }
}

fn entity(mesh: &Drawn<'_>, timestamp: Timestamp) -> SceneEntity {
    let still = Pose {
        position: Some(Doubles([0.0; 3])),
        orientation: Some(Doubles([0.0, 0.0, 0.0, 1.0])),
    };
    SceneEntity {
        timestamp: Some(timestamp),
        frame_id: WORLD.into(),
        id: mesh.name.into(),
        // Zero: until replaced.
        lifetime: Some(Duration::default()),
        frame_locked: true,
        triangles: vec![TriangleListPrimitive {
            pose: Some(still),
            points: mesh.points.iter().map(|p| Doubles(*p)).collect(),
            color: Some(Doubles(mesh.color.map(f64::from))),
            indices: mesh.triangles.as_flattened().to_vec(),
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
