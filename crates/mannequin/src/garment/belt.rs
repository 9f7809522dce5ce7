//! The belt: a strip around jacket and trousers.

use super::panel::{cells, stadium};
use mesh_core::generate::{Chain, Diagonal, GenerateError, Lattice, Seam, Sheet, sew};
use mesh_core::{Material2, World3};
use std::f64::consts::PI;

/// Half of the straight part and radius of its cross-section (m).
const SECTION: [f64; 2] = [0.06, 0.162];
/// Lower edge and width (m).
const LOW: f64 = 1.055;
const WIDTH: f64 = 0.05;
/// Length of the pattern over that of the start (1).
const ELASTIC: f64 = 0.75;

pub(super) fn belt(cell: f64) -> Result<Sheet, GenerateError> {
    let [half, radius] = SECTION;
    let length = 4.0 * half + 2.0 * PI * radius;
    let around = cells(length, cell, 8);
    let lattice = Lattice::new([around, cells(WIDTH, cell, 1)])?;
    let height = |j: usize| WIDTH * j as f64 / lattice.cells[1] as f64;
    let strip = lattice.sheet(
        Diagonal::Alternating,
        |i, j| Material2::new(ELASTIC * length * i as f64 / around as f64, height(j)),
        |i, j| {
            // Once around from the middle of the back; the last column is the first.
            let turn = 4.0 * (i % around) as f64 / around as f64 - 2.0;
            let [x, y] = if turn.abs() <= 1.0 {
                stadium(half, radius, turn)
            } else {
                let [x, y] = stadium(half, radius, turn - 2.0 * turn.signum());
                [-x, -y]
            };
            World3::new(x, y, LOW + height(j))
        },
    )?;
    let side = |i: usize| Chain::new(0, lattice.column(i));
    let mut sewn = sew(&[strip], &[Seam { first: side(0), second: side(around) }])?;
    for (name, j) in [("lower", 0), ("upper", lattice.cells[1])] {
        sewn.name_border(name, &[Chain::new(0, lattice.row(j))]);
    }
    Ok(sewn.sheet)
}
