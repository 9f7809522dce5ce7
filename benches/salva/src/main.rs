//! Particle-steps per CPU second of the dam break of `sph::scenes::dam_break`, made by salva3d: DFSPH
//! in single precision, steps of 1 ms, walls of one layer of particles, on one thread.
//!
//! `cargo run --release -- [layers] [steps]`: 20 layers are 5,120 particles. Lines that begin with
//! `figure` are for programs.

use nalgebra::Vector3;
use salva3d::LiquidWorld;
use salva3d::object::interaction_groups::InteractionGroups;
use salva3d::object::{Boundary, Fluid};
use salva3d::solver::{ArtificialViscosity, DFSPHSolver};
use std::error::Error;

/// Time step (s).
const STEP: f32 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let mut number = |default: &str| arguments.next().unwrap_or(default.into()).parse::<usize>();
    let (layers, steps) = (number("20")?, number("100")?);
    let spacing = 1.0 / layers as f32;
    let wide = (0.8 * layers as f32).round() as i32;
    let water = lattice([wide, wide, layers as i32], spacing, |_| true);
    // A basin two and a half times as long, 1.5 m high, open above.
    let size = [5 * wide / 2 + 2, wide + 2, 3 * layers as i32 / 2 + 1];
    let mut walls = lattice(size, spacing, |[i, j, k]| {
        i == 0 || j == 0 || k == 0 || i == size[0] - 1 || j == size[1] - 1
    });
    walls.iter_mut().for_each(|x| *x -= Vector3::repeat(spacing));
    let (n, n_walls) = (water.len(), walls.len());

    // The support of the kernel is two spacings, as in crates/sph.
    let solver: DFSPHSolver = DFSPHSolver::new();
    let mut world = LiquidWorld::new(solver, 0.5 * spacing, 2.0, 1.0);
    let mut fluid = Fluid::new(water, 0.5 * spacing, 1000.0, InteractionGroups::default());
    fluid.nonpressure_forces.push(Box::new(ArtificialViscosity::new(0.1, 0.02)));
    let fluid = world.add_fluid(fluid);
    world.add_boundary(Boundary::new(walls, InteractionGroups::default()));

    let before = cpu_seconds()?;
    for _ in 0..steps {
        world.step(STEP, &Vector3::new(0.0, 0.0, -9.81));
    }
    let seconds = cpu_seconds()? - before;
    let water = &world.fluids()[fluid].positions;
    let front = water.iter().map(|x| x.x).fold(0.0, f32::max);
    println!("{n} particles of fluid, {n_walls} of walls, {steps} steps, front at {front:.3} m");
    println!("figure particles {n}");
    println!("figure walls {n_walls}");
    println!("figure front {front}");
    println!("figure throughput {:e}", (n * steps) as f64 / seconds);
    Ok(())
}

/// Those points of a lattice that are wanted (m).
fn lattice(n: [i32; 3], spacing: f32, wanted: impl Fn([i32; 3]) -> bool) -> Vec<Vector3<f32>> {
    let mut points = Vec::new();
    for k in 0..n[2] {
        for j in 0..n[1] {
            for i in (0..n[0]).filter(|&i| wanted([i, j, k])) {
                points.push(Vector3::new(i as f32, j as f32, k as f32).add_scalar(0.5) * spacing);
            }
        }
    }
    points
}

/// Time of this thread on a processor (s), as Linux tells it.
fn cpu_seconds() -> Result<f64, Box<dyn Error>> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat")?;
    Ok(text.split_whitespace().next().unwrap_or("").parse::<f64>()? * 1e-9)
}
