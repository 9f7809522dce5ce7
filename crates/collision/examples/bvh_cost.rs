//! Time to build, refit and search the tree of boxes for a rippled sheet of 1e3 to 1e6 triangles, and
//! how it grows: the exponent between neighbouring sizes.
//!
//! `cargo run --release -p collision --example bvh_cost [THREADS]`

use collision::{Body, Surface, proximity, swept};
use mesh_core::{World3, par};
use std::hint::black_box;
use std::time::Instant;

/// A square metre of `n × n` squares in ripples of 1 cm, `phase` into their motion.
fn positions(n: usize, phase: f64) -> Vec<World3> {
    let at = |v: usize| {
        let (s, t) = ((v % (n + 1)) as f64 / n as f64, (v / (n + 1)) as f64 / n as f64);
        World3::new(s, t, 0.01 * ((40.0 * s + phase).sin() + (31.0 * t - phase).cos()))
    };
    (0..(n + 1) * (n + 1)).map(at).collect()
}

fn triangles(n: usize) -> Vec<[u32; 3]> {
    let squares = (0..n * n).map(|q| (q / n * (n + 1) + q % n) as u32);
    let w = n as u32 + 1;
    squares.flat_map(|a| [[a, a + 1, a + w + 1], [a, a + w + 1, a + w]]).collect()
}

/// Best time of some calls (s).
fn best<T>(calls: usize, mut f: impl FnMut() -> T) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..calls {
        let start = Instant::now();
        black_box(f());
        best = best.min(start.elapsed().as_secs_f64());
    }
    best
}

fn run() {
    println!("threads: {}", par::n_threads());
    let names = ["build", "refit", "self pairs", "proximity", "swept"];
    println!("triangles  {}", names.map(|name| format!("{name:>20}")).concat());
    let mut before: Option<(f64, [f64; 5])> = None;
    for n in [22, 71, 224, 707] {
        let list = triangles(n);
        let x = [positions(n, 0.0), positions(n, 0.01)];
        let surface = Surface::new(x[0].len(), &list).expect("indices in range");
        let calls = (200_000 / list.len()).clamp(3, 20);
        let radius = 0.1 / n as f64;
        let radius = |_: u32| radius;
        let still = Body::still(&surface, &x[1], &radius);
        let moving = Body::moving(&surface, &x[0], &x[1], &radius);
        let shares = |a: u32, b: u32| list[a as usize].iter().any(|v| list[b as usize].contains(v));
        let (mut tree, of_motion) = (still.tree(), moving.tree());
        let times = [
            best(calls, || surface.tree(&x[0])),
            best(calls, || tree.refit(|t| surface.triangle_box(&x[1], t))),
            best(calls, || tree.self_pairs(|a, b| !shares(a, b))),
            best(calls, || proximity::within(still, &of_motion)),
            best(calls, || swept::impacts_within(moving, &of_motion)),
        ];
        let size = list.len() as f64;
        let cells = (0..5).map(|k| {
            let slope = before.map_or(String::new(), |(s, t)| {
                format!(" ^{:.2}", (times[k] / t[k]).ln() / (size / s).ln())
            });
            format!("{:>20}", format!("{:.3} ms{slope}", times[k] * 1e3))
        });
        println!("{:>9}  {}", list.len(), cells.collect::<String>());
        before = Some((size, times));
    }
}

fn main() {
    let threads = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(1);
    par::with_threads(threads, run).expect("threads");
}
