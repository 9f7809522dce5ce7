//! Checks and resolves fluids.

use super::super::check::At;
use super::super::data::{Cloth, Fluid, Obstacle};
use super::super::format::{
    Basin, Block, EmitterFile, FluidFile, FluidRestraint, Region, RestraintLaw, RestraintPolicy,
};
use super::super::issue::IssueKind;
use super::super::limits::{
    MAX_FACTOR, MAX_FLUID_DENSITY_KG_PER_M3, MAX_PARTICLES, MAX_SPEED_M_PER_S, MAX_STEPS,
    MAX_TIME_S,
};
use super::super::typed::suggestion;
use super::handle::check_times;
use super::restraint::Run;
use super::{beyond, names};
use crate::fluid::{Policy, policy, settings};
use nalgebra::Vector3;

/// Numbers of particles in a recording.
const MAX_NAMES: f64 = u32::MAX as f64;

/// Checks the fluids of a scene that is `run` under `gravity` (m/s²). For now there is at most one.
pub(super) fn resolve(
    fluids: Vec<FluidFile>,
    (cloths, obstacles): (Option<&[Cloth]>, Option<&[Obstacle]>),
    gravity: [f64; 3],
    run: Run,
    at: &At<'_>,
) -> Option<Option<Fluid>> {
    if fluids.len() > 1 {
        at.index(1).report(IssueKind::Unsupported, "several fluids, which do not meet each other");
    }
    let names = names(&fluids, |fluid| fluid.name.clone(), "fluid", at);
    let Some((file, name)) = fluids.into_iter().zip(names).next() else { return Some(None) };
    let at = at.index(0);
    check_numbers(&file, &at);
    check_places(&file, run.duration, &at);
    let restraint = file.restraint.as_ref();
    let policy = restraint.map(|wish| check_restraint(wish, run, &at.key("restraint")));
    let obstacles =
        obstacles.map(|all| all.iter().map(|obstacle| obstacle.name.as_str()).collect());
    let obstacles = find(file.obstacles.as_deref(), obstacles, "obstacle", &at.key("obstacles"));
    let cloths = cloths.map(|all| all.iter().map(|cloth| cloth.name.as_str()).collect());
    let cloths = find(file.cloths.as_deref(), cloths, "cloth", &at.key("cloths"));
    let (obstacles, cloths) = (obstacles?, cloths?);
    let policy = match policy {
        Some(policy) => Some(policy?),
        None => None,
    };
    let fluid = Fluid { name, obstacles, cloths, gravity, policy, file };
    check_sound(&fluid, run.duration, &at);
    Some(Some(fluid))
}

/// Which of the names of `all` things of a kind are `wanted`: all of them if nothing is said.
fn find(
    wanted: Option<&[String]>,
    all: Option<Vec<&str>>,
    kind: &str,
    at: &At<'_>,
) -> Option<Vec<usize>> {
    let all = all?;
    let Some(wanted) = wanted else { return Some((0..all.len()).collect()) };
    let find_one = |(i, name): (usize, &String)| {
        let found = all.iter().position(|known| known == name);
        if found.is_none() {
            let hint = suggestion(name, &all);
            at.index(i).complain(format!("there is no {kind} `{name}`{hint}"));
        }
        found
    };
    wanted.iter().enumerate().map(find_one).collect()
}

fn check_numbers(file: &FluidFile, at: &At<'_>) {
    at.key("spacing_m").size(file.spacing_m);
    let density = at.key("density_kg_per_m3");
    density.positive(file.density_kg_per_m3, MAX_FLUID_DENSITY_KG_PER_M3, "kg/m³");
    if let Some(speed) = file.sound_speed_m_per_s {
        at.key("sound_speed_m_per_s").positive(speed, 100.0 * MAX_SPEED_M_PER_S, "m/s");
    }
    at.key("viscosity").not_negative(file.viscosity, MAX_FACTOR, "");
    at.key("wall_viscosity").not_negative(file.wall_viscosity, MAX_FACTOR, "");
    at.key("courant").positive(file.courant, 1.0, "");
    at.key("skin").not_negative(file.skin, 10.0, "");
}

fn check_places(file: &FluidFile, duration: f64, at: &At<'_>) {
    if let Some(domain) = &file.domain {
        check_region(domain, &at.key("domain"));
    }
    for (i, sink) in file.sinks.iter().enumerate() {
        check_region(sink, &at.key("sinks").index(i));
    }
    for (i, Basin { min, max, .. }) in file.boxes.iter().enumerate() {
        check_region(&Region { min: *min, max: *max }, &at.key("boxes").index(i));
    }
    if file.blocks.is_empty() && file.emitters.is_empty() {
        at.complain("has no fluid: give `blocks` or `emitters`");
    }
    let mut n = 0.0;
    for (i, block) in file.blocks.iter().enumerate() {
        let at = at.key("blocks").index(i);
        n += check_block(block, file.spacing_m, &at);
    }
    if n > MAX_PARTICLES {
        at.key("blocks").complain(beyond(n, MAX_PARTICLES, "particles"));
    }
    for (i, emitter) in file.emitters.iter().enumerate() {
        let at = at.key("emitters").index(i);
        n += check_emitter(emitter, file.spacing_m, duration, &at);
    }
    if n > MAX_NAMES && !file.emitters.is_empty() {
        at.key("emitters").complain(beyond(n, MAX_NAMES, "particles over all the time"));
    }
}

fn check_region(region: &Region, at: &At<'_>) {
    at.key("min").coordinates(&region.min);
    at.key("max").coordinates(&region.max);
    for k in 0..3 {
        if region.min[k] >= region.max[k] {
            let (min, max) = (region.min[k], region.max[k]);
            at.key("max").index(k).complain(format!("{max} m is not above the smallest, {min} m"));
        }
    }
}

/// Returns the number of particles.
fn check_block(block: &Block, spacing: f64, at: &At<'_>) -> f64 {
    check_region(&Region { min: block.min, max: block.max }, at);
    at.key("velocity").vector(&block.velocity, MAX_SPEED_M_PER_S, "m/s");
    let n: f64 = settings::lattice(block, spacing).iter().map(|n| *n as f64).product();
    if n == 0.0 && spacing > 0.0 && (0..3).all(|k| block.min[k] < block.max[k]) {
        at.complain(format!("is thinner than one particle of {spacing} m"));
    }
    n
}

/// Returns the number of particles over the duration (s).
fn check_emitter(emitter: &EmitterFile, spacing: f64, duration: f64, at: &At<'_>) -> f64 {
    at.key("position").coordinates(&emitter.position);
    at.key("direction").vector(&emitter.direction, MAX_FACTOR, "");
    if Vector3::from(emitter.direction).norm() == 0.0 {
        at.key("direction").complain("has no length");
    }
    for (i, &size) in emitter.size_m.iter().enumerate() {
        at.key("size_m").index(i).size(size);
    }
    let speed = at.key("speed_m_per_s");
    speed.positive(emitter.speed_m_per_s, MAX_SPEED_M_PER_S, "m/s");
    check_times(emitter.start_s, emitter.end_s, at);
    let open = emitter.end_s.unwrap_or(f64::INFINITY).min(duration) - emitter.start_s;
    let across: f64 = emitter.size_m.iter().map(|size| (size / spacing).max(1.0)).product();
    across * (emitter.speed_m_per_s * open / spacing).max(0.0)
}

fn check_sound(fluid: &Fluid, duration: f64, at: &At<'_>) {
    let speed = settings::sound_speed(fluid);
    if speed <= 0.0 {
        let what = "is needed where nothing falls or moves at the start";
        at.key("sound_speed_m_per_s").complain(what);
        return;
    }
    // The least that it takes: the smoothing length is a little more than the spacing.
    let steps = duration * speed / (fluid.file.courant * 2.0 * fluid.file.spacing_m);
    if steps > MAX_STEPS {
        at.key("spacing_m").complain(beyond(steps, MAX_STEPS, "steps"));
    }
}

/// The policy of a fluid's restraint; none if its thresholds were complained of.
fn check_restraint(restraint: &FluidRestraint, run: Run, at: &At<'_>) -> Option<Policy> {
    use RestraintPolicy::{Automatic, AutomaticView, Kinetic, Speed, View};
    let FluidRestraint { policy: by, law, .. } = *restraint;
    // Keys, the policies that they belong to, and whether these need them.
    let given: [(&str, Option<f64>, &[RestraintPolicy], bool); 10] = [
        ("restrain_below_m_per_s", restraint.restrain_below_m_per_s, &[Speed], true),
        ("restore_above_m_per_s", restraint.restore_above_m_per_s, &[Speed], true),
        ("restrain_below_j", restraint.restrain_below_j, &[Kinetic], true),
        ("restore_above_j", restraint.restore_above_j, &[Kinetic], true),
        ("restrain_below_px_per_frame", restraint.restrain_below_px_per_frame, &[View], true),
        ("restore_above_px_per_frame", restraint.restore_above_px_per_frame, &[View], true),
        ("most_m_per_s", restraint.most_m_per_s, &[View, AutomaticView], false),
        ("error_m", restraint.error_m, &[Automatic], true),
        ("error_px", restraint.error_px, &[AutomaticView], true),
        ("duration_s", restraint.duration_s, &[Automatic, AutomaticView], false),
    ];
    let mut complete = true;
    for (key, value, of, is_needed) in given {
        match value {
            Some(value) if of.contains(&by) => at.key(key).not_negative(value, MAX_FACTOR, ""),
            Some(_) => at.key(key).complain("belongs to another `policy`"),
            None if is_needed && of.contains(&by) => {
                complete = false;
                at.complain(format!("key `{key}` is missing"));
            }
            None => {}
        }
    }
    let (name, is_by_view) = match by {
        Speed => ("speed", false),
        Kinetic => ("kinetic", false),
        Automatic => ("automatic", false),
        View => ("view", true),
        AutomaticView => ("automatic-view", true),
    };
    if matches!(by, Automatic | AutomaticView) && law != RestraintLaw::Ramp {
        at.key("law").complain(format!("the policy `{name}` has the law `ramp`"));
    }
    if is_by_view && !run.has_camera {
        at.key("policy").complain("the scene has no `camera` to look through");
    }
    check_habits(restraint, at);
    let frame_s = run.duration / f64::from(run.frames);
    let run = policy::Run { duration: run.duration, frame_s };
    let made = complete.then(|| policy::of(restraint, run))?;
    made.inspect_err(|error| at.complain(error.to_string())).ok()
}

/// Checks what a restraint has beside its thresholds.
fn check_habits(restraint: &FluidRestraint, at: &At<'_>) {
    if let Some(tau) = restraint.bleeding_s {
        at.key("bleeding_s").positive(tau, MAX_TIME_S, "s");
    }
    let slow = restraint.inactivity_m_per_s;
    at.key("inactivity_m_per_s").not_negative(slow, MAX_SPEED_M_PER_S, "m/s");
    if let Some(tolerance) = restraint.pressure_tolerance_pa {
        at.key("pressure_tolerance_pa").not_negative(tolerance, 1e12, "Pa");
    }
    at.key("sweep_above").not_negative(restraint.sweep_above, 1.0, "");
    at.key("force_interval").at_least(restraint.force_interval, 1);
}
