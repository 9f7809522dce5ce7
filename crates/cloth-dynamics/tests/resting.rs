//! Restrained cloth: what it does where nothing is restrained, where all rests, and in between.

mod common;

use arps::{Held, Kinetic, Law, Motion, Particle, Restraint, Speed};
use cloth_dynamics::solver::{LinearSettings, LinearSolver, SolverKind};
use cloth_dynamics::*;
use common::{G, fabric, gravity, sheet};
use mesh_core::generate::Diagonal;
use mesh_core::{ClothState, World3, par};
use std::sync::Arc;

/// A sheet, how it is held, and all that it takes to step it.
struct Run {
    cloth: ClothState,
    system: System,
    solver: Box<dyn LinearSolver>,
    settings: NewtonSettings,
    held: Constraints,
    time: f64,
    total: SolveReport,
}

impl Run {
    fn new(cells: usize, policy: Option<RestingPolicy>, damping: Damping) -> Run {
        let cloth = sheet([1.0, 1.0], [cells, cells], Diagonal::Alternating, 0.2);
        let own = Fabric { damping, ..fabric(1000.0, 1e-4, 0.2) };
        let mut system = System::new(&cloth, &Arc::new(vec![own]), &gravity(), 0.01).unwrap();
        if let Some(policy) = policy {
            system.set_restraint(policy);
        }
        let held = common::hold(&cloth, |x| x.y > 0.999 && (x.x < 0.001 || x.x > 0.999));
        let solver = SolverKind::Auto.build(LinearSettings::default());
        let (time, total) = (0.0, SolveReport::default());
        let settings = NewtonSettings::default();
        Run { cloth, system, solver, settings, held, time, total }
    }

    fn step(&mut self, integrator: &mut dyn TimeIntegrator, h: f64) -> SolveReport {
        let step = Step { time: self.time, h };
        self.time += h;
        let held = self.held.clone();
        let report = integrator
            .advance(
                &mut self.cloth,
                &mut self.system,
                self.solver.as_mut(),
                &|_| held.clone(),
                &self.settings,
                step,
            )
            .unwrap();
        self.total.add(&report);
        report
    }

    /// Restrained energy (J), and how many rest and are in transition.
    fn energy(&mut self, restraint: &dyn Restraint) -> (f64, [usize; 3]) {
        self.system.settle(&mut self.cloth, self.time);
        let cloth = &self.cloth;
        let (mut kinetic, mut counts) = (0.0, [0; 3]);
        for i in 0..cloth.m.len() {
            let particle = Particle { index: i, mass: cloth.m[i], x: cloth.x[i], time: self.time };
            let held = restraint.at(&particle);
            let p = cloth.v[i] * cloth.m[i];
            kinetic += held.kinetic_energy(&p);
            counts[match held.motion(&p) {
                Motion::Rest => 0,
                Motion::Transition => 1,
                Motion::Full => 2,
            }] += 1;
        }
        let stage = Stage { x_t0: &cloth.x, base: &cloth.x, h: 0.01 };
        self.system.begin(stage);
        (kinetic + self.system.energy(&cloth.x), counts)
    }
}

fn speed(v_r: f64) -> RestingPolicy {
    RestingPolicy { restraint: Arc::new(Speed::new(v_r, 4.0 * v_r).unwrap()), bleeding: Some(1.0) }
}

const SOME: Damping = Damping { mass: 2.0, stiffness: 0.0 };

#[test]
fn look() {
    let policy = Speed::new(0.005, 0.02).unwrap();
    let mut run = Run::new(20, Some(speed(0.005)), SOME);
    let mut plain = Run::new(20, None, SOME);
    let clock = std::time::Instant::now();
    let mut last = run.energy(&policy).0;
    let (mut a, mut b) = (0.0, 0.0);
    for k in 0..2000 {
        let c = std::time::Instant::now();
        let report = run.step(&mut ImplicitEuler, 0.01);
        a += c.elapsed().as_secs_f64();
        let c = std::time::Instant::now();
        let other = plain.step(&mut ImplicitEuler, 0.01);
        b += c.elapsed().as_secs_f64();
        if k % 40 == 39 {
            let (energy, counts) = run.energy(&policy);
            let gap = run.cloth.x.iter().zip(&plain.cloth.x).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
            println!(
                "{k}: E {energy:.6} {counts:?} it {} solves {} unk {} unconv {} | it {} unc {} | {:.2e} {:.2e} s, ratio {:.2} untouched {} parts {} redone {} woken {} cut {} gap {:.4}",
                report.iterations, report.rest.solves, report.rest.unknowns, report.unconverged,
                other.iterations, other.unconverged, a, b, b / a, report.rest.untouched,
                run.total.rest.parts, run.total.rest.redone, run.total.rest.woken, run.total.rest.cut, gap
            );
            (a, b) = (0.0, 0.0);
            let _ = last;
            last = energy;
        }
    }
    println!("{:?} {:.1} s", run.total, clock.elapsed().as_secs_f64());
}
