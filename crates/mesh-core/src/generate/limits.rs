//! Limits of what generators are asked for, checked before any memory is taken.

use super::GenerateError;

/// Smallest length that generators accept (m).
pub const MIN_SIZE: f64 = 1e-6;
/// Largest length that generators accept (m).
pub const MAX_SIZE: f64 = 1e6;
/// Most triangles that generators make: about a gigabyte of mesh.
pub const MAX_TRIANGLES: usize = 4_000_000;

/// Accepts a length (m).
pub(super) fn check_size(what: &'static str, value: f64) -> Result<(), GenerateError> {
    check_below(what, value, MAX_SIZE)
}

/// Accepts a length up to `max` (m).
pub(super) fn check_below(what: &'static str, value: f64, max: f64) -> Result<(), GenerateError> {
    if (MIN_SIZE..=max).contains(&value) {
        Ok(())
    } else {
        Err(GenerateError::Size { what, value, min: MIN_SIZE, max })
    }
}

/// Accepts a number of parts.
pub(super) fn check_count(
    what: &'static str,
    value: usize,
    min: usize,
) -> Result<(), GenerateError> {
    if value >= min { Ok(()) } else { Err(GenerateError::TooFew { what, value, min }) }
}

/// Accepts a number of triangles, given as the product of some factors.
pub(super) fn check_triangles(factors: &[usize]) -> Result<(), GenerateError> {
    let wanted: f64 = factors.iter().map(|&n| n as f64).product();
    if wanted <= MAX_TRIANGLES as f64 {
        Ok(())
    } else {
        Err(GenerateError::TooMany { wanted, limit: MAX_TRIANGLES })
    }
}

/// Number of cells of about `cell` (m) along `length` (m), at least `min`. Both lengths must have
/// been accepted; absurd numbers come back as they are and fail at [`check_triangles`].
pub(super) fn cells_along(length: f64, cell: f64, min: usize) -> usize {
    ((length / cell).round() as usize).max(min)
}
