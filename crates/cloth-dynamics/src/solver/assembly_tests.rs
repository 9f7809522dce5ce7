//! Tests of the way from stencils to a matrix: pattern, slots, scatter and product, against sets and
//! dense sums.

use std::collections::BTreeSet;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::{ABSENT, BlockMatrix, PatternBuilder, PatternError, StencilSlots};

/// Numbers that look random (splitmix64).
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
    fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }
    /// In −1..1.
    fn real(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

#[test]
fn pattern_holds_exactly_the_pairs_of_the_stencils() {
    let mut random = Random(1);
    for n in [1, 2, 7, 40] {
        let mut corner = |n| if random.below(5) == 0 { ABSENT } else { random.below(n) as u32 };
        let triples: Vec<[u32; 3]> = (0..n).map(|_| [(); 3].map(|()| corner(n))).collect();
        let quads: Vec<[u32; 4]> = (0..n).map(|_| [(); 4].map(|()| corner(n))).collect();
        let mut builder = PatternBuilder::new(n);
        builder.add(&triples).unwrap();
        builder.add(&quads).unwrap();
        let pattern = builder.build().unwrap();
        let mut pairs: BTreeSet<(usize, usize)> = (0..n).map(|i| (i, i)).collect();
        let stencils = triples.iter().map(|s| &s[..]).chain(quads.iter().map(|s| &s[..]));
        for stencil in stencils {
            let real = || stencil.iter().filter(|&&v| v != ABSENT).map(|&v| v as usize);
            pairs.extend(real().flat_map(|i| real().map(move |j| (i.max(j), i.min(j)))));
        }
        assert_eq!(pattern.n_blocks(), pairs.len());
        let mut slots = BTreeSet::new();
        for i in 0..n {
            assert_eq!(pattern.slot(i, i), Some(pattern.diagonal_slot(i)));
            for j in 0..n {
                assert_eq!(pattern.slot(i, j).is_some(), pairs.contains(&(i, j)), "({i}, {j})");
                slots.extend(pattern.slot(i, j));
            }
        }
        assert_eq!(slots.len(), pairs.len(), "no slot is used twice");
        assert_eq!(pattern.slot(n, 0), None);
        assert_eq!(pattern.slot(0, n), None);
    }
}

#[test]
fn stencils_beyond_the_mesh_are_refused() {
    let mut builder = PatternBuilder::new(3);
    let error = builder.add(&[[0, 1], [2, 3]]).unwrap_err();
    assert_eq!(error, PatternError::NoSuchVertex { stencil: 1, vertex: 3, n_vertices: 3 });
    let pattern = PatternBuilder::new(3).build().unwrap();
    assert!(StencilSlots::new(&pattern, &[[0, 1]]).is_none(), "the pair is not in the pattern");
    assert!(StencilSlots::new(&pattern, &[[0, ABSENT]]).is_some());
}

#[test]
fn scatter_and_product_agree_with_dense_sums() {
    let mut random = Random(2);
    // Absent corners, repeated corners, every order of vertices.
    let stencils = [[0, 1, 2], [2, 1, 3], [3, ABSENT, 0], [4, 4, 1], [4, 0, 4], [1, 3, 4]];
    let mut builder = PatternBuilder::new(6);
    builder.add(&stencils).unwrap();
    let mut matrix = BlockMatrix::new(Arc::new(builder.build().unwrap()));
    let slots = StencilSlots::new(matrix.pattern(), &stencils).unwrap();
    assert_eq!((slots.len(), slots.is_empty()), (6, false));
    let mut expected = DMatrix::zeros(18, 18);
    for (e, stencil) in stencils.iter().enumerate() {
        // The symmetric element matrix G Gᵀ.
        let g: [Matrix3<f64>; 3] = std::array::from_fn(|_| Matrix3::from_fn(|_, _| random.real()));
        let element: [[_; 3]; 3] =
            std::array::from_fn(|a| std::array::from_fn(|b| g[a] * g[b].transpose()));
        slots.scatter(e, &element, &mut matrix);
        for (a, &va) in stencil.iter().enumerate() {
            for (b, &vb) in stencil.iter().enumerate() {
                if va != ABSENT && vb != ABSENT {
                    let mut view =
                        expected.fixed_view_mut::<3, 3>(3 * va as usize, 3 * vb as usize);
                    view += element[a][b];
                }
            }
        }
    }
    for i in 0..6 {
        for j in 0..=i {
            let stored = matrix.pattern().slot(i, j).map(|slot| matrix.blocks()[slot]);
            let wanted = expected.fixed_view::<3, 3>(3 * i, 3 * j);
            assert!((stored.unwrap_or_default() - wanted).amax() < 1e-14, "({i}, {j})");
        }
    }
    let x: Vec<_> = (0..6).map(|_| Vector3::from_fn(|_, _| random.real())).collect();
    let mut y = vec![Vector3::zeros(); 6];
    matrix.multiply(&x, &mut y);
    let flat = |v: &[Vector3<f64>]| DVector::from_iterator(18, v.iter().flatten().copied());
    assert!((flat(&y) - &expected * flat(&x)).amax() < 1e-13);
    // The sums by which shifts are measured.
    let rows = expected.abs().column_sum();
    for (i, sum) in matrix.row_sums().into_iter().enumerate() {
        assert!((sum - rows.rows(3 * i, 3).max()).abs() < 1e-13, "vertex {i}");
    }
}
