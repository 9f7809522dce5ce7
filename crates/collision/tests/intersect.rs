//! Edge–triangle tests against exact integers, and the search by trees against brute force.

use collision::intersect::{self, Crossing, edge_triangle};
use collision::{Bvh, Surface};
use mesh_core::{World3, par};
use proptest::prelude::*;

type Point = [i64; 3];

fn minus(a: Point, b: Point) -> Point {
    std::array::from_fn(|k| a[k] - b[k])
}

fn cross(u: Point, v: Point) -> Point {
    std::array::from_fn(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3])
}

fn dot(u: Point, v: Point) -> i64 {
    (0..3).map(|k| u[k] * v[k]).sum()
}

fn det(a: Point, b: Point, c: Point, d: Point) -> i64 {
    dot(minus(a, d), cross(minus(b, d), minus(c, d)))
}

/// The truth by another way: some plane separates the two, in integers.
fn separated(p: Point, q: Point, t: [Point; 3]) -> bool {
    // Across the normal, across cross products of edges, and, for those in a plane, across edges turned
    // within it.
    let e = minus(q, p);
    let sides = [minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])];
    let normal = cross(sides[0], sides[1]);
    let mut directions = vec![normal, [1, 0, 0], [0, 1, 0], [0, 0, 1], e];
    let mut normals = vec![normal];
    for s in sides {
        directions.extend([s, cross(e, s)]);
        normals.push(cross(e, s));
    }
    for n in normals {
        directions.extend([e, sides[0], sides[1], sides[2]].map(|s| cross(n, s)));
    }
    // Edges on one line and degenerate triangles: across from every corner.
    for c in t {
        let m = cross(minus(c, p), e);
        directions.extend([m, cross(m, e)]);
        for s in sides {
            let m = cross(minus(p, c), s);
            directions.extend([m, cross(m, s)]);
            let m = cross(minus(q, c), s);
            directions.extend([m, cross(m, s)]);
        }
    }
    directions.into_iter().any(|d| {
        let edge = [p, q].map(|x| dot(d, x));
        let triangle = t.map(|x| dot(d, x));
        edge.iter().max() < triangle.iter().min() || triangle.iter().max() < edge.iter().min()
    })
}

fn proper(p: Point, q: Point, [a, b, c]: [Point; 3]) -> bool {
    let sides = [det(p, q, a, b), det(p, q, b, c), det(p, q, c, a)].map(i64::signum);
    det(a, b, c, p).signum() * det(a, b, c, q).signum() < 0
        && sides[0] != 0
        && sides.iter().all(|&s| s == sides[0])
}

fn world(p: Point) -> World3 {
    World3::from(p.map(|c| c as f64))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100_000))]

    /// Small integers: touching and coplanar all the time.
    #[test]
    fn the_exact_answer_on_a_lattice(x in prop::array::uniform5(prop::array::uniform3(-2i64..=2))) {
        let [p, q, a, b, c] = x;
        let expected = if proper(p, q, [a, b, c]) {
            Crossing::Proper
        } else if separated(p, q, [a, b, c]) {
            Crossing::Apart
        } else {
            Crossing::Touching
        };
        prop_assert_eq!(edge_triangle(&world(p), &world(q), &[world(a), world(b), world(c)]), expected);
    }
}

#[test]
fn next_to_nothing_decides() {
    let t = [[-1.0, -1.0, 0.0], [3.0, -1.0, 0.0], [-1.0, 3.0, 0.0]].map(World3::from);
    let up = World3::new(0.3, 0.3, 1.0);
    let at = |z: f64| World3::new(0.3, 0.3, z);
    assert_eq!(edge_triangle(&up, &at(-1e-300), &t), Crossing::Proper);
    assert_eq!(edge_triangle(&up, &at(0.0), &t), Crossing::Touching);
    assert_eq!(edge_triangle(&up, &at(1e-300), &t), Crossing::Apart);
    // Far away, with an edge a last digit beside a side of the triangle.
    let far = t.map(|x| x + World3::new(1048576.0, 1048576.0, 0.0));
    let edge = |x: f64| [World3::new(x, 1048576.0, 1.0), World3::new(x, 1048576.0, -1.0)];
    let side = far[0].x;
    for (x, expected) in [
        (side.next_up(), Crossing::Proper),
        (side, Crossing::Touching),
        (side.next_down(), Crossing::Apart),
    ] {
        let [p, q] = edge(x);
        assert_eq!(edge_triangle(&p, &q, &far), expected);
        assert_eq!(edge_triangle(&q, &p, &[far[2], far[1], far[0]]), expected);
    }
}

/// A wavy sheet of `n × n` squares that runs through itself.
fn crumpled(n: u32, seed: f64) -> (Surface, Vec<World3>) {
    let mut triangles = Vec::new();
    let vertex = |i: u32, j: u32| j * (n + 1) + i;
    for j in 0..n {
        for i in 0..n {
            let [a, b, c, d] =
                [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let x = (0..(n + 1) * (n + 1))
        .map(|v| {
            let (s, t) =
                (f64::from(v % (n + 1)) / f64::from(n), f64::from(v / (n + 1)) / f64::from(n));
            let wave = |a: f64, b: f64| (a * s + b * t + seed).sin();
            World3::new(wave(4.0, 1.0), wave(1.3, 5.0), wave(6.0, -3.0)) * 0.5
        })
        .collect();
    (Surface::new((n as usize + 1).pow(2), &triangles).unwrap(), x)
}

#[test]
fn trees_find_what_brute_force_finds() {
    let ((a, x_a), (b, x_b)) = (crumpled(14, 0.3), crumpled(9, 2.0));
    let (tree_a, tree_b) = (a.tree(&x_a), b.tree(&x_b));
    let own = intersect::within(&a, &x_a, &tree_a);
    assert!(own.len() > 30, "{}", own.len());
    assert_eq!(own, intersect::within_brute_force(&a, &x_a));
    let both = intersect::between((&a, &x_a, &tree_a), (&b, &x_b, &tree_b));
    assert!(both.len() > 30, "{}", both.len());
    assert_eq!(both, intersect::between_brute_force((&a, &x_a), (&b, &x_b)));
    // The surfaces joined know the same crossings.
    let joined = a.joined(&b);
    let x: Vec<World3> = x_a.iter().chain(&x_b).copied().collect();
    let all = intersect::within(&joined, &x, &joined.tree(&x));
    let back = intersect::between((&b, &x_b, &tree_b), (&a, &x_a, &tree_a));
    let n_own_b = intersect::within(&b, &x_b, &tree_b).len();
    assert_eq!(all.len(), own.len() + both.len() + back.len() + n_own_b);
}

#[test]
fn the_same_crossings_at_any_number_of_threads_and_for_a_refitted_tree() {
    let (surface, x) = crumpled(40, 0.3);
    let (_, other) = crumpled(40, 1.1);
    let run = || {
        let mut tree: Bvh = surface.tree(&other);
        tree.refit(|t| surface.triangle_box(&x, t));
        intersect::within(&surface, &x, &tree)
    };
    let (one, two) = (par::with_threads(1, run).unwrap(), par::with_threads(2, run).unwrap());
    assert!(one.len() > 100 && one == two);
    assert_eq!(one, intersect::within(&surface, &x, &surface.tree(&x)));
}
