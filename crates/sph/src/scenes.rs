//! Scenes to measure with, at any resolution and in variants that differ by less than one can see.

use crate::fluid::Fluid;
use crate::settings::{Bounds, FluidError, FluidSettings};
use crate::source::{Emitter, Sink};
use crate::walls::{Open, Walls};
use nalgebra::Vector3;

/// A fluid and how long to watch it.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The fluid at its start.
    pub fluid: Fluid,
    /// Time that the scene is meant to run for (s).
    pub duration: f64,
}

/// How far particles are moved from their lattice, in spacings (1).
const JITTER: f64 = 1e-3;

/// A block of particles on a lattice, from a corner (m) on, moved a little by a seed. Seed 0 leaves
/// them where they are.
pub fn block(n: [usize; 3], corner: Vector3<f64>, spacing: f64, seed: u64) -> Vec<Vector3<f64>> {
    let mut random = seed;
    let mut offset = || {
        // SplitMix64 (Steele2014): a variant needs numbers that differ, no more.
        random = random.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = random;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) as f64 / u64::MAX as f64 - 0.5)
            * if seed == 0 { 0.0 } else { 2.0 * JITTER }
    };
    let mut x = Vec::with_capacity(n[0] * n[1] * n[2]);
    for k in 0..n[2] {
        for j in 0..n[1] {
            for i in 0..n[0] {
                let at = Vector3::new(i as f64, j as f64, k as f64).add_scalar(0.5);
                x.push(corner + (at + Vector3::new(offset(), offset(), offset())) * spacing);
            }
        }
    }
    x
}

/// Brings the layers of a block of still fluid as close as the weight of those above presses them, so that
/// sound does not go up and down in it from the start on. `bounds` is the block without weight (m), of which the
/// lowest layer stays where it is.
///
/// At the height s in the block without weight the pressure is ρ₀ g (H − s); by Tait's equation the height
/// with weight is z with dz/ds = ρ₀/ρ = (1 + 7 g (H − s)/c²)^(−1/7).
pub fn press(positions: &mut [Vector3<f64>], settings: &FluidSettings, bounds: &Bounds) {
    let g = settings.gravity.norm();
    let Some(down) = settings.gravity.try_normalize(0.0) else { return };
    let (low, high) = (bounds.min.component_mul(&down), bounds.max.component_mul(&down));
    let (top, bottom) = (low.inf(&high).sum(), low.sup(&high).sum());
    let c_squared = settings.sound_speed * settings.sound_speed;
    // −∫ dz/ds over the depth.
    let below =
        |depth: f64| c_squared / (6.0 * g) * (1.0 + 7.0 * g * depth / c_squared).powf(6.0 / 7.0);
    for x in positions {
        let depth = x.dot(&down) - top;
        let height = below(bottom - top) - below(depth);
        *x -= down * (height - (bottom - top - depth));
    }
}

fn at_rest(
    settings: FluidSettings,
    walls: Walls,
    positions: &[Vector3<f64>],
) -> Result<Fluid, FluidError> {
    Fluid::new(settings, walls, positions, &vec![Vector3::zeros(); positions.len()])
}

/// Manteaux2013 Fig. 1: a column of water, 1 m high and 0.8 m wide and deep, breaks down in a basin two
/// and a half times as long. `layers` of particles make the height: 20 for 5,120 particles, 43 for
/// 49,708, 92 for 503,792.
///
/// # Errors
/// If there are no layers or too many.
pub fn dam_break(layers: usize, seed: u64) -> Result<Scene, FluidError> {
    let spacing = 1.0 / layers as f64;
    let n = (0.8 * layers as f64).round() as usize;
    let width = n as f64 * spacing;
    let basin = Bounds::new(Vector3::zeros(), Vector3::new(2.5 * width, width, 1.5));
    let mut walls = Walls::none();
    walls.add_box(&basin, Open::TOP, spacing)?;
    let settings = FluidSettings::water(spacing, 1.0, basin.grown(4.0));
    let positions = block([n, n, layers], Vector3::zeros(), spacing, seed);
    Ok(Scene { fluid: at_rest(settings, walls, &positions)?, duration: 5.0 })
}

/// Manteaux2013 Table 1: a block of water falls into a closed box and comes to rest, 15 s. 5,120
/// particles for 20 `layers`.
///
/// # Errors
/// If there are no layers or too many.
pub fn block_fall(layers: usize, seed: u64) -> Result<Scene, FluidError> {
    let spacing = 1.0 / layers as f64;
    let n = (0.8 * layers as f64).round() as usize;
    let width = n as f64 * spacing;
    let side = (1.2 * layers as f64).round() * spacing;
    let inside = Bounds::new(Vector3::zeros(), Vector3::new(side, side, 2.0));
    let mut walls = Walls::none();
    walls.add_box(&inside, Open::default(), spacing)?;
    let settings = FluidSettings::water(spacing, 1.4, inside.grown(0.2));
    let corner = Vector3::new(0.5 * (side - width), 0.5 * (side - width), 0.4);
    let positions = block([n, n, layers], corner, spacing, seed);
    Ok(Scene { fluid: at_rest(settings, walls, &positions)?, duration: 15.0 })
}

/// Manteaux2013 Table 2: water pours into one end of a full shaft, 0.7 m long and 1.5 m deep, and is
/// skimmed off at the other, 30 s, about 4,240 particles. Deep below the current the water rests, from the
/// start on.
///
/// # Errors
/// None but for mistakes in the scene itself.
pub fn permanent_flow(seed: u64) -> Result<Scene, FluidError> {
    let spacing = 0.05;
    let n = [14, 10, 30];
    let size = n.map(|n| n as f64 * spacing);
    let inside = Bounds::new(Vector3::zeros(), Vector3::new(size[0], size[1], 2.2));
    let mut walls = Walls::none();
    walls.add_box(&inside, Open::default(), spacing)?;
    // Nothing falls far: what counts is that water at the bottom is denser by no more than 1 %.
    let settings = FluidSettings {
        sound_speed: 40.0,
        ..FluidSettings::water(spacing, size[2], inside.grown(0.2))
    };
    let mut positions = block(n, Vector3::zeros(), spacing, seed);
    let block = Bounds::new(Vector3::zeros(), Vector3::from(size));
    press(&mut positions, &settings, &block);
    let mut fluid = at_rest(settings, walls, &positions)?;
    let nozzle = Vector3::new(2.0 * spacing, 0.5 * size[1], size[2] + 2.0 * spacing);
    fluid.add_emitter(Emitter::new(nozzle, Vector3::x(), [2.0 * spacing, spacing], 0.5)?)?;
    // The skimmer takes what stands higher than the trough was full.
    let low = Vector3::new(size[0] - 3.0 * spacing, 0.0, size[2]);
    fluid.add_sink(Sink(Bounds::new(low, inside.max.add_scalar(0.1))));
    Ok(Scene { fluid, duration: 30.0 })
}
