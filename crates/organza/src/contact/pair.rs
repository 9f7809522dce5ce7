//! The two sides of a contact: which of its four vertices are cloth, and what of it goes to them.

use cloth_dynamics::solver::BlockMatrix;
use collision::{Pair, PairKind, distance};
use mesh_core::World3;
use nalgebra::Matrix3;

/// A pair of features with its vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sides {
    /// The vertices, of the cloth or of the obstacles.
    pub(super) vertices: [u32; 4],
    /// Which belong to the first feature.
    pub(super) is_first: [bool; 4],
    /// Which are the cloth's.
    pub(super) is_cloth: [bool; 4],
    pub(super) is_edges: bool,
    /// Distance below which they repel each other (m).
    pub(super) thickness: f64,
}

/// The closest points of a pair.
#[derive(Clone, Copy, Debug)]
pub(super) struct ClosestPoints {
    pub(super) weights: [f64; 4],
    pub(super) offset: World3,
    pub(super) distance: f64,
}

impl Sides {
    pub(super) fn new(pair: Pair, vertices: [u32; 4], within_cloth: bool, thickness: f64) -> Sides {
        let of_first = pair.of_first();
        let is_edges = pair.kind == PairKind::EdgeEdge;
        let front = if is_edges { 2 } else { 1 };
        Sides {
            vertices,
            is_first: std::array::from_fn(|k| k < front),
            is_cloth: of_first.map(|is_first| within_cloth || is_first),
            is_edges,
            thickness,
        }
    }

    /// The corners, which are the cloth's at `x` or the obstacles' at `y` (m).
    pub(super) fn corners(&self, x: &[World3], y: &[World3]) -> [World3; 4] {
        std::array::from_fn(|k| {
            let i = self.vertices[k] as usize;
            if self.is_cloth[k] { x[i] } else { y[i] }
        })
    }

    /// What tells pairs apart.
    pub(super) fn key(&self) -> [u32; 5] {
        let [a, b, c, d] = self.vertices;
        let bit = |k: usize| u32::from(self.is_cloth[k]) << k;
        [a, b, c, d, (0..4).map(bit).sum::<u32>() | u32::from(self.is_edges) << 4]
    }

    /// Pairs of vertices of the cloth.
    pub(super) fn couples(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let (vertices, is_cloth) = (self.vertices, self.is_cloth);
        let pairs = (0..4).flat_map(|a| (0..a).map(move |b| (a, b)));
        let cloth = pairs.filter(move |&(a, b)| is_cloth[a] && is_cloth[b]);
        cloth.map(move |(a, b)| [vertices[a], vertices[b]])
    }

    pub(super) fn is_within_cloth(&self) -> bool {
        self.is_cloth == [true; 4]
    }

    /// The most by which the distance can change on the way (m): the points of one feature move by
    /// no more than this against those of the other.
    pub(super) fn relative_motion(&self, x_t0: &[World3; 4], x_t1: &[World3; 4]) -> f64 {
        let motion: [World3; 4] = std::array::from_fn(|k| x_t1[k] - x_t0[k]);
        let mut most: f64 = 0.0;
        for a in (0..4).filter(|&k| self.is_first[k]) {
            for b in (0..4).filter(|&k| !self.is_first[k]) {
                most = most.max((motion[a] - motion[b]).norm_squared());
            }
        }
        most.sqrt()
    }

    pub(super) fn closest(&self, x: &[World3; 4]) -> ClosestPoints {
        let (weights, offset, squared) = if self.is_edges {
            let closest = distance::edge_edge(x);
            (closest.weights, closest.offset, closest.squared)
        } else {
            let closest = distance::vertex_triangle(x);
            (closest.weights, closest.offset, closest.squared)
        };
        ClosestPoints { weights, offset, distance: squared.sqrt() }
    }

    /// Adds `g`, a derivative by the offset, to the vertices of the cloth.
    pub(super) fn add_gradient(&self, weights: &[f64; 4], g: &World3, to: &mut [World3]) {
        for k in (0..4).filter(|&k| self.is_cloth[k]) {
            to[self.vertices[k] as usize] += g * weights[k];
        }
    }

    /// Adds a stiffness of the offset to the vertices of the cloth.
    pub(super) fn add_stiffness(
        &self,
        weights: &[f64; 4],
        stiffness: &Matrix3<f64>,
        to: &mut BlockMatrix,
    ) {
        for a in (0..4).filter(|&a| self.is_cloth[a] && weights[a] != 0.0) {
            for b in (0..=a).filter(|&b| self.is_cloth[b] && weights[b] != 0.0) {
                let (i, j) = (self.vertices[a] as usize, self.vertices[b] as usize);
                let slot =
                    to.pattern().slot(i.max(j), i.min(j)).expect("there is room for contact");
                // The blocks are symmetric, so that their order does not matter.
                to.add(slot, &(stiffness * (weights[a] * weights[b])));
            }
        }
    }
}
