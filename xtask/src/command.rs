//! The command line of `cargo xtask`: which commands there are, help, dispatch.

use std::fmt;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// One command.
pub struct Command {
    /// What is typed after `cargo xtask`.
    pub name: &'static str,
    /// One line for the overview.
    pub summary: &'static str,
    /// What `--help` prints after the summary: usage, options, examples.
    pub help: fn() -> String,
    /// Does the work on the workspace at the given root with the arguments after the name.
    pub run: fn(&Path, &[String]) -> Result<(), Failure>,
}

/// Why a command failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failure {
    /// It ran and the answer is no; it has printed why. Exit code 1.
    Found,
    /// It could not run. Exit code 2.
    Unable(String),
}

/// All commands, in the order in which help lists them.
pub const COMMANDS: &[Command] = &[crate::tidy::COMMAND, crate::ci::COMMAND, crate::bench::COMMAND];

/// Runs the command that the arguments name.
pub fn dispatch(arguments: &[String]) -> ExitCode {
    let asks_help = |a: &String| a == "--help" || a == "-h" || a == "help";
    let Some((name, rest)) = arguments.split_first() else {
        eprint!("{}", overview());
        return ExitCode::from(2);
    };
    if asks_help(name) {
        say(overview().trim_end());
        return ExitCode::SUCCESS;
    }
    let Some(command) = COMMANDS.iter().find(|c| c.name == name) else {
        eprintln!("there is no command `{name}`\n");
        eprint!("{}", overview());
        return ExitCode::from(2);
    };
    if rest.iter().any(asks_help) {
        say(format!("{}\n\n{}", command.summary, (command.help)().trim_end()));
        return ExitCode::SUCCESS;
    }
    match workspace_root().and_then(|root| (command.run)(&root, rest)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Found) => ExitCode::from(1),
        Err(Failure::Unable(why)) => {
            eprintln!("cargo xtask {name}: {why}");
            ExitCode::from(2)
        }
    }
}

/// Prints a line of the result. A reader that has gone, as `head` does, is no error.
pub fn say(line: impl fmt::Display) {
    let _ = writeln!(io::stdout(), "{line}");
}

/// Refuses arguments that a command does not know.
///
/// # Errors
/// If there are any.
pub fn no_arguments(arguments: &[String]) -> Result<(), Failure> {
    match arguments.first() {
        None => Ok(()),
        Some(argument) => {
            Err(Failure::Unable(format!("does not know the argument `{argument}`; see --help")))
        }
    }
}

fn overview() -> String {
    let width = COMMANDS.iter().map(|c| c.name.len()).max().unwrap_or(0);
    let list: String =
        COMMANDS.iter().map(|c| format!("  {:width$}  {}\n", c.name, c.summary)).collect();
    let examples: String = COMMANDS.iter().map(|c| format!("  cargo xtask {}\n", c.name)).collect();
    format!(
        "Chores of the project.\n\nUsage: cargo xtask COMMAND [OPTIONS]\n\nCommands:\n{list}\n\
         Examples:\n{examples}  cargo xtask {} --help\n",
        COMMANDS[0].name
    )
}

/// The folder of the workspace: the one above this crate, which cargo names when it runs it;
/// otherwise the nearest folder upwards that holds one.
fn workspace_root() -> Result<PathBuf, Failure> {
    let is_root = |folder: &Path| {
        std::fs::read_to_string(folder.join("Cargo.toml"))
            .is_ok_and(|text| text.lines().any(|line| line.trim() == "[workspace]"))
    };
    let own = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let here = std::env::current_dir().ok();
    let starts = [own, here].into_iter().flatten();
    let found = starts
        .flat_map(|start| start.ancestors().map(Path::to_path_buf).collect::<Vec<_>>())
        .find(|folder| is_root(folder));
    found.ok_or_else(|| Failure::Unable("there is no Cargo workspace here or above".into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_command_shows_an_example() {
        for command in COMMANDS {
            let call = format!("cargo xtask {}", command.name);
            assert!((command.help)().contains(&call), "{}", command.name);
            assert!(overview().contains(&call), "{}", command.name);
        }
    }

    #[test]
    fn unknown_arguments_are_refused() {
        assert_eq!(no_arguments(&[]), Ok(()));
        assert!(
            matches!(no_arguments(&["--fats".into()]), Err(Failure::Unable(why)) if why.contains("--fats"))
        );
    }
}
