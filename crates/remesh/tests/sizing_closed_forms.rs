//! The physical sizing field against closed forms, and under rigid motion.

mod common;

use common::{grid, stir};
use mesh_core::generate::Diagonal;
use mesh_core::{ClothState, TriangleId, VertexId, World3};
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;
use remesh::{Metric, PhysicalSizing, SizingContext, SizingField};

/// All criteria off and the clamp as wide as doubles allow without losing digits.
const OFF: PhysicalSizing = PhysicalSizing {
    refine_angle: f64::INFINITY,
    refine_velocity: f64::INFINITY,
    refine_compression: f64::INFINITY,
    size_min: 1e-6,
    size_max: 1e6,
    aspect_min: 1e-6,
};

/// Triangles with three neighbours, none of whose vertices lies on the boundary.
fn inner(cloth: &ClothState) -> Vec<TriangleId> {
    let mesh = &cloth.mesh;
    let corners = |t: TriangleId| mesh.triangles()[t.index()].map(VertexId);
    let is_inner = |t: &TriangleId| corners(*t).iter().all(|v| !mesh.is_boundary_vertex(*v));
    mesh.triangle_ids().filter(is_inner).collect()
}

fn metrics(cloth: &ClothState, sizing: &PhysicalSizing) -> Vec<Metric> {
    let context = SizingContext::new(cloth, None);
    cloth.mesh.triangle_ids().map(|t| sizing.metric(&context, t)).collect()
}

fn assert_close(got: f64, expected: f64, tolerance: f64) {
    assert!((got - expected).abs() <= tolerance * expected.abs(), "{got} is not {expected}");
}

/// A sheet rolled up around the y axis without stretching its edges.
fn cylinder(radius: f64, diagonal: Diagonal) -> ClothState {
    let n = 20;
    let mut cloth = grid([1.0, 1.0], [n, n], diagonal);
    let turn = 2.0 * (0.5 / n as f64 / radius).asin();
    let mut z = 0.0;
    let mut column = vec![World3::zeros()];
    for i in 0..n {
        let angle = (i as f64 + 0.5) * turn;
        z += angle.sin() / n as f64;
        column.push(World3::new(column[i].x + angle.cos() / n as f64, 0.0, z));
    }
    for (k, x) in cloth.x.iter_mut().enumerate() {
        *x = column[k % (n + 1)] + World3::new(0.0, x.y, 0.0);
    }
    cloth
}

#[test]
fn a_cylinder_is_refined_along_its_curve_only() {
    for diagonal in [Diagonal::One, Diagonal::Alternating] {
        for radius in [0.2, 0.5, 3.0] {
            let cloth = cylinder(radius, diagonal);
            let sizing = PhysicalSizing { refine_angle: 0.3, ..OFF };
            let all = metrics(&cloth, &sizing);
            // The turn from one flat strip to the next over its width.
            let curvature = 20.0 * 2.0 * (0.5 / 20.0 / radius).asin();
            assert_close(curvature, 1.0 / radius, 3e-3);
            for t in inner(&cloth) {
                let (lambda, [across, _]) = all[t.index()].eigen();
                assert_close(lambda[0], (curvature / 0.3).powi(2), 1e-9);
                assert!(lambda[1] <= 1e-9 * lambda[0]);
                assert!(across.x.abs() > 1.0 - 1e-9);
            }
        }
    }
}

#[test]
fn shape_operator_of_a_single_fold() {
    // Two right triangles folded by 0.4 along their long side.
    let mut cloth =
        common::flat(&[[0.0, 0.0], [0.1, 0.0], [0.1, 0.1], [0.0, 0.1]], &[[0, 1, 2], [0, 2, 3]]);
    let axis = Vector3::new(1.0, 1.0, 0.0).normalize();
    cloth.x[3] = Rotation3::new(axis * 0.4) * cloth.x[3];
    let context = SizingContext::new(&cloth, None);
    let length = 0.1 * 2f64.sqrt();
    for t in [TriangleId(0), TriangleId(1)] {
        let shape = context.shape_operator(t);
        // θ ℓ / 2A along the normal of the fold.
        assert_close(shape.trace().abs(), 0.4 * length / 0.01, 1e-12);
        assert!(shape.determinant().abs() <= 1e-12 * shape.norm_squared());
        assert_close(shape[(0, 1)], -shape[(0, 0)], 1e-12);
    }
}

#[test]
fn velocity_gradients() {
    let sizing = PhysicalSizing { refine_velocity: 0.5, ..OFF };
    let mut cloth = grid([1.0, 1.0], [6, 6], Diagonal::Alternating);
    // Simple shear: v_x = 3 y.
    for (x, v) in cloth.x.iter().zip(&mut cloth.v) {
        *v = World3::new(3.0 * x.y, 0.0, 0.0);
    }
    for m in metrics(&cloth, &sizing) {
        let (lambda, [first, _]) = m.eigen();
        assert_close(lambda[0], 36.0, 1e-9);
        assert!(lambda[1] < 1e-9 && first.y.abs() > 1.0 - 1e-9);
    }
    // Rigid rotation about the normal: ω in all directions; about the y axis: along x only.
    for (axis, expected) in [(World3::z(), [100.0, 100.0]), (World3::y(), [100.0, 0.0])] {
        for (x, v) in cloth.x.iter().zip(&mut cloth.v) {
            *v = (axis * 5.0).cross(x) + World3::new(1.0, 2.0, 3.0);
        }
        for m in metrics(&cloth, &sizing) {
            let lambda = m.eigenvalues();
            assert_close(lambda[0], expected[0], 1e-9);
            assert!((lambda[1] - expected[1]).abs() < 1e-7, "{lambda:?}");
        }
    }
}

#[test]
fn compression_but_not_stretch() {
    let sizing = PhysicalSizing { refine_compression: 0.01, ..OFF };
    let mut cloth = grid([1.0, 1.0], [5, 5], Diagonal::One);
    for x in &mut cloth.x {
        *x = World3::new(0.9 * x.x, 1.2 * x.y, 0.0);
    }
    for m in metrics(&cloth, &sizing) {
        let (lambda, [first, _]) = m.eigen();
        assert_close(lambda[0], (1.0 - 0.81) / 1e-4, 1e-9);
        assert!(lambda[1] < 1e-7 && first.x.abs() > 1.0 - 1e-9);
    }
}

#[test]
fn a_compressed_edge_hides_less_than_its_share_of_bulge() {
    // A circular arc of length ℓ over the chord d: the sagitta stays below (√3/4) · compression
    // for edges of size 1, in the limit of shallow arcs, and below half of it up to half-circles.
    let compression = 0.01;
    for half_angle in [1e-3, 0.1, 0.5, 1.0, 1.5f64] {
        // Radius such that the edge has size 1: ℓ² − d² = compression².
        let (arc, chord) = (2.0 * half_angle, 2.0 * half_angle.sin());
        let radius = compression / (arc * arc - chord * chord).sqrt();
        let sagitta = radius * (1.0 - half_angle.cos());
        assert!(sagitta <= 3f64.sqrt() / 4.0 * compression * (1.0 + 1e-6), "{sagitta}");
        if half_angle < 0.01 {
            assert_close(sagitta, 3f64.sqrt() / 4.0 * compression, 1e-3);
        }
    }
}

#[test]
fn a_flat_resting_sheet_gets_the_largest_size() {
    let cloth = grid([1.0, 1.0], [7, 5], Diagonal::Alternating);
    let sizing = PhysicalSizing::default();
    sizing.check().unwrap();
    for m in metrics(&cloth, &sizing) {
        assert_eq!(m, Metric::uniform(sizing.size_max));
    }
}

#[test]
fn the_obstacle_metric_is_taken_as_it_is_and_clamped() {
    let cloth = grid([1.0, 1.0], [3, 3], Diagonal::One);
    let sizing = PhysicalSizing::default();
    let n = cloth.mesh.n_triangles();
    let wanted = [Metric::ZERO, Metric::uniform(0.05), Metric::uniform(1e-4)];
    let obstacle: Vec<Metric> = (0..n).map(|t| wanted[t % 3]).collect();
    let context = SizingContext::new(&cloth, Some(&obstacle));
    for (k, size) in [sizing.size_max, 0.05, sizing.size_min].into_iter().enumerate() {
        let got = sizing.metric(&context, TriangleId(k as u32)).eigenvalues();
        assert_close(got[0], 1.0 / (size * size), 1e-12);
        assert_close(got[1], 1.0 / (size * size), 1e-12);
    }
}

#[test]
fn criteria_combine_to_a_tensor_that_dominates_each() {
    let cloth = stir(cylinder(0.3, Diagonal::Alternating));
    let bounds = PhysicalSizing { size_min: 1e-3, size_max: 10.0, aspect_min: 1e-3, ..OFF };
    let single = [
        PhysicalSizing { refine_angle: 0.3, ..bounds },
        PhysicalSizing { refine_velocity: 0.5, ..bounds },
        PhysicalSizing { refine_compression: 0.02, ..bounds },
    ];
    let all = PhysicalSizing {
        refine_angle: 0.3,
        refine_velocity: 0.5,
        refine_compression: 0.02,
        ..bounds
    };
    let parts = single.map(|sizing| metrics(&cloth, &sizing));
    for (t, m) in metrics(&cloth, &all).into_iter().enumerate() {
        for part in &parts {
            let gap = (m + part[t] * -1.0).eigenvalues()[1];
            assert!(gap >= -1e-9 * m.trace(), "{gap} of {}", m.trace());
        }
    }
}

#[test]
fn nonsense_settings_are_named() {
    let good = PhysicalSizing::default();
    for (bad, name) in [
        (PhysicalSizing { refine_angle: 0.0, ..good }, "refine_angle"),
        (PhysicalSizing { refine_velocity: f64::NAN, ..good }, "refine_velocity"),
        (PhysicalSizing { refine_compression: -1.0, ..good }, "refine_compression"),
        (PhysicalSizing { size_min: 0.0, ..good }, "size_min"),
        (PhysicalSizing { size_max: 0.001, ..good }, "size_max"),
        (PhysicalSizing { size_max: f64::INFINITY, ..good }, "size_max"),
        (PhysicalSizing { aspect_min: 1.5, ..good }, "aspect_min"),
    ] {
        let message = bad.check().unwrap_err().to_string();
        assert!(message.starts_with(name), "{message}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// The metric lives in material space: moving the cloth rigidly changes nothing.
    #[test]
    fn objective(axis in prop::array::uniform3(-3.0..3.0f64), shift in prop::array::uniform3(-5.0..5.0f64)) {
        let cloth = stir(grid([1.0, 1.0], [8, 8], Diagonal::Alternating));
        let turn = Rotation3::new(Vector3::from(axis));
        let mut moved = cloth.clone();
        for (x, v) in moved.x.iter_mut().zip(&mut moved.v) {
            *x = turn * *x + World3::from(shift);
            *v = turn * *v + World3::from(shift);
        }
        let sizing = PhysicalSizing::default();
        for (m, n) in metrics(&cloth, &sizing).into_iter().zip(metrics(&moved, &sizing)) {
            prop_assert!((m.matrix() - n.matrix()).norm() <= 1e-9 * m.trace());
        }
    }
}
