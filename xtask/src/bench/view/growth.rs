//! How the speed-up grows with the number of characters.

use crate::bench::Context;
use crate::bench::program::Simulation;
use crate::bench::report::{Figure, Report};
use crate::command::{Failure, say};

/// Characters of a whole run, and of a quick one.
const COUNTS: [&[usize]; 2] = [&[10, 30, 100], &[4, 8]];
/// Frames of each run: whole, and quick.
const FRAMES: [usize; 2] = [8, 3];

pub(super) fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let quick = usize::from(context.options.quick);
    let frames = FRAMES[quick];
    let scene = context.root.join("scenes/crowd.json5");
    let mut points = Vec::new();
    for count in COUNTS[quick] {
        let mut seconds = |kind: &str, mut sets: Vec<String>| {
            say(format!("crowd of {count}, {kind}: {frames} frames"));
            sets.push(format!("crowd.count={count}"));
            let out = context.runs().join(format!("view_crowd_{count}_{kind}.mcap"));
            let run = Simulation { scene: scene.clone(), frames, sets, out };
            let mean = context.program.simulate(&run)?.cpu_s / frames as f64;
            say(format!("  {mean:.3} CPU seconds a frame"));
            let note = "Whole process, one thread.";
            let name = format!("view.crowd.{count}.cpu_s_per_frame.{kind}");
            report.add(&name, Figure::median(&[mean], "s", note));
            Ok::<f64, Failure>(mean)
        };
        let speedup = seconds("adaptive", vec!["view=null".into()])? / seconds("view", Vec::new())?;
        let note = format!(
            "CPU seconds of the adaptive run over those of the view-dependent one, {frames} frames, \
             one thread."
        );
        report.add(&format!("view.crowd.{count}.speedup"), Figure::median(&[speedup], "1", &note));
        points.push((*count as f64, speedup));
        context.save(report)?;
    }
    super::plot::growth(context, &points)
}
