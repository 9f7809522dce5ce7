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
use serde_json::Value;
use std::fs;
use std::time::Duration;
use verdict::{Findings, Verdict};

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "stability",
    summary: "stiff and extreme cases: what stays stable, what is refused, and why",
    run,
};

/// How long a cell may take.
const LIMIT: Duration = Duration::from_secs(300);

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let folder = context.runs().join("stability");
    let told = |error| Failure::Unable(format!("cannot write to {}: {error}", folder.display()));
    fs::create_dir_all(&folder).map_err(told)?;
    scenes::write_meshes(&folder).map_err(told)?;
    let frames = if context.options.quick { 4 } else { 15 };
    let (mut stable, mut refused, mut unstable) = (0, 0, 0);
    let mut rows = Vec::new();
    for scene in scenes::ALL {
        let mut plain: Option<Findings> = None;
        for stress in stresses::ALL.iter().filter(|stress| stress.suits(scene.name)) {
            let mut text = (scene.text)();
            (stress.apply)(&mut text);
            text["name"] = Value::from(format!("{}, {}", scene.name, stress.name));
            let frame_rate = text["frames_per_second"].as_f64().unwrap_or(25.0);
            // As long in simulated time, whatever the frame rate.
            let frames = (frames as f64 * frame_rate / 25.0).ceil().max(2.0) as usize;
            text["frames"] = Value::from(frames);
            let name = format!("{}-{}", scene.name, stress.name.replace([' ', '/'], "-"));
            let path = folder.join(format!("{name}.json5"));
            fs::write(&path, format!("{text:#}")).map_err(told)?;
            let out = path.with_extension("mcap");
            let simulation = Simulation { scene: path, frames, sets: Vec::new(), out };
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
            let count = match &verdict {
                Verdict::Stable(_) => &mut stable,
                Verdict::Refused(_) => &mut refused,
                Verdict::Unstable(_) => &mut unstable,
            };
            *count += 1;
            say(format!("{:9} {:28} {verdict}", scene.name, stress.name));
            let tone = match &verdict {
                Verdict::Stable(_) => Tone::Good,
                Verdict::Refused(_) => Tone::Plain,
                Verdict::Unstable(_) => Tone::Bad,
            };
            let verdict = Cell { text: verdict.to_string(), tone };
            rows.push(vec![Cell::plain(scene.name), Cell::plain(stress.name), verdict]);
        }
        let columns = ["scene", "stress", "verdict"].map(str::to_owned).to_vec();
        let note = "A cell is stable if it runs to its end, all is finite, energy does not come from nowhere, and no \
                    more passes through anything than at the start; it is refused if an error says why.".to_owned();
        report.table_of("stability.verdicts", Table { columns, rows: rows.clone(), note });
        context.save(report)?;
    }
    let note = "Cells of scene and stress; the table has the figures of each.";
    let all = stable + refused + unstable;
    for (name, n) in
        [("cells", all), ("stable", stable), ("refused", refused), ("unstable", unstable)]
    {
        report.add(&format!("stability.{name}"), Figure::exact(f64::from(n), "1", note));
    }
    Ok(())
}
