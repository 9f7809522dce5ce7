//! The program `organza`: its commands are described by `organza --help`.

#![warn(missing_docs)]
#![forbid(unsafe_code)]

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run()
}
