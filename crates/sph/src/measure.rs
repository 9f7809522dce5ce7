//! How far two runs of a scene are apart: figures that do not follow single particles, since in a
//! splash these part after a short time whatever one does.

use crate::fluid::Fluid;
use crate::settings::Bounds;
use nalgebra::Vector3;

/// Spacings along an edge of the cells in which densities and heights are taken (1).
const CELL: f64 = 4.0;

/// A fluid at one time, as a whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation {
    /// Mass per volume in each cell of a lattice over some bounds, by the rest density (1).
    pub density: Vec<f64>,
    /// Centre of mass (m).
    pub centre: Vector3<f64>,
    /// Energy of the effective motion (J).
    pub kinetic: f64,
    /// Height of the highest particle over each column of cells (m); the floor where there is none.
    pub height: Vec<f64>,
}

/// How far two observations are apart.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// Root of the mean square over all cells that are not empty in both (1).
    pub density: f64,
    /// Distance of the centres of mass (m).
    pub centre: f64,
    /// Difference of the kinetic energies (J).
    pub kinetic: f64,
    /// Root of the mean square over all columns (m).
    pub height: f64,
}

impl Observation {
    /// Looks at a fluid within some bounds. Particles outside count for the sums only.
    pub fn new<R>(fluid: &Fluid<R>, bounds: &Bounds) -> Self {
        let settings = fluid.settings();
        let cell = CELL * settings.spacing;
        let n = [0, 1, 2].map(|k| (bounds.size()[k] / cell).ceil().max(1.0) as usize);
        let mut density = vec![0.0; n[0] * n[1] * n[2]];
        let mut height = vec![bounds.min.z; n[0] * n[1]];
        let (mut centre, mut kinetic) = (Vector3::zeros(), 0.0);
        let share = fluid.particle_mass() / (cell * cell * cell * settings.rest_density);
        for particle in fluid.particles() {
            let x = particle.position;
            centre += x;
            kinetic += 0.5 * fluid.particle_mass() * particle.effective_velocity.norm_squared();
            if bounds.contains(&x) {
                let at = [0, 1, 2].map(|k| (((x - bounds.min)[k] / cell) as usize).min(n[k] - 1));
                density[(at[2] * n[1] + at[1]) * n[0] + at[0]] += share;
                let height = &mut height[at[1] * n[0] + at[0]];
                *height = height.max(x.z);
            }
        }
        Observation { density, centre: centre / fluid.len().max(1) as f64, kinetic, height }
    }

    /// The difference of two observations within the same bounds.
    pub fn difference(&self, other: &Observation) -> Difference {
        let cells = || self.density.iter().zip(&other.density);
        let filled = cells().filter(|&(a, b)| *a > 0.0 || *b > 0.0).count().max(1) as f64;
        let density: f64 = cells().map(|(a, b)| (a - b) * (a - b)).sum();
        let heights = self.height.iter().zip(&other.height);
        let height: f64 = heights.map(|(a, b)| (a - b) * (a - b)).sum();
        Difference {
            density: (density / filled).sqrt(),
            centre: (self.centre - other.centre).norm(),
            kinetic: (self.kinetic - other.kinetic).abs(),
            height: (height / self.height.len().max(1) as f64).sqrt(),
        }
    }
}

impl Difference {
    /// Adds the squares of another difference, for a mean over time: start from zero, and end with
    /// [`Difference::root_of_mean`].
    pub fn add_squares(&mut self, other: &Difference) {
        self.density += other.density * other.density;
        self.centre += other.centre * other.centre;
        self.kinetic += other.kinetic * other.kinetic;
        self.height += other.height * other.height;
    }

    /// The root of a mean of `n` squares.
    pub fn root_of_mean(&self, n: usize) -> Difference {
        let root = |sum: f64| (sum / n.max(1) as f64).sqrt();
        Difference {
            density: root(self.density),
            centre: root(self.centre),
            kinetic: root(self.kinetic),
            height: root(self.height),
        }
    }

    /// The largest quotient of two differences, metric by metric (1).
    pub fn over(&self, floor: &Difference) -> f64 {
        let quotients = [
            self.density / floor.density,
            self.centre / floor.centre,
            self.kinetic / floor.kinetic,
            self.height / floor.height,
        ];
        quotients.into_iter().fold(0.0, f64::max)
    }
}
