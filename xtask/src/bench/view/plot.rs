//! Plots of the benchmark, as SVG files beside the report.

use crate::bench::Context;
use crate::command::Failure;
use plotters::prelude::*;
use serde_json::Value;

/// Lines with their names.
type Lines<'a> = [(&'a str, Vec<(f64, f64)>)];

/// Koh2014 Figure 6: seconds of every frame, and all up to it.
pub(super) fn times(
    context: &Context,
    scene: &str,
    adaptive: &[f64],
    view: &[f64],
) -> Result<(), Failure> {
    let each = |seconds: &[f64]| (1..).map(f64::from).zip(seconds.iter().copied()).collect();
    let total = |seconds: &[f64]| {
        let sums = seconds.iter().scan(0.0, |sum, s| {
            *sum += s;
            Some(*sum)
        });
        (1..).map(f64::from).zip(sums).collect()
    };
    let name = |what: &str| format!("view_{scene}_{what}");
    let both = [("adaptive", each(adaptive)), ("view-dependent", each(view))];
    draw(context, &name("times"), ["frame", "seconds a frame"], &both)?;
    let both = [("adaptive", total(adaptive)), ("view-dependent", total(view))];
    draw(context, &name("times_total"), ["frame", "seconds so far"], &both)
}

/// How far every remeshing moves what is seen.
pub(super) fn pops(context: &Context, scene: &str, pops: &Value) -> Result<(), Failure> {
    let point = |pop: &Value| Some((pop["frame"].as_f64()?, pop["px"].as_f64()?));
    let points: Vec<_> = pops.as_array().into_iter().flatten().filter_map(point).collect();
    let lines = [("view-dependent", points)];
    draw(context, &format!("view_{scene}_pops"), ["frame", "pixels"], &lines)
}

/// Speed-up by number of characters.
pub(super) fn growth(context: &Context, points: &[(f64, f64)]) -> Result<(), Failure> {
    draw(context, "view_crowd", ["characters", "speed-up"], &[("crowd", points.to_vec())])
}

fn draw(context: &Context, name: &str, axes: [&str; 2], lines: &Lines<'_>) -> Result<(), Failure> {
    let path = context.out.join(format!("{name}.svg"));
    try_draw(&path, axes, lines)
        .map_err(|e| Failure::Unable(format!("cannot draw {}: {e}", path.display())))
}

fn try_draw(
    path: &std::path::Path,
    [x, y]: [&str; 2],
    lines: &Lines<'_>,
) -> Result<(), Box<dyn std::error::Error>> {
    let all = || lines.iter().flat_map(|(_, points)| points);
    let most = |of: fn(&(f64, f64)) -> f64| all().map(of).fold(1e-9, f64::max);
    let root = SVGBackend::new(path, (640, 400)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .margin(15)
        .x_label_area_size(35)
        .y_label_area_size(50)
        .build_cartesian_2d(0.0..1.02 * most(|p| p.0), 0.0..1.05 * most(|p| p.1))?;
    chart.configure_mesh().x_desc(x).y_desc(y).light_line_style(WHITE).draw()?;
    for (k, (name, points)) in lines.iter().enumerate() {
        let colour = [RGBColor(190, 90, 60), RGBColor(40, 100, 160)][k % 2];
        chart
            .draw_series(LineSeries::new(points.iter().copied(), &colour))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 15, y)], colour));
    }
    chart.configure_series_labels().background_style(WHITE).border_style(BLACK).draw()?;
    Ok(root.present()?)
}
