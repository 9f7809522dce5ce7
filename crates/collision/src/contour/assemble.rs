//! From crossings to segments, and from segments to contours.

use super::{Contour, Contours, CrossingPoint, End, Segment};
use crate::Surface;
use mesh_core::World3;

pub(super) fn assemble(surface: &Surface, x: &[World3], crossings: Vec<CrossingPoint>) -> Contours {
    let mut all = Contours { crossings, ..Contours::default() };
    all.segments = segments(surface, &all.crossings, &mut all.n_gaps);
    for i in 0..all.segments.len() {
        let [a, b] = all.segments[i].ends;
        all.segments[i].length = (all.place(x, a) - all.place(x, b)).norm();
    }
    all.contours = chains(&all.segments, all.crossings.len());
    all
}

/// The segments without their lengths. A crossing is an end of one segment for each triangle at its
/// edge: with one triangle, on a boundary, the contour ends there.
fn segments(surface: &Surface, crossings: &[CrossingPoint], n_gaps: &mut usize) -> Vec<Segment> {
    let mut ends: Vec<([u32; 2], u32)> = Vec::with_capacity(2 * crossings.len());
    for (i, crossing) in (0..).zip(crossings) {
        for &t in surface.triangles_at(crossing.edge) {
            let other = crossing.triangle;
            ends.push(([t.min(other), t.max(other)], i));
        }
    }
    ends.sort_unstable();
    let mut segments = Vec::new();
    for same in ends.chunk_by(|a, b| a.0 == b.0) {
        let triangles = same[0].0;
        let [a, b] = triangles.map(|t| surface.triangles()[t as usize]);
        let mut shared = a.into_iter().filter(|v| b.contains(v));
        let ends = match (same, shared.next(), shared.next()) {
            (&[(_, i), (_, j)], None, None) => [End::Crossing(i), End::Crossing(j)],
            (&[(_, i)], Some(v), None) => [End::Crossing(i), End::Vertex(v)],
            _ => {
                *n_gaps += 1;
                continue;
            }
        };
        segments.push(Segment { triangles, ends, length: 0.0 });
    }
    segments
}

/// The segments at every end, and who has been walked along.
struct Graph<'a> {
    segments: &'a [Segment],
    n_crossings: usize,
    /// Vertices that segments end at, ascending.
    vertices: Vec<u32>,
    at: Vec<Vec<u32>>,
    used: Vec<bool>,
}

impl Graph<'_> {
    fn node(&self, end: End) -> usize {
        match end {
            End::Crossing(i) => i as usize,
            End::Vertex(v) => self.n_crossings + self.vertices.partition_point(|&w| w < v),
        }
    }

    /// True where a contour goes on: at crossings of two segments.
    fn goes_on(&self, end: End) -> bool {
        matches!(end, End::Crossing(_)) && self.at[self.node(end)].len() == 2
    }

    /// Walks from an end along a segment until the contour ends or closes.
    fn walk(&mut self, start: End, first: u32) -> Contour {
        let mut contour =
            Contour { segments: Vec::new(), ends: vec![start], is_closed: false, length: 0.0 };
        let mut next = Some(first);
        while let Some(s) = next {
            self.used[s as usize] = true;
            let Segment { ends: [a, b], length, .. } = self.segments[s as usize];
            contour.segments.push(s);
            contour.length += length;
            let here = contour.ends[contour.ends.len() - 1];
            let end = if a == here { b } else { a };
            if end == start && self.goes_on(start) {
                contour.is_closed = true;
                break;
            }
            contour.ends.push(end);
            let on = self.at[self.node(end)].iter().copied().find(|&s| !self.used[s as usize]);
            next = on.filter(|_| self.goes_on(end));
        }
        contour
    }
}

/// All chains: first those that end somewhere, then closed ones.
fn chains(segments: &[Segment], n_crossings: usize) -> Vec<Contour> {
    let ends = || segments.iter().flat_map(|s| s.ends);
    let mut vertices: Vec<u32> =
        ends().filter_map(|e| if let End::Vertex(v) = e { Some(v) } else { None }).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let at = vec![Vec::new(); n_crossings + vertices.len()];
    let used = vec![false; segments.len()];
    let mut graph = Graph { segments, n_crossings, vertices, at, used };
    for (i, segment) in (0..).zip(segments) {
        for end in segment.ends {
            let node = graph.node(end);
            graph.at[node].push(i);
        }
    }
    let mut chains = Vec::new();
    for closed in [false, true] {
        for (i, segment) in (0..).zip(segments) {
            for end in segment.ends {
                if !graph.used[i as usize] && (closed || !graph.goes_on(end)) {
                    chains.push(graph.walk(end, i));
                }
            }
        }
    }
    chains
}
