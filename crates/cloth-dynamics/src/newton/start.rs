//! Where the iterations of a stage begin.

use super::{Inertia, Watchdog};
use crate::solve_report::SolveError;
use crate::system::System;
use mesh_core::World3;

/// Stages that start at rest unasked after one that had to.
pub(super) const REST_STARTS: u32 = 7;

/// The start, its potential, and what to return to if it proves no good.
///
/// Where inertia leads, most of what a step turns has been turned, so a single iteration from there is
/// worth two from the start at rest. Stiff cloth is stretched there far above its potential at rest, so this
/// start is on trial like a full step. What touches, is restrained or has strain limits has it only where it
/// is the lower one: it may lie beyond what it touches and out of its limits.
pub(super) fn choose(
    system: &mut System,
    inertia: &Inertia<'_>,
    [resting, ballistic]: &[Vec<World3>; 2],
) -> Result<(Vec<World3>, f64, Watchdog), SolveError> {
    let phi = inertia.potential(system, resting);
    // One step resembles the next: where it is better to start at rest, the other start is looked at
    // only now and then.
    if system.rests > 0 && phi.is_finite() {
        system.rests -= 1;
        return Ok((resting.clone(), phi, Watchdog::default()));
    }
    let other = inertia.potential(system, ballistic);
    if other < phi || (other.is_finite() && !phi.is_finite()) {
        return Ok((ballistic.clone(), other, Watchdog::default()));
    }
    if !phi.is_finite() {
        return Err(SolveError::NotFinite { time: inertia.time, h: inertia.h });
    }
    let is_bound =
        system.contact.is_some() || system.limits.is_some() || inertia.restrained.is_some();
    if !is_bound && other.is_finite() {
        let lowest = Watchdog { age: 1, phi, x: resting.clone(), ..Watchdog::default() };
        return Ok((ballistic.clone(), other, lowest));
    }
    system.rests = REST_STARTS;
    Ok((resting.clone(), phi, Watchdog::default()))
}
