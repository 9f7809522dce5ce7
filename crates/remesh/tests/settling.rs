//! Remeshing again and again: nothing oscillates, what is done is done at once.

mod common;

use common::{At, grid, kind, noise, run, sewn, stir};
use mesh_core::generate::{self, Diagonal};
use mesh_core::{Material2, World3};
use remesh::{CornerMetrics, Metric, PhysicalSizing, RemeshSettings, SizingField, adapt};

#[test]
fn a_second_call_with_an_unchanged_constant_field_does_nothing() {
    for mesh in 0..common::N_KINDS {
        for field in
            [Metric::uniform(0.07), Metric::with_sizes(Material2::new(1.0, 0.4), 0.2, 0.05)]
        {
            let field = At(move |_| field);
            let mut cloth = stir(kind(mesh));
            run(&mut cloth, &field);
            let again = cloth.clone();
            let report = run(&mut cloth, &field);
            assert_eq!(report.journal, [], "mesh {mesh}");
            assert_eq!(cloth, again);
        }
    }
}

/// A field that is known everywhere settles: the sampling of the first calls catches up with it.
#[test]
fn known_fields_settle() {
    let fine = |u: Material2| Metric::uniform(0.02 + 0.15 * (u - Material2::new(0.4, 0.6)).norm());
    let stripes = |u: Material2| {
        Metric::with_sizes(Material2::x(), 0.02 + 0.1 * (4.0 * u.x).sin().powi(2), 0.1)
    };
    let step = |u: Material2| Metric::uniform(if u.x + 0.3 * u.y < 0.5 { 0.02 } else { 0.15 });
    fn settle(field: &dyn SizingField) -> Vec<usize> {
        let mut cloth = grid([1.0, 1.0], [9, 9], Diagonal::Alternating);
        (0..14).map(|_| run(&mut cloth, field).n_edits()).collect()
    }
    for edits in [settle(&At(fine)), settle(&At(stripes)), settle(&At(step))] {
        assert!(edits[12] + edits[13] == 0, "{edits:?}");
    }
}

/// Fine spots that only a few vertices stand for: a collapse that forgot one would be undone in the
/// next call, for ever.
#[test]
fn small_spots_are_not_forgotten_and_found_again() {
    for seed in [34u64, 52, 55, 100, 103, 112, 115, 118] {
        let fine = 0.02 + 0.03 * noise(seed, 1);
        let coarse = 0.1 + 0.3 * noise(seed, 2);
        let field = At(move |u: Material2| {
            let spot = |k: u64| Material2::new(noise(seed, 10 + k), noise(seed, 20 + k));
            let far = (0..5).map(|k| (u - spot(k)).norm()).fold(1.0, f64::min) / (2.0 * fine);
            Metric::uniform(fine + (coarse - fine) * (1.0 - (-far * far).exp()))
        });
        let diagonal = if seed % 2 == 0 { Diagonal::Alternating } else { Diagonal::One };
        let mut cloth = grid([1.0, 1.0], [7, 7], diagonal);
        let edits: Vec<_> = (0..20).map(|_| run(&mut cloth, &field).n_edits()).collect();
        assert_eq!(edits[17..], [0; 3], "seed {seed}: {edits:?}");
    }
}

/// Fine meshes under fields that let most of them go: what one call leaves, it leaves for good.
#[test]
fn coarsening_goes_to_the_end_at_once() {
    for (n, cloth) in [
        stir(grid([1.0, 1.0], [40, 40], Diagonal::Alternating)),
        stir(grid([1.0, 1.0], [40, 40], Diagonal::One)),
        stir(common::rest(generate::disc(0.5, 20).unwrap())),
        stir(sewn([60, 30], 0.8)),
    ]
    .into_iter()
    .enumerate()
    {
        for k in 0..6 {
            let turn = f64::from(k);
            let field = At(move |u: Material2| {
                let angle = turn + 3.0 * u.x;
                let along = Material2::new(angle.cos(), angle.sin());
                let size = 0.05 + 0.1 * (turn + 4.0 * u.y).sin().powi(2);
                Metric::with_sizes(along, 2.5 * size, size)
            });
            let mut cloth = cloth.clone();
            let settings = RemeshSettings::default();
            let mut metrics = CornerMetrics::evaluate(&cloth, &field, &settings).unwrap();
            let first = adapt(&mut cloth, &mut metrics, &settings).unwrap();
            assert!(first.n_collapses > 300, "mesh {n}: {}", first.n_collapses);
            common::check_sectors(&cloth.mesh, &metrics);
            let second = adapt(&mut cloth, &mut metrics, &settings).unwrap();
            assert_eq!(second.journal, [], "mesh {n}, field {k}");
        }
    }
}

#[test]
fn a_field_that_moves_a_little_costs_few_edits() {
    let mut cloth = grid([1.0, 1.0], [6, 6], Diagonal::Alternating);
    let bump = |x: f64| At(move |u: Material2| Metric::uniform(0.01 + 0.1 * (u.x - x).abs()));
    for _ in 0..6 {
        run(&mut cloth, &bump(0.5));
    }
    let all = cloth.mesh.n_triangles();
    let report = run(&mut cloth, &bump(0.501));
    assert!(report.n_edits() * 10 < all, "{} edits, {all} triangles", report.n_edits());
}

#[test]
fn moving_ripples_leave_few_thin_triangles() {
    // Curvature asks for the most anisotropic metric that the bound allows nearly everywhere.
    let sizing = PhysicalSizing {
        refine_angle: 0.22,
        size_min: 0.004,
        size_max: 0.1,
        ..PhysicalSizing::default()
    };
    let mut cloth = grid([1.0, 1.0], [10, 10], Diagonal::Alternating);
    let (mut n_low, mut n_all) = (0, 0);
    for frame in 0..16 {
        let centre = Material2::new(0.35 + 0.005 * f64::from(frame), 0.5);
        let corners: Vec<_> = cloth.mesh.triangles().iter().zip(cloth.mesh.material()).collect();
        let mut x = cloth.x.clone();
        for (v, u) in corners.into_iter().flat_map(|(t, u)| t.iter().zip(u)) {
            let r = (u - centre).norm();
            let height = 0.02 * (-0.5 * (r / 0.18).powi(2)).exp() * (60.0 * r).cos();
            x[*v as usize] = World3::new(u.x, u.y, height);
        }
        cloth.x = x;
        let quality = run(&mut cloth, &sizing).quality;
        assert_eq!(quality.n_invalid, 0);
        n_low += quality.n_below_aspect;
        n_all += quality.n_triangles;
    }
    assert!(n_all > 80_000);
    assert!((n_low as f64) < 1.6e-3 * n_all as f64, "{n_low} of {n_all}");
}
