//! The surface of a solid as triangles: dual cells, evened out.

use crate::body;
use crate::error::MannequinError;
use mesh_core::World3;
use mesh_core::generate::Surface;
use std::collections::HashMap;

/// Rounds of moving vertices towards the mean of their neighbours.
const ROUNDS: usize = 15;

/// The skin of the body with edges of about `cell` (m).
pub(crate) fn skin(cell: f64) -> Result<Surface, MannequinError> {
    let [low, high] = body::BOUNDS.map(World3::from);
    let Quads { mut positions, quads } = dual_cells(low, high, cell);
    even_out(&mut positions, &quads);
    let mut triangles = Vec::with_capacity(2 * quads.len());
    for [a, b, c, d] in quads {
        let length = |p: u32, q: u32| (positions[p as usize] - positions[q as usize]).norm();
        if length(a, c) <= length(b, d) {
            triangles.extend([[a, b, c], [a, c, d]]);
        } else {
            triangles.extend([[a, b, d], [b, c, d]]);
        }
    }
    let surface = Surface { positions, triangles };
    if is_closed_manifold(&surface) { Ok(surface) } else { Err(MannequinError::Skin { cell }) }
}

struct Quads {
    positions: Vec<World3>,
    /// Counter-clockwise seen from outside.
    quads: Vec<[u32; 4]>,
}

/// Corner k of a cell is at (k & 1, k >> 1 & 1, k >> 2 & 1). Edge 4 a + b of a cell runs along axis a;
/// bit 0 of b is its place on the next axis, bit 1 that on the one after.
fn edge_corners(edge: usize) -> [usize; 2] {
    let (axis, place) = (edge / 4, edge % 4);
    let from = (place & 1) << ((axis + 1) % 3) | (place >> 1) << ((axis + 2) % 3);
    [from, from | 1 << axis]
}

fn edge_between(p: usize, q: usize) -> usize {
    let axis = (p ^ q).trailing_zeros() as usize;
    let bit = |axis: usize| p >> (axis % 3) & 1;
    4 * axis + bit(axis + 1) + 2 * bit(axis + 2)
}

/// Corners of the six sides of a cell, around each.
const SIDES: [[usize; 4]; 6] =
    [[0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6], [0, 1, 3, 2], [4, 5, 7, 6]];

/// The dual of marching cubes (Nielson2004): one vertex in a cell for every piece of the surface in it,
/// and a quad around every edge of the lattice that the surface crosses.
fn dual_cells(low: World3, high: World3, cell: f64) -> Quads {
    let n = (high - low).map(|length| (length / cell).ceil() as usize + 1);
    let number = |p: [usize; 3]| (p[2] * n.y + p[1]) * n.x + p[0];
    let place = |p: [usize; 3]| low + World3::from(p.map(|i| i as f64)) * cell;
    let mut value = Vec::with_capacity(n.product());
    for k in 0..n.z {
        for j in 0..n.y {
            value.extend((0..n.x).map(|i| body::distance(&place([i, j, k]))));
        }
    }
    let mut positions = Vec::new();
    let mut vertex_of: HashMap<usize, [u32; 12]> = HashMap::new();
    let mut crossed = Vec::new();
    let corner = |p: [usize; 3], k: usize| [p[0] + (k & 1), p[1] + (k >> 1 & 1), p[2] + (k >> 2)];
    for k in 0..n.z - 1 {
        for j in 0..n.y - 1 {
            for i in 0..n.x - 1 {
                let p = [i, j, k];
                let values: [f64; 8] = std::array::from_fn(|c| value[number(corner(p, c))]);
                let Some(groups) = pieces(&values.map(|v| v < 0.0)) else { continue };
                let mut sums: HashMap<usize, (World3, f64)> = HashMap::new();
                for (edge, group) in groups.iter().enumerate() {
                    let Some(group) = group else { continue };
                    let [a, b] = edge_corners(edge);
                    let share = values[a] / (values[a] - values[b]);
                    let [xa, xb] = [a, b].map(|c| place(corner(p, c)));
                    let sum = sums.entry(*group).or_insert((World3::zeros(), 0.0));
                    *sum = (sum.0 + xa + (xb - xa) * share, sum.1 + 1.0);
                }
                let mut vertices = [u32::MAX; 12];
                for edge in 0..12 {
                    let Some(group) = groups[edge] else { continue };
                    if group == edge {
                        vertices[edge] = positions.len() as u32;
                        positions.push(sums[&group].0 / sums[&group].1);
                    } else {
                        vertices[edge] = vertices[group];
                    }
                }
                vertex_of.insert(number(p), vertices);
                crossed.push(p);
            }
        }
    }
    let mut quads = Vec::new();
    for p in crossed {
        // Every edge belongs to the cell above it on all axes, where it has place 0.
        for axis in 0..3 {
            let mut q = p;
            q[axis] += 1;
            let [inside, beyond] = [p, q].map(|p| value[number(p)] < 0.0);
            if inside == beyond {
                continue;
            }
            let around: [u32; 4] = [3, 2, 0, 1].map(|place: usize| {
                let mut cell = p;
                cell[(axis + 1) % 3] -= place & 1;
                cell[(axis + 2) % 3] -= place >> 1;
                vertex_of[&number(cell)][4 * axis + place]
            });
            let [a, b, c, d] = around;
            quads.push(if inside { [a, b, c, d] } else { [d, c, b, a] });
        }
    }
    Quads { positions, quads }
}

/// For every edge of a cell that the surface crosses the smallest edge of the same piece of surface;
/// `None` if it crosses none. On sides with four crossings, the corners inside are apart.
fn pieces(inside: &[bool; 8]) -> Option<[Option<usize>; 12]> {
    let mut group: [Option<usize>; 12] = std::array::from_fn(|edge| {
        let [a, b] = edge_corners(edge);
        (inside[a] != inside[b]).then_some(edge)
    });
    group.iter().flatten().next()?;
    let mut join = |e: usize, f: usize| {
        let (Some(a), Some(b)) = (group[e], group[f]) else { return };
        for g in group.iter_mut().flatten() {
            if *g == a.max(b) {
                *g = a.min(b);
            }
        }
    };
    for side in SIDES {
        let edges: [usize; 4] = std::array::from_fn(|k| edge_between(side[k], side[(k + 1) % 4]));
        let cut: Vec<usize> =
            (0..4).filter(|&k| inside[side[k]] != inside[side[(k + 1) % 4]]).collect();
        match cut[..] {
            [a, b] => join(edges[a], edges[b]),
            [_, _, _, _] => {
                (0..4)
                    .filter(|&k| inside[side[k]])
                    .for_each(|k| join(edges[k], edges[(k + 3) % 4]));
            }
            _ => {}
        }
    }
    Some(group)
}

/// Moves vertices along the surface towards the middle of their neighbours, and back onto it.
fn even_out(positions: &mut [World3], quads: &[[u32; 4]]) {
    for _ in 0..ROUNDS {
        let mut sums = vec![(World3::zeros(), 0.0); positions.len()];
        for quad in quads {
            for k in 0..4 {
                // Every edge is met once in each direction.
                let [from, to] = [quad[k], quad[(k + 1) % 4]].map(|v| v as usize);
                sums[from].0 += positions[to];
                sums[from].1 += 1.0;
            }
        }
        for (x, (sum, count)) in positions.iter_mut().zip(sums) {
            *x += (sum / count - *x) * 0.5;
            for _ in 0..2 {
                let slope = body::gradient(x);
                *x -= slope * (body::distance(x) / slope.norm_squared());
            }
        }
    }
}

/// True if it is in one piece, every edge has two sides, and the triangles around every vertex are one
/// fan.
fn is_closed_manifold(surface: &Surface) -> bool {
    let mut next: HashMap<(u32, u32), u32> = HashMap::new();
    let mut degree = vec![0; surface.positions.len()];
    for &[a, b, c] in &surface.triangles {
        for (from, to, apex) in [(a, b, c), (b, c, a), (c, a, b)] {
            if from == to || next.insert((from, to), apex).is_some() {
                return false;
            }
            degree[from as usize] += 1;
        }
    }
    if next.keys().any(|&(a, b)| !next.contains_key(&(b, a))) {
        return false;
    }
    if n_pieces(surface) != 1 {
        return false;
    }
    let mut seen = vec![false; surface.positions.len()];
    surface.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).all(|(v, first)| {
        if std::mem::replace(&mut seen[v as usize], true) {
            return true;
        }
        let (mut at, mut n) = (first, 0);
        loop {
            at = next[&(v, at)];
            n += 1;
            if at == first || n > degree[v as usize] {
                return n == degree[v as usize];
            }
        }
    })
}

/// Number of parts that no edge joins.
fn n_pieces(surface: &Surface) -> usize {
    let mut neighbours = vec![Vec::new(); surface.positions.len()];
    for &[a, b, c] in &surface.triangles {
        [(a, b), (b, c), (c, a)].into_iter().for_each(|(p, q)| neighbours[p as usize].push(q));
    }
    let mut seen = vec![false; surface.positions.len()];
    let mut n = 0;
    for start in 0..surface.positions.len() as u32 {
        if seen[start as usize] {
            continue;
        }
        n += 1;
        let mut open = vec![start];
        while let Some(v) = open.pop() {
            if !std::mem::replace(&mut seen[v as usize], true) {
                open.extend(&neighbours[v as usize]);
            }
        }
    }
    n
}
