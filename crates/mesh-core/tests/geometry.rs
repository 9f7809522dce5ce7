//! Geometry of triangles and hinges against closed forms.

use mesh_core::geometry::{
    area_vector, aspect, dihedral_angle, gradient, inverse_edges, is_sound, signed_area,
};
use mesh_core::{Material2, World3};
use nalgebra::{Matrix2, Matrix3x2, Rotation3};
use proptest::prelude::*;
use std::f64::consts::PI;

fn u(x: f64, y: f64) -> Material2 {
    Material2::new(x, y)
}

#[test]
fn areas() {
    let [a, b, c] = [u(1.0, 1.0), u(4.0, 1.0), u(2.0, 3.0)];
    assert_eq!(signed_area(a, b, c), 3.0);
    assert_eq!(signed_area(b, c, a), 3.0);
    assert_eq!(signed_area(a, c, b), -3.0);
    assert_eq!(signed_area(a, b, b), 0.0);
    let [x, y, z] = [a, b, c].map(|p| World3::new(p.x, 7.0, p.y));
    assert_eq!(area_vector(x, y, z), World3::new(0.0, -3.0, 0.0));
}

#[test]
fn aspects() {
    let equilateral = [u(0.0, 0.0), u(2.0, 0.0), u(1.0, 3f64.sqrt())];
    let [a, b, c] = equilateral;
    assert!((aspect(a, b, c) - 1.0).abs() < 1e-15);
    assert!((aspect(a, c, b) + 1.0).abs() < 1e-15);
    // Half a square: A = 1/2, p = 2 + √2.
    let half = aspect(u(0.0, 0.0), u(1.0, 0.0), u(0.0, 1.0));
    assert!((half - 6.0 * 3f64.sqrt() / (2.0 + 2f64.sqrt()).powi(2)).abs() < 1e-15);
    assert_eq!(aspect(a, b, u(1.0, 0.0)), 0.0);
    assert_eq!(aspect(a, a, a), 0.0);
    // Independent of size and place.
    let far = equilateral.map(|p| p * 1e-6 + u(3.0, -2.0));
    assert!((aspect(far[0], far[1], far[2]) - 1.0).abs() < 1e-8);
}

#[test]
fn sound_triangles() {
    let thin = |height: f64| is_sound(u(0.0, 0.0), u(1.0, 0.0), u(0.5, height));
    assert!(thin(1.0) && thin(3e-10));
    assert!(!thin(1e-10) && !thin(0.0) && !thin(-1.0) && !thin(f64::NAN));
    assert!(!is_sound(u(1.0, 1.0), u(1.0, 1.0), u(1.0, 1.0)));
}

/// A hinge over the x axis whose wings stand at `angle` to each other.
fn hinge(angle: f64) -> [World3; 4] {
    let wing = |y: f64, turn: f64| World3::new(0.3, y * turn.cos(), turn.sin() * -y.abs());
    let (a, b) = (World3::zeros(), World3::new(0.7, 0.0, 0.0));
    [a, b, wing(1.3, 0.25 * angle), wing(-0.4, 0.75 * angle)]
}

#[test]
fn dihedral_angles() {
    for k in -31..=31 {
        let angle = 0.1 * f64::from(k);
        let [a, b, c, d] = hinge(angle);
        assert!((dihedral_angle(a, b, c, d) - angle).abs() < 1e-14, "{angle}");
        // The same edge seen from its other end.
        assert!((dihedral_angle(b, a, d, c) - angle).abs() < 1e-14, "{angle}");
        // Mirrored: a ridge becomes a valley.
        let [a, b, c, d] = [a, b, c, d].map(|p| World3::new(p.x, p.y, -p.z));
        assert!((dihedral_angle(a, b, c, d) + angle).abs() < 1e-14, "{angle}");
    }
    // A ridge: normals up, both wings below the edge.
    let [a, b, c, d] = hinge(1.0);
    assert!(c.z < 0.0 && d.z < 0.0 && (b - a).cross(&(c - a)).z > 0.0);
    assert!(dihedral_angle(a, b, c, d) > 0.0);
}

#[test]
fn flat_folded_and_degenerate_hinges() {
    let (o, x, y) = (World3::zeros(), World3::x(), World3::y());
    assert_eq!(dihedral_angle(o, x, y, -y), 0.0);
    assert_eq!(dihedral_angle(o, x, y, y).abs(), PI);
    for (a, b, c, d) in [(o, o, y, -y), (o, x, x * 2.0, -y), (o, x, y, x * 0.5), (o, x, o, o)] {
        assert_eq!(dihedral_angle(a, b, c, d), 0.0);
    }
    // Tiny hinges keep their angle.
    let [a, b, c, d] = hinge(0.5).map(|p| p * 1e-60);
    assert!((dihedral_angle(a, b, c, d) - 0.5).abs() < 1e-14);
}

#[test]
fn inverses() {
    let corners = [u(1.0, 2.0), u(3.0, 2.5), u(0.5, 4.0)];
    let edges = Matrix2::from_columns(&[corners[1] - corners[0], corners[2] - corners[0]]);
    let inverse = inverse_edges(corners);
    assert!((inverse * edges - Matrix2::identity()).norm() < 1e-15);
    assert!((edges * inverse - Matrix2::identity()).norm() < 1e-15);
}

fn number() -> impl Strategy<Value = f64> {
    -2.0..2.0f64
}

proptest! {
    #[test]
    fn gradients_of_linear_fields(
        f in prop::array::uniform6(number()), offset in prop::array::uniform3(number()),
        corners in prop::array::uniform6(number()),
    ) {
        let corners = [u(corners[0], corners[1]), u(corners[2], corners[3]), u(corners[4], corners[5])];
        prop_assume!(aspect(corners[0], corners[1], corners[2]).abs() > 0.05);
        let f = Matrix3x2::from_row_slice(&f);
        let values = corners.map(|u| f * u + World3::from(offset));
        let size = inverse_edges(corners).norm().max(1.0);
        prop_assert!((gradient(values, &inverse_edges(corners)) - f).norm() < 1e-13 * size);
    }

    #[test]
    fn dihedral_angles_move_with_the_body(
        angle in -3.1..3.1f64, axis in prop::array::uniform3(number()),
        shift in prop::array::uniform3(number()),
    ) {
        let turn = Rotation3::new(World3::from(axis));
        let [a, b, c, d] = hinge(angle).map(|p| turn * p + World3::from(shift));
        prop_assert!((dihedral_angle(a, b, c, d) - angle).abs() < 1e-13);
    }
}
