use organza::{report::FrameReport, scene, world::World};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let sets: Vec<String> = args[3..].to_vec();
    let loaded = scene::load(args[1].as_ref(), &scene::LoadOptions { sets, allow_unsupported: true }).unwrap_or_else(|e| panic!("{e}"));
    let mut world = World::new(&loaded).unwrap_or_else(|e| panic!("{e}"));
    for w in &world.warnings { println!("warning {w}"); }
    println!("{:?}", world.force_names());
    let n: u32 = args[2].parse().unwrap();
    let mut total = 0.0;
    for _ in 0..n {
        let r: FrameReport = world.advance().unwrap_or_else(|e| panic!("{e}"));
        total += r.seconds.total;
        let c: nalgebra::Vector3<f64> = world.cloth.x.iter().zip(&world.cloth.m).map(|(x, m)| x * *m).sum::<nalgebra::Vector3<f64>>() / world.cloth.total_mass();
        let vmax = world.cloth.v.iter().map(|v| v.norm()).fold(0.0, f64::max);
        let s = r.stretch.unwrap();
        println!("{:3} f {:6} it {:3} un {:2} res {:.1e} cg {:4} fac {:3} ha {:2} re {} str {:.3} {:.3} com {:.3} {:.3} {:.3} vmax {:.2} asp {:.2} ed {:?} t {:.3} (build {:.3} as {:.3} lin {:.3} en {:.3} rem {:.3}) tot {:.2}",
            r.frame, r.faces, r.newton_iterations, r.unconverged_stages, r.residual_m_per_s, r.linear_iterations, r.factorisations, r.halvings, r.retries, s.min, s.max, c.x, c.y, c.z, vmax,
            r.remesh.map_or(0.0, |m| m.min_aspect), r.remesh.map(|m| (m.splits, m.flips, m.collapses)).unwrap_or_default(),
            r.seconds.total, r.seconds.build, r.seconds.assembly, r.seconds.linear, r.seconds.energy, r.seconds.remesh, total);
    }
}
