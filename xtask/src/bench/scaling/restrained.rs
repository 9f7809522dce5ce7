//! Growth with the vertices that move while others rest, and with those that rest while others move.

use super::super::Context;
use super::super::program::Simulation;
use super::super::report::Report;
use super::{Growth, Sample};
use crate::command::{Failure, say};
use std::fmt::Write;

/// Cells along each side of each of the sheets.
const CELLS: usize = 20;
/// Vertices of each.
const EACH: usize = (CELLS + 1) * (CELLS + 1);
/// Frames whose cost is measured.
const FRAMES: usize = 10;
/// Sheets of which some rest: a whole run, and a quick one.
const SHEETS: [usize; 2] = [32, 16];

pub(super) fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let all = SHEETS[usize::from(context.options.quick)];
    let counts: Vec<usize> =
        std::iter::successors(Some(1), |n| Some(2 * n).filter(|n| *n <= all)).collect();

    say(format!("restrained: of {all} sheets some move"));
    let samples = counts
        .iter()
        .map(|&n| sheets(context, report, [n, all - n], n))
        .collect::<Result<Vec<_>, _>>()?;
    let note = format!(
        "{} vertices in {all} sheets, of which some swing and the others rest by their thresholds, \
         frames 2 to {}, against the vertices that move.",
        all * EACH,
        1 + FRAMES
    );
    let plot = "growth with moving vertices while the others rest";
    Growth { name: "restrained", plot, axis: "moving vertices", note }.tell(report, &samples);

    say("resting: one sheet moves, the others rest");
    let samples = counts
        .iter()
        .map(|&n| sheets(context, report, [1, n], n))
        .collect::<Result<Vec<_>, _>>()?;
    let note = format!(
        "One sheet of {EACH} vertices swings and the others rest by their thresholds, frames 2 to \
         {}, against the vertices that rest.",
        1 + FRAMES
    );
    let plot = "growth with resting vertices while one sheet moves";
    Growth { name: "resting", plot, axis: "resting vertices", note }.tell(report, &samples);
    Ok(())
}

/// What frames cost with so many moving and resting sheets; `n` sheets are the size.
fn sheets(
    context: &Context,
    report: &mut Report,
    [moving, resting]: [usize; 2],
    n: usize,
) -> Result<Sample, Failure> {
    let text = scene(moving, resting);
    let scene = context.scene(&format!("scaling_restrained_{moving}_{resting}"), &text)?;
    let out = scene.with_extension("mcap");
    let simulation = Simulation { scene, frames: FRAMES, sets: Vec::new(), out };
    let sample = Sample::take(context, (n * EACH) as f64, &simulation)?;
    let rest = sample.run.info.min("/restraint/resting").unwrap_or(0.0);
    // The handles hold two vertices of each sheet, which nothing moves.
    if rest < (resting * (EACH - 2)) as f64 || rest > (resting * EACH + 2 * moving) as f64 {
        report.remark(&format!(
            "scaling.restrained: {rest} vertices rest with {resting} resting and {moving} moving \
             sheets of {EACH} vertices."
        ));
    }
    Ok(sample)
}

/// Sheets side by side that hang from two corners each. Those that rest do so by thresholds that they
/// never reach.
fn scene(moving: usize, resting: usize) -> String {
    let (mut cloths, mut handles) = (String::new(), String::new());
    for k in 0..moving + resting {
        let rests =
            "restraint: { thresholds: { speed: { rest_m_per_s: 1e3, full_m_per_s: 4e3 } } },";
        let restraint = if k < moving { "" } else { rests };
        let x = 1.2 * k as f64;
        // Writing to a String cannot fail.
        let _ = write!(
            cloths,
            "{{ name: 's{k}', fabric: 'woven-light', {restraint}
               mesh: {{ grid: {{ size_m: [1, 1], cells: [{CELLS}, {CELLS}] }} }},
               transform: {{ translate: [{x}, 0, 0] }} }},\n"
        );
        let _ = writeln!(
            handles,
            "{{ cloth: 's{k}', select: {{ corners: ['upper-left', 'upper-right'] }} }},"
        );
    }
    format!(
        "{{ frames: 1, substeps: 4, integrator: 'implicit-euler', restraint: {{ thresholds: 'none' }},
           cloths: [{cloths}], handles: [{handles}],
           camera: {{ position: [2.6, -2.2, 0.6], target: [0.5, 0.7, -0.35],
             resolution: [128, 72] }} }}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_has_all_its_sheets() {
        let text = scene(2, 3);
        for (what, n) in [("fabric:", 5), ("corners:", 5), ("rest_m_per_s: 1e3", 3)] {
            assert_eq!(text.matches(what).count(), n, "{what}");
        }
    }
}
