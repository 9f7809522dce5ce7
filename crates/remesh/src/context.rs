//! What a sizing field may look at: the cloth and world-space quantities worked out once per call.

use crate::metric::Metric;
use mesh_core::geometry::{area_vector, gradient, inverse_edges};
use mesh_core::{ClothState, HalfEdge, Material2, TriangleId, VertexId, World3, par};
use nalgebra::{Matrix2, Matrix3x2};

/// The cloth as a [`SizingField`](crate::SizingField) sees it, with what several policies want
/// worked out in advance: world normals of triangles and vertices and the dihedral angles.
#[derive(Debug)]
pub struct SizingContext<'a> {
    /// The cloth, before any edit of this call.
    pub cloth: &'a ClothState,
    /// Metric wanted for the proximity of obstacles, one per triangle (1/m²).
    pub obstacle: Option<&'a [Metric]>,
    area_vectors: Vec<World3>,
    normals: Vec<World3>,
    /// At the canonical half-edge of every edge; zero elsewhere.
    dihedral: Vec<[f64; 3]>,
}

impl<'a> SizingContext<'a> {
    /// Works out normals and dihedral angles. Cost: one pass over the mesh.
    pub fn new(cloth: &'a ClothState, obstacle: Option<&'a [Metric]>) -> Self {
        let mesh = &cloth.mesh;
        let mut area_vectors = vec![World3::zeros(); mesh.n_triangles()];
        par::fill(&mut area_vectors, |t| {
            let [a, b, c] = cloth.corners(TriangleId(t as u32));
            area_vector(a, b, c)
        });
        let mut normals = vec![World3::zeros(); mesh.n_vertices()];
        par::fill(&mut normals, |v| {
            let around = mesh.outgoing(VertexId(v as u32));
            unit_or_zero(around.map(|h| area_vectors[h.triangle().index()]).sum())
        });
        let mut dihedral = vec![[0.0; 3]; mesh.n_triangles()];
        par::fill(&mut dihedral, |t| {
            let t = TriangleId(t as u32);
            [0, 1, 2].map(|k| {
                let h = t.half_edge(k);
                match mesh.twin(h) {
                    Some(g) if h < g => {
                        let edge = cloth.x[mesh.dest(h).index()] - cloth.x[mesh.origin(h).index()];
                        let of = |e: HalfEdge| area_vectors[e.triangle().index()];
                        angle_between(of(h), of(g), edge)
                    }
                    _ => 0.0,
                }
            })
        });
        SizingContext { cloth, obstacle, area_vectors, normals, dihedral }
    }

    /// Area-weighted unit normal of a vertex in world space, zero if its triangles are degenerate
    /// (no unit).
    #[inline]
    pub fn normal(&self, v: VertexId) -> World3 {
        self.normals[v.index()]
    }

    /// Unit normal of a triangle in world space, zero if it is degenerate (no unit).
    #[inline]
    pub fn face_normal(&self, t: TriangleId) -> World3 {
        unit_or_zero(self.area_vectors[t.index()])
    }

    /// Dihedral angle at an edge, positive where the normals lean apart, zero on the boundary
    /// (rad).
    #[inline]
    pub fn dihedral(&self, h: HalfEdge) -> f64 {
        let canonical = match self.cloth.mesh.twin(h) {
            Some(g) if g < h => g,
            _ => h,
        };
        self.dihedral[canonical.triangle().index()][canonical.corner()]
    }

    /// Centre of a triangle in material space (m).
    pub fn centroid(&self, t: TriangleId) -> Material2 {
        let [a, b, c] = self.cloth.mesh.material()[t.index()];
        (a + b + c) / 3.0
    }

    /// Derivatives by material coordinates of a vector field that is linear on a triangle and has
    /// the given values at the vertices (the values' unit per metre): `&cloth.x` makes it the
    /// deformation gradient, `&cloth.v` the velocity gradient.
    pub fn gradient(&self, t: TriangleId, values: &[World3]) -> Matrix3x2<f64> {
        let inverse = inverse_edges(self.cloth.mesh.material()[t.index()]);
        self.gradient_with(t, values, &inverse)
    }

    /// Derivatives of the vertex normals by material coordinates (1/m).
    pub fn normal_gradient(&self, t: TriangleId) -> Matrix3x2<f64> {
        self.gradient(t, &self.normals)
    }

    /// As [`SizingContext::gradient`], with the inverse of the triangle's material edges at hand.
    #[inline]
    pub(crate) fn gradient_with(
        &self,
        t: TriangleId,
        values: &[World3],
        inverse: &Matrix2<f64>,
    ) -> Matrix3x2<f64> {
        let corners = self.cloth.mesh.triangles()[t.index()];
        gradient(corners.map(|i| values[i as usize]), inverse)
    }

    #[inline]
    pub(crate) fn normals(&self) -> &[World3] {
        &self.normals
    }

    /// Discrete shape operator of a triangle in material space (1/m): Σ θₑ ℓₑ nₑ nₑᵀ / 2A over its
    /// edges of length ℓₑ, with dihedral angle θₑ and unit normal nₑ in the material plane, which
    /// gives half of each edge's turn to either side (Grinspun2006).
    #[inline]
    pub fn shape_operator(&self, t: TriangleId) -> Matrix2<f64> {
        let u = &self.cloth.mesh.material()[t.index()];
        let edges = [u[1] - u[0], u[2] - u[1], u[0] - u[2]];
        let twice_area = edges[0].x * edges[1].y - edges[0].y * edges[1].x;
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for (k, e) in edges.iter().enumerate() {
            let weight = self.dihedral(t.half_edge(k)) / (twice_area * e.norm());
            xx += weight * e.y * e.y;
            xy -= weight * e.x * e.y;
            yy += weight * e.x * e.x;
        }
        Matrix2::new(xx, xy, xy, yy)
    }
}

/// Angle by which the normal turns across an edge (rad), from the area vectors on both sides; zero
/// if one is degenerate.
#[inline]
fn angle_between(n_left: World3, n_right: World3, edge: World3) -> f64 {
    let sine = n_left.cross(&n_right).dot(&edge);
    let cosine = n_left.dot(&n_right) * edge.norm();
    if sine == 0.0 && cosine == 0.0 { 0.0 } else { sine.atan2(cosine) }
}

#[inline]
fn unit_or_zero(v: World3) -> World3 {
    let norm = v.norm();
    if norm > 0.0 { v / norm } else { World3::zeros() }
}
