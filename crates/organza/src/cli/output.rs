//! Text to the user. Nothing here panics when nobody listens any more.

use std::io::{self, Write};
use std::path::Path;

use io_mcap::Status;
use organza::scene::Issue;

use super::Failure;

/// Prints the result of a command.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Err(Failure::OutputClosed),
        Err(error) => Err(Failure::failed(format!("cannot write the output: {error}"))),
    }
}

/// Prints one line beside the result.
pub(crate) fn note(line: &str) {
    // If not even this can be said there is nobody to say it to.
    let _ = writeln!(io::stderr().lock(), "{line}");
}

pub(crate) fn error(message: &str) {
    note(&format!("error: {message}"));
}

pub(crate) fn warning(message: &str) {
    note(&format!("warning: {message}"));
}

pub(crate) fn warnings(issues: &[Issue]) {
    issues.iter().for_each(|issue| warning(&issue.to_string()));
}

/// Warns of a recording that is not whole.
pub(crate) fn status(path: &Path, status: &Status) {
    if *status != Status::Complete {
        warning(&format!("{}: {status}", path.display()));
    }
}
