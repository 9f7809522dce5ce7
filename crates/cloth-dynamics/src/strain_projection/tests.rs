//! Random patches are brought back into bounds; momentum and held vertices stay.

use super::*;
use crate::fabric::{BendingModel, Damping};
use crate::law::{Membrane, Quadratic};
use mesh_core::generate::{Diagonal, grid};
use mesh_core::{ClothState, Material2, Mesh};
use nalgebra::Rotation3;
use proptest::prelude::*;

const LIMITS: StrainLimits = StrainLimits { min: 0.95, max: 1.05 };

fn fabric(strain_limits: Option<StrainLimits>) -> Fabric {
    Fabric {
        density: 0.2,
        membrane: Membrane::Orthotropic(Quadratic::isotropic(100.0, 0.2).unwrap()),
        bending: None,
        bending_model: BendingModel::ShapeOperator,
        tension_field: false,
        strain_limits,
        damping: Damping::default(),
    }
}

/// A sheet of 5 × 4 cells that are not square; its first panel has limits, the second has none.
fn patch(limited_columns: f64) -> (ClothState, StrainProjection) {
    let sheet = grid([0.25, 0.16], [5, 4], Diagonal::Alternating).unwrap();
    let panel =
        |u: &[Material2; 3]| u32::from(u.iter().any(|u| u.x > 0.05 * limited_columns + 1e-9));
    let panels = sheet.mesh.material().iter().map(panel).collect();
    let (triangles, material) = (sheet.mesh.triangles().to_vec(), sheet.mesh.material().to_vec());
    let mesh = Mesh::new(sheet.positions.len(), triangles, material, panels).unwrap();
    let cloth = ClothState::at_rest(mesh, sheet.positions, vec![0.2, 0.3]).unwrap();
    let projection = of(&cloth);
    (cloth, projection)
}

fn of(cloth: &ClothState) -> StrainProjection {
    let fabrics = Arc::new(vec![fabric(Some(LIMITS)), fabric(None)]);
    let rest = Arc::new(RestTriangle::all(cloth));
    StrainProjection::new(cloth.mesh.triangles(), rest, fabrics).expect("a panel has limits")
}

/// One right triangle.
fn single() -> (ClothState, StrainProjection) {
    let u = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.2]].map(Material2::from);
    let mesh = Mesh::new(3, vec![[0, 1, 2]], vec![u], vec![0]).unwrap();
    let x = u.iter().map(|u| World3::new(u.x, u.y, 0.0)).collect();
    let cloth = ClothState::at_rest(mesh, x, vec![0.2]).unwrap();
    let projection = of(&cloth);
    (cloth, projection)
}

/// How far the worst limited triangle is out of bounds (1), by a singular value decomposition of a
/// library and from material corners.
fn excess(cloth: &ClothState, x: &[World3]) -> f64 {
    let mesh = &cloth.mesh;
    let limited = (0..mesh.n_triangles()).filter(|&t| mesh.panels()[t] == 0);
    let of = |t: usize| {
        let corners = mesh.triangles()[t].map(|i| x[i as usize]);
        let inverse = mesh_core::geometry::inverse_edges(mesh.material()[t]);
        let sigma = mesh_core::geometry::gradient(corners, &inverse).singular_values();
        (sigma.max() - LIMITS.max).max(LIMITS.min - sigma.min())
    };
    limited.map(of).fold(f64::NEG_INFINITY, f64::max)
}

fn centre(cloth: &ClothState, x: &[World3]) -> World3 {
    x.iter().zip(&cloth.m).map(|(x, m)| x * *m).sum::<World3>() / cloth.total_mass()
}

/// A number in −1..1 that depends on nothing but its arguments (splitmix64).
fn noise(seed: u64, at: u64) -> f64 {
    let mut z = (seed ^ at.wrapping_mul(0xd1b5_4a32_d192_ed03)).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Moves every vertex by up to `share` of a cell in a random direction, and turns the whole.
fn shaken(x: &[World3], seed: u64, share: f64) -> Vec<World3> {
    let turn = Rotation3::new(World3::new(1.0, -2.0, 0.5));
    let shift = |i: u64| World3::from_fn(|c, _| noise(seed, 3 * i + c as u64)) * (0.04 * share);
    x.iter().zip(0..).map(|(x, i)| turn * (x + shift(i)) + World3::new(5.0, 3.0, -4.0)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Whatever comes out, the answer is true of it, momentum is kept, and vertices of triangles
    /// without limits stay.
    #[test]
    fn the_answer_is_true_and_momentum_is_kept(seed: u64, share in 0.0..1.0f64) {
        let (cloth, mut projection) = patch(3.0);
        let start = shaken(&cloth.x, seed, share);
        let mut x = start.clone();
        let answer = projection.project(&mut x, &|i| cloth.m[i as usize]);
        // Between the tolerance of the code and that of this test both answers are right.
        match answer {
            None => prop_assert!(excess(&cloth, &start) <= TOLERANCE + 1e-12),
            Some(true) => prop_assert!(excess(&cloth, &x) <= TOLERANCE + 1e-12),
            // The last sweep may have done it.
            Some(false) => prop_assert!(excess(&cloth, &start) > TOLERANCE - 1e-12),
        }
        let moved = (centre(&cloth, &x) - centre(&cloth, &start)).norm();
        prop_assert!(moved < 1e-14 * centre(&cloth, &start).norm(), "{moved:e} m");
        for i in (0..x.len()).filter(|&i| cloth.x[i].x > 0.15 + 1e-9) {
            prop_assert_eq!(x[i], start[i]);
        }
    }

    /// What a step leaves behind, vertices a tenth of a cell out of place, is within bounds after the
    /// sweeps.
    #[test]
    fn mild_disorder_is_always_repaired(seed: u64, share in 0.03..0.1f64) {
        let (cloth, mut projection) = patch(5.0);
        let start = shaken(&cloth.x, seed, share);
        prop_assume!(excess(&cloth, &start) > TOLERANCE + 1e-12);
        let mut x = start.clone();
        prop_assert_eq!(projection.project(&mut x, &|i| cloth.m[i as usize]), Some(true));
        prop_assert!(excess(&cloth, &x) <= TOLERANCE + 1e-12);
        // And not by throwing the cloth about: nothing moves much farther than it was shaken.
        let farthest = x.iter().zip(&start).map(|(x, y)| (x - y).norm()).fold(0.0, f64::max);
        prop_assert!(farthest < 0.04 * 0.3, "{farthest}");
    }

    /// Held vertices never move, whether a triangle has none, one, two or three of them.
    #[test]
    fn held_vertices_never_move(seed: u64, share in 0.05..1.0f64, mask: u32) {
        let (cloth, mut projection) = patch(5.0);
        let start = shaken(&cloth.x, seed, share);
        let held = |i: u32| mask >> (i % 32) & 1 == 1;
        let mut x = start.clone();
        let mass = |i: u32| if held(i) { f64::INFINITY } else { cloth.m[i as usize] };
        let answer = projection.project(&mut x, &mass);
        prop_assert!(x.iter().all(|x| x.iter().all(|c| c.is_finite())), "{answer:?}");
        for i in (0..x.len()).filter(|&i| held(i as u32)) {
            prop_assert_eq!(x[i], start[i]);
        }
    }
}

/// One triangle that is stretched by a fifth, with every choice of held corners: free ones are moved,
/// and unless the held ones cannot be helped it is in bounds afterwards.
#[test]
fn one_triangle_with_any_corners_held() {
    let (cloth, mut projection) = single();
    for mask in 0..8u32 {
        let held = |i: u32| mask >> i & 1 == 1;
        let start: Vec<World3> =
            cloth.x.iter().map(|x| x * 1.2 + World3::new(1.0, 2.0, 3.0)).collect();
        let mut x = start.clone();
        let mass = |i: u32| if held(i) { f64::INFINITY } else { cloth.m[i as usize] };
        let answer = projection.project(&mut x, &mass);
        match mask.count_ones() {
            0 | 1 => {
                assert_eq!(answer, Some(true), "{mask:03b}");
                assert!(excess(&cloth, &x) <= TOLERANCE);
            }
            // An edge between two held corners is too long for good.
            2 => assert_eq!(answer, Some(false), "{mask:03b}"),
            // Nothing that could be done is left undone.
            _ => assert_eq!((answer, &x), (Some(true), &start)),
        }
        for i in 0..3 {
            assert_eq!(x[i as usize] == start[i as usize], held(i), "{mask:03b}, corner {i}");
        }
    }
}

#[test]
fn nothing_happens_within_bounds() {
    let (cloth, mut projection) = patch(5.0);
    let turn = Rotation3::new(World3::new(0.3, 1.0, -2.0));
    for stretch in [0.9501, 0.96, 1.0, 1.04, 1.0499] {
        let start: Vec<World3> = cloth.x.iter().map(|x| turn * x * stretch).collect();
        let mut x = start.clone();
        assert_eq!(projection.project(&mut x, &|i| cloth.m[i as usize]), None, "{stretch}");
        assert_eq!(x, start);
    }
    let mut x: Vec<World3> = cloth.x.iter().map(|x| turn * x * 1.0502).collect();
    assert_eq!(projection.project(&mut x, &|i| cloth.m[i as usize]), Some(true));
}

#[test]
fn without_limits_there_is_no_projection() {
    let (cloth, _) = patch(5.0);
    let rest = Arc::new(RestTriangle::all(&cloth));
    let fabrics = Arc::new(vec![fabric(None), fabric(None)]);
    assert!(StrainProjection::new(cloth.mesh.triangles(), rest, fabrics).is_none());
}

/// Corners on a point, on a line, at the size of rounding, and turned inside out.
#[test]
fn degenerate_triangles_come_back() {
    let corner = |x: f64, y: f64, z: f64| World3::new(x, y, z);
    let cases = [
        [corner(1.0, 2.0, 3.0); 3],
        [corner(0.0, 0.0, 0.0), corner(0.1, 0.0, 0.0), corner(0.3, 0.0, 0.0)],
        [corner(0.0, 0.0, 0.0), corner(0.0, 0.0, 0.0), corner(0.0, 0.2, 0.0)],
        [corner(0.0, 0.0, 0.0), corner(1e-300, 0.0, 0.0), corner(0.0, 1e-300, 0.0)],
        [corner(0.0, 0.0, 0.0), corner(1e8, 0.0, 0.0), corner(0.0, 0.0, -1e8)],
    ];
    for (k, start) in cases.iter().enumerate() {
        let (cloth, mut projection) = single();
        let mut x = start.to_vec();
        assert_eq!(projection.project(&mut x, &|i| cloth.m[i as usize]), Some(true), "case {k}");
        assert!(excess(&cloth, &x) <= TOLERANCE + 1e-6, "case {k}: {}", excess(&cloth, &x));
    }
    // A vertex of a patch drawn onto its neighbour.
    let (cloth, mut projection) = patch(5.0);
    let mut x = cloth.x.clone();
    x[8] = x[9];
    assert_eq!(projection.project(&mut x, &|i| cloth.m[i as usize]), Some(true));
    assert!(excess(&cloth, &x) <= TOLERANCE + 1e-12);
}

#[test]
fn positions_that_are_not_numbers_do_not_panic() {
    let (cloth, mut projection) = patch(5.0);
    for bad in [f64::NAN, f64::INFINITY] {
        let mut x = cloth.x.clone();
        x[7] = World3::repeat(bad);
        let answer = projection.project(&mut x, &|i| cloth.m[i as usize]);
        assert!(answer.is_some(), "{bad} passes for in bounds");
    }
}
