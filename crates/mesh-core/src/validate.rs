//! The invariants of the corner table, checked one by one.

use crate::construct::MeshError;
use crate::ids::{HalfEdge, NONE, VertexId};
use crate::mesh::Mesh;

impl Mesh {
    /// Checks every invariant: lengths, twins, one complete fan per vertex, no doubled edge,
    /// positive material areas, unique names. Cost: one sort of the half-edges.
    ///
    /// # Errors
    /// The first invariant that does not hold.
    pub fn validate(&self) -> Result<(), MeshError> {
        let broken = |text: String| Err(MeshError::Broken(text));
        let (n, m) = (self.n_vertices(), self.n_triangles());
        if self.twin.len() != 3 * m || self.material.len() != m || self.panel.len() != m {
            return broken(format!("lengths: {m} triangles, {} half-edges", self.twin.len()));
        }
        let mut degree = vec![0usize; n];
        for h in (0..3 * m as u32).map(HalfEdge) {
            let (a, b) = (self.origin(h), self.dest(h));
            if a.index() >= n || a == b {
                return broken(format!("half-edge {} runs from {} to {}", h.0, a.0, b.0));
            }
            degree[a.index()] += 1;
            if let Some(g) = self.twin(h)
                && (g.index() >= 3 * m
                    || self.twin(g) != Some(h)
                    || (self.origin(g), self.dest(g)) != (b, a))
            {
                return broken(format!("half-edge {} and its twin {} disagree", h.0, g.0));
            }
        }
        let mut directed: Vec<(u32, u32)> =
            (0..3 * m as u32).map(HalfEdge).map(|h| (self.origin(h).0, self.dest(h).0)).collect();
        directed.sort_unstable();
        if let Some(pair) = directed.windows(2).find(|pair| pair[0] == pair[1]) {
            return broken(format!("two half-edges run from {} to {}", pair[0].0, pair[0].1));
        }
        for v in self.vertices() {
            self.check_fan(v, degree[v.index()])?;
        }
        for t in self.triangle_ids() {
            let area = self.area(t);
            if area.is_nan() || area <= 0.0 {
                return Err(MeshError::MaterialArea { triangle: t.index(), area });
            }
        }
        self.check_uids()
    }

    fn check_fan(&self, v: VertexId, degree: usize) -> Result<(), MeshError> {
        let broken = |text: String| Err(MeshError::Broken(text));
        let out = self.out[v.index()];
        if out == NONE || out as usize >= self.twin.len() || self.origin(HalfEdge(out)) != v {
            return broken(format!("vertex {} has the outgoing half-edge {out}", v.0));
        }
        let fan: Vec<HalfEdge> = self.outgoing(v).take(degree + 1).collect();
        if fan.len() != degree || fan.iter().any(|&h| self.origin(h) != v) {
            return broken(format!("vertex {}: fan of {}, degree {degree}", v.0, fan.len()));
        }
        // A fan that is open at its end must be anchored at its start.
        let open = fan.last().is_some_and(|h| self.is_boundary_edge(h.prev()));
        if open != self.is_boundary_vertex(v) {
            return broken(format!("vertex {} is not anchored at its boundary edge", v.0));
        }
        Ok(())
    }

    pub(crate) fn check_uids(&self) -> Result<(), MeshError> {
        let mut uids = self.uid.clone();
        uids.sort_unstable();
        let repeated = uids.windows(2).any(|pair| pair[0] == pair[1]);
        if repeated || uids.last().is_some_and(|&last| last >= self.next_uid) {
            return Err(MeshError::Broken("vertex names are not unique".into()));
        }
        Ok(())
    }
}
