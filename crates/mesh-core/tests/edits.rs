//! Random edits keep every invariant: manifold, Euler characteristic, area, mass, momentum.

use mesh_core::generate::{Diagonal, grid};
use mesh_core::{ClothState, Edit, HalfEdge, Material2, Mesh, VertexField, World3};
use proptest::prelude::*;

/// Two panels of different material coordinates sewn along one edge, as a corner-table mesh.
fn sewn() -> ClothState {
    let sheet = grid([2.0, 1.0], [6, 3], Diagonal::Alternating).unwrap();
    let (mut material, mut panels) = (sheet.mesh.material().to_vec(), vec![0; 36]);
    for (corners, panel) in material.iter_mut().zip(&mut panels) {
        if corners.iter().all(|u| u.x >= 1.0) {
            *panel = 1;
            // The second panel was cut elsewhere on the bolt, turned by 90°.
            *corners = corners.map(|u| Material2::new(5.0 - u.y, u.x));
        }
    }
    let triangles = sheet.mesh.triangles().to_vec();
    let mesh = Mesh::new(28, triangles, material, panels).unwrap();
    ClothState::at_rest(mesh, sheet.positions, vec![0.2, 0.3]).unwrap()
}

fn plain() -> ClothState {
    let sheet = grid([1.0, 1.0], [4, 4], Diagonal::One).unwrap();
    ClothState::at_rest(sheet.mesh, sheet.positions, vec![0.15]).unwrap()
}

fn swirl(mut cloth: ClothState) -> ClothState {
    for (x, v) in cloth.x.iter().zip(&mut cloth.v) {
        *v = World3::new(3.0 * x.y, -2.0 * x.x + x.y * x.y, (5.0 * x.x).sin());
    }
    cloth
}

/// One random edit; returns it if the mesh allowed it.
fn random_edit(cloth: &mut ClothState, kind: u8, pick: u32) -> Option<Edit> {
    let h = HalfEdge(pick % (3 * cloth.mesh.n_triangles() as u32));
    let (a, b) = (cloth.mesh.origin(h), cloth.mesh.dest(h));
    match kind {
        0 if cloth.mesh.n_triangles() < 4000 => cloth.split(h).ok(),
        1 => cloth.flip(h).ok(),
        2 => cloth.collapse(a, b).ok(),
        _ => cloth.collapse(b, a).ok(),
    }
}

/// Applies edits and checks all that must not change; returns how many were made.
fn check_edits(
    mut cloth: ClothState,
    edits: impl Iterator<Item = (u8, u32)>,
    every: usize,
) -> usize {
    let (area, euler) = (cloth.mesh.total_area(), cloth.mesh.euler_characteristic());
    let (mass, momentum) = (cloth.total_mass(), cloth.momentum());
    let ones = vec![1.0; cloth.mesh.n_vertices()];
    let mut field = VertexField::new(&cloth.mesh, ones);
    let mut made = 0;
    for (kind, pick) in edits {
        let Some(edit) = random_edit(&mut cloth, kind, pick) else { continue };
        made += 1;
        field.follow(&[edit]);
        if made % every == 0 {
            cloth.mesh.validate().unwrap();
        }
    }
    cloth.mesh.validate().unwrap();
    assert_eq!(cloth.mesh.euler_characteristic(), euler);
    assert!((cloth.mesh.total_area() / area - 1.0).abs() < 1e-12, "area {area}");
    assert!((cloth.total_mass() / mass - 1.0).abs() < 1e-12, "mass {mass}");
    let drift = (cloth.momentum() - momentum).norm();
    assert!(drift < 1e-12 * mass * 10.0, "momentum drifted by {drift} kg m/s");
    assert_eq!(field.epoch(), cloth.mesh.epoch());
    assert!(field.values().iter().all(|&one| one == 1.0));
    made
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn short_random_runs(edits in prop::collection::vec((0u8..4, any::<u32>()), 1..200), seams: bool) {
        check_edits(swirl(if seams { sewn() } else { plain() }), edits.into_iter(), 1);
    }
}

#[test]
fn a_hundred_thousand_edits() {
    for cloth in [plain(), sewn()] {
        // A fixed 64-bit generator (Knuth's MMIX constants): the same edits on every machine.
        let mut seed = 7u64;
        let mut next = move || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as u32
        };
        let edits = (0..300_000).map(move |_| ((next() % 4) as u8, next()));
        let made = check_edits(swirl(cloth), edits, 1000);
        assert!(made > 100_000, "only {made} edits were possible");
    }
}
