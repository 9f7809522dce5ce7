//! Contact: whether anything passes through anything, what it costs, and how that grows.

use super::program::Simulation;
use super::report::{Figure, Report};
use super::{Benchmark, Context, arcsim, statistics};
use crate::command::{Failure, say};
use std::fs;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "contact",
    summary: "crossings and cost of the scenes with contact, growth with the mesh, ARCSim's sphere",
    run,
};

/// The scenes of the project with contact.
const SCENES: [&str; 6] = ["sphere", "drape", "twist", "pile", "funnel", "pinch"];
/// Cells along each side of the sheet that falls on a sphere: 10³ to 10⁶ triangles.
const CELLS: [usize; 4] = [22, 71, 224, 707];

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    for name in SCENES {
        scene(context, report, name)?;
        context.save(report)?;
    }
    growth(context, report)?;
    context.save(report)?;
    arcsim::run(context, report, &arcsim::SPHERE)
}

/// Runs a scene to its end, or as far as a quick run goes.
fn scene(context: &Context, report: &mut Report, name: &str) -> Result<(), Failure> {
    let path = context.root.join(format!("scenes/{name}.json5"));
    let frames = if context.options.quick {
        context.options.frames()
    } else {
        context.program.n_frames(&path)?
    };
    say(format!("{name}: {frames} frames"));
    let out = context.runs().join(format!("contact_{name}.mcap"));
    let run =
        context.program.simulate(&Simulation { scene: path, frames, sets: Vec::new(), out })?;
    let info = &run.info;
    let note = format!("Over {frames} frames, one thread, whole process.{}", info.troubles());
    let figure = |what: &str| format!("contact.{name}.{what}");
    let crossings = info.sum("/crossings");
    say(format!("  {:.2} CPU seconds, {crossings} crossings", run.cpu_s));
    report.add(&figure("intersections"), Figure::exact(crossings, "1", &note));
    report.add(&figure("cpu_s_per_frame"), Figure::exact(run.cpu_s / frames as f64, "s", &note));
    let share = info.sum("/seconds/contact") / info.sum("/seconds/total");
    let what = "Share of the frames' time that finding contacts and keeping ways free takes.";
    report.add(&figure("share"), Figure::exact(share, "1", what));
    Ok(())
}

/// How the cost of contact grows with the number of triangles.
fn growth(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let n = if context.options.quick { CELLS.len() - 1 } else { CELLS.len() };
    let mut points = Vec::new();
    for cells in &CELLS[..n] {
        let text = format!(
            "{{ frames: 2, substeps: 2, newton: {{ max_iterations: 1, tolerance: 0.1 }},
               linear_solver: 'pcg', linear_tolerance: 1e-2, contact: {{ thickness_m: 0.001 }},
               cloths: [{{ mesh: {{ grid: {{ size_m: [1, 1], cells: [{cells}, {cells}] }} }},
                 fabric: 'woven-light', transform: {{ translate: [-0.5, -0.5, 0.2005] }} }}],
               obstacles: [{{ mesh: {{ sphere: {{ radius_m: 0.2 }} }} }}] }}"
        );
        let scene = context.runs().join(format!("contact_growth_{cells}.json5"));
        let told = |error| Failure::Unable(format!("cannot write {}: {error}", scene.display()));
        fs::create_dir_all(context.runs()).and_then(|()| fs::write(&scene, text)).map_err(told)?;
        let out = scene.with_extension("mcap");
        let triangles = (2 * cells * cells) as f64;
        say(format!("a sheet of {triangles} triangles on a sphere"));
        let simulation = Simulation { scene: scene.clone(), frames: 2, sets: Vec::new(), out };
        let info = context.program.simulate(&simulation)?.info;
        let seconds = info.sum("/seconds/contact") / info.sum("/substeps");
        say(format!("  {seconds:.4} s of contact a step"));
        report.add(
            &format!("contact.scaling.{triangles}.s_per_step"),
            Figure::exact(seconds, "s", "Wall time of contact in a step, one thread."),
        );
        points.push((triangles.ln(), seconds.ln()));
    }
    let note = "Slope of the logarithm of the time against that of the number of triangles, least squares.";
    report.add(
        "contact.scaling.exponent",
        statistics::slope(&points).and_then(|s| Figure::exact(s, "1", note)),
    );
    Ok(())
}
