//! The command line: arguments in, exit code out.
//!
//! | Code | Meaning |
//! |---|---|
//! | 0 | done |
//! | 1 | a run or a write failed half-way; what was finished before is kept |
//! | 2 | bad input or bad arguments; nothing was written |

mod args;
mod check;
mod export;
mod failure;
mod info;
mod output;
mod progress;
mod render;
mod resume;
mod simulate;
mod summary;

use std::process::ExitCode;

use clap::Parser;

use args::{Cli, Command};
use failure::Failure;

/// Runs the command that the arguments of the process ask for.
pub(crate) fn run() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            // A closed pipe is no reason to fail.
            let _ = error.print();
            return ExitCode::from(if error.use_stderr() { failure::BAD_INPUT } else { 0 });
        }
    };
    let result = match cli.command {
        Command::Simulate(args) => simulate::run(&args),
        Command::Resume(args) => resume::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Render(args) => render::run(&args),
    };
    match result {
        Ok(()) | Err(Failure::OutputClosed) => ExitCode::SUCCESS,
        Err(Failure::Error { code, message }) => {
            output::error(&message);
            ExitCode::from(code)
        }
    }
}

/// Runs `work` on as many threads as asked for, or on one per core.
fn with_threads(
    threads: Option<u16>,
    work: impl FnOnce() -> Result<(), Failure> + Send,
) -> Result<(), Failure> {
    mesh_core::par::with_threads(threads.map_or(0, usize::from), work)
        .map_err(|error| Failure::failed(format!("cannot start threads: {error}")))?
}
