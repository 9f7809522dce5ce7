//! Adaptively restrained particles: in any particle system, what hardly moves rests, and wakes when
//! its momentum says so (Manteaux2013, with its formulas corrected and its implicit scheme cured).
//!
//! A particle keeps its momentum p, and forces go on changing it. What is restrained is the way from
//! momentum to motion: the kinetic energy ‖p‖²/2m becomes a function T(p) that is flat up to a
//! threshold p_r, and the *effective velocity* ∂T/∂p is zero there. Since the motion still comes from
//! an energy, the adaptive Hamiltonian H_AR = Σ T + V is conserved, and so is momentum, exactly.
//! Between two particles at rest no force needs to be computed.
//!
//! This restrains a spring–mass system of one's own, a hanging chain, with a policy of one's own:
//! what is higher up rests sooner.
//!
//! ```
//! use arps::{Explicit, Held, Now, Particle, Particles, Restraint, Scheme, Speed, Vector3};
//!
//! /// Rest below `speed`, and sooner above a height.
//! struct Lazy {
//!     speed: Speed,
//!     height: f64, // m
//! }
//!
//! impl Restraint for Lazy {
//!     fn at(&self, particle: &Particle) -> Held {
//!         let factor = if particle.x.z > self.height { 2.0 } else { 1.0 };
//!         self.speed.at(particle).scaled(factor)
//!     }
//! }
//!
//! /// Gravity, damping, and springs of 50 N/m and 0.1 m between neighbours and from the ceiling.
//! fn forces(now: Now<'_>, f: &mut [Vector3]) {
//!     for i in 0..now.x.len() {
//!         let above = if i == 0 { Vector3::zeros() } else { now.x[i - 1] };
//!         let d = now.x[i] - above;
//!         let pull = -50.0 * (1.0 - 0.1 / d.norm()) * d;
//!         f[i] += pull - 0.02 * now.v[i] - 0.01 * 9.81 * Vector3::z();
//!         if i > 0 {
//!             f[i - 1] -= pull;
//!         }
//!     }
//! }
//!
//! let x: Vec<Vector3> = (1..=10).map(|i| Vector3::new(0.1 * i as f64, 0.0, 0.0)).collect();
//! let mut chain = Particles::new(x, &[Vector3::zeros(); 10], vec![0.01; 10])?;
//! let policy = Lazy { speed: Speed::new(0.01, 0.05)?, height: -0.3 };
//! let mut stepper = Explicit::new(policy, Scheme::StormerVerlet).with_bleeding(0.05)?;
//! while chain.time < 30.0 {
//!     stepper.step(&mut chain, 0.002, forces)?;
//! }
//! let moved = stepper.step(&mut chain, 0.002, forces)?;
//! assert_eq!(moved.n_rest, 10);
//! assert!(chain.x[9].xy().norm() < 0.02 && chain.x[9].z < -1.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # What is where
//! - **Laws.** [`Law`] says how a particle passes from rest to full dynamics; [`Held`] is the kinetic
//!   energy of one particle: effective velocity, R, s, in closed form. Its [`Conjugate`] leads back from
//!   velocities to momenta.
//! - **Policies.** [`Restraint`] says which particle has which thresholds: [`Speed`], [`Kinetic`], `()`
//!   for none, or a type of one's own with one pure method. It gets position and time, for instance to
//!   count motion in the pixels of a camera. [`Automatic`] chooses thresholds from an acceptable error.
//! - **Explicit steps.** [`Explicit`] is symplectic; the longest stable step is a little shorter than
//!   without restraint.
//! - **Implicit steps.** [`Implicit`] is stable at any stiffness and step. The problem behind it,
//!   [`ConvexProblem`], can be solved apart from it for matrices ([`Stiffness`]) and linear solvers of
//!   one's own. It needs a convex [`Law`]; [`paper`] has the scheme of the paper, to compare.
//! - **Waking.** [`WakeQueue`] knows when a resting particle under a constant force will wake, so that
//!   it costs nothing until then.
//!
//! # Units
//! SI: m, s, kg, N, J; momenta in kg m/s. `cargo run -p arps --example phase_portraits -- FOLDER`
//! draws what restraint does to an oscillator, `--example stress_grid` tries the implicit schemes on
//! nets of any stiffness.
#![forbid(unsafe_code)]

mod automatic;
mod blocks;
mod conjugate;
mod convex;
mod error;
mod explicit;
mod held;
mod implicit;
mod law;
mod linear;
pub mod paper;
mod particles;
mod restraint;
mod wake;

pub use automatic::Automatic;
pub use blocks::{Blocks, SparseBlocks, Stiffness};
pub use conjugate::Conjugate;
pub use convex::{ConvexProblem, ConvexReport, ConvexSolver};
pub use error::{NotConvex, StateError, StepError, ThresholdError};
pub use explicit::{Explicit, Moved, Now, Scheme, bleeding_kick};
pub use held::{Held, Motion};
pub use implicit::{Implicit, ImplicitReport};
pub use law::Law;
pub use linear::MoverSystem;
pub use particles::Particles;
pub use restraint::{Kinetic, Particle, Restraint, Speed};
pub use wake::{Rest, WakeQueue};

/// A position, velocity, momentum or force in world space.
pub type Vector3 = nalgebra::Vector3<f64>;
/// A 3 × 3 block.
pub type Matrix3 = nalgebra::Matrix3<f64>;
