//! Why frames could not be exported.

use std::path::PathBuf;

use super::FilesError;
use crate::record::{FrameRange, RunError};

/// Why frames could not be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The recording cannot be read.
    #[error(transparent)]
    Recording(#[from] RunError),
    /// The recording has none of the frames.
    #[error("{}: none of the frames {range}: {held}", path.display())]
    NoFrames {
        /// The recording.
        path: PathBuf,
        /// The frames asked for.
        range: FrameRange,
        /// The frames there are, in words.
        held: String,
    },
    /// The format holds particles alone, and the recording has none.
    #[error("{}: has no fluid, and the format holds nothing else", path.display())]
    NoFluid {
        /// The recording.
        path: PathBuf,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Files(#[from] FilesError),
}
