//! Why a command ends without success, and its exit code.

use organza::export::{ExportError, FilesError};
use organza::picture::PictureError;
use organza::record::RunError;
use organza::render::RenderError;
use organza::scene::SceneErrors;

/// Exit code of a run or a write that failed half-way.
pub(crate) const FAILED: u8 = 1;
/// Exit code of bad input and bad arguments.
pub(crate) const BAD_INPUT: u8 = 2;

/// Why a command ends without success.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The reader of the output has gone, as `head` does when it has enough: nothing to say.
    OutputClosed,
    /// An error.
    Error {
        /// The exit code.
        code: u8,
        /// The message, without "error: ".
        message: String,
    },
}

impl Failure {
    pub(crate) fn failed(message: impl ToString) -> Self {
        Failure::Error { code: FAILED, message: message.to_string() }
    }

    pub(crate) fn bad_input(message: impl ToString) -> Self {
        Failure::Error { code: BAD_INPUT, message: message.to_string() }
    }
}

/// Errors before anything is simulated.
impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        Failure::bad_input(error)
    }
}

impl From<SceneErrors> for Failure {
    fn from(error: SceneErrors) -> Self {
        Failure::bad_input(error)
    }
}

fn code(error: &FilesError) -> u8 {
    match error {
        FilesError::Write { .. } => FAILED,
        _ => BAD_INPUT,
    }
}

impl From<ExportError> for Failure {
    fn from(error: ExportError) -> Self {
        let code = match &error {
            ExportError::Files(files) => code(files),
            ExportError::Recording(_)
            | ExportError::NoFrames { .. }
            | ExportError::NoFluid { .. } => BAD_INPUT,
        };
        Failure::Error { code, message: error.to_string() }
    }
}

impl From<PictureError> for Failure {
    fn from(error: PictureError) -> Self {
        let code = match &error {
            PictureError::Files(files) => code(files),
            PictureError::Render(RenderError::Write { .. } | RenderError::Encode(_)) => FAILED,
            _ => BAD_INPUT,
        };
        Failure::Error { code, message: error.to_string() }
    }
}
