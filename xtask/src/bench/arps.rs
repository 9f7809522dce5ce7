//! Restraint: what it saves where cloth comes to rest, what it costs where nothing does, and what it
//! does to shape and energy.

use super::program::{Measured, Simulation};
use super::report::{Figure, Report};
use super::surface::Surface;
use super::{Benchmark, Context};
use crate::command::{Failure, say};
use std::process::{Command, Stdio};

/// The names of its figures.
const FIGURES: &[&str] = &[
    "arps.hanging.speedup.*",
    "arps.hanging.rest_error_m",
    "arps.solves_per_step",
    "arps.idle_overhead",
    "arps.poke.energy_gain",
    "arps.paper_scheme.blowups",
];

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "arps",
    summary: "restraint: speed-up and error of cloth that comes to rest, overhead, energy, the paper's scheme",
    figures: FIGURES,
    run,
};

/// Frames over which speeds are compared: a second.
const WINDOW: usize = 25;
/// How often the hanging cloth is run with restraint and without.
const ROUNDS: usize = 3;
/// Frames until the hanging cloth is pushed.
const PUSHED: usize = 500;
/// Points along each side of the sheet at which shapes are compared, less one.
const POINTS: usize = 30;

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    hanging(context, report)?;
    context.save(report)?;
    idle(context, report)?;
    poke(context, report)?;
    context.save(report)?;
    paper(context, report)?;
    if context.options.quick {
        report.remark("arps.resting_crowd is left out of quick runs.");
    } else {
        crowd(context, report)?;
        context.save(report)?;
    }
    combined(context, report)
}

fn simulate(
    context: &Context,
    name: &str,
    frames: usize,
    run: &str,
    sets: &[&str],
) -> Result<Measured, Failure> {
    let scene = context.root.join(format!("scenes/{name}.json5"));
    let out = context.runs().join(format!("arps_{name}_{run}.mcap"));
    say(format!("{name}, {run}: {frames} frames"));
    let sets = sets.iter().map(|set| (*set).to_owned()).collect();
    context.program.simulate(&Simulation { scene, frames, sets, out })
}

/// The hanging cloth with and without restraint.
fn hanging(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let frames = if context.options.quick { PUSHED / 2 } else { 750 };
    let restrained = simulate(context, "hanging-cloth", frames, "restrained", &[])?;
    let plain = simulate(context, "hanging-cloth", frames, "plain", &["restraint=null"])?;
    let mut seconds = [&restrained, &plain].map(|run| run.info.each("/seconds/total"));
    // Alternately, so that whatever else the machine does meets both.
    for round in 1..if context.options.quick { 1 } else { ROUNDS } {
        for (k, set) in [None, Some("restraint=null")].into_iter().enumerate() {
            let sets: Vec<&str> = set.into_iter().collect();
            let name = format!("hanging_{k}_{round}");
            let again = simulate(context, "hanging-cloth", frames, &name, &sets)?;
            let again = again.info.each("/seconds/total");
            seconds[k].iter_mut().zip(again).for_each(|(least, again)| *least = least.min(again));
        }
    }
    let ratios = speed_ups(&seconds);
    let note = format!(
        "Wall time of frames without restraint over that with it, second by second, over {frames} frames, of \
         each frame the fastest of {ROUNDS} alternating runs (of one in quick ones); the mean is that of \
         these ratios.{}",
        restrained.info.troubles()
    );
    let least = ratios.iter().copied().min_by(f64::total_cmp);
    let most = ratios.iter().copied().max_by(f64::total_cmp);
    let mean = (!ratios.is_empty()).then(|| ratios.iter().sum::<f64>() / ratios.len() as f64);
    for (what, value) in [("min", least), ("mean", mean), ("max", most)] {
        let figure = value.and_then(|value| Figure::median(&[value], "1", &note));
        report.add(&format!("arps.hanging.speedup.{what}"), figure);
    }
    let [fast, slow] = seconds.map(|each| each.iter().sum::<f64>());
    let whole = slow / fast;
    let note = "Wall time of the whole run without restraint over that with it.";
    report.add("arps.hanging.speedup.whole", Figure::median(&[whole], "1", note));
    let awake =
        restrained.info.sum("/restraint/stages") - restrained.info.sum("/restraint/stages_slept");
    let note = "Linear systems per stage of the hanging cloth that was not slept through.";
    let solves = restrained.info.sum("/restraint/solves") / awake;
    report.add("arps.solves_per_step", Figure::exact(solves, "1", note));
    let at = PUSHED.min(frames);
    let error = shape_error(context, at)?;
    let note = format!(
        "Largest distance between the cloth with and without restraint after {at} frames; it is 1 m wide."
    );
    report.add("arps.hanging.rest_error_m", Figure::exact(error, "m", &note));
    Ok(())
}

/// Speed-up of every window, from the seconds of frames with restraint and without.
fn speed_ups(seconds: &[Vec<f64>; 2]) -> Vec<f64> {
    let sum = |part: &[f64]| part.iter().sum::<f64>();
    let windows = seconds[0].chunks_exact(WINDOW).zip(seconds[1].chunks_exact(WINDOW));
    windows.map(|(restrained, plain)| sum(plain) / sum(restrained)).collect()
}

/// Largest distance (m) between the sheets of both runs in a frame.
fn shape_error(context: &Context, frame: usize) -> Result<f64, Failure> {
    let mut shapes = Vec::new();
    for run in ["restrained", "plain"] {
        let recording = context.runs().join(format!("arps_hanging-cloth_{run}.mcap"));
        let out = context.runs().join(format!("arps_hanging-cloth_{run}"));
        context.program.export_obj(&recording, frame, &out)?;
        let path = out.join(format!("frame_{frame:05}.obj"));
        shapes.push(Surface::read(&path).map_err(Failure::Unable)?);
    }
    let share = |k: usize| k as f64 / POINTS as f64;
    let points = (0..=POINTS).flat_map(|i| (0..=POINTS).map(move |j| [share(i), share(j)]));
    let distance = |point| {
        let (a, b) = (shapes[0].at(point)?, shapes[1].at(point)?);
        Some((0..3).map(|k| (a[k] - b[k]) * (a[k] - b[k])).sum::<f64>().sqrt())
    };
    Ok(points.filter_map(distance).fold(0.0, f64::max))
}

/// What restraint costs where nothing rests: the hanging cloth while it swings, with thresholds that it
/// is never below.
fn idle(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let frames = if context.options.quick { 10 } else { WINDOW };
    let slow = "restraint.thresholds={speed: {rest_m_per_s: 1e-7, full_m_per_s: 4e-7}}";
    // Alternately, so that whatever else the machine does meets both.
    let mut cpu = [Vec::new(), Vec::new()];
    for round in 0..3 {
        for (k, set) in [slow, "restraint=null"].into_iter().enumerate() {
            let name = format!("idle_{k}_{round}");
            cpu[k].push(
                simulate(context, "hanging-cloth", frames, &name, &[set])?
                    .info
                    .sum("/seconds/total"),
            );
        }
    }
    let least = cpu.map(|runs| runs.into_iter().fold(f64::INFINITY, f64::min));
    let note = format!(
        "Wall time of {frames} frames of the swinging cloth with restraint that restrains nobody over that \
         without, less 1; the fastest of 3 runs each."
    );
    report.add("arps.idle_overhead", Figure::median(&[least[0] / least[1] - 1.0], "1", &note));
    Ok(())
}

/// Energy that the poked cloth gains after it is let go.
fn poke(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let frames = if context.options.quick { 70 } else { 200 };
    let info = simulate(context, "poke", frames, "restrained", &[])?.info;
    let energies = info.each("/restraint/energy_j");
    // It is let go at 2.08 s, in frame 52.
    let free = energies.get(52..).unwrap_or_default();
    let gain = free.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    let most = free.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = free.iter().copied().fold(f64::INFINITY, f64::min);
    let note = format!(
        "Largest gain of restrained energy in a step after the poke, as a share of all that is dissipated.{}",
        info.troubles()
    );
    report.add("arps.poke.energy_gain", Figure::exact(gain / (most - least), "1", &note));
    Ok(())
}

/// Frames until a tenth of the crowd dances.
const STAND: usize = 75;
/// Frames from a common state to the comparison of two runs.
const HORIZON: usize = 3;

/// The crowd of which a tenth moves.
fn crowd(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let frames = STAND + 50;
    let count = "crowd.count=100";
    let restrained = simulate(context, "resting-crowd", frames, "restrained", &[count])?;
    let plain = simulate(context, "resting-crowd", frames, "plain", &[count, "restraint=null"])?;
    let [fast, slow] = [&restrained, &plain].map(|run| run.info.each("/seconds/total"));
    let ratio = |from: usize, to: usize| {
        slow[from..to].iter().sum::<f64>() / fast[from..to].iter().sum::<f64>()
    };
    let troubles = restrained.info.troubles();
    let note = format!(
        "Wall time without restraint over that with it, over frames {} to {frames}, in which a tenth of \
         the characters dances ({count}).{troubles}",
        STAND + 1
    );
    let figure = Figure::median(&[ratio(STAND, frames)], "1", &note);
    report.add("arps.resting_crowd.speedup", figure);
    let note = "The same over the whole run, of which all clothes fall into place in the first three fifths.";
    report.add("arps.resting_crowd.speedup_whole", Figure::median(&[ratio(0, frames)], "1", note));
    let scene = context.root.join("scenes/resting-crowd.json5").display().to_string();
    let variants = [
        count.to_owned(),
        format!("{count}&&restraint=null"),
        count.to_owned(),
        format!("{count}&&restraint=null&&newton.tolerance=0.01&&newton.max_iterations=12"),
    ];
    let errors = against(context, report, &scene, STAND + 5, &variants)?;
    let note = format!(
        "RMS distance in the picture of the clothes of all who dance, {HORIZON} frames after both runs had \
         the same state"
    );
    for (name, k, other) in [
        ("pixel_error", 0, "with restraint and without."),
        ("chaos_floor", 1, "without restraint, and with twice the iterations."),
    ] {
        let figure =
            errors.get(k).and_then(|px| Figure::exact(*px, "px", &format!("{note}: {other}")));
        report.add(&format!("arps.resting_crowd.{name}"), figure);
    }
    Ok(())
}

/// Restraint by what the camera sees, and its speeds.
const SEEN: &str = "restraint={thresholds: {view: {rest_px_per_frame: 0.2, full_px_per_frame: 1}}, \
                    bleeding_s: 0.2}";

/// Mesh sizes and restraint by view, each alone and both.
fn combined(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let quick = context.options.quick;
    let (frames, start) = if quick { (3, 2) } else { (75, 40) };
    let kinds: [(&str, &[&str]); 4] = [
        ("neither", &["view=null"]),
        ("sizing", &[]),
        ("restraint", &["view=null", SEEN]),
        ("both", &[SEEN]),
    ];
    let mut cpu = Vec::new();
    for (kind, sets) in kinds {
        cpu.push(simulate(context, "dancers", frames, kind, sets)?.cpu_s);
    }
    let scene = context.root.join("scenes/dancers.json5").display().to_string();
    let mut variants = vec!["view=null".to_owned(), "view=null".to_owned()];
    let text = |sets: &[&str]| if sets.is_empty() { "-".into() } else { sets.join("&&") };
    variants.extend(kinds.iter().map(|(_, sets)| text(sets)));
    let errors = against(context, report, &scene, start, &variants)?;
    for (k, (kind, _)) in kinds.iter().enumerate().skip(1) {
        let note = format!(
            "CPU seconds of the dancers without mesh sizes and restraint by view over those with {kind}, whole \
             processes over {frames} frames."
        );
        let name = if *kind == "both" { "combined" } else { *kind };
        let figure = Figure::median(&[cpu[0] / cpu[k]], "1", &note);
        report.add(&format!("arps.view.{name}_speedup"), figure);
        let note = format!(
            "RMS distance in the picture from the run with neither, {HORIZON} frames after both had the state \
             of frame {start}."
        );
        let figure = errors.get(k).and_then(|px| Figure::exact(*px, "px", &note));
        report.add(&format!("arps.view.{name}_pixel_error"), figure);
    }
    Ok(())
}

/// Distances in the picture (px) of runs from the truth; see `view_quality`. None in quick runs.
fn against(
    context: &Context,
    report: &mut Report,
    scene: &str,
    start: usize,
    variants: &[String],
) -> Result<Vec<f64>, Failure> {
    if context.options.quick {
        report.remark(&format!("Errors in pixels of {scene} are left out of quick runs."));
        return Ok(Vec::new());
    }
    say(format!("{scene}: error in pixels"));
    let mut arguments = vec!["against".to_owned(), scene.to_owned(), start.to_string()];
    arguments.push(HORIZON.to_string());
    arguments.extend_from_slice(variants);
    let told = context.program.example("view_quality", &arguments)?;
    let told: serde_json::Value = serde_json::from_str(&told)
        .map_err(|error| Failure::Unable(format!("view_quality: {error}")))?;
    Ok(told["errors_px"].as_array().into_iter().flatten().filter_map(|px| px.as_f64()).collect())
}

/// How often the paper's scheme blows up on nets on which the convex one never gains energy.
fn paper(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let steps = if context.options.quick { "300" } else { "3000" };
    say(format!("stress grid: {steps} steps"));
    let words = "run --release --quiet --package arps --example stress_grid --";
    let told = Command::new("cargo")
        .args(words.split(' '))
        .arg(steps)
        .current_dir(&context.root)
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| Failure::Unable(format!("cannot start cargo: {error}")))?;
    if !told.status.success() {
        return Err(Failure::Unable("the stress grid failed".into()));
    }
    let told = String::from_utf8_lossy(&told.stdout).into_owned();
    let blow_ups = blow_ups(&told);
    let note = format!(
        "Runs of {steps} steps of nets with stiffness ratios from 1 to 1e8 in which Algorithm 1 of \
         Manteaux2013 with its own law blew up; the convex scheme on the same nets: {}",
        told.lines().last().unwrap_or_default()
    );
    report.add("arps.paper_scheme.blowups", blow_ups.and_then(|n| Figure::exact(n, "1", &note)));
    Ok(())
}

/// The first number in brackets of the last line.
fn blow_ups(told: &str) -> Option<f64> {
    let (_, counts) = told.lines().last()?.split_once("blew up in [")?;
    counts.split([',', ']']).next()?.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::blow_ups;

    #[test]
    fn blow_ups_are_read_from_the_last_line() {
        let told = "net\n45 runs. Paper's scheme blew up in [31, 2, 0] runs (Spline).\n";
        assert_eq!(blow_ups(told), Some(31.0));
        assert_eq!(blow_ups("nothing"), None);
    }
}
