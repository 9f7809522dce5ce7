//! How good a mesh is: aspect of its triangles, size of its edges.

use crate::corners::NOT_HERE;
use mesh_core::geometry::aspect;
use mesh_core::{HalfEdge, Mesh};

/// Squared sizes above this make an edge invalid: rounding alone never splits one.
pub(crate) const LARGEST_SIZE_SQUARED: f64 = 1.0 + 1e-9;

/// Upper ends of the histogram's bins of edge sizes; the last bin is open.
pub const SIZE_BINS: [f64; 11] = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.5];

/// Quality of a mesh with respect to its metrics. An edge of size 1 is just allowed; after
/// remeshing most lie between one half and one.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshQuality {
    /// Number of vertices.
    pub n_vertices: usize,
    /// Number of triangles.
    pub n_triangles: usize,
    /// Number of edges.
    pub n_edges: usize,
    /// Smallest [aspect](mesh_core::geometry::aspect) of a triangle in material space (no unit).
    pub aspect_min: f64,
    /// Mean aspect (no unit).
    pub aspect_mean: f64,
    /// Number of triangles with an aspect below the settings' bound.
    pub n_below_aspect: usize,
    /// Number of edges of size above 1 outside fixed panels.
    pub n_invalid: usize,
    /// Largest edge size outside fixed panels (no unit).
    pub size_max: f64,
    /// Number of edges by size, in bins that end at [`SIZE_BINS`].
    pub sizes: [u32; SIZE_BINS.len() + 1],
}

impl MeshQuality {
    /// Measures the mesh with the squared sizes of its edges; `locked` tells edges that count only
    /// in the totals.
    pub(crate) fn measure(
        mesh: &Mesh,
        edge_sizes: &[[f64; 3]],
        aspect_bound: f64,
        locked: impl Fn(HalfEdge) -> bool,
    ) -> MeshQuality {
        let (mut aspect_min, mut aspect_sum, mut n_below_aspect) = (f64::INFINITY, 0.0, 0);
        for [a, b, c] in mesh.material() {
            let aspect = aspect(*a, *b, *c);
            aspect_min = aspect_min.min(aspect);
            aspect_sum += aspect;
            n_below_aspect += usize::from(aspect < aspect_bound);
        }
        let ends = SIZE_BINS.map(|end| end * end * LARGEST_SIZE_SQUARED);
        let mut sizes = [0; SIZE_BINS.len() + 1];
        let (mut n_edges, mut n_invalid, mut largest) = (0, 0, 0.0f64);
        for (t, three) in edge_sizes.iter().enumerate() {
            for (k, &size_squared) in three.iter().enumerate().filter(|(_, s)| **s != NOT_HERE) {
                n_edges += 1;
                if locked(HalfEdge((3 * t + k) as u32)) {
                    continue;
                }
                largest = largest.max(size_squared);
                n_invalid += usize::from(size_squared > LARGEST_SIZE_SQUARED);
                sizes[ends.partition_point(|end| size_squared > *end)] += 1;
            }
        }
        MeshQuality {
            n_vertices: mesh.n_vertices(),
            n_triangles: mesh.n_triangles(),
            n_edges,
            aspect_min,
            aspect_mean: aspect_sum / mesh.n_triangles() as f64,
            n_below_aspect,
            n_invalid,
            size_max: largest.sqrt(),
            sizes,
        }
    }
}
