//! Which frames of a recording: `A..B`.

use std::fmt;
use std::str::FromStr;

/// Frames by number, the first included and the end not, as ranges of Rust: `3..6` are the frames
/// 3, 4 and 5, `3..` all from frame 3, `..6` all before frame 6, `4` that frame alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameRange {
    /// The first frame.
    pub start: u64,
    /// The frame after the last; absent for all.
    pub end: Option<u64>,
}

/// Why a text is not a range of frames.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RangeError {
    /// Something else than numbers and two dots.
    #[error("expected A..B, A.., ..B or A, with frame numbers A and B")]
    Form,
    /// The end is not behind the start.
    #[error("{start}..{end} holds no frame: the end is not included")]
    Empty {
        /// The start.
        start: u64,
        /// The end.
        end: u64,
    },
}

impl FrameRange {
    /// Whether `frame` is one of them.
    pub fn contains(&self, frame: u64) -> bool {
        frame >= self.start && self.end.is_none_or(|end| frame < end)
    }
}

impl FromStr for FrameRange {
    type Err = RangeError;

    fn from_str(text: &str) -> Result<Self, RangeError> {
        let number = |text: &str| text.trim().parse::<u64>().map_err(|_| RangeError::Form);
        let Some((start, end)) = text.split_once("..") else {
            let frame = number(text)?;
            return Ok(Self { start: frame, end: frame.checked_add(1) });
        };
        let start = if start.trim().is_empty() { 0 } else { number(start)? };
        let end = if end.trim().is_empty() { None } else { Some(number(end)?) };
        match end {
            Some(end) if end <= start => Err(RangeError::Empty { start, end }),
            _ => Ok(Self { start, end }),
        }
    }
}

impl fmt::Display for FrameRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.end {
            Some(end) => write!(f, "{}..{end}", self.start),
            None => write!(f, "{}..", self.start),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_half_open() {
        for (text, start, end) in [
            ("3..6", 3, Some(6)),
            ("3..", 3, None),
            ("..6", 0, Some(6)),
            ("..", 0, None),
            (" 4 ", 4, Some(5)),
        ] {
            let range: FrameRange = text.parse().unwrap();
            assert_eq!(range, FrameRange { start, end }, "{text}");
            assert!(range.contains(start) && !end.is_some_and(|end| range.contains(end)));
        }
    }

    #[test]
    fn what_is_no_range_is_refused() {
        for text in ["", "a..b", "3...6", "-1..2", "3..=6", "1.5", "99999999999999999999"] {
            assert_eq!(text.parse::<FrameRange>(), Err(RangeError::Form), "{text}");
        }
        for text in ["3..3", "6..3", "..0"] {
            let error = text.parse::<FrameRange>().unwrap_err();
            assert!(matches!(error, RangeError::Empty { .. }), "{text}: {error}");
        }
    }
}
