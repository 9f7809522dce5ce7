//! Garments of a front and a back: tunic and poncho.

use super::lattice::Lattice;
use super::limits::{cells_along, check_below, check_size, check_triangles};
use super::sew::{Chain, Seam, lay_out, sew};
use super::{Diagonal, GenerateError, MAX_SIZE, Sheet};
use crate::geometry::{Material2, World3};
use crate::ids::VertexId;

/// The measures of a [`tunic`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tunic {
    /// Width of front and back from the shoulders to the underarm (m).
    pub width: f64,
    /// Width of front and back at the hem (m).
    pub hem_width: f64,
    /// Length from the shoulders to the hem (m).
    pub length: f64,
    /// Depth of the armholes below the shoulders (m).
    pub armhole: f64,
    /// Width of the neck opening (m).
    pub neck_width: f64,
    /// Depth of the neckline in front and back (m), both may be zero.
    pub neck_depth: [f64; 2],
    /// Length of the sleeves (m); without it the armholes stay open.
    pub sleeve: Option<f64>,
    /// Wanted length of the mesh edges (m).
    pub cell: f64,
}

impl Default for Tunic {
    /// A tunic with half-long sleeves for an adult.
    fn default() -> Self {
        Tunic {
            width: 0.6,
            hem_width: 0.7,
            length: 0.8,
            armhole: 0.22,
            neck_width: 0.26,
            neck_depth: [0.08, 0.02],
            sleeve: Some(0.3),
            cell: 0.03,
        }
    }
}

/// A tunic that lies flat as if on a table set upright: front (panel 0) and back (panel 1) in the
/// planes y < 0 and y > 0, sewn at the shoulders and below the armholes at the sides, and sleeves
/// (panels 2 at x > 0 and 3 at x < 0) folded at the shoulder, sewn into the armholes and to
/// themselves under the arm. The shoulders lie at z = 0, the hem below, x = 0 in the middle; normals
/// point outwards. Borders: `hem`, `neck`, and at x > 0, on the right as seen from the front, and
/// x < 0 `right-cuff` and `left-cuff`, or without sleeves `right-armhole` and `left-armhole`.
///
/// A gap of a tenth of the shortest cell keeps the two layers apart, so the cells at seams and folds
/// are longer than at rest by up to 0.2 %; all others are at rest to rounding.
///
/// # Errors
/// If a length is not positive, finite and within the limits, if the armholes are deeper than the
/// garment is long, the neck wider than the garment or the neckline deeper than half of it, or if
/// there would be too many triangles.
pub fn tunic(tunic: &Tunic) -> Result<Sheet, GenerateError> {
    check_size("cell size of the tunic", tunic.cell)?;
    check_size("length of the tunic", tunic.length)?;
    check_below("depth of the armholes", tunic.armhole, 0.999 * tunic.length)?;
    if let Some(sleeve) = tunic.sleeve {
        check_size("length of the sleeves", sleeve)?;
    }
    let body = Body::new(*tunic)?;
    let mut sheets = body.sheets()?;
    let mut seams = body.shoulder_seams();
    let mut borders = vec![("hem", body.hem().into()), ("neck", body.neck().into())];
    for side in 0..2 {
        seams.push(body.side_seam(side));
        if let Some((sleeve, sheet)) = body.sleeve(side)? {
            let cuff = Chain::new(sheets.len(), sleeve.column(sleeve.cells[0]));
            borders.push((["right-cuff", "left-cuff"][side], vec![cuff]));
            seams.extend(body.sleeve_seams(side, sleeve, sheets.len()));
            sheets.push(sheet);
        } else {
            borders.push((["right-armhole", "left-armhole"][side], body.armhole(side).into()));
        }
    }
    lay_out(&mut sheets, tunic.cell);
    let mut sewn = sew(&sheets, &seams)?;
    borders.iter().for_each(|(name, parts)| sewn.name_border(name, parts));
    Ok(sewn.sheet)
}

/// A poncho: front (panel 0) and back (panel 1), rectangles of `width` by `length` (m) sewn at the
/// shoulders beside a slit of `neck_width` (m) for the neck, of about `cell` (m) long mesh edges. It
/// hangs as a [`tunic`] does. Borders: `neck`, and `outline` all around.
///
/// # Errors
/// If a length is not positive, finite and within the limits, the neck is wider than the garment, or
/// there would be too many triangles.
pub fn poncho(width: f64, length: f64, neck_width: f64, cell: f64) -> Result<Sheet, GenerateError> {
    check_size("cell size of the poncho", cell)?;
    check_size("length of the poncho", length)?;
    let body = Body::new(Tunic {
        width,
        hem_width: width,
        length,
        armhole: 0.5 * length,
        neck_width,
        neck_depth: [0.0; 2],
        sleeve: None,
        cell,
    })?;
    let mut sheets = body.sheets()?;
    lay_out(&mut sheets, cell);
    let mut sewn = sew(&sheets, &body.shoulder_seams())?;
    sewn.name_border("neck", &body.neck());
    let [columns, rows] = body.lattice.cells;
    let sides = [0, 1].map(|layer| [0, columns].map(|i| body.column(layer, i, 0..=rows)));
    sewn.name_border("outline", &[&body.hem()[..], &sides.concat()].concat());
    Ok(sewn.sheet)
}

/// The right side is x > 0; there the front's last column meets the back's first. Seen from the
/// back, left is right: so side 0 is (front, back) and side 1 is (back, front).
const SIDES: [[usize; 2]; 2] = [[0, 1], [1, 0]];

/// Front and back: the same lattice, mirrored in x.
struct Body {
    measures: Tunic,
    lattice: Lattice,
    /// Columns of one shoulder and of the neck.
    shoulder: usize,
    neck: usize,
    /// Rows below and beside the armholes.
    below: usize,
    beside: usize,
    /// Distance between the layers (m).
    gap: f64,
}

impl Body {
    fn new(measures: Tunic) -> Result<Self, GenerateError> {
        let Tunic { width, length, armhole, neck_width, cell, .. } = measures;
        check_size("width of the garment", width)?;
        check_size("width of the hem", measures.hem_width)?;
        check_below("width of the neck", neck_width, 0.999 * width)?;
        for depth in measures.neck_depth {
            if !(0.0..=0.5 * length).contains(&depth) {
                let (what, max) = ("depth of the neckline", 0.5 * length);
                return Err(GenerateError::Size { what, value: depth, min: 0.0, max });
            }
        }
        check_below("cell size of the garment", cell, MAX_SIZE)?;
        let shoulder_width = 0.5 * (width - neck_width);
        let shoulder = cells_along(shoulder_width, cell, 1);
        // An opening of a single cell on each layer would fall shut.
        let neck = cells_along(neck_width, cell, 2);
        let beside = cells_along(armhole, cell, 2);
        let below = cells_along(length - armhole, cell, 1);
        let columns = neck.saturating_add(shoulder.saturating_mul(2));
        check_triangles(&[2, columns, below.saturating_add(beside)])?;
        let lattice = Lattice::new([columns, below + beside])?;
        let shortest = [
            shoulder_width / shoulder as f64,
            neck_width / neck as f64,
            (length - armhole) / below as f64,
            0.5 * armhole / beside as f64,
        ];
        let gap = 0.1 * shortest.into_iter().fold(cell, f64::min);
        Ok(Body { measures, lattice, shoulder, neck, below, beside, gap })
    }

    /// Front and back in material space; the world's x and z are their u and v, mirrored behind.
    fn sheets(&self) -> Result<Vec<Sheet>, GenerateError> {
        let sheet = |(layer, depth): (usize, f64)| {
            let sign = if layer == 0 { 1.0 } else { -1.0 };
            self.lattice.sheet(
                Diagonal::Alternating,
                |i, j| self.outline(i, j, depth),
                |i, j| {
                    let u = self.outline(i, j, depth);
                    World3::new(sign * u.x, -0.5 * sign * self.gap, u.y)
                },
            )
        };
        self.measures.neck_depth.into_iter().enumerate().map(sheet).collect()
    }

    /// Material coordinates of a body panel with the given depth of its neckline (m).
    fn outline(&self, i: usize, j: usize, neck_depth: f64) -> Material2 {
        let Tunic { width, hem_width, length, armhole, neck_width, .. } = self.measures;
        let half_neck = 0.5 * neck_width;
        let shoulder_cell = (0.5 * width - half_neck) / self.shoulder as f64;
        // Counted from the middle so that both halves are the same bits.
        let from_middle = i as f64 - 0.5 * (2 * self.shoulder + self.neck) as f64;
        let in_neck = 0.5 * self.neck as f64;
        let x = if from_middle.abs() <= in_neck {
            half_neck * from_middle / in_neck
        } else {
            (half_neck + shoulder_cell * (from_middle.abs() - in_neck)) * from_middle.signum()
        };
        let above_hem = if j <= self.below {
            (length - armhole) * j as f64 / self.below as f64
        } else {
            length - armhole * (self.lattice.cells[1] - j) as f64 / self.beside as f64
        };
        // Flared from the underarm down to the hem.
        let down = (1.0 - above_hem / (length - armhole)).max(0.0);
        let spread = 1.0 + (hem_width / width - 1.0) * down;
        // The neckline is a parabola; the rows below follow it less and less.
        let hollow = neck_depth * (1.0 - (x / half_neck).powi(2)).max(0.0);
        Material2::new(x * spread, above_hem * (1.0 - hollow / length) - length)
    }

    fn column(&self, layer: usize, i: usize, rows: std::ops::RangeInclusive<usize>) -> Chain {
        Chain::new(layer, rows.map(|j| self.lattice.vertex(i, j)))
    }

    /// The lowest row of front and back.
    fn hem(&self) -> [Chain; 2] {
        [0, 1].map(|layer| Chain::new(layer, self.lattice.row(0)))
    }

    /// The highest row of front and back between the shoulders.
    fn neck(&self) -> [Chain; 2] {
        let top = self.lattice.cells[1];
        let columns = self.shoulder..=self.shoulder + self.neck;
        [0, 1].map(|layer| Chain::new(layer, columns.clone().map(|i| self.lattice.vertex(i, top))))
    }

    /// The edges of front and back beside an arm.
    fn armhole(&self, side: usize) -> [Chain; 2] {
        let ([a, b], [last, top]) = (SIDES[side], self.lattice.cells);
        [(a, last), (b, 0)].map(|(layer, i)| self.column(layer, i, self.below..=top))
    }

    fn shoulder_seams(&self) -> Vec<Seam> {
        let [columns, top] = self.lattice.cells;
        let on_top = |i| self.lattice.vertex(i, top);
        let seam = |[a, b]: [usize; 2]| Seam {
            first: Chain::new(a, (0..=self.shoulder).map(|k| on_top(columns - k))),
            second: Chain::new(b, (0..=self.shoulder).map(on_top)),
        };
        SIDES.map(seam).into()
    }

    fn side_seam(&self, side: usize) -> Seam {
        let ([a, b], last) = (SIDES[side], self.lattice.cells[0]);
        Seam {
            first: self.column(a, last, 0..=self.below),
            second: self.column(b, 0, 0..=self.below),
        }
    }

    /// A sleeve: u along the arm from the armhole, v around it from the underarm over the shoulder
    /// and back, so that its first half lies beside the first panel of its side.
    fn sleeve(&self, side: usize) -> Result<Option<(Lattice, Sheet)>, GenerateError> {
        let Tunic { width, armhole, sleeve: Some(length), cell, .. } = self.measures else {
            return Ok(None);
        };
        let along = cells_along(length, cell, 1);
        let lattice = Lattice::new([along, 2 * self.beside])?;
        let arm = |i: usize| length * i as f64 / along as f64;
        let around = |j: usize| armhole * j as f64 / self.beside as f64;
        let gap = self.gap.min(0.1 * length / along as f64);
        let turn = if side == 0 { 1.0 } else { -1.0 };
        let sheet = lattice.sheet(
            Diagonal::Alternating,
            |i, j| Material2::new(arm(i), around(j)),
            |i, j| {
                let (y, rows_down) = match j.cmp(&self.beside) {
                    std::cmp::Ordering::Less => (-0.5 * gap, self.beside - j),
                    std::cmp::Ordering::Equal => (0.0, 0),
                    std::cmp::Ordering::Greater => (0.5 * gap, j - self.beside),
                };
                World3::new(turn * (0.5 * width + arm(i)), turn * y, -around(rows_down))
            },
        )?;
        Ok(Some((lattice, sheet)))
    }

    fn sleeve_seams(&self, side: usize, sleeve: Lattice, sheet: usize) -> [Seam; 3] {
        let [front, back] = self.armhole(side);
        let [along, around] = sleeve.cells;
        let chain = |vertices: Vec<VertexId>| Chain { sheet, vertices };
        let end = |j: usize| sleeve.vertex(0, j);
        let under = |j: usize| chain((0..=along).map(|i| sleeve.vertex(i, j)).collect());
        [
            Seam { first: front, second: chain((0..=self.beside).map(end).collect()) },
            Seam {
                first: back,
                second: chain((0..=self.beside).map(|k| end(around - k)).collect()),
            },
            Seam { first: under(0), second: under(around) },
        ]
    }
}
