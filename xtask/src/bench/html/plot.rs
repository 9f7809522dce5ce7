//! Plots of points on two logarithmic axes.

use super::super::number::short;
use super::super::points::{Point, Points, Shape};
use super::super::statistics::{front, power_law};
use super::axis::{Axis, drawable};
use super::markup::{Svg, colour};

const WIDTH: f64 = 560.0;
const LEFT: f64 = 62.0;
const RIGHT: f64 = 545.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 330.0;
/// Height of a line of the legend.
const LINE: f64 = 18.0;

/// Draws series with the same axes. `None` if there is nothing that can be drawn.
pub(super) fn plot(series: &[(&str, &Points)]) -> Option<String> {
    let all = || series.iter().flat_map(|(_, points)| &points.points);
    let floors = || series.iter().filter_map(|(_, points)| points.floor).filter(|x| drawable(*x));
    let x = Axis::over(all().map(|p| p.x).chain(floors()), [LEFT, RIGHT])?;
    let ys = all().flat_map(|p| [p.y, p.spread[0], p.spread[1]]);
    let y = Axis::over(ys, [BOTTOM, TOP])?;
    let (_, first) = series.first()?;

    let floor = floors().fold(f64::NAN, f64::max);
    let lines = series.len() + usize::from(!floor.is_nan());
    let height = BOTTOM + 48.0 + LINE * lines as f64;
    let mut svg = Svg::new([WIDTH, height], &first.plot);
    frame(&mut svg, &x, &y, first);
    if first.shape == Shape::Front {
        let best: Vec<[f64; 2]> =
            front(&all().map(|p| [p.x, p.y]).collect::<Vec<_>>()).into_iter().collect();
        svg.line(&on(&x, &y, &best), "class=\"best\"");
    }
    for (k, (name, points)) in series.iter().enumerate() {
        let at = BOTTOM + 44.0 + LINE * k as f64;
        svg.sign([LEFT + 6.0, at - 4.0], k, name);
        let told = one(&mut svg, &x, &y, k, points);
        svg.text([LEFT + 18.0, at], "", &format!("{name}{told}"));
    }
    if !floor.is_nan() {
        let at = x.at(floor);
        svg.line(&[[at, TOP], [at, BOTTOM]], "class=\"floor\"");
        let place = BOTTOM + 44.0 + LINE * series.len() as f64;
        svg.line(&[[LEFT, place - 4.0], [LEFT + 13.0, place - 4.0]], "class=\"floor\"");
        let told = format!("floor {}: smaller errors tell nothing", short(floor));
        svg.text([LEFT + 18.0, place], "class=\"soft\"", &told);
    }
    Some(svg.finish())
}

fn frame(svg: &mut Svg, x: &Axis, y: &Axis, of: &Points) {
    for (value, text) in x.ticks() {
        let at = x.at(value);
        svg.line(&[[at, TOP], [at, BOTTOM]], "class=\"grid\"");
        svg.text([at, BOTTOM + 15.0], "text-anchor=\"middle\" class=\"soft\"", &text);
    }
    for (value, text) in y.ticks() {
        let at = y.at(value);
        svg.line(&[[LEFT, at], [RIGHT, at]], "class=\"grid\"");
        svg.text([LEFT - 6.0, at + 4.0], "text-anchor=\"end\" class=\"soft\"", &text);
    }
    let corners = [[LEFT, TOP], [LEFT, BOTTOM], [RIGHT, BOTTOM]];
    svg.line(&corners, "class=\"frame\"");
    let name = |k: usize| match of.units[k].as_str() {
        "1" => of.axes[k].clone(),
        unit => format!("{} ({unit})", of.axes[k]),
    };
    svg.text([RIGHT, BOTTOM + 30.0], "text-anchor=\"end\"", &name(0));
    let up = format!("text-anchor=\"end\" transform=\"rotate(-90 14 {TOP})\"");
    svg.text([14.0, TOP], &up, &name(1));
}

/// Draws one series; returns what the legend says of it.
fn one(svg: &mut Svg, x: &Axis, y: &Axis, k: usize, points: &Points) -> String {
    let shown: Vec<&Point> =
        points.points.iter().filter(|p| drawable(p.x) && drawable(p.y)).collect();
    let pairs: Vec<[f64; 2]> = shown.iter().map(|p| [p.x, p.y]).collect();
    let stroke = format!("style=\"stroke: {}; fill: none; stroke-width: 2\"", colour(k));
    let mut told = String::new();
    match points.shape {
        Shape::Front => svg.line(&on(x, y, &front(&pairs)), &stroke),
        Shape::Growth => {
            if let Some((slope, factor)) = power_law(&pairs) {
                let ends = pairs.iter().map(|p| p[0]);
                let [low, high] = ends.fold([f64::INFINITY, 0.0], |[a, b], x| [a.min(x), b.max(x)]);
                let [bottom, top] = y.ends();
                let fit = |x: f64| (factor * x.powf(slope)).clamp(bottom, top);
                svg.line(&on(x, y, &[[low, fit(low)], [high, fit(high)]]), &stroke);
                told = format!(": grows as the power {slope:.2}");
            }
        }
    }
    let left_out = points.points.len() - shown.len();
    if left_out > 0 {
        told += &format!(" ({left_out} not positive, not drawn)");
    }
    for p in shown {
        let at = [x.at(p.x), y.at(p.y)];
        let [low, high] = p.spread;
        if drawable(low) && drawable(high) && low < high {
            svg.line(&[[at[0], y.at(low)], [at[0], y.at(high)]], &stroke);
        }
        svg.sign(at, k, &format!("{} ({}, {})", p.label, short(p.x), short(p.y)));
    }
    told
}

fn on(x: &Axis, y: &Axis, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    points.iter().map(|p| [x.at(p[0]), y.at(p[1])]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_fronts_and_floors_are_told() {
        let growth: Vec<(f64, f64)> =
            [1.0, 10.0, 100.0].iter().map(|&x| (x, 3.0 * x * x)).collect();
        let growth = Points::growth("g", ["faces", "time"], ["1", "s"], &growth, "");
        let svg = plot(&[("a.b", &growth)]).unwrap();
        assert!(svg.contains("a.b: grows as the power 2.00") && svg.contains(">time (s)<"));
        assert!(svg.contains(">faces<"));

        let point = |x, y| Point { x, y, spread: [y, 1.2 * y], n: 2, label: "<l>".into() };
        let points = vec![point(0.1, 1.0), point(0.01, 9.0), point(0.1, 5.0), point(0.0, 1.0)];
        let errors = Points::errors("hang", "m", points, 0.005, "");
        let svg = plot(&[("fixed", &errors), ("adaptive", &errors)]).unwrap();
        assert!(svg.contains("floor 0.005000") && svg.contains("class=\"best\""));
        assert!(svg.contains("1 not positive") && svg.contains("&lt;l&gt;"));
    }

    #[test]
    fn nothing_to_draw_is_no_plot() {
        assert_eq!(plot(&[]), None);
        let none = Points::growth("g", ["a", "b"], ["1", "1"], &[(0.0, 1.0)], "");
        assert_eq!(plot(&[("a", &none)]), None);
    }
}
