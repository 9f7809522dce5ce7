//! The three kernels that a frame spends its time in, on a sheet of 10 000 triangles.

use cloth_dynamics::solver::{LinearSettings, LinearSolver, SparseCholesky};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use nalgebra::Vector3;
use organza_benches::{Assembly, wavy_sheet};
use remesh::{PhysicalSizing, RemeshSettings, remesh};
use std::hint::black_box;

/// 2 · 71² = 10 082 triangles.
const CELLS: usize = 71;

fn assembly(c: &mut Criterion) {
    let cloth = wavy_sheet(CELLS).expect("the sheet is small");
    let mut assembly = Assembly::new(&cloth).expect("the sheet is small");
    c.bench_function("assembly", |b| b.iter(|| assembly.assemble(black_box(&cloth))));
}

fn factorisation(c: &mut Criterion) {
    let cloth = wavy_sheet(CELLS).expect("the sheet is small");
    let mut assembly = Assembly::new(&cloth).expect("the sheet is small");
    let (matrix, right) = assembly.step_matrix(&cloth);
    // The analysis stays from one solve to the next; the factor does not.
    let mut solver = SparseCholesky::new(LinearSettings::default());
    let mut x = vec![Vector3::zeros(); right.len()];
    c.bench_function("factorisation", |b| {
        b.iter(|| {
            x.fill(Vector3::zeros());
            solver.solve(black_box(&matrix), &right, &mut x).expect("positive definite")
        });
    });
}

fn remeshing(c: &mut Criterion) {
    let cloth = wavy_sheet(CELLS).expect("the sheet is small");
    let (sizing, settings) = (PhysicalSizing::default(), RemeshSettings::default());
    c.bench_function("remesh", |b| {
        b.iter_batched_ref(
            || cloth.clone(),
            |cloth| remesh(cloth, &sizing, &settings).expect("the settings are in range"),
            BatchSize::LargeInput,
        );
    });
}

criterion_group! {
    name = kernels;
    config = Criterion::default().sample_size(20);
    targets = assembly, factorisation, remeshing
}
criterion_main!(kernels);
