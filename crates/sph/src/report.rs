//! What a step did.

/// Counts of one or several steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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
    /// How often a single particle got a list of its own, instead of lists anew for all.
    pub mended: u64,
    /// New particles.
    pub emitted: u64,
    /// Removed particles.
    pub drained: u64,
    /// How often a particle was stopped at a moving surface, summed over the steps.
    pub stopped: u64,
    /// How often moving surfaces left a particle no room, so that it may have come through one of them.
    pub squeezed: u64,
    /// Wall time by stage.
    pub seconds: Seconds,
}

/// Seconds of wall time by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seconds {
    /// New velocities and positions, emitters and sinks (s).
    pub motion: f64,
    /// Listing neighbours (s).
    pub neighbours: f64,
    /// Densities of all particles (s).
    pub density: f64,
    /// Accelerations of all particles (s).
    pub force: f64,
    /// Densities and accelerations by what has changed (s).
    pub changes: f64,
    /// Meeting moving surfaces (s).
    pub sheets: f64,
}

impl Seconds {
    /// Adds the times of further steps.
    fn add(&mut self, other: &Seconds) {
        self.motion += other.motion;
        self.neighbours += other.neighbours;
        self.density += other.density;
        self.force += other.force;
        self.changes += other.changes;
        self.sheets += other.sheets;
    }

    /// All stages (s).
    pub fn total(&self) -> f64 {
        self.motion + self.neighbours + self.density + self.force + self.changes + self.sheets
    }
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
        self.mended += other.mended;
        self.emitted += other.emitted;
        self.drained += other.drained;
        self.stopped += other.stopped;
        self.squeezed += other.squeezed;
        self.seconds.add(&other.seconds);
    }
}
