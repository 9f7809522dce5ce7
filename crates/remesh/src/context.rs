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
    /// By half-edge; filled at the lower one of every edge and zero elsewhere.
    dihedral: Vec<f64>,
}

impl<'a> SizingContext<'a> {
    /// Works out normals and dihedral angles. Cost: one pass over the mesh.
    pub fn new(cloth: &'a ClothState, obstacle: Option<&'a [Metric]>) -> Self {
        let mesh = &cloth.mesh;
        let mut area_vectors = vec![World3::zeros(); mesh.n_triangles()];
        par::fill(&mut area_vectors, |t| {
            let [a, b, c] = mesh.triangles()[t];
            area_vector(cloth.x[a as usize], cloth.x[b as usize], cloth.x[c as usize])
        });
        let mut normals = vec![World3::zeros(); mesh.n_vertices()];
        par::fill(&mut normals, |v| {
            let mut sum = World3::zeros();
            for h in mesh.outgoing(VertexId(v as u32)) {
                sum += area_vectors[h.triangle().index()];
            }
            unit_or_zero(sum)
        });
        let mut dihedral = vec![0.0; 3 * mesh.n_triangles()];
        par::fill(&mut dihedral, |h| {
            let h = HalfEdge(h as u32);
            match mesh.twin(h) {
                Some(g) if h < g => {
                    let edge = cloth.x[mesh.origin(g).index()] - cloth.x[mesh.origin(h).index()];
                    let [left, right] = [h.triangle(), g.triangle()];
                    angle_between(area_vectors[left.index()], area_vectors[right.index()], edge)
                }
                _ => 0.0,
            }
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
        let lower = self.cloth.mesh.twin(h).map_or(h, |g| g.min(h));
        self.dihedral[lower.index()]
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
        let [a, b, c] = self.cloth.mesh.triangles()[t.index()];
        gradient([values[a as usize], values[b as usize], values[c as usize]], &inverse)
    }

    /// Derivatives of the vertex normals by material coordinates (1/m).
    pub fn normal_gradient(&self, t: TriangleId) -> Matrix3x2<f64> {
        self.gradient(t, &self.normals)
    }

    /// The vertex normals.
    pub(crate) fn normals(&self) -> &[World3] {
        &self.normals
    }

    /// Discrete shape operator of a triangle in material space (1/m): Σ θₑ ℓₑ nₑ nₑᵀ / 2A over its
    /// edges of length ℓₑ, with dihedral angle θₑ and unit normal nₑ in the material plane, which
    /// gives half of each edge's turn to either side (Grinspun2006).
    #[inline]
    pub fn shape_operator(&self, t: TriangleId) -> Matrix2<f64> {
        let [xx, xy, yy] = self.shape_entries(t);
        Matrix2::new(xx, xy, xy, yy)
    }

    /// The entries xx, xy and yy of the shape operator.
    #[inline]
    pub(crate) fn shape_entries(&self, t: TriangleId) -> [f64; 3] {
        let angles = [0, 1, 2].map(|k| self.dihedral(t.half_edge(k)));
        let u = &self.cloth.mesh.material()[t.index()];
        let edges = [u[1] - u[0], u[2] - u[1], u[0] - u[2]];
        let twice_area = edges[0].x * edges[1].y - edges[0].y * edges[1].x;
        let mut entries = [0.0; 3];
        for (angle, e) in angles.iter().zip(&edges) {
            let weight = angle / (twice_area * e.norm());
            entries[0] += weight * e.y * e.y;
            entries[1] -= weight * e.x * e.y;
            entries[2] += weight * e.x * e.x;
        }
        entries
    }
}

/// Angle by which the normal turns across an edge (rad), from the area vectors on both sides; zero
/// if one is degenerate.
#[inline]
fn angle_between(n_left: World3, n_right: World3, edge: World3) -> f64 {
    let sine = n_left.cross(&n_right).dot(&edge);
    let cosine = n_left.dot(&n_right) * edge.norm();
    if sine.abs() < 0.1 * cosine {
        return small_arc_tangent(sine / cosine);
    }
    if sine == 0.0 && cosine == 0.0 { 0.0 } else { sine.atan2(cosine) }
}

/// Arc tangent for |x| ≤ 0.1, the usual case: the series up to x¹⁵, to rounding.
#[inline]
fn small_arc_tangent(x: f64) -> f64 {
    let y = -x * x;
    let tail = 1.0 / 9.0 + y * (1.0 / 11.0 + y * (1.0 / 13.0 + y / 15.0));
    x + x * y * (1.0 / 3.0 + y * (1.0 / 5.0 + y * (1.0 / 7.0 + y * tail)))
}

#[inline]
fn unit_or_zero(v: World3) -> World3 {
    let norm = v.norm();
    if norm == 0.0 { v } else { v / norm }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_core::geometry::dihedral_angle;

    #[test]
    fn angles_agree_with_the_arc_tangent() {
        let (a, b) = (World3::new(0.1, 0.2, 0.0), World3::new(0.4, 0.1, 0.3));
        let c = World3::new(0.2, 0.8, 0.1);
        for k in -3000..=3000 {
            let angle = f64::from(k) * 1e-3;
            let axis = nalgebra::Unit::new_normalize(b - a);
            let flat = a + b - c;
            let d = a + nalgebra::Rotation3::from_axis_angle(&axis, angle) * (flat - a);
            let got = angle_between(area_vector(a, b, c), area_vector(b, a, d), b - a);
            assert!((got - dihedral_angle(a, b, c, d)).abs() <= 1e-15 + 4e-16 * angle.abs());
            assert!((got.abs() - angle.abs()).abs() < 1e-14);
        }
        assert_eq!(angle_between(World3::zeros(), World3::z(), World3::x()), 0.0);
    }
}
