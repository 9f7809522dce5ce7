//! CPU time of remeshing a square metre of cloth with a travelling ripple: refining it to about
//! 20,000 triangles, following the ripple, and finding nothing to do.
//!
//! `cargo run --release -p remesh --example remesh_cost [THREADS]`

use mesh_core::{ClothState, World3, generate, par};
use remesh::{PhysicalSizing, RemeshReport, RemeshSettings, remesh};
use std::time::Instant;

const SIZING: PhysicalSizing = PhysicalSizing {
    refine_angle: 0.22,
    refine_velocity: 2.0,
    refine_compression: 0.01,
    size_min: 0.004,
    size_max: 0.1,
    aspect_min: 0.2,
};

/// CPU time of this thread (s), where the system tells; else the time on the wall.
fn seconds(start: Instant) -> f64 {
    let schedule = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let on_cpu = schedule.and_then(|s| s.split_whitespace().next()?.parse::<f64>().ok());
    on_cpu.map_or_else(|| start.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// Puts the cloth on a ring of ripples, 2 cm high, around (centre, 0.5).
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

/// Time (ms) and report of one call.
#[inline(never)]
fn step(cloth: &mut ClothState) -> (f64, RemeshReport) {
    let start = Instant::now();
    let before = seconds(start);
    let report = remesh(cloth, &SIZING, &RemeshSettings::default()).expect("settings in range");
    ((seconds(start) - before) * 1e3, report)
}

fn print(what: &str, ms: f64, r: &RemeshReport) {
    println!(
        "{what:<16} {ms:8.2} ms  {:6} triangles, {:5} splits {:5} flips {:5} collapses, aspect \
         {:.2} to 1, {} below the bound",
        r.quality.n_triangles,
        r.n_splits,
        r.n_flips,
        r.n_collapses,
        r.quality.aspect_min,
        r.quality.n_below_aspect,
    );
}

/// Calls on a cloth that does not move.
#[inline(never)]
fn still(cloth: &mut ClothState) {
    let mut least = f64::INFINITY;
    for call in 0..20 {
        let (ms, report) = step(cloth);
        least = if report.n_edits() == 0 { least.min(ms) } else { least };
        if call % 5 == 4 {
            print("nothing moves", ms, &report);
        }
    }
    println!("nothing moves, least {least:.2} ms");
}

/// Refines the cloth for the ripples until it hardly changes any more.
#[inline(never)]
fn refine(cloth: &mut ClothState) {
    let mut total = 0.0;
    for call in 0..6 {
        shape(cloth, 0.35);
        let (ms, report) = step(cloth);
        print(&format!("refine, call {call}"), ms, &report);
        total += ms;
    }
    println!("refine, total {total:.2} ms");
}

/// Calls while the ripples wander.
#[inline(never)]
fn follow(cloth: &mut ClothState, mm: f64) {
    let mut sum = 0.0;
    for frame in 1..=10 {
        shape(cloth, 0.35 + 1e-3 * mm * f64::from(frame));
        let (ms, report) = step(cloth);
        sum += ms;
        if frame % 5 == 0 {
            print(&format!("moves {mm} mm"), ms, &report);
        }
    }
    println!("moves {mm} mm, mean {:.2} ms", sum / 10.0);
}

fn measure() {
    let sheet = generate::grid([1.0, 1.0], [10, 10], generate::Diagonal::Alternating)
        .expect("a valid grid");
    let mut cloth =
        ClothState::at_rest(sheet.mesh, sheet.positions, vec![0.2]).expect("a valid cloth");
    refine(&mut cloth);
    follow(&mut cloth, 1.0);
    follow(&mut cloth, 5.0);
    still(&mut cloth);
}

fn main() {
    let threads = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(1);
    par::with_threads(threads, measure).expect("threads");
}
