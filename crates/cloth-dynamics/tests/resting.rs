//! Restrained cloth: what it does where nothing is restrained, where all rests, and in between.

mod common;

use arps::{Kinetic, Law, Motion, Particle, Restraint, Speed};
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

    /// Energy (J), and how many rest, are in transition and have full dynamics.
    fn energy(&mut self, policy: &RestingPolicy) -> (f64, [usize; 3]) {
        self.system.settle(&mut self.cloth, self.time);
        let cloth = &self.cloth;
        let (mut kinetic, mut counts) = (0.0, [0; 3]);
        for i in 0..cloth.m.len() {
            let particle = Particle { index: i, mass: cloth.m[i], x: cloth.x[i], time: self.time };
            kinetic += policy.kinetic_energy(&particle, &cloth.v[i]);
            counts[match policy.motion(&particle, &cloth.v[i]) {
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

fn speed(v_r: f64, bleeding: Option<f64>) -> RestingPolicy {
    RestingPolicy { restraint: Arc::new(Speed::new(v_r, 4.0 * v_r).unwrap()), bleeding }
}

const SOME: Damping = Damping { mass: 2.0, stiffness: 0.005 };
const NONE: Damping = Damping { mass: 0.0, stiffness: 0.0 };

fn integrators() -> [Box<dyn TimeIntegrator>; 2] {
    [Box::new(ImplicitEuler), Box::new(Sdirk2)]
}

#[test]
fn policies_that_restrain_nothing_are_no_policy_to_the_bit() {
    let nothing: [Arc<dyn Restraint>; 3] = [
        Arc::new(()),
        Arc::new(Speed::new(0.0, 0.3).unwrap()),
        Arc::new(Kinetic::new(0.0, 0.0).unwrap()),
    ];
    for mut integrator in integrators() {
        let mut plain = Run::new(5, None, SOME);
        (0..8).for_each(|_| {
            plain.step(integrator.as_mut(), 0.02);
        });
        for restraint in &nothing {
            let policy = RestingPolicy { restraint: restraint.clone(), bleeding: Some(0.5) };
            let mut run = Run::new(5, Some(policy), SOME);
            (0..8).for_each(|_| {
                run.step(integrator.as_mut(), 0.02);
            });
            assert_eq!((&run.cloth.x, &run.cloth.v), (&plain.cloth.x, &plain.cloth.v));
            assert_eq!(run.total.rest, RestReport::default());
        }
    }
}

/// All that moves fast is as without restraint, and restraint solves no more systems than there are
/// iterations.
#[test]
fn what_is_fast_moves_as_without_restraint() {
    let start = |policy| {
        let mut run = Run::new(6, policy, NONE);
        run.held = Constraints::default();
        run.cloth.v.fill(World3::new(0.3, 0.2, -1.0));
        run.settings = NewtonSettings { max_iterations: 50, tolerance: 1e-7 };
        let exact = LinearSettings { tolerance: 1e-12, ..LinearSettings::default() };
        run.solver = SolverKind::SparseCholesky.build(exact);
        run
    };
    for mut integrator in integrators() {
        let mut plain = start(None);
        let mut run = start(Some(speed(0.01, Some(0.5))));
        for _ in 0..10 {
            plain.step(integrator.as_mut(), 0.01);
            let report = run.step(integrator.as_mut(), 0.01);
            assert!(report.rest.solves <= report.iterations, "{report:?}");
        }
        for (a, b) in run.cloth.x.iter().zip(&plain.cloth.x) {
            assert!((a - b).norm() < 1e-9, "{a} {b}");
        }
    }
}

#[test]
fn parts_have_the_forces_of_the_whole_to_the_bit() {
    let mut cloth = sheet([1.0, 0.8], [9, 7], Diagonal::Alternating, 0.2);
    let wave = |k: usize| ((k * 37 % 17) as f64 / 17.0 - 0.5) * 0.05;
    for (i, x) in cloth.x.iter_mut().enumerate() {
        *x += World3::new(wave(i), wave(i + 5), wave(i + 9));
    }
    for bending_model in [BendingModel::ShapeOperator, BendingModel::Hinge] {
        let own = Fabric {
            damping: SOME,
            strain_limits: Some(StrainLimits { min: 0.95, max: 1.05 }),
            bending_model,
            ..fabric(1000.0, 1e-3, 0.2)
        };
        let wind = Wind { velocity: World3::new(1.0, 2.0, 0.5), density: 1.2, drag: 0.1 };
        let environment = Environment { wind: Some(wind), ..gravity() };
        let mut whole = System::new(&cloth, &Arc::new(vec![own]), &environment, 0.01).unwrap();
        let before: Vec<World3> = cloth.x.iter().map(|x| x * 0.999).collect();
        whole.begin(Stage { x_t0: &before, base: &before, h: 0.01 });
        let all = whole.gradient(&cloth.x);
        for chosen in [3, 11, 12] {
            let answers: Vec<bool> = (0..cloth.x.len()).map(|i| i % chosen < 2).collect();
            let part = Part::new(answers, (0..cloth.x.len() as u32).collect());
            check_part(&whole, &part, &cloth, &before, &all);
        }
        // A corner, and what is near it.
        let near = |i: usize, size: f64| cloth.x[i].xy().norm() < size;
        let answers = (0..cloth.x.len()).map(|i| near(i, 0.3)).collect();
        let vertices = (0..cloth.x.len() as u32).filter(|&i| near(i as usize, 0.75)).collect();
        check_part(&whole, &Part::new(answers, vertices), &cloth, &before, &all);
    }
}

fn check_part(whole: &System, part: &Part, cloth: &ClothState, before: &[World3], all: &[World3]) {
    let mut own = whole.part(part).unwrap();
    let before = part.gather(before);
    own.begin(Stage { x_t0: &before, base: &before, h: 0.01 });
    let gradient = own.gradient(&part.gather(&cloth.x));
    let mut n = 0;
    for (k, &i) in part.vertices().iter().enumerate() {
        if part.answers(i as usize) {
            assert_eq!(gradient[k], all[i as usize], "{i}");
            n += 1;
        }
    }
    assert!(n > 5);
}

/// With backward Euler energy only falls, whatever is thrown at it: the restrained one, or where momentum
/// bleeds the plain one.
#[test]
fn energy_is_never_gained() {
    let mut rested = 0;
    for (v_r, bleeding) in [(0.02, None), (0.05, Some(0.5)), (0.5, Some(0.5)), (2.0, Some(0.1))] {
        let policy = speed(v_r, bleeding);
        let mut run = Run::new(8, Some(policy.clone()), NONE);
        // A kick that is far too strong for the step, and others when it may have come to rest.
        run.cloth.v[40] = World3::new(3.0, -2.0, 8.0);
        let (mut before, _) = run.energy(&policy);
        let scale = before.abs() + 0.2 * G;
        for k in 0..240 {
            if k % 60 == 59 {
                run.cloth.v[20] += World3::new(-0.5, 0.3, 1.0);
                before = run.energy(&policy).0;
            }
            run.step(&mut ImplicitEuler, 0.04);
            let (energy, [resting, ..]) = run.energy(&policy);
            assert!(energy <= before + 1e-7 * scale, "{v_r} step {k}: {before} J, then {energy} J");
            before = energy;
            rested += resting;
        }
    }
    assert!(rested > 10_000, "{rested}");
}

/// A sheet without weight under a slow pull: it rests until its momentum has grown to the threshold,
/// costs nothing until then, and falls from there on.
#[test]
fn sleepers_wake_when_their_momentum_says_so() {
    let pull = 1.1e-3;
    for mut integrator in integrators() {
        let cloth = sheet([1.0, 1.0], [6, 6], Diagonal::Alternating, 0.2);
        let environment = Environment { gravity: World3::new(0.0, 0.0, -pull), wind: None };
        let own = fabric(1000.0, 1e-4, 0.2);
        let mut run = Run::new(6, None, NONE);
        run.system = System::new(&cloth, &Arc::new(vec![own]), &environment, 0.01).unwrap();
        run.system.set_restraint(speed(0.005, None));
        run.cloth = cloth.clone();
        run.held = Constraints::default();
        for k in 1..=454 {
            let report = run.step(integrator.as_mut(), 0.01);
            assert_eq!(run.cloth.x, cloth.x, "{k}");
            if k > 1 {
                assert_eq!(report.rest.slept, report.stages, "{k}: {report:?}");
            }
        }
        run.system.settle(&mut run.cloth, run.time);
        for v in &run.cloth.v {
            assert!((v.z + pull * run.time).abs() < 1e-12, "{v}");
        }
        let report = run.step(integrator.as_mut(), 0.01);
        assert!(report.rest.woken > 0 && report.rest.slept < report.stages, "{report:?}");
        assert!(run.cloth.x.iter().zip(&cloth.x).all(|(a, b)| a.z < b.z), "it falls");
    }
}

/// What hangs at rest assembles and solves nothing, and a pull on a spring wakes it.
#[test]
fn what_rests_costs_nothing_until_it_is_pulled() {
    let mut run = Run::new(6, Some(speed(0.02, Some(0.3))), SOME);
    let mut slept = 0;
    for _ in 0..1500 {
        let report = run.step(&mut ImplicitEuler, 0.02);
        if report.rest.slept == 1 {
            slept += 1;
            assert_eq!((report.iterations, report.rest.solves), (0, 0));
            assert_eq!((report.assembly_s, report.linear_s, report.energy_s), (0.0, 0.0, 0.0));
        }
    }
    assert!(slept > 500, "{slept}: {:?}", run.total);
    run.system.settle(&mut run.cloth, run.time);
    let (rest, lowest) = (run.cloth.x.clone(), 3);
    let pull = run.cloth.x[lowest] + World3::new(0.0, 0.0, 0.2);
    run.held.springs = vec![(lowest as u32, pull, 5.0)];
    let report = run.step(&mut ImplicitEuler, 0.02);
    assert_eq!(report.rest.slept, 0);
    (0..5).for_each(|_| {
        run.step(&mut ImplicitEuler, 0.02);
    });
    assert!(run.cloth.x[lowest].z > rest[lowest].z + 0.01);
}

/// Only a part of the cloth is worked on where only a part of it moves.
#[test]
fn what_is_far_from_motion_is_not_touched() {
    let mut run = Run::new(20, Some(speed(0.05, Some(0.2))), SOME);
    run.system = {
        let own = Fabric { damping: SOME, ..fabric(50.0, 1e-6, 0.2) };
        System::new(&run.cloth, &Arc::new(vec![own]), &common::NOTHING, 0.01).unwrap()
    };
    run.system.set_restraint(speed(0.05, Some(0.2)));
    run.held = Constraints::default();
    // A corner is pulled at.
    run.held.springs = vec![(0, run.cloth.x[0] + World3::new(0.0, 0.0, 0.1), 0.01)];
    let n = run.cloth.x.len();
    run.step(&mut ImplicitEuler, 0.01);
    run.total = SolveReport::default();
    for _ in 0..40 {
        run.step(&mut ImplicitEuler, 0.01);
    }
    let RestReport { untouched, stages, parts, .. } = run.total.rest;
    assert!(parts > 0 && untouched > stages * n / 4, "{:?}", run.total.rest);
    assert!(run.cloth.x[0].z > 1e-4 && run.cloth.x[n - 1].z == 0.0);
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let run = |threads| {
        par::with_threads(threads, || {
            let mut run = Run::new(10, Some(speed(0.1, Some(0.5))), SOME);
            (0..40).for_each(|_| {
                run.step(&mut Sdirk2, 0.02);
            });
            run.system.settle(&mut run.cloth, run.time);
            (run.cloth.x, run.cloth.v)
        })
        .unwrap()
    };
    assert!(run(1) == run(2));
}

#[test]
fn thresholds_at_their_extremes() {
    // Infinite: nothing ever moves.
    let for_ever: Arc<dyn Restraint> = Arc::new(Speed::new(f64::INFINITY, f64::INFINITY).unwrap());
    let mut run = Run::new(4, Some(RestingPolicy { restraint: for_ever, bleeding: None }), NONE);
    let start = run.cloth.x.clone();
    (0..20).for_each(|_| {
        run.step(&mut ImplicitEuler, 0.02);
    });
    assert_eq!(run.cloth.x, start);
    assert!(run.total.rest.slept >= 18, "{:?}", run.total.rest);

    // Laws that implicit steps cannot have.
    let laws = [Law::Spline, Law::MomentumSpline, Law::Exact];
    for (law, bleeding) in laws.into_iter().flat_map(|law| [(law, None), (law, Some(0.5))]) {
        let speed = Speed::with_law(law, 0.1, 0.5).unwrap();
        let policy = RestingPolicy { restraint: Arc::new(speed), bleeding };
        let mut run = Run::new(4, Some(policy), NONE);
        let (before, held) = (run.cloth.clone(), run.held.clone());
        let step = Step { time: 0.0, h: 0.01 };
        let (solver, settings) = (run.solver.as_mut(), &run.settings);
        let error = ImplicitEuler
            .advance(&mut run.cloth, &mut run.system, solver, &|_| held.clone(), settings, step)
            .unwrap_err();
        assert!(matches!(error, SolveError::Restraint { .. }), "{error}");
        assert_eq!(run.cloth, before);
    }
}

/// However high the thresholds, rest holds no cloth in the air, but those that say for ever.
#[test]
fn nothing_stays_in_the_air() {
    for (v_r, falls) in [(0.01, true), (1.0, true), (100.0, true), (f64::INFINITY, false)] {
        let mut run = Run::new(4, Some(speed(v_r, Some(0.2))), NONE);
        run.held = Constraints::default();
        let before = run.cloth.x.clone();
        let n = (50.0 * (1.0 + v_r.min(100.0) / 4.0)) as usize;
        (0..n).for_each(|_| {
            run.step(&mut ImplicitEuler, 0.02);
        });
        let fell = run.cloth.x.iter().zip(&before).all(|(a, b)| (a - b).norm() > 0.5);
        assert_eq!(fell, falls, "{v_r} m/s");
    }
}

/// A force that friction at rest withstands, but not that in motion, makes damped cloth creep. It ends
/// that, from above and from below.
#[test]
fn creeping_cloth_comes_to_rest() {
    let (tau, rate) = (0.5, 10.0);
    // Rounding differs from one speed to the other.
    let speeds = [0.01, 0.0113, 0.0131, 0.0151, 0.0171];
    for (v_r, start) in speeds.into_iter().flat_map(|v_r| [(v_r, 1.02), (v_r, 1.3)]) {
        let damping = Damping { mass: rate, stiffness: 0.0 };
        let mut run = Run::new(3, Some(speed(v_r, Some(tau))), damping);
        let environment =
            Environment { gravity: World3::new(1.5 * v_r / tau, 0.0, 0.0), ..gravity() };
        let own = Fabric { damping, ..fabric(1000.0, 1e-4, 0.2) };
        run.system = System::new(&run.cloth, &Arc::new(vec![own]), &environment, 0.01).unwrap();
        run.system.set_restraint(speed(v_r, Some(tau)));
        run.held = Constraints::default();
        run.cloth.v.fill(World3::new(start * v_r, 0.0, 0.0));
        (0..200).for_each(|_| {
            run.step(&mut ImplicitEuler, 0.01);
        });
        let before = run.cloth.x.clone();
        let report = run.step(&mut ImplicitEuler, 0.01);
        assert_eq!((report.rest.slept, &run.cloth.x), (1, &before), "from {start} {v_r}");
    }
}
