//! What a stage promises at any limit of iterations: never above its start, within strain limits,
//! and no creep where cloth buckles.

use super::*;
use crate::RestTriangle;
use crate::fabric::{BendingModel, Damping, Fabric, StrainLimits};
use crate::force::Stage;
use crate::law::{Bending, Membrane, Quadratic};
use crate::solver::{LinearSettings, SolverKind};
use crate::strain_limit::principal_stretches;
use crate::system::Environment;
use mesh_core::ClothState;
use mesh_core::generate::{Diagonal, grid};
use nalgebra::Rotation3;
use std::sync::Arc;

const NOTHING: Environment = Environment { gravity: World3::new(0.0, 0.0, 0.0), wind: None };

fn fabric(membrane: f64, rigidity: f64, strain_limits: Option<StrainLimits>) -> Fabric {
    Fabric {
        density: 0.2,
        membrane: Membrane::Orthotropic(Quadratic::isotropic(membrane, 0.2).unwrap()),
        bending: Some(Bending::Orthotropic(Quadratic::isotropic(rigidity, 0.0).unwrap())),
        bending_model: BendingModel::ShapeOperator,
        tension_field: false,
        strain_limits,
        damping: Damping::default(),
    }
}

fn sheet(size: [f64; 2], cells: [usize; 2]) -> ClothState {
    let sheet = grid(size, cells, Diagonal::Alternating).unwrap();
    ClothState::at_rest(sheet.mesh, sheet.positions, vec![0.2]).unwrap()
}

/// A stage of implicit Euler.
struct Problem {
    cloth: ClothState,
    system: System,
    /// Where the vertices go, or are held.
    target: Vec<World3>,
    fixed: Vec<bool>,
    h: f64,
}

/// How it ended.
struct Outcome {
    /// Potential at the better start and at the end (J).
    phi: [f64; 2],
    x: Vec<World3>,
    report: SolveReport,
}

impl Problem {
    fn new(cloth: ClothState, fabric: Fabric, h: f64) -> Self {
        let system = System::new(&cloth, &Arc::new(vec![fabric]), &NOTHING, h).unwrap();
        let target = cloth.x.iter().zip(&cloth.v).map(|(x, v)| x + v * h).collect();
        let fixed = vec![false; cloth.x.len()];
        Problem { cloth, system, target, fixed, h }
    }

    /// Holds what `place` gives a place to.
    fn hold(&mut self, place: impl Fn(&World3) -> Option<World3>) {
        for (i, x) in self.cloth.x.iter().enumerate() {
            if let Some(goal) = place(x) {
                self.target[i] = goal;
                self.fixed[i] = true;
            }
        }
    }

    fn solve(&mut self, solver: SolverKind, max_iterations: usize, tolerance: f64) -> Outcome {
        let Problem { cloth, system, target, fixed, h } = self;
        system.begin(Stage { x_t0: &cloth.x, base: &cloth.x, h: *h });
        let mut resting = cloth.x.clone();
        for i in (0..resting.len()).filter(|&i| fixed[i]) {
            resting[i] = target[i];
        }
        let starts = [resting, target.clone()];
        let inertia = Inertia {
            mass: &cloth.m,
            target,
            h: *h,
            time: 0.0,
            fixed,
            pinned: fixed,
            restrained: None,
        };
        let start =
            starts.iter().map(|x| inertia.potential(system, x)).fold(f64::INFINITY, f64::min);
        let mut solver =
            solver.build(LinearSettings { tolerance: 1e-8, ..LinearSettings::default() });
        let settings = NewtonSettings { max_iterations, tolerance };
        let Minimum { x, report, .. } =
            minimise(system, solver.as_mut(), &inertia, &starts, &settings).expect("finite");
        Outcome { phi: [start, inertia.potential(system, &x)], x, report }
    }

    /// How far the worst triangle is out of limits (1).
    fn excess(&self, limits: &StrainLimits, x: &[World3]) -> f64 {
        let triangles = RestTriangle::all(&self.cloth).into_iter().zip(self.cloth.mesh.triangles());
        let of = |(rest, corners): (RestTriangle, &[u32; 3])| {
            let f = rest.deformation_gradient(&corners.map(|i| x[i as usize]));
            let [high, low] = principal_stretches(&f).0;
            (high - limits.max).max(limits.min - low)
        };
        triangles.map(of).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// A sheet that turns by half a radian about its normal in one step and flutters.
fn turning(stiffness: f64) -> Problem {
    let mut cloth = sheet([0.2, 0.1], [8, 4]);
    let h = 0.01;
    for (x, v) in cloth.x.iter().zip(&mut cloth.v) {
        let turned = Rotation3::from_axis_angle(&World3::z_axis(), 0.5) * x;
        *v = (turned - x) / h + World3::new(0.0, 0.0, 0.5 * (40.0 * x.x).sin());
    }
    Problem::new(cloth, fabric(stiffness, 1e-5, None), h)
}

/// The watchdog raises the potential on trial; wherever the limit cuts it off, the result does not.
#[test]
fn no_stage_ends_above_its_start() {
    let mut n_unfinished = 0;
    for stiffness in [1e2, 1e4, 1e6, 1e8] {
        let mut last = f64::INFINITY;
        for max_iterations in 1..=6 {
            let mut problem = turning(stiffness);
            let Outcome { phi: [start, end], report, .. } =
                problem.solve(SolverKind::SparseCholesky, max_iterations, 1e-6);
            assert!(report.iterations <= max_iterations);
            assert!(
                end <= start * (1.0 + 1e-12),
                "{stiffness:e}, {max_iterations}: {start} → {end}"
            );
            assert!(end < start, "{stiffness:e}, {max_iterations}: nothing gained");
            n_unfinished += report.unconverged;
            last = last.min(end);
        }
        // The minimum is below all of them.
        let best = turning(stiffness).solve(SolverKind::SparseCholesky, 100, 1e-6);
        assert_eq!(best.report.unconverged, 0, "{stiffness:e}: {:?}", best.report);
        println!(
            "{stiffness:e}: {} iterations, {} → {}",
            best.report.iterations, best.phi[0], best.phi[1]
        );
        assert!(
            best.phi[1] <= last * (1.0 + 1e-9) + 1e-12,
            "{stiffness:e}: {} {last}",
            best.phi[1]
        );
    }
    assert!(n_unfinished > 12, "{n_unfinished} stages were cut off: too few to tell");
}

/// A single iteration is more accurate from where inertia leads than from the start at rest.
#[test]
fn inertia_leads_close_to_the_minimum() {
    for stiffness in [1e2, 1e4, 1e6] {
        let best = turning(stiffness).solve(SolverKind::SparseCholesky, 100, 1e-6).x;
        let error = |rests: u32| {
            let mut problem = turning(stiffness);
            problem.system.rests = rests;
            let x = problem.solve(SolverKind::SparseCholesky, 1, 1e-6).x;
            best.iter().zip(&x).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
        };
        let [inertia, rest] = [0, 1].map(error);
        println!("{stiffness:e}: {inertia} m from where inertia leads, {rest} m from rest");
        assert!(inertia < 0.5 * rest, "{stiffness:e}: {inertia} {rest}");
    }
}

/// Vertices that fly apart lead to no good start; what is done from there does not count.
#[test]
fn a_start_that_proves_no_good_is_left() {
    let mut left = 0;
    for (seed, stiffness) in (0..8).flat_map(|seed| [10.0, 1e3, 1e5].map(|k| (seed, k))) {
        for (max_iterations, speed) in [(1, 0.4), (1, 40.0), (4, 0.4), (4, 40.0)] {
            let mut cloth = sheet([0.2, 0.1], [8, 4]);
            for (i, v) in cloth.v.iter_mut().enumerate() {
                let wave = |k: usize| ((i * 37 + k + 11 * seed) % 17) as f64 / 17.0 - 0.5;
                *v = World3::new(wave(0), wave(5), wave(9)) * speed;
            }
            let mut problem = Problem::new(cloth, fabric(stiffness, 1e-5, None), 0.01);
            let Outcome { phi: [start, end], report, .. } =
                problem.solve(SolverKind::SparseCholesky, max_iterations, 1e-9);
            assert!(end < start, "{seed} {stiffness:e}: {start} → {end}");
            let was_left = report.iterations > max_iterations;
            assert_eq!(was_left, problem.system.rests > 0, "the next stages start at rest");
            assert!(report.iterations <= 2 * max_iterations);
            left += usize::from(was_left);
        }
    }
    println!("{left} of 96 starts were left");
    assert!((10..86).contains(&left), "{left} of 96: too few to tell");
}

/// A strip of some rigidity (N m), shortened by 3 % between its held ends in a step of `h`, uneven by
/// `bump` (m).
fn buckling(rigidity: f64, h: f64, bump: f64) -> Problem {
    let mut cloth = sheet([0.1, 0.03], [20, 6]);
    for (i, x) in cloth.x.iter_mut().enumerate() {
        let wave = (std::f64::consts::PI * x.x / 0.1).sin() * (1.0 + 3.0 * x.y);
        x.z = bump * (wave + (i * 37 % 17) as f64 / 17.0 - 0.5);
    }
    let mut problem = Problem::new(cloth, fabric(500.0, rigidity, None), h);
    problem.hold(|x| {
        let is_end = x.x < 1e-9 || x.x > 0.1 - 1e-9;
        is_end.then(|| World3::new(0.05 + 0.97 * (x.x - 0.05), x.y, x.z))
    });
    problem
}

/// The projected Hessian alone creeps: 73 iterations. With the exact one at the end there are 18.
#[test]
fn a_buckling_strip_converges_quickly() {
    let Outcome { x, report, .. } =
        buckling(1e-5, 0.02, 1e-4).solve(SolverKind::SparseCholesky, 200, 1e-6);
    println!("{report:?}");
    let rise = x.iter().map(|x| x.z.abs()).fold(0.0, f64::max);
    assert!(rise > 1e-3, "it does buckle: {rise} m");
    assert_eq!(report.unconverged, 0, "{report:?}");
    assert!(report.iterations <= 30, "{report:?}");
}

/// The exact Hessian of this strip is not positive definite when it is tried, and the step of the
/// shifted one is shorter than the tolerance, though there is far to go.
#[test]
fn a_step_of_a_shifted_matrix_is_not_convergence() {
    let tolerance = 0.1;
    let mut problem = buckling(1e-6, 0.005, 1e-4);
    let Outcome { x, report, phi } = problem.solve(SolverKind::SparseCholesky, 200, tolerance);
    assert_eq!(report.unconverged, 0);
    // One more iteration, with the projected Hessian.
    let inertia = Inertia {
        mass: &problem.cloth.m,
        target: &problem.target,
        h: problem.h,
        time: 0.0,
        fixed: &problem.fixed,
        pinned: &problem.fixed,
        restrained: None,
    };
    let mut solver = SolverKind::SparseCholesky.build(LinearSettings::default());
    let settings = NewtonSettings { max_iterations: 1, tolerance };
    let starts = [x.clone(), x];
    let Minimum { report: next, .. } =
        minimise(&mut problem.system, solver.as_mut(), &inertia, &starts, &settings).unwrap();
    println!("{phi:?} {report:?}\n{next:?}");
    assert!(next.residual <= tolerance, "{} m/s left to go", next.residual);
}

/// Conjugate gradients cannot shift a matrix that is not positive definite, as the exact Hessian of
/// this strip; the projected one goes on instead.
#[test]
fn a_buckling_strip_is_solved_by_conjugate_gradients() {
    let direct = buckling(1e-5, 0.005, 1e-6).solve(SolverKind::SparseCholesky, 200, 1e-6);
    let iterative = buckling(1e-5, 0.005, 1e-6).solve(SolverKind::BlockJacobiCg, 200, 1e-6);
    println!("{:?}\n{:?}", direct.report, iterative.report);
    assert_eq!((direct.report.unconverged, iterative.report.unconverged), (0, 0));
    assert!((iterative.phi[1] / direct.phi[1] - 1.0).abs() < 1e-6);
}

/// A sheet whose one end is pulled away by 4 % in one step, the other held, all of it thrown about.
#[test]
fn a_stage_cut_short_ends_within_strain_limits() {
    let limits = StrainLimits { min: 0.95, max: 1.05 };
    for seed in 0..6 {
        for max_iterations in 1..=3 {
            let mut cloth = sheet([0.3, 0.2], [12, 8]);
            for (i, v) in cloth.v.iter_mut().enumerate() {
                let wave = |k: usize| ((i * 37 + k + 11 * seed) % 17) as f64 / 17.0 - 0.5;
                *v = World3::new(wave(0), wave(5), wave(9)) * 4.0;
            }
            let mut problem = Problem::new(cloth, fabric(50.0, 1e-6, Some(limits)), 0.01);
            problem.hold(|x| {
                let far = (x.x > 0.3 - 1e-9).then(|| World3::new(0.3 * 1.04, x.y, 0.0));
                far.or((x.x < 1e-9).then_some(*x))
            });
            let before = problem.excess(&limits, &problem.target);
            let Outcome { phi: [start, end], x, report } =
                problem.solve(SolverKind::SparseCholesky, max_iterations, 1e-9);
            let after = problem.excess(&limits, &x);
            println!(
                "{seed} {max_iterations}: {before:.3} → {after:.6}, {} iterations, {start} → {end}",
                report.iterations
            );
            assert!(end <= start * (1.0 + 1e-12));
            assert!(after <= 1e-4 + 1e-12, "{after}");
            assert!(report.iterations <= 3 * max_iterations);
            assert_eq!(report.unconverged, 1, "so that it is cut short");
        }
    }
}

/// A sheet held at 110 % of its length: no projection can keep its limits, and one that tries would
/// raise the potential.
#[test]
fn limits_that_cannot_be_kept_do_no_harm() {
    let limits = StrainLimits { min: 0.95, max: 1.05 };
    for max_iterations in 1..=3 {
        let mut cloth = sheet([0.3, 0.2], [12, 8]);
        cloth.x.iter_mut().for_each(|x| x.x *= 1.1);
        let mut problem = Problem::new(cloth, fabric(50.0, 1e-6, Some(limits)), 0.01);
        problem.hold(|x| (x.x < 1e-9 || x.x > 0.33 - 1e-9).then_some(*x));
        let Outcome { phi: [start, end], x, report } =
            problem.solve(SolverKind::SparseCholesky, max_iterations, 1e-9);
        let after = problem.excess(&limits, &x);
        println!("{after}, {start} → {end}, {report:?}");
        assert!(end <= start * (1.0 + 1e-12), "{start} → {end}");
        assert!(after < 0.06, "the strain is where it was: {after}");
        assert!(report.iterations <= 3 * max_iterations);
    }
}
