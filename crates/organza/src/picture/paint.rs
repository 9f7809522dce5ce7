//! What the colours of a picture show.

use super::sight::{Seen, Sight};
use cloth_dynamics::principal_stretches;
use io_mcap::OwnedGarment;
use mesh_core::{Material2, World3, geometry};

use crate::render::{Paint, Rgb, VIRIDIS};

/// Stretches at the ends of the colour scale (1).
pub const STRETCH_RANGE: [f64; 2] = [0.95, 1.05];

/// Sizes at the ends of the colour scale (m); its steps are factors.
pub const SIZE_RANGE_M: [f64; 2] = [0.005, 0.2];

/// Colours of what is seen from the front, from the back, and not at all.
const SEEN: [Rgb; 3] = [[66, 150, 96], [222, 150, 62], [120, 126, 148]];

/// Colour of the back of all garments.
const BACK: Rgb = [217, 182, 138];

/// What the colours of a picture show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Colouring {
    /// Each garment in its colour, the back in another. Particles in blue that move freely, in green
    /// in transition, in red at rest.
    #[default]
    Plain,
    /// The larger principal stretch of every triangle, from dark violet at [`STRETCH_RANGE`]'s start
    /// over green at rest to yellow at its end.
    Stretch,
    /// The size of every triangle, the side of a square of its area in the pattern, from dark violet at
    /// [`SIZE_RANGE_M`]'s start to yellow at its end.
    Size,
    /// The view factor of every triangle, from dark violet at 0 to yellow at 1.
    View,
    /// Green for what the scene's camera sees, orange for what faces away in its picture, grey for what
    /// is outside.
    Visibility,
    /// The speed of every particle, from dark violet at rest to yellow at the greatest of the recording.
    Speed,
    /// Who rests: triangles with a vertex of full dynamics blue, others with one in transition green,
    /// those that stand still red; grey where nothing is restrained.
    Restraint,
}

/// Colours of rest, of transition and of full dynamics, and where nothing is known.
const MOTIONS: [Rgb; 3] = [[190, 60, 55], [95, 160, 80], [70, 110, 190]];
const UNKNOWN: Rgb = [150, 150, 150];

/// The colours of one garment.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum OwnedPaint {
    Sides { front: Rgb },
    Triangles(Vec<Rgb>),
}

impl Colouring {
    /// `states` is what the vertices do, see
    /// [`RestraintSummary::states`](crate::report::RestraintSummary::states).
    pub(super) fn of(
        self,
        garment: &OwnedGarment,
        states: Option<&str>,
        frame: u64,
        sight: Option<&Sight>,
    ) -> OwnedPaint {
        match (self, sight) {
            (Colouring::View, Some(sight)) => {
                let factors = sight.factors(garment, frame);
                OwnedPaint::Triangles(factors.iter().map(|&v| VIRIDIS.colour(v)).collect())
            }
            (Colouring::Visibility, Some(sight)) => {
                let colour = |seen: &Seen| match seen {
                    Seen::Front => SEEN[0],
                    Seen::Back => SEEN[1],
                    Seen::Outside => SEEN[2],
                };
                OwnedPaint::Triangles(sight.seen(garment, frame).iter().map(colour).collect())
            }
            (Colouring::Size, _) => {
                let [low, high] = SIZE_RANGE_M.map(f64::ln);
                let size = |u: &[[f64; 2]; 3]| {
                    let [a, b, c] = u.map(Material2::from);
                    0.5 * (0.5 * (b - a).perp(&(c - a)).abs()).ln()
                };
                let colour = |u| VIRIDIS.colour_in(size(u), low, high);
                OwnedPaint::Triangles(garment.material.iter().map(colour).collect())
            }
            (Colouring::Restraint, _) => {
                let motions = |text| motions(text, garment.points.len());
                let motions = states.map(motions).unwrap_or_default();
                let most = |t: &[u32; 3]| {
                    let each = t.iter().map(|&i| motions.get(i as usize).copied());
                    each.collect::<Option<Vec<_>>>().and_then(|all| all.into_iter().max())
                };
                let colour = |t: &[u32; 3]| most(t).map_or(UNKNOWN, |motion| MOTIONS[motion]);
                OwnedPaint::Triangles(garment.triangles.iter().map(colour).collect())
            }
            (Colouring::Plain | Colouring::View | Colouring::Visibility | Colouring::Speed, _) => {
                let [r, g, b, _] = garment.color;
                // A float cast saturates: no colour can leave its range.
                OwnedPaint::Sides { front: [r, g, b].map(|c| (255.0 * c).round() as u8) }
            }
            (Colouring::Stretch, _) => {
                let [low, high] = STRETCH_RANGE;
                let colour = |stretch| VIRIDIS.colour_in(stretch, low, high);
                OwnedPaint::Triangles(stretches(garment).map(colour).collect())
            }
        }
    }
}

impl OwnedPaint {
    pub(super) fn borrowed(&self) -> Paint<'_> {
        match self {
            OwnedPaint::Sides { front } => Paint::Sides { front: *front, back: BACK },
            OwnedPaint::Triangles(colours) => Paint::Triangles(colours),
        }
    }
}

/// What every vertex does, as a place in [`MOTIONS`]; ends where the text is not understood.
fn motions(states: &str, n_vertices: usize) -> Vec<usize> {
    let mut all = Vec::new();
    let mut rest = states;
    while let Some(end) = rest.find(|c: char| !c.is_ascii_digit()) {
        let Some(motion) = rest[end..].chars().next().and_then(|letter| "rta".find(letter)) else {
            break;
        };
        let Ok(count) = rest[..end].parse::<usize>() else { break };
        if count > n_vertices - all.len() {
            break;
        }
        all.extend(std::iter::repeat_n(motion, count));
        rest = &rest[end + 1..];
    }
    all
}

/// The larger principal stretch of every triangle (1); not a number where the material triangle has
/// no area.
fn stretches(garment: &OwnedGarment) -> impl Iterator<Item = f64> + '_ {
    garment.triangles.iter().zip(&garment.material).map(|(t, u)| {
        let x = t.map(|v| World3::from(garment.points[v as usize]));
        let inverse = geometry::inverse_edges(u.map(Material2::from));
        if !inverse.iter().all(|entry| entry.is_finite()) {
            return f64::NAN;
        }
        let ([high, _], _) = principal_stretches(&geometry::gradient(x, &inverse));
        high
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretch_is_that_of_the_triangle() {
        let mut garment = OwnedGarment {
            name: "a".into(),
            points: vec![[0.0, 0.0, 1.0], [0.0, 1.1, 1.0], [2.0, 0.0, 1.0]],
            triangles: vec![[0, 1, 2]],
            material: vec![[[0.0, 0.0], [1.0, 0.0], [0.0, 2.0]]],
            color: [1.0; 4],
        };
        let stretch: Vec<f64> = stretches(&garment).collect();
        assert!((stretch[0] - 1.1).abs() < 1e-15, "{stretch:?}");
        assert_eq!(
            Colouring::Stretch.of(&garment, None, 0, None),
            OwnedPaint::Triangles(vec![VIRIDIS.colour(1.0)])
        );
        garment.material[0][2] = [2.0, 0.0];
        assert!(stretches(&garment).all(f64::is_nan));
        assert_eq!(
            Colouring::Stretch.of(&garment, None, 0, None),
            OwnedPaint::Triangles(vec![VIRIDIS.undefined])
        );
    }
}
