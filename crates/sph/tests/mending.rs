//! Lists of neighbours that are mended: a current over water at rest, with a nozzle and a sink.

mod common;

use arps::{Restraint, Speed};
use mesh_core::par;
use nalgebra::Vector3;
use sph::{
    Bounds, Emitter, Fluid, FluidSettings, Open, RestraintSettings, Sink, StepReport, Walls, scenes,
};
use std::collections::HashMap;

/// Water at rest in a trough, a nozzle above one end and a sink at the other.
fn free_current() -> Fluid {
    let n = [12, 6, 14];
    let size = n.map(|n| n as f64 * common::SPACING);
    let inside = Bounds::new(Vector3::zeros(), Vector3::new(size[0], size[1], 1.2));
    let mut walls = Walls::none();
    walls.add_box(&inside, Open::default(), common::SPACING).unwrap();
    let settings = FluidSettings {
        sound_speed: 30.0,
        ..FluidSettings::water(common::SPACING, size[2], inside.grown(0.2))
    };
    let mut x = scenes::block(n, Vector3::zeros(), common::SPACING, 3);
    scenes::press(&mut x, &settings, &Bounds::new(Vector3::zeros(), Vector3::from(size)));
    let mut fluid = Fluid::new(settings, walls, &x, &vec![Vector3::zeros(); x.len()]).unwrap();
    let nozzle = Vector3::new(0.1, 0.5 * size[1], size[2] + 0.1);
    fluid.add_emitter(Emitter::new(nozzle, Vector3::x(), [0.1, 0.05], 0.5).unwrap()).unwrap();
    let low = Vector3::new(size[0] - 0.1, 0.0, size[2]);
    fluid.add_sink(Sink(Bounds::new(low, inside.max.add_scalar(0.1))));
    fluid
}

fn policy() -> Speed {
    Speed::new(0.1, 0.2).unwrap()
}

/// The same, restrained.
fn current(tolerance: f64, force_interval: u32) -> Fluid<Speed> {
    let fluid = free_current();
    let settings = RestraintSettings {
        bleeding: Some(0.01),
        inactivity: 0.02,
        pressure_tolerance: tolerance,
        force_interval,
        ..RestraintSettings::of(fluid.settings())
    };
    fluid.restrained(policy(), settings).unwrap()
}

/// Densities and accelerations by lasting number.
fn sums<R: Restraint>(fluid: &Fluid<R>) -> HashMap<u64, ([f64; 3], f64, [f64; 3])> {
    let each = fluid.particles().zip(fluid.accelerations());
    each.map(|(p, a)| (p.id, (p.position.into(), p.density, a.into()))).collect()
}

/// By how much the accelerations of two fluids with the same particles in the same places differ, over the
/// square of the speed of sound over the spacing.
fn difference<R: Restraint, Q: Restraint>(a: &Fluid<R>, b: &Fluid<Q>) -> f64 {
    let (scale, b) = (a.settings().sound_speed.powi(2) / common::SPACING, sums(b));
    assert_eq!(a.len(), b.len());
    let off = sums(a).into_iter().map(|(id, (x, density, a))| {
        let (there, of_b, by_b) = b[&id];
        assert_eq!(x, there, "particle {id}");
        let far = (0..3).map(|k| (a[k] - by_b[k]).abs()).fold(0.0, f64::max);
        assert!((density - of_b).abs() < 1e-9, "density of {id}: {density}, {of_b}");
        // Where there is no pressure, near the surface, a density that changes leaves the drag as it is.
        if x[2] < 0.45 { far / scale } else { 0.0 }
    });
    off.fold(0.0, f64::max)
}

fn counts(report: StepReport) -> StepReport {
    StepReport { seconds: Default::default(), ..report }
}

#[test]
fn mended_lists_miss_nothing() {
    let mut fluid = current(0.0, 1);
    fluid.advance(1.0).unwrap();
    let report = fluid.advance(1.0).unwrap();
    assert!(report.mended > 200 && report.listings < 20, "{report:?}");
    assert!(report.sweeps < 500, "{report:?}");
    assert!(report.emitted > 50 && report.drained > 10, "{report:?}");
    // The same steps, once from what is known and once with lists and sums anew.
    for _ in 0..60 {
        let mut anew = fluid.clone().released::<()>();
        let saved = anew.checkpoint();
        anew.restore(&sph::Checkpoint { incremental: false, ..saved }).unwrap();
        let settings = RestraintSettings {
            bleeding: Some(0.01),
            inactivity: 0.02,
            sweep_above: 0.0,
            ..RestraintSettings::of(fluid.settings())
        };
        let mut anew = anew.restrained(policy(), settings).unwrap();
        let dt = 0.5 * fluid.step_bound();
        fluid.step(dt).unwrap();
        assert_eq!(anew.step(dt).unwrap().sweeps, 1);
        let off = difference(&fluid, &anew);
        assert!(off < 1e-7, "{off}");
    }
}

#[test]
fn free_fluid_with_mended_lists_misses_nothing() {
    let mut fluid = free_current();
    let report = fluid.advance(0.5).unwrap();
    assert!(report.mended > 100 && report.listings < 20, "{report:?}");
    let particles = fluid.particles_by_id();
    let x: Vec<_> = particles.iter().map(|p| p.position).collect();
    let v: Vec<_> = particles.iter().map(|p| p.velocity).collect();
    let anew = Fluid::new(*fluid.settings(), fluid.walls().clone(), &x, &v).unwrap();
    let again = sums(&anew);
    let scale = fluid.settings().sound_speed.powi(2) / common::SPACING;
    for ((p, a), (_, density, of_new)) in by_id(&fluid).iter().zip((0..).map(|k| again[&k])) {
        assert!((p.density - density).abs() < 1e-9 * 1000.0, "{p:?}: {density}");
        assert!((0..3).all(|k| (a[k] - of_new[k]).abs() < 1e-9 * scale), "{p:?}: {a:?} {of_new:?}");
    }
}

fn by_id(fluid: &Fluid) -> Vec<(sph::Particle, [f64; 3])> {
    let mut list: Vec<_> =
        fluid.particles().zip(fluid.accelerations().map(<[f64; 3]>::from)).collect();
    list.sort_by_key(|(p, _)| p.id);
    list
}

#[test]
fn a_restart_among_mended_lists_does_not_change_a_bit() {
    let run = |n| {
        par::with_threads(n, || {
            let mut fluid = current(10.0, 3);
            let mut total = StepReport::default();
            fluid.advance(1.0).unwrap();
            for _ in 0..8 {
                total.add(&fluid.advance(0.0731).unwrap());
                let saved = fluid.checkpoint();
                let mut resumed = current(10.0, 3);
                resumed.restore(&saved).unwrap();
                assert_eq!(resumed.checkpoint(), saved);
                let mut ahead = fluid.clone();
                let (a, b) = (ahead.advance(0.06).unwrap(), resumed.advance(0.06).unwrap());
                assert_eq!(counts(a), counts(b));
                assert_eq!(common::bits(&ahead), common::bits(&resumed));
                assert_eq!(ahead.checkpoint(), resumed.checkpoint());
            }
            assert!(total.mended > 100 && total.sweeps * 3 < total.steps, "{total:?}");
            (common::bits(&fluid), counts(total))
        })
        .unwrap()
    };
    assert!(run(1) == run(2));
}

#[test]
fn free_fluid_restarts_among_mended_lists() {
    let mut fluid = free_current();
    for _ in 0..4 {
        fluid.advance(0.0731).unwrap();
        let mut resumed = free_current();
        resumed.restore(&fluid.checkpoint()).unwrap();
        let mut ahead = fluid.clone();
        let (a, b) = (ahead.advance(0.1).unwrap(), resumed.advance(0.1).unwrap());
        assert!(a.mended > 0, "{a:?}");
        assert_eq!(counts(a), counts(b));
        assert_eq!(ahead.checkpoint(), resumed.checkpoint());
    }
}

#[test]
fn what_rests_may_get_its_accelerations_late_but_gets_them() {
    let mut fluid = current(0.0, 4);
    fluid.advance(0.5).unwrap();
    let mut late = 0;
    for _ in 0..40 {
        let age = fluid.checkpoint().age;
        let mut anew = fluid.clone();
        let dt = 0.5 * fluid.step_bound();
        fluid.step(dt).unwrap();
        let saved = anew.checkpoint();
        anew.restore(&sph::Checkpoint { incremental: false, ..saved }).unwrap();
        anew.step(dt).unwrap();
        let off = difference(&fluid, &anew);
        match fluid.checkpoint().age {
            0 => assert!(off < 1e-7, "{off} after {age}"),
            _ => late += usize::from(off > 1e-7),
        }
    }
    assert!(late > 20, "{late}");
}
