//! Geometry of single triangles and hinges.

use nalgebra::{Matrix2, Matrix3x2, Vector2, Vector3};

/// A point or vector in material space (m).
pub type Material2 = Vector2<f64>;
/// A point or vector in world space (m, or m/s for velocities).
pub type World3 = Vector3<f64>;

/// Signed area of a triangle in material space (m²): positive if counter-clockwise.
#[inline]
pub fn signed_area(a: Material2, b: Material2, c: Material2) -> f64 {
    let (p, q) = (b - a, c - a);
    0.5 * (p.x * q.y - p.y * q.x)
}

/// Area-scaled aspect ratio 12√3 A / p² with perimeter p: 1 for an equilateral triangle, 0 for a
/// degenerate one, negative for an inverted one.
#[inline]
pub fn aspect(a: Material2, b: Material2, c: Material2) -> f64 {
    let perimeter = (b - a).norm() + (c - b).norm() + (a - c).norm();
    if perimeter > 0.0 {
        12.0 * 3.0f64.sqrt() * signed_area(a, b, c) / (perimeter * perimeter)
    } else {
        0.0
    }
}

/// True if a triangle's area is clearly positive, above 1e-10 of its longest edge squared: edits
/// only make such triangles, far enough from where rounding decides the sign.
#[inline]
pub fn is_sound(a: Material2, b: Material2, c: Material2) -> bool {
    let edges = [b - a, c - b, a - c].map(|e| e.norm_squared());
    signed_area(a, b, c) > 1e-10 * edges[0].max(edges[1]).max(edges[2])
}

/// Inverse of the matrix of material edges [u₁ − u₀, u₂ − u₀] (1/m): derivatives of a function that
/// is linear on the triangle are `[f₁ − f₀, f₂ − f₀] · inverse`.
#[inline]
pub fn inverse_edges([a, b, c]: [Material2; 3]) -> Matrix2<f64> {
    let (p, q) = (b - a, c - a);
    let det = p.x * q.y - p.y * q.x;
    Matrix2::new(q.y, -q.x, -p.y, p.x) / det
}

/// Gradient with respect to the material coordinates of a vector field that is linear on the
/// triangle: with world positions this is the deformation gradient F, with velocities ∂v/∂u (1/s).
#[inline]
pub fn gradient(values: [World3; 3], inverse_edges: &Matrix2<f64>) -> Matrix3x2<f64> {
    Matrix3x2::from_columns(&[values[1] - values[0], values[2] - values[0]]) * inverse_edges
}

/// Area vector of a triangle in world space (m²): half the cross product of its edges.
#[inline]
pub fn area_vector(a: World3, b: World3, c: World3) -> World3 {
    (b - a).cross(&(c - a)) * 0.5
}

/// Dihedral angle (rad) across the edge from `a` to `b` of the triangles (a, b, c) and (b, a, d):
/// zero when flat, positive when the normals lean apart (a ridge seen from the normals' side),
/// in (−π, π]. Zero if either triangle is degenerate.
#[inline]
pub fn dihedral_angle(a: World3, b: World3, c: World3, d: World3) -> f64 {
    let n_c = (b - a).cross(&(c - a));
    let n_d = (d - a).cross(&(b - a));
    let edge = b - a;
    let sine = n_c.cross(&n_d).dot(&edge);
    let cosine = n_c.dot(&n_d) * edge.norm();
    if sine == 0.0 && cosine == 0.0 { 0.0 } else { sine.atan2(cosine) }
}
