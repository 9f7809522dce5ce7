//! Random and hostile sizing fields on meshes of every kind: every invariant holds, every call
//! ends, and no edge is left invalid in silence.

mod common;

use common::{Conserved, Numbers, kind, noise, stir};
use mesh_core::geometry::aspect;
use mesh_core::{ClothState, HalfEdge, Material2, TriangleId, VertexField};
use proptest::prelude::*;
use remesh::{CornerMetrics, Metric, RemeshSettings, SizingContext, SizingField, adapt, remesh};

/// A field without any mercy: one of several kinds, drawn anew for every call by the seed.
#[derive(Clone, Copy, Debug)]
struct Hostile {
    kind: u32,
    seed: u64,
    fine: f64,
    coarse: f64,
}

const N_HOSTILE: u32 = 10;

impl SizingField for Hostile {
    fn metric(&self, context: &SizingContext<'_>, at: TriangleId) -> Metric {
        let u = context.centroid(at);
        let random = |salt: u64| noise(self.seed + salt, u64::from(at.0));
        let log = |t: f64| self.fine * (self.coarse / self.fine).powf(t);
        match self.kind % N_HOSTILE {
            // All of it swings between the extremes from call to call.
            0 => Metric::uniform(if self.seed.is_multiple_of(2) { self.fine } else { self.coarse }),
            // Every triangle something else.
            1 => Metric::uniform(log(random(1))),
            // A checkerboard that does not fit the mesh.
            2 => {
                let cell = ((u.x * 7.3).floor() + (u.y * 5.1).floor()) as i64;
                Metric::uniform(if cell.rem_euclid(2) == 0 { self.fine } else { self.coarse })
            }
            // Needles of 100 : 1 in directions that turn with the place.
            3 => {
                let angle = 6.0 * u.x + 4.0 * u.y + self.seed as f64;
                let along = Material2::new(angle.cos(), angle.sin());
                Metric::with_sizes(along, 100.0 * self.fine, self.fine)
            }
            // Needles in random directions.
            4 => {
                let angle = std::f64::consts::TAU * random(2);
                let along = Material2::new(angle.cos(), angle.sin());
                Metric::with_sizes(along, self.coarse, self.fine)
            }
            // Sprinkled with what is no metric at all.
            5 => match at.0 % 7 {
                0 => Metric::new(f64::NAN, 0.0, 1.0),
                1 => Metric::new(1.0, f64::INFINITY, 1.0),
                2 => Metric::new(-1e3, 0.0, 1e3),
                3 => Metric::new(1.0, 1e9, 1.0),
                _ => Metric::uniform(log(random(3))),
            },
            // Nothing wanted at all.
            6 => Metric::ZERO,
            // A smooth fine spot that wanders.
            7 => {
                let centre = Material2::new(random(0), (self.seed as f64).sin().abs());
                let far = ((u - centre).norm() / 0.3).min(1.0);
                Metric::uniform(log(far))
            }
            // Degenerate: one direction only.
            8 => {
                let m = 1.0 / (self.fine * self.fine);
                Metric::new(m, -m, m)
            }
            // Far finer than can ever be.
            _ => Metric::uniform(if random(5) < 0.1 { 1e-9 } else { self.coarse }),
        }
    }
}

fn settings(max_vertices: usize) -> RemeshSettings<'static> {
    RemeshSettings { max_vertices, ..RemeshSettings::default() }
}

fn lowest_aspect(cloth: &ClothState) -> f64 {
    let aspects = cloth.mesh.material().iter().map(|[a, b, c]| aspect(*a, *b, *c));
    aspects.fold(f64::INFINITY, f64::min)
}

/// Remeshes once and checks what must hold after every call; returns the number of edits.
fn check_call(cloth: &mut ClothState, field: &Hostile, max_vertices: usize) -> usize {
    let conserved = Conserved::of(cloth);
    let mut ones = VertexField::new(&cloth.mesh, vec![1.0; cloth.mesh.n_vertices()]);
    let report = remesh(cloth, field, &settings(max_vertices)).unwrap();
    conserved.check(cloth);
    ones.follow(&report.journal);
    assert_eq!(ones.epoch(), cloth.mesh.epoch());
    assert!(ones.values().iter().all(|&one| one == 1.0));
    assert_eq!(ones.values().len(), cloth.mesh.n_vertices());
    assert_eq!(report.n_splits + report.n_flips + report.n_collapses, report.n_edits());
    assert_eq!(report.quality.n_vertices, cloth.mesh.n_vertices());
    assert!(cloth.mesh.n_vertices() <= max_vertices.max(ones.values().len()));
    report.n_edits()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn any_field_on_any_mesh(
        mesh in 0usize..common::N_KINDS,
        calls in prop::collection::vec((any::<u32>(), 0u64..1000), 1..6),
        fine in 0.02..0.2f64,
        ratio in 1.0..20.0f64,
    ) {
        let mut cloth = stir(kind(mesh));
        for (kind, seed) in calls {
            check_call(&mut cloth, &Hostile { kind, seed, fine, coarse: fine * ratio }, 1500);
        }
    }

    #[test]
    fn carried_metrics_leave_nothing_to_do(
        mesh in 0usize..common::N_KINDS,
        calls in prop::collection::vec((0u32..N_HOSTILE - 1, 0u64..1000), 1..4),
        fine in 0.03..0.2f64,
        ratio in 1.0..10.0f64,
    ) {
        let mut cloth = stir(kind(mesh));
        for (kind, seed) in calls {
            let field = Hostile { kind, seed, fine, coarse: fine * ratio };
            let settings = settings(20_000);
            let mut metrics = CornerMetrics::evaluate(&cloth, &field, &settings).unwrap();
            let first = adapt(&mut cloth, &mut metrics, &settings).unwrap();
            prop_assert!(!first.vertex_limit_reached);
            common::check_sectors(&cloth.mesh, &metrics);
            // What is still too long cannot be split well.
            let too_long = |h: &HalfEdge| metrics.size_squared(&cloth.mesh, *h) > 1.0 + 1e-9;
            let left: Vec<_> = cloth.mesh.edges().filter(too_long).collect();
            prop_assert_eq!(first.quality.n_invalid, left.len());
            prop_assert!(left.is_empty() || mesh == 8 || mesh == 11);
            for h in left {
                let mut cut = cloth.clone();
                prop_assert!(cut.split(h).is_err() || lowest_aspect(&cut) < settings.aspect_min);
            }
            let second = adapt(&mut cloth, &mut metrics, &settings).unwrap();
            prop_assert!(
                first.limit_reached() || second.n_edits() == 0,
                "{} edits after {}: {:?}", second.n_edits(), first.n_edits(), &second.journal
            );
        }
    }
}

#[test]
fn a_hundred_thousand_edits() {
    let mut numbers = Numbers(11);
    for mesh in [3, 13] {
        let mut cloth = stir(kind(mesh));
        let start = Conserved::of(&cloth);
        let mut n_edits = 0;
        while n_edits < 100_000 {
            let field = Hostile {
                kind: numbers.bits() % (N_HOSTILE - 1),
                seed: u64::from(numbers.bits() % 1000),
                fine: 0.015 + 0.05 * numbers.unit(),
                coarse: 0.1 + 0.4 * numbers.unit(),
            };
            n_edits += check_call(&mut cloth, &field, 4000);
        }
        start.check(&cloth);
    }
}

#[test]
fn the_vertex_limit_is_kept_and_reported() {
    let mut cloth = stir(kind(13));
    let field = Hostile { kind: 9, seed: 3, fine: 0.1, coarse: 0.5 };
    let report = remesh(&mut cloth, &field, &settings(700)).unwrap();
    assert!(report.vertex_limit_reached && report.limit_reached());
    assert!(report.quality.n_invalid > 0 && report.quality.size_max > 1.0);
    assert!(cloth.mesh.n_vertices() <= 700);
}

#[test]
fn invalid_metrics_are_counted_and_count_as_the_coarsest() {
    let mut cloth = kind(13);
    let n = cloth.mesh.n_triangles();
    let field = Hostile { kind: 5, seed: 0, fine: 0.2, coarse: 0.2 };
    let report = remesh(&mut cloth, &field, &settings(4000)).unwrap();
    assert_eq!(report.n_bad_metrics, (0..n).filter(|t| t % 7 < 4).count());
    // All valid ones agree, so the invalid ones do too.
    assert_eq!(report.quality.n_invalid, 0);
    let mut other = kind(13);
    let field = Hostile { kind: 0, seed: 0, fine: 0.2, coarse: 0.2 };
    remesh(&mut other, &field, &settings(4000)).unwrap();
    assert_eq!(cloth, other);
}
