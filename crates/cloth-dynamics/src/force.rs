//! What the solver sees of the physics: potentials of the positions.

use crate::element::Stiffness;
use crate::part::Part;
use crate::solver::{BlockMatrix, BlockPattern, PatternBuilder, PatternError};
use mesh_core::World3;

/// What a stage of a step knows before it is solved. Everything a potential lags (wind normals,
/// strains for damping) is taken from here, so that the rest is an exact potential of `x`.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// Positions at the start of the step (m).
    pub x_t0: &'a [World3],
    /// Positions (m) against which the stage measures velocity: v(x) = (x − base)/h.
    pub base: &'a [World3],
    /// Step of the implicit stage (s).
    pub h: f64,
}

/// One contribution to the incremental potential: an energy (J) with exact gradient (N) and a
/// positive semi-definite stiffness (N/m).
pub trait Force: Send + Sync {
    /// A short name for reports.
    fn name(&self) -> &'static str;

    /// Names the pairs of vertices that share stiffness.
    ///
    /// # Errors
    /// If the matrix would be too large.
    fn couple(&self, pattern: &mut PatternBuilder) -> Result<(), PatternError>;

    /// Called once the pattern is known, and again whenever it changes.
    fn bind(&mut self, pattern: &BlockPattern);

    /// Called at the start of every implicit stage.
    fn begin(&mut self, stage: Stage<'_>);

    /// Called with a Newton step before it is made: what the stiffness lags may be taken from the
    /// linear prediction at `x + step`.
    fn predict(&mut self, x: &[World3], step: &[World3]);

    /// Energy (J).
    fn energy(&self, x: &[World3]) -> f64;

    /// Adds the gradient of the energy (N).
    fn add_gradient(&self, x: &[World3], gradient: &mut [World3]);

    /// Adds gradient (N) and stiffness (N/m). What is called exact may leave out couplings that are
    /// small beside inertia in a step.
    fn add_system(
        &self,
        x: &[World3],
        kind: Stiffness,
        gradient: &mut [World3],
        stiffness: &mut BlockMatrix,
    );

    /// The same force on a part of the cloth; `None` if it has none there.
    fn part(&self, part: &Part) -> Option<Box<dyn Force>>;
}
