//! Trousers: four panels that meet in one point between the legs.

use super::panel::{cells, mix, panel, profile, stadium};
use mesh_core::World3;
use mesh_core::generate::{Chain, GenerateError, Lattice, Seam, Sheet, lay_out, sew};
use std::f64::consts::PI;

/// Half of the straight part of the cross-section at the hips (m).
const HALF: f64 = 0.055;
/// Height of hem, crotch and waist (m).
const HEM: f64 = 0.13;
const CROTCH: f64 = 0.77;
const WAIST: f64 = 1.08;
/// Radius of the cross-section at the hips by height (m).
const HIPS: [[f64; 2]; 4] = [[0.90, 0.140], [0.98, 0.113], [1.05, 0.083], [1.08, 0.082]];
/// Inner and outer reach of a leg in x, and its half depth, by height (m).
const INNER: [[f64; 2]; 3] = [[0.13, 0.034], [0.62, 0.018], [0.77, 0.0]];
const OUTER: [[f64; 2]; 2] = [[0.13, 0.205], [0.77, 0.195]];
const DEPTH: [[f64; 2]; 2] = [[0.13, 0.085], [0.77, 0.105]];

/// A point of the front of the leg at x > 0: `share` from 0 at the outer side to 1 at the inner one.
fn point(share: f64, z: f64) -> World3 {
    let leg = {
        let [inner, outer, depth] = [&INNER[..], &OUTER[..], &DEPTH[..]].map(|p| profile(p, z));
        let (sine, cosine) = (PI * share).sin_cos();
        [mix(inner, outer, 0.5 * (1.0 + cosine)), -depth * sine]
    };
    let up = (z - CROTCH) / (WAIST - CROTCH);
    if up <= 0.0 {
        return World3::new(leg[0], leg[1], z);
    }
    // From half of an ellipse around the leg to a quarter of the cross-section of the hips.
    let hips = stadium(HALF, profile(&HIPS, z), 1.0 - share);
    let above = (0.5 * PI * (up / 0.55).min(1.0)).sin();
    World3::new(mix(leg[0], hips[0], above), mix(leg[1], hips[1], above), z)
}

pub(super) fn trousers(cell: f64) -> Result<Sheet, GenerateError> {
    let columns = cells(0.30, cell, 3);
    let below = cells(CROTCH - HEM, cell, 2);
    let above = cells(1.15 * (WAIST - CROTCH), cell, 2);
    let lattice = Lattice::new([columns, below + above])?;
    let height = |j: usize| {
        if j <= below {
            mix(HEM, CROTCH, j as f64 / below as f64)
        } else {
            mix(CROTCH, WAIST, (j - below) as f64 / above as f64)
        }
    };
    // Front right, front left, back right, back left; seen from outside the inner side is at the left
    // of the first and the last.
    let sides = [[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];
    let inner_is_first = |side: usize| side == 0 || side == 3;
    let mut sheets = Vec::new();
    for (side, [x, y]) in sides.into_iter().enumerate() {
        sheets.push(panel(&lattice, |i, j| {
            let share = i as f64 / columns as f64;
            let share = if inner_is_first(side) { 1.0 - share } else { share };
            point(share, height(j)).component_mul(&World3::new(x, y, 1.0))
        })?);
    }
    lay_out(&mut sheets, 0.02);
    let inner = |side: usize| if inner_is_first(side) { 0 } else { columns };
    let part = |side: usize, i: usize, rows: std::ops::RangeInclusive<usize>| {
        Chain::new(side, rows.map(|j| lattice.vertex(i, j)))
    };
    let top = lattice.cells[1];
    let seam = |a: usize, b: usize, is_inner: bool, from: usize, to: usize| {
        let column = |side: usize| if is_inner { inner(side) } else { columns - inner(side) };
        Seam { first: part(a, column(a), from..=to), second: part(b, column(b), from..=to) }
    };
    let seams = [
        // At the sides, then inside the legs, then in the middle of front and back.
        seam(0, 2, false, 0, top),
        seam(1, 3, false, 0, top),
        seam(0, 2, true, 0, below),
        seam(1, 3, true, 0, below),
        seam(0, 1, true, below, top),
        seam(2, 3, true, below, top),
    ];
    let mut sewn = sew(&sheets, &seams)?;
    let row = |side: usize, j: usize| Chain::new(side, lattice.row(j));
    sewn.name_border("waist", &[0, 1, 2, 3].map(|side| row(side, top)));
    sewn.name_border("right-hem", &[row(0, 0), row(2, 0)]);
    sewn.name_border("left-hem", &[row(1, 0), row(3, 0)]);
    Ok(sewn.sheet)
}
