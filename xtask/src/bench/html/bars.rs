//! Bars of the shares of time that stages take.

use super::super::number::short;
use super::super::report::{Report, suite_of};
use super::markup::{Svg, colour};
use std::collections::BTreeMap;

const WIDTH: f64 = 560.0;
const LEFT: f64 = 110.0;
const ROW: f64 = 26.0;

/// Seconds of the stages of one variant.
#[derive(Clone, Debug, Default, PartialEq)]
struct Bar {
    /// Time of whole frames.
    total: f64,
    /// Stages and their times.
    stages: Vec<(String, f64)>,
}

/// A picture for each scene of a suite with figures `….stage_s.STAGE.VARIANT`: its name first.
pub(super) fn bars(report: &Report, suite: &str) -> Vec<(String, String)> {
    let mut scenes: BTreeMap<String, BTreeMap<String, Bar>> = BTreeMap::new();
    let of_suite = |name: &&str| {
        let entry = report.entries.iter().find(|e| e.name == **name);
        entry.is_some_and(|e| suite_of(&e.part) == suite)
    };
    for (name, figure) in report.figures().filter(|(name, _)| of_suite(name)) {
        let Some((scene, rest)) = name.split_once(".stage_s.") else { continue };
        let Some((stage, variant)) = rest.split_once('.') else { continue };
        let variants = scenes.entry(scene.to_owned()).or_default();
        let bar = variants.entry(variant.to_owned()).or_default();
        match stage {
            "total" => bar.total = figure.value,
            _ => bar.stages.push((stage.to_owned(), figure.value)),
        }
    }
    scenes
        .into_iter()
        .filter_map(|(scene, bars)| Some((scene.clone(), draw(&scene, &bars)?)))
        .collect()
}

fn draw(scene: &str, bars: &BTreeMap<String, Bar>) -> Option<String> {
    // Stages with a share that can be seen in some bar, each with a colour in all bars.
    let mut stages: Vec<&str> = Vec::new();
    for (stage, seconds, total) in
        bars.values().flat_map(|b| b.stages.iter().map(|(stage, s)| (stage, s, b.total)))
    {
        if *seconds > 0.002 * total && !stages.contains(&stage.as_str()) {
            stages.push(stage);
        }
    }
    if stages.is_empty() || bars.values().any(|bar| bar.total <= 0.0) {
        return None;
    }
    let per_line = 5;
    let legend = 18.0 * (stages.len() + 1).div_ceil(per_line) as f64;
    let height = ROW * bars.len() as f64 + legend + 14.0;
    let mut svg = Svg::new([WIDTH, height], &format!("{scene}: shares of stages"));
    for (row, (variant, bar)) in bars.iter().enumerate() {
        let y = ROW * row as f64 + 4.0;
        svg.text([LEFT - 8.0, y + 14.0], "text-anchor=\"end\"", variant);
        let mut from = 0.0;
        let mut piece = |style: &str, stage: &str, seconds: f64| {
            let share = (seconds / bar.total).clamp(0.0, 1.0 - from);
            let tip = format!("{variant}, {stage}: {:.1} %, {} s", 100.0 * share, short(seconds));
            let full = WIDTH - LEFT - 12.0;
            svg.rectangle([LEFT + full * from, y], [full * share, ROW - 7.0], style, &tip);
            from += share;
        };
        for (k, stage) in stages.iter().enumerate() {
            let seconds = bar.stages.iter().find(|(name, _)| name == stage).map_or(0.0, |s| s.1);
            piece(&format!("style=\"fill: {}\"", colour(k)), stage, seconds);
        }
        let named: f64 = bar.stages.iter().map(|(_, seconds)| seconds).sum();
        piece("style=\"fill: var(--line)\"", "the rest", (bar.total - named).max(0.0));
    }
    for (k, stage) in stages.iter().copied().chain(["the rest"]).enumerate() {
        let x = LEFT + 88.0 * (k % per_line) as f64;
        let y = ROW * bars.len() as f64 + 10.0 + 18.0 * (k / per_line) as f64;
        let fill = if k < stages.len() { colour(k) } else { "var(--line)".into() };
        svg.rectangle([x, y], [10.0, 10.0], &format!("style=\"fill: {fill}\""), stage);
        svg.text([x + 14.0, y + 9.5], "", stage);
    }
    Some(svg.finish())
}

#[cfg(test)]
mod tests {
    use super::super::super::figure::Figure;
    use super::super::super::provenance::Provenance;
    use super::*;

    #[test]
    fn bars_are_shares_of_the_total() {
        let mut report = Report::new(Provenance::default());
        let around = report.begin("flag");
        for (name, seconds) in [("total", 2.0), ("linear", 1.0), ("contact", 0.5), ("build", 0.001)]
        {
            let name = format!("flag.stage_s.{name}.fixed");
            report.add(&name, Figure::exact(seconds, "s", ""));
        }
        report.finish(around);
        let pictures = bars(&report, "flag");
        assert_eq!(pictures.len(), 1);
        let (scene, svg) = &pictures[0];
        assert_eq!(scene, "flag");
        assert!(svg.contains("linear: 50.0 %") && svg.contains("contact: 25.0 %"));
        assert!(svg.contains("the rest: 24.9") || svg.contains("the rest: 25.0"), "{svg}");
        assert!(!svg.contains("build"));
        assert!(bars(&report, "contact").is_empty());
    }
}
