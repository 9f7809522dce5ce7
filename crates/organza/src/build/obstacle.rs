//! The obstacles of a scene: surfaces read from files or generated, with their motions.

use super::BuildError;
use crate::obstacle::Obstacle;
use crate::scene::{Loaded, ObstacleSource, limits};
use mesh_core::World3;
use mesh_core::generate::{self, Diagonal, GenerateError, Surface};
use mesh_core::obj;

/// Builds all obstacles of a scene.
pub(super) fn obstacles(loaded: &Loaded) -> Result<Vec<Obstacle>, BuildError> {
    let mut obstacles: Vec<Obstacle> = Vec::new();
    let mut n_triangles = 0;
    for (index, body) in loaded.scene.obstacles.iter().enumerate() {
        let error = |message| BuildError::Obstacle { obstacle: index, message };
        let surface = surface(&body.mesh, loaded).map_err(error)?;
        n_triangles += surface.triangles.len();
        if n_triangles > limits::MAX_SCENE_TRIANGLES {
            let limit = limits::MAX_SCENE_TRIANGLES;
            return Err(error(format!("more than {limit} triangles in all obstacles")));
        }
        let motion = body.motion.as_ref();
        let name = body.name.as_str();
        let obstacle = Obstacle::new(name, surface, &body.transform, motion, body.friction);
        obstacles.push(obstacle.map_err(|e| error(e.to_string()))?);
    }
    Ok(obstacles)
}

/// Reads or makes the surface of an obstacle.
fn surface(source: &ObstacleSource, loaded: &Loaded) -> Result<Surface, String> {
    let generated = |surface: Result<Surface, GenerateError>| surface.map_err(|e| e.to_string());
    match source {
        ObstacleSource::Obj(file) => {
            let read = obj::read(loaded.source(file).unwrap_or_default());
            let read = read.map_err(|e| format!("{file}: {e}"))?;
            let twice = |&[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
            match read.triangles.iter().position(twice) {
                Some(t) => {
                    Err(format!("{file}: line {}: a face uses a vertex twice", read.line(t)))
                }
                None => Ok(read.to_surface()),
            }
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
    }
}
