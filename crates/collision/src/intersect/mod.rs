//! Does an edge cross a triangle? Exact, by predicates of Shewchuk1997, whatever the coordinates.
//!
//! Policy: an edge *crosses* a triangle if its ends lie strictly on different sides of the triangle's
//! plane and the line between them passes strictly inside. Any other common point, of an end on the
//! triangle, of the edge and the triangle's outline, of an edge in the triangle's plane, and of a
//! triangle without area, is *touching*. Crossings are stable: they survive small motion, come in
//! pairs along contours, and are what to count and to remove. Touching is the border between crossing
//! and apart, and a caller that wants no contact at all asks for "not apart".

mod count;
mod planar;

pub use count::{EdgeTriangle, between, between_brute_force, within, within_brute_force};

use mesh_core::World3;
use robust::{Coord3D, orient3d};

/// How an edge and a triangle lie to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// No point in common.
    Apart,
    /// A point in common, but no proper crossing.
    Touching,
    /// The edge passes strictly through the inside.
    Proper,
}

/// Exact sign, as a number, of the volume of a tetrahedron: positive if `d` sees `a, b, c` clockwise.
#[inline]
fn side(a: &World3, b: &World3, c: &World3, d: &World3) -> f64 {
    let coord = |p: &World3| Coord3D { x: p.x, y: p.y, z: p.z };
    orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// Volumes whose signs tell how an edge and a triangle lie to each other.
pub(crate) struct Volumes {
    /// Of the triangle with either end of the edge.
    pub(crate) ends: [f64; 2],
    /// Of the edge with every side of the triangle.
    pub(crate) sides: [f64; 3],
}

#[inline]
pub(crate) fn volumes(p: &World3, q: &World3, [a, b, c]: &[World3; 3]) -> Volumes {
    Volumes {
        ends: [side(a, b, c, p), side(a, b, c, q)],
        sides: [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)],
    }
}

/// Edge from `p` to `q` against triangle `t`: the exact answer for the given coordinates, barring
/// overflow and underflow of their products.
pub fn edge_triangle(p: &World3, q: &World3, t: &[World3; 3]) -> Crossing {
    let Volumes { ends: [above, below], sides: around } = volumes(p, q, t);
    if (above > 0.0 && below > 0.0) || (above < 0.0 && below < 0.0) {
        return Crossing::Apart;
    }
    let all = |f: fn(f64) -> bool| around.iter().all(|&s| f(s));
    if above == 0.0 && below == 0.0 {
        // A triangle without area is in a plane with the edge if that sees all of its sides so.
        let touches = all(|s| s == 0.0) && planar::edge_triangle(p, q, t);
        return if touches { Crossing::Touching } else { Crossing::Apart };
    }
    if above != 0.0 && below != 0.0 && (all(|s| s > 0.0) || all(|s| s < 0.0)) {
        Crossing::Proper
    } else if all(|s| s >= 0.0) || all(|s| s <= 0.0) {
        Crossing::Touching
    } else {
        Crossing::Apart
    }
}
