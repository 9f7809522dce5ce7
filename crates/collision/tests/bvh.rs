//! The tree of boxes against brute force, on random and degenerate boxes.

use collision::{Aabb, Bvh};
use mesh_core::par;
use proptest::prelude::*;

fn brute_self(boxes: &[Aabb], keep: impl Fn(u32, u32) -> bool) -> Vec<[u32; 2]> {
    brute_between(boxes, boxes, |a, b| a < b && keep(a, b))
}

fn brute_between(a: &[Aabb], b: &[Aabb], keep: impl Fn(u32, u32) -> bool) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for (i, p) in (0..).zip(a) {
        for (j, q) in (0..).zip(b) {
            // Written out on purpose: not by the function under test.
            let apart = (0..3).any(|k| p.hi[k] < q.lo[k] || q.hi[k] < p.lo[k]);
            if !apart && keep(i, j) {
                pairs.push([i, j]);
            }
        }
    }
    pairs
}

fn tree(boxes: &[Aabb]) -> Bvh {
    Bvh::build(boxes.len(), |i| boxes[i as usize])
}

/// Boxes on a coarse lattice: many touch, coincide, are flat, or are points.
fn lattice_box() -> impl Strategy<Value = Aabb> {
    let axis = || (-6i32..6, 0i32..3);
    (axis(), axis(), axis()).prop_map(|axes| {
        let [x, y, z] = [axes.0, axes.1, axes.2];
        let lo = [x.0, y.0, z.0].map(f64::from);
        let size = [x.1, y.1, z.1].map(f64::from);
        Aabb { lo, hi: std::array::from_fn(|k| lo[k] + size[k]) }
    })
}

/// Boxes of very different sizes, far from the origin.
fn wild_box() -> impl Strategy<Value = Aabb> {
    (prop::array::uniform3(-1.0..1.0f64), prop::array::uniform3(-20.0..1.0f64)).prop_map(
        |(lo, size)| {
            let lo = lo.map(|x| 1e6 + x);
            Aabb { lo, hi: std::array::from_fn(|k| lo[k] + size[k].exp2()) }
        },
    )
}

fn any_boxes() -> impl Strategy<Value = Vec<Aabb>> {
    prop_oneof![
        prop::collection::vec(lattice_box(), 0..120),
        prop::collection::vec(wild_box(), 0..120),
        prop::collection::vec(lattice_box(), 1..8)
            .prop_map(|few| (0..90).map(|i| few[i % few.len()]).collect()),
    ]
}

proptest! {
    #[test]
    fn pairs_are_those_of_brute_force(a in any_boxes(), b in any_boxes()) {
        let keep = |i: u32, j: u32| !(i + j).is_multiple_of(5);
        prop_assert_eq!(tree(&a).self_pairs(keep), brute_self(&a, keep));
        prop_assert_eq!(tree(&a).pairs_with(&tree(&b), keep), brute_between(&a, &b, keep));
        for (i, probe) in b.iter().enumerate().take(10) {
            let found: Vec<[u32; 2]> =
                tree(&a).overlaps(probe).into_iter().map(|j| [i as u32, j]).collect();
            let expected = brute_between(&b, &a, |k, _| k == i as u32);
            prop_assert_eq!(found, expected);
        }
    }

    #[test]
    fn a_refitted_tree_answers_like_a_new_one(a in any_boxes(), seed in any::<u64>()) {
        let mut old = tree(&a);
        // The same boxes given to other elements: the worst that motion can do.
        let mut moved = a.clone();
        let n = moved.len().max(1);
        (0..moved.len()).for_each(|i| moved.swap(i, (seed as usize).wrapping_mul(i + 7) % n));
        old.refit(|i| moved[i as usize]);
        prop_assert_eq!(old.self_pairs(|_, _| true), brute_self(&moved, |_, _| true));
        prop_assert_eq!(old.bounds(), tree(&a).bounds());
        let built = old.update(moved.len(), |i| moved[i as usize]);
        prop_assert_eq!(old.self_pairs(|_, _| true), brute_self(&moved, |_, _| true));
        prop_assert!(!old.is_worn() || !built);
    }
}

/// Triangles of a flat sheet of `n × n` squares, and the vertices they share.
fn sheet(n: u32) -> (Vec<[u32; 3]>, impl Fn([u32; 3]) -> Aabb) {
    let vertex = move |i: u32, j: u32| j * (n + 1) + i;
    let triangles = (0..n * n).flat_map(move |q| {
        let (i, j) = (q % n, q / n);
        let [a, b, c, d] =
            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| vertex(i, j));
        [[a, b, c], [a, c, d]]
    });
    let around = move |t: [u32; 3]| {
        let x =
            t.map(|v| mesh_core::World3::new(f64::from(v % (n + 1)), f64::from(v / (n + 1)), 0.0));
        Aabb::around(&x)
    };
    (triangles.collect(), around)
}

#[test]
fn neighbours_stay_out_if_the_filter_says_so() {
    let (triangles, around) = sheet(20);
    let tree = Bvh::build(triangles.len(), |i| around(triangles[i as usize]));
    let shares =
        |a: u32, b: u32| triangles[a as usize].iter().any(|v| triangles[b as usize].contains(v));
    let all = tree.self_pairs(|_, _| true);
    assert!(all.iter().filter(|p| shares(p[0], p[1])).count() > 6 * 400);
    let apart = tree.self_pairs(|a, b| !shares(a, b));
    assert!(!apart.is_empty() && apart.iter().all(|p| !shares(p[0], p[1])));
    assert_eq!(apart, all.into_iter().filter(|p| !shares(p[0], p[1])).collect::<Vec<_>>());
}

#[test]
fn the_same_pairs_at_any_number_of_threads() {
    let (triangles, around) = sheet(60);
    let run = || {
        let mut tree = Bvh::build(triangles.len(), |i| around(triangles[i as usize]));
        tree.refit(|i| around(triangles[i as usize]).grown(0.25));
        (
            tree.self_pairs(|_, _| true),
            tree.pairs_with(&tree, |_, _| true),
            tree.looseness().to_bits(),
        )
    };
    let one = par::with_threads(1, run).unwrap();
    let two = par::with_threads(2, run).unwrap();
    assert!(one.0.len() > 7200 && one == two);
}

#[test]
fn a_tree_wears_out_when_its_elements_change_places_and_not_when_they_move_together() {
    let (triangles, around) = sheet(40);
    let n = triangles.len();
    let mut tree = Bvh::build(n, |i| around(triangles[i as usize]));
    let stretched = |i: u32| {
        let b = around(triangles[i as usize]);
        Aabb { lo: b.lo.map(|x| 3.0 * x + 7.0), hi: b.hi.map(|x| 3.0 * x + 7.0) }
    };
    assert!(!tree.update(n, stretched));
    let shuffled = |i: u32| around(triangles[(i as usize * 1237) % n]);
    assert!(tree.update(n, shuffled), "looseness {}", tree.looseness());
    assert!(!tree.is_worn());
    assert!(tree.update(n - 1, shuffled) && tree.len() == n - 1);
}

#[test]
fn small_trees() {
    let none = tree(&[]);
    let point = Aabb { lo: [1.0; 3], hi: [1.0; 3] };
    let one = tree(&[point]);
    assert!(none.is_empty() && none.self_pairs(|_, _| true).is_empty());
    assert!(none.pairs_with(&one, |_, _| true).is_empty());
    assert!(one.pairs_with(&none, |_, _| true).is_empty());
    assert!(none.overlaps(&point).is_empty() && none.bounds() == Aabb::EMPTY);
    assert_eq!(one.overlaps(&point), [0]);
    assert_eq!(one.pairs_with(&tree(&[point; 6]), |_, j| j != 2).len(), 5);
    assert_eq!(tree(&[point; 6]).self_pairs(|_, _| true).len(), 15);
}
