//! Fluid among moving surfaces: nothing passes them, nothing is lost, the bits stay the same.

mod common;

use arps::{Restraint, Speed};
use common::{SPACING, bits, block_in_box, free_ball, tank};
use mesh_core::par;
use nalgebra::Vector3;
use sph::{
    Bounds, Fluid, FluidSettings, Open, RestraintSettings, Sheets, StepReport, Walls, scenes,
};

type Vectors = Vec<Vector3<f64>>;

/// A level plate of `n` × `n` squares around a middle (m), bent by `bend` (m).
fn plate(n: u32, size: f64, middle: Vector3<f64>, bend: f64) -> (Sheets, Vectors) {
    let at = |k: u32| (f64::from(k) / f64::from(n) - 0.5) * size;
    let mut x = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            let height = bend * (f64::from(i) * 2.1).sin() * (f64::from(j) * 1.7).cos();
            x.push(middle + Vector3::new(at(i), at(j), height));
        }
    }
    let mut triangles = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let k = j * (n + 1) + i;
            triangles.extend([[k, k + 1, k + n + 2], [k, k + n + 2, k + n + 1]]);
        }
    }
    (Sheets::new(triangles, x.len(), SPACING).unwrap(), x)
}

/// Moves a surface by `velocity` (m/s) for a time of `n` times `duration` (s).
fn push<R: Restraint>(
    fluid: &mut Fluid<R>,
    (sheets, x): (&mut Sheets, &mut Vectors),
    velocity: Vector3<f64>,
    (n, duration): (usize, f64),
) -> StepReport {
    let mut report = StepReport::default();
    for _ in 0..n {
        let to: Vectors = x.iter().map(|x| x + velocity * duration).collect();
        sheets.move_between(x, &to).unwrap();
        report.add(&fluid.advance_among(duration, sheets).unwrap());
        *x = to;
    }
    report
}

/// A closed box with water, all of it but two layers around a level surface at `level`, all in spacings.
fn water_around(block: [usize; 3], inside: [usize; 3], level: f64, seed: u64) -> Fluid {
    let inside = tank(inside);
    let mut walls = Walls::none();
    walls.add_box(&inside, Open::default(), SPACING).unwrap();
    let height = block[2] as f64 * SPACING;
    let settings = FluidSettings::water(SPACING, height, inside.grown(SPACING));
    let mut x = scenes::block(block, Vector3::zeros(), SPACING, seed);
    x.retain(|x| (x.z / SPACING - level).abs() > 0.8);
    Fluid::new(settings, walls, &x, &vec![Vector3::zeros(); x.len()]).unwrap()
}

#[test]
fn what_the_fluid_loses_the_surface_gets() {
    let mut fluid = free_ball(1);
    let below = Vector3::new(0.0, 0.0, -5.0 * SPACING);
    let (mut sheets, x) = plate(7, 0.9, below, 0.03);
    let to: Vectors = x.iter().map(|x| x + Vector3::new(0.0, 0.02, 0.12)).collect();
    sheets.move_between(&x, &to).unwrap();
    let before = fluid.momentum();
    let report = fluid.advance_among(0.06, &mut sheets).unwrap();
    let (after, lost) = (fluid.momentum(), sheets.impulses().iter().sum::<Vector3<f64>>());
    assert!(lost.norm() > 0.05 * before.norm(), "{lost:?} of {before:?}, {report:?}");
    assert!((fluid.under_way() - lost).norm() < 1e-12 * lost.norm());
    let scale: f64 = sheets.impulses().iter().map(Vector3::norm).sum();
    assert!((after + lost - before).norm() < 1e-12 * scale, "{after:?} + {lost:?} = {before:?}");
}

#[test]
fn what_is_carried_is_what_is_near() {
    let mut fluid = free_ball(2);
    let (mut sheets, mut x) = plate(9, 0.5, Vector3::new(0.01, 0.02, -3.6 * SPACING), 0.02);
    sheets.place(&x).unwrap();
    let (masses, _) = fluid.load(&mut sheets);
    let all: f64 = masses.iter().sum();
    assert!(all > 20.0 * fluid.particle_mass(), "{all}");
    let changes: Vectors = (0..x.len()).map(|k| Vector3::new(0.1, 0.02 * k as f64, -0.3)).collect();
    let before = fluid.momentum();
    fluid.carry(&mut sheets, &changes).unwrap();
    let given: Vector3<f64> = masses.iter().zip(&changes).map(|(m, v)| v * *m).sum();
    assert!((fluid.momentum() - before - given).norm() < 1e-12 * given.norm());

    // Impulses go to the corners, all of them, and by mass they are no more than particles lost.
    let report = push(&mut fluid, (&mut sheets, &mut x), Vector3::new(0.0, 0.0, 1.0), (1, 0.01));
    let under_way = fluid.under_way();
    assert!(under_way.z < -0.1, "{under_way:?}, {report:?}");
    sheets.place(&x).unwrap();
    let before = fluid.momentum();
    let (masses, impulses) = fluid.load(&mut sheets);
    // What is near no corner any more stays with the fluid.
    let sum = impulses.iter().sum::<Vector3<f64>>() + fluid.momentum() - before;
    assert!((sum - under_way).norm() < 1e-11 * under_way.norm());
    assert_eq!(fluid.under_way(), Vector3::zeros());
    // A corner that has hardly any mass has as little impulse.
    let fast = fluid.settings().sound_speed;
    assert!(impulses.iter().zip(&masses).all(|(j, m)| j.norm() <= fast * m), "{impulses:?}");
}

#[test]
fn no_particle_passes_a_plate_that_sweeps_through_a_tank() {
    for restrained in [false, true] {
        let mut fluid = water_around([8, 8, 12], [8, 8, 40], 6.0, 3).released::<Speed>();
        if restrained {
            let settings = RestraintSettings {
                bleeding: Some(0.05),
                ..RestraintSettings::of(fluid.settings())
            };
            fluid = fluid.restrained(Speed::new(0.1, 0.2).unwrap(), settings).unwrap();
        }
        // As wide as the tank and a little more, in the middle of the water; it is bent, so that it
        // squeezes and drags too.
        let middle = Vector3::new(4.0, 4.0, 6.0) * SPACING;
        let (mut sheets, mut x) = plate(6, 8.6 * SPACING, middle, 0.004);
        let height =
            |p: &Vector3<f64>, x: &Vectors| p.z - x.iter().map(|x| x.z).sum::<f64>() / 49.0;
        let above = |fluid: &Fluid<Speed>, x: &Vectors| -> Vec<bool> {
            fluid.particles_by_id().iter().map(|p| height(&p.position, x) > 0.0).collect()
        };
        let before = above(&fluid, &x);
        // Faster than anything in a real scene: a fifth of the speed of sound.
        let sound = fluid.settings().sound_speed;
        for speed in [0.02, -0.02, 0.2, -0.2] {
            let time = 2.0 * SPACING / (speed * sound).abs();
            let velocity = Vector3::new(0.0, 0.0, speed * sound);
            let each = (5, time / 5.0);
            let report = push(&mut fluid, (&mut sheets, &mut x), velocity, each);
            assert_eq!(report.squeezed, 0, "{report:?}");
        }
        // The bend is less than the floor that everything keeps.
        let after = above(&fluid, &x);
        let passed = before.iter().zip(&after).filter(|(a, b)| a != b).count();
        assert_eq!(passed, 0, "of {} particles", before.len());
    }
}

#[test]
fn without_pressure_worth_the_name_nothing_passes_a_thin_sheet() {
    // Sound so slow that particles hit the sheet as dust would, in steps as long as they may be.
    let room = Bounds::new(Vector3::repeat(-10.0), Vector3::repeat(10.0));
    let settings = FluidSettings {
        gravity: Vector3::zeros(),
        sound_speed: 0.01,
        viscosity: 0.0,
        wall_viscosity: 0.0,
        ..FluidSettings::water(SPACING, 1.0, room)
    };
    let x = scenes::block([6, 6, 6], Vector3::zeros(), SPACING, 9);
    let v: Vectors = x.iter().map(|x| Vector3::new(x.y, 0.1, -1.0 - 3.0 * x.x)).collect();
    for (n, bend) in [(2, 0.0), (60, 0.0), (60, 0.02)] {
        let mut fluid = Fluid::new(settings, Walls::none(), &x, &v).unwrap();
        let (mut sheets, mut x) = plate(n, 3.0, Vector3::new(0.0, 0.0, -0.05), bend);
        let report =
            push(&mut fluid, (&mut sheets, &mut x), Vector3::new(0.3, 0.1, 2.0), (4, 0.06));
        assert!(report.stopped > 200, "{report:?}");
        assert_eq!(report.squeezed, 0, "{report:?}");
        let level = x.iter().map(|x| x.z).sum::<f64>() / x.len() as f64;
        assert!(fluid.particles().all(|p| p.position.z > level - bend));
        assert!(fluid.particles().all(|p| p.velocity.norm() < 6.0));
    }
}

#[test]
fn a_sheet_carries_the_weight_of_what_rests_on_it() {
    let n = [8, 8, 8];
    let mut fluid = block_in_box(n, [8, 8, 14], 0);
    // A floor above the floor, on which nothing of the water may lie deeper than half a spacing.
    let (mut sheets, mut x) = plate(12, 12.0 * SPACING, Vector3::new(4.0, 4.0, 0.0) * SPACING, 0.0);
    let weight = fluid.particle_mass() * 512.0 * 9.81;
    // On the floor of the box it shares the weight with it: far above, it has all.
    let up = Vector3::new(0.0, 0.0, 0.4);
    push(&mut fluid, (&mut sheets, &mut x), up, (25, 0.02));
    push(&mut fluid, (&mut sheets, &mut x), Vector3::zeros(), (50, 0.04));
    let (mut sum, n_frames) = (0.0, 20);
    for _ in 0..n_frames {
        push(&mut fluid, (&mut sheets, &mut x), Vector3::zeros(), (1, 0.04));
        sum += sheets.impulses().iter().map(|j| j.z).sum::<f64>();
    }
    let force = -sum / (f64::from(n_frames) * 0.04);
    assert!((force - weight).abs() < 0.03 * weight, "{force} N by water of {weight} N");
    let lowest = fluid.particles().map(|p| p.position.z - x[0].z).fold(f64::INFINITY, f64::min);
    assert!((0.2..0.8).contains(&(lowest / SPACING)), "{lowest} m above the sheet");
}

#[test]
fn changes_give_what_sweeps_give() {
    let run = |sweep_above: f64| {
        let fluid = water_around([8, 8, 10], [8, 8, 14], 6.0, 5);
        let settings = RestraintSettings {
            pressure_tolerance: 0.0,
            sweep_above,
            ..RestraintSettings::of(fluid.settings())
        };
        let mut fluid = fluid.restrained(Speed::new(0.05, 0.1).unwrap(), settings).unwrap();
        let (mut sheets, mut x) = plate(5, 0.2, Vector3::new(0.2, 0.2, 0.3), 0.01);
        let report =
            push(&mut fluid, (&mut sheets, &mut x), Vector3::new(0.1, 0.2, -0.3), (2, 0.01));
        (fluid, report)
    };
    let ((changes, did), (sweeps, all)) = (run(1.0), run(0.0));
    assert!(did.sweeps * 4 < did.steps * 3 && all.sweeps == all.steps, "{did:?}");
    for (a, b) in changes.particles_by_id().iter().zip(&sweeps.particles_by_id()) {
        assert!((a.position - b.position).norm() < 1e-6 * SPACING, "{a:?} {b:?}");
        assert!((a.density - b.density).abs() < 1e-3, "{a:?} {b:?}");
    }
}

#[test]
fn a_moving_plate_wakes_what_rests() {
    let fluid = water_around([8, 8, 10], [8, 8, 14], 5.0, 0);
    let settings = RestraintSettings {
        bleeding: Some(0.02),
        inactivity: 0.01,
        ..RestraintSettings::of(fluid.settings())
    };
    let mut fluid = fluid.restrained(Speed::new(0.1, 0.2).unwrap(), settings).unwrap();
    let (mut sheets, mut x) = plate(4, 0.2, Vector3::new(0.2, 0.2, 0.25), 0.0);
    let still = Vector3::zeros();
    push(&mut fluid, (&mut sheets, &mut x), still, (25, 0.04));
    let report = push(&mut fluid, (&mut sheets, &mut x), still, (1, 0.04));
    assert!(report.moved * 20 < report.particles, "{report:?}");
    let report = push(&mut fluid, (&mut sheets, &mut x), Vector3::new(0.0, 0.0, -0.8), (1, 0.04));
    assert!(report.moved * 10 > report.particles, "{report:?}");
}

#[test]
fn the_same_bits_at_any_number_of_threads_and_from_a_checkpoint() {
    let start = || {
        let fluid = water_around([9, 8, 8], [12, 8, 12], 4.0, 7);
        let settings = RestraintSettings::of(fluid.settings());
        let fluid = fluid.restrained(Speed::new(0.05, 0.1).unwrap(), settings).unwrap();
        (fluid, plate(5, 0.3, Vector3::new(0.25, 0.2, 0.2), 0.01))
    };
    let velocity = Vector3::new(0.3, 0.0, 0.2);
    let run = |threads: usize| {
        par::with_threads(threads, || {
            let (mut fluid, (mut sheets, mut x)) = start();
            push(&mut fluid, (&mut sheets, &mut x), velocity, (8, 0.01));
            bits(&fluid)
        })
        .unwrap()
    };
    let one = run(1);
    assert!(one == run(2));
    let (mut fluid, (mut sheets, mut x)) = start();
    push(&mut fluid, (&mut sheets, &mut x), velocity, (4, 0.01));
    let saved = fluid.checkpoint();
    let (mut fluid, (mut sheets, _)) = start();
    fluid.restore(&saved).unwrap();
    push(&mut fluid, (&mut sheets, &mut x), velocity, (4, 0.01));
    assert!(one == bits(&fluid));
}

#[test]
fn a_policy_that_restrains_nothing_changes_no_bit() {
    let run = |restrained: bool| {
        let mut fluid = water_around([6, 6, 6], [8, 6, 9], 4.0, 7).released::<Speed>();
        if restrained {
            let settings = RestraintSettings::of(fluid.settings());
            fluid = fluid.restrained(Speed::new(0.0, 0.0).unwrap(), settings).unwrap();
        }
        let (mut sheets, mut x) = plate(3, 0.2, Vector3::new(0.2, 0.15, 0.2), 0.01);
        push(&mut fluid, (&mut sheets, &mut x), Vector3::new(0.3, 0.0, -0.2), (4, 0.01));
        bits(&fluid)
    };
    assert!(run(false) == run(true));
}

#[test]
fn bad_surfaces_are_told() {
    assert!(Sheets::new(vec![[0, 1, 3]], 3, SPACING).is_err());
    let mut sheets = Sheets::new(vec![[0, 1, 2]], 3, SPACING).unwrap();
    assert!(sheets.place(&[Vector3::zeros(); 2]).is_err());
    assert!(sheets.place(&[Vector3::repeat(f64::NAN); 3]).is_err());
    let far = [[0.0, 0.0, 0.0], [1e6, 0.0, 0.0], [0.0, 1e6, 0.0]].map(Vector3::from);
    assert!(sheets.place(&far).is_err());
}
