//! Wrinkles that a mesh is too coarse for.

mod common;

use cloth_dynamics::ElementModel;
use cloth_dynamics::{Constraints, Fabric, MembraneModel, RestTriangle, Stage};
use common::{Run, fabric, gravity, sheet};
use mesh_core::World3;
use mesh_core::generate::Diagonal;
use std::f64::consts::PI;
use std::sync::Arc;

/// Pushed together, a plate carries its buckling load and no more.
#[test]
fn compression_ends_at_the_buckling_load() {
    let (side, rigidity) = (0.02, 1e-5);
    let cloth = sheet([side, side], [1, 1], Diagonal::One, 0.2);
    let wrinkled = Fabric { tension_field: true, ..fabric(1000.0, rigidity, 0.2) };
    let rest = Arc::new(RestTriangle::all(&cloth));
    let mut model = MembraneModel::new(cloth.mesh.triangles(), rest, Arc::new(vec![wrinkled]));
    model.begin(Stage { x_t0: &cloth.x, base: &cloth.x, h: 0.01 });
    // What pushes back at the right side (N), and the load of its triangles: 2π²/3 B Σ b bᵀ with
    // Σ b₁² = 2/side².
    let push = |shortened: f64| -> f64 {
        let x: Vec<World3> =
            cloth.x.iter().map(|x| World3::new((1.0 - shortened) * x.x, x.y, x.z)).collect();
        let elements = model.stencils().iter().enumerate();
        let forces = elements.flat_map(|(e, stencil)| {
            let gradient = model.gradient(e, &stencil.map(|i| x[i as usize]));
            stencil.map(|i| i as usize).into_iter().zip(gradient)
        });
        let right = forces.filter(|(i, _)| cloth.x[*i].x > 0.5 * side);
        right.map(|(_, g)| -g.x).sum()
    };
    let load = 4.0 / 3.0 * PI * PI * rigidity / (side * side);
    for shortened in [0.01, 0.1, 0.5] {
        // The first Piola–Kirchhoff stress is F S.
        let expected = (1.0 - shortened) * load * side;
        let found = push(shortened);
        // Folds are a little askew in a triangle that is not symmetric.
        assert!((found - expected).abs() < 1e-2 * expected, "{shortened}: {found} {expected}");
    }
    // Before that it is the law that resists.
    let strain = 0.5 * load / 1000.0;
    let found = push(strain);
    let expected = 1000.0 * strain * side;
    assert!((found - expected).abs() < 1e-2 * expected, "{found} {expected}");
}

/// How far the middle of a sheet hangs down (m) between two corners that are nearer to each other
/// than it is wide: folds form that a coarse mesh has no vertices for.
fn sag(cells: usize, tension_field: bool) -> f64 {
    let cloth = sheet([1.0, 1.0], [cells, cells], Diagonal::Alternating, 0.2);
    let corner = |x: f64| {
        let at = |p: &World3| (p.x - x).abs() < 1e-9 && (p.y - 1.0).abs() < 1e-9;
        cloth.x.iter().position(at).expect("a corner") as u32
    };
    let (left, right) = (corner(0.0), corner(1.0));
    let held = Constraints {
        fixed: vec![(left, World3::new(0.1, 1.0, 0.0)), (right, World3::new(0.9, 1.0, 0.0))],
        springs: vec![],
    };
    let fabric = Fabric { tension_field, ..fabric(1000.0, 1e-5, 0.2) };
    let mut run = Run::new(cloth, fabric, &gravity());
    run.rest(&held, 0.1);
    run.cloth.x.iter().map(|x| -x.z).sum::<f64>() / run.cloth.x.len() as f64
}

/// The stiffness of a coarse mesh that Koh2014 §5 describes.
#[test]
fn coarse_cloth_hangs_as_fine_cloth_does() {
    let fine = sag(24, false);
    let (plain, wrinkled) = (sag(4, false), sag(4, true));
    println!(
        "centre below the corners: fine {fine:.4} m, coarse {plain:.4} m, wrinkled {wrinkled:.4} m"
    );
    assert!((wrinkled - fine).abs() < 0.5 * (plain - fine).abs(), "{fine} {plain} {wrinkled}");
}
