//! Strips and the loop that brings them to rest.
#![allow(dead_code, unreachable_pub)]

use cloth_dynamics::law::{Bending, Membrane, Quadratic};
use cloth_dynamics::solver::{LinearSettings, SparseCholesky};
use cloth_dynamics::{
    BendingModel, Constraints, Damping, Environment, Fabric, ImplicitEuler, NewtonSettings,
    SolveReport, Step, System, TimeIntegrator,
};
use mesh_core::generate::{Diagonal, grid};
use mesh_core::{ClothState, World3};
use std::sync::Arc;

pub const G: f64 = 9.81;

/// An isotropic fabric without Poisson effect: membrane stiffness (N/m), rigidity (N m), density.
pub fn fabric(membrane: f64, rigidity: f64, density: f64) -> Fabric {
    Fabric {
        density,
        membrane: Membrane::Orthotropic(Quadratic::isotropic(membrane, 0.0).unwrap()),
        bending: (rigidity > 0.0)
            .then(|| Bending::Orthotropic(Quadratic::isotropic(rigidity, 0.0).unwrap())),
        bending_model: BendingModel::ShapeOperator,
        tension_field: false,
        strain_limits: None,
        damping: Damping::default(),
    }
}

/// A sheet of the given size (m) in the plane z = 0.
pub fn sheet(size: [f64; 2], cells: [usize; 2], diagonal: Diagonal, density: f64) -> ClothState {
    let sheet = grid(size, cells, diagonal).unwrap();
    ClothState::at_rest(sheet.mesh, sheet.positions, vec![density]).unwrap()
}

pub fn gravity() -> Environment {
    Environment { gravity: World3::new(0.0, 0.0, -G), wind: None }
}

pub const NOTHING: Environment = Environment { gravity: World3::new(0.0, 0.0, 0.0), wind: None };

/// Everything one needs to step a cloth.
pub struct Run {
    pub cloth: ClothState,
    pub system: System,
    pub solver: SparseCholesky,
    pub settings: NewtonSettings,
    pub time: f64,
}

impl Run {
    pub fn new(cloth: ClothState, fabric: Fabric, environment: &Environment) -> Run {
        let system = System::new(&cloth, &Arc::new(vec![fabric]), environment, 1.0).unwrap();
        let solver = SparseCholesky::new(LinearSettings::default());
        let settings = NewtonSettings { max_iterations: 100, tolerance: 1e-9 };
        Run { cloth, system, solver, settings, time: 0.0 }
    }

    pub fn step(
        &mut self,
        integrator: &mut dyn TimeIntegrator,
        h: f64,
        held: &dyn Fn(f64) -> Constraints,
    ) -> SolveReport {
        let step = Step { time: self.time, h };
        self.time += h;
        integrator
            .advance(
                &mut self.cloth,
                &mut self.system,
                &mut self.solver,
                held,
                &self.settings,
                step,
            )
            .unwrap()
    }

    /// Steps with strong damping until nothing moves any more.
    pub fn rest(&mut self, held: &Constraints, h: f64) {
        self.settings.tolerance = 1e-7;
        for _ in 0..4000 {
            self.step(&mut ImplicitEuler, h, &|_| held.clone());
            let fastest = self.cloth.v.iter().map(|v| v.norm()).fold(0.0, f64::max);
            if fastest < 1e-6 {
                return;
            }
            // Inertia is not wanted here: start every step from rest.
            self.cloth.v.fill(World3::zeros());
        }
        panic!("did not come to rest");
    }
}

/// Holds the vertices chosen by material position where they are.
pub fn hold(cloth: &ClothState, chosen: impl Fn(World3) -> bool) -> Constraints {
    let fixed = (0..).zip(&cloth.x).filter(|(_, x)| chosen(**x)).map(|(i, x)| (i, *x)).collect();
    Constraints { fixed, springs: Vec::new() }
}
