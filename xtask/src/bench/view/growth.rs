//! How the speed-up grows with the number of characters.

use crate::bench::Context;
use crate::bench::program::Simulation;
use crate::bench::report::{Figure, Report};
use crate::command::{Failure, say};

/// Characters of a whole run, and of a quick one.
const COUNTS: [&[usize]; 2] = [&[10, 30, 100], &[4, 8]];
/// Frames of each run: whole, and quick.
const FRAMES: [usize; 2] = [8, 3];
/// Frames whose meshes are still on their way from those of the scene.
const SETTLING: usize = 2;

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
            let each = context.program.simulate(&run)?.info.each("/seconds/total");
            let mean = each[SETTLING..].iter().sum::<f64>() / (frames - SETTLING) as f64;
            say(format!("  {mean:.3} s a frame"));
            let note = "Mean over the frames after the second, one thread.";
            let name = format!("view.crowd.{count}.s_per_frame.{kind}");
            report.add(&name, Figure::exact(mean, "s", note));
            Ok::<f64, Failure>(mean)
        };
        let speedup = seconds("adaptive", vec!["view=null".into()])? / seconds("view", Vec::new())?;
        let note = format!(
            "Seconds a frame of the adaptive run over those of the view-dependent one, frames {} to \
             {frames}, one thread.",
            SETTLING + 1
        );
        report.add(&format!("view.crowd.{count}.speedup"), Figure::exact(speedup, "1", &note));
        points.push((*count as f64, speedup));
        context.save(report)?;
    }
    super::plot::growth(context, &points)
}
