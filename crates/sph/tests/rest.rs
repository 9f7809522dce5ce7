//! Water at rest: hydrostatic pressure, rest density, a closed box that holds.

mod common;

use nalgebra::Vector3;
use sph::{Fluid, FluidError, FluidSettings, Open, Walls, scenes};

/// A basin of water, eight by eight by eighteen particles, in which the first motion has died away.
fn settled() -> Fluid {
    let inside = common::tank([8, 8, 24]);
    let mut walls = Walls::none();
    walls.add_box(&inside, Open::TOP, common::SPACING).unwrap();
    let height = 18.0 * common::SPACING;
    let settings = FluidSettings {
        viscosity: 1.0,
        ..FluidSettings::water(common::SPACING, height, inside.grown(1.0))
    };
    let x = scenes::block([8, 8, 18], Vector3::zeros(), common::SPACING, 0);
    let mut fluid = Fluid::new(settings, walls, &x, &vec![Vector3::zeros(); x.len()]).unwrap();
    fluid.advance(1.5).unwrap();
    fluid
}

#[test]
fn pressure_is_hydrostatic_and_density_that_of_rest() {
    let mut fluid = settled();
    // Slabs of two layers of particles: as thick as the smoothing reaches. Between single layers the
    // pressure goes up and down by some percent near the floor.
    let n_slab = 2 * 64;
    let n_slabs = fluid.len() / n_slab;
    // Sound still goes up and down: four of its periods, 4 H / c.
    let period = 4.0 * 18.0 * common::SPACING / fluid.settings().sound_speed;
    let samples = 80;
    let mut pressure = vec![0.0; n_slabs];
    let mut depth = 0.0;
    for _ in 0..samples {
        fluid.advance(4.0 * period / f64::from(samples)).unwrap();
        let mut particles: Vec<_> = fluid.particles().collect();
        particles.sort_by(|a, b| a.position.z.total_cmp(&b.position.z));
        for (sum, slab) in pressure.iter_mut().zip(particles.chunks(n_slab)) {
            let mean = slab.iter().map(|p| p.pressure).sum::<f64>() / n_slab as f64;
            *sum += mean / f64::from(samples);
        }
        depth += particles.last().unwrap().position.z / f64::from(samples);
        // Particles of the surface have fewer neighbours; all others are within 1 %.
        for p in &particles[..fluid.len() - 64] {
            assert!((p.density / 1000.0 - 1.0).abs() < 0.01, "{} kg/m³", p.density);
        }
    }
    // What stands above a level must be carried there.
    let weight = 2.0 * fluid.particle_mass() * 9.81 / common::SPACING.powi(2);
    let bottom = weight * n_slabs as f64;
    for (k, pressure) in pressure.iter().enumerate() {
        let expected = weight * (n_slabs as f64 - k as f64 - 0.5);
        let off = (pressure - expected).abs() / bottom;
        assert!(off < 0.02, "slab {k}: {pressure} Pa instead of {expected} Pa, off by {off}");
    }
    let depth = (depth + 0.5 * common::SPACING) / (18.0 * common::SPACING);
    assert!((depth - 1.0).abs() < 0.02, "{depth} of the depth at rest");
}

#[test]
fn nothing_leaves_a_closed_box() {
    let inside = common::tank([12, 6, 12]);
    let mut fluid = common::block_in_box([5, 6, 9], [12, 6, 12], 5);
    for _ in 0..3_000 {
        fluid.step(fluid.step_bound()).unwrap();
    }
    assert_eq!(fluid.len(), 5 * 6 * 9);
    // Half a spacing: as far as the first layer of the wall.
    let reach = inside.grown(0.5 * common::SPACING);
    assert!(fluid.particles().all(|p| reach.contains(&p.position)));
}

/// A million steps of a few particles that are thrown about: gravity turns over again and again. The example
/// `closed_box` does the same with more of them.
#[test]
fn nothing_leaves_a_closed_box_in_a_million_steps() {
    let inside = common::tank([3, 3, 5]);
    let mut x = scenes::block([2, 2, 4], Vector3::zeros(), common::SPACING, 3);
    let mut v = vec![Vector3::zeros(); x.len()];
    let mut gravity = -9.81;
    let (mut steps, mut fastest) = (0, 0.0);
    while steps < 1_000_000 {
        let mut walls = Walls::none();
        walls.add_box(&inside, Open::default(), common::SPACING).unwrap();
        let settings = FluidSettings {
            gravity: Vector3::new(0.0, 0.0, gravity),
            // Half a spacing: as far as the first layer of the wall. Beyond it the step fails.
            ..FluidSettings::water(common::SPACING, 0.25, inside.grown(0.5 * common::SPACING))
        };
        let mut fluid = Fluid::new(settings, walls, &x, &v).unwrap();
        for _ in 0..1_000 {
            fluid.step(fluid.step_bound()).unwrap();
        }
        steps += 1_000;
        assert_eq!(fluid.len(), 16);
        (x, v) = fluid.particles().map(|p| (p.position, p.velocity)).unzip();
        fastest = v.iter().map(Vector3::norm).fold(fastest, f64::max);
        gravity = -gravity;
    }
    assert!(fastest > 1.0, "they were thrown about: {fastest} m/s");
}

#[test]
fn steps_beyond_the_bound_are_refused_and_can_be_divided() {
    let mut fluid = common::block_in_box([4, 4, 6], [8, 4, 8], 1);
    let before = common::bits(&fluid);
    let bound = fluid.step_bound();
    assert_eq!(
        fluid.step(10.0 * bound),
        Err(FluidError::StepTooLong { step: 10.0 * bound, bound })
    );
    for bad in [0.0, -bound, f64::NAN, f64::INFINITY] {
        assert!(matches!(fluid.step(bad), Err(FluidError::OutOfRange { .. })), "{bad}");
    }
    assert_eq!(common::bits(&fluid), before, "a refused step changes nothing");
    for _ in 0..100 {
        let time = fluid.time();
        let report = fluid.advance(10.0 * bound).unwrap();
        assert!(report.steps >= 10);
        assert!((fluid.time() - time - 10.0 * bound).abs() < 1e-12);
    }
    let reach = common::tank([8, 4, 8]).grown(0.5 * common::SPACING);
    assert!(fluid.particles().all(|p| reach.contains(&p.position)));
    let fastest = fluid.particles().map(|p| p.velocity.norm()).fold(0.0, f64::max);
    assert!(fastest < 4.0, "{fastest} m/s after a fall of 0.3 m");
}

/// A column that its own weight has pressed bounces far less than one laid out at the spacing.
#[test]
fn a_pressed_column_does_not_bounce() {
    let inside = common::tank([6, 6, 30]);
    let block = common::tank([6, 6, 24]);
    let kinetic = |is_pressed: bool| {
        let mut walls = Walls::none();
        walls.add_box(&inside, Open::TOP, common::SPACING).unwrap();
        let settings = FluidSettings::water(common::SPACING, block.size().z, inside.grown(1.0));
        let mut x = scenes::block([6, 6, 24], Vector3::zeros(), common::SPACING, 0);
        let lattice = x.clone();
        if is_pressed {
            scenes::press(&mut x, &settings, &block);
            // The lowest stays, the highest sinks by what the pressure takes: about g H²/2c².
            let sunk = |k: usize| lattice[k].z - x[k].z;
            let height = block.size().z;
            let expected = 9.81 * height * height / (2.0 * settings.sound_speed.powi(2));
            assert!((sunk(lattice.len() - 1) / expected - 1.0).abs() < 0.1, "{expected}");
            assert!(sunk(0) > 0.0 && sunk(0) < 0.1 * expected);
        }
        let mut fluid = Fluid::new(settings, walls, &x, &vec![Vector3::zeros(); x.len()]).unwrap();
        let mut most: f64 = 0.0;
        for _ in 0..40 {
            fluid.advance(0.005).unwrap();
            most = most.max(fluid.energy().kinetic);
        }
        most
    };
    let (pressed, lattice) = (kinetic(true), kinetic(false));
    assert!(pressed < 0.5 * lattice, "{pressed} J and {lattice} J");
}

#[test]
fn a_particle_that_leaves_the_domain_stops_the_run() {
    let inside = common::tank([6, 6, 6]);
    let settings = FluidSettings::water(common::SPACING, 1.0, inside);
    let x = [Vector3::repeat(0.1)];
    let mut fluid = Fluid::new(settings, Walls::none(), &x, &[Vector3::zeros()]).unwrap();
    let error = fluid.advance(1.0).unwrap_err();
    let FluidError::Escaped { id: 0, z, .. } = error else { panic!("{error}") };
    assert!(z < 0.0);
    let p = fluid.particles().next().unwrap();
    assert!(inside.contains(&p.position), "the failed step left no trace");
}
