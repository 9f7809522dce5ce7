//! The silhouette rule: view factors that jump from triangle to triangle.

use mesh_core::{HalfEdge, Mesh, par};

/// Koh2014 §3.3: where the factors on the sides of an edge differ by more than the threshold, the
/// lesser one is raised to the mean of the two; of several means the greatest counts. All means are of
/// the factors as they were.
pub(crate) fn smoothed(mesh: &Mesh, factors: &[f64], threshold: f64) -> Vec<f64> {
    let mut raised = vec![0.0; factors.len()];
    par::fill(&mut raised, |t| {
        let own = factors[t];
        let across = (0..3).filter_map(|k| mesh.twin(HalfEdge((3 * t + k) as u32)));
        across.map(|g| factors[g.triangle().index()]).fold(own, |most, other| {
            if other - own > threshold { most.max(0.5 * (own + other)) } else { most }
        })
    });
    raised
}
