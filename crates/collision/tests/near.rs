//! What may come near, against brute force over all pairs of features: nothing that can is missing, and
//! nothing that cannot is there.

use collision::{Aabb, Body, Pair, PairKind, Surface, distance, swept};
use mesh_core::{World3, par};
use proptest::prelude::*;

/// A surface with its way and the radii of its vertices.
#[derive(Clone, Debug)]
struct Moving {
    surface: Surface,
    x: [Vec<World3>; 2],
    radii: Vec<f64>,
}

impl Moving {
    fn is_idle(&self, v: u32) -> bool {
        !self.surface.triangles().iter().any(|t| t.contains(&v))
    }

    fn within(&self) -> Vec<(Pair, f64)> {
        let radius = |v: u32| self.radii[v as usize];
        let body = Body::moving(&self.surface, &self.x[0], &self.x[1], &radius);
        swept::near_within(body, &body.tree(), |_, _| f64::INFINITY)
    }

    fn between(&self, other: &Moving) -> Vec<(Pair, f64)> {
        let (radius, room) = (|v: u32| self.radii[v as usize], |v: u32| other.radii[v as usize]);
        let a = Body::moving(&self.surface, &self.x[0], &self.x[1], &radius);
        let b = Body::moving(&other.surface, &other.x[0], &other.x[1], &room);
        swept::near_between((a, &a.tree()), (b, &b.tree()))
    }
}

/// The pairs that must be found and those that may be, with their distances.
fn brute(a: &Moving, b: &Moving, own: bool) -> [Vec<(Pair, f64)>; 2] {
    let mut all = [Vec::new(), Vec::new()];
    let mut look = |kind, n_a: usize, n_b: usize| {
        for i in 0..n_a as u32 {
            for j in 0..n_b as u32 {
                let pair = Pair { kind, a: i, b: j };
                let (v, is_first) = (pair.vertices(&a.surface, &b.surface), pair.of_first());
                let front = if kind == PairKind::EdgeEdge { 2 } else { 1 };
                let incident = own && v[..front].iter().any(|p| v[front..].contains(p));
                // Vertices without triangles take no part.
                let is_idle = match kind {
                    PairKind::VertexTriangle => a.is_idle(i),
                    PairKind::TriangleVertex => b.is_idle(j),
                    PairKind::EdgeEdge => false,
                };
                if is_idle || incident || (own && kind == PairKind::EdgeEdge && i >= j) {
                    continue;
                }
                let of = |k: usize| if is_first[k] { a } else { b };
                let at = |t: usize| -> [World3; 4] {
                    std::array::from_fn(|k| of(k).x[t][v[k] as usize])
                };
                let x = [at(0), at(1)];
                let radius = |range: std::ops::Range<usize>| {
                    range.map(|k| of(k).radii[v[k] as usize]).fold(0.0, f64::max)
                };
                let radii = [radius(0..front), radius(front..4)];
                let around = |range: std::ops::Range<usize>, r: f64| {
                    Aabb::around(x[0][range.clone()].iter().chain(&x[1][range])).grown(r)
                };
                if !around(0..front, radii[0]).overlaps(&around(front..4, radii[1])) {
                    continue;
                }
                let mut most: f64 = 0.0;
                for k in 0..front {
                    for l in front..4 {
                        let motion = |k: usize| x[1][k] - x[0][k];
                        most = most.max((motion(k) - motion(l)).norm());
                    }
                }
                let d = match kind {
                    PairKind::EdgeEdge => distance::edge_edge(&x[0]).distance(),
                    _ => distance::vertex_triangle(&x[0]).distance(),
                };
                let reach = most + radii[0] + radii[1];
                if d <= reach {
                    all[0].push((pair, d));
                }
                if d <= reach * (1.0 + 1e-8) {
                    all[1].push((pair, d));
                }
            }
        }
    };
    look(PairKind::VertexTriangle, a.surface.n_vertices(), b.surface.n_triangles());
    if !own {
        look(PairKind::TriangleVertex, a.surface.n_triangles(), b.surface.n_vertices());
    }
    look(PairKind::EdgeEdge, a.surface.n_edges(), b.surface.n_edges());
    for list in &mut all {
        list.sort_unstable_by_key(|(pair, _)| *pair);
    }
    all
}

fn check(found: &[(Pair, f64)], a: &Moving, b: &Moving, own: bool) -> Result<(), TestCaseError> {
    let [must, may] = brute(a, b, own);
    prop_assert!(found.is_sorted_by(|p, q| p.0 < q.0));
    for pair in &must {
        prop_assert!(found.contains(pair), "{pair:?} is missing");
    }
    for pair in found {
        prop_assert!(may.contains(pair), "{pair:?} is not near");
    }
    Ok(())
}

/// Numbers from −1 to 1 that follow from a seed.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / f64::from(1u32 << 30) - 1.0
    }
}

/// What makes a sheet.
#[derive(Clone, Debug)]
struct Shape {
    n: u32,
    seed: u64,
    /// Slope of the folds, and by how much vertices are off (1).
    fold: f64,
    off: f64,
    /// Common motion, that of each vertex, and radii, against the size of a square (1).
    common: f64,
    motion: f64,
    radius: f64,
    /// Powers of two of the size and of the distance from the origin.
    size: i32,
    far: i32,
    /// Whether some triangles are turned round, given twice, or without area.
    is_odd: bool,
}

fn shape() -> impl Strategy<Value = Shape> {
    let looks = (2u32..8, any::<u64>(), 0.0..2.5f64, 0.0..0.6f64, any::<bool>());
    let moves =
        (0.0..2.0f64, prop_oneof![Just(0.0), 0.0..0.5f64], prop_oneof![Just(0.0), 0.0..0.5f64]);
    let places = prop_oneof![Just((0, -40)), Just((0, 10)), Just((-200, -240)), Just((200, 190))];
    (looks, moves, places).prop_map(|(looks, moves, places)| {
        let ((n, seed, fold, off, is_odd), (common, motion, radius)) = (looks, moves);
        Shape { n, seed, fold, off, common, motion, radius, size: places.0, far: places.1, is_odd }
    })
}

fn moving(shape: &Shape) -> Moving {
    let mut random = noise(shape.seed);
    let n = shape.n;
    let mut triangles = Vec::new();
    for q in 0..n * n {
        let a = q / n * (n + 1) + q % n;
        let (b, c, d) = (a + 1, a + n + 2, a + n + 1);
        triangles.extend(if random() > 0.0 {
            [[a, b, c], [a, c, d]]
        } else {
            [[a, b, d], [b, c, d]]
        });
    }
    if shape.is_odd {
        for k in 0..triangles.len() {
            match (random() * 20.0) as i32 {
                15 => triangles[k].swap(0, 1),
                16 => triangles[k] = triangles[0],
                17 => triangles.push(triangles[k]),
                // All at one vertex.
                18 if triangles[k][1] != 0 && triangles[k][2] != 0 => triangles[k][0] = 0,
                _ => {}
            }
        }
    }
    let (unit, far) = (f64::from(shape.size).exp2(), f64::from(shape.far).exp2());
    let n_vertices = (n as usize + 1).pow(2);
    let mut vector = |size: f64| World3::new(random(), random(), random()) * size;
    let common = vector(shape.common);
    let mut x = [Vec::new(), Vec::new()];
    for v in 0..n_vertices as u32 {
        let (i, j) = (f64::from(v % (n + 1)), f64::from(v / (n + 1)));
        let mut at = World3::new(0.0, j, 0.1 * i * j);
        for k in 0..16 {
            let angle = shape.fold * (i * (f64::from(k) + 0.5) / 16.0 + 0.2 * j).sin();
            at += World3::new(angle.cos(), 0.0, angle.sin()) * (i / 16.0);
        }
        let start = at + vector(shape.off);
        let end = start + common + vector(shape.motion);
        let place = |x: World3| x * unit + World3::new(far, -far, far);
        x[0].push(place(start));
        x[1].push(place(end));
    }
    if shape.is_odd {
        // Corners that are in the same place, or on a line with others but for almost nothing.
        for v in n as usize + 2..n_vertices {
            let (a, b) = (v - 1, v - n as usize - 2);
            let (kind, off) = ((12.0 * random()) as i32, (30.0 * random() - 30.0).exp2());
            for x in &mut x {
                match kind {
                    1..3 => x[v] = x[a],
                    3..6 => x[v] = (x[a] + x[b]) * 0.5 + World3::new(off, -off, off) * unit,
                    6..9 => x[v] = x[a] * 1.5 - x[b] * 0.5 + World3::new(-off, off, off) * unit,
                    _ => {}
                }
            }
        }
    }
    let radii =
        (0..n_vertices).map(|_| shape.radius * unit * (0.5 + 0.5 * random()).abs()).collect();
    Moving { surface: Surface::new(n_vertices, &triangles).unwrap(), x, radii }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn what_may_come_near_within_a_surface_is_found(shape in shape()) {
        let body = moving(&shape);
        check(&body.within(), &body, &body, true)?;
    }

    #[test]
    fn what_may_come_near_between_surfaces_is_found(a in shape(), n in 2u32..8, seed in any::<u64>()) {
        let other = Shape { n, seed, fold: 0.5 * a.fold, radius: 0.1, ..a.clone() };
        let (a, b) = (moving(&a), moving(&other));
        check(&a.between(&b), &a, &b, false)?;
    }

    /// Of pairs with a vertex that is awake none is missing, and no other is there.
    #[test]
    fn what_sleeps_is_left_out(a in shape(), other in shape(), share in 0u64..5) {
        let (a, b) = (moving(&a), moving(&Shape { size: a.size, far: a.far, ..other }));
        // Runs of vertices, so that whole groups sleep.
        let marks = |of: &Moving, seed: u64| -> Vec<bool> {
            let mark = |v: u64| (v / 7 + seed) % 5 < share;
            (0..of.surface.n_vertices() as u64).map(mark).collect()
        };
        let (awake, awake_b) = (marks(&a, 0), marks(&b, 3));
        let radius = |v: u32| a.radii[v as usize];
        let radius_b = |v: u32| b.radii[v as usize];
        let body = Body::moving(&a.surface, &a.x[0], &a.x[1], &radius);
        let other = Body::moving(&b.surface, &b.x[0], &b.x[1], &radius_b);
        let any = |_: &[u32; 4], _: PairKind| f64::INFINITY;
        let has_awake = |pair: &Pair, marks: [&[bool]; 2], surface: &Surface| {
            let vertices = pair.vertices(&a.surface, surface);
            (0..4).any(|k| marks[usize::from(!pair.of_first()[k])][vertices[k] as usize])
        };
        let mut within = a.within();
        within.retain(|(pair, _)| has_awake(pair, [&awake, &awake], &a.surface));
        let found = swept::near_within(body.awake(&awake), &body.tree(), any);
        prop_assert_eq!(found, within);
        let mut between = a.between(&b);
        between.retain(|(pair, _)| has_awake(pair, [&awake, &awake_b], &b.surface));
        let sleepy = (body.awake(&awake), other.awake(&awake_b));
        let found = swept::near_between((sleepy.0, &body.tree()), (sleepy.1, &other.tree()));
        prop_assert_eq!(found, between);
    }
}

/// A sheet of 40 × 40 squares of 1/64.
const LARGE: Shape = Shape {
    n: 40,
    seed: 3,
    fold: 1.5,
    off: 0.15,
    common: 0.3,
    motion: 0.1,
    radius: 0.2,
    size: -6,
    far: -6,
    is_odd: false,
};

#[test]
fn the_same_pairs_at_any_number_of_threads_and_after_any_life_of_the_tree() {
    let body = moving(&LARGE);
    let radius = |v: u32| body.radii[v as usize];
    let run = |worn: bool| {
        let moving = Body::moving(&body.surface, &body.x[0], &body.x[1], &radius);
        let mut tree = moving.tree();
        if worn {
            let turned: Vec<World3> =
                body.x[0].iter().map(|x| World3::new(x[2], x[0], x[1])).collect();
            tree = Body::still(&body.surface, &turned, &radius).tree();
            moving.update_tree(&mut tree);
        }
        (
            swept::near_within(moving, &tree, |_, _| f64::INFINITY),
            swept::near_between((moving, &tree), (moving, &tree)),
        )
    };
    let one = par::with_threads(1, || run(false)).unwrap();
    let two = par::with_threads(2, || run(true)).unwrap();
    assert!(one.0.len() > 100 && one.1.len() > 1000 && one == two);
}

#[test]
fn parts_of_a_flat_sheet_are_not_near() {
    let flat = Shape { fold: 0.0, off: 0.05, motion: 0.05, radius: 0.15, ..LARGE };
    let found = moving(&flat).within();
    assert!(found.is_empty(), "{}", found.len());
}
