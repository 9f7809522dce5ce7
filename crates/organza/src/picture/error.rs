//! Why pictures could not be made.

use std::path::PathBuf;

use crate::export::{ExportError, FilesError};
use crate::record::RunError;
use crate::render::RenderError;

/// Why pictures could not be made.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The recording cannot be read, or has none of the frames.
    #[error(transparent)]
    Recording(#[from] ExportError),
    /// A view through a camera that is not there.
    #[error("{}: frame {frame} has no camera; use the view from outside", path.display())]
    NoCamera {
        /// The recording.
        path: PathBuf,
        /// The frame.
        frame: u64,
    },
    /// A picture cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A file cannot be written.
    #[error(transparent)]
    Files(#[from] FilesError),
}

impl From<RunError> for PictureError {
    fn from(error: RunError) -> Self {
        PictureError::Recording(error.into())
    }
}
