//! What the picture loses: errors in pixels against the chaos floor, popping, edges at a distance.

use super::{Scene, ask, plot};
use crate::bench::Context;
use crate::bench::report::{Figure, Report};
use crate::command::{Failure, say};
use serde_json::Value;

/// Frames from a common state to the comparison.
const HORIZON: usize = 3;
/// Frames of the distance scene: whole, and quick.
const DISTANCE_FRAMES: [usize; 2] = [150, 4];

fn numbers(told: &Value, key: &str) -> Vec<f64> {
    told[key].as_array().into_iter().flatten().filter_map(Value::as_f64).collect()
}

/// Error, floor and popping of a scene.
pub(super) fn error(context: &Context, report: &mut Report, scene: &Scene) -> Result<(), Failure> {
    if context.options.quick {
        report.remark(&format!("Errors in pixels of {} are left out of quick runs.", scene.name));
        return Ok(());
    }
    say(format!("{}: error in pixels", scene.name));
    let [first, last, every] = scene.starts;
    let arguments = [
        "error".to_owned(),
        scene.path(context).display().to_string(),
        first.to_string(),
        last.to_string(),
        every.to_string(),
        HORIZON.to_string(),
    ];
    let told = ask(&context.program, &arguments)?;
    let whole = format!(
        "RMS distance in the picture of the same visible points of the cloth, of runs from the start of the \
         scene, over frames from {first} to {last}; the spread is from frame to frame."
    );
    let short = format!(
        "The same {HORIZON} frames after both runs had the same state, that of the adaptive run."
    );
    let onward = format!(
        "The same {HORIZON} frames after both runs had the same state, that of the view-dependent run."
    );
    let (error, floor) = (
        "Runs: view-dependent and adaptive.",
        "Runs: adaptive with smallest edges longer by a tenth, and adaptive.",
    );
    let name = |what: &str| format!("view.{}.{what}", scene.name);
    for (figure, key, note, runs) in [
        ("pixel_error", "errors_px", &whole, error),
        ("chaos_floor", "floors_px", &whole, floor),
        ("short.pixel_error", "short_errors_px", &short, error),
        ("short.chaos_floor", "short_floors_px", &short, floor),
        ("onward.pixel_error", "onward_errors_px", &onward, error),
        ("onward.chaos_floor", "onward_floors_px", &onward, floor),
    ] {
        let all = numbers(&told, key);
        report.add(&name(figure), Figure::rms(&all, "px", &format!("{note} {runs}")));
        let rms = report.value(&name(figure)).unwrap_or(f64::NAN);
        say(format!("  {figure}: {rms:.3} px"));
    }
    let note =
        "Largest distance in the picture that one remeshing moves a visible point of the cloth.";
    let value = |key: &str| told[key].as_f64().unwrap_or(f64::NAN);
    report.add(&name("pop"), Figure::exact(value("pop_px"), "px", note));
    report.add(
        &name("pop_floor"),
        Figure::exact(value("pop_floor_px"), "px", "The same in the adaptive run."),
    );
    plot::pops(context, scene.name, &told["pops"])
}

/// How constant the length of edges in the picture is while the distance grows.
pub(super) fn distance(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let frames = DISTANCE_FRAMES[usize::from(context.options.quick)];
    say(format!("distance: {frames} frames"));
    let scene = context.root.join("scenes/distance.json5").display().to_string();
    let told = ask(&context.program, &["edges".to_owned(), scene, frames.to_string()])?;
    let (all, distances) = (numbers(&told, "edge_px"), numbers(&told, "distance_m"));
    // The first remeshings are on their way from the mesh of the scene.
    let (px, distances) = (&all[2.min(all.len() - 1)..], &distances[2.min(all.len() - 1)..]);
    let mean = px.iter().sum::<f64>() / px.len() as f64;
    let spread = px.iter().map(|px| (px / mean - 1.0).abs()).fold(0.0, f64::max);
    let growth = distances[distances.len() - 1] / distances[0];
    say(format!("  {mean:.2} px ± {:.1} %", 100.0 * spread));
    let note = format!(
        "Largest deviation of a frame's mean length of visible edges from the mean over all frames, \
         while the distance grows {growth:.1} times."
    );
    report.add("view.distance.edge_px_spread", Figure::exact(spread, "1", &note));
    report.add(
        "view.distance.edge_px",
        Figure::mean(px, "px", "Mean over the frames, spread over them."),
    );
    Ok(())
}
