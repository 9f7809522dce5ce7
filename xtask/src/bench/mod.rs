//! `cargo xtask bench`: what the program costs and how well it does, as figures in a report.
//!
//! A benchmark is a [`Benchmark`] listed in [`BENCHMARKS`]. It drives the program that users run, in
//! processes of its own, one after the other and on one thread, and adds named figures to the
//! [`Report`].

mod arcsim;
mod arps;
mod baseline;
mod child;
mod contact;
mod cpu_time;
mod example;
mod figure;
mod fixed_or_adaptive;
mod flag;
mod html;
mod kernels;
mod machine;
mod names;
mod number;
mod options;
mod pareto;
mod pay;
mod peers;
mod points;
mod program;
mod provenance;
mod report;
mod resume;
mod run_info;
mod scaling;
mod sph;
mod stability;
mod stages;
mod statistics;
mod stiff;
mod surface;
mod table;
mod told_by_tests;
mod view;

use crate::command::{Command, Failure, say};
use options::Options;
use program::Program;
use provenance::Provenance;
use report::Report;
use std::fs;
use std::path::{Path, PathBuf};

/// The command.
pub const COMMAND: Command = Command {
    name: "bench",
    summary: "Measure speed and error of the program; writes report.json and report.html",
    help,
    run,
};

/// One benchmark.
struct Benchmark {
    /// What is typed after `cargo xtask bench`.
    name: &'static str,
    /// One line for the help.
    summary: &'static str,
    /// Names of its figures and tables, where `*` stands for anything without a dot.
    figures: &'static [&'static str],
    run: fn(&Context, &mut Report) -> Result<(), Failure>,
}

/// All benchmarks, in the order in which they run.
const BENCHMARKS: &[Benchmark] = &[
    flag::BENCHMARK,
    contact::BENCHMARK,
    view::BENCHMARK,
    arps::BENCHMARK,
    sph::BENCHMARK,
    pareto::BENCHMARK,
    stability::BENCHMARK,
    stiff::BENCHMARK,
    scaling::BENCHMARK,
    peers::BENCHMARK,
    pay::BENCHMARK,
];

/// What a benchmark works with.
struct Context {
    /// Folder of the workspace.
    root: PathBuf,
    /// Folder of the report.
    out: PathBuf,
    options: Options,
    program: Program,
    /// An earlier report to compare with.
    baseline: Option<Report>,
}

impl Context {
    /// Where a benchmark leaves its recordings.
    fn runs(&self) -> PathBuf {
        self.out.join("runs")
    }

    /// Writes a scene that a suite has made among the recordings.
    ///
    /// # Errors
    /// If it cannot be written.
    fn scene(&self, name: &str, text: &str) -> Result<PathBuf, Failure> {
        let path = self.runs().join(format!("{name}.json5"));
        let told = |error| Failure::Unable(format!("cannot write {}: {error}", path.display()));
        fs::create_dir_all(self.runs()).and_then(|()| fs::write(&path, text)).map_err(told)?;
        Ok(path)
    }

    /// The scenes of a suite that are asked for, all unless one is named.
    fn chosen<'a, T>(
        &self,
        report: &mut Report,
        all: &'a [T],
        name: impl Fn(&T) -> &str,
    ) -> Vec<&'a T> {
        let Some(path) = &self.options.scene else { return all.iter().collect() };
        let wanted = path.file_stem().unwrap_or_default().to_string_lossy();
        let chosen: Vec<&T> = all.iter().filter(|scene| name(scene) == wanted).collect();
        if chosen.is_empty() {
            let known: Vec<&str> = all.iter().map(name).collect();
            report.remark(&format!("`{wanted}` is none of the scenes: {}.", known.join(", ")));
        }
        chosen
    }

    /// Writes what was found so far, so that a long benchmark that is stopped leaves something.
    fn save(&self, report: &Report) -> Result<(), Failure> {
        let changes = self.baseline.as_ref().map(|before| baseline::compare(before, report));
        write(&self.out.join("report.json"), &report.json())?;
        write(&self.out.join("report.html"), &html::page(report, changes.as_ref()))?;
        let Some(folder) = &self.options.plots else { return Ok(()) };
        fs::create_dir_all(folder).map_err(|error| {
            Failure::Unable(format!("cannot make {}: {error}", folder.display()))
        })?;
        html::files(report).iter().try_for_each(|(name, svg)| write(&folder.join(name), svg))
    }

    /// Measures a part of a suite, named `suite/part`, unless a run that was stopped has it.
    fn part(
        &self,
        report: &mut Report,
        name: &str,
        measure: impl FnOnce(&mut Report) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        if report.is_finished(name) {
            say(format!("{name}: kept from a run that was stopped; --fresh measures it again"));
            return Ok(());
        }
        say(format!("\n{name}"));
        let around = report.begin(name);
        measure(report)?;
        report.finish(around);
        self.save(report)
    }

    /// The report to begin with; `chosen` are the suites asked for.
    fn start(&self, chosen: &[&Benchmark]) -> Report {
        let provenance = Provenance::here(&self.root, self.options.that_matter());
        let earlier = fs::read_to_string(self.out.join("report.json"));
        let earlier = earlier.ok().and_then(|text| Report::read(&text).ok());
        let suites: Vec<&str> = chosen.iter().map(|suite| suite.name).collect();
        resume::start(earlier, provenance, &suites, self.options.fresh)
    }
}

/// The part of the report that `cargo bench` has measured.
const KERNELS: &str = "kernels";

/// Writes a file so that it is never there in halves.
fn write(path: &Path, text: &str) -> Result<(), Failure> {
    let half = path.with_extension("tmp");
    fs::write(&half, text)
        .and_then(|()| fs::rename(&half, path))
        .map_err(|error| Failure::Unable(format!("cannot write {}: {error}", path.display())))
}

fn help() -> String {
    let list: String =
        BENCHMARKS.iter().map(|b| format!("  {:12}{}\n", b.name, b.summary)).collect();
    format!(
        "Usage: cargo xtask bench [NAME]… [OPTIONS]\n\nBenchmarks, all unless named:\n{list}\n\
         Options:\n{}\n\
         Builds the program first. Runs it on one thread and counts CPU seconds, which other load\n\
         on the machine still makes longer: compare runs made on a quiet one. A run that was\n\
         stopped goes on where it was if commit, changes, options and machine are the same.\n\n\
         Examples:\n  cargo xtask bench\n  cargo xtask bench pareto --quick --baseline before\n  \
         cargo xtask bench flag --scene scenes/hang.json5 --out target/hang\n",
        options::HELP
    )
}

fn run(root: &Path, arguments: &[String]) -> Result<(), Failure> {
    let options = Options::parse(arguments).map_err(Failure::Unable)?;
    let out = options.out.clone().unwrap_or_else(|| root.join("target/bench"));
    let named = |b: &&Benchmark| options.names.is_empty() || options.names.contains(&b.name.into());
    let chosen: Vec<&Benchmark> = BENCHMARKS.iter().filter(named).collect();

    let baseline = options.baseline.as_deref().map(baseline::read).transpose()?;
    say("building the program");
    let program = Program::build(root)?;
    let context = Context { root: root.to_owned(), out, options, program, baseline };
    let runs = context.runs();
    fs::create_dir_all(&runs)
        .map_err(|error| Failure::Unable(format!("cannot make {}: {error}", runs.display())))?;
    let mut report = context.start(&chosen);
    for benchmark in chosen {
        let measure = |report: &mut Report| (benchmark.run)(&context, report);
        context.part(&mut report, benchmark.name, measure)?;
        // Figures of another scene bear its name.
        if context.options.scene.is_none() {
            names::check(&mut report, benchmark);
        }
    }
    let around = report.begin(KERNELS);
    kernels::take(&mut report, root);
    report.finish(around);
    report.complete = report.all_is_finished();
    context.save(&report)?;
    say(format!("\n{}", report.text()));
    if let Some(before) = &context.baseline {
        let changes = baseline::compare(before, &report);
        say(format!("\nchanges beyond noise:\n{}", baseline::text(&changes)));
    }
    for name in ["report.json", "report.html"] {
        say(format!("{}", context.out.join(name).display()));
    }
    Ok(())
}
