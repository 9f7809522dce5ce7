//! Forces on single vertices: gravity, mass-proportional damping, springs to handles.

use crate::element::Stiffness;
use crate::force::{Force, Stage};
use crate::part::Part;
use crate::solver::{BlockMatrix, BlockPattern, PatternBuilder, PatternError};
use mesh_core::{World3, par};
use nalgebra::Matrix3;

/// Gravity: −m g·x.
#[derive(Debug)]
pub struct Gravity {
    masses: Vec<f64>,
    acceleration: World3,
}

impl Gravity {
    /// Gravity of the given acceleration (m/s²) on lumped masses (kg).
    pub fn new(masses: Vec<f64>, acceleration: World3) -> Self {
        Gravity { masses, acceleration }
    }
}

impl Force for Gravity {
    fn name(&self) -> &'static str {
        "gravity"
    }

    fn couple(&self, _: &mut PatternBuilder) -> Result<(), PatternError> {
        Ok(())
    }

    fn bind(&mut self, _: &BlockPattern) {}

    fn begin(&mut self, _: Stage<'_>) {}

    fn predict(&mut self, _: &[World3], _: &[World3]) {}

    fn energy(&self, x: &[World3]) -> f64 {
        -par::sum(x.len(), |i| self.masses[i] * self.acceleration.dot(&x[i]))
    }

    fn add_gradient(&self, _: &[World3], gradient: &mut [World3]) {
        for (g, m) in gradient.iter_mut().zip(&self.masses) {
            *g -= self.acceleration * *m;
        }
    }

    fn add_system(&self, x: &[World3], _: Stiffness, gradient: &mut [World3], _: &mut BlockMatrix) {
        self.add_gradient(x, gradient);
    }

    fn part(&self, part: &Part) -> Option<Box<dyn Force>> {
        Some(Box::new(Gravity::new(part.gather(&self.masses), self.acceleration)))
    }
}

/// Damping proportional to mass: force −α m v, from the dissipation α m |x − base|²/2h.
#[derive(Debug)]
pub struct MassDamping {
    /// α m of every vertex (kg/s).
    rates: Vec<f64>,
    base: Vec<World3>,
    h: f64,
}

impl MassDamping {
    /// Damping with the given α m (kg/s); `None` if all are zero.
    pub fn new(rates: Vec<f64>) -> Option<Self> {
        let needed = rates.iter().any(|&r| r > 0.0);
        let base = vec![World3::zeros(); rates.len()];
        needed.then_some(MassDamping { rates, base, h: 1.0 })
    }
}

impl Force for MassDamping {
    fn name(&self) -> &'static str {
        "mass damping"
    }

    fn couple(&self, _: &mut PatternBuilder) -> Result<(), PatternError> {
        Ok(())
    }

    fn bind(&mut self, _: &BlockPattern) {}

    fn begin(&mut self, stage: Stage<'_>) {
        self.base.copy_from_slice(stage.base);
        self.h = stage.h;
    }

    fn predict(&mut self, _: &[World3], _: &[World3]) {}

    fn energy(&self, x: &[World3]) -> f64 {
        par::sum(x.len(), |i| self.rates[i] * (x[i] - self.base[i]).norm_squared()) / (2.0 * self.h)
    }

    fn add_gradient(&self, x: &[World3], gradient: &mut [World3]) {
        for (i, g) in gradient.iter_mut().enumerate() {
            *g += (x[i] - self.base[i]) * (self.rates[i] / self.h);
        }
    }

    fn add_system(
        &self,
        x: &[World3],
        _: Stiffness,
        gradient: &mut [World3],
        stiffness: &mut BlockMatrix,
    ) {
        self.add_gradient(x, gradient);
        for (i, rate) in self.rates.iter().enumerate() {
            *stiffness.diagonal_mut(i) += Matrix3::identity() * (rate / self.h);
        }
    }

    fn part(&self, part: &Part) -> Option<Box<dyn Force>> {
        let damping = MassDamping::new(part.gather(&self.rates));
        damping.map(|damping| Box::new(damping) as Box<dyn Force>)
    }
}

/// Springs that pull vertices to points: soft handles.
#[derive(Debug, Default)]
pub struct Springs {
    /// Vertex, where it should be (m), stiffness (N/m).
    pub springs: Vec<(u32, World3, f64)>,
}

impl Force for Springs {
    fn name(&self) -> &'static str {
        "springs"
    }

    fn couple(&self, _: &mut PatternBuilder) -> Result<(), PatternError> {
        Ok(())
    }

    fn bind(&mut self, _: &BlockPattern) {}

    fn begin(&mut self, _: Stage<'_>) {}

    fn predict(&mut self, _: &[World3], _: &[World3]) {}

    fn energy(&self, x: &[World3]) -> f64 {
        self.springs.iter().map(|&(i, p, k)| 0.5 * k * (x[i as usize] - p).norm_squared()).sum()
    }

    fn add_gradient(&self, x: &[World3], gradient: &mut [World3]) {
        for &(i, p, k) in &self.springs {
            gradient[i as usize] += (x[i as usize] - p) * k;
        }
    }

    fn add_system(
        &self,
        x: &[World3],
        _: Stiffness,
        gradient: &mut [World3],
        stiffness: &mut BlockMatrix,
    ) {
        self.add_gradient(x, gradient);
        for &(i, _, k) in &self.springs {
            *stiffness.diagonal_mut(i as usize) += Matrix3::identity() * k;
        }
    }

    fn part(&self, part: &Part) -> Option<Box<dyn Force>> {
        Some(Box::new(Springs::of(part, &self.springs)))
    }
}

impl Springs {
    /// Those of the springs that pull a vertex of the part which answers.
    pub(crate) fn of(part: &Part, springs: &[(u32, World3, f64)]) -> Springs {
        let here = springs.iter().filter(|(i, ..)| part.answers(*i as usize));
        let springs = here.map(|&(i, x, k)| (part.place(i as usize), x, k)).collect();
        Springs { springs }
    }
}
