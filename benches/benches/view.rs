//! What the view policy costs beside the physical sizing, on a crowd of 100 sheets of 1152 triangles
//! of which the camera sees a few, and on one of them that fills the picture.

use criterion::{Criterion, criterion_group, criterion_main};
use mesh_core::generate::{Diagonal, grid};
use mesh_core::{ClothState, Mesh, World3};
use remesh::{CornerMetrics, PhysicalSizing, RemeshSettings};
use sizing_view::{
    Camera, CameraPath, DepthBuffer, Key, Sample, Shot, ViewFactors, ViewSettings, ViewSizing,
    window,
};
use std::hint::black_box;

/// `n` wavy sheets of a square metre, two metres apart in rows of ten.
fn crowd(n: usize, cells: usize) -> ClothState {
    let one = grid([1.0, 1.0], [cells, cells], Diagonal::Alternating).expect("the sheet is small");
    let (mut triangles, mut material, mut panels, mut x) = (vec![], vec![], vec![], vec![]);
    for k in 0..n {
        let first = x.len() as u32;
        triangles.extend(one.mesh.triangles().iter().map(|t| t.map(|i| i + first)));
        material.extend_from_slice(one.mesh.material());
        panels.extend(vec![k as u32; one.mesh.n_triangles()]);
        let middle = World3::new((k % 10) as f64, (k / 10) as f64, 0.0) * 2.0;
        x.extend(
            one.positions
                .iter()
                .map(|p| middle + p + World3::z() * (0.1 * (9.0 * p.x).sin() * (7.0 * p.y).cos())),
        );
    }
    let mesh = Mesh::new(x.len(), triangles, material, panels).expect("sheets apart");
    ClothState::at_rest(mesh, x, vec![0.2; n]).expect("one density per sheet")
}

/// A camera above `target` that moves sideways, and the window of its next five frames.
fn samples(target: World3, height: f64, settings: &ViewSettings) -> Vec<Sample> {
    let key = |time: f64| {
        let x = World3::x() * time;
        let from = target + World3::new(0.0, -height, height);
        let camera = Camera::looking_at(from + x, target + x, World3::z(), 0.7, [1920, 1080]);
        Key { time, camera: camera.expect("a usual camera") }
    };
    let shot = Shot { start: 0.0, keys: vec![key(0.0), key(1.0)] };
    window(&CameraPath::new(vec![shot]).expect("two keys"), 0.5, 0.04, settings)
}

fn view(c: &mut Criterion) {
    let (field, settings) = (PhysicalSizing::default(), ViewSettings::default());
    let limits = RemeshSettings::default();
    for (name, n, cells, height) in [("crowd", 100, 24, 2.0), ("one", 1, 240, 1.2)] {
        let cloth = crowd(n, cells);
        let samples = samples(World3::new(0.5, 0.5, 0.0), height, &settings);
        let evaluate =
            || ViewFactors::evaluate(&cloth, &samples, &settings).expect("fine settings");
        let factors = evaluate();
        c.bench_function(&format!("{name}: physical sizing"), |b| {
            b.iter(|| CornerMetrics::evaluate(black_box(&cloth), &field, &limits));
        });
        c.bench_function(&format!("{name}: view factors"), |b| b.iter(evaluate));
        c.bench_function(&format!("{name}: physical sizing as seen"), |b| {
            let seen = ViewSizing::new(field, &factors);
            b.iter(|| CornerMetrics::evaluate(black_box(&cloth), &seen, &limits));
        });
        c.bench_function(&format!("{name}: depth buffer"), |b| {
            b.iter(|| {
                let mut depth = DepthBuffer::new(&samples[0].camera, 270, 0.02).expect("small");
                cloth.mesh.triangle_ids().for_each(|t| depth.draw(&cloth.corners(t)));
                depth
            });
        });
    }
}

criterion_group! {
    name = views;
    config = Criterion::default().sample_size(20);
    targets = view
}
criterion_main!(views);
