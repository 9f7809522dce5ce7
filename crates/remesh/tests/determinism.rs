//! The same bits at any number of threads, and after saving and restoring the state.

mod common;

use common::{At, grid, kind, sewn, stir};
use mesh_core::generate::Diagonal;
use mesh_core::{ClothState, Material2, Mesh, World3, par};
use remesh::{Metric, PhysicalSizing, RemeshReport, RemeshSettings, remesh};

const SIZING: PhysicalSizing = PhysicalSizing {
    refine_angle: 0.2,
    refine_velocity: 0.3,
    refine_compression: 0.01,
    size_min: 0.01,
    size_max: 0.2,
    aspect_min: 0.2,
};

/// Something like motion: the same for the same state.
fn advance(cloth: &mut ClothState, frame: u32) {
    let phase = 0.3 * f64::from(frame);
    for (x, v) in cloth.x.iter_mut().zip(&mut cloth.v) {
        *v = World3::new((3.0 * x.y + phase).sin(), 0.2 * x.z, (6.0 * x.x - phase).cos());
        *x += *v * 0.02;
    }
}

fn frame(cloth: &mut ClothState, number: u32) -> RemeshReport {
    advance(cloth, number);
    remesh(cloth, &SIZING, &RemeshSettings::default()).unwrap()
}

/// What a checkpoint holds, and nothing else.
fn save_and_restore(cloth: &ClothState) -> ClothState {
    let mesh = &cloth.mesh;
    let restored = Mesh::new(
        mesh.n_vertices(),
        mesh.triangles().to_vec(),
        mesh.material().to_vec(),
        mesh.panels().to_vec(),
    )
    .unwrap()
    .with_uids(mesh.uids().to_vec(), mesh.next_uid())
    .unwrap();
    ClothState::new(restored, cloth.x.clone(), cloth.v.clone(), cloth.densities().to_vec()).unwrap()
}

/// Bit for bit, but for the count of edits that a restored mesh starts anew.
fn assert_same(a: &ClothState, b: &ClothState) {
    assert_eq!(a.mesh.triangles(), b.mesh.triangles());
    assert_eq!(a.mesh.material(), b.mesh.material());
    assert_eq!(a.mesh.uids(), b.mesh.uids());
    assert_eq!((&a.x, &a.v, &a.m), (&b.x, &b.v, &b.m));
}

#[test]
fn one_two_and_five_threads_agree() {
    let run = |threads: usize| {
        par::with_threads(threads, || {
            let mut cloth = stir(grid([1.0, 1.0], [12, 12], Diagonal::Alternating));
            let reports: Vec<_> = (0..8).map(|k| frame(&mut cloth, k)).collect();
            (cloth, reports)
        })
        .unwrap()
    };
    let (one, reports) = run(1);
    assert!(reports.iter().map(RemeshReport::n_edits).sum::<usize>() > 2000);
    for threads in [2, 5] {
        assert_eq!(run(threads), (one.clone(), reports.clone()));
    }
}

#[test]
fn a_restored_state_goes_on_with_the_same_bits() {
    for start in
        [stir(grid([1.0, 1.0], [9, 9], Diagonal::One)), stir(sewn([8, 4], 0.8)), stir(kind(9))]
    {
        let mut straight = start.clone();
        let mut saved = start;
        for number in 0..6 {
            let (p, q) = (frame(&mut straight, number), frame(&mut saved, number));
            assert_eq!(p, q);
            assert_same(&straight, &saved);
            saved = save_and_restore(&saved);
            assert_same(&straight, &saved);
        }
    }
}

#[test]
fn the_result_depends_on_the_state_alone() {
    let field = At(|u: Material2| Metric::uniform(0.03 + 0.1 * u.norm()));
    let run = || {
        let mut cloth = kind(4);
        let report = remesh(&mut cloth, &field, &RemeshSettings::default()).unwrap();
        (cloth, report)
    };
    assert_eq!(run(), run());
}
