//! Small fluids for the tests.
#![allow(dead_code)]

use nalgebra::Vector3;
use sph::{Bounds, Fluid, FluidSettings, Open, Walls, scenes};

/// Particle spacing (m).
pub(crate) const SPACING: f64 = 0.05;

/// A box from the origin on with edges of `n` spacings.
pub(crate) fn tank(n: [usize; 3]) -> Bounds {
    let size = n.map(|n| n as f64 * SPACING);
    Bounds::new(Vector3::zeros(), Vector3::from(size))
}

/// A block of particles in the corner of a closed box, both in spacings.
pub(crate) fn block_in_box(block: [usize; 3], inside: [usize; 3], seed: u64) -> Fluid {
    let inside = tank(inside);
    let mut walls = Walls::none();
    walls.add_box(&inside, Open::default(), SPACING).unwrap();
    let height = block[2] as f64 * SPACING;
    let settings = FluidSettings::water(SPACING, height, inside.grown(SPACING));
    let x = scenes::block(block, Vector3::zeros(), SPACING, seed);
    Fluid::new(settings, walls, &x, &vec![Vector3::zeros(); x.len()]).unwrap()
}

/// A ball of particles with random velocities, without walls and gravity.
pub(crate) fn free_ball(seed: u64) -> Fluid {
    let room = Bounds::new(Vector3::repeat(-10.0), Vector3::repeat(10.0));
    let settings =
        FluidSettings { gravity: Vector3::zeros(), ..FluidSettings::water(SPACING, 1.0, room) };
    let corner = Vector3::repeat(-4.0 * SPACING);
    let mut x = scenes::block([8, 8, 8], corner, SPACING, seed);
    x.retain(|x| x.norm() < 4.0 * SPACING);
    // A squeeze along one axis and a spin.
    let v: Vec<_> =
        x.iter().map(|x| Vector3::new(-3.0 * x.x - 2.0 * x.y, 2.0 * x.x, 0.3)).collect();
    Fluid::new(settings, Walls::none(), &x, &v).unwrap()
}

/// Positions, velocities, densities and accelerations as bits, by particle number.
pub(crate) fn bits<R: arps::Restraint>(fluid: &Fluid<R>) -> Vec<[u64; 11]> {
    let mut rows: Vec<(u64, [u64; 11])> = fluid
        .particles()
        .zip(fluid.accelerations())
        .map(|(p, a)| {
            let vectors = [p.position, p.velocity, a].map(|v| [v.x, v.y, v.z]).concat();
            let mut row = [0; 11];
            for (slot, number) in
                row.iter_mut().zip(vectors.into_iter().chain([p.density, p.pressure]))
            {
                *slot = number.to_bits();
            }
            (p.id, row)
        })
        .collect();
    rows.sort_unstable();
    rows.into_iter().map(|(_, row)| row).collect()
}
