//! `cargo xtask bench`: what the program costs and how well it does, as figures in a report.
//!
//! A benchmark is a [`Benchmark`] listed in [`BENCHMARKS`]. It drives the program that users run, in
//! processes of its own, one after the other and on one thread, and adds named figures to the
//! [`Report`].

mod arcsim;
mod arps;
mod contact;
mod cpu_time;
mod fixed_or_adaptive;
mod flag;
mod machine;
mod options;
mod program;
mod report;
mod run_info;
mod statistics;
mod surface;

use crate::command::{Command, Failure, say};
use options::Options;
use program::Program;
use report::Report;
use std::fs;
use std::path::{Path, PathBuf};

/// The command.
pub const COMMAND: Command = Command {
    name: "bench",
    summary: "Measure speed and error of the program; writes report.json",
    help,
    run,
};

/// One benchmark.
struct Benchmark {
    /// What is typed after `cargo xtask bench`; its figures begin with it.
    name: &'static str,
    /// One line for the help.
    summary: &'static str,
    run: fn(&Context, &mut Report) -> Result<(), Failure>,
}

/// All benchmarks, in the order in which they run.
const BENCHMARKS: &[Benchmark] = &[flag::BENCHMARK, contact::BENCHMARK, arps::BENCHMARK];

/// What a benchmark works with.
struct Context {
    /// Folder of the workspace.
    root: PathBuf,
    /// Folder of the report.
    out: PathBuf,
    options: Options,
    program: Program,
}

impl Context {
    /// Where a benchmark leaves its recordings.
    fn runs(&self) -> PathBuf {
        self.out.join("runs")
    }

    /// Writes the figures found so far, so that a long benchmark that is stopped leaves something.
    fn save(&self, report: &Report) -> Result<(), Failure> {
        let path = self.out.join("report.json");
        fs::write(&path, report.json())
            .map_err(|error| Failure::Unable(format!("cannot write {}: {error}", path.display())))
    }
}

fn help() -> String {
    let list: String =
        BENCHMARKS.iter().map(|b| format!("  {:8}{}\n", b.name, b.summary)).collect();
    format!(
        "Usage: cargo xtask bench [NAME]… [OPTIONS]\n\nBenchmarks, all unless named:\n{list}\n\
         Options:\n{}\n\
         Builds the program first. Runs it on one thread and counts CPU seconds, which other load\n\
         on the machine still makes longer: compare runs made on a quiet one.\n\n\
         Examples:\n  cargo xtask bench\n  cargo xtask bench flag --quick\n  \
         cargo xtask bench flag --scene scenes/hang.json5 --out target/hang\n",
        options::HELP
    )
}

fn run(root: &Path, arguments: &[String]) -> Result<(), Failure> {
    let options = Options::parse(arguments).map_err(Failure::Unable)?;
    let out = options.out.clone().unwrap_or_else(|| root.join("target/bench"));
    let named = |b: &&Benchmark| options.names.is_empty() || options.names.contains(&b.name.into());
    let chosen: Vec<&Benchmark> = BENCHMARKS.iter().filter(named).collect();

    say("building the program");
    let program = Program::build(root)?;
    let context = Context { root: root.to_owned(), out, options, program };
    let runs = context.runs();
    fs::create_dir_all(&runs)
        .map_err(|error| Failure::Unable(format!("cannot make {}: {error}", runs.display())))?;
    let mut report = Report::new(machine::Machine::here(), machine::commit(root));
    for benchmark in chosen {
        (benchmark.run)(&context, &mut report)?;
        context.save(&report)?;
    }
    say(format!("\n{}\nreport: {}", report.table(), context.out.join("report.json").display()));
    Ok(())
}
