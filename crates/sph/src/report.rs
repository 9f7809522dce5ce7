//! What a step did.

/// Counts of one or several steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepReport {
    /// Time steps.
    pub steps: u64,
    /// Particles, summed over the steps.
    pub particles: u64,
    /// Pairs of fluid particles in the lists of neighbours, summed over the steps.
    pub pairs: u64,
    /// How often neighbours were listed anew.
    pub listings: u64,
    /// New particles.
    pub emitted: u64,
    /// Removed particles.
    pub drained: u64,
}

impl StepReport {
    /// Adds the counts of further steps.
    pub fn add(&mut self, other: &StepReport) {
        self.steps += other.steps;
        self.particles += other.particles;
        self.pairs += other.pairs;
        self.listings += other.listings;
        self.emitted += other.emitted;
        self.drained += other.drained;
    }
}
