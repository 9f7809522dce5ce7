//! Particle-steps per CPU second of the dam break.

use nalgebra::Vector3;
use sph::*;

fn cpu() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap();
    let (_, rest) = stat.rsplit_once(')').unwrap();
    let mut f = rest.split_whitespace().skip(11);
    let mut n = || f.next().unwrap().parse::<f64>().unwrap();
    (n() + n()) / 100.0
}

fn main() {
    let n: Vec<usize> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    let (nx, ny, nz, steps) = (n[0], n[1], n[2], n[3]);
    let d = 1.0 / nz as f64;
    let mut x = Vec::new();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                x.push(Vector3::new(i as f64 + 0.5, j as f64 + 0.5, k as f64 + 0.5) * d);
            }
        }
    }
    let tank = Bounds::new(Vector3::zeros(), Vector3::new(2.5 * nx as f64 * d, ny as f64 * d, 1.5));
    let mut walls = Walls::none();
    walls.add_box(&tank, Open::TOP, d).unwrap();
    let mut settings = FluidSettings::water(d, 1.0, tank.grown(3.0));
    if let Some(skin) = n.get(4) { settings.skin = *skin as f64 / 100.0; }
    let v = vec![Vector3::zeros(); x.len()];
    let mut fluid = Fluid::new(settings, walls, &x, &v).unwrap();
    println!("{} fluid, {} wall", fluid.len(), fluid.walls().n_particles());
    for _ in 0..5 {
        let t = cpu();
        let mut r = StepReport::default();
        for _ in 0..steps {
            r.add(&fluid.step(fluid.step_bound()).unwrap());
        }
        let t = cpu() - t;
        println!("t {:.3} s, {:.3} M particle-steps/s, {:.2} ms/step, pairs/particle {:.1}, listings per step {:.3}, E {:?}", fluid.time(), r.particles as f64 / t / 1e6, t / steps as f64 * 1e3, 2.0 * r.density_pairs as f64 / r.particles as f64, r.listings as f64 / r.steps as f64, fluid.energy());
    }
}
