//! Proximity and impacts of whole surfaces against brute force over all features.

use collision::ccd::{self, Ccd};
use collision::{Body, Pair, PairKind, Surface, distance, proximity, swept};
use mesh_core::{World3, par};

/// A wavy sheet of `n × n` squares.
fn sheet(n: u32, seed: f64) -> (Surface, Vec<World3>) {
    let mut triangles = Vec::new();
    let vertex = |i: u32, j: u32| j * (n + 1) + i;
    for j in 0..n {
        for i in 0..n {
            let [a, b, c, d] =
                [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let n_vertices = (n as usize + 1).pow(2);
    (Surface::new(n_vertices, &triangles).unwrap(), waves(n, seed))
}

fn waves(n: u32, seed: f64) -> Vec<World3> {
    let at = |v: u32| {
        let (s, t) = (f64::from(v % (n + 1)) / f64::from(n), f64::from(v / (n + 1)) / f64::from(n));
        let wave = |a: f64, b: f64| (a * s + b * t + seed).sin();
        World3::new(wave(4.0, 1.0), wave(1.3, 5.0), wave(6.0, -3.0)) * 0.5
    };
    (0..(n + 1) * (n + 1)).map(at).collect()
}

/// All pairs of features of two bodies, or of one with itself.
fn all_pairs(a: &Surface, b: &Surface, own: bool) -> Vec<Pair> {
    let mut pairs = Vec::new();
    let mut push = |kind, n_a: usize, n_b: usize| {
        for i in 0..n_a as u32 {
            for j in 0..n_b as u32 {
                let pair = Pair { kind, a: i, b: j };
                let v = pair.vertices(a, b);
                let n = if kind == PairKind::EdgeEdge { 2 } else { 1 };
                let incident = own && v[..n].iter().any(|p| v[n..].contains(p));
                let repeated = own && kind == PairKind::EdgeEdge && i >= j;
                if !incident && !repeated {
                    pairs.push(pair);
                }
            }
        }
    };
    push(PairKind::VertexTriangle, a.n_vertices(), b.n_triangles());
    if !own {
        push(PairKind::TriangleVertex, a.n_triangles(), b.n_vertices());
    }
    push(PairKind::EdgeEdge, a.n_edges(), b.n_edges());
    pairs
}

fn positions(pair: Pair, a: (&Surface, &[World3]), b: (&Surface, &[World3])) -> [World3; 4] {
    let (v, first) = (pair.vertices(a.0, b.0), pair.of_first());
    std::array::from_fn(|i| if first[i] { a.1[v[i] as usize] } else { b.1[v[i] as usize] })
}

fn radius_of(pair: Pair, a: &Surface, b: &Surface, radius: [&dyn Fn(u32) -> f64; 2]) -> f64 {
    let (v, first) = (pair.vertices(a, b), pair.of_first());
    let largest = |side: bool| {
        let own = (0..4).filter(|&i| first[i] == side).map(|i| radius[usize::from(!side)](v[i]));
        own.fold(0.0, f64::max)
    };
    largest(true) + largest(false)
}

fn squared(pair: Pair, x: &[World3; 4]) -> f64 {
    match pair.kind {
        PairKind::EdgeEdge => distance::edge_edge(x).squared,
        _ => distance::vertex_triangle(x).squared,
    }
}

/// Two thicknesses, so that the largest of a triangle matters.
fn uneven(v: u32) -> f64 {
    if v.is_multiple_of(3) { 0.03 } else { 0.01 }
}

#[test]
fn proximities_are_those_of_brute_force() {
    let ((a, x_a), (b, x_b)) = (sheet(11, 0.3), sheet(7, 2.0));
    let flat = |_: u32| 0.02;
    let (body_a, body_b) = (Body::still(&a, &x_a, &uneven), Body::still(&b, &x_b, &flat));

    let expected =
        |pairs: Vec<Pair>, b: &Surface, x_b: &[World3], radius: [&dyn Fn(u32) -> f64; 2]| {
            let near = |p: &Pair| {
                let d = squared(*p, &positions(*p, (&a, &x_a), (b, x_b))).sqrt();
                d <= radius_of(*p, &a, b, radius)
            };
            let mut near: Vec<Pair> = pairs.into_iter().filter(near).collect();
            near.sort_unstable();
            near
        };
    let own = proximity::within(body_a, &body_a.tree());
    assert!(own.len() > 200, "{}", own.len());
    let pairs: Vec<Pair> = own.iter().map(|p| p.pair).collect();
    assert_eq!(pairs, expected(all_pairs(&a, &a, true), &a, &x_a, [&uneven, &uneven]));

    let both = proximity::between((body_a, &body_a.tree()), (body_b, &body_b.tree()));
    assert!(both.len() > 200, "{}", both.len());
    let pairs: Vec<Pair> = both.iter().map(|p| p.pair).collect();
    assert_eq!(pairs, expected(all_pairs(&a, &b, false), &b, &x_b, [&uneven, &flat]));
    for kind in [PairKind::VertexTriangle, PairKind::TriangleVertex, PairKind::EdgeEdge] {
        assert!(pairs.iter().any(|p| p.kind == kind));
    }
    for p in &both {
        let x = positions(p.pair, (&a, &x_a), (&b, &x_b));
        let sum: World3 = (0..4).map(|i| x[i] * p.weights[i]).sum();
        assert!((sum - p.offset).norm() < 1e-14 && (p.offset.norm() - p.distance).abs() < 1e-16);
        assert_eq!(p.thickness, radius_of(p.pair, &a, &b, [&uneven, &flat]));
    }
}

#[test]
fn impacts_are_those_of_brute_force() {
    let ((a, x_t0), (b, y_t0)) = (sheet(8, 0.3), sheet(5, 2.0));
    let (x_t1, y_t1) = (waves(8, 0.5), waves(5, 2.3));
    let (no, thin) = (|_: u32| 0.0, |_: u32| 1e-3);
    for radius in [&no as &(dyn Fn(u32) -> f64 + Sync), &thin] {
        let body_a = Body::moving(&a, &x_t0, &x_t1, radius);
        let body_b = Body::moving(&b, &y_t0, &y_t1, radius);
        let expected = |pairs: Vec<Pair>, b: &Surface, y_t0: &[World3], y_t1: &[World3]| {
            let mut hits: Vec<(Pair, f64)> = Vec::new();
            for p in pairs {
                let start = positions(p, (&a, &x_t0), (b, y_t0));
                let end = positions(p, (&a, &x_t1), (b, y_t1));
                let test = if p.kind == PairKind::EdgeEdge {
                    ccd::edge_edge
                } else {
                    ccd::vertex_triangle
                };
                if let Ccd::Hit { t } = test(&start, &end, 2.0 * radius(0)) {
                    hits.push((p, t));
                }
            }
            hits.sort_unstable_by_key(|h| h.0);
            hits
        };
        let plain = |impacts: Vec<swept::Impact>| -> Vec<(Pair, f64)> {
            impacts.into_iter().map(|i| (i.pair, i.t)).collect()
        };
        let own = swept::impacts_within(body_a, &body_a.tree());
        assert!(own.len() > 30 && own.iter().any(|i| i.t > 0.0), "{}", own.len());
        let first = swept::free_until(&own);
        assert!(own.iter().all(|i| i.t >= first) && own.iter().any(|i| i.t == first));
        assert_eq!(swept::free_until(&[]), 1.0);
        assert_eq!(plain(own), expected(all_pairs(&a, &a, true), &a, &x_t0, &x_t1));
        let both = swept::impacts_between((body_a, &body_a.tree()), (body_b, &body_b.tree()));
        assert!(both.len() > 30, "{}", both.len());
        let candidates =
            swept::candidates_between((body_a, &body_a.tree()), (body_b, &body_b.tree()));
        assert!(both.iter().all(|i| candidates.binary_search(&i.pair).is_ok()));
        assert_eq!(plain(both), expected(all_pairs(&a, &b, false), &b, &y_t0, &y_t1));
    }
}

#[test]
fn the_same_contacts_at_any_number_of_threads_and_whatever_the_tree_has_been_through() {
    let (surface, x_t0) = sheet(40, 0.3);
    let x_t1 = waves(40, 0.33);
    let run = |worn: bool| {
        let body = Body::moving(&surface, &x_t0, &x_t1, &uneven);
        let tree = if worn {
            let far = waves(40, 2.0);
            let mut tree = Body::still(&surface, &far, &uneven).tree();
            assert!(body.tree().bounds() != tree.bounds());
            body.update_tree(&mut tree);
            tree
        } else {
            body.tree()
        };
        let (near, hits) = (proximity::within(body, &tree), swept::impacts_within(body, &tree));
        (near, hits, swept::candidates_within(body, &tree))
    };
    let one = par::with_threads(1, || run(false)).unwrap();
    let two = par::with_threads(2, || run(true)).unwrap();
    assert!(one.0.len() > 1000 && one.1.len() > 1000 && one == two);
}

#[test]
fn the_limit_itself_is_contact() {
    let (sheet, _) = sheet(10, 0.0);
    let two = sheet.joined(&sheet);
    // A thickness that the lattice of coordinates, 1/8 m, holds exactly.
    let thickness = 0.0078125;
    let radius = |_: u32| 0.5 * thickness;
    let n_at = |gap: f64| {
        let at = |v: u32, z: f64| World3::new(f64::from(v % 11), f64::from(v / 11), z) * 0.125;
        let x: Vec<World3> =
            (0..121).map(|v| at(v, 0.0)).chain((0..121).map(|v| at(v, 8.0 * gap))).collect();
        let body = Body::still(&two, &x, &radius);
        proximity::within(body, &body.tree()).len()
    };
    // Every vertex meets at least the six triangles around the one across, on either side.
    assert!(n_at(thickness) > 2 * 81 * 6, "{}", n_at(thickness));
    // Distances have rounding errors of the size of the triangles.
    assert_eq!(n_at(thickness + 1e-15), 0);
}
