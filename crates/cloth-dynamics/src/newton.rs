//! Newton's method with line search on the incremental potential of an implicit stage,
//!
//!   Φ(x) = 1/(2h²) Σ mᵢ |xᵢ − x̃ᵢ|² + V(x),
//!
//! whose minimum is the new position. Every accepted iteration lowers Φ, so a stage cannot blow up
//! at any stiffness; stopping early costs accuracy, is allowed ("one iteration is the fast setting")
//! and is always reported.

use crate::solver::{LinearError, LinearReport, LinearSolver, clear_fixed};
use crate::system::System;
use mesh_core::{World3, par};
use nalgebra::Matrix3;
use std::time::Instant;

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewtonSettings {
    /// The most iterations, each one linear solve.
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
    /// Halvings of a step in the line search.
    pub halvings: usize,
    /// Second-order corrections in the line search.
    pub corrections: usize,
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
}

impl SolveReport {
    /// Adds another report.
    pub fn add(&mut self, other: &SolveReport) {
        self.iterations += other.iterations;
        self.linear_iterations += other.linear_iterations;
        self.factorisations += other.factorisations;
        self.analyses += other.analyses;
        self.halvings += other.halvings;
        self.corrections += other.corrections;
        self.stages += other.stages;
        self.unconverged += other.unconverged;
        self.residual = self.residual.max(other.residual);
        self.assembly_s += other.assembly_s;
        self.linear_s += other.linear_s;
        self.energy_s += other.energy_s;
    }

    fn note(&mut self, linear: &LinearReport) {
        self.linear_iterations += linear.iterations;
        self.factorisations += usize::from(linear.refactored);
        self.analyses += usize::from(linear.analysed);
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
    /// The linear solver failed.
    #[error("at time {time} s: {source}")]
    Linear {
        /// Time at the end of the stage (s).
        time: f64,
        /// What it said.
        source: LinearError,
    },
}

/// The stage to be solved: inertia and constraints.
pub(crate) struct Inertia<'a> {
    /// Masses (kg).
    pub mass: &'a [f64],
    /// Where each vertex would go without forces (m).
    pub target: &'a [World3],
    /// Step (s).
    pub h: f64,
    /// Time at the end of the stage (s).
    pub time: f64,
    /// Vertices that do not move from where the start has them.
    pub fixed: &'a [bool],
}

impl Inertia<'_> {
    fn potential(&self, system: &System, x: &[World3]) -> f64 {
        let kinetic = par::sum(x.len(), |i| self.mass[i] * (x[i] - self.target[i]).norm_squared());
        kinetic / (2.0 * self.h * self.h) + system.energy(x)
    }
}

/// Share of the predicted decrease that a step must reach (Armijo).
const SUFFICIENT: f64 = 1e-4;
/// The most halvings before a direction is given up.
const MAX_HALVINGS: usize = 30;
/// The most second-order corrections of one trial.
const MAX_CORRECTIONS: usize = 3;
/// Shorter steps are not corrected: they hardly turn anything.
const LEAST_CORRECTED: f64 = 0.25;

/// Minimises the incremental potential from the better of the given starts.
pub(crate) fn minimise(
    system: &mut System,
    solver: &mut dyn LinearSolver,
    inertia: &Inertia<'_>,
    starts: &[Vec<World3>],
    settings: &NewtonSettings,
) -> Result<(Vec<World3>, SolveReport), SolveError> {
    let (h, time) = (inertia.h, inertia.time);
    let mut report = SolveReport { stages: 1, ..Default::default() };
    let clock = Instant::now();
    let valued = starts.iter().map(|x| (inertia.potential(system, x), x));
    let best =
        valued.filter(|(phi, _)| phi.is_finite()).reduce(|a, b| if b.0 < a.0 { b } else { a });
    let (mut phi, mut x) = match best {
        Some((phi, x)) => (phi, x.clone()),
        None => return Err(SolveError::NotFinite { time, h }),
    };
    report.energy_s += clock.elapsed().as_secs_f64();

    let n = x.len();
    let mut direction = vec![World3::zeros(); n];
    let mut trial = vec![World3::zeros(); n];
    let mut converged = false;
    while report.iterations < settings.max_iterations && !converged {
        let clock = Instant::now();
        let mut rhs = assemble(system, inertia, &x);
        report.assembly_s += clock.elapsed().as_secs_f64();
        if !rhs.iter().all(|g| g.iter().all(|c| c.is_finite())) {
            return Err(SolveError::NotFinite { time, h });
        }

        let clock = Instant::now();
        for g in &mut rhs {
            *g = -*g;
        }
        direction.fill(World3::zeros());
        let linear = solver
            .solve(&system.matrix, &rhs, &mut direction)
            .map_err(|source| SolveError::Linear { time, source })?;
        report.note(&linear);
        report.linear_s += clock.elapsed().as_secs_f64();
        report.iterations += 1;

        let clock = Instant::now();
        let slope = -par::sum(n, |i| rhs[i].dot(&direction[i]));
        let largest = direction.iter().map(|d| d.norm_squared()).fold(0.0, f64::max).sqrt();
        report.residual = largest / h;
        converged = report.residual <= settings.tolerance;
        // Below this a change of Φ is rounding.
        let noise = 1e-13 * phi.abs();
        let mut share = 1.0;
        let mut accepted = None;
        let linear_before = report.linear_s;
        for _ in 0..=MAX_HALVINGS {
            let bound = phi + SUFFICIENT * share * slope + noise;
            // What is predicted, corrected and lagged is the step as it is tried.
            system.predict(&x, &direction);
            par::fill(&mut trial, |i| x[i] + direction[i]);
            let mut value = inertia.potential(system, &trial);
            let mut corrections = 0;
            let fits = |value: f64| value <= bound;
            while !fits(value) && share >= LEAST_CORRECTED && corrections < MAX_CORRECTIONS {
                let before = value;
                value = correct(system, solver, inertia, &x, &mut trial, &mut report)?;
                corrections += 1;
                // Give up on a correction that does not at least halve the excess.
                let halved = value - bound <= 0.5 * (before - bound);
                if !halved {
                    break;
                }
            }
            if fits(value) {
                accepted = Some(value);
                break;
            }
            share *= 0.5;
            par::for_each(&mut direction, |_, d| *d *= 0.5);
            report.halvings += 1;
        }
        report.energy_s += clock.elapsed().as_secs_f64() - (report.linear_s - linear_before);
        let Some(value) = accepted else {
            // No descent left within rounding: report it instead of going in circles.
            converged = false;
            break;
        };
        std::mem::swap(&mut x, &mut trial);
        phi = value;
        converged &= share == 1.0;
    }
    report.unconverged = usize::from(!converged);
    Ok((x, report))
}

/// Second-order correction of a trial (Nocedal2006 §15.6): takes the stress away that is there only
/// because the step was straight; returns the new potential.
///
/// A Newton step that turns stiff cloth by an angle θ stretches it by θ²/2, and on the curved valley
/// of stiff energies a line search alone would then creep (the Maratos effect). The factor is there
/// already, and the stretch is what it knows best. The excess stress acts in the directions it has at
/// `x`: those of the trial are turned, and their error would push along the soft valley.
fn correct(
    system: &System,
    solver: &mut dyn LinearSolver,
    inertia: &Inertia<'_>,
    x: &[World3],
    trial: &mut [World3],
    report: &mut SolveReport,
) -> Result<f64, SolveError> {
    let mut rhs = system.remainder(x, trial);
    for g in &mut rhs {
        *g = -*g;
    }
    clear_fixed(&mut rhs, inertia.fixed);
    if !rhs.iter().all(|g| g.iter().all(|c| c.is_finite())) {
        return Ok(f64::NAN);
    }
    let clock = Instant::now();
    let mut step = vec![World3::zeros(); trial.len()];
    let linear = solver
        .solve_again(&system.matrix, &rhs, &mut step)
        .map_err(|source| SolveError::Linear { time: inertia.time, source })?;
    report.note(&linear);
    report.corrections += 1;
    report.linear_s += clock.elapsed().as_secs_f64();
    for (x, d) in trial.iter_mut().zip(&step) {
        *x += d;
    }
    Ok(inertia.potential(system, trial))
}

/// Sets the matrix to the projected Hessian of Φ with fixed vertices taken out; returns ∇Φ.
fn assemble(system: &mut System, inertia: &Inertia<'_>, x: &[World3]) -> Vec<World3> {
    let scale = 1.0 / (inertia.h * inertia.h);
    let mut gradient: Vec<World3> = vec![World3::zeros(); x.len()];
    par::fill(&mut gradient, |i| (x[i] - inertia.target[i]) * (inertia.mass[i] * scale));
    system.assemble(x, &mut gradient);
    for (i, m) in inertia.mass.iter().enumerate() {
        *system.matrix.diagonal_mut(i) += Matrix3::identity() * (m * scale);
    }
    if inertia.fixed.contains(&true) {
        system.matrix.eliminate(inertia.fixed);
        clear_fixed(&mut gradient, inertia.fixed);
    }
    gradient
}
