//! What can be drawn: surfaces of triangles and line segments.

use super::{RenderError, Rgb};

/// One part of a picture. Layers share one depth: nearer parts hide farther ones whatever their
/// order.
#[derive(Clone, Copy, Debug)]
pub enum Layer<'a> {
    /// Triangles.
    Surface(Surface<'a>),
    /// Line segments.
    Lines(Lines<'a>),
}

/// A surface of triangles, seen and lit from both sides.
#[derive(Clone, Copy, Debug)]
pub struct Surface<'a> {
    /// Positions; those that are not finite are left out with their triangles (m).
    pub points: &'a [[f64; 3]],
    /// Three points each; counter-clockwise where the front is seen.
    pub triangles: &'a [[u32; 3]],
    /// Its colours.
    pub paint: Paint<'a>,
    /// Whether the edges of the triangles are drawn, where not hidden.
    pub wireframe: bool,
}

impl<'a> Surface<'a> {
    /// A surface in the house colours of cloth, without wireframe.
    pub fn new(points: &'a [[f64; 3]], triangles: &'a [[u32; 3]]) -> Self {
        Self { points, triangles, paint: Paint::CLOTH, wireframe: false }
    }

    /// Checks the numbers of colours and the points named by the triangles; `layer` is for the
    /// message.
    pub(super) fn check(&self, layer: usize) -> Result<(), RenderError> {
        let n_points = self.points.len();
        for (triangle, corners) in self.triangles.iter().enumerate() {
            if let Some(&point) = corners.iter().find(|&&i| i as usize >= n_points) {
                return Err(RenderError::Index { layer, triangle, point, n_points });
            }
        }
        let (what, n_colours, n_wanted) = match self.paint {
            Paint::Sides { .. } => return Ok(()),
            Paint::Triangles(colours) => ("triangles", colours.len(), self.triangles.len()),
            Paint::Points(colours) => ("points", colours.len(), n_points),
        };
        if n_colours == n_wanted {
            return Ok(());
        }
        Err(RenderError::Paint { layer, what, n_colours, n_wanted })
    }
}

/// The colours of a surface before light falls on it.
#[derive(Clone, Copy, Debug)]
pub enum Paint<'a> {
    /// One colour for each side.
    Sides {
        /// Colour of the side on which the triangles run counter-clockwise.
        front: Rgb,
        /// Colour of the other side.
        back: Rgb,
    },
    /// A colour for each triangle, on both sides.
    Triangles(&'a [Rgb]),
    /// A colour for each point, on both sides, mixed inside the triangles.
    Points(&'a [Rgb]),
}

impl Paint<'_> {
    /// The house colours of cloth: a slate blue, and a warm sand on the back.
    pub const CLOTH: Self = Self::Sides { front: [88, 131, 165], back: [217, 182, 138] };
    /// A pale grey for obstacles and floors, on both sides.
    pub const OBSTACLE: Self = Self::both([198, 196, 192]);

    /// One colour on both sides.
    pub const fn both(colour: Rgb) -> Self {
        Self::Sides { front: colour, back: colour }
    }
}

/// Straight segments of constant width in the picture, hidden where something is nearer; unlit.
#[derive(Clone, Copy, Debug)]
pub struct Lines<'a> {
    /// The two ends of each segment; segments with an end that is not finite are left out (m).
    pub segments: &'a [[[f64; 3]; 2]],
    /// Their colour.
    pub colour: Rgb,
    /// Width in the picture, kept between 0.5 and 64 (px).
    pub width_px: f64,
}

impl<'a> Lines<'a> {
    /// Dark lines of 1.5 pixels.
    pub fn new(segments: &'a [[[f64; 3]; 2]]) -> Self {
        Self { segments, colour: [48, 52, 60], width_px: 1.5 }
    }
}
