//! Settings of a remeshing call and what can be wrong with them.

use crate::metric::Metric;
use nalgebra::Matrix3;

/// How to remesh. The numbers hold for a whole run; the slices name what this call must respect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RemeshSettings<'a> {
    /// Edits do not take a triangle's [aspect](mesh_core::geometry::aspect) below this, and metrics
    /// are made at most as anisotropic: their two sizes differ by a factor of at most 1 /
    /// `aspect_min`. From 0 to 1; above 1/2 hardly any collapse is possible (no unit).
    pub aspect_min: f64,
    /// A collapse must leave all its edges shorter than 1 − `hysteresis`, so that they are not
    /// split again at once (no unit).
    pub hysteresis: f64,
    /// Splitting stops at this many vertices, and the report says so.
    pub max_vertices: usize,
    /// Names ([`Mesh::uids`](mesh_core::Mesh::uids)) of vertices that are never removed: pins,
    /// handles. Names that no longer exist are ignored.
    pub keep: &'a [u64],
    /// Panels whose triangles are left exactly as they are.
    pub fixed_panels: &'a [u32],
    /// Least and largest principal stretch that a flip or a collapse may leave, by panel (1), on both
    /// sides of 1: an edit that would strain a triangle further is refused, unless one of those it
    /// replaces was strained as much. Panels beyond the end of the slice are not limited.
    pub stretch_limits: &'a [[f64; 2]],
    /// Names of vertices around which edges are only split, which leaves the surface where it is: for
    /// tight places, where a flip or a collapse could take cloth through something. Names that do not
    /// exist are ignored.
    pub hold: &'a [u64],
    /// How far a single flip or collapse may move the surface, by vertex, as a metric N on displacements d
    /// in world space (1/m²): dᵀ N d ≤ 1. A length l in all directions is 1 / l², no limit is 0; cameras
    /// limit what shows in pixels. Empty for no limit anywhere.
    pub shift: &'a [Matrix3<f64>],
    /// Metric wanted for the proximity of obstacles, one per triangle (1/m²); handed to the sizing
    /// field.
    pub obstacle: Option<&'a [Metric]>,
}

impl Default for RemeshSettings<'_> {
    fn default() -> Self {
        RemeshSettings {
            aspect_min: 0.2,
            hysteresis: 0.2,
            max_vertices: 200_000,
            keep: &[],
            fixed_panels: &[],
            stretch_limits: &[],
            hold: &[],
            shift: &[],
            obstacle: None,
        }
    }
}

/// Why a call was refused; nothing was changed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RemeshError {
    /// A setting out of range.
    #[error("{name} is {value}; it must be {range}")]
    Setting {
        /// Which one.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
    /// The obstacle metric does not fit the mesh.
    #[error("the obstacle metric has {got} entries for {expected} triangles")]
    Obstacle {
        /// Number of triangles.
        expected: usize,
        /// Number of entries.
        got: usize,
    },
    /// The limits of how far the surface may move do not fit the mesh.
    #[error("shift has {got} entries for {expected} vertices")]
    Shift {
        /// Number of vertices.
        expected: usize,
        /// Number of entries.
        got: usize,
    },
    /// The metrics were worked out for another state of the mesh.
    #[error("the metrics belong to epoch {got} of the mesh, which is now at {expected}")]
    Stale {
        /// Epoch of the mesh.
        expected: u64,
        /// Epoch of the metrics.
        got: u64,
    },
}

impl RemeshSettings<'_> {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`RemeshError::Setting`] names the first value out of range.
    pub fn check(&self) -> Result<(), RemeshError> {
        let fail = |name, value, range| Err(RemeshError::Setting { name, value, range });
        if !(0.0..=1.0).contains(&self.aspect_min) {
            return fail("aspect_min", self.aspect_min, "from 0 to 1");
        }
        if !(0.0..1.0).contains(&self.hysteresis) {
            return fail("hysteresis", self.hysteresis, "from 0 to below 1");
        }
        for &[min, max] in self.stretch_limits {
            if !(0.0..=1.0).contains(&min) {
                return fail("stretch_limits (least)", min, "from 0 to 1");
            }
            if !(1.0..=f64::INFINITY).contains(&max) {
                return fail("stretch_limits (largest)", max, "at least 1");
            }
        }
        Ok(())
    }

    /// Checks that there is a limit for every vertex, or none.
    pub(crate) fn check_shift(&self, n_vertices: usize) -> Result<(), RemeshError> {
        let got = self.shift.len();
        if got > 0 && got != n_vertices {
            return Err(RemeshError::Shift { expected: n_vertices, got });
        }
        Ok(())
    }
}
