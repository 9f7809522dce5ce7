//! A skirt of several equal panels.

use super::lattice::Lattice;
use super::limits::{MAX_SIZE, check_below, check_count, check_size, check_triangles};
use super::sew::{Chain, Seam, lay_out, sew};
use super::{Diagonal, GenerateError, Sheet};
use crate::geometry::{Material2, World3};
use std::f64::consts::{PI, TAU};

/// The measures of a [`skirt`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skirt {
    /// Radius at the waist (m).
    pub waist_radius: f64,
    /// Radius at the hem (m).
    pub hem_radius: f64,
    /// Length along the cloth from waist to hem (m).
    pub length: f64,
    /// Number of panels.
    pub panels: usize,
    /// Cells around in each panel.
    pub around: usize,
    /// Cells from waist to hem.
    pub along: usize,
}

impl Default for Skirt {
    /// Six flared panels for an adult.
    fn default() -> Self {
        Skirt { waist_radius: 0.12, hem_radius: 0.4, length: 0.65, panels: 6, around: 4, along: 12 }
    }
}

/// A skirt around the z axis, the waist at z = 0 and the hem below: `panels` equal panels sewn side
/// to side, numbered around. The vertices lie on a cone; the facets between them are flat, and every
/// panel is its part of the facets unrolled into a sector of a ring, so that the cloth is at rest to
/// rounding. Panels lie side by side in material space, v pointing from hem to waist in their
/// middle; normals point outwards. The hem may be narrower than the waist. Borders: `hem`, `waist`.
///
/// # Errors
/// If a length is not positive, finite and within the limits; if the radii differ by more than the
/// length, which no flat cloth can span; if there are no panels, no cells, fewer than three cells
/// around in all, or too many.
pub fn skirt(skirt: &Skirt) -> Result<Sheet, GenerateError> {
    let Skirt { waist_radius, hem_radius, length, panels, around, along } = *skirt;
    check_size("radius of the waist", waist_radius)?;
    check_below("radius of the hem", hem_radius, (waist_radius + length).min(MAX_SIZE))?;
    check_below("length of the skirt", length, MAX_SIZE)?;
    if waist_radius - hem_radius > length {
        let (what, max) = ("radius of the waist", hem_radius + length);
        return Err(GenerateError::Size { what, value: waist_radius, min: super::MIN_SIZE, max });
    }
    check_count("panels of the skirt", panels, 1)?;
    check_triangles(&[2, panels, around, along])?;
    check_count("cells around the skirt", panels * around, 3)?;
    let lattice = Lattice::new([around, along])?;

    // Along the edges of the facets the radius grows by κ per length; a facet's sides meet at the
    // angle β, of which the middle of the panel is the bisector.
    let kappa = (hem_radius - waist_radius) / length;
    let drop = ((1.0 - kappa) * (1.0 + kappa)).sqrt();
    let half_facet = (PI / (panels * around) as f64).sin();
    let beta = 2.0 * (kappa * half_facet).asin();
    let slant = |j: usize| length * (along - j) as f64 / along as f64;
    let unrolled = |i: usize, j: usize| {
        let (s, from_middle) = (slant(j), i as f64 - 0.5 * around as f64);
        let r = waist_radius + kappa * s;
        if kappa.abs() < 1e-14 {
            return Material2::new(r * 2.0 * half_facet * from_middle, -s);
        }
        // Polar coordinates of radius r/κ and angle ψ around the tip of the cone, taken from the
        // middle of the waist without the difference of large numbers.
        let psi = from_middle * beta;
        let half_sine = (0.5 * psi).sin();
        Material2::new(r * psi.sin() / kappa, 2.0 * r * half_sine * half_sine / kappa - s)
    };
    let mut sheets = Vec::with_capacity(panels);
    for panel in 0..panels {
        sheets.push(lattice.sheet(Diagonal::Alternating, unrolled, |i, j| {
            let (s, column) = (slant(j), (panel * around + i) % (panels * around));
            let (sine, cosine) = (TAU * column as f64 / (panels * around) as f64).sin_cos();
            let r = waist_radius + kappa * s;
            World3::new(r * cosine, r * sine, -drop * s)
        })?);
    }
    lay_out(&mut sheets, 0.05 * length);
    let side = |panel: usize, i: usize| Chain::new(panel, lattice.column(i));
    let seams: Vec<Seam> = (0..panels)
        .map(|p| Seam { first: side(p, around), second: side((p + 1) % panels, 0) })
        .collect();
    let mut sewn = sew(&sheets, &seams)?;
    for (name, j) in [("hem", 0), ("waist", along)] {
        let rows: Vec<Chain> = (0..panels).map(|p| Chain::new(p, lattice.row(j))).collect();
        sewn.name_border(name, &rows);
    }
    Ok(sewn.sheet)
}
