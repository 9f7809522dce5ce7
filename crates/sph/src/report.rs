//! What a step did.

/// Counts of one or several steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepReport {
    /// Time steps.
    pub steps: u64,
    /// Particles, summed over the steps.
    pub particles: u64,
    /// Particles that changed their place, summed over the steps.
    pub moved: u64,
    /// Particles with a new position, velocity or pressure, summed over the steps without a sweep.
    pub changed: u64,
    /// Steps in which everything was computed anew.
    pub sweeps: u64,
    /// Pairs of fluid particles that were looked at for densities, summed over the steps. In a sweep
    /// these are all pairs in the lists of neighbours.
    pub density_pairs: u64,
    /// The same for accelerations.
    pub force_pairs: u64,
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
        self.moved += other.moved;
        self.changed += other.changed;
        self.sweeps += other.sweeps;
        self.density_pairs += other.density_pairs;
        self.force_pairs += other.force_pairs;
        self.listings += other.listings;
        self.emitted += other.emitted;
        self.drained += other.drained;
    }
}
