//! The pairs of features that two triangles answer for, and which of them are certainly far from each
//! other: nearly all, even of triangles that are near.

use crate::pairs::{Body, Pair, PairKind};
use mesh_core::World3;

/// Calls `found` with the pairs of features that two triangles own ([`Surface`](crate::Surface)) and
/// that are not certainly further than `reach` (m) from each other at the start; of triangles of the same
/// body, none with a vertex in common.
#[inline]
pub(super) fn look(
    (first, a): (Body<'_>, u32),
    (second, b): (Body<'_>, u32),
    is_own: bool,
    reach: f64,
    mut found: impl FnMut(Pair),
) {
    let (s, t) = (first.surface(), second.surface());
    let (p, q) = (s.triangles()[a as usize], t.triangles()[b as usize]);
    let (x, y) = (s.corners(first.x_t0(), a), t.corners(second.x_t0(), b));
    let corner = |v: u32| Pair { kind: PairKind::VertexTriangle, a: v, b };
    let other = |v: u32| match is_own {
        true => Pair { kind: PairKind::VertexTriangle, a: v, b: a },
        false => Pair { kind: PairKind::TriangleVertex, a, b: v },
    };
    // One loop over all that there is: loops in loops would end where no branch foresees it.
    let mut rest = owned(s.owned(a), t.owned(b), is_own.then_some([&p, &q]));
    while rest != 0 {
        let bit = rest.trailing_zeros() as usize;
        rest &= rest - 1;
        if bit < 9 {
            let (i, j) = (bit / 3, bit % 3);
            if Gap::between_edges(&[x[i], x[NEXT[i]], y[j], y[NEXT[j]]]).is_beyond(reach) {
                continue;
            }
            let (e, f) = (s.edges_of(a)[i], t.edges_of(b)[j]);
            let (e, f) = if is_own { (e.min(f), e.max(f)) } else { (e, f) };
            found(Pair { kind: PairKind::EdgeEdge, a: e, b: f });
        } else if bit < 12 {
            if !Gap::to_triangle(&[x[bit - 9], y[0], y[1], y[2]]).is_beyond(reach) {
                found(corner(p[bit - 9]));
            }
        } else if !Gap::to_triangle(&[y[bit - 12], x[0], x[1], x[2]]).is_beyond(reach) {
            found(other(q[bit - 12]));
        }
    }
}

const NEXT: [usize; 3] = [1, 2, 0];

/// The pairs of features that are owned by the first and by the second triangle, but for those with a
/// vertex in common, given the vertices of both if they can have one. Bit 3 i + j: edges `i` and `j`; bits
/// 9 + i and 12 + j: vertices `i` and `j` with the other triangle.
#[inline]
fn owned(first: u8, second: u8, of_one_body: Option<[&[u32; 3]; 2]>) -> u32 {
    let (own, theirs) = (u32::from(first), u32::from(second));
    // Bit j of row i: whether corner i of the first triangle is corner j of the second.
    let same = |i: usize| {
        let at =
            |[p, q]: [&[u32; 3]; 2]| (0..3).fold(0, |row, j| row | u32::from(p[i] == q[j]) << j);
        of_one_body.map_or(0, at)
    };
    let same = [same(0), same(1), same(2)];
    let mut all = 0;
    for i in 0..3 {
        let at_ends = same[i] | same[NEXT[i]];
        // Edge j ends in corners j and j + 1.
        let touched = at_ends | at_ends >> 1 | at_ends << 2;
        let is_owned = (own >> (3 + i) & 1).wrapping_neg();
        all |= (theirs >> 3 & !touched & 0b111 & is_owned) << (3 * i);
        all |= (own >> i & u32::from(same[i] == 0)) << (9 + i);
    }
    all | (theirs & !(same[0] | same[1] | same[2]) & 0b111) << 12
}

/// How far two features are apart along the line of points that are nearest if rounding does no harm,
/// which tells most often whether they are far: the distance itself, right for all elements, takes several
/// times longer.
pub(super) struct Gap {
    /// In units of the axis.
    size: f64,
    /// Square of the axis (m²), and more than rounding takes from it.
    squared: f64,
}

impl Gap {
    /// Of two edges, by their ends (m).
    #[inline]
    pub(super) fn between_edges(x: &[World3; 4]) -> Gap {
        let axis = from_edge(x);
        let [p, q, r, s] = x.map(|y| axis.dot(&(y - x[0])));
        Gap::new(p.min(q) - r.max(s), &axis)
    }

    /// Of a vertex and a triangle (m).
    #[inline]
    pub(super) fn to_triangle(x: &[World3; 4]) -> Gap {
        let axis = from_triangle(x);
        let [p, q, r, s] = x.map(|y| axis.dot(&(y - x[0])));
        Gap::new(p - q.max(r).max(s), &axis)
    }

    #[inline]
    fn new(size: f64, axis: &World3) -> Gap {
        Gap { size, squared: axis.norm_squared() * (1.0 + 1e-6) }
    }

    /// Whether the features are certainly further from each other than `reach` (m).
    #[inline]
    pub(super) fn is_beyond(&self, reach: f64) -> bool {
        self.size > 0.0 && self.size * self.size > reach * reach * self.squared
    }
}

/// The way to the first of two edges from the second, roughly: as Ericson2005 §5.1.9.
#[inline]
fn from_edge(x: &[World3; 4]) -> World3 {
    let (d, e, r) = (x[1] - x[0], x[3] - x[2], x[0] - x[2]);
    let (dd, de, ee) = (d.norm_squared(), d.dot(&e), e.norm_squared());
    let (dr, er) = (d.dot(&r), e.dot(&r));
    let s = ((de * er - dr * ee) / (dd * ee - de * de)).clamp(0.0, 1.0);
    let t = ((de * s + er) / ee).clamp(0.0, 1.0);
    let s = ((de * t - dr) / dd).clamp(0.0, 1.0);
    r + d * s - e * t
}

/// The way to a vertex from a triangle, roughly: from the plane, or from the edge that the vertex is
/// beyond.
#[inline]
fn from_triangle(x: &[World3; 4]) -> World3 {
    let (e, f, r) = (x[2] - x[1], x[3] - x[1], x[0] - x[1]);
    let (ee, ef, ff) = (e.norm_squared(), e.dot(&f), f.norm_squared());
    let (er, fr) = (e.dot(&r), f.dot(&r));
    let size = ee * ff - ef * ef;
    // Weights of the second and the third corner, times the size.
    let (v, w) = (ff * er - ef * fr, ee * fr - ef * er);
    let u = size - v - w;
    // The nearest point of the edge across the corner with the least weight, if that is negative.
    let beyond = |from: &World3, to: &World3| {
        let (side, way) = (to - from, x[0] - from);
        way - side * (way.dot(&side) / side.norm_squared()).clamp(0.0, 1.0)
    };
    if u.min(v).min(w) >= 0.0 {
        r - (e * v + f * w) / size
    } else if u <= v && u <= w {
        beyond(&x[2], &x[3])
    } else if v <= w {
        beyond(&x[1], &x[3])
    } else {
        beyond(&x[1], &x[2])
    }
}
