//! Growth with the characters of a crowd, all seen alike.

use super::super::Context;
use super::super::program::Simulation;
use super::super::report::Report;
use super::{Growth, LIMIT_S, Sample, too_large};
use crate::command::{Failure, say};

/// Characters: a whole run, and a quick one.
const COUNTS: [&[usize]; 2] = [&[1, 3, 10, 30, 100], &[1, 2, 4]];
/// Frames whose cost is measured: the same.
const FRAMES: [usize; 2] = [4, 2];

pub(super) fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let quick = usize::from(context.options.quick);
    let name = "characters";
    say("characters: the crowd without a view");
    let mut samples: Vec<Sample> = Vec::new();
    for &count in COUNTS[quick] {
        let size = count as f64;
        if samples.last().is_some_and(|last| last.forbids(size)) {
            too_large(
                report,
                name,
                size,
                &format!("it may take more than {LIMIT_S:.0} CPU seconds"),
            );
            break;
        }
        let simulation = Simulation {
            scene: context.root.join("scenes/crowd.json5"),
            frames: FRAMES[quick],
            sets: vec![
                "view=null".into(),
                format!("crowd.count={count}"),
                "camera.resolution=[128, 72]".into(),
            ],
            out: context.runs().join(format!("scaling_characters_{count}.mcap")),
        };
        samples.push(Sample::take(context, size, &simulation)?);
    }
    let note = format!(
        "The scene `crowd` without mesh sizes by view, so that all characters are as expensive, frames \
         2 to {}; `view.crowd.COUNT.speedup` tells what the view saves.",
        1 + FRAMES[quick]
    );
    let plot = "growth with the number of characters";
    Growth { name, plot, axis: "characters", note }.tell(report, &samples);
    Ok(())
}
