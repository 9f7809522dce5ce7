//! Checks and resolves obstacles, and how things touch.

use super::super::check::At;
use super::super::data::{Obstacle, ObstacleSource};
use super::super::format::{Capsule, ContactFile, ObstacleFile, ObstacleMesh, Sphere};
use super::super::limits::{
    MAX_COORDINATE_M, MAX_FRICTION, MAX_MESH_BYTES, MAX_THICKNESS_M, MAX_TRIANGLES,
};
use super::handle::{check_motion, check_transform};
use super::{Context, beyond, names};
use crate::contact::ContactSettings;

/// Checks all obstacles.
pub(super) fn resolve(
    obstacles: Vec<ObstacleFile>,
    at: &At<'_>,
    context: &mut Context<'_>,
) -> Option<Vec<Obstacle>> {
    let names = names(&obstacles, |obstacle| obstacle.name.clone(), "obstacle", at);
    let resolved: Vec<Option<Obstacle>> = obstacles
        .into_iter()
        .zip(names)
        .enumerate()
        .map(|(i, (obstacle, name))| resolve_one(obstacle, name, &at.index(i), context))
        .collect();
    resolved.into_iter().collect()
}

/// How things touch, in a scene with obstacles or without.
pub(super) fn contact(
    file: Option<ContactFile>,
    has_obstacles: bool,
    at: &At<'_>,
) -> Option<ContactSettings> {
    let file = match file {
        None if !has_obstacles => return None,
        None => ContactFile { self_contact: false, ..ContactFile::default() },
        Some(file) => file,
    };
    at.key("thickness_m").positive(file.thickness_m, MAX_THICKNESS_M, "m");
    at.key("friction").not_negative(file.friction, MAX_FRICTION, "");
    Some(ContactSettings {
        thickness: file.thickness_m,
        friction: file.friction,
        self_contact: file.self_contact,
    })
}

fn resolve_one(
    obstacle: ObstacleFile,
    name: String,
    at: &At<'_>,
    context: &mut Context<'_>,
) -> Option<Obstacle> {
    check_transform(&obstacle.transform, &at.key("transform"));
    at.key("friction").not_negative(obstacle.friction, MAX_FRICTION, "");
    let mut most = 1.0f64;
    if let Some(motion) = &obstacle.motion {
        check_motion(motion, &at.key("motion"));
        most = motion.keyframes.iter().map(|key| key.transform.scale).fold(0.0, f64::max);
    }
    let mesh = mesh(obstacle.mesh, &at.key("mesh"), context)?;
    let size = extent(&mesh);
    let reach = size * obstacle.transform.scale * most;
    if size <= MAX_COORDINATE_M && reach > MAX_COORDINATE_M {
        let reach = beyond(reach, MAX_COORDINATE_M, "m");
        at.key("transform.scale").complain(format!("the obstacle as scaled: {reach}"));
    }
    let (transform, motion, friction) = (obstacle.transform, obstacle.motion, obstacle.friction);
    Some(Obstacle { name, mesh, transform, motion, friction })
}

/// Checks the one source that `mesh` names.
fn mesh(mesh: ObstacleMesh, at: &At<'_>, context: &mut Context<'_>) -> Option<ObstacleSource> {
    let ObstacleMesh { obj, sphere, cuboid, plane, capsule } = mesh;
    let sources = [
        obj.map(ObstacleSource::Obj),
        sphere.map(ObstacleSource::Sphere),
        cuboid.map(ObstacleSource::Cuboid),
        plane.map(ObstacleSource::Plane),
        capsule.map(ObstacleSource::Capsule),
    ];
    let mut given = sources.into_iter().flatten();
    let (first, more) = (given.next(), given.count());
    let Some(source) = first.filter(|_| more == 0) else {
        let n = if more == 0 { 0 } else { more + 1 };
        at.complain(format!("must have exactly one of obj, sphere, box, plane, capsule; has {n}"));
        return None;
    };
    match &source {
        ObstacleSource::Obj(obj) => {
            context.read(&at.key("obj"), obj, MAX_MESH_BYTES)?;
        }
        ObstacleSource::Sphere(sphere) => check_sphere(sphere, &at.key("sphere")),
        ObstacleSource::Cuboid(cuboid) => check_sizes(&cuboid.size_m, &at.key("box.size_m")),
        ObstacleSource::Plane(plane) => check_sizes(&plane.size_m, &at.key("plane.size_m")),
        ObstacleSource::Capsule(capsule) => check_capsule(capsule, &at.key("capsule")),
    }
    Some(source)
}

/// The largest length in a generated surface (m); 0 for files, whose coordinates are not known yet.
fn extent(source: &ObstacleSource) -> f64 {
    match source {
        ObstacleSource::Obj(_) => 0.0,
        ObstacleSource::Sphere(sphere) => sphere.radius_m,
        ObstacleSource::Cuboid(cuboid) => cuboid.size_m.into_iter().fold(0.0, f64::max),
        ObstacleSource::Plane(plane) => plane.size_m.into_iter().fold(0.0, f64::max),
        ObstacleSource::Capsule(capsule) => capsule.radius_m.max(capsule.length_m),
    }
}

fn check_sizes(sizes: &[f64], at: &At<'_>) {
    for (i, &size) in sizes.iter().enumerate() {
        at.index(i).size(size);
    }
}

fn check_sphere(sphere: &Sphere, at: &At<'_>) {
    at.key("radius_m").size(sphere.radius_m);
    let triangles = 20.0 * 4f64.powf(f64::from(sphere.detail));
    if triangles > MAX_TRIANGLES {
        at.key("detail").complain(beyond(triangles, MAX_TRIANGLES, "triangles"));
    }
}

fn check_capsule(capsule: &Capsule, at: &At<'_>) {
    at.key("radius_m").size(capsule.radius_m);
    at.key("length_m").size(capsule.length_m);
    let segments = at.key("segments");
    segments.at_least(capsule.segments, 4);
    let triangles = f64::from(capsule.segments).powi(2);
    if triangles > MAX_TRIANGLES {
        segments.complain(beyond(triangles, MAX_TRIANGLES, "triangles"));
    }
}
