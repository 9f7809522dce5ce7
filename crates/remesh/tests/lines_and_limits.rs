//! What remeshing must not touch: seams, fixed panels, kept vertices, folds; and what it refuses.

mod common;

use common::{At, flat, grid, kind, panel_by_names, run, sewn, stir, together};
use mesh_core::generate::{self, Diagonal};
use mesh_core::{ClothState, HalfEdge, Material2, World3};
use remesh::{
    CornerMetrics, Metric, PerPanel, PhysicalSizing, RemeshError, RemeshSettings, SizingField,
    Uniform, adapt, remesh,
};

#[test]
fn seams_are_sized_by_their_finer_side_and_stay_where_they_are() {
    let fields = PerPanel { fields: vec![Uniform { size: 0.3 }, Uniform { size: 0.05 }] };
    let mut cloth = sewn([6, 3], 2.1);
    let report = run(&mut cloth, &fields);
    assert_eq!(report.quality.n_invalid, 0);
    let seam: Vec<HalfEdge> = cloth.mesh.edges().filter(|&h| cloth.mesh.is_seam(h)).collect();
    let length: f64 = seam.iter().map(|&h| cloth.mesh.material_edge(h).norm()).sum();
    assert!((length - 1.0).abs() < 1e-12);
    for &h in &seam {
        assert!(cloth.mesh.material_edge(h).norm() <= 0.05 + 1e-12);
        for end in [cloth.mesh.origin(h), cloth.mesh.dest(h)] {
            assert!((cloth.x[end.index()].x - 1.0).abs() < 1e-12);
        }
    }
    // Fine on one side only.
    let count = |panel| cloth.mesh.panels().iter().filter(|&&p| p == panel).count();
    assert!(count(1) > 8 * count(0), "{} and {}", count(0), count(1));
    // A panel's axes mean nothing to the other one: an anisotropic wish turns with the panel.
    let angle = 2.1f64;
    let along = |a: f64| Metric::with_sizes(Material2::new(a.cos(), a.sin()), 0.2, 0.05);
    let mut turned = sewn([6, 3], angle);
    let mut straight = sewn([6, 3], 0.0);
    let boxed = |m: Metric| -> Box<dyn SizingField> { Box::new(At(move |_| m)) };
    let p = run(&mut turned, &PerPanel { fields: vec![boxed(along(0.0)), boxed(along(angle))] });
    let q = run(&mut straight, &PerPanel { fields: vec![boxed(along(0.0)), boxed(along(0.0))] });
    let ratio = p.quality.n_triangles as f64 / q.quality.n_triangles as f64;
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
}

#[test]
fn fixed_panels_and_kept_vertices_are_left_alone() {
    // Needles in the fixed panel, and kept vertices at the end, where removals renumber.
    let mut cloth = stir(together(&[kind(8), grid([1.0, 1.0], [10, 10], Diagonal::One)]));
    let n_fixed = kind(8).mesh.n_vertices() as u64;
    let kept: Vec<u64> = [5, 60, 117, 119, 9999].map(|k| n_fixed + k).to_vec();
    let places: Vec<World3> = kept[..4].iter().map(|&uid| cloth.x[uid as usize]).collect();
    let before = panel_by_names(&cloth, 0);
    let settings = RemeshSettings { keep: &kept, fixed_panels: &[0], ..RemeshSettings::default() };
    for size in [0.7, 0.03, 0.9] {
        let report = remesh(&mut cloth, &Uniform { size }, &settings).unwrap();
        assert!(report.n_edits() > 0);
        assert_eq!(panel_by_names(&cloth, 0), before);
    }
    for (uid, x) in kept.iter().zip(&places) {
        let v = cloth.mesh.uids().iter().position(|u| u == uid).expect("kept");
        assert_eq!(cloth.x[v], *x);
    }
    // All else went as far as it could.
    assert!(cloth.mesh.n_vertices() < n_fixed as usize + 20);
}

#[test]
fn a_seam_to_a_fixed_panel_stays_and_makes_no_slivers() {
    let mut cloth = sewn([6, 3], 2.1);
    let before = panel_by_names(&cloth, 0);
    let settings = RemeshSettings { fixed_panels: &[0], ..RemeshSettings::default() };
    for (size, n_triangles) in [(0.05, 1500..2600), (0.8, 24..60)] {
        let report = remesh(&mut cloth, &Uniform { size }, &settings).unwrap();
        assert_eq!(panel_by_names(&cloth, 0), before);
        assert!(n_triangles.contains(&cloth.mesh.n_triangles()), "{}", cloth.mesh.n_triangles());
        assert_eq!(report.quality.n_below_aspect, 0);
        // The sides over the three seam edges of 1/3 m, and a few behind them.
        assert!(report.quality.n_invalid <= 40, "{}", report.quality.n_invalid);
        assert_eq!(remesh(&mut cloth, &Uniform { size }, &settings).unwrap().journal, []);
    }
}

#[test]
fn seams_are_coarsened_with_the_panels() {
    let mut cloth = sewn([24, 12], 2.1);
    let report = run(&mut cloth, &Uniform { size: 0.5 });
    assert_eq!(report.quality.n_invalid, 0);
    let n_seam = cloth.mesh.edges().filter(|&h| cloth.mesh.is_seam(h)).count();
    assert!(n_seam <= 4, "{n_seam} edges of size 0.5 along a seam of 1 m");
    assert!(cloth.mesh.n_triangles() < 130, "{}", cloth.mesh.n_triangles());
}

#[test]
fn no_flip_folds_the_cloth_over() {
    // A kite whose short diagonal the metric wants, but the cloth is bent about its long one.
    let mut cloth =
        flat(&[[-1.0, 0.0], [1.0, 0.0], [0.0, 0.3], [0.0, -0.3]], &[[0, 1, 2], [1, 0, 3]]);
    let bend = |cloth: &mut ClothState, height: f64| {
        cloth.x = vec![
            World3::new(-0.1, 0.0, 0.0),
            World3::new(0.1, 0.0, 0.0),
            World3::new(0.0, 1.0, height),
            World3::new(0.0, -1.0, height),
        ];
    };
    bend(&mut cloth, 0.5);
    assert_eq!(run(&mut cloth, &Uniform { size: 3.0 }).n_edits(), 0);
    bend(&mut cloth, 0.01);
    assert_eq!(run(&mut cloth, &Uniform { size: 3.0 }).n_flips, 1);
}

#[test]
fn creases_are_not_flipped_or_collapsed_flat() {
    // A sheet folded over by 180° along x = 0.5: nothing may cut through the fold.
    let mut cloth = grid([1.0, 1.0], [10, 10], Diagonal::Alternating);
    for x in &mut cloth.x {
        if x.x > 0.5 + 1e-9 {
            *x = World3::new(1.0 - x.x, x.y, 0.01);
        }
    }
    run(&mut cloth, &Uniform { size: 5.0 });
    assert!(cloth.mesh.n_triangles() < 60);
    for t in cloth.mesh.triangle_ids() {
        let [a, b, c] = cloth.mesh.material()[t.index()];
        let (low, high) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        assert!(high <= 0.6 + 1e-9 || low >= 0.5 - 1e-9, "triangle from {low} to {high}");
    }
}

#[test]
fn refusals_change_nothing() {
    let mut cloth = kind(13);
    let before = cloth.clone();
    let field = Uniform { size: 0.1 };
    let stretched = |limits| RemeshSettings { stretch_limits: limits, ..RemeshSettings::default() };
    for (settings, name) in [
        (RemeshSettings { aspect_min: 1.5, ..RemeshSettings::default() }, "aspect_min"),
        (RemeshSettings { aspect_min: f64::NAN, ..RemeshSettings::default() }, "aspect_min"),
        (RemeshSettings { hysteresis: 1.0, ..RemeshSettings::default() }, "hysteresis"),
        (RemeshSettings { hysteresis: -0.1, ..RemeshSettings::default() }, "hysteresis"),
        (stretched(&[[0.9, 1.1], [1.01, 1.1]]), "stretch_limits"),
        (stretched(&[[0.9, 0.99]]), "stretch_limits"),
        (stretched(&[[f64::NAN, 1.1]]), "stretch_limits"),
        (stretched(&[[0.9, f64::NAN]]), "stretch_limits"),
    ] {
        let message = remesh(&mut cloth, &field, &settings).unwrap_err().to_string();
        assert!(message.starts_with(name), "{message}");
    }
    assert_eq!(cloth, before);
    let settings = RemeshSettings::default();
    let mut stale = CornerMetrics::evaluate(&cloth, &field, &settings).unwrap();
    cloth.split(HalfEdge(0)).unwrap();
    let error = adapt(&mut cloth, &mut stale, &settings).unwrap_err();
    assert_eq!(error, RemeshError::Stale { expected: 1, got: 0 });
}

#[test]
fn positions_that_are_not_numbers_do_not_hang_or_panic() {
    let mut cloth = kind(13);
    cloth.x[17] = World3::repeat(f64::NAN);
    let settings = RemeshSettings::default();
    let report = remesh(&mut cloth, &PhysicalSizing::default(), &settings).unwrap();
    assert!(report.n_bad_metrics >= 6, "{}", report.n_bad_metrics);
    cloth.mesh.validate().unwrap();
}

#[test]
fn garments_from_the_generator() {
    let tunic = generate::tunic(&generate::Tunic::default()).unwrap();
    let mut cloth = common::rest(tunic);
    let report = run(&mut cloth, &Uniform { size: 0.05 });
    assert_eq!(report.quality.n_invalid, 0);
    let report = run(&mut cloth, &Uniform { size: 0.2 });
    assert!(report.n_collapses > 100);
    assert_eq!(run(&mut cloth, &Uniform { size: 0.2 }).n_edits(), 0);
    let one = flat(&[[0.0, 0.0], [1.0, 0.0], [0.3, 0.8]], &[[0, 1, 2]]);
    assert_eq!(run(&mut one.clone(), &Uniform { size: 2.0 }).n_edits(), 0);
}

/// Around held vertices the surface stays where it is, whatever is wished.
#[test]
fn around_held_vertices_edges_are_only_split() {
    let start = stir(grid([1.0, 1.0], [8, 8], Diagonal::Alternating));
    let on_start = |u: Material2| -> World3 {
        for (corners, t) in start.mesh.triangles().iter().zip(start.mesh.triangle_ids()) {
            let m = start.mesh.material()[t.index()];
            let g = mesh_core::geometry::inverse_edges(m);
            let w = g * (u - m[0]);
            if w.x >= -1e-9 && w.y >= -1e-9 && w.x + w.y <= 1.0 + 1e-9 {
                let [a, b, c] = corners.map(|i| start.x[i as usize]);
                return a + (b - a) * w.x + (c - a) * w.y;
            }
        }
        panic!("{u:?} is not on the sheet");
    };
    let left = |x: &World3| x.x < 0.4;
    let names = start.mesh.uids().iter().zip(&start.x);
    let held: Vec<u64> = names.filter(|(_, x)| left(x)).map(|(uid, _)| *uid).collect();
    for size in [0.05, 0.5] {
        let mut cloth = start.clone();
        let settings = RemeshSettings { hold: &held, ..RemeshSettings::default() };
        let report = remesh(&mut cloth, &Uniform { size }, &settings).unwrap();
        let is_coarser = report.n_collapses > 0;
        assert_eq!(is_coarser, size > 0.1, "the other side is free");
        assert!(held.iter().all(|uid| cloth.mesh.uids().contains(uid)));
        for (corners, u) in cloth.mesh.triangles().iter().zip(cloth.mesh.material()) {
            if corners.iter().any(|&i| held.contains(&cloth.mesh.uids()[i as usize])) {
                let x: World3 = corners.iter().map(|&i| cloth.x[i as usize]).sum();
                let place = on_start((u[0] + u[1] + u[2]) / 3.0);
                assert!((x / 3.0 - place).norm() < 1e-12, "size {size}");
            }
        }
        let all = start.mesh.uids().to_vec();
        let mut cloth = start.clone();
        let settings = RemeshSettings { hold: &all, ..RemeshSettings::default() };
        let report = remesh(&mut cloth, &Uniform { size }, &settings).unwrap();
        assert_eq!((report.n_flips, report.n_collapses), (0, 0));
    }
}
