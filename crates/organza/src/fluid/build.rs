//! From the fluid of a scene to particles between walls.

use super::meeting::Meeting;
use super::{Water, settings};
use crate::build::Garment;
use crate::obstacle::Obstacle;
use crate::scene;
use crate::scene::format::{Basin, Block, Face};
use mesh_core::ClothState;
use nalgebra::Vector3;
use sph::{Bounds, Emitter, Fluid, FluidError, FluidSettings, Open, Sink, Walls, scenes};

/// How much denser than at rest a particle may be at the start (1). Where fluid stands in fluid or in
/// a wall it would burst apart in the first step.
const DENSEST: f64 = 1.25;

/// Builds a fluid between its boxes and obstacles, around cloth and bodies that move: where these are
/// at the start there is none.
///
/// # Errors
/// The key of the fluid that is wrong, and why.
pub(crate) fn water(
    of: &scene::Fluid,
    (cloth, garments): (&ClothState, &[Garment]),
    obstacles: &[Obstacle],
) -> Result<Water, (String, String)> {
    let at = |key: &str| {
        let key = key.to_owned();
        move |error: FluidError| (key, error.to_string())
    };
    let spacing = of.file.spacing_m;
    let mut walls = Walls::none();
    for (k, basin) in of.file.boxes.iter().enumerate() {
        let inside = settings::bounds(basin.min, basin.max);
        walls.add_box(&inside, open(basin), spacing).map_err(at(&format!("boxes[{k}]")))?;
    }
    let mut around = Vec::new();
    let mut moving = Vec::new();
    for (k, obstacle) in of.obstacles.iter().map(|&k| (k, &obstacles[k])) {
        let name = &obstacle.name;
        let [start, end] = obstacle.times();
        if start > 0.0 || end.is_finite() {
            let what = format!(
                "the fluid meets obstacle `{name}`, which comes or goes: not supported; name in \
                 `obstacles` those that it meets"
            );
            return Err(("obstacles".into(), what));
        }
        let corners = obstacle.positions(0.0);
        if obstacle.is_moving() {
            moving.push(k);
            around.extend(box_around(&corners));
            continue;
        }
        let added = walls.add_mesh(&corners, &obstacle.triangles, spacing);
        added.map_err(|error| ("obstacles".into(), format!("obstacle `{name}`: {error}")))?;
        around.extend(box_around(&corners));
    }
    if !of.cloths.is_empty() {
        around.extend(box_around(&cloth.x));
    }
    let bodies: Vec<&Obstacle> = moving.iter().map(|&k| &obstacles[k]).collect();
    let mut meeting = Meeting::new(&of.cloths, moving, garments.len(), spacing);
    let fluid_settings = settings::fluid(of, &around);
    let (mut x, mut v) = (Vec::new(), Vec::new());
    for block in &of.file.blocks {
        let free = particles(block, spacing, &fluid_settings).into_iter();
        x.extend(free.filter(|x| bodies.iter().all(|body| !is_inside(body, x))));
        v.resize(x.len(), Vector3::from(block.velocity));
    }
    let mut fluid = Fluid::new(fluid_settings, walls, &x, &v).map_err(at("blocks"))?;
    if let Some(meeting) = &mut meeting {
        let sheets = meeting.place(cloth, garments, obstacles, 0.0).map_err(at("spacing_m"))?;
        fluid.leave_room(sheets);
    }
    let densest = fluid.particles().max_by(|a, b| a.density.total_cmp(&b.density));
    let limit = DENSEST * of.file.density_kg_per_m3;
    if let Some(p) = densest.filter(|p| p.density > limit) {
        let (x, density) = (p.position, p.density);
        let what = format!(
            "the particle at ({:.4}, {:.4}, {:.4}) m has a density of {density:.0} kg/m³ at the \
             start: blocks reach into each other or into a wall",
            x.x, x.y, x.z
        );
        return Err(("blocks".into(), what));
    }
    for (k, emitter) in of.file.emitters.iter().enumerate() {
        let error = at(&format!("emitters[{k}]"));
        let [position, direction] = [emitter.position, emitter.direction].map(Vector3::from);
        let half_size = emitter.size_m.map(|size| 0.5 * size);
        let end = emitter.end_s.unwrap_or(f64::INFINITY);
        Emitter::new(position, direction, half_size, emitter.speed_m_per_s)
            .and_then(|nozzle| fluid.add_emitter(nozzle.open(emitter.start_s, end)))
            .map_err(error)?;
    }
    for sink in &of.file.sinks {
        fluid.add_sink(Sink(settings::bounds(sink.min, sink.max)));
    }
    let (name, is_restrained) = (of.name.clone(), of.file.restraint.is_some());
    let fluid = match of.policy.clone().zip(of.file.restraint.as_ref()) {
        None => fluid.released(),
        Some((policy, restraint)) => {
            let settings = settings::restraint(restraint, fluid.settings());
            fluid.restrained(policy, settings).map_err(at("restraint"))?
        }
    };
    Ok(Water { name, fluid, is_restrained, meeting })
}

/// Positions of the particles of a block (m).
fn particles(block: &Block, spacing: f64, settings: &FluidSettings) -> Vec<Vector3<f64>> {
    let n = settings::lattice(block, spacing);
    let mut x = scenes::block(n, Vector3::from(block.min), spacing, u64::from(block.seed));
    if block.pressed {
        let size = Vector3::from(n.map(|n| n as f64 * spacing));
        let min = Vector3::from(block.min);
        scenes::press(&mut x, settings, &Bounds::new(min, min + size));
    }
    x
}

/// Whether a body surrounds a point at the start: the solid angle of its triangles, seen from there, is
/// that of a sphere (VanOosterom1983 Eq. (8)).
fn is_inside(body: &Obstacle, x: &Vector3<f64>) -> bool {
    let corners = body.positions(0.0);
    let angle = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|k| corners[k as usize] - x);
        let [la, lb, lc] = [a.norm(), b.norm(), c.norm()];
        let volume = a.dot(&b.cross(&c));
        let around = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
        2.0 * volume.atan2(around)
    };
    let angle: f64 = body.triangles.iter().map(angle).sum();
    angle.abs() > 3.0 * std::f64::consts::PI
}

fn open(basin: &Basin) -> Open {
    let has = |face| basin.open.contains(&face);
    Open {
        low: [Face::LowX, Face::LowY, Face::LowZ].map(has),
        high: [Face::HighX, Face::HighY, Face::HighZ].map(has),
    }
}

fn box_around(points: &[Vector3<f64>]) -> Option<Bounds> {
    let first = points.first()?;
    let start = Bounds::new(*first, *first);
    Some(points.iter().fold(start, |b, x| Bounds::new(b.min.inf(x), b.max.sup(x))))
}
