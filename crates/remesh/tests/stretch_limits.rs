//! Flips and collapses put no strain into curved cloth beyond the limits of its panel.

mod common;

use common::{Numbers, kind, noise, stir};
use mesh_core::geometry::{gradient, inverse_edges};
use mesh_core::{ClothState, Material2, TriangleId, World3};
use proptest::prelude::*;
use remesh::{Metric, RemeshSettings, SizingContext, SizingField, Uniform, remesh};

const LIMITS: [f64; 2] = [0.95, 1.05];

/// Sizes between two lengths (m), another one on every triangle and in every call.
struct Patchy {
    seed: u64,
    fine: f64,
    coarse: f64,
}

impl SizingField for Patchy {
    fn metric(&self, _: &SizingContext<'_>, at: TriangleId) -> Metric {
        let random = |salt: u64| noise(self.seed + salt, u64::from(at.0));
        let size = |t: f64| self.fine * (self.coarse / self.fine).powf(t);
        let angle = std::f64::consts::TAU * random(1);
        let along = Material2::new(angle.cos(), angle.sin());
        Metric::with_sizes(along, size(random(2)), size(random(3)))
    }
}

/// How far the worst triangle of a panel is out of limits (1), by a singular value decomposition.
fn excess(cloth: &ClothState, panel: u32, [min, max]: [f64; 2]) -> f64 {
    let mesh = &cloth.mesh;
    let of = |t: TriangleId| {
        let inverse = inverse_edges(mesh.material()[t.index()]);
        let sigma = gradient(cloth.corners(t), &inverse).singular_values();
        (sigma.max() - max).max(min - sigma.min())
    };
    let on_panel = mesh.triangle_ids().filter(|t| mesh.panels()[t.index()] == panel);
    on_panel.map(of).fold(f64::NEG_INFINITY, f64::max)
}

/// Rolls flat cloth up without strain: the curvature (1/m) changes along one direction of the plane.
fn rolled(mut cloth: ClothState, seed: u64, curvature: f64) -> ClothState {
    let mut numbers = Numbers(seed);
    numbers.bits();
    let angle = std::f64::consts::TAU * numbers.unit();
    let (along, across) =
        (Material2::new(angle.cos(), angle.sin()), Material2::new(-angle.sin(), angle.cos()));
    let wave = 3.0 + 5.0 * numbers.unit();
    // The profile's tangent turns by ∫ curvature · cos(wave · s).
    let profile = |s: f64| {
        let (n, mut p) = (400, (0.0, 0.0));
        for k in 0..n {
            let t = s * (k as f64 + 0.5) / n as f64;
            let turn = curvature * (wave * t).sin() / wave;
            p = (p.0 + turn.cos() * s / n as f64, p.1 + turn.sin() * s / n as f64);
        }
        p
    };
    for x in &mut cloth.x {
        let u = Material2::new(x.x, x.y);
        let (s, t) = (along.dot(&u), across.dot(&u));
        let (p, z) = profile(s);
        *x = World3::new(p, t, z);
    }
    cloth
}

/// Adds random displacements (m), the largest of 0.02, 0.01, … that keep all triangles within limits.
fn crumpled(cloth: &ClothState, seed: u64, limits: [f64; 2]) -> Option<ClothState> {
    (0..8).map(|k| 0.02 * 0.5f64.powi(k)).find_map(|amplitude| {
        let mut crumpled = cloth.clone();
        for (x, i) in crumpled.x.iter_mut().zip(0..) {
            *x += World3::from_fn(|c, _| noise(seed, 3 * i + c as u64) - 0.5) * (2.0 * amplitude);
        }
        let n_panels = cloth.densities().len() as u32;
        (0..n_panels).all(|p| excess(&crumpled, p, limits) <= 0.0).then_some(crumpled)
    })
}

/// The kinds of meshes that lie in the plane at rest and whose material is where they lie.
const FLAT: [usize; 7] = [1, 2, 5, 7, 10, 12, 13];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    /// A surface within limits is within limits after any number of calls.
    #[test]
    fn what_is_within_limits_stays_so(
        mesh in prop::sample::select(&FLAT[..]),
        seed in 0u64..1_000_000,
        curvature in 0.0..20.0f64,
        calls in prop::collection::vec((0u64..1000, 0.02..0.2f64, 1.0..20.0f64), 1..4),
    ) {
        // Fine enough to be curved.
        let mut cloth = kind(mesh);
        remesh(&mut cloth, &Uniform { size: 0.1 }, &RemeshSettings::default()).unwrap();
        let start = crumpled(&rolled(cloth, seed, curvature), seed, LIMITS);
        prop_assume!(start.is_some());
        let mut cloth = start.unwrap();
        let settings = RemeshSettings { stretch_limits: &[LIMITS], ..RemeshSettings::default() };
        for (seed, fine, ratio) in calls {
            let field = Patchy { seed, fine, coarse: fine * ratio };
            let settings = RemeshSettings { max_vertices: 3000, ..settings };
            remesh(&mut cloth, &field, &settings).unwrap();
            let excess = excess(&cloth, 0, LIMITS);
            // Halves of a triangle at the limit differ from it by rounding.
            prop_assert!(excess <= 1e-12, "{excess}");
        }
    }

    /// Where cloth is out of limits already, no edit makes the worst of it worse, panel by panel.
    #[test]
    fn the_worst_never_gets_worse(
        mesh in 0usize..common::N_KINDS,
        seed in 0u64..1000,
        fine in 0.03..0.2f64,
        ratio in 1.0..20.0f64,
    ) {
        let mut cloth = stir(kind(mesh));
        let limits = vec![LIMITS; cloth.densities().len()];
        let before: Vec<f64> =
            (0..limits.len()).map(|p| excess(&cloth, p as u32, LIMITS)).collect();
        let settings = RemeshSettings {
            stretch_limits: &limits, max_vertices: 3000, ..RemeshSettings::default()
        };
        remesh(&mut cloth, &Patchy { seed, fine, coarse: fine * ratio }, &settings).unwrap();
        for (p, before) in before.into_iter().enumerate() {
            let after = excess(&cloth, p as u32, LIMITS);
            // Some of the meshes have triangles of 1e-5 m in height, with coordinates of 1 m.
            let slack = 1e-12 + 1e-9 * before.max(0.0);
            prop_assert!(after <= before.max(0.0) + slack, "panel {p}: {before} → {after}");
        }
    }

    /// Limits that nothing reaches, and limits of panels that do not exist, change no bit.
    #[test]
    fn no_limits_are_wide_limits(
        mesh in 0usize..common::N_KINDS,
        seed in 0u64..1000,
        fine in 0.03..0.2f64,
        ratio in 1.0..20.0f64,
    ) {
        let field = Patchy { seed, fine, coarse: fine * ratio };
        let run = |limits: &[[f64; 2]]| {
            let mut cloth = stir(kind(mesh));
            let settings = RemeshSettings {
                stretch_limits: limits, max_vertices: 3000, ..RemeshSettings::default()
            };
            let report = remesh(&mut cloth, &field, &settings).unwrap();
            (cloth, report)
        };
        let n_panels = kind(mesh).densities().len();
        let none = run(&[]);
        prop_assert_eq!(&run(&vec![[0.0, f64::INFINITY]; n_panels]), &none);
        let mut beyond = vec![[0.0, f64::INFINITY]; n_panels];
        beyond.push([1.0, 1.0]);
        prop_assert_eq!(&run(&beyond), &none);
    }
}

/// A sheet rolled to a radius of 0.1 m wants to be coarse: without limits its edges cut across the
/// roll, with limits they stay as short as it needs, and the flat half is as coarse in both.
#[test]
fn limits_keep_a_roll_round_and_flat_cloth_coarse() {
    let roll = |limits: &[[f64; 2]]| {
        let mut cloth =
            common::grid([2.0, 0.4], [60, 12], mesh_core::generate::Diagonal::Alternating);
        for x in &mut cloth.x {
            let turn = ((x.x - 1.0) / 0.1).max(0.0);
            let flat = x.x.min(1.0);
            *x = World3::new(flat + 0.1 * turn.sin(), x.y, 0.1 * (1.0 - turn.cos()));
        }
        let settings = RemeshSettings { stretch_limits: limits, ..RemeshSettings::default() };
        remesh(&mut cloth, &Uniform { size: 0.4 }, &settings).unwrap();
        let count = |rolled: bool| {
            let side = |u: &&[Material2; 3]| u.iter().all(|u| (u.x > 1.1) == rolled);
            cloth.mesh.material().iter().filter(side).count()
        };
        (excess(&cloth, 0, LIMITS), count(false), count(true))
    };
    let (strained, flat, rolled) = roll(&[]);
    let (kept, flat_kept, rolled_kept) = roll(&[LIMITS]);
    println!("{strained} {flat} {rolled}, with limits {kept} {flat_kept} {rolled_kept}");
    assert!(strained > 0.05, "the example needs limits: {strained}");
    assert!(kept <= 1e-12, "{kept}");
    assert!(rolled_kept > 2 * rolled, "{rolled_kept} {rolled}");
    assert!(flat_kept <= 2 * flat, "{flat_kept} {flat}");
}
