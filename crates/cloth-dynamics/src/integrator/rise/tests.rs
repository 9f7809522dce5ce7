//! Energy that impacts leave is taken back where they are, and momentum stays.

use super::*;
use crate::fabric::{BendingModel, Damping, Fabric};
use crate::law::{Bending, Membrane, Quadratic};
use crate::system::Environment;
use mesh_core::generate::{Diagonal, grid};
use std::sync::Arc;

const STEP: Step = Step { time: 0.0, h: 0.04 };

fn free(_: f64) -> Constraints {
    Constraints::default()
}

/// A sheet that flies, spins and flutters, and where a step leads that dents it: its end (positions and
/// velocities) and what was bent.
struct Dented {
    cloth: ClothState,
    system: System,
    x: Vec<World3>,
    v: Vec<World3>,
    bent: Vec<u32>,
}

/// By `depth` (m) in a corner.
fn dented(depth: f64) -> Dented {
    let sheet = grid([1.0, 1.0], [20, 20], Diagonal::Alternating).unwrap();
    let mut cloth = ClothState::at_rest(sheet.mesh, sheet.positions, vec![0.2]).unwrap();
    for (x, v) in cloth.x.iter().zip(&mut cloth.v) {
        let flutter = World3::new(0.0, 0.0, (20.0 * x.x).sin() * (20.0 * x.y).cos());
        *v = World3::new(1.0, -2.0, 0.5) + World3::new(0.2, 0.1, 1.0).cross(x) + flutter;
    }
    let fabric = Fabric {
        density: 0.2,
        membrane: Membrane::Orthotropic(Quadratic::isotropic(500.0, 0.2).unwrap()),
        bending: Some(Bending::Orthotropic(Quadratic::isotropic(1e-5, 0.0).unwrap())),
        bending_model: BendingModel::ShapeOperator,
        tension_field: false,
        strain_limits: None,
        damping: Damping::default(),
    };
    let nothing = Environment { gravity: World3::zeros(), wind: None };
    let system = System::new(&cloth, &Arc::new(vec![fabric]), &nothing, STEP.h).unwrap();
    let v = cloth.v.clone();
    // Along its own rigid way, but for the dent.
    let motion = RigidMotion::of(&all(&cloth), &cloth.m, &cloth.x, &cloth.v);
    let turn = nalgebra::Rotation3::new(motion.spin * STEP.h);
    let mut x: Vec<World3> = cloth.x.clone();
    for x in &mut x {
        *x = motion.centre + motion.velocity * STEP.h + turn * (*x - motion.centre);
    }
    let corner = cloth.x[0];
    let is_near = |i: &u32| (cloth.x[*i as usize] - corner).norm() < 0.12;
    let bent: Vec<u32> = (0..x.len() as u32).filter(is_near).collect();
    assert!((3..20).contains(&bent.len()), "{bent:?}");
    bent.iter().for_each(|&i| x[i as usize].x += depth);
    Dented { cloth, system, x, v, bent }
}

fn all(cloth: &ClothState) -> Vec<u32> {
    (0..cloth.x.len() as u32).collect()
}

impl Dented {
    fn take_back(&mut self, constraints: &dyn Fn(f64) -> Constraints) -> Result<(), SolveError> {
        let Dented { cloth, system, x, v, bent } = self;
        take_back(system, cloth, StepEnd { x, v, bent }, constraints, STEP)
    }

    fn energy(&mut self, x: &[World3], v: &[World3]) -> f64 {
        let own = v.iter().zip(&self.cloth.m).map(|(v, m)| 0.5 * m * v.norm_squared());
        own.sum::<f64>() + self.system.energy_at_rest(x)
    }

    /// Energy at start and end (J).
    fn energies(&mut self) -> [f64; 2] {
        let (x, v) = (self.cloth.x.clone(), self.cloth.v.clone());
        let start = self.energy(&x, &v);
        let (x, v) = (self.x.clone(), self.v.clone());
        [start, self.energy(&x, &v)]
    }

    /// Momentum and angular momentum at the end.
    fn momenta(&self) -> [World3; 2] {
        let of = |i: usize| self.v[i] * self.cloth.m[i];
        let n = self.x.len();
        [(0..n).map(of).sum(), (0..n).map(|i| self.x[i].cross(&of(i))).sum()]
    }
}

#[test]
fn what_impacts_strain_is_taken_from_the_motion_around() {
    let mut step = dented(5e-4);
    let (before, momenta) = (step.v.clone(), step.momenta());
    let [start, end] = step.energies();
    assert!(end > start + 1e-4, "{start} {end}");
    step.take_back(&free).unwrap();
    let [_, after] = step.energies();
    assert!((after - start).abs() < 1e-12, "{start} {end} {after}");
    for (a, b) in momenta.iter().zip(step.momenta()) {
        assert!((a - b).norm() < 1e-12 * (1.0 + a.norm()), "{a} {b}");
    }
    // Only around the dent.
    let (corner, far) = (step.x[0], 0.6);
    let moved = |i: usize| step.v[i] != before[i];
    assert!((0..before.len()).any(moved));
    assert!((0..before.len()).filter(|&i| (step.x[i] - corner).norm() > far).all(|i| !moved(i)));
}

#[test]
fn where_too_little_moves_a_shorter_step_is_asked_for() {
    let mut step = dented(0.02);
    let [start, end] = step.energies();
    assert!(end > start + 0.02);
    step.system.accept_rise(false);
    let before = step.v.clone();
    assert!(matches!(step.take_back(&free), Err(SolveError::Rise { .. })));
    assert_eq!(step.v, before);
    // If that does not help, what there is is taken, and no momentum.
    step.system.accept_rise(true);
    let momenta = step.momenta();
    step.take_back(&free).unwrap();
    let [_, after] = step.energies();
    assert!(after < end - 1e-4, "{end} {after}");
    for (a, b) in momenta.iter().zip(step.momenta()) {
        assert!((a - b).norm() < 1e-12 * (1.0 + a.norm()), "{a} {b}");
    }
}

#[test]
fn what_is_driven_or_not_bent_stays() {
    let mut step = dented(5e-4);
    let before = step.v.clone();
    let held = |time: f64| Constraints {
        fixed: vec![(400, World3::new(time, 0.0, 0.0))],
        springs: Vec::new(),
    };
    step.take_back(&held).unwrap();
    assert_eq!(step.v, before);
    step.bent.clear();
    step.take_back(&free).unwrap();
    assert_eq!(step.v, before);
}
