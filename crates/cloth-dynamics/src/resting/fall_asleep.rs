//! Who goes to sleep after a stage.

use super::friction::beyond;
use super::local::WholeStage;
use super::part_contact::gradient_of;
use super::{Patch, REACH, Resting, SHRINK};
use crate::integrator::StageStart;
use crate::system::System;
use arps::Rest;
use mesh_core::World3;

impl Resting {
    /// Gradient of all but contact (N), right for the active vertices.
    fn elastic_gradient(&self, system: &System, x: &[World3]) -> Vec<World3> {
        let Some(Patch { part, system: own }) = &self.patch else { return system.gradient(x) };
        let gradient = own.gradient(&part.gather(x));
        let mut all = vec![World3::zeros(); x.len()];
        part.vertices().iter().zip(&gradient).for_each(|(&i, g)| all[i as usize] = *g);
        all
    }

    /// Lets vertices sleep that are far from all that moved, if that makes the part much smaller.
    pub(super) fn put_to_sleep(
        &mut self,
        system: &System,
        whole: &WholeStage<'_>,
        x: &[World3],
        v: &[World3],
        grip: &[f64],
    ) {
        let &StageStart { x_t0, base, time, .. } = whole.start;
        let n = x.len();
        let moved = (0..n).filter(|&i| x[i] != x_t0[i] || base[i] != x_t0[i]);
        let wanted = self.near.around(moved.map(|i| i as u32), 2 * REACH);
        if wanted.len() as f64 >= SHRINK * self.n_active as f64 {
            return;
        }
        let gradient = self.elastic_gradient(system, x);
        let contact = system.contact.as_deref();
        let touching = contact.map(|contact| gradient_of(contact, x));
        let mut is_wanted = vec![false; n];
        wanted.iter().for_each(|&i| is_wanted[i as usize] = true);
        for i in 0..n {
            if !self.active[i] || is_wanted[i] {
                continue;
            }
            let (f, p, p_r) = if whole.fixed[i] {
                (World3::zeros(), World3::zeros(), f64::INFINITY)
            } else {
                let pressed = touching.as_ref().map_or_else(World3::zeros, |of| of[i]);
                let f = -(gradient[i] + pressed);
                let p_r = whole.held[i].p_r();
                match self.policy.bleeding {
                    None => (f, v[i] * whole.cloth.m[i], p_r),
                    Some(_) => (beyond(f, grip[i]), self.gathered[i], p_r),
                }
            };
            let bleeding = self.policy.rate(&whole.held[i]);
            self.queue.rest(i, Rest { since: time, p, f, p_r, bleeding });
            self.active[i] = false;
            self.n_active -= 1;
            if let Some(touching) = &touching {
                self.touching[i] = touching[i];
            }
        }
        self.patch = None;
    }
}
