//! Contact: whether anything passes through anything, what it costs, and how that grows.

use super::figure::Figure;
use super::points::Points;
use super::program::Simulation;
use super::report::Report;
use super::statistics::{median, power_law};
use super::{Benchmark, Context, arcsim, told_by_tests};
use crate::command::{Failure, say};

/// The names of its figures.
const FIGURES: &[&str] = &[
    "contact.*.intersections",
    "contact.*.cpu_s_per_frame",
    "contact.*.peak_mb",
    "contact.*.share",
    "contact.scaling",
    "contact.scaling.exponent",
    "contact.scaling.*.s_per_step",
    "contact.distant_obstacle.overhead",
    "contact.ccd.false_negatives",
    "contact.tangles.resolved",
    "contact.sphere.arcsim_*_cpu_s",
    "contact.sphere.arcsim_*_cpu_ratio",
    "contact.sphere.arcsim_*_peak_mb",
    "contact.sphere.arcsim_*_faces.*",
    "contact.sphere.arcsim_*_stretch.*",
    "contact.sphere.arcsim_*_intersections",
];

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "contact",
    summary: "crossings and cost of the scenes with contact, growth with the mesh, ARCSim's sphere",
    figures: FIGURES,
    run,
};

/// The scenes of the project with contact.
const SCENES: [&str; 6] = ["sphere", "drape", "twist", "pile", "funnel", "pinch"];
/// Cells along each side of the sheet that falls on a sphere: 10³ to 10⁶ triangles.
const CELLS: [usize; 4] = [22, 71, 224, 707];

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    for name in SCENES {
        let part = format!("contact/{name}");
        context.part(report, &part, |report| scene(context, report, name))?;
    }
    context.part(report, "contact/growth", |report| growth(context, report))?;
    context.part(report, "contact/distant", |report| distant_obstacle(context, report))?;
    context.part(report, "contact/tests", |report| told_by_tests::contact(context, report))?;
    context.part(report, "contact/arcsim", |r| arcsim::run(context, r, &arcsim::SPHERE))
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
    report
        .add(&figure("cpu_s_per_frame"), Figure::median(&[run.cpu_s / frames as f64], "s", &note));
    let what = "Peak of resident memory of the process.";
    let peak = run.peak_mb.and_then(|mb| Figure::exact(mb, "MB", what));
    report.add(&figure("peak_mb"), peak);
    let share = info.sum("/seconds/contact") / info.sum("/seconds/total");
    let what = "Share of the frames' time that finding contacts and keeping ways free takes.";
    report.add(&figure("share"), Figure::median(&[share], "1", what));
    Ok(())
}

/// What an obstacle costs that nothing comes near.
fn distant_obstacle(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let near = "{ mesh: { sphere: { radius_m: 0.2 } } }";
    let far =
        "{ mesh: { sphere: { radius_m: 0.2, detail: 5 } }, transform: { translate: [50, 0, 0] } }";
    let frames = context.options.frames();
    let cells = if context.options.quick { 20 } else { 60 };
    let mut simulations = Vec::new();
    for (name, obstacles) in [("alone", near.to_string()), ("distant", format!("{near}, {far}"))] {
        let text = format!(
            "{{ frames: {frames}, substeps: 4, cloths: [{{ fabric: 'woven-light',
                 mesh: {{ grid: {{ size_m: [1, 1], cells: [{cells}, {cells}] }} }},
                 transform: {{ translate: [-0.5, -0.5, 0.21] }} }}], obstacles: [{obstacles}] }}"
        );
        let scene = context.scene(&format!("contact_{name}"), &text)?;
        let out = scene.with_extension("mcap");
        simulations.push(Simulation { scene, frames, sets: Vec::new(), out });
    }
    say("a distant obstacle of 20480 triangles, with and without in turns");
    let mut ratios = Vec::new();
    for _ in 0..2 * context.options.runs() {
        let [alone, distant] = [0, 1].map(|k| context.program.simulate(&simulations[k]));
        ratios.push(distant?.info.sum("/seconds/total") / alone?.info.sum("/seconds/total") - 1.0);
    }
    say(format!("  {:.4} of the time more", median(&ratios).unwrap_or(f64::NAN)));
    let note = "By how much frames take longer with it, median of runs in turns.";
    report.add("contact.distant_obstacle.overhead", Figure::median(&ratios, "1", note));
    Ok(())
}

/// How the cost of contact grows with the number of triangles.
fn growth(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let n = if context.options.quick { 2 } else { CELLS.len() };
    let mut points = Vec::new();
    for cells in &CELLS[..n] {
        let text = format!(
            "{{ frames: 2, substeps: 2, newton: {{ max_iterations: 1, tolerance: 0.1 }},
               linear_solver: 'pcg', linear_tolerance: 1e-2, contact: {{ thickness_m: 0.001 }},
               cloths: [{{ mesh: {{ grid: {{ size_m: [1, 1], cells: [{cells}, {cells}] }} }},
                 fabric: 'woven-light', transform: {{ translate: [-0.5, -0.5, 0.2005] }} }}],
               obstacles: [{{ mesh: {{ sphere: {{ radius_m: 0.2 }} }} }}] }}"
        );
        let scene = context.scene(&format!("contact_growth_{cells}"), &text)?;
        let out = scene.with_extension("mcap");
        let triangles = (2 * cells * cells) as f64;
        say(format!("a sheet of {triangles} triangles on a sphere"));
        let simulation = Simulation { scene, frames: 2, sets: Vec::new(), out };
        let info = context.program.simulate(&simulation)?.info;
        let seconds = info.sum("/seconds/contact") / info.sum("/substeps");
        say(format!("  {seconds:.4} s of contact a step"));
        report.add(
            &format!("contact.scaling.{triangles}.s_per_step"),
            Figure::median(&[seconds], "s", "Wall time of contact in a step, one thread."),
        );
        points.push((triangles, seconds));
    }
    let note = "Slope of the logarithm of the time against that of the number of triangles, least squares.";
    let pairs: Vec<[f64; 2]> = points.iter().map(|&(x, y)| [x, y]).collect();
    let exponent = power_law(&pairs).and_then(|(power, _)| Figure::median(&[power], "1", note));
    report.add("contact.scaling.exponent", exponent);
    let axes = ["triangles", "contact in a step"];
    let note = "A sheet on a sphere; wall time, one thread.";
    let growth = Points::growth("growth of contact with the mesh", axes, ["1", "s"], &points, note);
    report.points("contact.scaling", growth);
    Ok(())
}
