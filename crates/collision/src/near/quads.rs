//! Four triangles at a time, and which of them may come near a fifth.
//!
//! Positions are in single precision, in units in which all of them are between −1 and 1; what they lose
//! by it is added to the room between things.

use super::lanes::{
    Row, Vector, bits, cross, dot, lower, mark, minus, plus, reach, row, unit, upper, widened,
};
use crate::pairs::Body;
use crate::{Aabb, Bvh};
use mesh_core::{World3, par};

/// A number for each of four triangles, and a vector.
type Four = Row<4>;
type Fours = Vector<4>;

/// Units of length in which all positions are from −1 to 1.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    origin: World3,
    scale: f64,
}

impl Frame {
    pub(super) fn of(bounds: &Aabb) -> Frame {
        let origin = World3::from(std::array::from_fn::<f64, 3, _>(|k| {
            0.5 * bounds.lo[k] + 0.5 * bounds.hi[k]
        }));
        let size = (0..3).map(|k| 0.5 * bounds.hi[k] - 0.5 * bounds.lo[k]).fold(0.0, f64::max);
        // A bit more than needed, as the origin is rounded.
        let scale = if size > 0.0 { 0.999 / size } else { 1.0 };
        Frame { origin, scale }
    }
}

/// Four triangles that are next to each other in the tree.
#[derive(Clone)]
pub(super) struct Quad {
    lo: Fours,
    hi: Fours,
    corners: [Fours; 3],
    /// In the plane of the triangle out of each edge, and its normal: unit vectors, or zero.
    axes: [Fours; 4],
    /// How far the triangle reaches along each.
    reaches: [Four; 4],
    /// Where it begins along the normal.
    low: Four,
    motion: Fours,
    /// Radius, and by what the corners' motions differ from their mean at most.
    room: Four,
    /// The corners of each triangle. Those that are not covered have numbers from the top that differ for
    /// each triangle: with no more than 2³² corners and vertices in all they are no vertices.
    keys: [[u32; 3]; 4],
    pub(super) triangles: [u32; 4],
}

impl Quad {
    /// Triangles of a body, up to four. Those with a vertex in common that is covered are left
    /// out when they are compared.
    pub(super) fn new(
        body: Body<'_>,
        frame: &Frame,
        triangles: &[u32],
        is_covered: impl Fn(u32) -> bool + Sync,
    ) -> Quad {
        let zero = [[0.0; 4]; 3];
        let (mut corners, mut ends, mut radius) = ([zero; 3], [zero; 3], [0.0; 4]);
        let (mut keys, mut list) = ([[u32::MAX; 3]; 4], [u32::MAX; 4]);
        for (l, &t) in triangles.iter().enumerate() {
            let vertices = body.surface().triangles()[t as usize];
            for (c, v) in vertices.into_iter().enumerate() {
                let x = (body.x_t0()[v as usize] - frame.origin) * frame.scale;
                let end = (body.x_t1()[v as usize] - frame.origin) * frame.scale;
                for k in 0..3 {
                    corners[c][k][l] = x[k] as f32;
                    ends[c][k][l] = end[k] as f32;
                }
                keys[l][c] = if is_covered(v) { v } else { u32::MAX - (3 * t + c as u32) };
            }
            radius[l] = (body.radius_of(&vertices) * frame.scale) as f32;
            list[l] = t;
        }
        let (mut lo, mut hi) = ([[f32::INFINITY; 4]; 3], [[f32::NEG_INFINITY; 4]; 3]);
        for k in 0..3 {
            let row = |x: &[Fours; 3]| [x[0][k], x[1][k], x[2][k]];
            let ([a, b, c], [d, e, f]) = (row(&corners), row(&ends));
            let least = lower(&lower(&lower(&a, &b), &lower(&c, &d)), &lower(&e, &f));
            let most = upper(&upper(&upper(&a, &b), &upper(&c, &d)), &upper(&e, &f));
            for l in 0..triangles.len() {
                [lo[k][l], hi[k][l]] = widened(least[l], most[l], radius[l]);
            }
        }
        let moved = [
            minus(&ends[0], &corners[0]),
            minus(&ends[1], &corners[1]),
            minus(&ends[2], &corners[2]),
        ];
        let third = [1.0 / 3.0; 4];
        let motion =
            plus(&plus(&plus(&zero, &third, &moved[0]), &third, &moved[1]), &third, &moved[2]);
        let mut spread = [0.0; 4];
        for m in &moved {
            let off = minus(m, &motion);
            spread = upper(&spread, &dot(&off, &off));
        }
        let sides = [
            minus(&corners[1], &corners[0]),
            minus(&corners[2], &corners[1]),
            minus(&corners[0], &corners[2]),
        ];
        let normal = unit(&cross(&sides[0], &sides[1]));
        let out = |c: usize| unit(&cross(&sides[c], &normal));
        let axes = [out(0), out(1), out(2), normal];
        let reaches = axes.map(|axis| span(&axis, &corners)[1]);
        Quad {
            lo,
            hi,
            corners,
            axes,
            reaches,
            low: span(&normal, &corners)[0],
            motion,
            room: row(|l| radius[l] + spread[l].sqrt()),
            keys,
            triangles: list,
        }
    }

    /// Bit 4 i + j: whether the boxes of triangle `i` of this and triangle `j` of `other` overlap. What is
    /// no number separates nothing.
    #[inline]
    pub(super) fn overlaps(&self, other: &Quad) -> u32 {
        // All without a branch, which would go wrong most often.
        let mut hits = [0; 4];
        for i in 0..4 {
            let mut gap = [f32::NEG_INFINITY; 4];
            for k in 0..3 {
                let (lo, hi) = ([self.lo[k][i]; 4], [self.hi[k][i]; 4]);
                gap = upper(&row(|l| lo[l] - other.hi[k][l]), &gap);
                gap = upper(&row(|l| other.lo[k][l] - hi[l]), &gap);
            }
            for l in 0..4 {
                hits[l] |= if gap[l] > 0.0 { 0 } else { 1u32 << (4 * i + l) };
            }
        }
        hits[0] | hits[1] | hits[2] | hits[3]
    }

    /// Those of the bits `hits` of two quads of a body that stand for triangles without a covered vertex
    /// in common.
    #[inline]
    pub(super) fn without_common(&self, other: &Quad, hits: u32) -> u32 {
        let (mut apart, mut rest) = (0, hits);
        while rest != 0 {
            let bit = rest.trailing_zeros();
            let [a, b, c] = self.keys[bit as usize / 4];
            let [d, e, f] = other.keys[bit as usize % 4];
            let is_common = (a == d) | (a == e) | (a == f) | (b == d) | (b == e) | (b == f);
            let is_common = is_common | (c == d) | (c == e) | (c == f);
            apart |= u32::from(!is_common) << bit;
            rest &= rest - 1;
        }
        apart
    }

    /// For each triangle of `other`, a bit: whether it may come near triangle `i` of this, because none
    /// of their axes separates them by more than radii and relative motion.
    pub(super) fn may_meet(&self, i: usize, other: &Quad) -> u32 {
        let of = |a: &Fours| [[a[0][i]; 4], [a[1][i]; 4], [a[2][i]; 4]];
        let way = minus(&other.motion, &of(&self.motion));
        let reach = reach(&[self.room[i]; 4], &other.room, &dot(&way, &way));
        let corners = [of(&self.corners[0]), of(&self.corners[1]), of(&self.corners[2])];
        let mut apart = [0; 4];
        for c in 0..3 {
            let own = span(&of(&self.axes[c]), &other.corners)[0];
            let theirs = span(&other.axes[c], &corners)[0];
            let reaches = self.reaches[c][i];
            mark(&mut apart, |l| own[l] - reaches > reach[l]);
            mark(&mut apart, |l| theirs[l] - other.reaches[c][l] > reach[l]);
        }
        // The normals, of which both sides count.
        let own = span(&of(&self.axes[3]), &other.corners);
        let theirs = span(&other.axes[3], &corners);
        let (low, high) = (self.low[i], self.reaches[3][i]);
        mark(&mut apart, |l| own[0][l] - high > reach[l]);
        mark(&mut apart, |l| low - own[1][l] > reach[l]);
        mark(&mut apart, |l| theirs[0][l] - other.reaches[3][l] > reach[l]);
        mark(&mut apart, |l| other.low[l] - theirs[1][l] > reach[l]);
        !bits(&apart) & 0b1111
    }
}

/// The least and the greatest product of an axis with three corners.
#[inline(always)]
fn span(axis: &Fours, corners: &[Fours; 3]) -> [Four; 2] {
    let [p, q, r] = [dot(axis, &corners[0]), dot(axis, &corners[1]), dot(axis, &corners[2])];
    [lower(&lower(&p, &q), &r), upper(&upper(&p, &q), &r)]
}

/// The groups of a tree that are needed, as quads.
pub(super) struct Quads {
    /// Where the quad of each group is.
    place: Vec<u32>,
    quads: Vec<Quad>,
}

impl Quads {
    pub(super) fn new(
        body: Body<'_>,
        tree: &Bvh,
        groups: &[u32],
        frame: &Frame,
        is_covered: impl Fn(u32) -> bool + Sync,
    ) -> Quads {
        let mut place = vec![u32::MAX; tree.n_groups()];
        (0..).zip(groups).for_each(|(k, &group)| place[group as usize] = k);
        let mut quads = vec![Quad::new(body, frame, &[], &is_covered); groups.len()];
        par::fill(&mut quads, |k| {
            Quad::new(body, frame, tree.elements_of(groups[k] as usize), &is_covered)
        });
        Quads { place, quads }
    }

    #[inline]
    pub(super) fn of(&self, group: u32) -> &Quad {
        &self.quads[self.place[group as usize] as usize]
    }
}
