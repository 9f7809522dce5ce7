//! Intersection contours: the lines along which surfaces pass through themselves and each other.
//!
//! Two triangles that cross do so along a segment. Its ends are crossings, each of an edge of one with
//! the other triangle, or a vertex that the two share. Segments join at crossings into contours:
//! closed ones, ones that end at a boundary of the mesh, and ones that end at a vertex. Unlike depths
//! or sides, all this is defined on any tangle of open surfaces, and a tangle is gone exactly if the
//! contours have no length. Their length shrinks along its negative gradient (Volino2006), see
//! [`Contours::gradient`] and [`Contours::pushes`].
//!
//! Several bodies are one surface here: see [`Surface::joined`].

mod assemble;
mod gradient;

pub use gradient::Push;

use crate::intersect::{EdgeTriangle, within};
use crate::{Bvh, Surface};
use mesh_core::World3;

/// The crossing of an edge and a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossingPoint {
    /// The edge.
    pub edge: u32,
    /// The triangle.
    pub triangle: u32,
    /// Where on the edge, from its lower vertex at 0 to the other at 1 (1).
    pub along: f64,
    /// Where on the triangle: barycentric coordinates (1).
    pub weights: [f64; 3],
    /// The place (m).
    pub x: World3,
}

/// What a segment ends at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum End {
    /// A crossing, by its index in [`Contours::crossings`].
    Crossing(u32),
    /// A vertex that both triangles share.
    Vertex(u32),
}

/// The part of a contour in two triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The triangles, the lower one first.
    pub triangles: [u32; 2],
    /// Its ends.
    pub ends: [End; 2],
    /// Its length (m).
    pub length: f64,
}

/// A chain of segments.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    /// Indices of the segments, in order.
    pub segments: Vec<u32>,
    /// What they pass through: one more than segments, or as many if closed.
    pub ends: Vec<End>,
    /// True if the last segment leads back to the first end.
    pub is_closed: bool,
    /// Total length (m).
    pub length: f64,
}

/// All intersection contours of a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contours {
    /// All crossings, in ascending order of edge and triangle.
    pub crossings: Vec<CrossingPoint>,
    /// All segments, in ascending order of triangles.
    pub segments: Vec<Segment>,
    /// All chains of segments.
    pub contours: Vec<Contour>,
    /// Number of pairs of triangles with crossings that do not make a segment, because something
    /// touches instead of crossing: contours have gaps there.
    pub n_gaps: usize,
}

impl Contours {
    /// Finds the contours of a surface at positions `x` (m); `tree` is over its triangles there
    /// ([`Surface::tree`]). Crossings for which `keep(edge, triangle)` is false are left out, such as
    /// those of obstacles among themselves.
    pub fn find(
        surface: &Surface,
        x: &[World3],
        tree: &Bvh,
        keep: impl Fn(u32, u32) -> bool,
    ) -> Contours {
        let mut crossings = within(surface, x, tree);
        crossings.retain(|c| keep(c.edge, c.triangle));
        let crossings: Vec<_> = crossings.iter().map(|c| locate(surface, x, *c)).collect();
        assemble::assemble(surface, x, crossings)
    }

    /// Total length of all segments (m).
    pub fn length(&self) -> f64 {
        self.segments.iter().fold(0.0, |sum, s| sum + s.length)
    }

    /// True if nothing crosses.
    pub fn is_empty(&self) -> bool {
        self.crossings.is_empty()
    }

    /// The place of a segment's end (m) at positions `x` (m), those of the search.
    #[inline]
    pub fn place(&self, x: &[World3], end: End) -> World3 {
        match end {
            End::Crossing(i) => self.crossings[i as usize].x,
            End::Vertex(v) => x[v as usize],
        }
    }
}

/// The parameters of a proper crossing: ratios of the volumes whose signs made it one.
fn locate(surface: &Surface, x: &[World3], crossing: EdgeTriangle) -> CrossingPoint {
    let EdgeTriangle { edge, triangle } = crossing;
    let ([p, q], [a, b, c]) = (surface.ends(x, edge), surface.corners(x, triangle));
    let volumes = crate::intersect::volumes(&p, &q, &[a, b, c]);
    let along = volumes.ends[0] / (volumes.ends[0] - volumes.ends[1]);
    let total: f64 = volumes.sides.iter().sum();
    // Side k is that of the edge from corner k to corner k + 1, across from corner k + 2.
    let weights = std::array::from_fn(|k| volumes.sides[(k + 1) % 3] / total);
    CrossingPoint { edge, triangle, along, weights, x: p + (q - p) * along }
}
