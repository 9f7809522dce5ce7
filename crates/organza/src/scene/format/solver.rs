//! How time steps are made and solved.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How time steps are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// First order; damps all motion the more the longer the step.
    ImplicitEuler,
    /// Second order, and still damps what is too fast for the step (L-stable).
    #[default]
    Sdirk2,
}

/// The nonlinear solve of each time step, by Newton's method.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Newton {
    /// Most iterations per solve. 1 is the fast setting: one linearised step, without a test for
    /// convergence. With more, a step that has not converged is reported. While triangles are out of
    /// their strain limits, there may be three times as many.
    #[schemars(range(min = 1))]
    pub max_iterations: u32,
    /// The solve ends when an iteration changes no velocity by more than this (m/s).
    pub tolerance: f64,
}

impl Newton {
    /// True for the fast setting, where one iteration is what was asked for.
    #[must_use]
    pub fn is_fast(&self) -> bool {
        self.max_iterations == 1
    }
}

impl Default for Newton {
    fn default() -> Self {
        Self { max_iterations: 20, tolerance: 1e-3 }
    }
}

/// The linear solver inside the nonlinear one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LinearSolver {
    /// Chosen by size and stiffness.
    #[default]
    Auto,
    /// Sparse Cholesky, factored anew for every solve.
    Cholesky,
    /// Conjugate gradients, preconditioned by a Cholesky factor of an earlier step.
    StaleCholesky,
    /// Conjugate gradients, preconditioned by the 3 × 3 diagonal blocks.
    Pcg,
}
