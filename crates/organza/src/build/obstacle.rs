//! The obstacles of a scene: surfaces read from files or generated, with their motions.

use super::BuildError;
use crate::character::{self, Container};
use crate::obstacle::{Frames, Obstacle, Shape};
use crate::scene::format::{Action, CharacterFile, Gltf};
use crate::scene::{Loaded, ObstacleSource, Sequence, limits};
use mannequin::{Mannequin, MannequinError};
use mesh_core::World3;
use mesh_core::generate::{self, Diagonal, GenerateError, Surface};
use mesh_core::obj::{self, ObjMesh};

/// Builds all obstacles of a scene.
pub(super) fn obstacles(loaded: &Loaded) -> Result<Vec<Obstacle>, BuildError> {
    let mut obstacles: Vec<Obstacle> = Vec::new();
    let mut n_triangles = 0;
    let mut bodies = Vec::new();
    for (index, body) in loaded.scene.obstacles.iter().enumerate() {
        let error = |message| BuildError::Obstacle { obstacle: index, message };
        let shape = shape(&body.mesh, loaded, &mut bodies).map_err(error)?;
        let motion = body.motion.as_ref();
        let name = body.name.as_str();
        let mut obstacle = Obstacle::new(name, shape, &body.transform, motion, body.friction)
            .map_err(|e| error(e.to_string()))?;
        obstacle.thickness = body.thickness_m;
        n_triangles += obstacle.triangles.len();
        if n_triangles > limits::MAX_SCENE_TRIANGLES {
            let limit = limits::MAX_SCENE_TRIANGLES;
            return Err(error(format!("more than {limit} triangles in all obstacles")));
        }
        obstacles.push(obstacle.between(body.start_s, body.end_s));
    }
    Ok(obstacles)
}

/// Reads or makes the surface of an obstacle; `bodies` are the mannequins made so far.
fn shape(
    source: &ObstacleSource,
    loaded: &Loaded,
    bodies: &mut Vec<Mannequin>,
) -> Result<Shape, String> {
    let generated = |surface: Result<Surface, GenerateError>| surface.map_err(|e| e.to_string());
    let surface = match source {
        ObstacleSource::Obj(file) => read_obj(file, loaded).map(|read| read.to_surface()),
        ObstacleSource::Sequence(sequence) => return frames(sequence, loaded).map(Shape::Frames),
        ObstacleSource::Gltf(gltf) => {
            let read = character(gltf, loaded).map_err(|e| format!("{}: {e}", gltf.file));
            return read.map(Shape::Character);
        }
        ObstacleSource::Character(character) => {
            return mannequin(character, bodies).map(Shape::Mannequin).map_err(|e| e.to_string());
        }
        ObstacleSource::Sphere(s) => generated(generate::sphere(s.radius_m, s.detail as usize)),
        ObstacleSource::Cuboid(b) => generated(generate::cuboid(b.size_m)),
        ObstacleSource::Plane(plane) => {
            let sheet = generate::grid(plane.size_m, [1, 1], Diagonal::One);
            let sheet = sheet.map_err(|e| e.to_string())?;
            let middle = World3::new(plane.size_m[0], plane.size_m[1], 0.0) * 0.5;
            let positions = sheet.positions.iter().map(|x| x - middle).collect();
            Ok(Surface { positions, triangles: sheet.mesh.triangles().to_vec() })
        }
        ObstacleSource::Capsule(c) => {
            generated(generate::capsule(c.radius_m, c.length_m, c.segments as usize))
        }
        ObstacleSource::Torus(t) => {
            let [around, across] = t.segments.map(|n| n as usize);
            generated(generate::torus(t.radius_m, t.tube_radius_m, around, across))
        }
    };
    surface.map(Shape::Rigid)
}

/// A mannequin, with the skin of one that has been made already if there is one like it.
fn mannequin(
    character: &CharacterFile,
    bodies: &mut Vec<Mannequin>,
) -> Result<Mannequin, MannequinError> {
    let motion = mannequin::Motion {
        action: match character.motion {
            Action::Stand => mannequin::Action::Stand,
            Action::Walk => mannequin::Action::Walk,
            Action::Turn => mannequin::Action::Turn,
            Action::Kick => mannequin::Action::Kick,
            Action::Dance => mannequin::Action::Dance,
        },
        phase: character.phase,
        seed: u64::from(character.seed),
        start: character.start_s,
        ease: character.ease_s,
    };
    if let Some(body) = bodies.iter().find(|body| body.cell() == character.cell_m) {
        return body.moving(motion);
    }
    bodies.push(Mannequin::new(character.cell_m, motion)?);
    Ok(bodies[bodies.len() - 1].clone())
}

fn read_obj(file: &str, loaded: &Loaded) -> Result<ObjMesh, String> {
    let read = obj::read(loaded.source(file).unwrap_or_default());
    let read = read.map_err(|e| format!("{file}: {e}"))?;
    let twice = |&[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
    match read.triangles.iter().position(twice) {
        Some(t) => Err(format!("{file}: line {}: a face uses a vertex twice", read.line(t))),
        None => Ok(read),
    }
}

/// Reads an animation, all frames of which must have the vertices and faces of the first.
fn frames(sequence: &Sequence, loaded: &Loaded) -> Result<Frames, String> {
    let mut positions = Vec::with_capacity(sequence.files.len());
    let mut first: Option<ObjMesh> = None;
    for file in &sequence.files {
        let read = read_obj(file, loaded)?;
        if let Some(first) = &first {
            let name = &sequence.files[0];
            let (n, expected) = (read.positions.len(), first.positions.len());
            if n != expected {
                return Err(format!("{file}: has {n} vertices, and {name} has {expected}"));
            }
            let (n, expected) = (read.triangles.len(), first.triangles.len());
            if n != expected {
                return Err(format!("{file}: has {n} triangles, and {name} has {expected}"));
            }
            let mut pairs = read.triangles.iter().zip(&first.triangles);
            if let Some(t) = pairs.position(|(a, b)| a != b) {
                let line = read.line(t);
                return Err(format!("{file}: line {line}: a face is another than in {name}"));
            }
        }
        positions.push(read.to_surface().positions);
        first.get_or_insert(read);
    }
    let triangles = first.map(|first| first.to_surface().triangles).unwrap_or_default();
    let (frames_per_second, start) = (sequence.frames_per_second, sequence.start_s);
    Ok(Frames { triangles, positions, frames_per_second, start })
}

fn character(gltf: &Gltf, loaded: &Loaded) -> Result<character::Character, String> {
    let bytes = loaded.source(&gltf.file).unwrap_or_default();
    let file = Container::new(&gltf.file, bytes, |name| loaded.source(name))?;
    character::read(&file, gltf.animation.as_ref(), gltf.start_s)
}
