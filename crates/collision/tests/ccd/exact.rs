//! The exact truth about collision queries with integer coordinates, independent of the crate: time is
//! halved until signs of Bernstein coefficients, in integers, decide.

use mesh_core::World3;

/// A point with integer coordinates.
pub(crate) type Point = [i64; 3];

/// Four points at both ends of a linear motion: a vertex and a triangle, or two edges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Query {
    pub(crate) is_edges: bool,
    pub(crate) x_t0: [Point; 4],
    pub(crate) x_t1: [Point; 4],
}

/// What is certain about a query.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Truth {
    /// They touch at no time.
    Free,
    /// They touch, first within this interval of time.
    Hit { from: f64, to: f64 },
    /// They touch within the interval, or nothing is certain after all halvings: degenerate.
    Unclear,
}

/// Most halvings of time.
const DEEPEST: u32 = 20;

type Wide = [i128; 3];

/// The same strict sign of all numbers, or 0.
fn common_sign(values: &[i128]) -> i32 {
    if values.iter().all(|&v| v > 0) {
        1
    } else if values.iter().all(|&v| v < 0) {
        -1
    } else {
        0
    }
}

fn det(u: Wide, v: Wide, w: Wide) -> i128 {
    u[0] * (v[1] * w[2] - v[2] * w[1])
        + u[1] * (v[2] * w[0] - v[0] * w[2])
        + u[2] * (v[0] * w[1] - v[1] * w[0])
}

fn minus(a: Wide, b: Wide) -> Wide {
    std::array::from_fn(|k| a[k] - b[k])
}

/// Sign, all the time, of the cross product of two linearly moving vectors seen along axis `k`.
fn turn(u: [Wide; 2], v: [Wide; 2], k: usize) -> i32 {
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let cross = |u: Wide, v: Wide| u[i] * v[j] - u[j] * v[i];
    common_sign(&[cross(u[0], v[0]), cross(u[0], v[1]) + cross(u[1], v[0]), cross(u[1], v[1])])
}

/// What projections along the axes say about an interval of time.
enum Seen {
    Apart,
    /// Across each other all the time, seen along some axis.
    Across,
    Neither,
}

impl Query {
    /// The positions as numbers of unit `unit` (m) around `origin` (in units); exact by assertion.
    pub(crate) fn placed(&self, origin: i64, unit: f64) -> ([World3; 4], [World3; 4]) {
        let place = |x: &[Point; 4]| {
            x.map(|p| {
                let number = |c: i64| {
                    assert!((origin + c).unsigned_abs() < 1 << 53);
                    (origin + c) as f64 * unit
                };
                World3::new(number(p[0]), number(p[1]), number(p[2]))
            })
        };
        (place(&self.x_t0), place(&self.x_t1))
    }

    /// What is certain.
    pub(crate) fn truth(&self) -> Truth {
        let wide = |x: &[Point; 4]| x.map(|p| p.map(i128::from));
        // With c bits, a Bernstein coefficient has at most 3 (c + 1) + 5, and 3 more per halving.
        let largest = self.x_t0.iter().chain(&self.x_t1).flatten().map(|c| c.unsigned_abs()).max();
        let bits = 64 - largest.unwrap_or(0).leading_zeros();
        let deepest = DEEPEST.min(121u32.saturating_sub(3 * (bits + 1)) / 3);
        search(self.is_edges, wide(&self.x_t0), wide(&self.x_t1), 0, 0, deepest)
    }
}

/// Looks at interval number `at` of 2^depth; coordinates are in units of 2^−depth.
fn search(is_edges: bool, a: [Wide; 4], b: [Wide; 4], depth: u32, at: u64, deepest: u32) -> Truth {
    let relative = |i: usize| [minus(a[i], a[0]), minus(b[i], b[0])];
    let [u, v, w] = [relative(1), relative(2), relative(3)];
    // Bernstein coefficients, times 1, 3, 3, 1, of the coplanarity of the four.
    let volume = [
        det(u[0], v[0], w[0]),
        det(u[1], v[0], w[0]) + det(u[0], v[1], w[0]) + det(u[0], v[0], w[1]),
        det(u[0], v[1], w[1]) + det(u[1], v[0], w[1]) + det(u[1], v[1], w[0]),
        det(u[1], v[1], w[1]),
    ];
    if common_sign(&volume) != 0 || apart_along_an_axis(is_edges, &a, &b) {
        return Truth::Free;
    }
    let seen = if is_edges { edges_seen(u, v, w) } else { vertex_seen(u, v, w) };
    match seen {
        Seen::Apart => return Truth::Free,
        Seen::Across if volume[0].signum() * volume[3].signum() < 0 => {
            let scale = 0.5f64.powi(depth as i32);
            return Truth::Hit { from: at as f64 * scale, to: (at + 1) as f64 * scale };
        }
        _ => {}
    }
    if depth == deepest {
        return Truth::Unclear;
    }
    let double = |x: [Wide; 4]| x.map(|p| p.map(|c| 2 * c));
    let middle = std::array::from_fn(|i| std::array::from_fn(|k| a[i][k] + b[i][k]));
    match search(is_edges, double(a), middle, depth + 1, 2 * at, deepest) {
        Truth::Free => search(is_edges, middle, double(b), depth + 1, 2 * at + 1, deepest),
        other => other,
    }
}

fn apart_along_an_axis(is_edges: bool, a: &[Wide; 4], b: &[Wide; 4]) -> bool {
    let n = if is_edges { 2 } else { 1 };
    (0..3).any(|k| {
        let differences = || {
            (0..n)
                .flat_map(move |i| (n..4).flat_map(move |j| [a[i][k] - a[j][k], b[i][k] - b[j][k]]))
        };
        differences().all(|d| d > 0) || differences().all(|d| d < 0)
    })
}

/// Corners u, v, w of a triangle around a vertex at the origin.
fn vertex_seen(u: [Wide; 2], v: [Wide; 2], w: [Wide; 2]) -> Seen {
    let edge = |p: [Wide; 2], q: [Wide; 2]| [minus(q[0], p[0]), minus(q[1], p[1])];
    for k in 0..3 {
        let around = [turn(u, v, k), turn(v, w, k), turn(w, u, k)];
        let area = turn(edge(u, v), edge(u, w), k);
        if area != 0 && around.contains(&-area) {
            return Seen::Apart;
        }
    }
    let across = (0..3).any(|k| {
        let first = turn(u, v, k);
        first != 0 && turn(v, w, k) == first && turn(w, u, k) == first
    });
    if across { Seen::Across } else { Seen::Neither }
}

/// Edge from the origin to u, and edge from v to w.
fn edges_seen(u: [Wide; 2], v: [Wide; 2], w: [Wide; 2]) -> Seen {
    let from = |p: [Wide; 2], q: [Wide; 2]| [minus(q[0], p[0]), minus(q[1], p[1])];
    let mut seen = Seen::Neither;
    for k in 0..3 {
        let ends = [turn(u, v, k), turn(u, w, k)];
        // The origin and u as seen from v along the other edge.
        let other = from(v, w);
        let back = [turn(other, from(v, [[0; 3]; 2]), k), turn(other, from(v, u), k)];
        for pair in [ends, back] {
            if pair[0] != 0 && pair[0] == pair[1] {
                return Seen::Apart;
            }
        }
        if ends[0] * ends[1] < 0 && back[0] * back[1] < 0 {
            seen = Seen::Across;
        }
    }
    seen
}
