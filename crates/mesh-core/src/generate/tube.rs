//! A rectangle rolled up to a tube.

use super::lattice::Lattice;
use super::limits::{check_count, check_size};
use super::sew::{Chain, Seam, sew};
use super::{Diagonal, GenerateError, Sheet};
use crate::geometry::{Material2, World3};
use std::f64::consts::{PI, TAU};

/// A tube around the z axis from z = 0 to z = `length` (m) with `around` cells in each of `along`
/// rows. The vertices lie on the cylinder of `radius` (m), so that the tube is a prism; material
/// space is the prism unrolled, with u around and v along, and the cloth is at rest exactly. A seam
/// runs along it in the plane y = 0, x > 0, where the first and the last column share vertices.
/// Normals point outwards. Borders: `lower` at z = 0, and `upper`.
///
/// # Errors
/// If a length is not positive, finite and within the limits, or if there are fewer than three
/// cells around, none along, or too many.
pub fn tube(radius: f64, length: f64, around: usize, along: usize) -> Result<Sheet, GenerateError> {
    check_size("radius of the tube", radius)?;
    check_size("length of the tube", length)?;
    check_count("cells around the tube", around, 3)?;
    let lattice = Lattice::new([around, along])?;

    let chord = 2.0 * radius * (PI / around as f64).sin();
    let height = |j: usize| length * j as f64 / along as f64;
    let sheet = lattice.sheet(
        Diagonal::Alternating,
        |i, j| Material2::new(chord * i as f64, height(j)),
        |i, j| {
            // The last column is the first one: the same bits, not only the same angle.
            let (sine, cosine) = (TAU * (i % around) as f64 / around as f64).sin_cos();
            World3::new(radius * cosine, radius * sine, height(j))
        },
    )?;
    let column = |i: usize| Chain::new(0, lattice.column(i));
    let seam = Seam { first: column(0), second: column(around) };
    let mut sewn = sew(&[sheet], &[seam])?;
    for (name, j) in [("lower", 0), ("upper", along)] {
        sewn.name_border(name, &[Chain::new(0, lattice.row(j))]);
    }
    Ok(sewn.sheet)
}
