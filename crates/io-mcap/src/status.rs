//! Whether a recording is whole.

use std::fmt;

/// Whether a recording is whole, and if not, what is missing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Status {
    /// The run went to its end and the file is whole.
    Complete,
    /// The file stops early: the run was killed, is still going on, or the file was cut.
    Cut {
        /// Frames that can be read.
        frames_complete: u64,
        /// Bytes at the end of the file that hold nothing that can be read.
        bytes_lost: u64,
        /// Where and how it stops, and any damage before that.
        reason: String,
    },
    /// The file has its end, but not everything before it is as it was written.
    Damaged {
        /// Frames that can be read.
        frames_complete: u64,
        /// Where and what.
        reason: String,
    },
}

impl fmt::Display for Status {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Complete => write!(f, "complete"),
            Self::Cut { frames_complete, bytes_lost, reason } => write!(
                f,
                "cut short: {frames_complete} frames can be read, {bytes_lost} bytes are lost \
                 ({reason})"
            ),
            Self::Damaged { frames_complete, reason } => {
                write!(f, "damaged: {frames_complete} frames can be read ({reason})")
            }
        }
    }
}

/// Bytes that cannot be what was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Damage {
    /// Where (bytes from the start of the file).
    pub(crate) offset: u64,
    /// What.
    pub(crate) what: String,
}

impl fmt::Display for Damage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at byte {}: {}", self.offset, self.what)
    }
}

/// Damage in words: all of it when little, else the first of it.
pub(crate) fn describe(damage: &[Damage]) -> String {
    const MOST: usize = 3;
    let mut words: Vec<String> = damage.iter().take(MOST).map(Damage::to_string).collect();
    if damage.len() > MOST {
        words.push(format!("and {} more places", damage.len() - MOST));
    }
    words.join("; ")
}
