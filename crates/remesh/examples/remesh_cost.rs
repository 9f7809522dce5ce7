//! CPU time of remeshing a square metre of cloth with a travelling bump: refining it to about
//! 20,000 triangles, following the bump, and finding nothing to do.
//!
//! `cargo run --release -p remesh --example remesh_cost [THREADS]`

use mesh_core::{ClothState, World3, generate, par};
use remesh::{PhysicalSizing, RemeshReport, RemeshSettings, remesh};
use std::time::Instant;

const SIZING: PhysicalSizing = PhysicalSizing {
    refine_angle: 0.3,
    refine_velocity: 2.0,
    refine_compression: f64::INFINITY,
    size_min: 0.004,
    size_max: 0.1,
    aspect_min: 0.2,
};

/// Puts the cloth on the bump z = 2 cm · exp(−r²/2σ²)·cos(k r) around (centre, 0.5).
fn shape(cloth: &mut ClothState, centre: f64) {
    let corners: Vec<_> =
        cloth.mesh.triangles().iter().zip(cloth.mesh.material()).map(|(t, u)| (*t, *u)).collect();
    for (triangle, material) in corners {
        for (v, u) in triangle.into_iter().zip(material) {
            let r = ((u.x - centre).powi(2) + (u.y - 0.5).powi(2)).sqrt();
            let z = 0.02 * (-0.5 * (r / 0.18).powi(2)).exp() * (r * 90.0).cos();
            cloth.x[v as usize] = World3::new(u.x, u.y, z);
        }
    }
}

fn step(cloth: &mut ClothState, centre: f64) -> (f64, RemeshReport) {
    shape(cloth, centre);
    let start = Instant::now();
    let report = remesh(cloth, &SIZING, &RemeshSettings::default()).expect("settings in range");
    (start.elapsed().as_secs_f64() * 1e3, report)
}

fn print(what: &str, ms: f64, r: &RemeshReport) {
    println!(
        "{what:<28} {ms:8.2} ms  {:6} triangles  {:6} splits {:6} flips {:6} collapses  \
         aspect min {:.3} mean {:.3} below {}",
        r.quality.n_triangles,
        r.n_splits,
        r.n_flips,
        r.n_collapses,
        r.quality.aspect_min,
        r.quality.aspect_mean,
        r.quality.n_below_aspect
    );
    if std::env::var("HIST").is_ok() {
        println!("{:?}", r.quality.sizes);
    }
}

fn measure() {
    let sheet = generate::grid([1.0, 1.0], [10, 10], generate::Diagonal::Alternating)
        .expect("a valid grid");
    let mut cloth =
        ClothState::at_rest(sheet.mesh, sheet.positions, vec![0.2]).expect("a valid cloth");
    let mut total = 0.0;
    for call in 0..12 {
        let (ms, report) = step(&mut cloth, 0.35);
        print(&format!("refine, call {call}"), ms, &report);
        total += ms;
        if report.n_edits() == 0 {
            break;
        }
    }
    println!("refine, total                {total:8.2} ms");
    for (what, speed) in [("bump moves 1 mm", 1e-3), ("bump moves 5 mm", 5e-3)] {
        let mut sum = 0.0;
        for frame in 1..=10 {
            let (ms, report) = step(&mut cloth, 0.35 + speed * f64::from(frame));
            sum += ms;
            if frame % 5 == 0 {
                print(what, ms, &report);
            }
        }
        println!("{what}, mean        {:8.2} ms", sum / 10.0);
    }
    for _ in 0..12 {
        let (ms, report) = step(&mut cloth, 0.4);
        print("nothing moves", ms, &report);
    }
}

fn main() {
    let threads = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(1);
    par::with_threads(threads, measure).expect("threads");
}
