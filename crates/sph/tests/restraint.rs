//! Restrained fluid: what it must have in common with free fluid, and what it may leave undone.

mod common;

use arps::{Law, Restraint, Speed};
use nalgebra::Vector3;
use sph::{Fluid, RestraintSettings, StepReport};

/// A policy that never lets go.
struct Frozen;

impl Restraint for Frozen {
    fn at(&self, particle: &arps::Particle) -> arps::Held {
        arps::Held::new(Law::Ramp, particle.mass, f64::INFINITY, f64::INFINITY).unwrap()
    }
}

/// A block that falls and comes to rest, under thresholds that make particles rest soon.
fn resting(tolerance: f64, sweep_above: f64) -> Fluid<Speed> {
    let fluid = common::block_in_box([6, 6, 8], [10, 10, 12], 2);
    let settings = RestraintSettings {
        bleeding: Some(0.02),
        inactivity: 0.01,
        pressure_tolerance: tolerance,
        sweep_above,
        force_interval: 1,
    };
    fluid.restrained(Speed::new(0.1, 0.2).unwrap(), settings).unwrap()
}

fn steps<R: Restraint>(fluid: &mut Fluid<R>, n: usize) -> StepReport {
    let mut report = StepReport::default();
    for _ in 0..n {
        report.add(&fluid.step(fluid.step_bound()).unwrap());
    }
    report
}

/// The same fluid, in which every step computes everything.
fn always_anew(fluid: &Fluid<Speed>) -> Fluid<Speed> {
    let settings = RestraintSettings {
        bleeding: Some(0.02),
        inactivity: 0.01,
        sweep_above: 0.0,
        ..RestraintSettings::of(fluid.settings())
    };
    fluid.clone().restrained(Speed::new(0.1, 0.2).unwrap(), settings).unwrap()
}

#[test]
fn a_null_policy_has_the_bits_of_none() {
    let mut free = common::block_in_box([6, 4, 6], [10, 6, 10], 4);
    let settings =
        RestraintSettings { bleeding: Some(0.1), ..RestraintSettings::of(free.settings()) };
    let mut null = free.clone().restrained((), settings).unwrap();
    let mut zero = free.clone().restrained(Speed::new(0.0, 0.0).unwrap(), settings).unwrap();
    for _ in 0..5 {
        steps(&mut free, 100);
        steps(&mut null, 100);
        steps(&mut zero, 100);
        assert_eq!(common::bits(&free), common::bits(&null));
        assert_eq!(common::bits(&free), common::bits(&zero));
    }
}

#[test]
fn changes_add_up_to_everything_anew() {
    // With no tolerance the two only differ by rounding, as long as they take the same steps.
    let mut fluid = resting(0.0, 0.3);
    fluid.advance(5.0).unwrap();
    let report = steps(&mut fluid, 1_000);
    assert!(report.sweeps < 500, "mostly changes: {report:?}");
    let scale = fluid.settings().sound_speed.powi(2) / common::SPACING;
    // The same step, once by changes and once with everything anew.
    let mut anew = always_anew(&fluid);
    assert_eq!(steps(&mut fluid, 1).sweeps, 0);
    assert_eq!(steps(&mut anew, 1).sweeps, 1);
    let by_id = |mut list: Vec<(u64, f64, Vector3<f64>)>| {
        list.sort_by_key(|entry| entry.0);
        list
    };
    let sums = |p: Vec<sph::Particle>, a: Vec<Vector3<f64>>| {
        by_id(p.iter().zip(a).map(|(p, a)| (p.id, p.density, a)).collect())
    };
    let held = sums(fluid.particles().collect(), fluid.accelerations().collect());
    let full = sums(anew.particles().collect(), anew.accelerations().collect());
    for ((id, density, a), (_, full_density, full_a)) in held.iter().zip(&full) {
        assert!((density - full_density).abs() < 1e-9 * 1000.0, "density of {id}: {density}");
        assert!((a - full_a).norm() < 1e-9 * scale, "acceleration of {id}: {a} {full_a}");
    }
}

#[test]
fn a_tolerance_of_pressure_is_an_error_of_that_size() {
    let tolerance = 5.0;
    let mut fluid = resting(tolerance, 0.3);
    steps(&mut fluid, 3_000);
    let report = steps(&mut fluid, 500);
    assert!(report.sweeps < 250, "{report:?}");
    let mut anew = always_anew(&fluid);
    assert_eq!(steps(&mut fluid, 1).sweeps, 0);
    steps(&mut anew, 1);
    let off = |f: &dyn Fn(&sph::Particle, &sph::Particle) -> f64| {
        let pairs = fluid.particles_by_id().into_iter().zip(anew.particles_by_id());
        pairs.map(|(a, b)| f(&a, &b)).fold(0.0, f64::max)
    };
    let density = off(&|a, b| (a.density - b.density).abs());
    assert!(density < 1e-6, "densities are exact in any case: off by {density} kg/m³");
    // Some 30 pairs, each with twice the tolerance times m F r / ρ² or less.
    let accelerations = fluid.accelerations().zip(anew.accelerations());
    let a = accelerations.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    let most = 2.0 * tolerance / (1000.0 * common::SPACING) * 30.0;
    assert!(a > 0.0 && a < most, "accelerations are off by {a} m/s²");
}

#[test]
fn what_rests_is_not_looked_at() {
    let fluid = common::block_in_box([6, 6, 8], [6, 6, 10], 2);
    let settings = RestraintSettings::of(fluid.settings());
    let mut fluid = fluid.restrained(Frozen, settings).unwrap();
    let before: Vec<_> = fluid.particles_by_id().iter().map(|p| p.position).collect();
    steps(&mut fluid, 1);
    let report = steps(&mut fluid, 100);
    assert_eq!((report.moved, report.changed, report.sweeps), (0, 0, 0));
    assert_eq!((report.density_pairs, report.force_pairs), (0, 0));
    let after: Vec<_> = fluid.particles_by_id().iter().map(|p| p.position).collect();
    assert_eq!(before, after);
    // Momentum gathers all the while.
    assert!(fluid.particles().all(|p| p.velocity.norm() > 0.0));
}

#[test]
fn momentum_is_conserved_under_restraint() {
    for law in [Law::Ramp, Law::Soft, Law::Spline] {
        let fluid = common::free_ball(6);
        let settings =
            RestraintSettings { sweep_above: 1.0, ..RestraintSettings::of(fluid.settings()) };
        let policy = Speed::with_law(law, 0.2, 0.6).unwrap();
        let mut fluid = fluid.restrained(policy, settings).unwrap();
        let scale: f64 = fluid.particles().map(|p| p.velocity.norm()).sum();
        let (scale, before) = (scale * fluid.particle_mass(), fluid.momentum());
        let report = steps(&mut fluid, 400);
        assert!(report.moved < report.particles, "nobody rests: {report:?}");
        let off = (fluid.momentum() - before).norm();
        assert!(off < 1e-11 * scale, "{law:?}: {off} of {scale} kg m/s");
    }
}

#[test]
fn a_dam_break_comes_to_rest_and_costs_nothing_then() {
    let mut fluid = resting(5.0, 0.3);
    fluid.advance(6.0).unwrap();
    let report = steps(&mut fluid, 200);
    let part = report.force_pairs as f64 / (200.0 * 10.0 * fluid.len() as f64);
    assert!(part < 0.02, "{report:?}");
    let depth = fluid.particles().map(|p| p.position.z).fold(0.0, f64::max);
    let expected = common::SPACING * 8.0 * 36.0 / 100.0;
    assert!((depth - expected).abs() < 1.5 * common::SPACING, "{depth} m instead of {expected} m");
}

#[test]
fn bad_settings_are_refused() {
    let fluid = common::block_in_box([2, 2, 2], [4, 4, 4], 0);
    let good = RestraintSettings::of(fluid.settings());
    let bad = [
        RestraintSettings { bleeding: Some(0.0), ..good },
        RestraintSettings { bleeding: Some(f64::NAN), ..good },
        RestraintSettings { inactivity: -1.0, ..good },
        RestraintSettings { pressure_tolerance: f64::NAN, ..good },
        RestraintSettings { sweep_above: 1.5, ..good },
        RestraintSettings { force_interval: 0, ..good },
    ];
    for settings in bad {
        assert!(fluid.clone().restrained((), settings).is_err(), "{settings:?}");
    }
}
