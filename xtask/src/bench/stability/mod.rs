//! Stability on stiff and extreme cases: a table of scenes and stresses, each with a verdict and the
//! figures behind it.
//!
//! A cell is stable if it runs to its end, all its numbers are finite, energy does not come from
//! nowhere, a stiffer cloth does not stretch more, and no more passes through anything than did at the
//! start. It is refused if the program ends it with an error that says why. Everything else is unstable,
//! and a cell that takes too long hangs.

mod scenes;
mod stresses;
mod verdict;

use super::program::{Attempt, Simulation};
use super::report::{Figure, Report};
use super::table::{Cell, Table, Tone};
use super::{Benchmark, Context};
use crate::command::{Failure, say};
use scenes::Scene;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::time::Duration;
use stresses::Stress;
use verdict::{Findings, Verdict};

/// The names of its figures.
const FIGURES: &[&str] = &[
    "stability.cells",
    "stability.stable",
    "stability.refused",
    "stability.unstable",
    "stability.verdicts.*",
    "stability.refused_cells",
];

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "stability",
    summary: "stiff and extreme cases: what stays stable, what is refused, and why",
    figures: FIGURES,
    run,
};

/// CPU time that a cell may take.
const LIMIT: Duration = Duration::from_secs(300);

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let folder = context.runs().join("stability");
    let told = |error| Failure::Unable(format!("cannot write to {}: {error}", folder.display()));
    fs::create_dir_all(&folder).map_err(told)?;
    scenes::write_meshes(&folder).map_err(told)?;
    for scene in context.chosen(report, scenes::ALL, |scene| scene.name) {
        let part = format!("stability/{}", scene.name);
        context.part(report, &part, |report| one(context, report, scene, &folder))?;
    }
    count(report);
    Ok(())
}

/// Puts a scene under one stress after the other.
fn one(
    context: &Context,
    report: &mut Report,
    scene: &Scene,
    folder: &Path,
) -> Result<(), Failure> {
    let mut rows = Vec::new();
    let mut plain: Option<Findings> = None;
    for stress in stresses::ALL.iter().filter(|stress| stress.suits(scene.name)) {
        if context.options.quick && stress.is_slow_on(scene.name) {
            let cell = format!("{} {}", scene.name, stress.name);
            report.remark(&format!("stability: {cell} is left out of quick runs."));
            continue;
        }
        let simulation = simulation(context, scene, stress, folder)?;
        let verdict = match context.program.attempt(&simulation, LIMIT)? {
            Attempt::Done(measured) => {
                let findings = Findings::of(&measured, stress);
                let verdict = findings.verdict(plain.as_ref());
                plain.get_or_insert(findings);
                verdict
            }
            Attempt::Refused(message) => Verdict::Refused(message),
            Attempt::Crashed(message) => Verdict::Unstable(format!("crashes: {message}")),
            Attempt::TooLong => Verdict::Unstable(format!("does not end in {LIMIT:?}")),
        };
        say(format!("{:9} {:28} {verdict}", scene.name, stress.name));
        let verdict = Cell { text: verdict.to_string(), tone: verdict.tone() };
        rows.push(vec![Cell::plain(scene.name), Cell::plain(stress.name), verdict]);
    }
    let note = "A cell is stable if it runs to its end, all is finite, energy does not come from \
                nowhere, and no more passes through anything than at the start; it is refused if an \
                error says why.";
    report.table_of(&format!("{VERDICTS}{}", scene.name), table(rows, note));
    Ok(())
}

/// A scene under stress, written to the folder.
fn simulation(
    context: &Context,
    scene: &Scene,
    stress: &Stress,
    folder: &Path,
) -> Result<Simulation, Failure> {
    let mut text = (scene.text)();
    (stress.apply)(&mut text);
    text["name"] = Value::from(format!("{}, {}", scene.name, stress.name));
    // Energy lost and found in remeshing is small only beside that of some way fallen.
    let is_short = context.options.quick && !stress.remeshes();
    let frames = if is_short { 2.0 } else { 15.0 };
    // As long in simulated time, whatever the frame rate.
    let frame_rate = text["frames_per_second"].as_f64().unwrap_or(25.0);
    let frames = (frames * frame_rate / 25.0).ceil().max(2.0) as usize;
    text["frames"] = Value::from(frames);
    let name = format!("{}-{}", scene.name, stress.name.replace([' ', '/'], "-"));
    let path = folder.join(format!("{name}.json5"));
    let told = |error| Failure::Unable(format!("cannot write {}: {error}", path.display()));
    fs::write(&path, format!("{text:#}")).map_err(told)?;
    let out = path.with_extension("mcap");
    Ok(Simulation { scene: path, frames, sets: Vec::new(), out })
}

/// What the names of the tables begin with that have the cells of a scene each.
const VERDICTS: &str = "stability.verdicts.";

/// Adds how many cells have which verdict, and lists those that are refused.
fn count(report: &mut Report) {
    let tables = report.tables().filter(|(name, _)| name.starts_with(VERDICTS));
    let rows: Vec<Vec<Cell>> = tables.flat_map(|(_, table)| table.rows.clone()).collect();
    let of = |tone: Tone| rows.iter().filter(move |row| row.last().is_some_and(|c| c.tone == tone));
    let counts = [
        ("cells", rows.len()),
        ("stable", of(Tone::Good).count()),
        ("refused", of(Tone::Plain).count()),
        ("unstable", of(Tone::Bad).count()),
    ];
    let refused: Vec<Vec<Cell>> = of(Tone::Plain).cloned().collect();
    let note = "Cells of scene and stress; the tables have the figures of each.";
    for (name, n) in counts {
        report.add(&format!("stability.{name}"), Figure::exact(n as f64, "1", note));
    }
    let note = match refused.len() {
        0 => "No cell is refused.".to_owned(),
        n => format!("The {n} cells that end with an error, and what it says."),
    };
    report.table_of("stability.refused_cells", table(refused, &note));
}

fn table(rows: Vec<Vec<Cell>>, note: &str) -> Table {
    let columns = ["scene", "stress", "verdict"].map(str::to_owned).to_vec();
    Table { columns, rows, note: note.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::super::provenance::Provenance;
    use super::*;

    #[test]
    fn cells_are_counted_over_all_scenes_and_refused_ones_listed() {
        let mut report = Report::new(Provenance::default());
        let row = |scene: &str, verdict: &Verdict| {
            let verdict = Cell { text: verdict.to_string(), tone: verdict.tone() };
            vec![Cell::plain(scene), Cell::plain("none"), verdict]
        };
        let stable = row("hang", &Verdict::Stable("fine".into()));
        let refused = row("hang", &Verdict::Refused("error: too stiff".into()));
        let unstable = row("drape", &Verdict::Unstable("grows".into()));
        report.table_of("stability.verdicts.hang", table(vec![stable, refused.clone()], ""));
        report.table_of("stability.verdicts.drape", table(vec![unstable], ""));
        count(&mut report);
        let values = ["cells", "stable", "refused", "unstable"]
            .map(|name| report.value(&format!("stability.{name}")));
        assert_eq!(values, [3.0, 1.0, 1.0, 1.0].map(Some));
        let listed =
            report.tables().find(|(name, _)| *name == "stability.refused_cells").unwrap().1;
        assert_eq!(listed.rows, [refused]);
    }
}
