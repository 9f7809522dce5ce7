//! Closest points of a vertex and a triangle, and of two edges.
//!
//! The candidates are taken one by one and the best wins (compare Ericson2005 §5.1, whose cascades of
//! sign tests go wrong on elements without area or length). The best is the nearest. But distances
//! say little about points close to the nearest one: at 1e-9 from it they are the same to the last
//! digit. Among equals wins the candidate that best satisfies what holds for the nearest points only:
//! that all of both elements lies beyond the planes across its offset.

use mesh_core::World3;

/// The closest points of two elements with four vertices in all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest<F> {
    /// Which features the points lie on.
    pub feature: F,
    /// Signed weights of the four vertices: the weighted sum of their positions leads from the point
    /// on the second element to the point on the first (1). Those of the first element sum to 1, those
    /// of the second to −1.
    pub weights: [f64; 4],
    /// From the point on the second element to the point on the first (m).
    pub offset: World3,
    /// Square of the distance (m²).
    pub squared: f64,
}

impl<F> Closest<F> {
    /// The distance (m).
    pub fn distance(&self) -> f64 {
        self.squared.sqrt()
    }
}

/// What of a triangle is closest to a vertex. Corners are numbered 0, 1, 2; edge k is from corner k to
/// corner k + 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VertexTriangleFeature {
    /// A corner: the distance is that of two points.
    Corner(usize),
    /// The inside of an edge: the distance is that of a point and a line.
    Edge(usize),
    /// The inside: the distance is that of a point and a plane.
    Face,
}

/// What of two edges is closest to each other. Ends are numbered 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeEdgeFeature {
    /// An end of each.
    Ends(usize, usize),
    /// An end of the first and the inside of the second.
    EndInside(usize),
    /// The inside of the first and an end of the second.
    InsideEnd(usize),
    /// The insides: the distance is that of two lines.
    Inside,
}

/// The point of the segment from `a` to `b` that is nearest to `p`: its parameter from 0 to 1 (1), and
/// the way from it to `p` (m). A segment without length has parameter 0.
#[inline]
pub fn segment(p: &World3, a: &World3, b: &World3) -> (f64, World3) {
    let e = b - a;
    let from_a = p - a;
    let along = from_a.dot(&e);
    let length_squared = e.norm_squared();
    if along <= 0.0 || length_squared == 0.0 {
        return (0.0, from_a);
    }
    // From the end, so that the parameter is exact near either.
    let from_b = p - b;
    let back = -from_b.dot(&e);
    if back <= 0.0 {
        return (1.0, from_b);
    }
    // Rejecting from the nearer end loses least.
    if along <= back {
        let s = along / length_squared;
        (s, from_a - e * s)
    } else {
        let r = back / length_squared;
        (1.0 - r, from_b + e * r)
    }
}

/// The better of the candidates for two elements whose corners differ by `D`.
struct Best<'a, F> {
    differences: &'a [World3],
    /// Squares of distances that differ by less than this times the larger distance are the same (m).
    rounding: f64,
    best: Closest<F>,
    /// By how much some difference lies before the plane across the offset (m²).
    violation: f64,
}

impl<'a, F: Copy> Best<'a, F> {
    fn of(differences: &'a [World3], first: Closest<F>) -> Best<'a, F> {
        let size = differences.iter().map(|d| d.amax()).fold(0.0, f64::max);
        let rounding = 8.0 * f64::EPSILON * size;
        let mut best = Best { differences, rounding, best: first, violation: 0.0 };
        best.violation = best.violation_of(&first.offset);
        best
    }

    #[inline]
    fn violation_of(&self, r: &World3) -> f64 {
        self.differences.iter().map(|d| r.dot(&(r - d))).fold(f64::NEG_INFINITY, f64::max)
    }

    #[inline]
    fn take(&mut self, feature: F, weights: [f64; 4], offset: World3) {
        let squared = offset.norm_squared();
        let old = self.best.squared;
        let slack = self.rounding * squared.max(old).sqrt();
        if squared <= old + slack {
            let violation = self.violation_of(&offset);
            if squared < old - slack || violation < self.violation {
                self.best = Closest { feature, weights, offset, squared };
                self.violation = violation;
            }
        }
    }
}

/// The point of triangle `x[1], x[2], x[3]` closest to vertex `x[0]` (m).
pub fn vertex_triangle(x: &[World3; 4]) -> Closest<VertexTriangleFeature> {
    let [p, a, b, c] = *x;
    let corners = [a, b, c];
    let differences = corners.map(|x| p - x);
    let on_edge = |k: usize| {
        use VertexTriangleFeature::{Corner, Edge};
        let next = (k + 1) % 3;
        let (s, offset) = segment(&p, &corners[k], &corners[next]);
        let feature = match end_of(s) {
            Some(end) => Corner((k + end) % 3),
            None => Edge(k),
        };
        let mut weights = [1.0, 0.0, 0.0, 0.0];
        weights[1 + k] = s - 1.0;
        weights[1 + next] = -s;
        (feature, weights, offset)
    };
    let (feature, weights, offset) = on_edge(0);
    let first = Closest { feature, weights, offset, squared: offset.norm_squared() };
    let mut best = Best::of(&differences, first);
    for k in 1..3 {
        let (feature, weights, offset) = on_edge(k);
        best.take(feature, weights, offset);
    }
    if let Some((w, offset)) = projection(&p, &corners) {
        best.take(VertexTriangleFeature::Face, [1.0, -w[0], -w[1], -w[2]], offset);
    }
    best.best
}

/// Barycentric coordinates of the projection of `p` to the plane of a triangle, if it lies inside, and
/// the way from it to `p`.
///
/// With the longest edge as base and the height over it as second direction, in this order, the
/// result is that of a triangle whose corners are off by rounding errors, however thin it is. Ratios
/// of areas are not: on a needle they err by the inverse of its thinness.
#[inline]
fn projection(p: &World3, x: &[World3; 3]) -> Option<([f64; 3], World3)> {
    let lengths = [x[1] - x[0], x[2] - x[1], x[0] - x[2]].map(|e| e.norm_squared());
    let i = if lengths[0] >= lengths[1] && lengths[0] >= lengths[2] {
        0
    } else if lengths[1] >= lengths[2] {
        1
    } else {
        2
    };
    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
    let base = x[j] - x[i];
    let across = |d: World3| {
        let along = d.dot(&base) / lengths[i];
        (along, d - base * along)
    };
    let (foot, height) = across(x[k] - x[i]);
    let (along, rest) = across(p - x[i]);
    // No number if the triangle has no area, and then not inside.
    let up = rest.dot(&height) / height.norm_squared();
    let mut w = [0.0; 3];
    w[k] = up;
    w[j] = along - up * foot;
    w[i] = 1.0 - w[j] - w[k];
    w.iter().all(|&w| w > 0.0).then(|| (w, rest - height * up))
}

/// The closest points of edges `x[0], x[1]` and `x[2], x[3]` (m).
pub fn edge_edge(x: &[World3; 4]) -> Closest<EdgeEdgeFeature> {
    use EdgeEdgeFeature::{EndInside, Ends, Inside, InsideEnd};
    let [a, b, c, d] = *x;
    let differences = [a - c, a - d, b - c, b - d];
    let weights = |s: f64, t: f64| [1.0 - s, s, t - 1.0, -t];
    let of_end = |i: usize| {
        let (t, offset) = segment(&x[i], &c, &d);
        let feature = end_of(t).map_or(EndInside(i), |end| Ends(i, end));
        (feature, weights(i as f64, t), offset)
    };
    let (feature, w, offset) = of_end(0);
    let first = Closest { feature, weights: w, offset, squared: offset.norm_squared() };
    let mut best = Best::of(&differences, first);
    let (feature, w, offset) = of_end(1);
    best.take(feature, w, offset);
    for j in 0..2 {
        let (s, offset) = segment(&x[2 + j], &a, &b);
        let feature = end_of(s).map_or(InsideEnd(j), |end| Ends(end, j));
        best.take(feature, weights(s, j as f64), -offset);
    }
    if let Some((s, t)) = crossing(&a, &b, &c, &d) {
        let offset = (a - c) * (1.0 - s) + (b - c) * s - (d - c) * t;
        best.take(Inside, weights(s, t), offset);
    }
    best.best
}

fn end_of(s: f64) -> Option<usize> {
    if s == 0.0 {
        Some(0)
    } else if s == 1.0 {
        Some(1)
    } else {
        None
    }
}

/// Parameters of the closest points of two lines, if they lie inside both edges. As [`projection`], and
/// for the same reason: first away from the longer edge, then along it.
#[inline]
fn crossing(a: &World3, b: &World3, c: &World3, d: &World3) -> Option<(f64, f64)> {
    let (u, v) = (b - a, d - c);
    let (s, t) = if u.norm_squared() <= v.norm_squared() {
        nearest_on_lines(a, &u, c, &v)
    } else {
        let (t, s) = nearest_on_lines(c, &v, a, &u);
        (s, t)
    };
    (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0).then_some((s, t))
}

/// Parameters of the closest points of the lines a + s u and c + t v, where v is the longer one. No
/// numbers if they are parallel.
#[inline]
fn nearest_on_lines(a: &World3, u: &World3, c: &World3, v: &World3) -> (f64, f64) {
    let length_squared = v.norm_squared();
    let across = |d: &World3| d - v * (d.dot(v) / length_squared);
    let (start, direction) = (a - c, across(u));
    let s = -across(&start).dot(&direction) / direction.norm_squared();
    (s, (start + u * s).dot(v) / length_squared)
}
