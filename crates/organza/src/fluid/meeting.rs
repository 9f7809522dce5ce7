//! The join of a fluid with what moves in it: cloth, and bodies on their prescribed ways.
//!
//! A frame is cut into steps in which first the cloth moves, then the fluid, among the straight ways that
//! the cloth and the bodies go in that time. What the fluid does to the cloth, an impulse by every particle,
//! the cloth gets at the start of its next step. Light cloth before heavy water would be thrown back and
//! forth by that: so the cloth moves with the mass of the fluid near it added to its own, and what this
//! fluid took of the change of velocity it gets (the added mass, Causin2005). So momentum is conserved to
//! rounding, and a step is stable as long as sound comes no farther in it than the fluid goes that is
//! added: see [`STEP`].

use crate::build::Garment;
use crate::obstacle::Obstacle;
use mesh_core::{ClothState, World3};
use sph::{Fluid, FluidError, FluidSettings, Sheets, StepReport};

use super::Policy;

/// The time of a step, in that of sound from one particle to the next (1). Fluid within two spacings,
/// the support of the kernel, moves along with the cloth.
const STEP: f64 = 2.0;

/// What a fluid meets that moves.
#[derive(Clone, Debug)]
pub(crate) struct Meeting {
    /// Whether it meets each garment, and if it meets any.
    garments: Vec<bool>,
    has_cloth: bool,
    /// Which of the obstacles move.
    obstacles: Vec<usize>,
    /// Triangles of the cloth and the obstacles; absent after the mesh has changed.
    sheets: Option<Sheets>,
    spacing: f64,
    /// What was done since [`Meeting::report`].
    done: StepReport,
}

/// What cloth has of the fluid in a step.
pub(crate) struct Load {
    /// Mass of fluid near each vertex (kg).
    pub(crate) masses: Vec<f64>,
    /// Velocities before the step and before what the fluid has given (m/s).
    before: Vec<World3>,
}

impl Load {
    /// Vertices of the cloth that bear any of it.
    pub(crate) fn wet(&self, cloth: &ClothState) -> Vec<u32> {
        let is_wet = |i: usize| self.masses[i] > 0.0 || self.before[i] != cloth.v[i];
        (0..self.masses.len()).filter(|&i| is_wet(i)).map(|i| i as u32).collect()
    }
}

impl Meeting {
    /// A fluid of particles at a `spacing` (m) among the cloths and obstacles with these numbers; `None`
    /// if there are none.
    pub(super) fn new(
        cloths: &[usize],
        obstacles: Vec<usize>,
        n_garments: usize,
        spacing: f64,
    ) -> Option<Meeting> {
        let garments: Vec<bool> = (0..n_garments).map(|k| cloths.contains(&k)).collect();
        let has_cloth = garments.contains(&true);
        let is_needed = has_cloth || !obstacles.is_empty();
        is_needed.then(|| Meeting {
            garments,
            has_cloth,
            obstacles,
            sheets: None,
            spacing,
            done: StepReport::default(),
        })
    }

    /// Steps to make in a time (s).
    pub(crate) fn n_steps(&self, time: f64, settings: &FluidSettings) -> u32 {
        (time * settings.sound_speed / (STEP * settings.spacing)).ceil().max(1.0) as u32
    }

    /// The mesh has changed, or may have.
    pub(crate) fn forget(&mut self) {
        self.sheets = None;
    }

    /// What was done since the last call.
    pub(crate) fn report(&mut self) -> StepReport {
        std::mem::take(&mut self.done)
    }

    /// After remeshing of cloth, at a time (s): fluid stays on its side.
    pub(super) fn follow(
        &mut self,
        fluid: &mut Fluid<Policy>,
        cloth: &ClothState,
        (garments, obstacles): (&[Garment], &[Obstacle]),
        time: f64,
    ) {
        let Some(mut old) = self.sheets.take().filter(|_| self.has_cloth) else { return };
        // If they cannot be placed the next step says so, and the frame is whole until then.
        if let Ok(new) = self.place(cloth, garments, obstacles, time) {
            fluid.keep_sides(&mut old, new);
        }
    }

    /// Where all corners are at a time (s): vertices of the cloth, at `x`, then those of the bodies (m).
    fn corners(&self, x: &[World3], obstacles: &[Obstacle], time: f64) -> Vec<World3> {
        let mut corners = if self.has_cloth { x.to_vec() } else { Vec::new() };
        for &k in &self.obstacles {
            corners.extend(obstacles[k].positions(time));
        }
        corners
    }

    /// The surfaces as they are at a time (s), standing still.
    pub(super) fn place(
        &mut self,
        cloth: &ClothState,
        garments: &[Garment],
        obstacles: &[Obstacle],
        time: f64,
    ) -> Result<&mut Sheets, FluidError> {
        let corners = self.corners(&cloth.x, obstacles, time);
        let mut sheets = match self.sheets.take() {
            Some(sheets) => sheets,
            None => {
                let triangles = self.triangles(cloth, garments, obstacles);
                Sheets::new(triangles, corners.len(), self.spacing)?
            }
        };
        sheets.place(&corners)?;
        Ok(self.sheets.insert(sheets))
    }

    fn triangles(
        &self,
        cloth: &ClothState,
        garments: &[Garment],
        obstacles: &[Obstacle],
    ) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        let mut first = 0;
        if self.has_cloth {
            let mesh = &cloth.mesh;
            for (corners, panel) in mesh.triangles().iter().zip(mesh.panels()) {
                let garment = garments.partition_point(|garment| garment.panels.end <= *panel);
                if self.garments[garment] {
                    triangles.push(*corners);
                }
            }
            first = mesh.n_vertices() as u32;
        }
        for obstacle in self.obstacles.iter().map(|&k| &obstacles[k]) {
            triangles.extend(obstacle.triangles.iter().map(|t| t.map(|c| c + first)));
            first += obstacle.n_vertices() as u32;
        }
        triangles
    }

    /// Before the cloth's step, which starts at `time` (s): gives it what the fluid has done. `None` if
    /// the fluid is nowhere near and has done nothing.
    pub(crate) fn load(
        &mut self,
        fluid: &mut Fluid<Policy>,
        cloth: &mut ClothState,
        (garments, obstacles): (&[Garment], &[Obstacle]),
        time: f64,
    ) -> Result<Option<Load>, FluidError> {
        let has_cloth = self.has_cloth;
        let sheets = self.place(cloth, garments, obstacles, time)?;
        if !has_cloth {
            return Ok(None);
        }
        let (mut masses, impulses) = fluid.load(sheets);
        masses.truncate(cloth.x.len());
        if masses.iter().all(|mass| *mass == 0.0) {
            return Ok(None);
        }
        let before = cloth.v.clone();
        for (k, mass) in masses.iter().enumerate() {
            cloth.v[k] += impulses[k] / (cloth.m[k] + mass);
        }
        Ok(Some(Load { masses, before }))
    }

    /// After the cloth's step: the fluid near it goes along.
    pub(crate) fn carry(
        &mut self,
        fluid: &mut Fluid<Policy>,
        cloth: &ClothState,
        load: &Load,
    ) -> Result<(), FluidError> {
        let Some(sheets) = &mut self.sheets else { return Ok(()) };
        let mut changes: Vec<World3> =
            cloth.v.iter().zip(&load.before).map(|(a, b)| a - b).collect();
        changes.resize(sheets.impulses().len(), World3::zeros());
        fluid.carry(sheets, &changes)
    }

    /// Moves the fluid for `h` (s) from `time` (s) on, in which the cloth came from `start` (m) to where
    /// it is.
    pub(crate) fn flow(
        &mut self,
        fluid: &mut Fluid<Policy>,
        (cloth, start): (&ClothState, &[World3]),
        obstacles: &[Obstacle],
        (time, h): (f64, f64),
    ) -> Result<(), FluidError> {
        let from = self.corners(start, obstacles, time);
        let to = self.corners(&cloth.x, obstacles, time + h);
        let Some(sheets) = &mut self.sheets else { return Ok(()) };
        sheets.move_between(&from, &to)?;
        self.done.add(&fluid.advance_among(h, sheets)?);
        Ok(())
    }
}
