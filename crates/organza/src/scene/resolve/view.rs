//! Checks and resolves the camera, its shots, and the sizing by what it sees.

use super::super::check::{At, beyond};
use super::super::data::View;
use super::super::format::{Camera, CameraGltf, CameraKeyframe, ShotFile, ViewFile};
use super::super::issue::IssueKind;
use super::super::limits;
use super::handle::check_transform;
use super::{Context, animated};
use crate::character::{Container, read_camera};
use nalgebra::Vector3;
use sizing_view::{CameraPath, Key, Shot, ViewSettings};

/// The camera over time; none if the scene has none or something was complained of.
pub(super) fn path(
    camera: Option<&Camera>,
    shots: &[ShotFile],
    scene: &Facts,
    top: &At<'_>,
    context: &mut Context<'_, '_>,
) -> Option<CameraPath> {
    let scene_up = scene.up;
    let Some(camera) = camera else {
        if !shots.is_empty() {
            top.key("shots").complain("the scene has no `camera`, which sets the resolution");
        }
        return None;
    };
    let own = check_camera(camera, scene_up, &top.key("camera"));
    if shots.is_empty() {
        return own.map(CameraPath::still);
    }
    if shots.len() > limits::MAX_SHOTS {
        let n = shots.len();
        let limit = limits::MAX_SHOTS;
        top.key("shots").complain(format!("has {n} elements, beyond the limit of {limit}"));
        return None;
    }
    let at = top.key("shots");
    let resolved: Vec<Option<Shot>> = shots
        .iter()
        .enumerate()
        .map(|(i, shot)| {
            let at = at.index(i);
            at.key("start_s").bounded(shot.start_s, limits::MAX_TIME_S, "s");
            if shot.keyframes.is_empty() == shot.gltf.is_none() {
                at.complain("must have exactly one of keyframes, gltf");
                return None;
            }
            if let Some(gltf) = &shot.gltf {
                let keys = from_gltf(gltf, camera, scene, &at.key("gltf"), context)?;
                return Some(Shot { start: shot.start_s, keys });
            }
            let keys = shot.keyframes.iter().enumerate();
            let keys: Vec<Option<Key>> = keys
                .map(|(k, key)| keyframe(key, camera, scene_up, &at.key("keyframes").index(k)))
                .collect();
            let keys = keys.into_iter().collect::<Option<_>>()?;
            Some(Shot { start: shot.start_s, keys })
        })
        .collect();
    let path = CameraPath::new(resolved.into_iter().collect::<Option<_>>()?);
    path.map_err(|error| at.complain(error.to_string())).ok()
}

/// What the times and the directions of cameras depend on.
pub(super) struct Facts {
    /// Unit vector against gravity.
    pub(super) up: [f64; 3],
    /// Frame rate (1/s).
    pub(super) frames_per_second: f64,
    /// Number of frames after the first.
    pub(super) frames: u32,
}

/// The cameras of a glTF file at the times of the scene's frames; one if it does not move.
fn from_gltf(
    gltf: &CameraGltf,
    like: &Camera,
    scene: &Facts,
    at: &At<'_>,
    context: &mut Context<'_, '_>,
) -> Option<Vec<Key>> {
    check_transform(&gltf.transform, &at.key("transform"));
    at.key("start_s").bounded(gltf.start_s, limits::MAX_TIME_S, "s");
    animated::read_file(&gltf.file, &at.key("file"), context)?;
    let read = {
        let file = |name: &str| context.files.get(name);
        Container::new(&gltf.file, file(&gltf.file)?, file)
            .and_then(|file| read_camera(&file, gltf.camera.as_deref(), gltf.animation.as_ref()))
    };
    let refused = |message: String| {
        at.key("file").report(IssueKind::File, format!("`{}`: {message}", gltf.file));
    };
    let camera = read.map_err(refused).ok()?;
    let place = gltf.transform.similarity();
    let times: Vec<f64> = match camera.span() {
        None => vec![0.0],
        Some([first, last]) => {
            // From the frame before it begins to that after its end.
            let frame = |time: f64| (time + gltf.start_s) * scene.frames_per_second;
            let frames = f64::from(scene.frames) + limits::MAX_VIEW_WINDOW;
            let from = frame(first).floor().clamp(0.0, frames) as u64;
            let to = frame(last).ceil().clamp(0.0, frames) as u64;
            (from..=to).map(|k| k as f64 / scene.frames_per_second).collect()
        }
    };
    let keys = times.into_iter().map(|time| {
        let (position, axes) = camera.at(time - gltf.start_s)?;
        let fov = camera.vertical_fov;
        if !(fov > 0.0 && fov < std::f64::consts::PI) {
            return None;
        }
        let focal = 0.5 * f64::from(like.resolution[1]) / (0.5 * fov).tan();
        let position = place.transform_point(&position.into()).coords;
        let axes = place.isometry.rotation * axes;
        let camera = sizing_view::Camera::new(position, axes, focal, like.resolution).ok()?;
        Some(Key { time, camera })
    });
    let keys: Option<Vec<Key>> = keys.collect();
    if keys.is_none() {
        refused("its camera has no direction, place or opening angle".into());
    }
    keys
}

fn keyframe(key: &CameraKeyframe, like: &Camera, scene_up: [f64; 3], at: &At<'_>) -> Option<Key> {
    at.key("time_s").bounded(key.time_s, limits::MAX_TIME_S, "s");
    let camera = Camera {
        position: key.position,
        target: key.target,
        up: key.up.or(like.up),
        vertical_fov_deg: key.vertical_fov_deg.unwrap_or(like.vertical_fov_deg),
        resolution: like.resolution,
    };
    Some(Key { time: key.time_s, camera: check_camera(&camera, scene_up, at)? })
}

/// Checks a camera; none if something was complained of.
fn check_camera(camera: &Camera, scene_up: [f64; 3], at: &At<'_>) -> Option<sizing_view::Camera> {
    at.key("position").coordinates(&camera.position);
    at.key("target").coordinates(&camera.target);
    let fov = camera.vertical_fov_deg;
    if !(1.0..=170.0).contains(&fov) {
        at.key("vertical_fov_deg").complain(format!("must lie between 1 and 170, got {fov}"));
    }
    for (i, pixels) in camera.resolution.into_iter().enumerate() {
        let at = at.key("resolution").index(i);
        at.at_least(pixels, 1);
        if pixels > limits::MAX_PICTURE_PX {
            let limit = f64::from(limits::MAX_PICTURE_PX);
            at.complain(beyond(f64::from(pixels), limit, "pixels"));
        }
    }
    let vector = Vector3::from;
    let view = vector(camera.target) - vector(camera.position);
    let up = vector(camera.up.unwrap_or(scene_up));
    if view.norm() < 1e-9 {
        at.key("target").complain("is where the camera stands");
        return None;
    } else if view.normalize().cross(&up).norm() < 1e-6 * up.norm().max(1e-9) {
        at.key("up")
            .complain("is parallel to the direction of view or zero; give an `up` across the view");
        return None;
    }
    let (position, target) = (camera.position.into(), camera.target.into());
    let made =
        sizing_view::Camera::looking_at(position, target, up, fov.to_radians(), camera.resolution);
    // What it refuses has been complained of above.
    made.ok()
}

/// The constants of sizing by view.
pub(super) fn settings(
    view: ViewFile,
    has_camera: bool,
    scene: &Facts,
    top: &At<'_>,
    context: &mut Context<'_, '_>,
) -> Option<View> {
    let at = top.key("view");
    if !has_camera {
        at.complain("the scene has no `camera` to look through");
    }
    let settings = ViewSettings {
        v_back: view.v_back,
        v_hidden: view.v_hidden,
        v_out: view.v_out,
        margin: view.margin_m,
        window: view.window_frames,
        size_min_px: view.size_min_px,
        shift_max_px: view.shift_max_px,
        size_max: view.size_max_m,
        ..ViewSettings::default()
    };
    settings.check().map_err(|error| at.complain(error.to_string())).ok()?;
    if view.cameras.len() > limits::MAX_VIEW_CAMERAS {
        let (n, limit) = (view.cameras.len(), limits::MAX_VIEW_CAMERAS);
        at.key("cameras").complain(format!("has {n} elements, beyond the limit of {limit}"));
        return None;
    }
    let more: Vec<Option<CameraPath>> = view
        .cameras
        .iter()
        .enumerate()
        .map(|(i, more)| {
            let at = at.key("cameras").index(i);
            path(Some(&more.camera), &more.shots, scene, &at, context)
        })
        .collect();
    let more_cameras = more.into_iter().collect::<Option<_>>()?;
    let (occlusion, predicted) = (view.occlusion, view.predicted);
    has_camera.then_some(View { settings, occlusion, predicted, more_cameras })
}
