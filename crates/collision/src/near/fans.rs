//! Vertices around which nothing comes near anything.
//!
//! Most pairs of triangles whose boxes overlap have a vertex in common, and on a surface without sharp
//! folds none of their features are near each other. This is told once for all triangles around a
//! vertex p, its fan. Let n be a unit vector, r_0, r_1, ... the ring, e_i the way from p to r_i, and T_i
//! the triangle p r_i r_(i+1) with the longest edge L_i. If
//!
//! - n · (e_i × e_(i+1)) > R L_i for all i, and
//! - seen along n, the fan goes around p at most once, and if it is open the gap is of a right angle or
//!   more, or n · (e_last × e_0) > R max(|e_last|, |e_0|) there as well,
//!
//! then any two features of the fan without a common vertex are more than R apart.
//!
//! *Proof.* Projection along n only brings things nearer, so look at the projected fan. Lengths of edges
//! are there at most L_i, so that every height of every T_i is more than R, and the triangles lie in
//! sectors around p, of angles below π, that do not overlap: they are embedded. Let α be the angle
//! between e_i and a neighbouring spoke, and y a point of the fan off p that T_i and T_(i−1) do not
//! contain: its angle from e_i is at least the α on its side. If it is a right angle or more, y is
//! |e_i| > R or more away from r_i; if not, |e_i| sin α or more, and this is the height of r_i over the
//! spoke, or |e_i| if α is a right angle or more. The same holds across the gap. And p is more than R
//! from the sides of the ring by the heights over them. So every vertex is more than R from every edge
//! and triangle that does not contain it. The distance of disjoint segments in a plane is that of an
//! end of one of them from the other. ∎
//!
//! With R the largest sum of two radii and the largest relative motion in the fan, no pair of features
//! of it can be near. Cloth that is flat or bent gently passes if the radii are small against the
//! heights of its triangles; whatever does not pass is looked at pair by pair.

use crate::pairs::Body;
use crate::rings;
use mesh_core::{World3, par};

/// By what R is enlarged (1): far above rounding.
const ROUNDING: f64 = 1e-6;

/// For each vertex, true if all features around it without a common vertex certainly stay apart by more
/// than their radii.
pub(super) fn clear(body: Body<'_>) -> Vec<bool> {
    let mut clear = vec![false; body.surface().n_vertices()];
    par::fill(&mut clear, |p| is_clear(body, p));
    clear
}

fn is_clear(body: Body<'_>, p: usize) -> bool {
    let ring = body.surface().rings().of(p);
    // One triangle has no pairs.
    if ring.len() < 3 {
        return false;
    }
    let n = ring.len() - 1;
    let mut spokes = [World3::zeros(); rings::MOST + 1];
    let mut radius = body.radius(p as u32);
    let (start, motion) = (body.x_t0()[p], body.motion(p));
    let mut moved: f64 = 0.0;
    for (spoke, &r) in spokes.iter_mut().zip(ring) {
        *spoke = body.x_t0()[r as usize] - start;
        radius = radius.max(body.radius(r));
        moved = moved.max((body.motion(r as usize) - motion).norm_squared());
    }
    let mut normals = [World3::zeros(); rings::MOST];
    let mut sum = World3::zeros();
    for i in 0..n {
        normals[i] = spokes[i].cross(&spokes[i + 1]);
        sum += normals[i];
    }
    let axis = sum / sum.norm();
    let room = (2.0 * (radius + moved.sqrt())) * (1.0 + ROUNDING);
    // True if the triangle of two spokes, with this area seen along the axis, is high enough. What is
    // no number is not.
    let is_high = |area: f64, longest: f64| {
        (area > ROUNDING * longest) & (area * area > room * room * longest)
    };
    let mut lengths = [0.0; rings::MOST + 1];
    for i in 0..=n {
        lengths[i] = spokes[i].norm_squared();
    }
    let mut is_clear = true;
    // Which side of the first spoke the others are on: the fan comes around as often as it crosses it
    // from right to left.
    let across = axis.cross(&spokes[0]);
    let mut turns = 0;
    let mut is_right = false;
    for i in 0..n {
        let side = (spokes[i + 1] - spokes[i]).norm_squared();
        is_clear &= is_high(axis.dot(&normals[i]), lengths[i].max(lengths[i + 1]).max(side));
        let is_closed = i + 1 == n && ring[n] == ring[0];
        let now = !is_closed && across.dot(&spokes[i + 1]) < 0.0;
        turns += usize::from(is_right & !now);
        is_right = now;
    }
    let around = if ring[n] == ring[0] {
        turns == 1
    } else {
        let (first, last) = (&spokes[0], &spokes[n]);
        let flat = last.dot(first) - last.dot(&axis) * first.dot(&axis);
        let gap = -across.dot(last);
        turns == 0 && (flat <= 0.0 || is_high(gap, lengths[0].max(lengths[n])))
    };
    is_clear & around
}
