//! Collapsing edges, the shortest first, as long as all that they leave stays valid.

use crate::driver::Driver;
use crate::star::{Removal, Star};
use mesh_core::{Edit, VertexId, par};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Marks a vertex that has been removed.
const GONE: u32 = u32::MAX;

/// The collapse that is best for a vertex: the squared size of the shortest edge along which it may
/// go, and the neighbour there.
type Verdict = Option<(f64, VertexId)>;

/// A possible collapse: the bits of its edge's squared size, then the local names of the vertex and
/// its neighbour and the vertex's stamp.
type Entry = Reverse<(u64, u32, u32, u32)>;

/// The vertices by local names, which stay as indices change: their index at the start of the pass.
struct Names {
    index_of: Vec<u32>,
    local_of: Vec<u32>,
}

/// Candidates for collapses, kept up to date.
struct Candidates {
    queue: BinaryHeap<Entry>,
    names: Names,
    /// Number of verdicts so far by local name: entries with an older stamp do not count.
    stamp: Vec<u32>,
}

impl Driver<'_> {
    /// Collapses edges until no collapse is admissible.
    pub(crate) fn collapse_all(&mut self) {
        let mut verdicts = vec![None; self.cloth.mesh.n_vertices()];
        {
            let this = &*self;
            par::fill(&mut verdicts, |v| this.examine(VertexId(v as u32), false));
        }
        let mut candidates = Candidates::new(&verdicts);
        let mut touched: Vec<u32> = Vec::new();
        while let Some(Reverse((_, local, to, stamp))) = candidates.queue.pop() {
            if candidates.stamp[local as usize] != stamp {
                continue;
            }
            let removed = VertexId(candidates.names.index_of[local as usize]);
            let kept = VertexId(candidates.names.index_of[to as usize]);
            touched.clear();
            if self.collapse_edge(removed, kept, &mut candidates.names, &mut touched) {
                self.renew(&mut candidates, &mut touched);
            } else {
                candidates.judge(local, self.examine(removed, true));
            }
        }
    }

    /// Merges `removed` into `kept` and flips around it; names the vertices whose stars changed.
    fn collapse_edge(
        &mut self,
        removed: VertexId,
        kept: VertexId,
        names: &mut Names,
        touched: &mut Vec<u32>,
    ) -> bool {
        let mesh = &self.cloth.mesh;
        let star = Star::of(mesh, removed);
        let Some(removal) = self.removals(removed, &star).find(|r| r.kept == kept) else {
            return false;
        };
        let moved: Vec<_> =
            removal.survivors(&star).map(|(e, side)| (e, *self.metrics.of(side))).collect();
        let ring: Vec<VertexId> = mesh.neighbours(removed).collect();
        let Ok(edit) = self.cloth.collapse(removed, kept) else { return false };
        let Edit::Collapse { triangles, .. } = edit else { return false };
        self.metrics.follow_collapse(removed, triangles, &moved);
        self.journal.push(edit);
        self.kept.swap_remove(removed.index());
        self.held.swap_remove(removed.index());
        self.collapse_passes_limit_on(removed, &ring);
        touched.extend(ring.iter().map(|v| names.local_of[v.index()]));
        let local_kept = names.local_of[kept.index()];
        names.remove(removed);

        let kept = VertexId(names.index_of[local_kept as usize]);
        let around: Star = Star::of(&self.cloth.mesh, kept);
        for h in around.spokes() {
            self.queue_flips(h.triangle());
        }
        self.settle();
        for t in self.flipped.iter().flatten() {
            let corners = self.cloth.mesh.triangles()[t.index()];
            touched.extend(corners.map(|v| names.local_of[v as usize]));
        }
        true
    }

    /// New verdicts for the touched vertices.
    fn renew(&self, candidates: &mut Candidates, touched: &mut Vec<u32>) {
        touched.sort_unstable();
        touched.dedup();
        for &local in touched.iter() {
            let v = VertexId(candidates.names.index_of[local as usize]);
            candidates.judge(local, self.examine(v, false));
        }
    }

    /// The best collapse of a vertex. What depends on its star alone is checked always; the topology,
    /// which depends on its neighbours' stars, hardly ever refuses off the lines (whose bends do) and
    /// is checked there only if asked for.
    fn examine(&self, v: VertexId, with_topology: bool) -> Verdict {
        let mesh = &self.cloth.mesh;
        if self.kept[v.index()] {
            return None;
        }
        if self.held[v.index()] || mesh.neighbours(v).any(|i| self.held[i.index()]) {
            return None;
        }
        let star = Star::of(mesh, v);
        if self.has_fixed() && star.spokes().iter().any(|h| self.is_fixed(h.triangle())) {
            return None;
        }
        let is_checked = with_topology || star.is_open() || self.metrics.on_line[v.index()];
        let mut removals = self.valid_removals(v, &star);
        removals.sort_unstable_by(|p, q| p.0.total_cmp(&q.0).then(p.1.kept.cmp(&q.1.kept)));
        let is_admissible = |removal: &Removal| {
            self.keeps_shape(&star, removal)
                && self.collapse_stays_near(v, &star, removal)
                && (!is_checked || mesh.can_collapse(v, removal.kept, |_, _| {}).is_ok())
        };
        let best = removals.iter().find(|(_, removal)| is_admissible(removal));
        best.map(|(size_squared, removal)| (*size_squared, removal.kept))
    }
}

impl Names {
    fn remove(&mut self, v: VertexId) {
        self.index_of[self.local_of[v.index()] as usize] = GONE;
        self.local_of.swap_remove(v.index());
        if let Some(&renamed) = self.local_of.get(v.index()) {
            self.index_of[renamed as usize] = v.0;
        }
    }
}

impl Candidates {
    fn new(verdicts: &[Verdict]) -> Self {
        let n = verdicts.len() as u32;
        let names = Names { index_of: (0..n).collect(), local_of: (0..n).collect() };
        let mut candidates =
            Candidates { queue: BinaryHeap::new(), names, stamp: vec![0; verdicts.len()] };
        for (local, verdict) in verdicts.iter().enumerate() {
            candidates.judge(local as u32, *verdict);
        }
        candidates
    }

    fn judge(&mut self, local: u32, verdict: Verdict) {
        let slot = local as usize;
        self.stamp[slot] += 1;
        if let Some((size_squared, kept)) = verdict {
            let to = self.names.local_of[kept.index()];
            self.queue.push(Reverse((size_squared.to_bits(), local, to, self.stamp[slot])));
        }
    }
}
