//! Cost of a continuous collision test by kind of query.
//!
//! `cargo run --release -p collision --example ccd_cost`

#[path = "../tests/ccd/splitmix.rs"]
mod splitmix;

use collision::ccd::{self, Ccd};
use mesh_core::World3;
use splitmix::Random;
use std::time::Instant;

type Test = fn(&[World3; 4], &[World3; 4], f64) -> Ccd;
type Motion = ([World3; 4], [World3; 4]);

impl Random {
    /// In [−1, 1).
    fn number(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn point(&mut self) -> World3 {
        World3::new(self.number(), self.number(), self.number())
    }

    fn points(&mut self) -> [World3; 4] {
        std::array::from_fn(|_| self.point())
    }
}

/// Two bodies of size 1 whose `n` first corners are shifted, moving by `speed`.
fn motion(random: &mut Random, n: usize, shift: World3, speed: f64) -> Motion {
    let mut x_t0 = random.points();
    x_t0[..n].iter_mut().for_each(|x| *x += shift);
    let d = random.points();
    (x_t0, std::array::from_fn(|i| x_t0[i] + d[i] * speed))
}

fn measure(what: &str, test: Test, motions: &[Motion]) {
    let mut hits = 0;
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let start = Instant::now();
        hits = motions.iter().filter(|(a, b)| test(a, b, 0.0).is_hit()).count();
        best = best.min(start.elapsed().as_secs_f64());
    }
    let n = motions.len();
    println!(
        "{what:44} {:7.0} ns, {:5.1} % hits",
        best / n as f64 * 1e9,
        100.0 * hits as f64 / n as f64
    );
}

fn main() {
    const N: usize = 100_000;
    let mut random = Random(1);
    for (name, test, n) in
        [("vertex-triangle", ccd::vertex_triangle as Test, 1), ("edge-edge", ccd::edge_edge, 2)]
    {
        let mut family = |shift: f64, speed: f64| -> Vec<Motion> {
            (0..N)
                .map(|_| {
                    let along = random.point().normalize() * shift;
                    motion(&mut random, n, along, speed)
                })
                .collect()
        };
        let far = family(4.0, 0.2);
        let close = family(0.5, 0.2);
        let (hits, misses): (Vec<_>, Vec<_>) =
            family(0.5, 2.0).into_iter().partition(|(a, b)| test(a, b, 0.0).is_hit());
        let slow = |x: &Motion| (x.0, std::array::from_fn(|i| x.0[i] + (x.1[i] - x.0[i]) * 0.1));
        let slow: Vec<Motion> = misses.iter().map(slow).collect();
        measure(&format!("{name}: far, easy miss"), test, &far);
        measure(&format!("{name}: boxes overlap, small motion"), test, &close);
        measure(&format!("{name}: misses, large motion"), test, &misses);
        measure(&format!("{name}: the same, a tenth of the motion"), test, &slow);
        measure(&format!("{name}: hits"), test, &hits);
    }
}
