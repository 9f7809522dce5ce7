//! What every triangle knows about its rest shape.

use mesh_core::{ClothState, World3, geometry};
use nalgebra::{Matrix2, Matrix3x2, Vector2, Vector3};

/// Rest shape of a triangle in material space.
#[derive(Clone, Copy, Debug)]
pub struct RestTriangle {
    /// Gradients of the three barycentric coordinates (1/m): F = Σ xᵢ bᵢᵀ.
    pub b: [Vector2<f64>; 3],
    /// Material area (m²).
    pub area: f64,
    /// Index of its fabric.
    pub panel: u32,
}

impl RestTriangle {
    /// Rest shapes of all triangles of a cloth.
    pub fn all(cloth: &ClothState) -> Vec<RestTriangle> {
        let mesh = &cloth.mesh;
        let one = |t: mesh_core::TriangleId| {
            let g: Matrix2<f64> = geometry::inverse_edges(mesh.material()[t.index()]);
            let (b1, b2) = (g.row(0).transpose(), g.row(1).transpose());
            RestTriangle {
                b: [-b1 - b2, b1, b2],
                area: mesh.area(t),
                panel: mesh.panels()[t.index()],
            }
        };
        mesh.triangle_ids().map(one).collect()
    }

    /// The deformation gradient F = ∂x/∂u.
    #[inline]
    pub fn deformation_gradient(&self, x: &[World3; 3]) -> Matrix3x2<f64> {
        let (p, q) = (x[1] - x[0], x[2] - x[0]);
        Matrix3x2::from_columns(&[
            p * self.b[1].x + q * self.b[2].x,
            p * self.b[1].y + q * self.b[2].y,
        ])
    }

    /// Change of [`RestTriangle::green_strain`] to first order when F changes by `df`.
    #[inline]
    pub fn strain_change(f: &Matrix3x2<f64>, df: &Matrix3x2<f64>) -> Vector3<f64> {
        let (f1, f2) = (f.column(0), f.column(1));
        let (d1, d2) = (df.column(0), df.column(1));
        Vector3::new(f1.dot(&d1), f2.dot(&d2), f1.dot(&d2) + f2.dot(&d1))
    }

    /// Green strain (E₁₁, E₂₂, 2 E₁₂) of a deformation gradient.
    #[inline]
    pub fn green_strain(f: &Matrix3x2<f64>) -> Vector3<f64> {
        let (f1, f2) = (f.column(0), f.column(1));
        Vector3::new(0.5 * (f1.norm_squared() - 1.0), 0.5 * (f2.norm_squared() - 1.0), f1.dot(&f2))
    }
}
