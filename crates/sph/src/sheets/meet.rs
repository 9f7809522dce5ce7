//! A fluid among moving surfaces.

use super::Sheets;
use super::forces::take_away;
use crate::fluid::{Fluid, hardest};
use crate::report::{Seconds, StepReport};
use crate::settings::FluidError;
use crate::state::State;
use arps::Restraint;
use nalgebra::Vector3;
use std::time::Instant;

impl<R: Restraint> Fluid<R> {
    /// Makes as many steps within the bound as `duration` (s) takes, among surfaces that go the ways
    /// they were given in that time. They push the fluid, and [`Sheets::impulses`] then says what it
    /// has done to them. No particle comes to the other side of a surface unless surfaces left it no
    /// room, which the report tells as `squeezed`.
    ///
    /// # Errors
    /// As for [`Fluid::advance`].
    pub fn advance_among(
        &mut self,
        duration: f64,
        sheets: &mut Sheets,
    ) -> Result<StepReport, FluidError> {
        if !(duration.is_finite() && duration > 0.0) {
            let wanted = "positive and finite";
            return Err(FluidError::OutOfRange { name: "duration", value: duration, wanted });
        }
        let clock = Instant::now();
        self.state.meet_sheets();
        sheets.start(duration);
        sheets.list(&self.laws, &self.state.x, 0.0);
        sheets.find_touches(&self.laws, &self.state.x);
        // Pressures stay as they are until the step has been made.
        take_away(&mut self.state.a, &mut self.state.by_sheets);
        let mut seconds = Seconds::default();
        self.feel_sheets(sheets, &mut seconds);
        self.hardest = hardest(&self.state.a);
        let before = clock.elapsed().as_secs_f64();
        let mut report = self.make_steps(duration, Some(sheets))?;
        report.seconds.sheets += before;
        Ok(report)
    }

    /// Takes out the particles that are where surfaces that stand still want room, before the first
    /// step; those that are left are numbered anew.
    pub fn leave_room(&mut self, sheets: &mut Sheets) {
        sheets.start(0.0);
        sheets.list(&self.laws, &self.state.x, 0.0);
        sheets.find_touches(&self.laws, &self.state.x);
        if sheets.touches.is_empty() {
            return;
        }
        let mut keep = vec![true; self.state.len()];
        sheets.touches.iter().for_each(|touch| keep[touch.particle as usize] = false);
        self.state.keep(&keep);
        self.state.id = (0..self.state.len() as u64).collect();
        self.next_id = self.state.len() as u64;
        self.list_neighbours();
        self.evaluate_all(&mut Seconds::default());
        self.hardest = hardest(&self.state.a);
        sheets.forget_particles();
    }

    /// What surfaces that stand still have of the fluid: the mass near every corner (kg), that of each
    /// particle within the support of a surface shared out among the corners of the triangle closest to
    /// it, and the impulse that it has yet to get (N s), shared out in the same way. So the impulse on a
    /// corner over its mass is a mean of changes of velocity of particles, however the surface is meshed.
    ///
    /// The fluid has given these impulses then. One whose particle is near no surface any more it keeps.
    pub fn load(&mut self, sheets: &mut Sheets) -> (Vec<f64>, Vec<Vector3<f64>>) {
        self.state.meet_sheets();
        sheets.start(0.0);
        sheets.list(&self.laws, &self.state.x, 0.0);
        let n = sheets.impulses().len();
        let (mut masses, mut impulses) = (vec![0.0; n], vec![Vector3::zeros(); n]);
        let mut is_near = vec![false; self.len()];
        let given = &self.state.given;
        sheets.shares(&self.laws, &self.state.x, |particle, corner, share| {
            let [x, y, z, _] = given[particle];
            is_near[particle] = true;
            masses[corner] += self.laws.mass * share;
            impulses[corner] += Vector3::new(x, y, z) * share;
        });
        let State { u, given, .. } = &mut self.state;
        for ((u, given), is_near) in u.iter_mut().zip(given).zip(is_near) {
            if !is_near && *given != [0.0; 4] {
                (0..3).for_each(|c| u[c] += given[c] / self.laws.mass);
                self.fastest = Vector3::new(u[0], u[1], u[2]).norm().max(self.fastest);
            }
            *given = [0.0; 4];
        }
        (masses, impulses)
    }

    /// The impulse that surfaces have yet to get (N s).
    pub fn under_way(&self) -> Vector3<f64> {
        self.state.given.iter().map(|j| Vector3::new(j[0], j[1], j[2])).sum()
    }

    /// Carries the fluid along with the corners of surfaces whose [`Fluid::load`] was just
    /// asked for, whose velocities have changed by `changes` (m/s): the sum of momenta changes by that of
    /// the masses times the changes.
    ///
    /// # Errors
    /// If there are not as many changes as corners.
    pub fn carry(
        &mut self,
        sheets: &mut Sheets,
        changes: &[Vector3<f64>],
    ) -> Result<(), FluidError> {
        let (found, expected) = (changes.len(), sheets.impulses().len());
        if found != expected {
            return Err(FluidError::Length { what: "changes of velocity", found, expected });
        }
        let (state, mut fastest) = (&mut self.state, self.fastest);
        sheets.shares(&self.laws, &state.x, |particle, corner, share| {
            let u = &mut state.u[particle];
            for c in 0..3 {
                u[c] += share * changes[corner][c];
            }
        });
        for u in &state.u {
            fastest = Vector3::new(u[0], u[1], u[2]).norm().max(fastest);
        }
        self.fastest = fastest;
        Ok(())
    }

    /// After particles and surfaces have moved: what surfaces add to densities. What they added to
    /// accelerations is taken away.
    pub(crate) fn touch_sheets(
        &mut self,
        sheets: &mut Sheets,
        others: bool,
        seconds: &mut Seconds,
    ) {
        let clock = Instant::now();
        if others {
            sheets.forget_particles();
        }
        self.state.meet_sheets();
        take_away(&mut self.state.a, &mut self.state.by_sheets);
        sheets.list(&self.laws, &self.state.x, 0.0);
        sheets.find_touches(&self.laws, &self.state.x);
        sheets.densities(&self.laws, &mut self.state.by_sheets);
        seconds.sheets += clock.elapsed().as_secs_f64();
    }

    /// Adds to accelerations what surfaces do.
    pub(crate) fn feel_sheets(&mut self, sheets: &mut Sheets, seconds: &mut Seconds) {
        let clock = Instant::now();
        let state = &mut self.state;
        sheets.accelerations(&self.laws, &state.x, &state.w, &mut state.a, &mut state.by_sheets);
        seconds.sheets += clock.elapsed().as_secs_f64();
    }

    /// Forgets surfaces, if there were any.
    pub(crate) fn leave_sheets(&mut self) {
        if !self.state.by_sheets.is_empty() {
            self.state.by_sheets.clear();
            self.state.given.clear();
            self.scratch.changes.forget();
            self.evaluate_all(&mut Seconds::default());
            self.hardest = hardest(&self.state.a);
        }
    }
}
