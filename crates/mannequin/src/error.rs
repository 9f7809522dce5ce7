//! What can be wrong with a mannequin or a garment that is asked for.

use mesh_core::generate::GenerateError;

/// Why no mannequin or garment was made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MannequinError {
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
    /// The skin is not one closed manifold at this length of edges.
    #[error("the skin is not one closed surface with edges of {cell} m; try another length")]
    Skin {
        /// Wanted length of edges (m).
        cell: f64,
    },
    /// A garment cannot be made.
    #[error(transparent)]
    Garment(#[from] GenerateError),
}

/// Accepts a number for which `fits` holds.
pub(crate) fn check(
    name: &'static str,
    value: f64,
    range: &'static str,
    fits: impl FnOnce(f64) -> bool,
) -> Result<(), MannequinError> {
    if fits(value) { Ok(()) } else { Err(MannequinError::OutOfRange { name, value, range }) }
}
