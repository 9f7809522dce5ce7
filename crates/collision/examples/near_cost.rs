//! Time to find what may come near on a folded sheet that moves mostly as one, as cloth does in a time
//! step: with itself, with a finer surface below it, and with one far bigger than itself.
//!
//! `cargo run --release -p collision --example near_cost [THREADS]`

use collision::{Body, Surface, swept};
use mesh_core::{World3, par};
use std::hint::black_box;
use std::time::Instant;

/// Squares along a side of the sheet.
const N: usize = 45;
/// Their size (m).
const SIZE: f64 = 0.014;

/// `n × n` squares, split along alternating diagonals.
fn triangles(n: usize) -> Vec<[u32; 3]> {
    let w = n as u32 + 1;
    let split = |q: usize| {
        let (i, j) = (q % n, q / n);
        let a = (j * (n + 1) + i) as u32;
        let (b, c, d) = (a + 1, a + w + 1, a + w);
        if (i + j).is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    (0..n * n).flat_map(split).collect()
}

/// Vertices of the flat sheet, away from the lattice by up to a fifth of a square (m).
fn material(n: usize, size: f64) -> Vec<[f64; 2]> {
    let at = |v: usize| {
        let (i, j) = ((v % (n + 1)) as f64, (v / (n + 1)) as f64);
        let off = |a: f64, b: f64| 0.2 * (a * i + b * j).sin();
        [(i + off(12.9, 78.2)) * size, (j + off(39.3, 11.1)) * size]
    };
    (0..(n + 1) * (n + 1)).map(at).collect()
}

/// The sheet as a strip whose slope along s is a few waves over each other, `phase` into its motion
/// (m). Lengths along s are kept, so that the folds overhang and lie upon each other.
fn folded(material: &[[f64; 2]], phase: f64) -> Vec<World3> {
    let slope = |s: f64, t: f64| {
        1.6 * (24.0 * s + 1.5 * (7.0 * t).sin() + phase).sin() + 0.5 * (21.0 * t + 9.0 * s).cos()
    };
    let at = |&[s, t]: &[f64; 2]| {
        let n = 64;
        let step = s / f64::from(n);
        let mut x = World3::new(0.0, t, 0.01 * (25.0 * t + phase).sin());
        for k in 0..n {
            let angle = slope((f64::from(k) + 0.5) * step, t);
            x += World3::new(angle.cos(), 0.0, angle.sin()) * step;
        }
        let sway = |a: f64| (9.0 * x[0] + 11.0 * t + 7.0 * x[2] + a).sin();
        x + World3::new(sway(0.0), 0.3, sway(2.0)) * (0.2 * phase)
    };
    material.iter().map(at).collect()
}

/// A fifth of the lowest height around each vertex, but at most 2.5 mm, and half a skin of 1.5 mm (m).
fn radii(list: &[[u32; 3]], material: &[[f64; 2]]) -> Vec<f64> {
    let mut radii = vec![0.0025f64; material.len()];
    for corners in list {
        let [a, b, c] = corners.map(|v| material[v as usize]);
        let way = |p: [f64; 2], q: [f64; 2]| [q[0] - p[0], q[1] - p[1]];
        let (e, f, g) = (way(a, b), way(a, c), way(b, c));
        let longest = [e, f, g].map(|e| e[0].hypot(e[1])).into_iter().fold(0.0, f64::max);
        let height = (e[0] * f[1] - e[1] * f[0]).abs() / longest;
        corners.iter().for_each(|&v| radii[v as usize] = radii[v as usize].min(0.2 * height));
    }
    radii.into_iter().map(|r| r + 0.00075).collect()
}

/// Median time of some calls (s).
fn median<T>(mut f: impl FnMut() -> T) -> f64 {
    let mut times: Vec<f64> = (0..41)
        .map(|_| {
            let start = Instant::now();
            black_box(f());
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn run() {
    println!("threads: {}", par::n_threads());
    let (list, flat) = (triangles(N), material(N, SIZE));
    let surface = Surface::new(flat.len(), &list).expect("indices in range");
    let x = [folded(&flat, 0.0), folded(&flat, 0.04)];
    let n = flat.len() as f64;
    let drift = x[0].iter().zip(&x[1]).map(|(a, b)| b - a).sum::<World3>() / n;
    let x_t1: Vec<World3> = x[1].iter().map(|x| x - drift).collect();
    let motion = x[0].iter().zip(&x_t1).map(|(a, b)| (b - a).norm()).sum::<f64>() / n;
    let around = radii(&list, &flat);
    let radius = |v: u32| around[v as usize];
    let body = Body::moving(&surface, &x[0], &x_t1, &radius);
    let mut tree = body.tree();
    let pairs = tree.self_pairs(|_, _| true).len();
    println!("{} triangles, motion {:.1} mm, {pairs} pairs of boxes", list.len(), motion * 1e3);
    println!("update of the tree {:>9.3} ms", median(|| body.update_tree(&mut tree)) * 1e3);
    let found = swept::near_within(body, &tree, |_, _| f64::INFINITY).len();
    let time = median(|| swept::near_within(body, &tree, |_, _| f64::INFINITY));
    println!("with itself        {:>9.3} ms, {found} found", time * 1e3);

    let body = Body::moving(&surface, &x[0], &x[1], &radius);
    let tree = body.tree();
    let lowest = tree.bounds().lo[2];
    for (name, m, size) in [("finer", 120, 0.006), ("bigger", 700, 0.02)] {
        let list = triangles(m);
        let floor = Surface::new((m + 1) * (m + 1), &list).expect("indices in range");
        let corner = -0.5 * (m as f64 * size - N as f64 * SIZE);
        let height = |s: f64, t: f64| lowest + 0.02 * ((30.0 * s).sin() + (20.0 * t).cos());
        let y: Vec<World3> = material(m, size)
            .into_iter()
            .map(|[s, t]| World3::new(s + corner, t + corner, height(s, t)))
            .collect();
        let room = |_: u32| 0.00325;
        let other = Body::still(&floor, &y, &room);
        let their_tree = other.tree();
        let both = ((body, &tree), (other, &their_tree));
        let found = swept::near_between(both.0, both.1).len();
        let time = median(|| swept::near_between(both.0, both.1));
        println!("with a {name:<6} one {:>9.3} ms, {found} found", time * 1e3);
    }
}

fn main() {
    let threads = std::env::args().nth(1).and_then(|n| n.parse().ok()).unwrap_or(1);
    par::with_threads(threads, run).expect("threads");
}
