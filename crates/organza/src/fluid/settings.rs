//! What follows from the keys of a fluid: lattices, sound, bounds.

use crate::scene::Fluid;
use crate::scene::format::{Block, EmitterFile};
use nalgebra::Vector3;
use sph::{Bounds, FluidSettings, RestraintSettings};

/// How many particles of a block fit along each axis.
pub(crate) fn lattice(block: &Block, spacing: f64) -> [usize; 3] {
    // Sizes written as decimals miss whole numbers of spacings by rounding.
    [0, 1, 2].map(|k| ((block.max[k] - block.min[k]) / spacing + 1e-6).floor().max(0.0) as usize)
}

/// Speed of sound (m/s): the one given, or ten times what a particle from the highest point has that
/// has fallen to the lowest; zero where nothing falls or moves.
pub(crate) fn sound_speed(fluid: &Fluid) -> f64 {
    if let Some(speed) = fluid.file.sound_speed_m_per_s {
        return speed;
    }
    let gravity = Vector3::from(fluid.gravity);
    let up = gravity.try_normalize(0.0).map_or_else(Vector3::zeros, |down| -down);
    let heights = |bounds: Bounds| {
        let (min, max) = (bounds.min.component_mul(&up), bounds.max.component_mul(&up));
        [min.inf(&max).sum(), min.sup(&max).sum()]
    };
    let sources = sources(fluid);
    let top = sources.iter().map(|b| heights(*b)[1]).fold(f64::NEG_INFINITY, f64::max);
    let basins: Vec<Bounds> =
        fluid.file.boxes.iter().map(|basin| bounds(basin.min, basin.max)).collect();
    let lowest = |list: &[Bounds]| list.iter().map(|b| heights(*b)[0]).fold(top, f64::min);
    let bottom = match &fluid.file.domain {
        Some(domain) if basins.is_empty() => heights(bounds(domain.min, domain.max))[0].min(top),
        _ => lowest(&basins).min(lowest(&sources)),
    };
    let starts = fluid.file.blocks.iter().map(|block| Vector3::from(block.velocity).norm());
    let jets = fluid.file.emitters.iter().map(|emitter| emitter.speed_m_per_s);
    let start = starts.chain(jets).fold(0.0, f64::max);
    10.0 * (start * start + 2.0 * gravity.norm() * (top - bottom)).sqrt()
}

/// Boxes around blocks and nozzles (m).
fn sources(fluid: &Fluid) -> Vec<Bounds> {
    let blocks = fluid.file.blocks.iter().map(|block| bounds(block.min, block.max));
    let nozzle = |emitter: &EmitterFile| {
        let middle = Vector3::from(emitter.position);
        Bounds::new(middle, middle).grown(emitter.size_m[0].hypot(emitter.size_m[1]))
    };
    blocks.chain(fluid.file.emitters.iter().map(nozzle)).collect()
}

/// Where particles may be; `walls` are the boxes around the obstacles that the fluid meets (m).
fn domain(fluid: &Fluid, walls: &[Bounds]) -> Bounds {
    if let Some(domain) = &fluid.file.domain {
        return bounds(domain.min, domain.max);
    }
    let basins = fluid.file.boxes.iter().map(|basin| bounds(basin.min, basin.max));
    let sinks = fluid.file.sinks.iter().map(|sink| bounds(sink.min, sink.max));
    let mut all =
        sources(fluid).into_iter().chain(basins).chain(sinks).chain(walls.iter().copied());
    let first = all.next().unwrap_or_else(|| bounds([0.0; 3], [1.0; 3]));
    let around = all.fold(first, |a, b| Bounds::new(a.min.inf(&b.min), a.max.sup(&b.max)));
    around.grown(around.size().max())
}

/// The settings of a fluid; `walls` are the boxes around the obstacles that it meets (m).
pub(crate) fn fluid(fluid: &Fluid, walls: &[Bounds]) -> FluidSettings {
    FluidSettings {
        spacing: fluid.file.spacing_m,
        rest_density: fluid.file.density_kg_per_m3,
        sound_speed: sound_speed(fluid),
        viscosity: fluid.file.viscosity,
        wall_viscosity: fluid.file.wall_viscosity,
        gravity: Vector3::from(fluid.gravity),
        domain: domain(fluid, walls),
        skin: fluid.file.skin,
        courant: fluid.file.courant,
    }
}

/// The settings of its restraint.
pub(crate) fn restraint(
    restraint: &crate::scene::format::FluidRestraint,
    settings: &FluidSettings,
) -> RestraintSettings {
    let usual = RestraintSettings::of(settings);
    RestraintSettings {
        bleeding: restraint.bleeding_s,
        inactivity: restraint.inactivity_m_per_s,
        pressure_tolerance: restraint.pressure_tolerance_pa.unwrap_or(usual.pressure_tolerance),
        sweep_above: restraint.sweep_above,
        force_interval: restraint.force_interval,
    }
}

pub(crate) fn bounds(min: [f64; 3], max: [f64; 3]) -> Bounds {
    Bounds::new(Vector3::from(min), Vector3::from(max))
}
