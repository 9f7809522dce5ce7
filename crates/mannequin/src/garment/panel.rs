//! Panels: a lattice of cells in space, and the flat pattern that comes nearest to it.

use mesh_core::generate::{Diagonal, GenerateError, Lattice, Sheet};
use mesh_core::{Material2, World3};

/// Sweeps of the flattening.
const SWEEPS: usize = 400;
/// Share of the way to its shape that a triangle goes at once.
const STEP: f64 = 0.7;

/// A panel whose vertex in column i and row j is at `world(i, j)` (m). Columns run to the right and
/// rows up as seen from outside.
pub(super) fn panel(
    lattice: &Lattice,
    world: impl Fn(usize, usize) -> World3,
) -> Result<Sheet, GenerateError> {
    let [nx, ny] = lattice.cells;
    let x: Vec<Vec<World3>> = (0..=ny).map(|j| (0..=nx).map(|i| world(i, j)).collect()).collect();
    let flat = flattened(&x);
    lattice.sheet(Diagonal::Alternating, |i, j| flat[j][i], |i, j| x[j][i])
}

/// Positions in the plane at which all triangles of neighbours in a cell have, as nearly as may be, the
/// shape they have in space: sweeps over them move each towards its shape, turned as fits best (shape
/// matching, Mueller2005). A triangle that is inside out is turned back. The start has rows and columns
/// in full length.
fn flattened(x: &[Vec<World3>]) -> Vec<Vec<Material2>> {
    let (ny, nx) = (x.len() - 1, x[0].len() - 1);
    let middle = nx / 2;
    let mut heights = vec![0.0; nx + 1];
    let mut u: Vec<Vec<Material2>> = Vec::with_capacity(ny + 1);
    for j in 0..=ny {
        let mut along = vec![0.0; nx + 1];
        for i in 0..=nx {
            if j > 0 {
                heights[i] += (x[j][i] - x[j - 1][i]).norm();
            }
            if i > 0 {
                along[i] = along[i - 1] + (x[j][i] - x[j][i - 1]).norm();
            }
        }
        let row = along.iter().zip(&heights);
        u.push(row.map(|(s, height)| Material2::new(s - along[middle], *height)).collect());
    }
    let mut triangles = Vec::with_capacity(4 * nx * ny);
    for j in 0..ny {
        for i in 0..nx {
            let [p, q, r, s] = [[j, i], [j, i + 1], [j + 1, i + 1], [j + 1, i]];
            for corners in [[p, q, r], [p, r, s], [p, q, s], [q, r, s]] {
                triangles.push((corners, unrolled(corners.map(|[j, i]| x[j][i]))));
            }
        }
    }
    for sweep in 0..SWEEPS {
        let mut relax = |(corners, shape): &([[usize; 2]; 3], [Material2; 3])| {
            let now = corners.map(|[j, i]| u[j][i]);
            let middle = (now[0] + now[1] + now[2]) / 3.0;
            let (mut sine, mut cosine) = (0.0, 0.0);
            for (p, q) in shape.iter().zip(&now) {
                let q = q - middle;
                sine += p.x * q.y - p.y * q.x;
                cosine += p.dot(&q);
            }
            let size = sine.hypot(cosine).max(1e-300);
            let (sine, cosine) = (sine / size, cosine / size);
            for (p, &[j, i]) in shape.iter().zip(corners) {
                let turned = Material2::new(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y);
                u[j][i] = u[j][i].lerp(&(middle + turned), STEP);
            }
        };
        // To and fro, so that no side is preferred.
        if sweep % 2 == 0 {
            triangles.iter().for_each(&mut relax);
        } else {
            triangles.iter().rev().for_each(relax);
        }
    }
    u
}

/// The triangle in the plane, counter-clockwise, its middle at the origin.
fn unrolled([a, b, c]: [World3; 3]) -> [Material2; 3] {
    let (ab, ac) = (b - a, c - a);
    let base = ab.norm();
    let foot = ac.dot(&ab) / base;
    let height = ab.cross(&ac).norm() / base;
    let corners = [Material2::zeros(), Material2::new(base, 0.0), Material2::new(foot, height)];
    let middle = (corners[1] + corners[2]) / 3.0;
    corners.map(|corner| corner - middle)
}

/// The point at `share` from −1 (x < 0) to 1 along the front half of a stadium: two half circles of
/// `radius` around (±`half`, 0), joined by straight lines (m).
pub(super) fn stadium(half: f64, radius: f64, share: f64) -> [f64; 2] {
    let s = share.abs() * (half + std::f64::consts::FRAC_PI_2 * radius);
    if s <= half {
        return [s * share.signum(), -radius];
    }
    let (sine, cosine) = ((s - half) / radius).sin_cos();
    [(half + radius * sine) * share.signum(), -radius * cosine]
}

/// The value at `z` of straight lines through points of falling or rising z, level beyond the ends.
pub(super) fn profile(points: &[[f64; 2]], z: f64) -> f64 {
    let next = points.partition_point(|p| p[0] <= z);
    match (next.checked_sub(1).map(|i| points[i]), points.get(next)) {
        (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (z - a[0]) / (b[0] - a[0]),
        (Some(a), None) => a[1],
        (None, _) => points[0][1],
    }
}

pub(super) fn mix(a: f64, b: f64, share: f64) -> f64 {
    a + (b - a) * share
}

/// Number of cells of about `cell` along `length` (m), at least `min`.
pub(super) fn cells(length: f64, cell: f64, min: usize) -> usize {
    ((length / cell).round() as usize).max(min)
}
