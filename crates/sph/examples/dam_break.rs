//! Particle-steps per CPU second of a dam break, neighbour search included, on one thread.
//!
//! `cargo run --release -p sph --example dam_break -- [layers] [steps]`: 20 layers are 5,120 particles,
//! 43 are 49,708 and 92 are 503,792.

#[path = "common/cpu_time.rs"]
mod cpu_time;

use mesh_core::par;
use sph::StepReport;
use sph::scenes;
use std::error::Error;

/// Parts of the run that are measured one after the other.
const PARTS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut number = |default: &str| arguments.next().unwrap_or(default.into()).parse::<usize>();
    let (layers, steps) = (number("20")?, number("1500")?);
    let lines = par::with_threads(1, || run(layers, steps).map_err(|error| error.to_string()))??;
    println!("{lines}");
    Ok(())
}

/// A line for each part of the run.
fn run(layers: usize, steps: usize) -> Result<String, Box<dyn Error>> {
    let mut fluid = scenes::dam_break(layers, 0)?.fluid;
    let (n, n_wall) = (fluid.len(), fluid.walls().n_particles());
    let mut lines = format!("{n} particles of fluid, {n_wall} of walls, double precision\n");
    for _ in 0..PARTS {
        let before = cpu_time::of_this_thread()?;
        let mut report = StepReport::default();
        for _ in 0..steps / PARTS {
            report.add(&fluid.step(fluid.step_bound())?);
        }
        let seconds = cpu_time::of_this_thread()? - before;
        lines += &format!(
            "to {:.3} s: {:.3e} particle-steps per s, {:.2} ms a step, {:.1} listed neighbours, \
             listed anew every {:.1} steps\n",
            fluid.time(),
            report.particles as f64 / seconds,
            1e3 * seconds / report.steps as f64,
            2.0 * report.density_pairs as f64 / report.particles as f64,
            report.steps as f64 / report.listings.max(1) as f64,
        );
    }
    Ok(lines)
}
