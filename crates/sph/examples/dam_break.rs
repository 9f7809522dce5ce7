//! Particle-steps per CPU second of a dam break, neighbour search included.
//!
//! `cargo run --release -p sph --example dam_break -- [layers] [steps] [threads]`: 20 layers are 5,120
//! particles, 43 are 49,708 and 92 are 503,792. On one thread times are CPU seconds, on several those of
//! the clock on the wall. Lines that begin with `figure` are for programs.

#[path = "common/cpu_time.rs"]
mod cpu_time;

use mesh_core::par;
use sph::StepReport;
use sph::scenes;
use std::error::Error;
use std::time::Instant;

/// Parts of the run that are measured one after the other.
const PARTS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut number = |default: &str| arguments.next().unwrap_or(default.into()).parse::<usize>();
    let (layers, steps, threads) = (number("20")?, number("1500")?, number("1")?);
    let work = || run(layers, steps, threads).map_err(|error| error.to_string());
    println!("{}", par::with_threads(threads, work)??);
    Ok(())
}

/// Time on the clock that counts (s).
fn now(start: Instant, threads: usize) -> Result<f64, Box<dyn Error>> {
    if threads == 1 { cpu_time::of_this_thread() } else { Ok(start.elapsed().as_secs_f64()) }
}

/// A line for each part of the run, and the figures of all.
fn run(layers: usize, steps: usize, threads: usize) -> Result<String, Box<dyn Error>> {
    let mut fluid = scenes::dam_break(layers, 0)?.fluid;
    let (n, n_wall) = (fluid.len(), fluid.walls().n_particles());
    let mut lines = format!("{n} particles of fluid, {n_wall} of walls, double precision\n");
    let (start, mut all, mut all_s) = (Instant::now(), StepReport::default(), 0.0);
    for _ in 0..PARTS {
        let before = now(start, threads)?;
        let mut report = StepReport::default();
        for _ in 0..(steps / PARTS).max(1) {
            report.add(&fluid.step(fluid.step_bound())?);
        }
        let seconds = now(start, threads)? - before;
        lines += &format!(
            "to {:.3} s: {:.3e} particle-steps per s, {:.2} ms a step, {:.1} listed neighbours, \
             listed anew every {:.1} steps\n",
            fluid.time(),
            report.particles as f64 / seconds,
            1e3 * seconds / report.steps as f64,
            2.0 * report.density_pairs as f64 / report.particles as f64,
            report.steps as f64 / report.listings.max(1) as f64,
        );
        all.add(&report);
        all_s += seconds;
    }
    let share = |part: f64| part / all.seconds.total();
    for (name, value) in [
        ("particles", n as f64),
        ("walls", n_wall as f64),
        ("neighbours", 2.0 * all.density_pairs as f64 / all.particles as f64),
        ("throughput", all.particles as f64 / all_s),
        ("s_per_step", all_s / all.steps as f64),
        ("share.neighbours", share(all.seconds.neighbours)),
        ("share.density", share(all.seconds.density)),
        ("share.force", share(all.seconds.force)),
        ("share.motion", share(all.seconds.motion)),
    ] {
        lines += &format!("figure {name} {value:e}\n");
    }
    Ok(lines)
}
