//! What a remeshing call did.

use crate::quality::MeshQuality;
use mesh_core::Edit;

/// What a call did and what it left.
#[derive(Clone, Debug, PartialEq)]
pub struct RemeshReport {
    /// Number of edges split.
    pub n_splits: usize,
    /// Number of edges flipped.
    pub n_flips: usize,
    /// Number of vertices removed.
    pub n_collapses: usize,
    /// Every edit in order: fields that live on the mesh follow by replaying them.
    pub journal: Vec<Edit>,
    /// Answers of the sizing field that were not valid and counted as the coarsest.
    pub n_bad_metrics: usize,
    /// True if splitting stopped at `max_vertices`.
    pub vertex_limit_reached: bool,
    /// Number of times that flipping around an edit was cut short: the metric changes so fast that
    /// no arrangement of the diagonals is Delaunay for all of it.
    pub n_flip_limits: usize,
    /// The mesh afterwards, sized by the metrics that the call used.
    pub quality: MeshQuality,
}

impl RemeshReport {
    /// Number of edits.
    pub fn n_edits(&self) -> usize {
        self.journal.len()
    }

    /// True if the call ran into one of its limits.
    pub fn limit_reached(&self) -> bool {
        self.vertex_limit_reached || self.n_flip_limits > 0
    }
}
