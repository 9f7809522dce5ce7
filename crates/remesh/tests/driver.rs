//! What remeshing makes of simple fields, and that it leaves well alone.

mod common;

use common::{At, Conserved, flat, grid, kind, sewn, share, stir, together};
use mesh_core::generate::{self, Diagonal};
use mesh_core::{ClothState, Edit, HalfEdge, Material2, TriangleField, TriangleId, World3};
use proptest::prelude::*;
use remesh::{
    CornerMetrics, MaxOf, Metric, PerPanel, PhysicalSizing, RemeshError, RemeshReport,
    RemeshSettings, SizingContext, SizingField, Uniform, adapt, remesh,
};

fn run<S: SizingField + ?Sized>(cloth: &mut ClothState, field: &S) -> RemeshReport {
    let conserved = Conserved::of(cloth);
    let report = remesh(cloth, field, &RemeshSettings::default()).unwrap();
    conserved.check(cloth);
    report
}

fn edge_lengths(cloth: &ClothState) -> Vec<f64> {
    cloth.mesh.edges().map(|h| cloth.mesh.material_edge(h).norm()).collect()
}

#[test]
fn a_uniform_field_gives_edges_of_its_size() {
    let size = 0.04;
    for mesh in [1, 5, 9, 10, 13] {
        let mut cloth = kind(mesh);
        let report = run(&mut cloth, &Uniform { size });
        assert_eq!(report.quality.n_invalid, 0, "mesh {mesh}");
        assert!(!report.limit_reached());
        let lengths = edge_lengths(&cloth);
        let mean = lengths.iter().sum::<f64>() / lengths.len() as f64;
        assert!(lengths.iter().all(|&l| l <= size * (1.0 + 1e-9)));
        assert!((0.55..0.9).contains(&(mean / size)), "mesh {mesh}: mean {}", mean / size);
        assert!(share(&report.quality, 0.3, 1.0) > 0.97, "mesh {mesh}: {:?}", report.quality.sizes);
        // Equilateral triangles with edges of the mean length, give or take what splitting in
        // halves cannot do better.
        let expected = cloth.mesh.total_area() / (3f64.sqrt() / 4.0 * mean * mean);
        let got = cloth.mesh.n_triangles() as f64 / expected;
        assert!((0.85..1.2).contains(&got), "mesh {mesh}: {got} of the triangles expected");
        assert_eq!(report.quality.n_below_aspect, 0);
        assert!(report.quality.aspect_mean > 0.75, "mesh {mesh}: {}", report.quality.aspect_mean);
    }
}

#[test]
fn a_fine_mesh_is_coarsened_to_the_size() {
    let mut cloth = grid([1.0, 1.0], [50, 50], Diagonal::Alternating);
    let report = run(&mut cloth, &Uniform { size: 0.2 });
    assert_eq!((report.quality.n_invalid, report.quality.n_below_aspect), (0, 0));
    // Edges of mean size 0.6 to 0.75 are what hysteresis allows.
    assert!((100..300).contains(&cloth.mesh.n_triangles()), "{}", cloth.mesh.n_triangles());
    assert!(report.quality.aspect_mean > 0.75);
    assert!(report.n_collapses > 2000);
}

#[test]
fn a_constant_anisotropic_metric_is_the_isotropic_case_in_other_axes() {
    let mut isotropic = grid([1.0, 1.0], [8, 8], Diagonal::Alternating);
    let expected = run(&mut isotropic, &Uniform { size: 0.03 }).quality;
    for angle in [0.0, 0.7] {
        let along = Material2::new(f64::cos(angle), f64::sin(angle));
        let metric = Metric::with_sizes(along, 0.06, 0.015);
        let mut cloth = grid([1.0, 1.0], [8, 8], Diagonal::Alternating);
        let quality = run(&mut cloth, &At(move |_| metric)).quality;
        assert_eq!((quality.n_invalid, quality.n_below_aspect), (0, 0));
        // Same area of a triangle in the metric, same distribution of sizes.
        let ratio = quality.n_triangles as f64 / expected.n_triangles as f64;
        assert!((0.85..1.25).contains(&ratio), "{ratio}");
        for (low, high) in [(0.0, 0.4), (0.4, 0.7), (0.7, 1.0)] {
            let (p, q) = (share(&quality, low, high), share(&expected, low, high));
            assert!((p - q).abs() < 0.3, "{low}..{high}: {p} against {q}");
        }
        // Stretched triangles: the mean ratio of extents follows the metric's 4 : 1.
        let across = Material2::new(-along.y, along.x);
        let edges: Vec<_> = cloth.mesh.edges().map(|h| cloth.mesh.material_edge(h)).collect();
        let extent = |d: Material2| edges.iter().map(|e| e.dot(&d).powi(2)).sum::<f64>().sqrt();
        let stretch = extent(along) / extent(across);
        assert!((3.0..5.0).contains(&stretch), "{stretch}");
    }
}

#[test]
fn needle_inputs_end_and_keep_their_area() {
    for mesh in [7, 8, 11, 12] {
        let mut cloth = kind(mesh);
        let report = run(&mut cloth, &Uniform { size: 0.08 });
        assert_eq!(report.quality.n_invalid, 0, "mesh {mesh}");
        // What was thin may stay thin along its boundary but is mostly gone.
        assert!(report.quality.aspect_mean > 0.6, "mesh {mesh}: {}", report.quality.aspect_mean);
    }
}

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
    let mut cloth = stir(together(&[
        grid([1.0, 1.0], [10, 10], Diagonal::One),
        grid([1.0, 1.0], [10, 10], Diagonal::One),
    ]));
    let kept: Vec<u64> = vec![5, 60, 33, 9999];
    let places: Vec<World3> = kept[..3].iter().map(|&uid| cloth.x[uid as usize]).collect();
    let panel = |cloth: &ClothState| {
        let mesh = &cloth.mesh;
        let mut rows: Vec<_> = (0..mesh.n_triangles())
            .filter(|&t| mesh.panels()[t] == 1)
            .map(|t| mesh.triangles()[t].map(|v| mesh.uids()[v as usize]))
            .collect();
        rows.sort_unstable();
        rows
    };
    let before = panel(&cloth);
    let settings = RemeshSettings { keep: &kept, fixed_panels: &[1], ..RemeshSettings::default() };
    for size in [0.7, 0.03, 0.9] {
        let report = remesh(&mut cloth, &Uniform { size }, &settings).unwrap();
        assert!(report.n_edits() > 0);
        assert_eq!(panel(&cloth), before);
    }
    for (uid, x) in kept.iter().zip(&places) {
        let v = cloth.mesh.uids().iter().position(|u| u == uid).expect("kept");
        assert_eq!(cloth.x[v], *x);
    }
    // All else went as far as it could.
    assert!(cloth.mesh.n_vertices() < 121 + 20);
}

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
fn smooth_fields_settle() {
    let fine = |u: Material2| Metric::uniform(0.02 + 0.15 * (u - Material2::new(0.4, 0.6)).norm());
    let stripes = |u: Material2| {
        Metric::with_sizes(Material2::x(), 0.02 + 0.1 * (4.0 * u.x).sin().powi(2), 0.1)
    };
    let step = |u: Material2| Metric::uniform(if u.x + 0.3 * u.y < 0.5 { 0.02 } else { 0.15 });
    fn settle(field: &dyn SizingField) -> Vec<usize> {
        let mut cloth = grid([1.0, 1.0], [6, 6], Diagonal::Alternating);
        (0..12).map(|_| run(&mut cloth, field).n_edits()).collect()
    }
    for edits in [settle(&At(fine)), settle(&At(stripes)), settle(&At(step))] {
        assert!(edits[11] == 0, "{edits:?}");
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
fn flips_make_an_arbitrary_triangulation_delaunay() {
    let mut cloth = kind(12);
    let report = run(&mut cloth, &Uniform { size: 1.2 });
    assert!(report.n_flips >= 12 && report.n_splits == 0);
    for h in cloth.mesh.edges() {
        let Some(g) = cloth.mesh.twin(h) else { continue };
        let at = |e: HalfEdge| cloth.mesh.corner_material(e);
        let angle = |e: HalfEdge| (at(e) - at(e.prev())).angle(&(at(e.next()) - at(e.prev())));
        assert!(angle(h) + angle(g) < std::f64::consts::PI + 0.11);
    }
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
fn obstacles_refine_through_the_settings() {
    let mut cloth = grid([1.0, 1.0], [10, 10], Diagonal::Alternating);
    let near = |cloth: &ClothState| -> Vec<Metric> {
        let x = |t: TriangleId| cloth.mesh.material()[t.index()][0].x;
        let of = |t| if x(t) < 0.3 { Metric::uniform(0.02) } else { Metric::ZERO };
        cloth.mesh.triangle_ids().map(of).collect()
    };
    let obstacle = near(&cloth);
    let settings = RemeshSettings { obstacle: Some(&obstacle), ..RemeshSettings::default() };
    let report = remesh(&mut cloth, &PhysicalSizing::default(), &settings).unwrap();
    assert!(report.n_splits > 500);
    let error = remesh(&mut cloth, &PhysicalSizing::default(), &settings).unwrap_err();
    assert_eq!(error, RemeshError::Obstacle { expected: cloth.mesh.n_triangles(), got: 200 });
}

#[test]
fn refusals_change_nothing() {
    let mut cloth = kind(13);
    let before = cloth.clone();
    let field = Uniform { size: 0.1 };
    for (settings, name) in [
        (RemeshSettings { aspect_min: 0.9, ..RemeshSettings::default() }, "aspect_min"),
        (RemeshSettings { aspect_min: f64::NAN, ..RemeshSettings::default() }, "aspect_min"),
        (RemeshSettings { hysteresis: 1.0, ..RemeshSettings::default() }, "hysteresis"),
        (RemeshSettings { hysteresis: -0.1, ..RemeshSettings::default() }, "hysteresis"),
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
    assert!(report.n_bad_metrics >= 6);
    cloth.mesh.validate().unwrap();
}

#[test]
fn policies_combine() {
    let cloth = stir(grid([1.0, 1.0], [4, 4], Diagonal::One));
    let context = SizingContext::new(&cloth, None);
    let x = At(|_| Metric::with_sizes(Material2::x(), 0.1, 1.0));
    let y = At(|_| Metric::with_sizes(Material2::y(), 0.2, 1.0));
    let both = MaxOf(&x, &y).metric(&context, TriangleId(3));
    assert!((both.matrix() - Metric::new(100.0, 0.0, 25.0).matrix()).norm() < 1e-12);
    let beyond = PerPanel::<Uniform> { fields: vec![] }.metric(&context, TriangleId(3));
    assert_eq!(beyond, Metric::ZERO);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Fields on triangles follow the journal, whatever was done.
    #[test]
    fn the_journal_replays(mesh in 0usize..common::N_KINDS, size in 0.03..0.5f64) {
        let mut cloth = stir(kind(mesh));
        let mut panel = TriangleField::new(&cloth.mesh, cloth.mesh.panels().to_vec());
        let report = run(&mut cloth, &Uniform { size });
        panel.follow(&report.journal);
        prop_assert_eq!(panel.values(), cloth.mesh.panels());
        prop_assert_eq!(panel.epoch(), cloth.mesh.epoch());
        let n_new = report.journal.iter().filter(|e| matches!(e, Edit::Split { .. })).count();
        prop_assert_eq!(n_new, report.n_splits);
    }
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
