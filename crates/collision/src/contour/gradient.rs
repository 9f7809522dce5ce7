//! The gradient of the length of contours (Volino2006).
//!
//! A crossing P moves with the edge and with the triangle. Let E be the point of the edge and A the
//! point of the triangle, at fixed parameters, that are at P now; N the triangle's normal and e the
//! edge's direction. P stays on the edge and on the triangle's plane, so to first order
//!
//! ```text
//! dP = dE + e (N · (dA − dE)) / (N · e)
//! ```
//!
//! If g is the gradient of the length with respect to P, the sum of unit vectors along the segments
//! that end there, then the gradients with respect to E and A are
//!
//! ```text
//! h = g − N (e · g) / (N · e)     and     g − h
//! ```
//!
//! and the weights of E and A spread them over the vertices. This is exact while the same edges cross
//! the same triangles. It is Volino's vector G = h of a crossing, for one segment on boundaries and for
//! a vertex at which a segment ends just the unit vector.

use super::{Contours, End};
use crate::Surface;
use mesh_core::World3;

/// How an edge should move against a triangle that it crosses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Index of the crossing in [`Contours::crossings`].
    pub crossing: u32,
    /// The edge's two vertices and the triangle's three.
    pub vertices: [u32; 5],
    /// Weights of the vertices that give the point of the edge less that of the triangle (1).
    pub weights: [f64; 5],
    /// How fast the length grows as the edge moves against the triangle (1). Unbounded where the edge
    /// is nearly in the triangle's plane.
    pub gradient: World3,
}

impl Push {
    /// The displacement of the edge against the triangle that shortens the contour: against the
    /// gradient, of a length that grows with it and stays below `most` (m). Volino2006 proposes
    /// `most` of the size of a thickness and `typical` (1) of about 1, the gradient at which 0.7 of it
    /// is reached.
    #[inline]
    pub fn displacement(&self, most: f64, typical: f64) -> World3 {
        let slope = (self.gradient.norm_squared() + typical * typical).sqrt();
        self.gradient * (-most / slope)
    }
}

impl Contours {
    /// The gradient of [`Contours::length`] with respect to the positions of all vertices (1), at
    /// positions `x` (m), those of the search.
    pub fn gradient(&self, surface: &Surface, x: &[World3]) -> Vec<World3> {
        let mut gradient = vec![World3::zeros(); surface.n_vertices()];
        let at_crossings = self.at_ends(x, &mut gradient);
        for (i, g) in at_crossings.iter().enumerate() {
            let h = self.against(surface, x, i, g);
            let (vertices, weights) = self.stencil(surface, i);
            for k in 0..5 {
                // The weights of the triangle are negative.
                let part = if k < 2 { h } else { h - g };
                gradient[vertices[k] as usize] += part * weights[k];
            }
        }
        gradient
    }

    /// What every crossing asks of its edge and its triangle, in the order of the crossings.
    pub fn pushes(&self, surface: &Surface, x: &[World3]) -> Vec<Push> {
        let mut ignored = vec![World3::zeros(); surface.n_vertices()];
        let at_crossings = self.at_ends(x, &mut ignored);
        let push = |(i, g): (usize, &World3)| {
            let (vertices, weights) = self.stencil(surface, i);
            let gradient = self.against(surface, x, i, g);
            Push { crossing: i as u32, vertices, weights, gradient }
        };
        at_crossings.iter().enumerate().map(push).collect()
    }

    /// The gradient with respect to the places of the crossings, each on its own; what belongs to
    /// vertices is added to `at_vertices`.
    fn at_ends(&self, x: &[World3], at_vertices: &mut [World3]) -> Vec<World3> {
        let mut at_crossings = vec![World3::zeros(); self.crossings.len()];
        for segment in self.segments.iter().filter(|s| s.length > 0.0) {
            let [a, b] = segment.ends;
            let unit = (self.place(x, a) - self.place(x, b)) / segment.length;
            for (end, unit) in [(a, unit), (b, -unit)] {
                match end {
                    End::Crossing(i) => at_crossings[i as usize] += unit,
                    End::Vertex(v) => at_vertices[v as usize] += unit,
                }
            }
        }
        at_crossings
    }

    /// The gradient with respect to the edge alone, while the triangle rests.
    fn against(&self, surface: &Surface, x: &[World3], crossing: usize, g: &World3) -> World3 {
        let crossing = &self.crossings[crossing];
        let ([p, q], [a, b, c]) =
            (surface.ends(x, crossing.edge), surface.corners(x, crossing.triangle));
        let (e, n) = (q - p, (b - a).cross(&(c - a)));
        let across = n.dot(&e);
        // An edge so close to the plane that rounding puts it there tells nothing.
        if across == 0.0 { World3::zeros() } else { g - n * (e.dot(g) / across) }
    }

    fn stencil(&self, surface: &Surface, crossing: usize) -> ([u32; 5], [f64; 5]) {
        let crossing = &self.crossings[crossing];
        let [p, q] = surface.edges()[crossing.edge as usize];
        let [a, b, c] = surface.triangles()[crossing.triangle as usize];
        let (s, w) = (crossing.along, crossing.weights);
        ([p, q, a, b, c], [1.0 - s, s, -w[0], -w[1], -w[2]])
    }
}
