//! What remeshing makes of simple fields.

mod common;

use common::{At, grid, kind, run, share, stir};
use mesh_core::generate::{self, Diagonal};
use mesh_core::{ClothState, Edit, HalfEdge, Material2, TriangleField, TriangleId};
use proptest::prelude::*;
use remesh::{
    MaxOf, Metric, PerPanel, PhysicalSizing, RemeshError, RemeshSettings, SizingContext,
    SizingField, Uniform, remesh,
};

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
    let mut isotropic = common::rest(generate::disc(0.5, 3).unwrap());
    let expected = run(&mut isotropic, &Uniform { size: 0.03 }).quality;
    for angle in [0.0, 0.7] {
        let along = Material2::new(f64::cos(angle), f64::sin(angle));
        let metric = Metric::with_sizes(along, 0.06, 0.015);
        let mut cloth = common::rest(generate::disc(0.5, 3).unwrap());
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
