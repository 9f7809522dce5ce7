//! Wind: pressure along the normal and drag along the surface.
//!
//! The force on a triangle of world area A with relative velocity u = v − v_wind is
//! −A (ρ |u_n| u_n n + c u_t) (the law of ARCSim, twice the textbook's ½ρ). In a step it is the
//! gradient of the dissipation h A (ρ |u_n|³/3 + ½ c |u_t|²), with A and n taken from the start of
//! the stage: convex in the new positions, hence unconditionally stable.

use crate::element::{ElementModel, ElementSystem, Stiffness};
use crate::force::Stage;
use mesh_core::{World3, geometry, par};
use nalgebra::Matrix3;

/// A steady wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wind {
    /// Velocity of the air (m/s).
    pub velocity: World3,
    /// Density of the air (kg/m³).
    pub density: f64,
    /// Drag along the surface (kg/(m² s)).
    pub drag: f64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Sail {
    /// Unit normal, zero if degenerate.
    normal: World3,
    /// World area (m²).
    area: f64,
}

/// Wind on all triangles.
#[derive(Debug)]
pub struct WindModel {
    stencils: Vec<[u32; 3]>,
    wind: Wind,
    sails: Vec<Sail>,
    /// Mean of the corners' velocity base (m).
    base: Vec<World3>,
    h: f64,
}

impl WindModel {
    /// Wind on the given triangles.
    pub fn new(triangles: &[[u32; 3]], wind: Wind) -> Self {
        let n = triangles.len();
        WindModel {
            stencils: triangles.to_vec(),
            wind,
            sails: vec![Sail::default(); n],
            base: vec![World3::zeros(); n],
            h: 1.0,
        }
    }

    /// Relative velocity of the triangle: along the normal, and along the surface.
    fn relative(&self, e: usize, x: &[World3; 3]) -> (f64, World3) {
        let v = ((x[0] + x[1] + x[2]) / 3.0 - self.base[e]) / self.h;
        let u = v - self.wind.velocity;
        let n = self.sails[e].normal;
        let along = u.dot(&n);
        (along, u - n * along)
    }
}

impl ElementModel<3> for WindModel {
    fn name(&self) -> &'static str {
        "wind"
    }

    fn stencils(&self) -> &[[u32; 3]] {
        &self.stencils
    }

    fn begin(&mut self, stage: Stage<'_>) {
        self.h = stage.h;
        let stencils = &self.stencils;
        par::fill(&mut self.sails, |e| {
            let [a, b, c] = stencils[e].map(|i| stage.x_t0[i as usize]);
            let vector = geometry::area_vector(a, b, c);
            let area = vector.norm();
            let normal = if area > 0.0 { vector / area } else { World3::zeros() };
            Sail { normal, area }
        });
        par::fill(&mut self.base, |e| {
            let [a, b, c] = stencils[e].map(|i| stage.base[i as usize]);
            (a + b + c) / 3.0
        });
    }

    fn predict(&mut self, _: &[World3], _: &[World3]) {}

    fn energy(&self, e: usize, x: &[World3; 3]) -> f64 {
        let (n, t) = self.relative(e, x);
        let rate =
            self.wind.density * n.abs().powi(3) / 3.0 + 0.5 * self.wind.drag * t.norm_squared();
        self.h * self.sails[e].area * rate
    }

    fn gradient(&self, e: usize, x: &[World3; 3]) -> [World3; 3] {
        let (n, t) = self.relative(e, x);
        let sail = &self.sails[e];
        let pressure = sail.normal * (self.wind.density * n.abs() * n) + t * self.wind.drag;
        [pressure * (sail.area / 3.0); 3]
    }

    fn system(&self, e: usize, x: &[World3; 3], _: Stiffness, out: &mut ElementSystem<3>) {
        let (n, _) = self.relative(e, x);
        let sail = &self.sails[e];
        let nn = sail.normal * sail.normal.transpose();
        let k = nn * (2.0 * self.wind.density * n.abs() - self.wind.drag)
            + Matrix3::identity() * self.wind.drag;
        out.active = true;
        out.gradient = self.gradient(e, x);
        out.stiffness = [[k * (sail.area / (9.0 * self.h)); 3]; 3];
    }

    fn part(&self, _: &[u32], stencils: Vec<[u32; 3]>) -> Self {
        WindModel::new(&stencils, self.wind)
    }
}
