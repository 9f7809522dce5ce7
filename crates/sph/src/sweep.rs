//! The sweeps over all particles, or over those that are marked: densities, then accelerations.
//!
//! Each particle's sums run over its own list in a fixed order and lanes, so results do not depend on
//! the number of threads nor on the width of the processor's registers.

use crate::grid::Point;
use crate::kernel::CubicSpline;
use crate::lanes::{self, Four, LANES};
use crate::lists::Lists;
use crate::neighbours::{BLOCK, Block, Neighbours};
use crate::pair::{Laws, Side, transpose};
use crate::walls::WallState;
use mesh_core::par;
use pulp::{Simd, WithSimd};

/// The particles to look at: those whose mark has one of some bits.
#[derive(Clone, Copy)]
pub(crate) struct Marked<'a> {
    pub(crate) marks: &'a [u8],
    pub(crate) bits: u8,
}

impl Marked<'_> {
    #[inline(always)]
    fn has(&self, i: usize) -> bool {
        self.marks[i] & self.bits != 0
    }

    /// True if any of `n` particles from `first` on has a mark.
    #[inline(always)]
    fn any(&self, first: usize, n: usize) -> bool {
        let all = self.marks[first..first + n].iter().fold(0, |all, mark| all | mark);
        all & self.bits != 0
    }
}

/// Densities (kg/m³) of the particles of the fluid, into `density`; finds the neighbours within the
/// support. `only` are the particles to look at, if not all.
pub(crate) fn densities(
    laws: &Laws,
    x: &[Point],
    walls: &WallState,
    neighbours: &mut Neighbours,
    density: &mut [f64],
    only: Option<Marked<'_>>,
) {
    par::blocks(&mut neighbours.blocks, density, BLOCK, |b, block, density| {
        let first = b * BLOCK;
        lanes::run(Densities { laws, x, walls, first, block, density, only });
    });
}

/// The same for the walls that fluid touches.
pub(crate) fn wall_densities(
    laws: &Laws,
    x: &[Point],
    walls: &mut WallState,
    neighbours: &mut Neighbours,
    only: Option<Marked<'_>>,
) {
    let WallState { x: places, own, density, .. } = walls;
    par::blocks(&mut neighbours.wall_blocks, density, BLOCK, |b, lists, density| {
        lanes::run(WallDensities { laws, x, places, own, first: b * BLOCK, lists, density, only });
    });
}

/// The densities of a block of particles of the walls.
struct WallDensities<'a> {
    laws: &'a Laws,
    x: &'a [Point],
    places: &'a [Point],
    own: &'a [f64],
    first: usize,
    lists: &'a mut Lists,
    density: &'a mut [f64],
    only: Option<Marked<'a>>,
}

impl WithSimd for WallDensities<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        if self.only.is_some_and(|only| !only.any(self.first, self.density.len())) {
            return;
        }
        let kernel = &self.laws.kernel;
        let support_squared = kernel.support() * kernel.support();
        for (k, slot) in self.density.iter_mut().enumerate() {
            let i = self.first + k;
            if self.only.is_some_and(|only| !only.has(i)) {
                continue;
            }
            let (_, weights) =
                self.lists.activate(simd, k, &self.places[i], self.x, (support_squared, 0));
            let mut fluid = Four::splat(simd, 0.0);
            for four in weights.chunks_exact_mut(LANES) {
                fluid = fluid + weigh(simd, kernel, four);
            }
            *slot = self.own[i] + self.laws.mass * fluid.total();
        }
    }
}

/// The densities of a block. A type of its own and not a closure, since only this is compiled for the
/// registers of the processor at hand.
struct Densities<'a> {
    laws: &'a Laws,
    x: &'a [Point],
    walls: &'a WallState,
    first: usize,
    block: &'a mut Block,
    density: &'a mut [f64],
    only: Option<Marked<'a>>,
}

impl WithSimd for Densities<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        if self.only.is_none_or(|only| only.any(self.first, self.density.len())) {
            densities_of_block(simd, self);
        }
    }
}

#[inline(always)]
fn densities_of_block<S: Simd>(simd: S, task: Densities<'_>) {
    let Densities { laws, x, walls, first, block, density, only } = task;
    let kernel = &laws.kernel;
    let support_squared = kernel.support() * kernel.support();
    let at_zero = kernel.value(0.0);
    for (k, slot) in density.iter_mut().enumerate() {
        if only.is_some_and(|only| !only.has(first + k)) {
            continue;
        }
        let p = &x[first + k];
        let (_, weights) =
            block.fluid.activate(simd, k, p, x, (support_squared, (first + k) as u32));
        let mut fluid = Four::splat(simd, 0.0);
        for four in weights.chunks_exact_mut(LANES) {
            fluid = fluid + weigh(simd, kernel, four);
        }
        let (active, weights) = block.wall.activate(simd, k, p, &walls.x, (support_squared, 0));
        let mut wall = Four::splat(simd, 0.0);
        for (four, at) in weights.chunks_exact_mut(LANES).zip(active.chunks_exact(LANES)) {
            wall = wall + weigh(simd, kernel, four) * numbers(simd, &walls.mass, at);
        }
        *slot = laws.mass * (at_zero + fluid.total()) + wall.total();
        block.is_fresh[k] = true;
    }
}

/// W at four squared distances, which become F.
#[inline(always)]
fn weigh<S: Simd>(simd: S, kernel: &CubicSpline, four: &mut [f64]) -> Four<S> {
    let squared = Four::new(simd, [four[0], four[1], four[2], four[3]]);
    let (value, slope) = kernel.value_and_slope(squared);
    four.copy_from_slice(&slope.array());
    value
}

/// F in the place of squared distances, a multiple of `LANES`.
#[inline(always)]
fn slopes<S: Simd>(simd: S, kernel: &CubicSpline, r_squared: &mut [f64]) {
    for four in r_squared.chunks_exact_mut(LANES) {
        weigh(simd, kernel, four);
    }
}

#[inline(always)]
fn points<'a>(list: &'a [Point], at: &[u32]) -> [&'a Point; LANES] {
    [0, 1, 2, 3].map(|l| &list[at[l] as usize])
}

#[inline(always)]
fn numbers<S: Simd>(simd: S, list: &[f64], at: &[u32]) -> Four<S> {
    Four::new(simd, [0, 1, 2, 3].map(|l| list[at[l] as usize]))
}

/// Accelerations by pressure, viscosity and gravity (m/s²), into `a`.
///
/// The active candidates of particles for which they are not those of these positions are found first.
/// `x` and the positions of `walls` carry P = p/ρ², and `w`, the effective velocities, carry ρ.
pub(crate) fn accelerations(
    laws: &Laws,
    x: &[Point],
    w: &[Point],
    walls: &WallState,
    neighbours: &mut Neighbours,
    (gravity, only): ([f64; 3], Option<Marked<'_>>),
    a: &mut [Point],
) {
    par::blocks(&mut neighbours.blocks, a, BLOCK, |b, block, a| {
        let first = b * BLOCK;
        lanes::run(Accelerations { laws, x, w, walls, first, block, gravity, only, a });
    });
}

/// The accelerations of a block.
struct Accelerations<'a> {
    laws: &'a Laws,
    x: &'a [Point],
    w: &'a [Point],
    walls: &'a WallState,
    first: usize,
    block: &'a mut Block,
    gravity: [f64; 3],
    only: Option<Marked<'a>>,
    a: &'a mut [Point],
}

impl WithSimd for Accelerations<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        if self.only.is_none_or(|only| only.any(self.first, self.a.len())) {
            accelerations_of_block(simd, self);
        }
    }
}

#[inline(always)]
fn accelerations_of_block<S: Simd>(simd: S, task: Accelerations<'_>) {
    let Accelerations { laws, x, w, walls, first, block, gravity, only, a } = task;
    let support_squared = laws.kernel.support() * laws.kernel.support();
    for (k, slot) in a.iter_mut().enumerate() {
        if only.is_some_and(|only| !only.has(first + k)) {
            continue;
        }
        if !block.is_fresh[k] {
            let p = &x[first + k];
            let (_, r) = block.fluid.activate(simd, k, p, x, (support_squared, (first + k) as u32));
            slopes(simd, &laws.kernel, r);
            let (_, r) = block.wall.activate(simd, k, p, &walls.x, (support_squared, 0));
            slopes(simd, &laws.kernel, r);
            block.is_fresh[k] = true;
        }
        let here = Side::splat(simd, &x[first + k], &w[first + k]);
        let mut sum = [Four::splat(simd, 0.0); 3];
        let (active, slopes) = block.fluid.active(k);
        for (at, f) in active.chunks_exact(LANES).zip(slopes.chunks_exact(LANES)) {
            let there = Side::gather(simd, points(x, at), points(w, at));
            let slope = Four::new(simd, [f[0], f[1], f[2], f[3]]);
            let by = laws.between(&here, &there, slope);
            sum = [sum[0] + by[0], sum[1] + by[1], sum[2] + by[2]];
        }
        let (active, slopes) = block.wall.active(k);
        for (at, f) in active.chunks_exact(LANES).zip(slopes.chunks_exact(LANES)) {
            let [x0, x1, x2, term] = transpose(simd, points(&walls.x, at));
            let mass = numbers(simd, &walls.mass, at);
            let slope = Four::new(simd, [f[0], f[1], f[2], f[3]]);
            let by = laws.by_wall(&here, &[x0, x1, x2], term, mass, slope);
            sum = [sum[0] + by[0], sum[1] + by[1], sum[2] + by[2]];
        }
        let [gx, gy, gz] = gravity;
        *slot = [sum[0].total() + gx, sum[1].total() + gy, sum[2].total() + gz, 0.0];
    }
}
