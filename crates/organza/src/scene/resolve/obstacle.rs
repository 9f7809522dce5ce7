//! Checks and resolves obstacles, and how things touch.

use super::super::check::At;
use super::super::data::{Obstacle, ObstacleSource};
use super::super::format::{
    Capsule, CharacterFile, ContactFile, ObstacleFile, ObstacleMesh, Sphere, Torus,
};
use super::super::limits::{
    MAX_COORDINATE_M, MAX_FRICTION, MAX_MESH_BYTES, MAX_THICKNESS_M, MAX_TIME_S, MAX_TRIANGLES,
};
use super::animated;
use super::handle::{check_motion, check_times, check_transform};
use super::{Context, beyond, names};
use crate::contact::ContactSettings;

/// Checks all obstacles.
pub(super) fn resolve(
    obstacles: Vec<ObstacleFile>,
    at: &At<'_>,
    context: &mut Context<'_, '_>,
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
    context: &mut Context<'_, '_>,
) -> Option<Obstacle> {
    check_transform(&obstacle.transform, &at.key("transform"));
    at.key("friction").not_negative(obstacle.friction, MAX_FRICTION, "");
    if let Some(thickness) = obstacle.thickness_m {
        at.key("thickness_m").positive(thickness, MAX_THICKNESS_M, "m");
    }
    let mut most = 1.0f64;
    if let Some(motion) = &obstacle.motion {
        check_motion(motion, 1.0, &at.key("motion"));
        most = motion.keyframes.iter().map(|key| key.transform.scale).fold(0.0, f64::max);
    }
    let mesh = mesh(obstacle.mesh, &at.key("mesh"), context)?;
    let size = extent(&mesh);
    let reach = size * obstacle.transform.scale * most;
    if size <= MAX_COORDINATE_M && reach > MAX_COORDINATE_M {
        let reach = beyond(reach, MAX_COORDINATE_M, "m");
        at.key("transform.scale").complain(format!("the obstacle as scaled: {reach}"));
    }
    check_times(obstacle.start_s, obstacle.end_s, at);
    let (transform, motion, friction) = (obstacle.transform, obstacle.motion, obstacle.friction);
    let (start_s, end_s) = (obstacle.start_s, obstacle.end_s.unwrap_or(f64::INFINITY));
    let thickness_m = obstacle.thickness_m;
    Some(Obstacle { name, mesh, transform, motion, friction, thickness_m, start_s, end_s })
}

/// Checks the one source that `mesh` names.
fn mesh(mesh: ObstacleMesh, at: &At<'_>, context: &mut Context<'_, '_>) -> Option<ObstacleSource> {
    let ObstacleMesh { obj, obj_sequence, gltf, character, sphere, cuboid, plane, capsule, torus } =
        mesh;
    let given = [
        obj.is_some(),
        obj_sequence.is_some(),
        gltf.is_some(),
        character.is_some(),
        sphere.is_some(),
        cuboid.is_some(),
        plane.is_some(),
        capsule.is_some(),
        torus.is_some(),
    ];
    let n = given.into_iter().filter(|given| *given).count();
    if n != 1 {
        at.complain(format!(
            "must have exactly one of obj, obj_sequence, gltf, character, sphere, box, plane, \
             capsule, torus; has {n}"
        ));
        return None;
    }
    if let Some(sequence) = obj_sequence {
        let sequence = animated::sequence(&sequence, &at.key("obj_sequence"), context)?;
        return Some(ObstacleSource::Sequence(sequence));
    }
    let sources = [
        obj.map(ObstacleSource::Obj),
        gltf.map(ObstacleSource::Gltf),
        character.map(ObstacleSource::Character),
        sphere.map(ObstacleSource::Sphere),
        cuboid.map(ObstacleSource::Cuboid),
        plane.map(ObstacleSource::Plane),
        capsule.map(ObstacleSource::Capsule),
        torus.map(ObstacleSource::Torus),
    ];
    let source = sources.into_iter().flatten().next()?;
    match &source {
        ObstacleSource::Obj(obj) => {
            context.read(&at.key("obj"), obj, MAX_MESH_BYTES)?;
        }
        ObstacleSource::Gltf(gltf) => animated::read_gltf(gltf, &at.key("gltf"), context)?,
        ObstacleSource::Sequence(_) => {}
        ObstacleSource::Character(character) => check_character(character, &at.key("character")),
        ObstacleSource::Sphere(sphere) => check_sphere(sphere, &at.key("sphere")),
        ObstacleSource::Cuboid(cuboid) => check_sizes(&cuboid.size_m, &at.key("box.size_m")),
        ObstacleSource::Plane(plane) => check_sizes(&plane.size_m, &at.key("plane.size_m")),
        ObstacleSource::Capsule(capsule) => check_capsule(capsule, &at.key("capsule")),
        ObstacleSource::Torus(torus) => check_torus(torus, &at.key("torus")),
    }
    Some(source)
}

/// The largest length in a generated surface (m); 0 for files, whose coordinates are not known yet.
fn extent(source: &ObstacleSource) -> f64 {
    match source {
        ObstacleSource::Obj(_) | ObstacleSource::Sequence(_) | ObstacleSource::Gltf(_) => 0.0,
        ObstacleSource::Character(_) => 2.0,
        ObstacleSource::Sphere(sphere) => sphere.radius_m,
        ObstacleSource::Cuboid(cuboid) => cuboid.size_m.into_iter().fold(0.0, f64::max),
        ObstacleSource::Plane(plane) => plane.size_m.into_iter().fold(0.0, f64::max),
        ObstacleSource::Capsule(capsule) => capsule.radius_m.max(capsule.length_m),
        ObstacleSource::Torus(torus) => 2.0 * torus.radius_m,
    }
}

/// Checks a character, of an obstacle or of a crowd.
pub(super) fn check_character(character: &CharacterFile, at: &At<'_>) {
    let [low, high] = [mannequin::Mannequin::MIN_CELL, mannequin::Mannequin::MAX_CELL];
    if !(low..=high).contains(&character.cell_m) {
        let got = character.cell_m;
        at.key("cell_m").complain(format!("must lie between {low} and {high}, got {got}"));
    }
    at.key("phase").bounded(character.phase, 1e6, "");
    at.key("start_s").bounded(character.start_s, MAX_TIME_S, "s");
    at.key("ease_s").not_negative(character.ease_s, MAX_TIME_S, "s");
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

fn check_torus(torus: &Torus, at: &At<'_>) {
    at.key("radius_m").size(torus.radius_m);
    let tube = at.key("tube_radius_m");
    tube.size(torus.tube_radius_m);
    if torus.tube_radius_m >= torus.radius_m && torus.radius_m > 0.0 {
        let (tube_radius, radius) = (torus.tube_radius_m, torus.radius_m);
        tube.complain(format!("{tube_radius} m leaves no hole in a ring of {radius} m"));
    }
    let segments = at.key("segments");
    for (i, n) in torus.segments.into_iter().enumerate() {
        segments.index(i).at_least(n, 3);
    }
    let triangles = torus.segments.map(f64::from).into_iter().product::<f64>() * 2.0;
    if triangles > MAX_TRIANGLES {
        segments.complain(beyond(triangles, MAX_TRIANGLES, "triangles"));
    }
}
