//! Random collision queries: generic ones, and ones built around a contact.

use crate::exact::{Point, Query};
pub(crate) use crate::splitmix::Random;

impl Random {
    /// One of 0 … n − 1.
    pub(crate) fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    /// One of −r … r.
    pub(crate) fn within(&mut self, r: i64) -> i64 {
        self.below(2 * r as u64 + 1) as i64 - r
    }

    pub(crate) fn point(&mut self, r: i64) -> Point {
        std::array::from_fn(|_| self.within(r))
    }

    /// True once in n times.
    pub(crate) fn once_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }

    pub(crate) fn is_edges(&mut self) -> bool {
        self.once_in(2)
    }
}

/// Weights are multiples of 1/16, so that points made with them have integer coordinates.
const PARTS: i64 = 16;

/// Eight random points. Small numbers make coincidences of all kinds.
pub(crate) fn generic(random: &mut Random) -> Query {
    let r = [1, 2, 4, 16, 256, 1 << 12, 1 << 15][random.below(7) as usize];
    let x_t0 = std::array::from_fn(|_| random.point(r));
    // Half of the time a small motion of bodies that are not far from each other.
    let x_t1 = if random.once_in(2) {
        x_t0.map(|p: Point| {
            let d = random.point((r / 4).max(1));
            std::array::from_fn(|k| p[k] + d[k])
        })
    } else {
        std::array::from_fn(|_| random.point(r))
    };
    Query { is_edges: random.is_edges(), x_t0, x_t1 }
}

/// A query whose bodies touch at a known time, exactly, in every degenerate way there is.
pub(crate) struct Contact {
    pub(crate) query: Query,
    /// Time of the contact; there may be earlier ones.
    pub(crate) at: f64,
}

fn mix(weights: &[i64], points: &[Point]) -> Point {
    std::array::from_fn(|k| {
        let sum: i64 = weights.iter().zip(points).map(|(w, p)| w * p[k]).sum();
        assert_eq!(sum % PARTS, 0);
        sum / PARTS
    })
}

/// Weights of n points that sum to one: inside, on an edge, or at a corner.
fn weights(random: &mut Random, n: usize) -> Vec<i64> {
    let mut all = vec![0; n];
    let kind = 1 + random.below(n as u64);
    let mut rest = PARTS;
    for _ in 1..kind {
        let part = random.below(rest as u64 + 1) as i64;
        all[random.below(n as u64) as usize] += part;
        rest -= part;
    }
    all[random.below(n as u64) as usize] += rest;
    all
}

/// Builds it from the moment of contact: positions there and velocities.
pub(crate) fn contact(random: &mut Random) -> Contact {
    let is_edges = random.is_edges();
    let r = [1, 4, 64, 2000][random.below(4) as usize];
    let corner = |random: &mut Random| random.point(r).map(|c| PARTS * c);
    let mut x: [Point; 4] = std::array::from_fn(|_| corner(random));
    let w = if is_edges {
        [weights(random, 2), weights(random, 2)]
    } else {
        [vec![PARTS], weights(random, 3)]
    };
    let n = w[0].len();
    // Degenerate elements: no area or no length, parallel edges.
    match random.below(6) {
        0 => x[3] = x[2],
        1 if is_edges => {
            let d: Point = std::array::from_fn(|k| x[1][k] - x[0][k]);
            let sign = if random.once_in(2) { 2 } else { -2 };
            x[3] = std::array::from_fn(|k| x[2][k] + sign * d[k]);
        }
        1 => x[3] = std::array::from_fn(|k| 2 * x[2][k] - x[1][k]),
        2 => x[1] = x[2 * usize::from(!is_edges)],
        // Everything in a plane.
        3 => x.iter_mut().for_each(|p| p[2] = 0),
        _ => {}
    }
    // Moves the first body so that the two points coincide.
    let target = mix(&w[1], &x[n..]);
    let own = mix(&w[0], &x[..n]);
    (0..n).for_each(|i| (0..3).for_each(|k| x[i][k] += target[k] - own[k]));
    // Velocities per 1/m of the time.
    let m = 1 << random.below(5);
    let speed = [1, 8, 100, 500][random.below(4) as usize];
    let mut v: [Point; 4] = std::array::from_fn(|_| random.point(speed).map(|c| PARTS * c));
    match random.below(5) {
        // The same for all, and a bit.
        0 => {
            let common = random.point(speed);
            v = std::array::from_fn(|_| {
                let own = random.point(1);
                std::array::from_fn(|k| PARTS * (common[k] + own[k]))
            });
        }
        // Within a plane: the cubic is zero if the positions are too.
        1 => v.iter_mut().for_each(|v| v[2] = 0),
        // No relative velocity at the contact: it touches and goes away, or stays.
        2 => {
            let (target, own) = (mix(&w[1], &v[n..]), mix(&w[0], &v[..n]));
            (0..n).for_each(|i| (0..3).for_each(|k| v[i][k] += target[k] - own[k]));
        }
        // Only the first body moves.
        3 => v[n..].iter_mut().for_each(|v| *v = [0; 3]),
        _ => {}
    }
    let at = random.below(m as u64 + 1) as i64;
    let away =
        |steps: i64| std::array::from_fn(|i| std::array::from_fn(|k| x[i][k] + steps * v[i][k]));
    let query = Query { is_edges, x_t0: away(-at), x_t1: away(m - at) };
    Contact { query, at: at as f64 / m as f64 }
}

/// A contact with every coordinate changed by at most one unit: hits and misses by next to nothing.
pub(crate) fn near(random: &mut Random) -> Query {
    let mut query = contact(random).query;
    let all_of_one_body = random.once_in(2);
    let n = if query.is_edges { 2 } else { 1 };
    let shift = random.point(1);
    for i in 0..4 {
        let d = [random.point(1), random.point(1)];
        for k in 0..3 {
            if all_of_one_body {
                query.x_t0[i][k] += if i < n { shift[k] } else { 0 };
                query.x_t1[i][k] += if i < n { shift[k] } else { 0 };
            } else {
                query.x_t0[i][k] += d[0][k];
                query.x_t1[i][k] += d[1][k];
            }
        }
    }
    query
}
