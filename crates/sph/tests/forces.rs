//! Forces are the gradient of the energy; momentum is conserved.

mod common;

use nalgebra::Vector3;
use sph::{Bounds, Fluid, FluidSettings, Open, Walls, scenes};

/// Fluid without viscosity that is squeezed between nothing but itself, or into the corner of a box.
fn squeezed(in_box: bool, positions: &[Vector3<f64>]) -> Fluid {
    let inside = common::tank([5, 5, 8]);
    let mut walls = Walls::none();
    if in_box {
        walls.add_box(&inside, Open::TOP, common::SPACING).unwrap();
    }
    let settings = FluidSettings {
        viscosity: 0.0,
        wall_viscosity: 0.0,
        ..FluidSettings::water(common::SPACING, 1.0, inside.grown(1.0))
    };
    let at_rest = vec![Vector3::zeros(); positions.len()];
    Fluid::new(settings, walls, positions, &at_rest).unwrap()
}

fn positions() -> Vec<Vector3<f64>> {
    scenes::block([5, 5, 6], Vector3::zeros(), 0.97 * common::SPACING, 7)
}

/// Forces by particle number (N).
fn forces(fluid: &Fluid) -> Vec<Vector3<f64>> {
    let mut forces = vec![Vector3::zeros(); fluid.len()];
    for (p, a) in fluid.particles().zip(fluid.accelerations()) {
        forces[p.id as usize] = a * fluid.particle_mass();
    }
    forces
}

/// The gradient of `f` by the position of particle `i`.
fn gradient(i: usize, f: impl Fn(&[Vector3<f64>]) -> f64) -> Vector3<f64> {
    let step = 1e-6 * common::SPACING;
    let at = |k: usize, by: f64| {
        let mut x = positions();
        x[i][k] += by;
        f(&x)
    };
    Vector3::from([0, 1, 2].map(|k| (at(k, step) - at(k, -step)) / (2.0 * step)))
}

#[test]
fn forces_are_the_gradient_of_the_energy() {
    for in_box in [false, true] {
        let fluid = squeezed(in_box, &positions());
        let forces = forces(&fluid);
        let scale = forces.iter().map(Vector3::norm).fold(0.0, f64::max);
        assert!(scale > 10.0 * fluid.particle_mass() * 9.81, "nothing presses: {scale} N");
        for i in (0..forces.len()).step_by(7) {
            let slope = gradient(i, |x| squeezed(in_box, x).energy().total());
            let off = (slope + forces[i]).norm();
            assert!(off < 1e-5 * scale, "particle {i}: {slope} and {}", forces[i]);
        }
    }
}

#[test]
fn momentum_is_conserved_to_rounding_without_walls() {
    let mut fluid = common::free_ball(3);
    let total = |fluid: &Fluid| -> f64 {
        fluid.particles().map(|p| p.velocity.norm()).sum::<f64>() * fluid.particle_mass()
    };
    let (before, scale) = (fluid.momentum(), total(&fluid));
    let energy = fluid.energy().total();
    for _ in 0..400 {
        fluid.step(fluid.step_bound()).unwrap();
    }
    let off = (fluid.momentum() - before).norm();
    assert!(off < 1e-12 * scale, "{off} of {scale} kg m/s");
    assert!(fluid.energy().total() < energy, "viscosity takes energy away");
    assert!(fluid.energy().kinetic > 0.05 * energy, "there is still motion");
}

#[test]
fn viscosity_only_brakes_what_approaches() {
    let room = Bounds::new(Vector3::repeat(-1.0), Vector3::repeat(1.0));
    let settings =
        FluidSettings { gravity: Vector3::zeros(), ..FluidSettings::water(0.05, 1.0, room) };
    let x = [Vector3::zeros(), Vector3::new(0.06, 0.0, 0.0)];
    let pull = |speed: f64| {
        let v = [Vector3::new(speed, 0.0, 0.0), Vector3::zeros()];
        let fluid = Fluid::new(settings, Walls::none(), &x, &v).unwrap();
        fluid.accelerations().next().unwrap().x
    };
    // Two particles alone have less than the rest density and no pressure.
    assert_eq!(pull(-1.0), 0.0);
    assert!(pull(1.0) < 0.0);
    assert!((pull(2.0) / pull(1.0) - 2.0).abs() < 1e-12, "linear in the speed");
}
