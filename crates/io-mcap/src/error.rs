//! What can go wrong while writing or reading a recording.

use std::io;
use std::path::{Path, PathBuf};

/// Why a recording could not be written or read. Offsets are bytes from the start of the file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Any of the other errors, with the file it concerns.
    #[error("{}: {source}", path.display())]
    InFile {
        /// The file as it was named by the caller.
        path: PathBuf,
        /// What happened.
        source: Box<Error>,
    },
    /// The operating system refused.
    #[error("cannot {doing}: {source}")]
    Io {
        /// What was being done.
        doing: &'static str,
        /// Its answer.
        source: io::Error,
    },
    /// The file to create is there already and may not be overwritten.
    #[error("the file exists already, and overwriting it was not asked for")]
    Exists,
    /// A file of no bytes.
    #[error("the file is empty (0 bytes): not a recording")]
    Empty,
    /// The file does not begin as an MCAP does.
    #[error("not an MCAP file: it begins with {found:02x?} instead of the MCAP magic bytes")]
    NotMcap {
        /// The first bytes of the file, at most eight.
        found: Vec<u8>,
    },
    /// An MCAP of another program, or one cut before anything of ours was written.
    #[error(
        "an MCAP file, but not a recording of a simulation: it has no readable \
         `organza.recording` metadata in its {bytes} bytes"
    )]
    NotRecording {
        /// Size of the file (bytes).
        bytes: u64,
    },
    /// A recording in a later form of this format.
    #[error("the recording has format {found:?}; this version reads format \"{supported}\"")]
    Format {
        /// Format named by the file.
        found: String,
        /// The format this version writes and reads.
        supported: &'static str,
    },
    /// Bytes that cannot be what was written.
    #[error("damaged at byte {offset}: {what}")]
    Damaged {
        /// Where.
        offset: u64,
        /// What is wrong there.
        what: String,
    },
    /// Something claims, or has, more bytes than the limit.
    #[error("the {what} at byte {offset} has {bytes} bytes, above the limit of {limit}")]
    TooLarge {
        /// What it is.
        what: &'static str,
        /// Where.
        offset: u64,
        /// Its size (bytes).
        bytes: u64,
        /// The limit (bytes).
        limit: u64,
    },
    /// The frame asked for is not in the recording.
    #[error("frame {frame} is not in the recording, which holds {held}")]
    NoFrame {
        /// Frame asked for.
        frame: u64,
        /// The frames there are, in words.
        held: String,
    },
    /// No checkpoint was taken at the frame asked for.
    #[error("no checkpoint at frame {frame}; there are {held}")]
    NoCheckpoint {
        /// Frame asked for.
        frame: u64,
        /// The checkpoints there are, in words.
        held: String,
    },
    /// No attachment has the name asked for.
    #[error("no attachment named {name:?} in the recording; there are {held}")]
    NoAttachment {
        /// Name asked for.
        name: String,
        /// The attachments there are, in words.
        held: String,
    },
    /// A frame, checkpoint or header given to the recorder that cannot be recorded.
    #[error("cannot record {what}")]
    Unrecordable {
        /// What, and why.
        what: String,
    },
    /// The recorder gave up after an earlier error.
    #[error("recording stopped after an earlier error")]
    Stopped,
    /// The MCAP library refused.
    #[error("cannot write MCAP: {what}")]
    Mcap {
        /// Its answer.
        what: String,
    },
}

impl Error {
    pub(crate) fn io(doing: &'static str) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { doing, source }
    }

    pub(crate) fn damaged(offset: u64, what: impl Into<String>) -> Self {
        Self::Damaged { offset, what: what.into() }
    }

    pub(crate) fn unrecordable(what: impl Into<String>) -> Self {
        Self::Unrecordable { what: what.into() }
    }

    /// Names the file, once.
    pub(crate) fn in_file(path: &Path) -> impl FnOnce(Self) -> Self {
        move |error| match error {
            Self::InFile { .. } => error,
            _ => Self::InFile { path: path.to_owned(), source: Box::new(error) },
        }
    }
}

impl From<mcap::McapError> for Error {
    fn from(error: mcap::McapError) -> Self {
        match error {
            mcap::McapError::Io(source) => Self::Io { doing: "write the recording", source },
            other => Self::Mcap { what: other.to_string() },
        }
    }
}
