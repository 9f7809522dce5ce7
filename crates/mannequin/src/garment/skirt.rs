//! The skirt: a front and a back of one cone.

use super::panel::{cells, mix, panel, stadium};
use mesh_core::World3;
use mesh_core::generate::{Chain, GenerateError, Lattice, Seam, Sheet, lay_out, sew};
use std::f64::consts::PI;

/// Half of the straight part of the cross-section (m).
pub(super) const HALF: f64 = 0.06;
/// Height of the waist (m).
pub(super) const WAIST: f64 = 1.08;
/// Radius of the cross-section there (m): stretched by a tenth, it does not slide over the hips.
const RADIUS: f64 = 0.082;
/// Height and radius of the hem (m).
const HEM: [f64; 2] = [0.48, 0.33];

/// Front and back below a waist of `radius` (m), with `columns` cells across each; column i is at
/// `share(i)` from −1 to 1 across.
pub(super) fn panels(
    columns: usize,
    cell: f64,
    radius: f64,
    share: impl Fn(usize) -> f64,
) -> Result<(Lattice, [Sheet; 2]), GenerateError> {
    let length = (WAIST - HEM[0]).hypot(HEM[1] - radius);
    let lattice = Lattice::new([columns, cells(length, cell, 2)])?;
    let make = |sign: f64| {
        panel(&lattice, |i, j| {
            let up = j as f64 / lattice.cells[1] as f64;
            let [x, y] = stadium(HALF, mix(HEM[1], radius, up), share(i));
            World3::new(sign * x, sign * y, mix(HEM[0], WAIST, up))
        })
    };
    Ok((lattice, [make(1.0)?, make(-1.0)?]))
}

/// Seams at both sides between the sheets `front` and `back`, which have the same lattice.
pub(super) fn side_seams(lattice: &Lattice, front: usize, back: usize) -> [Seam; 2] {
    let side = |sheet, i| Chain::new(sheet, lattice.column(i));
    let last = lattice.cells[0];
    [
        Seam { first: side(front, last), second: side(back, 0) },
        Seam { first: side(back, last), second: side(front, 0) },
    ]
}

pub(super) fn skirt(cell: f64) -> Result<Sheet, GenerateError> {
    // As many as the middle between waist and hem wants.
    let width = 2.0 * HALF + PI * 0.5 * (RADIUS + HEM[1]);
    let columns = cells(width, cell, 4);
    let even = |i: usize| 2.0 * i as f64 / columns as f64 - 1.0;
    let (lattice, sheets) = panels(columns, cell, RADIUS, even)?;
    let mut sheets = Vec::from(sheets);
    lay_out(&mut sheets, 0.02);
    let mut sewn = sew(&sheets, &side_seams(&lattice, 0, 1))?;
    for (name, j) in [("hem", 0), ("waist", lattice.cells[1])] {
        sewn.name_border(name, &[0, 1].map(|sheet| Chain::new(sheet, lattice.row(j))));
    }
    Ok(sewn.sheet)
}
