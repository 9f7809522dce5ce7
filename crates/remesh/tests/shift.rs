//! Flips and collapses move the surface no farther than its vertices allow.

mod common;

use common::{flat, kind, noise, stir};
use mesh_core::geometry::inverse_edges;
use mesh_core::{ClothState, Material2, TriangleId, World3};
use nalgebra::Matrix3;
use proptest::prelude::*;
use remesh::{RemeshError, RemeshSettings, Uniform, remesh};

/// Remeshes with long edges; the same limit (1/m²) everywhere.
fn coarsened(mut cloth: ClothState, limit: Matrix3<f64>) -> ClothState {
    let shift = vec![limit; cloth.x.len()];
    let settings = RemeshSettings { shift: &shift, ..RemeshSettings::default() };
    remesh(&mut cloth, &Uniform { size: 3.0 }, &settings).unwrap();
    cloth
}

/// The metric that allows a length (m) in all directions.
fn length(l: f64) -> Matrix3<f64> {
    Matrix3::identity() / (l * l)
}

/// A roof whose ridge wants to be flipped, which takes the middle of it down by its height.
#[test]
fn a_flip_moves_the_crossing_of_the_diagonals() {
    let height = 0.02;
    let flipped = |limit: Matrix3<f64>| {
        let points = [[-0.5, 0.0], [0.5, 0.0], [0.0, 0.1], [0.0, -0.1]];
        let mut roof = flat(&points, &[[0, 1, 2], [1, 0, 3]]);
        (roof.x[0].z, roof.x[1].z) = (height, height);
        let roof = coarsened(roof, limit);
        // The ridge is on both triangles as long as it is there.
        roof.mesh.triangles().iter().any(|t| !(t.contains(&0) && t.contains(&1)))
    };
    assert!(flipped(Matrix3::zeros()), "the example asks for no flip");
    assert!(flipped(length(1.001 * height)));
    assert!(!flipped(length(0.999 * height)));
    assert!(!flipped(Matrix3::repeat(f64::NAN)));
    // Down it may not, but sideways.
    let along = |d: World3| d * d.transpose() * 1e20;
    assert!(!flipped(along(World3::z())));
    assert!(flipped(along(World3::x()) + along(World3::y())));
}

/// A pyramid loses its top only if the base is near enough.
#[test]
fn a_collapse_moves_the_place_of_the_vertex() {
    let height = 0.05;
    let left = |limit: Matrix3<f64>| {
        let corner = |k: u32| (std::f64::consts::TAU * f64::from(k) / 6.0).sin_cos();
        let ring = (0..6).map(|k| [corner(k).1, corner(k).0]);
        let points: Vec<_> = std::iter::once([0.0, 0.0]).chain(ring).collect();
        let triangles: Vec<_> = (0..6).map(|k| [0, 1 + k, 1 + (k + 1) % 6]).collect();
        let mut pyramid = flat(&points, &triangles);
        pyramid.x[0].z = height;
        coarsened(pyramid, limit).x.len()
    };
    assert_eq!(left(Matrix3::zeros()), 6);
    assert_eq!(left(length(1.001 * height)), 6);
    assert_eq!(left(length(0.999 * height)), 7);
    assert_eq!(left(Matrix3::repeat(f64::NAN)), 7);
}

/// Where a material point of a panel is (m).
fn place(cloth: &ClothState, panel: u32, at: Material2) -> World3 {
    let mesh = &cloth.mesh;
    let weights = |t: TriangleId| {
        let u = mesh.material()[t.index()];
        let s = inverse_edges(u) * (at - u[0]);
        [1.0 - s.x - s.y, s.x, s.y]
    };
    let least = |t: &TriangleId| weights(*t).into_iter().fold(f64::INFINITY, f64::min);
    let on_panel = mesh.triangle_ids().filter(|t| mesh.panels()[t.index()] == panel);
    let t = on_panel.max_by(|s, t| least(s).total_cmp(&least(t))).unwrap();
    let (x, w) = (cloth.corners(t), weights(t));
    (0..3).map(|k| x[k] * w[k]).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// What may not move stays where it is, whatever is wanted there and happens beside it.
    #[test]
    fn what_may_not_move_does_not(
        mesh in 0usize..common::N_KINDS,
        seed in 0u64..1000,
        share in 0.0..1.0f64,
        size in 0.03..1.0f64,
    ) {
        let before = stir(kind(mesh));
        let still = |v: u32| noise(seed, u64::from(v)) < share;
        let limit = |v| if still(v) { length(1e-12) } else { Matrix3::zeros() };
        let shift: Vec<_> = (0..before.x.len() as u32).map(limit).collect();
        let settings =
            RemeshSettings { shift: &shift, max_vertices: 2000, ..RemeshSettings::default() };
        let mut after = before.clone();
        remesh(&mut after, &Uniform { size }, &settings).unwrap();
        for t in before.mesh.triangle_ids() {
            if !before.mesh.triangles()[t.index()].iter().all(|v| still(*v)) {
                continue;
            }
            let (u, x) = (before.mesh.material()[t.index()], before.corners(t));
            for w in [[1.0, 0.0, 0.0], [0.2, 0.5, 0.3], [0.3, 0.1, 0.6], [0.5, 0.5, 0.0]] {
                let at: Material2 = (0..3).map(|k| u[k] * w[k]).sum();
                let was: World3 = (0..3).map(|k| x[k] * w[k]).sum();
                let moved = (place(&after, before.mesh.panels()[t.index()], at) - was).norm();
                // Some of the meshes have triangles of 1e-5 m in height.
                prop_assert!(moved < 1e-9, "{moved} at {at}");
            }
        }
    }

    /// A limit that nothing reaches changes no bit.
    #[test]
    fn no_limit_is_a_wide_limit(mesh in 0usize..common::N_KINDS, size in 0.03..1.0f64) {
        let run = |wide: bool| {
            let mut cloth = stir(kind(mesh));
            let shift = vec![length(1e6); if wide { cloth.x.len() } else { 0 }];
            let settings =
                RemeshSettings { shift: &shift, max_vertices: 2000, ..RemeshSettings::default() };
            let report = remesh(&mut cloth, &Uniform { size }, &settings).unwrap();
            (cloth, report)
        };
        prop_assert_eq!(run(true), run(false));
    }
}

#[test]
fn limits_of_another_mesh_are_refused() {
    let mut cloth = kind(1);
    let shift = [length(1.0); 3];
    let settings = RemeshSettings { shift: &shift, ..RemeshSettings::default() };
    let error = remesh(&mut cloth, &Uniform { size: 0.1 }, &settings).unwrap_err();
    assert_eq!(error, RemeshError::Shift { expected: 4, got: 3 });
    assert_eq!(error.to_string(), "shift has 3 entries for 4 vertices");
    assert_eq!(cloth, kind(1));
}
