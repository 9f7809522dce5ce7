//! A step of a dam break of 5,120 particles, free and when most of it rests.

use arps::Speed;
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use sph::{RestraintSettings, scenes};

/// Layers of particles over the height of the column.
const LAYERS: usize = 20;

fn free_step(c: &mut Criterion) {
    let mut fluid = scenes::dam_break(LAYERS, 0).expect("the scene is good").fluid;
    fluid.advance(0.3).expect("nothing leaves the domain");
    c.bench_function("free step of fluid", |b| {
        b.iter_batched_ref(
            || fluid.clone(),
            |fluid| fluid.step(fluid.step_bound()).expect("nothing leaves the domain"),
            BatchSize::LargeInput,
        );
    });
}

fn resting_step(c: &mut Criterion) {
    // A shallow block that has nothing to do but calm down.
    let fluid = scenes::block_fall(12, 0).expect("the scene is good").fluid;
    let settings = RestraintSettings {
        bleeding: Some(0.02),
        inactivity: 0.01,
        ..RestraintSettings::of(fluid.settings())
    };
    let policy = Speed::new(0.1, 0.2).expect("in order");
    let mut fluid = fluid.restrained(policy, settings).expect("in range");
    fluid.advance(5.0).expect("nothing leaves the domain");
    c.bench_function("step of fluid at rest", |b| {
        b.iter(|| fluid.step(fluid.step_bound()).expect("nothing leaves the domain"));
    });
}

criterion_group!(benches, free_step, resting_step);
criterion_main!(benches);
