//! One particle on a spring, of mass 1 kg and stiffness 1 N/m, released at rest from 1 m: energy,
//! period and phase portrait of the adaptive Hamiltonian.

mod common;

use arps::{Explicit, Kinetic, Law, Motion, Now, Particles, Restraint, Scheme, Vector3};
use common::{reference, table};

fn spring(now: Now<'_>, f: &mut [Vector3]) {
    f[0] -= now.x[0];
}

fn released() -> Particles {
    Particles::new(vec![Vector3::x()], &[Vector3::zeros()], vec![1.0]).unwrap()
}

fn energy(particles: &Particles, restraint: &impl Restraint) -> f64 {
    particles.hamiltonian(restraint, 0.5 * particles.x[0].norm_squared())
}

fn restraint(law: Law) -> Kinetic {
    Kinetic::with_law(law, 0.01, 0.1).unwrap()
}

/// Greatest deviation of the restrained energy from its first value in each tenth of a run.
fn deviations(law: Law, scheme: Scheme, h: f64, n_steps: usize) -> Vec<f64> {
    let policy = restraint(law);
    let mut stepper = Explicit::new(policy, scheme);
    let mut particles = released();
    let e0 = energy(&particles, &policy);
    let tenth = |_| {
        let mut worst: f64 = 0.0;
        for _ in 0..n_steps / 10 {
            stepper.step(&mut particles, h, spring).unwrap();
            worst = worst.max((energy(&particles, &policy) - e0).abs());
        }
        worst
    };
    (0..10).map(tenth).collect()
}

#[test]
fn no_drift_over_a_million_steps() {
    for law in Law::ALL {
        for (scheme, h, bound) in
            [(Scheme::SymplecticEuler, 0.01, 5e-3), (Scheme::StormerVerlet, 0.02, 5e-4)]
        {
            let worst = deviations(law, scheme, h, 1_000_000);
            // It oscillates by as much in the last tenth as in the first, and never by much.
            let most = worst.iter().fold(0.0, |a: f64, b| a.max(*b));
            assert!(most < bound, "{law:?} {scheme:?} {worst:?}");
            assert!(most < 1.3 * worst[0], "{law:?} {scheme:?} {worst:?}");
        }
    }
}

/// The test that tells restrained dynamics from mere freezing.
#[test]
fn deviation_halves_with_the_step() {
    for law in Law::ALL {
        let worst = |h: f64| deviations(law, Scheme::SymplecticEuler, h, (200.0 / h) as usize)[9];
        let ratio = worst(0.004) / worst(0.002);
        assert!((1.9..2.1).contains(&ratio), "{law:?} {ratio}");
    }
}

/// Freezing what is slow, at p/m otherwise, conserves no energy: the deviation is that of the frozen
/// stretches, whatever the step. The test above would find it.
#[test]
fn freezing_is_not_restraining() {
    let worst = |h: f64| {
        let policy = restraint(Law::Ramp);
        let mut particles = released();
        let e0 = energy(&particles, &policy);
        let mut worst: f64 = 0.0;
        for _ in 0..(200.0 / h) as usize {
            let f = -particles.x[0];
            particles.p[0] += h * f;
            let p = particles.p[0];
            if policy.at(&particles.particle(0)).motion(&p) != Motion::Rest {
                particles.x[0] += h * p;
            }
            worst = worst.max((energy(&particles, &policy) - e0).abs());
        }
        worst
    };
    let ratio = worst(0.004) / worst(0.002);
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
}

#[test]
fn period_against_the_table() {
    // arps_oscillator_period.csv: ε_r, ε_f, period (s), for the spline in the energy.
    const PERIODS: [[f64; 3]; 7] = [
        [0.0, 1e-12, std::f64::consts::TAU],
        [0.005, 0.01, 6.28194313431],
        [0.01, 0.05, 6.27273689505],
        [0.01, 0.1, 6.25578074242],
        [0.05, 0.1, 6.24066484036],
        [0.05, 0.25, 6.14067859491],
        [0.1, 0.3, 6.05046241351],
    ];
    for [energy_r, energy_f, period] in PERIODS {
        let h = 1e-4;
        let policy = Kinetic::with_law(Law::Spline, energy_r, energy_f).unwrap();
        let mut stepper = Explicit::new(policy, Scheme::StormerVerlet);
        let mut particles = released();
        // The momentum passes through 0 from above once a period, while the particle rests and so in
        // a straight line.
        let mut crossings = Vec::new();
        while crossings.len() < 2 {
            let (t, p) = (particles.time, particles.p[0].x);
            stepper.step(&mut particles, h, spring).unwrap();
            let next = particles.p[0].x;
            if p > 0.0 && next <= 0.0 {
                crossings.push(t + h * p / (p - next));
            }
        }
        let measured = crossings[1] - crossings[0];
        assert!(
            (measured - period).abs() < 2e-7,
            "{energy_r} {energy_f}: {measured}, not {period}"
        );
    }
}

#[test]
fn phase_portrait_against_the_table() {
    // Rows of arps_oscillator_portrait_er0.01_ef0.1.csv: t, q, p, H_AR.
    const PORTRAIT: &str = "\
0,1,0,0.5
0.626669231943,0.805948496227,-0.591985659752,0.499999999962
1.37666923194,0.18618317251,-0.982515051385,0.499999999962
2.13166923194,-0.537714525141,-0.843126971088,0.499999999962
2.88257825637,-0.997675831501,-0.24526447782,0.500000000188
3.62984444995,-0.873327149166,0.487134161175,0.500000000227
4.37984444995,-0.306954228342,0.951724278432,0.500000000227
5.12984444995,0.424137164903,0.905597960357,0.500000000227
5.88055729696,0.944423995849,0.372405941562,0.500000000506";
    for rows in [table(PORTRAIT), reference("arps_oscillator_portrait_er0.01_ef0.1.csv")] {
        let policy = restraint(Law::Spline);
        let mut stepper = Explicit::new(policy, Scheme::StormerVerlet);
        let mut particles = released();
        for row in rows {
            let left = row[0] - particles.time;
            let n = (left / 1e-4).ceil();
            for _ in 0..n as usize {
                stepper.step(&mut particles, left / n, spring).unwrap();
            }
            let (q, p) = (particles.x[0].x, particles.p[0].x);
            assert!((q - row[1]).abs() < 2e-7 && (p - row[2]).abs() < 2e-7, "{q} {p} {row:?}");
            assert!((energy(&particles, &policy) - row[3]).abs() < 1e-7);
        }
    }
}

/// Damping uses the effective velocity. With the paper's law a damped particle creeps towards p_r
/// without arriving: a speed a hundred times smaller takes ten times as long. With a convex law it
/// takes a few units of time more.
#[test]
fn damped_particles_stop_with_a_convex_law() {
    let time_until = |law: Law, speed: f64| {
        let policy = restraint(law);
        let mut stepper = Explicit::new(policy, Scheme::SymplecticEuler);
        let mut particles =
            Particles::new(vec![Vector3::zeros()], &[Vector3::x()], vec![1.0]).unwrap();
        while policy.at(&particles.particle(0)).velocity(&particles.p[0]).norm() > speed {
            stepper.step(&mut particles, 0.01, |now, f| f[0] -= now.v[0]).unwrap();
        }
        particles.time
    };
    let [ramp, spline] =
        [Law::Ramp, Law::Spline].map(|law| [1e-4, 1e-6].map(|v| time_until(law, v)));
    assert!(ramp[1] < ramp[0] + 5.0 && ramp[1] < 12.0, "{ramp:?}");
    assert!(spline[1] > 8.0 * spline[0] && spline[1] > 400.0, "{spline:?}");
}

/// A damped oscillator loses restrained energy in every step (Manteaux2013 Fig. 3: a spiral).
#[test]
fn a_damped_oscillator_spirals_in() {
    for law in Law::ALL {
        let policy = Kinetic::with_law(law, 0.001, 0.01).unwrap();
        let mut stepper = Explicit::new(policy, Scheme::StormerVerlet);
        let mut particles = released();
        let mut last = energy(&particles, &policy);
        for turn in 0..5 {
            for _ in 0..6300 {
                let damped = |now: Now<'_>, f: &mut [Vector3]| f[0] -= now.x[0] + 0.1 * now.v[0];
                stepper.step(&mut particles, 1e-3, damped).unwrap();
            }
            let now = energy(&particles, &policy);
            assert!(now < 0.8 * last, "{law:?} {turn}: {now} after {last}");
            last = now;
        }
    }
}
