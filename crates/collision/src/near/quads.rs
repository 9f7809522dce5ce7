//! Four triangles at a time, and which of them may come near a fifth.
//!
//! Positions are in single precision, in units in which all of them are between −1 and 1; what they lose
//! by it is added to the room between things.

use crate::pairs::Body;
use crate::{Aabb, Bvh};
use mesh_core::{World3, par};

/// A number for each of four triangles.
type Four = [f32; 4];

/// More than the rounding errors of a gap between points whose coordinates are at most 1: those of the
/// points are 2⁻²⁴ and less, and those of the some ten operations on them not much larger.
pub(super) const SLACK: f32 = 4e-6;
/// More than the rounding errors of a length by its size (1).
pub(super) const RELATIVE: f32 = 1e-5;
/// The key of a vertex that is common to nothing, in the first and in the second triangle.
const NO_KEY: [u32; 2] = [u32::MAX, u32::MAX - 1];

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
    lo: [Four; 3],
    hi: [Four; 3],
    corners: [[Four; 3]; 3],
    /// In the plane of the triangle out of each edge, and its normal: unit vectors, or zero.
    axes: [[Four; 3]; 4],
    /// How far the triangle reaches along each.
    ends: [Four; 4],
    motion: [Four; 3],
    /// Radius, and by what the corners' motions differ from their mean at most.
    room: Four,
    keys: [[u32; 4]; 3],
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
        let zero = [0.0; 4];
        let mut quad = Quad {
            lo: [[f32::INFINITY; 4]; 3],
            hi: [[f32::NEG_INFINITY; 4]; 3],
            corners: [[zero; 3]; 3],
            axes: [[zero; 3]; 4],
            ends: [zero; 4],
            motion: [zero; 3],
            room: zero,
            keys: [[NO_KEY[0]; 4]; 3],
            triangles: [u32::MAX; 4],
        };
        for (l, &t) in triangles.iter().enumerate() {
            quad.set(l, t, body, frame, &is_covered);
        }
        quad
    }

    fn set(
        &mut self,
        l: usize,
        t: u32,
        body: Body<'_>,
        frame: &Frame,
        is_covered: impl Fn(u32) -> bool + Sync,
    ) {
        let vertices = body.surface().triangles()[t as usize];
        let scaled = |x: &World3| (x - frame.origin) * frame.scale;
        let x = vertices.map(|v| scaled(&body.x_t0()[v as usize]));
        let end = vertices.map(|v| scaled(&body.x_t1()[v as usize]));
        let moved: [World3; 3] = std::array::from_fn(|c| end[c] - x[c]);
        let motion = (moved[0] + moved[1] + moved[2]) / 3.0;
        let spread = moved.map(|m| (m - motion).norm_squared()).into_iter().fold(0.0, f64::max);
        let radius = body.radius_of(&vertices) * frame.scale;
        let normal = (x[1] - x[0]).cross(&(x[2] - x[0]));
        let axes: [World3; 4] = std::array::from_fn(|k| {
            let axis = if k < 3 { (x[(k + 1) % 3] - x[k]).cross(&normal) } else { normal };
            let length = axis.norm();
            if length > 0.0 { axis / length } else { World3::zeros() }
        });
        let around = Aabb::around(x.iter().chain(&end));
        for k in 0..3 {
            self.lo[k][l] = (around.lo[k] - radius) as f32 - SLACK;
            self.hi[k][l] = (around.hi[k] + radius) as f32 + SLACK;
            self.motion[k][l] = motion[k] as f32;
            for c in 0..3 {
                self.corners[c][k][l] = x[c][k] as f32;
            }
            for c in 0..4 {
                self.axes[c][k][l] = axes[c][k] as f32;
            }
            let v = vertices[k];
            self.keys[k][l] = if is_covered(v) { v } else { NO_KEY[0] };
        }
        for c in 0..4 {
            let reach = x.map(|x| axes[c].dot(&x));
            self.ends[c][l] = reach[0].max(reach[1]).max(reach[2]) as f32;
        }
        self.room[l] = (radius + spread.sqrt()) as f32;
        self.triangles[l] = t;
    }

    /// Which triangles of `other` may come near triangle `i` of this: those whose swept boxes overlap its
    /// own, and which no axis separates by more than radii and relative motion. Those with a covered
    /// vertex in common are left out. A comparison with what is no number separates nothing.
    #[inline]
    pub(super) fn may_meet(&self, i: usize, other: &Quad) -> [bool; 4] {
        let mut apart = [false; 4];
        for k in 0..3 {
            let (lo, hi) = (self.lo[k][i], self.hi[k][i]);
            for l in 0..4 {
                apart[l] |= (lo > other.hi[k][l]) | (other.lo[k][l] > hi);
            }
        }
        if apart == [true; 4] {
            return [false; 4];
        }
        for c in 0..3 {
            let key = self.keys[c][i];
            let key = if key == NO_KEY[0] { NO_KEY[1] } else { key };
            for d in 0..3 {
                for l in 0..4 {
                    apart[l] |= key == other.keys[d][l];
                }
            }
        }
        if apart == [true; 4] {
            return [false; 4];
        }
        let mut squared = [0.0; 4];
        for k in 0..3 {
            let motion = self.motion[k][i];
            for l in 0..4 {
                let m = other.motion[k][l] - motion;
                squared[l] += m * m;
            }
        }
        let reach: Four = std::array::from_fn(|l| {
            (self.room[i] + other.room[l] + squared[l].sqrt()) * (1.0 + RELATIVE) + SLACK
        });
        let of = |a: &[Four; 3]| [a[0][i], a[1][i], a[2][i]].map(|x| [x; 4]);
        let corners = [of(&self.corners[0]), of(&self.corners[1]), of(&self.corners[2])];
        for c in 0..4 {
            let own = span(&of(&self.axes[c]), &other.corners);
            let theirs = span(&other.axes[c], &corners);
            for l in 0..4 {
                apart[l] |= own[0][l] - self.ends[c][i] > reach[l];
                apart[l] |= theirs[0][l] - other.ends[c][l] > reach[l];
                // The fourth axis is the normal, of which both sides count.
                apart[l] |= (c == 3) & (self.ends[c][i] - own[1][l] > reach[l]);
                apart[l] |= (c == 3) & (other.ends[c][l] - theirs[1][l] > reach[l]);
            }
        }
        apart.map(|apart| !apart)
    }
}

/// The least and the greatest product of an axis with three corners.
#[inline]
fn span(axis: &[Four; 3], corners: &[[Four; 3]; 3]) -> [Four; 2] {
    let dot = |x: &[Four; 3]| -> Four {
        std::array::from_fn(|l| axis[0][l] * x[0][l] + axis[1][l] * x[1][l] + axis[2][l] * x[2][l])
    };
    let [p, q, r] = [dot(&corners[0]), dot(&corners[1]), dot(&corners[2])];
    // Not by `f32::min`, which does more about what is no number; such a corner is lost here only if its
    // triangle is beyond help anyway.
    let lower = |a: f32, b: f32| if a < b { a } else { b };
    let upper = |a: f32, b: f32| if a > b { a } else { b };
    [
        std::array::from_fn(|l| lower(lower(p[l], q[l]), r[l])),
        std::array::from_fn(|l| upper(upper(p[l], q[l]), r[l])),
    ]
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
