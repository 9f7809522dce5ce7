//! Explicit steps of 100 000 particles with springs to neighbours: plain, with the policy of none, and
//! restrained with all moving and all resting.

use arps::{Explicit, Now, Particles, Restraint, Scheme, Speed, Vector3};
use criterion::{Criterion, criterion_group, criterion_main};
use std::hint::black_box;

const N: usize = 100_000;
const H: f64 = 1e-3;

/// A chain in motion, at about 1 m/s.
fn chain() -> Particles {
    let x = (0..N).map(|i| Vector3::new(0.1 * i as f64, 0.0, 0.0)).collect();
    let v: Vec<Vector3> =
        (0..N).map(|i| Vector3::new((i as f64).sin(), (i as f64).cos(), 0.1)).collect();
    Particles::new(x, &v, vec![0.1; N]).expect("the chain is finite")
}

fn springs(x: &[Vector3], f: &mut [Vector3]) {
    for i in 1..x.len() {
        let pull = 10.0 * (x[i] - x[i - 1] - 0.1 * Vector3::x());
        f[i] -= pull;
        f[i - 1] += pull;
    }
}

fn plain(c: &mut Criterion) {
    let mut particles = chain();
    let mut f = vec![Vector3::zeros(); N];
    c.bench_function("explicit, plain loop", |b| {
        b.iter(|| {
            f.fill(Vector3::zeros());
            springs(black_box(&particles.x), &mut f);
            for i in 0..N {
                particles.p[i] += H * f[i];
                let v = particles.p[i] / particles.masses()[i];
                particles.x[i] += H * v;
            }
        });
    });
}

fn restrained(c: &mut Criterion, name: &str, policy: impl Restraint) {
    let mut particles = chain();
    let mut stepper = Explicit::new(policy, Scheme::SymplecticEuler);
    c.bench_function(name, |b| {
        b.iter(|| {
            let force = |now: Now<'_>, f: &mut [Vector3]| springs(black_box(now.x), f);
            stepper.step(&mut particles, H, force).expect("the step is short")
        });
    });
}

fn policies(c: &mut Criterion) {
    let speed = |v_r: f64, v_f: f64| Speed::new(v_r, v_f).expect("the thresholds are in order");
    restrained(c, "explicit, none", ());
    restrained(c, "explicit, all moving", speed(1e-6, 1e-5));
    restrained(c, "explicit, all in transition", speed(0.1, 1e3));
    restrained(c, "explicit, all resting", speed(1e3, 1e4));
}

criterion_group! {
    name = restraint;
    config = Criterion::default().sample_size(20);
    targets = plain, policies
}
criterion_main!(restraint);
