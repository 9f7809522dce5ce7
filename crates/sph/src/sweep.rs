//! The full sweeps over all particles: densities, then accelerations.
//!
//! Each particle's sums run over its own list in a fixed order and lanes, so results do not depend on
//! the number of threads nor on the width of the processor's registers.

use crate::grid::Point;
use crate::kernel::CubicSpline;
use crate::neighbours::{BLOCK, Block, LANES, Neighbours};
use crate::pair::{Laws, Side};
use crate::walls::Walls;
use mesh_core::par;

type Lanes = [f64; LANES];

/// Densities (kg/m³) of all particles, into `density`; finds the neighbours within the support.
pub(crate) fn densities(
    laws: &Laws,
    x: &[Point],
    walls: &Walls,
    neighbours: &mut Neighbours,
    density: &mut [f64],
) {
    let arch = pulp::Arch::new();
    par::blocks(&mut neighbours.blocks, density, BLOCK, |b, block, part| {
        arch.dispatch(
            #[inline(always)]
            || densities_of_block(laws, x, walls.points(), b * BLOCK, block, part),
        );
    });
}

#[inline(always)]
fn densities_of_block(
    laws: &Laws,
    x: &[Point],
    walls: &[Point],
    first: usize,
    block: &mut Block,
    density: &mut [f64],
) {
    let kernel = &laws.kernel;
    let support_squared = kernel.support() * kernel.support();
    let at_zero = kernel.value(0.0);
    for (k, slot) in density.iter_mut().enumerate() {
        let i = first + k;
        let p = &x[i];
        let (_, weights) = block.fluid.activate(k, p, x, support_squared, i as u32);
        let fluid = weigh(kernel, weights);
        let (active, weights) = block.wall.activate(k, p, walls, support_squared, 0);
        let wall = if active.is_empty() { 0.0 } else { weigh_by_mass(kernel, walls, active, weights) };
        *slot = laws.mass * (at_zero + fluid) + wall;
    }
}

/// Σ W over squared distances, which become F.
#[inline(always)]
fn weigh(kernel: &CubicSpline, weights: &mut [f64]) -> f64 {
    let mut sum: Lanes = [0.0; LANES];
    for chunk in weights.chunks_exact_mut(LANES) {
        for l in 0..LANES {
            let (value, slope) = kernel.value_and_slope(chunk[l]);
            sum[l] += value;
            chunk[l] = slope;
        }
    }
    total(&sum)
}

/// The same with each W multiplied by the mass of its wall particle.
#[inline(always)]
fn weigh_by_mass(kernel: &CubicSpline, walls: &[Point], active: &[u32], weights: &mut [f64]) -> f64 {
    let mut sum: Lanes = [0.0; LANES];
    for (chunk, at) in weights.chunks_exact_mut(LANES).zip(active.chunks_exact(LANES)) {
        for l in 0..LANES {
            let (value, slope) = kernel.value_and_slope(chunk[l]);
            sum[l] += value * walls[at[l] as usize][3];
            chunk[l] = slope;
        }
    }
    total(&sum)
}

#[inline(always)]
fn total(sum: &Lanes) -> f64 {
    (sum[0] + sum[1]) + (sum[2] + sum[3])
}

/// Accelerations by pressure and viscosity (m/s²), without gravity, into `a`.
///
/// `x` carries P = p/ρ² and `w`, the effective velocities, carry ρ.
pub(crate) fn accelerations(
    laws: &Laws,
    x: &[Point],
    w: &[Point],
    walls: &Walls,
    neighbours: &mut Neighbours,
    a: &mut [Point],
) {
    let arch = pulp::Arch::new();
    par::blocks(&mut neighbours.blocks, a, BLOCK, |b, block, part| {
        arch.dispatch(
            #[inline(always)]
            || accelerations_of_block(laws, x, w, walls.points(), b * BLOCK, block, part),
        );
    });
}

#[inline(always)]
fn accelerations_of_block(
    laws: &Laws,
    x: &[Point],
    w: &[Point],
    walls: &[Point],
    first: usize,
    block: &Block,
    a: &mut [Point],
) {
    for (k, slot) in a.iter_mut().enumerate() {
        let i = first + k;
        let here = Side::new(&x[i], &w[i]);
        let mut sum: [Lanes; 3] = [[0.0; LANES]; 3];
        let (active, slopes) = block.fluid.active(k);
        for (at, f) in active.chunks_exact(LANES).zip(slopes.chunks_exact(LANES)) {
            let mut xs: [Lanes; 4] = [[0.0; LANES]; 4];
            let mut ws: [Lanes; 4] = [[0.0; LANES]; 4];
            for l in 0..LANES {
                let (x, w) = (&x[at[l] as usize], &w[at[l] as usize]);
                for c in 0..4 {
                    xs[c][l] = x[c];
                    ws[c][l] = w[c];
                }
            }
            for l in 0..LANES {
                let there = Side {
                    x: [xs[0][l], xs[1][l], xs[2][l]],
                    w: [ws[0][l], ws[1][l], ws[2][l]],
                    pressure_term: xs[3][l],
                    density: ws[3][l],
                };
                let by = laws.between(&here, &there, f[l]);
                for c in 0..3 {
                    sum[c][l] += by[c];
                }
            }
        }
        let mut acceleration = [total(&sum[0]), total(&sum[1]), total(&sum[2]), 0.0];
        let (active, slopes) = block.wall.active(k);
        for (&at, &f) in active.iter().zip(slopes) {
            let by = laws.by_wall(&here, &walls[at as usize], f);
            for c in 0..3 {
                acceleration[c] += by[c];
            }
        }
        *slot = acceleration;
    }
}
