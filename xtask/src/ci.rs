//! `cargo xtask ci`: the checks that a change must pass, as `.ci/run` makes them.
//!
//! The script is plain bash so that it says on one page what happens; a tidy rule keeps the two
//! lists together.

use crate::command::{Command, Failure, no_arguments, say};
use std::path::Path;
use std::process;
use std::time::Instant;

/// The checks, in order: cheap ones first. The last is the README's test command, which runs the
/// documentation tests too.
pub const STEPS: [&str; 3] = [
    "cargo fmt --all --check",
    "cargo clippy --release --workspace --all-targets -- -D warnings",
    "cargo test --release --workspace",
];

/// The command.
pub const COMMAND: Command = Command {
    name: "ci",
    summary: "Check formatting, lints and tests: what .ci/run does before its trial run",
    help,
    run,
};

fn help() -> String {
    let steps: String = STEPS.iter().map(|step| format!("  {step}\n")).collect();
    format!(
        "Usage: cargo xtask ci\n\nRuns, and stops at the first that fails:\n{steps}\n\
         Examples:\n  cargo xtask ci\n"
    )
}

fn run(root: &Path, arguments: &[String]) -> Result<(), Failure> {
    no_arguments(arguments)?;
    for step in STEPS {
        say(format!("\n+ {step}"));
        let start = Instant::now();
        let mut words = step.split_whitespace();
        let program = words.next().unwrap_or_default();
        let status = process::Command::new(program)
            .args(words)
            .current_dir(root)
            .status()
            .map_err(|error| Failure::Unable(format!("cannot start `{step}`: {error}")))?;
        if !status.success() {
            eprintln!("failed: {step} ({status})");
            return Err(Failure::Found);
        }
        say(format!("  passed in {:.0} s", start.elapsed().as_secs_f64()));
    }
    Ok(())
}
