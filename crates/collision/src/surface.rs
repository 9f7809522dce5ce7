//! The connectivity that collision needs: triangles, edges, and who owns what.

use crate::rings::Rings;
use crate::{Aabb, Bvh};
use mesh_core::World3;
use thiserror::Error;

/// Why an index buffer is no surface.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SurfaceError {
    /// A vertex index is out of range.
    #[error("triangle {triangle} has vertex {vertex}, but there are only {n_vertices} vertices")]
    NoSuchVertex {
        /// The triangle.
        triangle: usize,
        /// Its vertex.
        vertex: u32,
        /// Number of vertices.
        n_vertices: usize,
    },
    /// A triangle has a vertex twice.
    #[error("triangle {triangle} has vertex {vertex} twice")]
    Degenerate {
        /// The triangle.
        triangle: usize,
        /// Its vertex.
        vertex: u32,
    },
}

/// Triangles with their edges; any number of triangles may meet in an edge.
///
/// Every vertex and every edge is owned by the lowest of its triangles (the representative triangles
/// of Curtis2008). Whatever comes near a feature comes near its owner, so pairs of triangles with
/// overlapping boxes lead to every pair of features exactly once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Surface {
    n_vertices: usize,
    triangles: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
    /// Edge k of a triangle is from corner k to corner k + 1.
    triangle_edges: Vec<[u32; 3]>,
    /// Where the triangles of each edge begin in `around`, and where the last ones end.
    starts: Vec<u32>,
    around: Vec<u32>,
    /// Bits 0–2: corners, bits 3–5: edges that the triangle owns.
    owned: Vec<u8>,
    rings: Rings,
}

impl Surface {
    /// The surface of an index buffer; vertices that no triangle uses take no part in anything.
    /// Edges are in ascending order of their vertices, the lower one first.
    ///
    /// # Errors
    /// If an index is out of range or twice in a triangle.
    pub fn new(n_vertices: usize, triangles: &[[u32; 3]]) -> Result<Surface, SurfaceError> {
        for (triangle, t) in triangles.iter().enumerate() {
            for k in 0..3 {
                let vertex = t[k];
                if vertex as usize >= n_vertices {
                    return Err(SurfaceError::NoSuchVertex { triangle, vertex, n_vertices });
                }
                if vertex == t[(k + 1) % 3] {
                    return Err(SurfaceError::Degenerate { triangle, vertex });
                }
            }
        }
        let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * triangles.len());
        for (t, corners) in (0..).zip(triangles) {
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                sides.push(([a.min(b), a.max(b)], 3 * t + k as u32));
            }
        }
        sides.sort_unstable();
        let mut surface = Surface {
            n_vertices,
            triangles: triangles.to_vec(),
            edges: Vec::new(),
            triangle_edges: vec![[0; 3]; triangles.len()],
            starts: Vec::new(),
            around: Vec::with_capacity(sides.len()),
            owned: vec![0; triangles.len()],
            rings: Rings::new(n_vertices, triangles),
        };
        for same in sides.chunk_by(|a, b| a.0 == b.0) {
            let edge = surface.edges.len() as u32;
            surface.edges.push(same[0].0);
            surface.starts.push(surface.around.len() as u32);
            for &(_, side) in same {
                surface.triangle_edges[side as usize / 3][side as usize % 3] = edge;
                surface.around.push(side / 3);
            }
            let first = same[0].1 as usize;
            surface.owned[first / 3] |= 8 << (first % 3);
        }
        surface.starts.push(surface.around.len() as u32);
        let mut seen = vec![false; n_vertices];
        for (owned, corners) in surface.owned.iter_mut().zip(triangles) {
            for k in 0..3 {
                if !std::mem::replace(&mut seen[corners[k] as usize], true) {
                    *owned |= 1 << k;
                }
            }
        }
        Ok(surface)
    }

    /// Two surfaces as one; the vertices, triangles and edges of the second follow the first's.
    #[must_use]
    pub fn joined(&self, other: &Surface) -> Surface {
        let (v, t, e) = (self.n_vertices as u32, self.n_triangles() as u32, self.n_edges() as u32);
        let mut all = self.clone();
        all.n_vertices += other.n_vertices;
        all.triangles.extend(other.triangles.iter().map(|x| x.map(|x| x + v)));
        all.edges.extend(other.edges.iter().map(|x| x.map(|x| x + v)));
        all.triangle_edges.extend(other.triangle_edges.iter().map(|x| x.map(|x| x + e)));
        all.starts.pop();
        all.starts.extend(other.starts.iter().map(|s| s + self.around.len() as u32));
        all.around.extend(other.around.iter().map(|x| x + t));
        all.owned.extend(&other.owned);
        all.rings.extend(&other.rings, t);
        all
    }

    /// Number of vertices, used or not.
    pub fn n_vertices(&self) -> usize {
        self.n_vertices
    }

    /// Number of triangles.
    pub fn n_triangles(&self) -> usize {
        self.triangles.len()
    }

    /// Number of edges.
    pub fn n_edges(&self) -> usize {
        self.edges.len()
    }

    /// Vertices of every triangle.
    #[inline]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Vertices of every edge, the lower one first.
    #[inline]
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// Edges of a triangle: edge k is between its corners k and k + 1.
    #[inline]
    pub fn edges_of(&self, triangle: u32) -> [u32; 3] {
        self.triangle_edges[triangle as usize]
    }

    /// The triangles that meet in an edge, in ascending order; one on the boundary.
    #[inline]
    pub fn triangles_at(&self, edge: u32) -> &[u32] {
        let e = edge as usize;
        &self.around[self.starts[e] as usize..self.starts[e + 1] as usize]
    }

    /// What lies around each vertex.
    #[inline]
    pub(crate) fn rings(&self) -> &Rings {
        &self.rings
    }

    /// What a triangle owns: bits 0–2 for its corners, bits 3–5 for its edges.
    #[inline]
    pub(crate) fn owned(&self, triangle: u32) -> u8 {
        self.owned[triangle as usize]
    }

    /// The vertices that a triangle owns.
    #[inline]
    pub fn owned_vertices(&self, triangle: u32) -> impl Iterator<Item = u32> + use<> {
        let (owned, corners) = (self.owned[triangle as usize], self.triangles[triangle as usize]);
        (0..3).filter(move |k| owned >> k & 1 == 1).map(move |k| corners[k])
    }

    /// The edges that a triangle owns.
    #[inline]
    pub fn owned_edges(&self, triangle: u32) -> impl Iterator<Item = u32> + use<> {
        let (owned, edges) =
            (self.owned[triangle as usize], self.triangle_edges[triangle as usize]);
        (0..3).filter(move |k| owned >> (k + 3) & 1 == 1).map(move |k| edges[k])
    }

    /// Positions of a triangle's corners (m).
    #[inline]
    pub fn corners(&self, x: &[World3], triangle: u32) -> [World3; 3] {
        self.triangles[triangle as usize].map(|v| x[v as usize])
    }

    /// Positions of an edge's ends (m).
    #[inline]
    pub fn ends(&self, x: &[World3], edge: u32) -> [World3; 2] {
        self.edges[edge as usize].map(|v| x[v as usize])
    }

    /// The box around a triangle.
    #[inline]
    pub fn triangle_box(&self, x: &[World3], triangle: u32) -> Aabb {
        Aabb::around(&self.corners(x, triangle))
    }

    /// A tree over the triangles at positions `x` (m).
    pub fn tree(&self, x: &[World3]) -> Bvh {
        Bvh::build(self.n_triangles(), |t| self.triangle_box(x, t))
    }

    /// Makes a tree over the triangles one for positions `x` (m); see [`Bvh::update`].
    pub fn update_tree(&self, tree: &mut Bvh, x: &[World3]) -> bool {
        tree.update(self.n_triangles(), |t| self.triangle_box(x, t))
    }

    /// True if an edge and a triangle have a vertex in common.
    #[inline]
    pub fn edge_meets_triangle(&self, edge: u32, triangle: u32) -> bool {
        let [p, q] = self.edges[edge as usize];
        self.triangles[triangle as usize].iter().any(|&v| v == p || v == q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles with a common edge, and a third on the same edge.
    const FAN: [[u32; 3]; 3] = [[0, 1, 2], [1, 0, 3], [0, 1, 5]];

    #[test]
    fn edges_know_their_triangles_and_triangles_their_edges() {
        let s = Surface::new(6, &FAN).unwrap();
        assert_eq!(s.edges(), [[0, 1], [0, 2], [0, 3], [0, 5], [1, 2], [1, 3], [1, 5]]);
        assert_eq!(s.triangles_at(0), [0, 1, 2]);
        assert_eq!(s.triangles_at(4), [0]);
        assert_eq!(s.edges_of(1), [0, 2, 5]);
    }

    #[test]
    fn every_feature_has_one_owner_around_it() {
        let s = Surface::new(6, &FAN).unwrap();
        let edges: Vec<u32> = (0..3).flat_map(|t| s.owned_edges(t)).collect();
        let vertices: Vec<u32> = (0..3).flat_map(|t| s.owned_vertices(t)).collect();
        assert_eq!(edges, [0, 4, 1, 2, 5, 6, 3]);
        assert_eq!(vertices, [0, 1, 2, 3, 5]);
    }

    #[test]
    fn joining_keeps_both() {
        let (a, b) = (Surface::new(6, &FAN).unwrap(), Surface::new(4, &FAN[..2]).unwrap());
        let moved: Vec<[u32; 3]> = FAN.into_iter().chain([[6, 7, 8], [7, 6, 9]]).collect();
        assert_eq!(a.joined(&b), Surface::new(10, &moved).unwrap());
    }

    #[test]
    fn bad_indices_are_refused() {
        let refused = |t: [u32; 3]| Surface::new(4, &[[0, 1, 2], t]).unwrap_err();
        let n_vertices = 4;
        assert_eq!(
            refused([0, 1, 4]),
            SurfaceError::NoSuchVertex { triangle: 1, vertex: 4, n_vertices }
        );
        assert_eq!(refused([3, 1, 3]), SurfaceError::Degenerate { triangle: 1, vertex: 3 });
    }
}
