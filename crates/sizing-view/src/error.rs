//! What can be wrong with cameras, paths and settings.

/// Why a camera, a path or an evaluation was refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ViewError {
    /// A number out of range.
    #[error("{name} is {value}; it must be {range}")]
    OutOfRange {
        /// Which one.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
    /// The direction of view cannot be told.
    #[error("the camera at {position:?} has no direction of view towards {target:?}")]
    NoDirection {
        /// Where the camera stands (m).
        position: [f64; 3],
        /// Where it should look (m).
        target: [f64; 3],
    },
    /// A path without a shot, or a shot without a camera.
    #[error("shot {shot} of the camera path is missing or has no camera")]
    Empty {
        /// Its number, from 0.
        shot: usize,
    },
    /// Times that do not increase.
    #[error("in shot {shot} of the camera path, {time} s comes after {previous} s")]
    Order {
        /// Number of the shot, from 0.
        shot: usize,
        /// The earlier entry's time (s).
        previous: f64,
        /// The later entry's time (s).
        time: f64,
    },
    /// No camera looks at the cloth.
    #[error("no camera to evaluate view factors for")]
    NoCamera,
}

/// Checks a number.
pub(crate) fn check(
    name: &'static str,
    value: f64,
    range: &'static str,
    is_fine: impl Fn(f64) -> bool,
) -> Result<(), ViewError> {
    if is_fine(value) { Ok(()) } else { Err(ViewError::OutOfRange { name, value, range }) }
}
