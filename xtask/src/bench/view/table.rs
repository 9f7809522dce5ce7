//! Table 1 of Koh2014: faces, vertices and seconds of fixed, adaptive and view-dependent meshes.

use super::{Scene, plot};
use crate::bench::Context;
use crate::bench::program::{Measured, Simulation};
use crate::bench::report::{Figure, Report};
use crate::command::{Failure, say};

pub(super) fn run(context: &Context, report: &mut Report, scene: &Scene) -> Result<(), Failure> {
    let quick = usize::from(context.options.quick);
    let (frames, fixed_frames) = (scene.frames[quick], scene.fixed_frames[quick]);
    let mut simulate = |kind: &str, frames: usize, sets: Vec<String>| {
        say(format!("{}, {kind}: {frames} frames", scene.name));
        let out = context.runs().join(format!("view_{}_{kind}.mcap", scene.name));
        let run = Simulation { scene: scene.path(context), frames, sets, out };
        let measured = context.program.simulate(&run)?;
        let info = &measured.info;
        let (faces, seconds) = (info.mean("/faces"), info.mean("/seconds/total"));
        say(format!("  {seconds:.3} s a frame, {faces:.0} faces"));
        columns(report, scene.name, kind, &measured);
        Ok::<_, Failure>(measured)
    };
    let adaptive = simulate("adaptive", frames, vec!["view=null".into()])?;
    let view = simulate("view", frames, Vec::new())?;
    let fixed = if fixed_frames > 0 {
        let mut sets = vec!["view=null".to_owned()];
        for cloth in scene.cloths {
            sets.push(format!("{cloth}.remeshing=null"));
            sets.push(format!("{cloth}.mesh.garment.cell_m={}", scene.finest));
        }
        Some(simulate("fixed", fixed_frames, sets)?)
    } else {
        None
    };
    let name = |what: &str| format!("view.{}.{what}", scene.name);
    let [of_adaptive, of_view] = [&adaptive, &view].map(|run| run.info.each("/seconds/total"));
    let fast = view.cpu_s / frames as f64;
    let note = format!(
        "CPU seconds of the adaptive run over those of the view-dependent one, whole processes over \
         {frames} frames, one thread.{}",
        view.info.troubles()
    );
    report.add(&name("speedup"), Figure::median(&[adaptive.cpu_s / view.cpu_s], "1", &note));
    if let Some(fixed) = &fixed {
        let seconds = fixed.cpu_s / fixed_frames as f64;
        let note = format!(
            "CPU seconds a frame on a fixed mesh with edges of {} m, over frames 1 to {fixed_frames} \
             alone, over those of the view-dependent run.",
            scene.finest
        );
        report.add(&name("speedup_over_fixed"), Figure::median(&[seconds / fast], "1", &note));
    } else {
        report.remark(&format!("{} is left out of quick runs", name("speedup_over_fixed")));
    }
    for (kind, run) in [("adaptive", &adaptive), ("view", &view)] {
        let n = run.info.sum("/crossings");
        report.add(&name(&format!("crossings.{kind}")), Figure::exact(n, "1", "Over all frames."));
    }
    overhead(report, scene.name, &adaptive, &view);
    plot::times(context, scene.name, &of_adaptive, &of_view)
}

/// The columns of the table.
fn columns(report: &mut Report, scene: &str, kind: &str, run: &Measured) {
    let note = "Mean over the frames; the spread is from the smallest to the largest.";
    for (column, pointer, unit) in [
        ("faces", "/faces", "1"),
        ("vertices", "/vertices", "1"),
        ("s_per_frame", "/seconds/total", "s"),
    ] {
        let figure = Figure::mean(&run.info.each(pointer), unit, note);
        report.add(&format!("view.{scene}.{column}.{kind}"), figure);
    }
}

/// What the policy itself costs: view factors, and what a face's size costs more than without them.
fn overhead(report: &mut Report, scene: &str, adaptive: &Measured, view: &Measured) {
    let [a, v] = [&adaptive.info, &view.info];
    let per_face = a.sum("/seconds/sizing") / a.sum("/faces");
    let bound = (v.sum("/seconds/sizing") - per_face * v.sum("/faces")).max(0.0);
    let share = (v.sum("/seconds/view") + bound) / v.sum("/seconds/total");
    let note =
        "View factors and the bound in pixels, as a share of the frames of the view-dependent run.";
    report.add(&format!("view.{scene}.overhead_fraction"), Figure::median(&[share], "1", note));
    // The whole benchmark's figure is that of its scene with the largest share.
    let name = "view.overhead_fraction";
    let worst = report.value(name).map_or(share, |before| before.max(share));
    report.add(name, Figure::median(&[worst], "1", "The largest over the scenes."));
}
