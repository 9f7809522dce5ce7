//! A closed box of splashing water for a million steps: none of it may get out.
//!
//! `cargo run --release -p sph --example closed_box -- [steps]`. A new splash begins whenever the water
//! has calmed down: gravity turns over.

use nalgebra::Vector3;
use sph::{Bounds, Fluid, FluidSettings, Open, Walls, scenes};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let steps: u64 = std::env::args().nth(1).unwrap_or("1000000".into()).parse()?;
    let spacing = 0.05;
    let inside = Bounds::new(Vector3::zeros(), Vector3::new(0.4, 0.3, 0.5));
    let mut x = scenes::block([4, 6, 6], Vector3::zeros(), spacing, 1);
    let mut v = vec![Vector3::zeros(); x.len()];
    let mut down = -9.81;
    let mut done = 0;
    let mut farthest: f64 = 0.0;
    while done < steps {
        let mut walls = Walls::none();
        walls.add_box(&inside, Open::default(), spacing)?;
        let settings = FluidSettings {
            gravity: Vector3::new(0.0, 0.0, down),
            ..FluidSettings::water(spacing, 0.5, inside.grown(0.5 * spacing))
        };
        let mut fluid = Fluid::new(settings, walls, &x, &v)?;
        for _ in 0..10_000.min(steps - done) {
            fluid.step(fluid.step_bound())?;
            done += 1;
        }
        for p in fluid.particles() {
            let out = (p.position - inside.max).max().max((inside.min - p.position).max());
            farthest = farthest.max(out / spacing);
        }
        x = fluid.particles().map(|p| p.position).collect();
        v = fluid.particles().map(|p| p.velocity).collect();
        down = -down;
    }
    println!("{done} steps, {} particles, none more than {farthest:.3} spacings out", x.len());
    Ok(())
}
