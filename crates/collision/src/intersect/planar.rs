//! Edges and triangles in one plane, exactly.
//!
//! Seen along an axis, figures in a plane can only come together, never part. Along at least one axis
//! the view of their plane is one-to-one (for points on a line: of their line). So they have a point
//! in common exactly if they have one seen along every axis, and no plane has to be computed.

use mesh_core::World3;
use robust::{Coord, orient2d};

type Point = [f64; 2];

/// True if an edge and a triangle in one plane have a point in common.
pub(super) fn edge_triangle(p: &World3, q: &World3, t: &[World3; 3]) -> bool {
    (0..3).all(|k| {
        let seen = |x: &World3| [x[(k + 1) % 3], x[(k + 2) % 3]];
        let (p, q, t) = (seen(p), seen(q), [seen(&t[0]), seen(&t[1]), seen(&t[2])]);
        inside(p, t) || (0..3).any(|i| segments(p, q, t[i], t[(i + 1) % 3]))
    })
}

fn turn(a: Point, b: Point, c: Point) -> f64 {
    let coord = |p: Point| Coord { x: p[0], y: p[1] };
    orient2d(coord(a), coord(b), coord(c))
}

/// True inside a triangle with area. Its outline is the edges' business.
fn inside(p: Point, [a, b, c]: [Point; 3]) -> bool {
    let turns = [turn(a, b, p), turn(b, c, p), turn(c, a, p)];
    turns.iter().all(|&t| t > 0.0) || turns.iter().all(|&t| t < 0.0)
}

/// True if two closed segments, of any length, have a point in common.
fn segments(a: Point, b: Point, c: Point, d: Point) -> bool {
    let of_cd = [turn(c, d, a), turn(c, d, b)];
    let of_ab = [turn(a, b, c), turn(a, b, d)];
    let part = |[s, t]: [f64; 2]| (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0);
    (part(of_cd) && part(of_ab))
        || (of_cd[0] == 0.0 && within(a, c, d))
        || (of_cd[1] == 0.0 && within(b, c, d))
        || (of_ab[0] == 0.0 && within(c, a, b))
        || (of_ab[1] == 0.0 && within(d, a, b))
}

/// True for a point of the line through `a` and `b` that lies between them.
fn within(p: Point, a: Point, b: Point) -> bool {
    (0..2).all(|k| a[k].min(b[k]) <= p[k] && p[k] <= a[k].max(b[k]))
}
