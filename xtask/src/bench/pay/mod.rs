//! Nothing paid for nothing: what each optional part costs a scene that does not have it, has it
//! switched off, or has it on with nothing to do.
//!
//! Two things are compared with a scene without the part. The work that the runs count, which has the
//! same bits in every run: switched off, it must be the same to the last iteration. And CPU seconds,
//! which tell what is not counted: in many short runs that take turns, as the median of their ratios
//! with its confidence interval, because single times of a machine that does other things tell nothing.

mod part;

use super::program::Simulation;
use super::report::{Figure, Report};
use super::run_info::RunInfo;
use super::statistics::{median, median_interval};
use super::{Benchmark, Context};
use crate::command::{Failure, say};
use part::{PARTS, Part};

/// The names of its figures.
const FIGURES: &[&str] = &[
    "pay.*.off",
    "pay.*.idle",
    "pay.*.off_work",
    "pay.*.idle_work",
    "pay.max_difference",
    "pay.max_work_difference",
];

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "pay",
    summary: "optional parts of a scene: absent, switched off, and on but idle",
    figures: FIGURES,
    run,
};

/// Turns in which every variant runs once: a whole run, and a quick one.
const TURNS: [usize; 2] = [31, 8];
/// Frames of each run: whole, and quick.
const FRAMES: [usize; 2] = [6, 2];
/// Confidence of the intervals: among all parts one interval in fifteen misses by chance.
const LEVEL: f64 = 0.99;
/// What runs count, beside their times.
const COUNTS: [&str; 12] = [
    "/vertices",
    "/faces",
    "/substeps",
    "/retries",
    "/newton_iterations",
    "/linear_iterations",
    "/factorisations",
    "/analyses",
    "/halvings",
    "/stages",
    "/contacts",
    "/kinetic_energy_j",
];

/// The variants of a scene, in the order in which they run.
const KINDS: [&str; 3] = ["absent", "off", "idle"];

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    for part in PARTS {
        let name = format!("pay/{}", part.name);
        context.part(report, &name, |report| one(context, report, part))?;
    }
    let worst = |what: &str| {
        let name = |part: &Part| format!("pay.{}.{what}", part.name);
        let values = PARTS.iter().filter_map(|part| report.value(&name(part)));
        values.map(f64::abs).reduce(f64::max)
    };
    let [times, work] = ["off", "off_work"].map(worst);
    let note = format!(
        "Largest of the differences of CPU time between parts switched off and absent; \
         `pay.PART.off` has the {} % interval of each, and what lies around zero is noise.",
        100.0 * LEVEL
    );
    report.add("pay.max_difference", times.and_then(|x| Figure::median(&[x], "1", &note)));
    let note = "Largest of the differences of counted work between parts switched off and absent.";
    report.add("pay.max_work_difference", work.and_then(|x| Figure::exact(x, "1", note)));
    Ok(())
}

fn one(context: &Context, report: &mut Report, part: &Part) -> Result<(), Failure> {
    let frames = FRAMES[usize::from(context.options.quick)];
    let mut simulations = Vec::new();
    for (kind, text) in KINDS.into_iter().zip(part.scenes()) {
        let scene = context.scene(&format!("pay_{}_{kind}", part.name), &format!("{text:#}"))?;
        let out = scene.with_extension("mcap");
        simulations.push(Simulation { scene, frames, sets: Vec::new(), out });
    }
    let (mut off, mut idle) = (Vec::new(), Vec::new());
    let mut infos: Vec<RunInfo> = Vec::new();
    // The first turn warms up. Every other turn goes backwards, so that what grows or fades while
    // they run falls on all alike.
    for turn in 0..=TURNS[usize::from(context.options.quick)] {
        let mut seconds = [0.0; 3];
        let order = if turn % 2 == 0 { [0, 1, 2] } else { [2, 1, 0] };
        for k in order {
            let run = context.program.simulate(&simulations[k])?;
            seconds[k] = run.cpu_s;
            if turn == 0 {
                infos.push(run.info);
            }
        }
        if turn > 0 {
            off.push(seconds[1] / seconds[0] - 1.0);
            idle.push(seconds[2] / seconds[0] - 1.0);
        }
    }
    let [absent, off_info, idle_info] = &infos[..] else { return Ok(()) };
    let [off_work, idle_work] = [off_info, idle_info].map(|info| difference(absent, info));
    tell(report, part, "off", &off, off_work);
    tell(report, part, "idle", &idle, idle_work);
    let says = [absent, off_info, idle_info].map(|info| part.is_left_out(info));
    if says != [true, true, false].map(Some) && says != [None; 3] {
        report.remark(&format!(
            "pay.{}: runs do not say rightly whether it was left out: {KINDS:?} say {says:?}.",
            part.name
        ));
    }
    Ok(())
}

/// Adds what a variant takes more than the scene without the part.
fn tell(report: &mut Report, part: &Part, kind: &str, by: &[f64], work: f64) {
    let (middle, interval) = (median(by).unwrap_or(f64::NAN), median_interval(by, LEVEL));
    let name = format!("pay.{}.{kind}", part.name);
    let [low, high] = interval.unwrap_or([f64::NAN; 2]);
    let verdict = if low <= 0.0 && 0.0 <= high { "equal within noise" } else { "not equal" };
    let percent = 100.0 * LEVEL;
    say(format!(
        "  {kind:5} {:+.2} % of the time ({:+.2} to {:+.2}, {verdict}), {work:.1e} of the work",
        100.0 * middle,
        100.0 * low,
        100.0 * high
    ));
    let note = format!(
        "By how much a run takes more CPU seconds than without the part: median of the ratios of {} \
         pairs of runs in turns; the spread is the {percent} % confidence interval of the median.",
        by.len()
    );
    report.add(&name, interval.map(|i| Figure::told(middle, i, by.len(), "1", &note)));
    let note = "Largest relative difference of anything that the runs count, with and without the \
                part: vertices, steps, stages, iterations, factorisations, contacts, energy.";
    report.add(&format!("{name}_work"), Figure::exact(work, "1", note));
    if kind == "off" && (verdict != "equal within noise" || work != 0.0) {
        report.remark(&format!(
            "{name}: switched off it is not as if absent: {:+.2} % of the time ({:+.2} to {:+.2}), \
             counted work differs by {work:.1e}.",
            100.0 * middle,
            100.0 * low,
            100.0 * high
        ));
    }
}

/// Largest relative difference of what two runs count, frame by frame.
fn difference(one: &RunInfo, other: &RunInfo) -> f64 {
    let differ = |(a, b): (f64, f64)| {
        if a == b { 0.0 } else { (a - b).abs() / a.abs().max(b.abs()) }
    };
    let of = |pointer: &&str| {
        let (one, other) = (one.each(pointer), other.each(pointer));
        // What only one of the runs counts is another kind of work.
        let all = if one.len() == other.len() { 0.0 } else { 1.0 };
        one.into_iter().zip(other).map(differ).fold(all, f64::max)
    };
    COUNTS.iter().map(of).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn info(stages: &str, faces: &str) -> RunInfo {
        let text = format!(
            r#"{{ "status": {{ "state": "complete" }}, "frames": [
                {{}}, {{ "faces": {faces}, "stages": 8 }}, {{ "faces": 4, {stages} }} ] }}"#
        );
        RunInfo::parse(&text).unwrap()
    }

    #[test]
    fn work_differs_by_its_largest_difference() {
        let one = info("\"stages\": 8", "4");
        assert_eq!(difference(&one, &one), 0.0);
        assert_eq!(difference(&one, &info("\"stages\": 10", "4")), 0.2);
        assert_eq!(difference(&info("\"stages\": 10", "2"), &one), 0.5);
        assert_eq!(difference(&one, &info("\"x\": 8", "4")), 1.0);
    }
}
