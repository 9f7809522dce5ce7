//! Pairs of triangles with a common vertex: most of the pairs whose boxes overlap, and of almost none of
//! them the features that have no vertex in common are near each other.
//!
//! No axis separates such triangles, but what is left of them without what they share can be separated.
//! Let p be the vertex, and the triangles around it be p u v and p U V.
//!
//! - If they have only p in common: of two features without a common vertex, one is without p, so that
//!   it is a part of the edge u v or of U V. It is enough that u v is far from the triangle p U V, and
//!   U V from p u v.
//! - If they follow upon each other, v = U = q, with a = u and b = V: the pairs are a and the triangle
//!   p q b, b and p q a, the edges p a and q b, and q a and p b.
//!
//! For each of them a few axes are tried that separate them where the surface is flat. The tests go
//! around the vertex, all triangles at a time, in single precision and in units of the longest edge; what
//! is lost by that is added to the room.

use super::lanes::{self, bits, dot, lower, mark, minus, plus, reach, rejected, unit, upper};
use crate::pairs::Body;
use crate::rings;
use mesh_core::{World3, par};

/// A number for each triangle around a vertex.
const LANES: usize = rings::MOST;
type Row = lanes::Row<LANES>;
/// Twice around, to look ahead by any number of triangles.
type Twice = [f32; 2 * LANES];

/// All pairs of triangles around vertices with a ring whose features without a common vertex may be
/// near. Of two that have an edge in common, and then belong to two vertices, none is given twice.
pub(super) fn pairs(body: Body<'_>) -> Vec<[u32; 2]> {
    par::collect(body.surface().n_vertices(), |p, pairs| around(body, p, pairs))
}

/// Whether the pairs around a vertex are among [`pairs`].
pub(super) fn covers(body: Body<'_>, p: u32) -> bool {
    !body.surface().rings().of(p as usize).is_empty()
}

fn around(body: Body<'_>, p: usize, pairs: &mut Vec<[u32; 2]>) {
    let rings = body.surface().rings();
    let (ring, triangles) = (rings.of(p), rings.triangles_of(p));
    let n = triangles.len();
    if n < 2 || !body.has_awake(ring) && !body.has_awake(&[p as u32]) {
        return;
    }
    let is_closed = ring[0] == ring[n];
    let fan = Fan::new(body, p, ring);
    // Of each triangle, bits of those ahead that its outer edge is far from.
    let mut far = [0u32; LANES];
    for ahead in if is_closed { 2..n - 1 } else { 1..n } {
        let clear = fan.outer_edges_far(ahead);
        for i in 0..n {
            far[i] |= (clear >> i & 1) << ((i + ahead) % n);
        }
    }
    for i in 0..n {
        for j in i + 2..n {
            let follow = is_closed && i == 0 && j == n - 1;
            if !follow && (far[i] >> j & far[j] >> i & 1) == 0 {
                pairs.push([triangles[i], triangles[j]]);
            }
        }
    }
    let clear = fan.followers_far();
    for i in 0..if is_closed { n } else { n - 1 } {
        let q = ring[i + 1];
        let is_mine = (p as u32) < q || !covers(body, q);
        if is_mine && clear >> i & 1 == 0 {
            pairs.push([triangles[i], triangles[(i + 1) % n]]);
        }
    }
}

/// The triangles around a vertex, which is the origin.
struct Fan {
    /// Their first and second other corners.
    spokes: [[Twice; 3]; 2],
    /// How these move against the vertex.
    motions: [[Twice; 3]; 2],
    /// Largest radius, of all corners and of the outer edge.
    radius: Twice,
    outer_radius: Twice,
    /// From the vertex to the nearest point of the outer edge, and how far all of this edge is along it.
    outwards: [Twice; 3],
    height: Twice,
    /// In the plane of the triangle across each spoke, towards the other one.
    inwards: [[Twice; 3]; 2],
}

impl Fan {
    fn new(body: Body<'_>, p: usize, ring: &[u32]) -> Fan {
        let n = ring.len() - 1;
        let zero = [0.0; 2 * LANES];
        let mut fan = Fan {
            spokes: [[zero; 3]; 2],
            motions: [[zero; 3]; 2],
            radius: zero,
            outer_radius: zero,
            outwards: [zero; 3],
            height: zero,
            inwards: [[zero; 3]; 2],
        };
        let (start, motion) = (body.x_t0()[p], body.motion(p));
        let mut spokes = [World3::zeros(); LANES + 1];
        let mut longest: f64 = 0.0;
        for (spoke, &r) in spokes.iter_mut().zip(ring) {
            *spoke = body.x_t0()[r as usize] - start;
            longest = longest.max(spoke.norm_squared());
        }
        let scale = 1.0 / longest.sqrt();
        let own = body.radius(p as u32);
        for (i, &r) in ring.iter().enumerate() {
            let spoke = spokes[i] * scale;
            let moved = (body.motion(r as usize) - motion) * scale;
            let radius = (body.radius(r) * scale) as f32;
            // The first corner of one triangle, and the second of that before it.
            for (side, at) in [(0, i), (1, i + n - 1)] {
                let at = at % n;
                if (side == 0 && i == n) || (side == 1 && i == 0) {
                    continue;
                }
                for k in 0..3 {
                    fan.spokes[side][k][at] = spoke[k] as f32;
                    fan.motions[side][k][at] = moved[k] as f32;
                }
                fan.outer_radius[at] = fan.outer_radius[at].max(radius);
            }
        }
        for at in 0..LANES {
            fan.radius[at] = fan.outer_radius[at].max((own * scale) as f32);
        }
        let (u, v) = (fan.spoke(0, 0), fan.spoke(1, 0));
        let side = minus(&v, &u);
        let (along, squared) = (dot(&u, &side), dot(&side, &side));
        let share: Row = lanes::row(|l| 1.0 - above(1.0 - above(-along[l] / squared[l])));
        let outwards = unit(&plus(&u, &share, &side));
        let height = lower(&dot(&outwards, &u), &dot(&outwards, &v));
        let inwards = [unit(&rejected(&v, &u)), unit(&rejected(&u, &v))];
        fan.height[..LANES].copy_from_slice(&height);
        for k in 0..3 {
            fan.outwards[k][..LANES].copy_from_slice(&outwards[k]);
            fan.inwards[0][k][..LANES].copy_from_slice(&inwards[0][k]);
            fan.inwards[1][k][..LANES].copy_from_slice(&inwards[1][k]);
        }
        let all = fan.spokes.iter_mut().chain(&mut fan.motions).chain(&mut fan.inwards).flatten();
        let rows = [&mut fan.radius, &mut fan.outer_radius, &mut fan.height];
        for row in all.chain(&mut fan.outwards).chain(rows) {
            for i in 0..LANES {
                row[n + i] = row[i];
            }
        }
        fan
    }

    #[inline(always)]
    fn spoke(&self, side: usize, ahead: usize) -> [Row; 3] {
        vector(&self.spokes[side], ahead)
    }

    /// For each triangle, whether its outer edge is far from all of the one so far ahead.
    #[inline]
    fn outer_edges_far(&self, ahead: usize) -> u32 {
        let own = [self.spoke(0, 0), self.spoke(1, 0)];
        let other = [self.spoke(0, ahead), self.spoke(1, ahead)];
        let moved = [vector(&self.motions[0], 0), vector(&self.motions[1], 0)];
        let moves = [vector(&self.motions[0], ahead), vector(&self.motions[1], ahead)];
        let mut most = upper(&dot(&moved[0], &moved[0]), &dot(&moved[1], &moved[1]));
        for a in &moved {
            for b in &moves {
                let m = minus(a, b);
                most = upper(&most, &dot(&m, &m));
            }
        }
        let reach = reach(&row(&self.outer_radius, 0), &row(&self.radius, ahead), &most);
        let outwards = vector(&self.outwards, 0);
        let theirs = vector(&self.outwards, ahead);
        let beyond = upper(&dot(&outwards, &other[0]), &dot(&outwards, &other[1]));
        let behind = upper(&dot(&theirs, &own[0]), &dot(&theirs, &own[1]));
        let (height, low) = (row(&self.height, 0), row(&self.height, ahead));
        let mut far = [0; LANES];
        mark(&mut far, |l| height[l] - above(beyond[l]) > reach[l]);
        mark(&mut far, |l| -above(-low[l]) - behind[l] > reach[l]);
        for side in 0..2 {
            let inwards = vector(&self.inwards[side], ahead);
            let outside = upper(&dot(&inwards, &own[0]), &dot(&inwards, &own[1]));
            // Zero but for rounding, which is not small on a triangle without area.
            let least = lower(&dot(&inwards, &other[0]), &dot(&inwards, &other[1]));
            mark(&mut far, |l| -above(-least[l]) - outside[l] > reach[l]);
        }
        bits(&far)
    }

    /// For each triangle, whether all its features are far from those of the next one with which they
    /// have no vertex in common.
    #[inline]
    fn followers_far(&self) -> u32 {
        let (a, q, b) = (self.spoke(0, 0), self.spoke(1, 0), self.spoke(1, 1));
        let of = |side: usize, ahead: usize| vector(&self.motions[side], ahead);
        let (m, n, o) = (of(0, 0), of(1, 0), of(1, 1));
        let mut most = [0.0; LANES];
        for way in [m, n, o, minus(&m, &n), minus(&m, &o), minus(&n, &o)] {
            most = upper(&most, &dot(&way, &way));
        }
        let reach = reach(&row(&self.radius, 0), &row(&self.radius, 1), &most);
        // Across the common edge.
        let (to_a, to_b) = (vector(&self.inwards[1], 0), vector(&self.inwards[0], 1));
        let gap = |axis: &[Row; 3], near: &[Row; 3], far: [&[Row; 3]; 2]| -> Row {
            let (front, back) = (dot(axis, near), upper(&dot(axis, far[0]), &dot(axis, far[1])));
            lanes::row(|l| front[l] - above(back[l]))
        };
        let first = gap(&to_a, &a, [&q, &b]);
        let second = gap(&to_b, &b, [&q, &a]);
        // Edges p a and q b: across q b, or across p a.
        let edges = |ahead: usize, side: &[Row; 3], a: &[Row; 3], b: &[Row; 3]| -> Row {
            let back = dot(&vector(&self.outwards, ahead), a);
            let height = row(&self.height, ahead);
            let front = lower(&dot(side, &q), &dot(side, b));
            let behind = dot(side, a);
            upper(
                &lanes::row(|l| height[l] - above(back[l])),
                &lanes::row(|l| front[l] - above(behind[l])),
            )
        };
        let third = edges(1, &vector(&self.inwards[0], 0), &a, &b);
        let fourth = edges(0, &vector(&self.inwards[1], 1), &b, &a);
        // One by one: what is no number must not be lost in a minimum.
        let far = |gap: &Row| {
            let mut far = [0; LANES];
            mark(&mut far, |l| gap[l] > reach[l]);
            bits(&far)
        };
        far(&first) & far(&second) & far(&third) & far(&fourth)
    }
}

/// The greater of a number and zero.
#[inline(always)]
fn above(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}

#[inline(always)]
fn row(twice: &Twice, ahead: usize) -> Row {
    let mut row = [0.0; LANES];
    row.copy_from_slice(&twice[ahead..ahead + LANES]);
    row
}

#[inline(always)]
fn vector(twice: &[Twice; 3], ahead: usize) -> [Row; 3] {
    [row(&twice[0], ahead), row(&twice[1], ahead), row(&twice[2], ahead)]
}
