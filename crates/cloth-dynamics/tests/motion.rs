//! Motions with known laws: free fall, oscillators, conservation, terminal velocity, stability.

mod common;

use cloth_dynamics::{Constraints, Environment, ImplicitEuler, Sdirk2, TimeIntegrator, Wind};
use common::{G, NOTHING, Run, fabric, gravity, sheet};
use mesh_core::generate::Diagonal;
use mesh_core::{ClothState, World3};

fn free(_: f64) -> Constraints {
    Constraints::default()
}

fn small(density: f64) -> ClothState {
    sheet([0.2, 0.1], [4, 2], Diagonal::Alternating, density)
}

/// Implicit Euler falls ½ g t (t + h), SDIRK2 exactly ½ g t².
#[test]
fn free_fall() {
    for (h, n) in [(0.04, 25), (0.005, 200)] {
        let t = h * f64::from(n);
        let integrators: [(&mut dyn TimeIntegrator, f64); 2] =
            [(&mut ImplicitEuler, 0.5 * G * t * (t + h)), (&mut Sdirk2, 0.5 * G * t * t)];
        for (integrator, exact) in integrators {
            let mut run = Run::new(small(0.2), fabric(1000.0, 1e-5, 0.2), &gravity());
            let start = run.cloth.x.clone();
            for _ in 0..n {
                run.step(integrator, h, &free);
            }
            for (x, x_0) in run.cloth.x.iter().zip(&start) {
                let moved = x - x_0;
                assert!((moved - World3::new(0.0, 0.0, -exact)).norm() < 1e-9, "{moved:?} {exact}");
            }
        }
    }
}

/// A sheet on one spring per vertex is a linear oscillator of frequency √(k/m).
fn oscillate(integrator: &mut dyn TimeIntegrator, omega: f64, h: f64, n: usize) -> (f64, f64) {
    let mut run = Run::new(small(0.2), fabric(1000.0, 0.0, 0.2), &NOTHING);
    let home = run.cloth.x.clone();
    let stiffness: Vec<f64> = run.cloth.m.iter().map(|m| m * omega * omega).collect();
    let springs = move |_| Constraints {
        fixed: Vec::new(),
        springs: (0..).zip(&home).zip(&stiffness).map(|((i, x), k)| (i, *x, *k)).collect(),
    };
    let start = World3::new(0.0, 0.0, 0.01);
    for x in &mut run.cloth.x {
        *x += start;
    }
    for _ in 0..n {
        run.step(integrator, h, &springs);
    }
    (run.cloth.x[0].z / 0.01, run.cloth.v[0].z / (0.01 * omega))
}

/// Amplitude per step of implicit Euler is 1/√(1 + (ωh)²) (reference/oscillator_integrators).
#[test]
fn implicit_euler_damps_by_its_law() {
    for (omega_h, amplitude) in
        [(0.1, 0.99503719021), (1.0, std::f64::consts::FRAC_1_SQRT_2), (10.0, 0.099503719021)]
    {
        let h = 0.01;
        let (x, v) = oscillate(&mut ImplicitEuler, omega_h / h, h, 3);
        let found = x.hypot(v);
        let expected = f64::powi(amplitude, 3);
        assert!((found / expected - 1.0).abs() < 1e-6, "ωh {omega_h}: {found} {expected}");
    }
}

/// Order of convergence: the error at a fixed time falls by 2 (Euler) and by 4 (SDIRK2) when the
/// step is halved; and the stiff end is damped as strongly as by Euler.
#[test]
fn orders_of_convergence() {
    let omega = 2.0 * std::f64::consts::PI;
    let error = |integrator: &mut dyn TimeIntegrator, n: usize| {
        let (x, v) = oscillate(integrator, omega, 1.0 / n as f64, n);
        (x - 1.0).hypot(v)
    };
    let euler = [100, 200, 400].map(|n| error(&mut ImplicitEuler, n));
    let second = [100, 200, 400].map(|n| error(&mut Sdirk2, n));
    println!("Euler {euler:?}, SDIRK2 {second:?}");
    assert!((1.8..2.2).contains(&(euler[1] / euler[2])), "{euler:?}");
    assert!((3.8..4.2).contains(&(second[1] / second[2])), "{second:?}");
    let (x, v) = oscillate(&mut Sdirk2, 1e6, 0.01, 1);
    assert!(x.hypot(v * 1e-2) < 1e-2, "L-stable: {x} {v}");
}

/// A sheet thrown, spinning and wobbling in empty space.
fn thrown() -> Run {
    let mut run = Run::new(small(0.2), fabric(500.0, 1e-4, 0.2), &NOTHING);
    for (x, v) in run.cloth.x.iter().zip(&mut run.cloth.v) {
        *v = World3::new(1.0, -2.0, 0.5)
            + World3::new(2.0, 1.0, 6.0).cross(x)
            + World3::new(0.0, 0.0, (40.0 * x.x).sin());
    }
    run
}

#[test]
fn momentum_is_conserved() {
    let integrators: [&mut dyn TimeIntegrator; 2] = [&mut ImplicitEuler, &mut Sdirk2];
    for integrator in integrators {
        let mut run = thrown();
        let before = run.cloth.momentum();
        for _ in 0..100 {
            run.step(integrator, 0.005, &free);
        }
        // Internal forces cancel; what is left is the tolerance of Newton's method, 1e-9 m/s a step.
        let drift = (run.cloth.momentum() - before).norm() / run.cloth.total_mass();
        assert!(drift < 1e-7, "drift {drift} m/s");
    }
}

/// Angular momentum: implicit Euler loses it in first order, SDIRK2 in second.
#[test]
fn angular_momentum_converges() {
    let loss = |integrator: &mut dyn TimeIntegrator, h: f64| {
        let mut run = thrown();
        let before = run.cloth.angular_momentum();
        for _ in 0..(0.2 / h).round() as usize {
            run.step(integrator, h, &free);
        }
        (run.cloth.angular_momentum() - before).norm() / before.norm()
    };
    let euler = [0.004, 0.002].map(|h| loss(&mut ImplicitEuler, h));
    let second = [0.004, 0.002, 0.001].map(|h| loss(&mut Sdirk2, h));
    println!("Euler {euler:?}, SDIRK2 {second:?}");
    assert!(euler[1] < 0.65 * euler[0], "{euler:?}");
    assert!(second[2] < 0.35 * second[1] && second[1] < 0.5 * euler[1], "{second:?} {euler:?}");
}

/// A rigid spin of φ per step under implicit Euler goes on by tan θ = sin φ/(2 − cos φ) and keeps the
/// share sin θ/sin φ of its angular momentum (reference table, first step). Velocities are those
/// of the method itself: chords over the last step.
#[test]
fn implicit_euler_slows_a_spin_by_its_law() {
    for (phi, ratio) in [(0.01, 0.999900015831), (0.1, 0.99015562982), (0.5, 0.819322723984)] {
        let h = 0.01;
        let mut run = Run::new(small(0.2), fabric(1e9, 0.0, 0.2), &NOTHING);
        let centre: World3 =
            run.cloth.x.iter().zip(&run.cloth.m).map(|(x, m)| x * *m).sum::<World3>()
                / run.cloth.total_mass();
        for x in &mut run.cloth.x {
            *x -= centre;
        }
        for (x, v) in run.cloth.x.iter().zip(&mut run.cloth.v) {
            *v = (x - nalgebra::Rotation3::from_axis_angle(&World3::z_axis(), -phi) * x) / h;
        }
        let before = run.cloth.angular_momentum().z;
        run.settings.tolerance = 1e-7;
        run.step(&mut ImplicitEuler, h, &free);
        let found = run.cloth.angular_momentum().z / before;
        println!("φ {phi}: {found:.9} ({ratio:.9})");
        assert!((found - ratio).abs() < 1e-4 * (1.0 - ratio) + 1e-8, "φ {phi}: {found} {ratio}");
    }
}

/// Without work from outside the total energy does not rise, from soft to stiff, small to large
/// steps. SDIRK2 is not unconditionally monotone: it may wobble by 1 % on the way down.
#[test]
fn energy_does_not_rise() {
    for stiffness in [10.0, 1e3, 1e5, 1e7] {
        for h in [0.0005, 0.005, 0.04] {
            let integrators: [(&mut dyn TimeIntegrator, f64); 2] =
                [(&mut ImplicitEuler, 1e-9), (&mut Sdirk2, 0.01)];
            for (integrator, slack) in integrators {
                let mut run = thrown();
                run.system = cloth_dynamics::System::new(
                    &run.cloth,
                    &std::sync::Arc::new(vec![fabric(stiffness, 1e-4, 0.2)]),
                    &NOTHING,
                    h,
                )
                .unwrap();
                run.settings.tolerance = 1e-6;
                let energy =
                    |run: &Run| run.cloth.kinetic_energy() + run.system.energy(&run.cloth.x);
                let start = energy(&run);
                for _ in 0..60 {
                    run.step(integrator, h, &free);
                    let now = energy(&run);
                    assert!(now <= start * (1.0 + slack), "k {stiffness}, h {h}: {start} → {now}");
                }
            }
        }
    }
}

/// A level sheet falling through air: v = √(σ g/ρ) tanh(t √(ρ g/σ)).
#[test]
fn terminal_velocity() {
    for (density, air, terminal) in [(0.1, 1.0, 0.990454441153), (0.3, 1.225, 1.54998354172)] {
        let wind = Wind { velocity: World3::zeros(), density: air, drag: 0.0 };
        let environment = Environment { wind: Some(wind), ..gravity() };
        let mut run = Run::new(small(density), fabric(1000.0, 1e-3, density), &environment);
        for _ in 0..400 {
            run.step(&mut Sdirk2, 0.0025, &free);
        }
        let tau = (density / (air * G)).sqrt();
        let exact = terminal * (1.0 / tau).tanh();
        let speed = -run.cloth.v[4].z;
        println!("{speed} {exact}");
        assert!((speed / exact - 1.0).abs() < 1e-6, "{speed} {exact}");
        let drop = terminal * tau * (1.0 / tau).cosh().ln();
        assert!((-run.cloth.x[4].z / drop - 1.0).abs() < 2e-4, "{} {drop}", run.cloth.x[4].z);
    }
}

/// A sheet thrown at a plane never passes it, stays in one piece, and ends at rest just above it.
#[test]
fn a_sheet_comes_to_rest_on_a_plane() {
    for (speed, h) in [(0.0, 0.01), (5.0, 0.01), (30.0, 0.02)] {
        let mut cloth = sheet([0.2, 0.2], [6, 6], Diagonal::Alternating, 0.2);
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, 0.2, 0.0);
        for x in &mut cloth.x {
            *x = turn * *x + World3::new(0.0, 0.0, 0.1);
        }
        cloth.v.fill(World3::new(0.0, 0.0, -speed));
        let mut run = Run::new(cloth, fabric(500.0, 1e-4, 0.2), &gravity());
        let thickness = 0.005;
        let plane = cloth_dynamics::PlaneContact::new(World3::zeros(), World3::z(), thickness);
        run.system.set_contact(Box::new(plane));
        run.settings.tolerance = 1e-4;
        for _ in 0..200 {
            run.step(&mut ImplicitEuler, h, &free);
            assert!(run.cloth.x.iter().all(|x| x.z > 0.0), "speed {speed}");
        }
        let fastest = run.cloth.v.iter().map(|v| v.norm()).fold(0.0, f64::max);
        let highest = run.cloth.x.iter().map(|x| x.z).fold(0.0, f64::max);
        assert!(fastest < 2e-3, "speed {speed}: still {fastest} m/s");
        assert!(highest < 1.2 * thickness, "speed {speed}: still at {highest} m");
    }
}
