//! What hangs from the shoulders: the dress and the jacket.

use super::panel::{cells, mix, panel, profile, stadium};
use super::skirt;
use mesh_core::World3;
use mesh_core::generate::{Chain, GenerateError, Lattice, Seam, Sheet, lay_out, sew};
use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::RangeInclusive;

/// The shape of front and back, which are mirror images.
struct Shape {
    /// Radius of the cross-section by height, from the lowest row to the underarm (m).
    radii: &'static [[f64; 2]],
    /// Reach of the shoulders and of the neck in x (m).
    shoulder: f64,
    neck: f64,
    /// Height of the shoulders (m).
    top: f64,
    /// How far the armhole stands out to the front (m).
    bulge: f64,
}

/// Radius of the cross-section at the waist of the dress, which hangs from the shoulders (m).
const WAIST_OF_DRESS: f64 = 0.102;

const DRESS: Shape = Shape {
    radii: &[[skirt::WAIST, WAIST_OF_DRESS], [1.285, 0.122]],
    shoulder: 0.138,
    neck: 0.080,
    top: 1.525,
    bulge: 0.088,
};

const JACKET: Shape = Shape {
    radii: &[[0.80, 0.180], [1.08, 0.130], [1.305, 0.130]],
    shoulder: 0.19,
    neck: 0.085,
    top: 1.515,
    bulge: 0.09,
};

impl Shape {
    fn low(&self) -> f64 {
        self.radii[0][0]
    }

    fn underarm(&self) -> [f64; 2] {
        self.radii[self.radii.len() - 1]
    }

    /// A point of the front at `share` from −1 to 1 across, below the underarm at height `z` (m).
    fn below(&self, share: f64, z: f64) -> World3 {
        let [x, y] = stadium(skirt::HALF, profile(self.radii, z), share);
        World3::new(x, y, z)
    }

    /// The same above the underarm, `up` from 0 there to 1 at the shoulders: the middle goes over the
    /// chest in a quarter of an ellipse, the sides around the arms in an arc.
    fn above(&self, share: f64, up: f64) -> World3 {
        let [underarm, radius] = self.underarm();
        let [x, y] = stadium(skirt::HALF, radius, share);
        let middle = -y / radius;
        let y = -mix(self.bulge * (PI * up).sin(), radius * (FRAC_PI_2 * up).cos(), middle);
        let rise = mix(up, (FRAC_PI_2 * up).sin(), middle);
        let x = mix(x, share * self.shoulder, up);
        World3::new(x, y, mix(underarm, self.top, rise))
    }

    /// Rows up to the underarm and on to the shoulders.
    fn rows(&self, cell: f64) -> [usize; 2] {
        let [underarm, _] = self.underarm();
        [cells(underarm - self.low(), cell, 2), cells(0.5 * PI * self.bulge, cell, 3)]
    }

    /// The place of column `i` from −1 to 1 across, with columns on a shoulder and at the neck.
    fn across(&self, i: usize, [shoulder, neck]: [usize; 2]) -> f64 {
        let edge = self.neck / self.shoulder;
        // Counted from the middle, so that both halves are the same bits.
        let from_middle = i as f64 - 0.5 * (2 * shoulder + neck) as f64;
        let (size, n) = (from_middle.abs(), 0.5 * neck as f64);
        let share = if size <= n {
            edge * size / n
        } else {
            edge + (1.0 - edge) * (size - n) / shoulder as f64
        };
        share * from_middle.signum()
    }

    /// A panel over the whole width with `rows` and columns on a shoulder and at the neck, its
    /// neckline as deep as `hollow` of the way down to the underarm.
    fn whole(
        &self,
        lattice: &Lattice,
        [below, above]: [usize; 2],
        [shoulder, neck]: [usize; 2],
        hollow: f64,
        sign: f64,
    ) -> Result<Sheet, GenerateError> {
        let edge = self.neck / self.shoulder;
        panel(lattice, |i, j| {
            let share = self.across(i, [shoulder, neck]);
            let deep = hollow * (1.0 - (share / edge).powi(2)).max(0.0);
            let x = if j <= below {
                self.below(share, mix(self.low(), self.underarm()[0], j as f64 / below as f64))
            } else {
                self.above(share, (j - below) as f64 / above as f64 * (1.0 - deep))
            };
            World3::new(sign * x.x, sign * x.y, x.z)
        })
    }
}

/// The vertices of a column.
fn column(sheet: usize, lattice: &Lattice, i: usize, rows: RangeInclusive<usize>) -> Chain {
    Chain::new(sheet, rows.map(|j| lattice.vertex(i, j)))
}

/// The vertices of the highest row.
fn top(sheet: usize, lattice: &Lattice, columns: RangeInclusive<usize>) -> Chain {
    Chain::new(sheet, columns.map(|i| lattice.vertex(i, lattice.cells[1])))
}

fn reversed(chain: Chain) -> Chain {
    Chain::new(chain.sheet, chain.vertices.into_iter().rev())
}

pub(super) fn dress(cell: f64) -> Result<Sheet, GenerateError> {
    let shape = &DRESS;
    let shoulder = cells(1.6 * (shape.shoulder - shape.neck), cell, 2);
    let neck = 2 * cells(1.3 * shape.neck, cell, 2);
    let columns = 2 * shoulder + neck;
    let rows = shape.rows(cell);
    let lattice = Lattice::new([columns, rows[0] + rows[1]])?;
    let front = shape.whole(&lattice, rows, [shoulder, neck], 0.60, 1.0)?;
    let back = shape.whole(&lattice, rows, [shoulder, neck], 0.45, -1.0)?;
    let across = |i: usize| shape.across(i, [shoulder, neck]);
    let (skirt_lattice, [skirt_front, skirt_back]) =
        skirt::panels(columns, cell, WAIST_OF_DRESS, across)?;
    let mut sheets = vec![front, back, skirt_front, skirt_back];
    lay_out(&mut sheets, 0.02);
    let side = |sheet, i| column(sheet, &lattice, i, 0..=rows[0]);
    let waist = |above: usize, below: usize| Seam {
        first: Chain::new(above, lattice.row(0)),
        second: Chain::new(below, skirt_lattice.row(skirt_lattice.cells[1])),
    };
    let shoulders = |a: usize, b: usize| Seam {
        first: top(a, &lattice, columns - shoulder..=columns),
        second: reversed(top(b, &lattice, 0..=shoulder)),
    };
    let mut seams = vec![
        Seam { first: side(0, columns), second: side(1, 0) },
        Seam { first: side(1, columns), second: side(0, 0) },
        shoulders(0, 1),
        shoulders(1, 0),
        waist(0, 2),
        waist(1, 3),
    ];
    seams.extend(skirt::side_seams(&skirt_lattice, 2, 3));
    let mut sewn = sew(&sheets, &seams)?;
    sewn.name_border("hem", &[2, 3].map(|s| Chain::new(s, skirt_lattice.row(0))));
    sewn.name_border("neck", &[0, 1].map(|s| top(s, &lattice, shoulder..=shoulder + neck)));
    let hole = |sheet, i| column(sheet, &lattice, i, rows[0]..=rows[0] + rows[1]);
    sewn.name_border("right-armhole", &[hole(0, columns), hole(1, 0)]);
    sewn.name_border("left-armhole", &[hole(1, columns), hole(0, 0)]);
    Ok(sewn.sheet)
}

/// How far the fronts of the jacket reach beyond the middle, as a share of half of the front (1).
const OVERLAP: f64 = 0.26;
/// How far the outer front lies before the inner one (m).
const BEFORE: f64 = 0.016;
/// Reach of the sleeves in x, and their size there over that at the shoulder (1).
const CUFF: f64 = 0.60;
const TAPER: f64 = 0.85;

/// A front of the jacket, `sign` 1 for the inner one at x > 0 and −1 for the outer one. Column 0 is at
/// the smaller x.
fn front(lattice: &Lattice, [below, above]: [usize; 2], sign: f64) -> Result<Sheet, GenerateError> {
    let shape = &JACKET;
    panel(lattice, |i, j| {
        let across = i as f64 / lattice.cells[0] as f64;
        // From the edge in the middle to the side.
        let across = if sign > 0.0 { across } else { 1.0 - across };
        let up = j.saturating_sub(below) as f64 / above as f64;
        let edge = mix(-OVERLAP, shape.neck / shape.shoulder, up);
        let share = mix(edge, 1.0, across);
        let mut x = if j <= below {
            shape.below(share, mix(shape.low(), shape.underarm()[0], j as f64 / below as f64))
        } else {
            shape.above(share, up)
        };
        if sign < 0.0 {
            // Back at the body where the fronts do not overlap any more.
            let near = ((0.75 - share.abs()) / (0.75 - OVERLAP)).clamp(0.0, 1.0);
            x.y -= BEFORE * near * near * (3.0 - 2.0 * near) * (1.0 - up);
        }
        World3::new(sign * x.x, x.y, x.z)
    })
}

pub(super) fn jacket(cell: f64) -> Result<Sheet, GenerateError> {
    let shape = &JACKET;
    let shoulder = cells(0.26, cell, 4);
    let neck = 2 * cells(1.2 * shape.neck, cell, 2);
    let columns = 2 * shoulder + neck;
    let rows = shape.rows(cell);
    let [below, above] = rows;
    let back_lattice = Lattice::new([columns, below + above])?;
    let front_lattice = Lattice::new([shoulder, below + above])?;
    let along = cells(CUFF - shape.shoulder, cell, 2);
    let sleeve_lattice = Lattice::new([along, 2 * above])?;
    let mut sheets = vec![
        shape.whole(&back_lattice, rows, [shoulder, neck], 0.30, -1.0)?,
        front(&front_lattice, rows, 1.0)?,
        front(&front_lattice, rows, -1.0)?,
    ];
    for sign in [1.0, -1.0] {
        sheets.push(panel(&sleeve_lattice, |i, j| {
            let out = i as f64 / along as f64;
            let size = mix(1.0, TAPER, out);
            // Two arcs, as the armhole: up over the front, down over the back.
            let turn = j as f64 / above as f64;
            let up = if turn <= 1.0 { turn } else { 2.0 - turn };
            let [low, high] = [shape.underarm()[0], shape.top];
            let z = 0.5 * (low + high) + (up - 0.5) * (high - low) * size;
            let y = -sign * shape.bulge * (PI * turn).sin() * size;
            World3::new(sign * mix(shape.shoulder, CUFF, out), y, z)
        })?);
    }
    lay_out(&mut sheets, 0.02);
    let whole = below + above;
    // Seen from the back, its first column is at x > 0.
    let back = |i: usize, rows| column(0, &back_lattice, i, rows);
    let outer = |sheet: usize, rows| {
        column(sheet, &front_lattice, if sheet == 1 { shoulder } else { 0 }, rows)
    };
    let shoulders = |sheet: usize| top(sheet, &front_lattice, 0..=shoulder);
    let around =
        |sheet: usize, rows: RangeInclusive<usize>| column(sheet, &sleeve_lattice, 0, rows);
    let under = |sheet: usize, j: usize| Chain::new(sheet, sleeve_lattice.row(j));
    // The sleeve at x > 0 goes from under the arm over the front and back over the back, the other
    // one the other way.
    let seams = [
        Seam { first: outer(1, 0..=below), second: back(0, 0..=below) },
        Seam { first: outer(2, 0..=below), second: back(columns, 0..=below) },
        Seam { first: shoulders(1), second: reversed(top(0, &back_lattice, 0..=shoulder)) },
        Seam {
            first: shoulders(2),
            second: reversed(top(0, &back_lattice, columns - shoulder..=columns)),
        },
        Seam { first: outer(1, below..=whole), second: around(3, 0..=above) },
        Seam { first: back(0, below..=whole), second: reversed(around(3, above..=2 * above)) },
        Seam { first: back(columns, below..=whole), second: around(4, 0..=above) },
        Seam { first: outer(2, below..=whole), second: reversed(around(4, above..=2 * above)) },
        Seam { first: under(3, 0), second: under(3, 2 * above) },
        Seam { first: under(4, 0), second: under(4, 2 * above) },
    ];
    let mut sewn = sew(&sheets, &seams)?;
    let lower = |sheet, lattice: &Lattice| Chain::new(sheet, lattice.row(0));
    sewn.name_border(
        "hem",
        &[lower(0, &back_lattice), lower(1, &front_lattice), lower(2, &front_lattice)],
    );
    sewn.name_border(
        "opening",
        &[
            column(1, &front_lattice, 0, 0..=whole),
            column(2, &front_lattice, shoulder, 0..=whole),
            top(0, &back_lattice, shoulder..=shoulder + neck),
        ],
    );
    for (name, sheet) in [("right-cuff", 3), ("left-cuff", 4)] {
        sewn.name_border(name, &[column(sheet, &sleeve_lattice, along, 0..=2 * above)]);
    }
    Ok(sewn.sheet)
}
