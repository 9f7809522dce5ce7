//! What a second thread gives.

use super::super::Context;
use super::super::program::Simulation;
use super::super::report::{Figure, Report};
use super::super::statistics::median;
use crate::command::{Failure, say};

/// Frames of each run: whole, and quick.
const FRAMES: [usize; 2] = [20, 6];

pub(super) fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let frames = FRAMES[usize::from(context.options.quick)];
    let scene = context.root.join("scenes/drape.json5");
    let out = context.runs().join("scaling_threads.mcap");
    let simulation = Simulation { scene, frames, sets: Vec::new(), out };
    say(format!("threads: {frames} frames of drape on one and on two, in turns"));
    let (mut speedups, mut more) = (Vec::new(), Vec::new());
    for _ in 0..context.options.runs() {
        let [one, two] = [1, 2].map(|n| context.program.simulate_on(&simulation, n));
        let (one, two) = (one?, two?);
        speedups.push(one.info.sum("/seconds/total") / two.info.sum("/seconds/total"));
        more.push(two.cpu_s / one.cpu_s);
    }
    let [speedup, cpu] = [&speedups, &more].map(|all| median(all).unwrap_or(f64::NAN));
    say(format!("  {speedup:.2} times as fast for {cpu:.2} times the CPU seconds"));
    let note = format!(
        "{frames} frames of `drape`, in turns: wall seconds on one thread over those on two. Where \
         other programs use the cores, a second thread gives less."
    );
    report.add("scaling.threads.speedup", Figure::median(&speedups, "1", &note));
    let note = "The same runs: CPU seconds on two threads over those on one.";
    report.add("scaling.threads.cpu_ratio", Figure::median(&more, "1", note));
    Ok(())
}
