//! `organza info`.

use std::fmt::{self, Write};

use organza::info::Info;
use organza::report::{FluidSummary, FrameReport};

use super::{Failure, args, output};

pub(crate) fn run(args: &args::Info) -> Result<(), Failure> {
    let info = Info::read(&args.recording)?;
    if args.json {
        let json = serde_json::to_string_pretty(&info).map_err(Failure::failed)?;
        return output::print(&format!("{json}\n"));
    }
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write(&mut text, &info);
    output::print(&text)
}

/// Columns of the table of frames: name, width, content.
type Column = (&'static str, usize, fn(&FrameReport) -> String);

const COLUMNS: [Column; 22] = [
    ("frame", 6, |r| r.frame.to_string()),
    ("time s", 9, |r| format!("{:.4}", r.time_s)),
    ("vertices", 9, |r| r.vertices.to_string()),
    ("faces", 8, |r| r.faces.to_string()),
    ("steps", 6, |r| r.substeps.to_string()),
    ("newton", 7, |r| r.newton_iterations.to_string()),
    ("krylov", 8, |r| r.linear_iterations.to_string()),
    ("factor", 7, |r| r.factorisations.to_string()),
    ("unconv", 7, |r| r.unconverged_stages.to_string()),
    ("redone", 7, |r| r.retries.to_string()),
    ("contacts", 9, |r| r.contacts.to_string()),
    ("short", 6, |r| r.shortened_ways.to_string()),
    ("cross", 6, |r| r.crossings.map_or("-".into(), |n| n.to_string())),
    ("resting", 8, |r| r.restraint.as_ref().map_or("-".into(), |s| s.resting.to_string())),
    ("total s", 9, |r| seconds(r.seconds.total)),
    ("build s", 10, |r| seconds(r.seconds.build)),
    ("assembly s", 11, |r| seconds(r.seconds.assembly)),
    ("linear s", 10, |r| seconds(r.seconds.linear)),
    ("energy s", 10, |r| seconds(r.seconds.energy)),
    ("contact s", 10, |r| seconds(r.seconds.contact)),
    ("sizing s", 10, |r| seconds(r.seconds.sizing)),
    ("remesh s", 10, |r| seconds(r.seconds.remesh)),
];

/// Further columns where there is a fluid.
const FLUID_COLUMNS: [Column; 7] = [
    ("particles", 10, |r| of_fluid(r, |f| f.particles.to_string())),
    ("active", 8, |r| of_fluid(r, |f| f.active.to_string())),
    ("transit", 8, |r| of_fluid(r, |f| f.transition.to_string())),
    ("rest", 8, |r| of_fluid(r, |f| f.restrained.to_string())),
    ("f.steps", 8, |r| of_fluid(r, |f| f.steps.to_string())),
    ("sweeps", 7, |r| of_fluid(r, |f| f.sweeps.to_string())),
    ("fluid s", 10, |r| seconds(r.seconds.fluid)),
];

fn of_fluid(report: &FrameReport, show: fn(&FluidSummary) -> String) -> String {
    report.fluid.as_ref().map_or("-".into(), show)
}

fn seconds(s: f64) -> String {
    format!("{s:.4}")
}

fn write(out: &mut String, info: &Info) -> fmt::Result {
    writeln!(out, "{}: scene {}, recorded by {}", info.recording, info.scene, info.software)?;
    let n = info.frames.len();
    let planned =
        info.frames_planned.map_or(String::new(), |n| format!(" of {}", n.saturating_add(1)));
    writeln!(out, "{}; {n}{planned} frames, frame 0 is the initial state", info.status.message)?;
    let checkpoints: Vec<String> = info.checkpoints.iter().map(u64::to_string).collect();
    writeln!(out, "checkpoints: {}", join(&checkpoints))?;
    if !info.obstacles.is_empty() {
        writeln!(out, "obstacles: {}", join(&info.obstacles))?;
    }
    info.fluid.iter().try_for_each(|fluid| writeln!(out, "fluid: {fluid}"))?;
    writeln!(out, "attached: {}\n", join(&info.attachments))?;
    let of_fluid: &[Column] = if info.fluid.is_some() { &FLUID_COLUMNS } else { &[] };
    let columns = || COLUMNS.iter().chain(of_fluid);
    columns().try_for_each(|(name, width, _)| write!(out, "{name:>width$}"))?;
    writeln!(out)?;
    for frame in &info.frames {
        for (_, width, content) in columns() {
            // A blank of its own keeps the columns apart where a number fills its column.
            write!(out, " {:>1$}", content(frame), width - 1)?;
        }
        writeln!(out)?;
    }
    if !info.totals.is_empty() {
        writeln!(out, "\n{:<27}{:>14}{:>14}{:>14}{:>14}", "", "min", "mean", "max", "sum")?;
        for (name, spread) in &info.totals {
            write!(out, "{name:<27}")?;
            for value in [spread.min, spread.mean, spread.max, spread.sum] {
                write!(out, " {:>13}", number(value))?;
            }
            writeln!(out)?;
        }
    }
    if !info.skipped.is_empty() {
        writeln!(out)?;
    }
    info.skipped.iter().try_for_each(|stage| writeln!(out, "skipped: {stage}"))
}

fn join(words: &[String]) -> String {
    if words.is_empty() { "none".into() } else { words.join(", ") }
}

/// Whole numbers as they are, others with five significant digits or so.
fn number(x: f64) -> String {
    if x == x.trunc() && x.abs() < 1e13 {
        return format!("{x}");
    }
    match x.abs() {
        a if (1e4..1e10).contains(&a) => format!("{x:.1}"),
        a if (1e-3..1e4).contains(&a) => format!("{x:.4}"),
        _ => format!("{x:.4e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (x, text) in [
            (0.0, "0"),
            (1234.0, "1234"),
            (0.5, "0.5000"),
            (12345.678, "12345.7"),
            (1.5e-7, "1.5000e-7"),
            (-2.5, "-2.5000"),
            (f64::NAN, "NaN"),
            (1e300, "1.0000e300"),
        ] {
            assert_eq!(number(x), text);
        }
    }
}
