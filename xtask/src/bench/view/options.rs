//! What the options beyond Koh2014 save or cost.

use crate::bench::Context;
use crate::bench::program::Simulation;
use crate::bench::report::{Figure, Report};
use crate::command::{Failure, say};

/// Frames of each run: whole, and quick.
const FRAMES: [usize; 2] = [25, 2];

/// An option, on a scene, as keys that differ from it.
const OPTIONS: [(&str, &str, &str); 4] = [
    // What is behind dancers is hidden.
    ("occlusion", "dancers", "view.occlusion=true"),
    // A second camera, at the side.
    (
        "cameras",
        "dancer",
        "view.cameras=[{camera: {position: [3.2, 0.3, 1.2], target: [0, 0, 1], vertical_fov_deg: 35}}]",
    ),
    ("predicted", "dancer", "view.predicted=true"),
    ("tension_field", "dancer", "cloths[0].tension_field=true"),
];

/// Adds `view.option.<option>.cpu_ratio` and `.faces_ratio`: with the option over without.
pub(super) fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let frames = FRAMES[usize::from(context.options.quick)];
    for (option, scene, set) in OPTIONS {
        say(format!("{scene} with {option}: {frames} frames"));
        let run = |kind: &str, sets: Vec<String>| {
            let out = context.runs().join(format!("view_option_{option}_{kind}.mcap"));
            let scene = context.root.join(format!("scenes/{scene}.json5"));
            context.program.simulate(&Simulation { scene, frames, sets, out })
        };
        let (plain, with) = (run("without", Vec::new())?, run("with", vec![set.to_owned()])?);
        let faces = with.info.mean("/faces") / plain.info.mean("/faces");
        let cpu = with.cpu_s / plain.cpu_s;
        say(format!("  {cpu:.3} of the time, {faces:.3} of the faces"));
        let note = format!(
            "`{scene}` with `{set}` over the scene as it is, {frames} frames, one thread.{}",
            with.info.troubles()
        );
        let name = |what: &str| format!("view.option.{option}.{what}");
        report.add(&name("cpu_ratio"), Figure::median(&[cpu], "1", &note));
        report.add(&name("faces_ratio"), Figure::exact(faces, "1", &note));
        context.save(report)?;
    }
    Ok(())
}
