//! From what a scene file says to what it means: every range checked, every name and file found.

mod animated;
mod cloth;
mod crowd;
mod fluid;
mod handle;
mod mesh;
mod obstacle;
mod restraint;
mod view;

use super::check::{At, Complaints, beyond};
use super::data::{Cloth, MeshSource, Obstacle, ObstacleSource, Scene};
use super::files::Files;
use super::format::{BLEEDING_S, ClothFile, SceneFile, Wind};
use super::issue::{Issue, IssueKind};
use super::limits;
use super::typed::suggestion;

/// What resolving needs and collects.
pub(super) struct Context<'r, 'f> {
    pub(super) files: &'f mut Files<'r>,
    /// Complaints about the scene file.
    pub(super) complaints: &'f Complaints,
    /// Issues in other files.
    pub(super) foreign: Vec<Issue>,
    /// Whether cloths are being resolved that a crowd wears.
    pub(super) in_crowd: bool,
}

impl Context<'_, '_> {
    /// Reads a file named in the scene, once; a file that cannot be read is complained of at `at`.
    fn read(&mut self, at: &At<'_>, name: &str, max_bytes: u64) -> Option<&[u8]> {
        let read = self.files.read(name, max_bytes);
        read.map_err(|error| at.report(IssueKind::File, error.to_string())).ok()
    }
}

/// Checks and resolves a scene. Complaints go to `context`; where there are any, the result may be
/// absent or hold values that were complained of.
pub(super) fn resolve(
    file: SceneFile,
    default_name: &str,
    context: &mut Context<'_, '_>,
) -> Option<Scene> {
    let top = context.complaints.at_top();
    check_time(&file, &top);
    check_solver(&file, &top);
    top.key("gravity").vector(&file.gravity, limits::MAX_GRAVITY_M_PER_S2, "m/s²");
    if let Some(wind) = &file.wind {
        check_wind(wind, &top.key("wind"));
    }
    top.key("recording.checkpoint_every_frames")
        .at_least(file.recording.checkpoint_every_frames, 1);
    if file.cloths.is_empty() && file.crowd.is_none() && file.fluids.is_empty() {
        top.key("cloths").complain("a scene needs at least one cloth or fluid");
    }
    for (key, n, limit) in [
        ("cloths", file.cloths.len(), limits::MAX_CLOTHS),
        ("handles", file.handles.len(), limits::MAX_HANDLES),
        ("obstacles", file.obstacles.len(), limits::MAX_OBSTACLES),
    ] {
        if n > limit {
            top.key(key).complain(format!("has {n} elements, beyond the limit of {limit}"));
            return None;
        }
    }
    let given = |cloth: &ClothFile| cloth.name.clone();
    let names = names(&file.cloths, given, "cloth", &top.key("cloths"));
    let handles = handle::resolve(file.handles, &names, &top.key("handles"));
    let duration = f64::from(file.frames) / file.frames_per_second;
    let (frames, has_camera) = (file.frames, file.camera.is_some());
    let run = restraint::Run { duration, frames, has_camera };
    let mut cloths: Option<Vec<_>> = {
        let resolved: Vec<_> = file
            .cloths
            .into_iter()
            .zip(names)
            .enumerate()
            .map(|(i, (cloth, name))| {
                cloth::resolve(cloth, name, run, &top.key("cloths").index(i), context)
            })
            .collect();
        resolved.into_iter().collect()
    };
    let has_obstacles = !file.obstacles.is_empty() || file.crowd.is_some();
    let contact = obstacle::contact(file.contact, has_obstacles, &top.key("contact"));
    let mut obstacles = obstacle::resolve(file.obstacles, &top.key("obstacles"), context);
    if let (Some(cloths), Some(obstacles)) = (&cloths, &obstacles) {
        check_wearers(cloths, obstacles, &top.key("cloths"));
    }
    if let Some(crowd) = file.crowd {
        let members = crowd::resolve(crowd, run, &top.key("crowd"), context)?;
        let taken = |name: &String| {
            let obstacles = obstacles.iter().flatten().any(|obstacle| obstacle.name == *name);
            obstacles || cloths.iter().flatten().any(|cloth| cloth.name == *name)
        };
        if let Some((member, _)) = members.iter().find(|(member, _)| taken(&member.name)) {
            let name = &member.name;
            top.key("crowd").complain(format!("`{name}` is the name of something else already"));
            return None;
        }
        for (obstacle, cloth) in members {
            obstacles.as_mut()?.push(obstacle);
            cloths.as_mut()?.push(cloth);
        }
    }
    let fluids = top.key("fluids");
    let bounded = (cloths.as_deref(), obstacles.as_deref());
    let fluid = fluid::resolve(file.fluids, bounded, file.gravity, run, &fluids);
    let up = super::data::up(file.gravity);
    let facts = view::Facts { up, frames_per_second: file.frames_per_second, frames: file.frames };
    let camera_path = view::path(file.camera.as_ref(), &file.shots, &facts, &top, context);
    let view = file
        .view
        .and_then(|view| view::settings(view, file.camera.is_some(), &facts, &top, context));
    let restraint = file.restraint.and_then(|wish| {
        let at = top.key("restraint");
        restraint::check_bleeding(wish.bleeding_s, &at);
        restraint::thresholds(wish.thresholds, wish.law, run, &at)
    });
    Some(Scene {
        name: file.name.unwrap_or_else(|| default_name.to_owned()),
        frames: file.frames,
        frames_per_second: file.frames_per_second,
        substeps: file.substeps,
        gravity: file.gravity,
        wind: file.wind,
        integrator: file.integrator,
        newton: file.newton,
        linear_solver: file.linear_solver,
        linear_tolerance: file.linear_tolerance,
        cloths: cloths?,
        handles: handles?,
        obstacles: obstacles?,
        fluid: fluid?,
        contact,
        camera: file.camera,
        camera_path,
        view,
        restraint: restraint.unwrap_or_default(),
        bleeding_s: file.restraint.map_or(Some(BLEEDING_S), |wish| wish.bleeding_s),
        recording: file.recording,
    })
}

/// Complains of garments on what is no character.
fn check_wearers(cloths: &[Cloth], obstacles: &[Obstacle], at: &At<'_>) {
    for (i, cloth) in cloths.iter().enumerate() {
        let MeshSource::Garment(garment) = &cloth.mesh else { continue };
        let is_character = |o: &&Obstacle| matches!(o.mesh, ObstacleSource::Character(_));
        let names: Vec<&str> =
            obstacles.iter().filter(is_character).map(|o| o.name.as_str()).collect();
        // A name that is missing has been complained of.
        if !garment.on.is_empty() && !names.contains(&garment.on.as_str()) {
            let (on, hint) = (&garment.on, suggestion(&garment.on, &names));
            let at = at.index(i).key("mesh.garment.on");
            at.complain(format!("there is no character `{on}`{hint}"));
        }
    }
}

/// The names of all `things`, given or made up; names used twice are complained of.
fn names<T>(
    things: &[T],
    given: impl Fn(&T) -> Option<String>,
    kind: &str,
    at: &At<'_>,
) -> Vec<String> {
    let mut names: Vec<String> = Vec::with_capacity(things.len());
    for (i, thing) in things.iter().enumerate() {
        let name = given(thing).unwrap_or_else(|| format!("{kind}{i}"));
        let at = at.index(i).key("name");
        if name.is_empty() {
            at.complain("is empty");
        } else if let Some(first) = names.iter().position(|other| *other == name) {
            at.complain(format!("`{name}` is the name of {kind}s[{first}] already"));
        }
        names.push(name);
    }
    names
}

fn check_time(file: &SceneFile, top: &At<'_>) {
    top.key("frames").at_least(file.frames, 1);
    top.key("substeps").at_least(file.substeps, 1);
    let rate = file.frames_per_second;
    top.key("frames_per_second").positive(rate, limits::MAX_FRAME_RATE, "1/s");
    if rate > 0.0 && rate < 1.0 / limits::MAX_FRAME_RATE {
        let limit = 1.0 / limits::MAX_FRAME_RATE;
        top.key("frames_per_second")
            .complain(format!("{rate:e} 1/s is below the limit of {limit:e} 1/s"));
    }
    let (frames, substeps) = (f64::from(file.frames), f64::from(file.substeps));
    if frames * substeps > limits::MAX_STEPS {
        let steps = beyond(frames * substeps, limits::MAX_STEPS, "steps");
        top.key("frames").complain(format!("{frames} frames of {substeps} substeps: {steps}"));
    }
    let seconds = frames / rate;
    if rate >= 1.0 / limits::MAX_FRAME_RATE && seconds > limits::MAX_TIME_S {
        top.key("frames").complain(beyond(seconds, limits::MAX_TIME_S, "s"));
    }
}

fn check_solver(file: &SceneFile, top: &At<'_>) {
    const MOST_ITERATIONS: u32 = 10_000;
    let newton = top.key("newton");
    newton.key("max_iterations").at_least(file.newton.max_iterations, 1);
    if file.newton.max_iterations > MOST_ITERATIONS {
        let n = f64::from(file.newton.max_iterations);
        newton.key("max_iterations").complain(beyond(n, f64::from(MOST_ITERATIONS), ""));
    }
    newton.key("tolerance").positive(file.newton.tolerance, limits::MAX_SPEED_M_PER_S, "m/s");
    top.key("linear_tolerance").positive(file.linear_tolerance, 0.1, "");
}

fn check_wind(wind: &Wind, at: &At<'_>) {
    at.key("velocity").vector(&wind.velocity, limits::MAX_SPEED_M_PER_S, "m/s");
    at.key("density").not_negative(wind.density, limits::MAX_AIR_DENSITY_KG_PER_M3, "kg/m³");
    at.key("drag").not_negative(wind.drag, limits::MAX_FACTOR, "N·s/m³");
}
