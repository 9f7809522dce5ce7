//! The two sides of a contour, and the parts into which contours cut surfaces.

use collision::Surface;
use collision::contour::{Contour, Contours, CrossingPoint, End};

/// The traces that a contour leaves on the two surfaces that cross there.
pub(super) struct Traces {
    /// Triangles that it passes on either side.
    pub(super) triangles: [Vec<u32>; 2],
    /// Its crossings, with 1 where the edge is of the first side, and -1 where it is of the second.
    pub(super) crossings: Vec<(u32, f64)>,
    /// Edges that it cuts on either side.
    pub(super) edges: [Vec<u32>; 2],
}

impl Traces {
    pub(super) fn of(contours: &Contours, contour: &Contour) -> Traces {
        let mut traces = Traces {
            triangles: [Vec::new(), Vec::new()],
            crossings: Vec::new(),
            edges: [Vec::new(), Vec::new()],
        };
        for &s in &contour.segments {
            let [mut a, mut b] = contours.segments[s as usize].triangles;
            // From one segment to the next only one side goes on.
            if traces.triangles[1].last() == Some(&a) || traces.triangles[0].last() == Some(&b) {
                (a, b) = (b, a);
            }
            traces.triangles[0].push(a);
            traces.triangles[1].push(b);
        }
        let n = contour.segments.len();
        for (k, end) in contour.ends.iter().enumerate() {
            let End::Crossing(i) = *end else { continue };
            let crossing = &contours.crossings[i as usize];
            // The triangle of a crossing is that of the side whose edge is the other's.
            let is_first = traces.triangles[1][k.min(n - 1)] == crossing.triangle;
            traces.crossings.push((i, if is_first { 1.0 } else { -1.0 }));
            traces.edges[usize::from(!is_first)].push(crossing.edge);
        }
        traces
    }
}

/// Parts of surfaces that hang together by edges that nothing crosses.
pub(super) struct Regions {
    parent: Vec<u32>,
    /// The same without any cuts.
    whole: Vec<u32>,
    /// Vertices of every region by its root; filled where asked for.
    members: Vec<Vec<u32>>,
    /// Number of vertices by root of the whole.
    sizes: Vec<u32>,
}

impl Regions {
    pub(super) fn new(surface: &Surface, crossings: &[CrossingPoint]) -> Regions {
        let n = surface.n_vertices();
        let mut is_cut = vec![false; surface.n_edges()];
        // What is passed through twice is on the same side again.
        crossings.iter().for_each(|c| is_cut[c.edge as usize] ^= true);
        let mut parent: Vec<u32> = (0..n as u32).collect();
        for (edge, &[a, b]) in surface.edges().iter().enumerate() {
            if !is_cut[edge] {
                unite(&mut parent, a, b);
            }
        }
        let mut whole = parent.clone();
        surface.edges().iter().for_each(|&[a, b]| unite(&mut whole, a, b));
        let mut regions =
            Regions { members: vec![Vec::new(); n], sizes: vec![0; n], parent, whole };
        for v in 0..n as u32 {
            let root = regions.of(v);
            regions.members[root as usize].push(v);
            let root = find(&mut regions.whole, v);
            regions.sizes[root as usize] += 1;
        }
        regions
    }

    /// The region of a vertex.
    pub(super) fn of(&mut self, v: u32) -> u32 {
        find(&mut self.parent, v)
    }

    /// Vertices of a region.
    pub(super) fn vertices(&self, region: u32) -> &[u32] {
        &self.members[region as usize]
    }

    /// Whether a region is no more than half of what it is cut from.
    pub(super) fn is_minor(&mut self, region: u32) -> bool {
        let root = find(&mut self.whole, region);
        2 * self.members[region as usize].len() <= self.sizes[root as usize] as usize
    }
}

fn find(parent: &mut [u32], mut v: u32) -> u32 {
    while parent[v as usize] != v {
        parent[v as usize] = parent[parent[v as usize] as usize];
        v = parent[v as usize];
    }
    v
}

fn unite(parent: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(parent, a), find(parent, b));
    parent[a.max(b) as usize] = a.min(b);
}
