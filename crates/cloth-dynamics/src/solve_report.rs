//! When a solve stops, what it did, and why it failed.

use crate::solver::{LinearError, LinearReport, PatternError};
use mesh_core::World3;

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonSettings {
    /// The most iterations, each one linear solve; up to three times as many while triangles are out
    /// of their strain limits. Those from a start that proved no good do not count, in the rare stage
    /// that has such.
    pub max_iterations: usize,
    /// The stage is converged when no vertex would change its velocity by more than this (m/s).
    pub tolerance: f64,
}

impl Default for NewtonSettings {
    fn default() -> Self {
        NewtonSettings { max_iterations: 30, tolerance: 1e-3 }
    }
}

/// What a solve did. Sums over the stages of a step, and over steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolveReport {
    /// Newton iterations.
    pub iterations: usize,
    /// Iterations of the linear solver; a direct solve counts none.
    pub linear_iterations: usize,
    /// Numeric factorisations.
    pub factorisations: usize,
    /// Symbolic analyses.
    pub analyses: usize,
    /// Halvings of a step that did not lower the potential.
    pub halvings: usize,
    /// Solved stages.
    pub stages: usize,
    /// Stages that stopped before they reached the tolerance.
    pub unconverged: usize,
    /// Largest velocity change of a last iteration (m/s).
    pub residual: f64,
    /// Time spent on forces and matrix assembly (s).
    pub assembly_s: f64,
    /// Time spent in the linear solver (s).
    pub linear_s: f64,
    /// Time spent on energies in the line search (s).
    pub energy_s: f64,
    /// Time spent on finding contacts and on keeping ways free (s).
    pub contact_s: f64,
    /// Contacts with an energy, over all stages.
    pub touches: usize,
    /// Vertices whose way was shortened in the end, because something was in it.
    pub shortened: usize,
    /// What restraint did, if there is any.
    pub rest: RestReport,
}

/// What restraint did and saved. Sums over stages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RestReport {
    /// Stages under restraint, those slept through included.
    pub stages: usize,
    /// Stages slept through: nothing was evaluated, assembled or solved.
    pub slept: usize,
    /// Linear systems of restrained stages.
    pub solves: usize,
    /// Vertices in these, summed.
    pub unknowns: usize,
    /// Vertices that no force was evaluated on, summed over stages.
    pub untouched: usize,
    /// Vertices that woke because their momentum said so.
    pub woken: usize,
    /// Times that forces and matrix were built for a part of the cloth.
    pub parts: usize,
    /// Stages made again, because they moved more than had been thought.
    pub redone: usize,
    /// Vertices at rest whose momentum was cut to what may rest, in stages that did not converge.
    pub cut: usize,
}

impl SolveReport {
    /// Adds another report.
    pub fn add(&mut self, other: &SolveReport) {
        self.iterations += other.iterations;
        self.linear_iterations += other.linear_iterations;
        self.factorisations += other.factorisations;
        self.analyses += other.analyses;
        self.halvings += other.halvings;
        self.stages += other.stages;
        self.unconverged += other.unconverged;
        self.residual = self.residual.max(other.residual);
        self.assembly_s += other.assembly_s;
        self.linear_s += other.linear_s;
        self.energy_s += other.energy_s;
        self.contact_s += other.contact_s;
        self.touches += other.touches;
        self.shortened += other.shortened;
        self.rest.add(&other.rest);
    }

    pub(crate) fn note(&mut self, linear: &LinearReport) {
        self.linear_iterations += linear.iterations;
        self.factorisations += usize::from(linear.refactored);
        self.analyses += usize::from(linear.analysed);
    }
}

impl RestReport {
    /// Adds another report.
    pub fn add(&mut self, other: &RestReport) {
        self.stages += other.stages;
        self.slept += other.slept;
        self.solves += other.solves;
        self.unknowns += other.unknowns;
        self.untouched += other.untouched;
        self.woken += other.woken;
        self.parts += other.parts;
        self.redone += other.redone;
        self.cut += other.cut;
    }
}

/// Why a step could not be made; the state is as before.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// Energies or forces overflowed.
    #[error(
        "the energy of the cloth is not finite at time {time} s: positions, velocities or \
         stiffness are too large for the step of {h} s"
    )]
    NotFinite {
        /// Time at the end of the stage (s).
        time: f64,
        /// Step of the stage (s).
        h: f64,
    },
    /// Cloth is in the way of obstacles or handles that leave it no room.
    #[error(
        "at time {time} s: the cloth is caught between obstacles or handles at ({}, {}, {}) m",
        place.x, place.y, place.z
    )]
    Caught {
        /// Time at the end of the stage (s).
        time: f64,
        /// Where (m).
        place: World3,
    },
    /// What was in the way left the cloth with more energy than it would have had at rest.
    #[error("at time {time} s: impacts are too hard for the step of {h} s")]
    Rise {
        /// Time at the end of the stage (s).
        time: f64,
        /// Step of the stage (s).
        h: f64,
    },
    /// The contacts couple more vertices than the matrix can hold.
    #[error(transparent)]
    Pattern(#[from] PatternError),
    /// A policy of restraint asks for a kinetic energy that implicit steps cannot have.
    #[error("at time {time} s: {source}")]
    Restraint {
        /// Time at the start of the stage (s).
        time: f64,
        /// What is wrong.
        source: arps::StepError,
    },
    /// The linear solver failed.
    #[error("at time {time} s: {source}")]
    Linear {
        /// Time at the end of the stage (s).
        time: f64,
        /// What it said.
        source: LinearError,
    },
}
