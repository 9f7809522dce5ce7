//! Panels: a lattice of cells in space, and the flat pattern that comes nearest to it.

use mesh_core::generate::{Diagonal, GenerateError, Lattice, Sheet};
use mesh_core::{Material2, World3};

/// Sweeps of the flattening.
const SWEEPS: usize = 600;

/// A panel whose vertex in column i and row j is at `world(i, j)` (m). Columns run to the right and
/// rows up as seen from outside.
pub(super) fn panel(
    lattice: &Lattice,
    world: impl Fn(usize, usize) -> World3,
) -> Result<Sheet, GenerateError> {
    let [nx, ny] = lattice.cells;
    let x: Vec<Vec<World3>> =
        (0..=ny).map(|j| (0..=nx).map(|i| world(i, j)).collect()).collect();
    let flat = flattened(&x);
    lattice.sheet(Diagonal::Alternating, |i, j| flat[j][i], |i, j| x[j][i])
}

/// Positions in the plane at which the edges and the diagonals of all cells are as long as in space,
/// as nearly as Gauss–Seidel sweeps over them bring it: every sweep moves the ends of each edge to its
/// length (Provot1995). The start has rows and
/// columns in full length.
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
    let mut edges = Vec::new();
    for j in 0..=ny {
        for i in 0..=nx {
            let mut edge = |(k, l): (usize, usize), (p, q): (usize, usize)| {
                edges.push(([l, k], [q, p], (x[l][k] - x[q][p]).norm()));
            };
            if i < nx {
                edge((i, j), (i + 1, j));
            }
            if j < ny {
                edge((i, j), (i, j + 1));
            }
            if i < nx && j < ny {
                edge((i, j), (i + 1, j + 1));
                edge((i + 1, j), (i, j + 1));
            }
        }
    }
    for sweep in 0..SWEEPS {
        // To and fro, so that no side is preferred.
        let mut relax = |&([l, k], [q, p], length): &([usize; 2], [usize; 2], f64)| {
            let way = u[q][p] - u[l][k];
            let now = way.norm().max(1e-12);
            let step = way * (0.5 * (now - length) / now);
            u[l][k] += step;
            u[q][p] -= step;
        };
        if sweep % 2 == 0 { edges.iter().for_each(&mut relax) } else { edges.iter().rev().for_each(relax) }
    }
    u
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
