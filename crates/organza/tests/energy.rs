//! Energy of steps that are far too long for what happens in them: cloth that falls on things gains none.

use organza::scene::{LoadOptions, from_sources, parse};
use organza::world::World;

/// A sheet that falls on a ball and then on a table, in steps as long as frames.
fn drape(frames_per_second: u32, integrator: &str) -> World {
    let text = format!(
        "{{ frames: 20, frames_per_second: {frames_per_second}, substeps: 1,
            integrator: '{integrator}',
            cloths: [{{ mesh: {{ grid: {{ size_m: [0.8, 0.8], cells: [16, 16] }} }},
                fabric: 'woven-light', transform: {{ translate: [-0.4, -0.37, 0.21] }} }}],
            obstacles: [
                {{ mesh: {{ sphere: {{ radius_m: 0.2, detail: 3 }} }} }},
                {{ mesh: {{ plane: {{ size_m: [3, 3] }} }},
                   transform: {{ translate: [0, 0, -0.22] }} }},
            ],
            contact: {{}} }}"
    );
    World::new(&parse(&text, "s", &LoadOptions::default(), &from_sources(&[])).unwrap()).unwrap()
}

#[test]
fn cloth_that_falls_on_things_gains_no_energy() {
    for (per_second, frames) in [(25, 20), (10, 12)] {
        for integrator in ["sdirk2", "implicit-euler"] {
            let mut world = drape(per_second, integrator);
            // What contact stores by the weight of all of the cloth: a step that is made in halves has
            // stiffer contacts, which lift what lies on them.
            let weight = 9.81 * world.cloth.m.iter().sum::<f64>();
            let lift = weight * world.contact.unwrap().thickness;
            let (mut last, mut n_bent) = (f64::INFINITY, 0);
            for frame in 1..=frames {
                let report = world.advance().unwrap();
                let energy = report.kinetic_energy_j + report.potential_energy_j.unwrap();
                let (rise, rounding) = (energy - last, 1e-9 * energy.abs());
                println!("1/{per_second} s, {integrator}, {frame}: {energy} J, {rise:e} J more");
                let allowed = if report.retries > 0 { lift } else { 0.0 };
                assert!(rise <= allowed + rounding, "1/{per_second} s, {integrator}, {frame}");
                (last, n_bent) = (energy, n_bent + report.shortened_ways);
            }
            assert!(n_bent > 0);
        }
    }
}
