//! Fluid in a world: built from a scene, moved, saved.

mod build;
mod columns;
mod meeting;
pub(crate) mod policy;
pub(crate) mod settings;

pub(crate) use build::water;
pub(crate) use columns::{columns, restore};
pub use policy::Policy;

use crate::build::Garment;
use crate::obstacle::Obstacle;
use crate::report::{FluidSeconds, FluidSummary, FluidViewSummary};
use arps::{Motion, Restraint};
use mesh_core::{ClothState, World3};
use sizing_view::ViewRestraint;
use sph::{Fluid, FluidError, StepReport};

/// The fluid of a world.
#[derive(Clone, Debug)]
pub struct Water {
    /// Its name in the scene.
    pub name: String,
    /// Particles, walls, nozzles and sinks.
    pub fluid: Fluid<Policy>,
    /// Whether a policy restrains its particles.
    pub is_restrained: bool,
    /// What of cloth and bodies moves in it, if anything may.
    pub(crate) meeting: Option<meeting::Meeting>,
}

/// A particle as recordings show it: 0 moves freely, 1 is in transition, 2 rests.
fn state(motion: Motion) -> u8 {
    match motion {
        Motion::Full => 0,
        Motion::Transition => 1,
        Motion::Rest => 2,
    }
}

impl Water {
    /// Goes back to a state.
    ///
    /// # Errors
    /// If it is none of this fluid; nothing is changed then.
    pub(crate) fn restore(&mut self, saved: &sph::Checkpoint) -> Result<(), FluidError> {
        self.fluid.restore(saved)?;
        if let Some(meeting) = &mut self.meeting {
            meeting.report();
            meeting.forget();
        }
        Ok(())
    }

    /// The impulse that cloth has yet to get from the fluid (N s).
    pub fn on_its_way(&self) -> World3 {
        self.fluid.under_way()
    }

    /// Steps of cloth and fluid together in a time (s); 0 if they do not meet and no body moves.
    pub(crate) fn steps_among_others(&self, time: f64) -> u32 {
        self.meeting.as_ref().map_or(0, |meeting| meeting.n_steps(time, self.fluid.settings()))
    }

    /// Takes thresholds for the frame to come from what cameras see, if they depend on it: `pixel_speeds` are
    /// those of positions (m).
    pub(crate) fn look(&mut self, pixel_speeds: impl FnOnce(&[World3]) -> Vec<f64>) {
        let Some(Policy::View(ViewRestraint { thresholds, .. })) = self.fluid.policy() else {
            return;
        };
        let thresholds = *thresholds;
        let (names, positions): (Vec<usize>, Vec<World3>) =
            self.fluid.particles().map(|p| (p.id as usize, p.position)).unzip();
        let mut by_name = vec![0.0; names.iter().max().map_or(0, |last| last + 1)];
        for (name, speed) in names.into_iter().zip(pixel_speeds(&positions)) {
            by_name[name] = speed;
        }
        self.fluid.change_policy(Policy::View(ViewRestraint { thresholds, pixel_speeds: by_name }));
    }

    /// What cameras make of the thresholds, if they depend on that.
    fn seen(&self) -> Option<FluidViewSummary> {
        let Some(Policy::View(policy)) = self.fluid.policy() else { return None };
        let (mass, time) = (self.fluid.particle_mass(), self.fluid.time());
        let mut all =
            FluidViewSummary { rest_min_m_per_s: f64::INFINITY, ..FluidViewSummary::default() };
        for p in self.fluid.particles() {
            let asked = arps::Particle { index: p.id as usize, mass, x: p.position, time };
            let rest = policy.at(&asked).p_r() / mass;
            all.rest_min_m_per_s = all.rest_min_m_per_s.min(rest);
            all.rest_max_m_per_s = all.rest_max_m_per_s.max(rest);
        }
        (!self.fluid.is_empty()).then_some(all)
    }

    /// Follows the remeshing of cloth at a time (s).
    pub(crate) fn follow(
        &mut self,
        cloth: &ClothState,
        scene: (&[Garment], &[Obstacle]),
        time: f64,
    ) {
        if let Some(meeting) = &mut self.meeting {
            meeting.follow(&mut self.fluid, cloth, scene, time);
        }
    }

    /// Lets time (s) go by.
    ///
    /// # Errors
    /// As for [`Fluid::advance`].
    pub(crate) fn advance(&mut self, duration: f64) -> Result<StepReport, FluidError> {
        self.fluid.advance(duration)
    }

    /// The particles as recordings hold them, by ascending number. `None` for a particle whose number
    /// a recording cannot hold.
    pub fn particles(&self) -> Option<Vec<io_mcap::Particle>> {
        let particles = self.fluid.particles().zip(self.fluid.motions());
        let recorded = particles.map(|(p, motion)| {
            Some(io_mcap::Particle {
                id: u32::try_from(p.id).ok()?,
                position: p.position.into(),
                velocity: p.velocity.map(|v| v as f32).into(),
                speed: p.effective_velocity.norm() as f32,
                density: p.density as f32,
                state: state(motion),
            })
        });
        let mut recorded = recorded.collect::<Option<Vec<_>>>()?;
        recorded.sort_unstable_by_key(|particle| particle.id);
        Some(recorded)
    }

    /// What the report of a frame says of it, in which `done` was done in `duration` (s).
    pub(crate) fn summary(&self, done: &StepReport, duration: f64) -> FluidSummary {
        let mut n = [0; 3];
        self.fluid.motions().for_each(|motion| n[usize::from(state(motion))] += 1);
        let [active, transition, restrained] = n;
        let energy = self.fluid.energy();
        let sph::Seconds { motion, neighbours, density, force, changes, sheets } = done.seconds;
        FluidSummary {
            particles: self.fluid.len(),
            active,
            transition,
            restrained,
            steps: done.steps,
            step_s: duration / done.steps.max(1) as f64,
            moved: done.moved,
            sweeps: done.sweeps,
            density_pairs: done.density_pairs,
            force_pairs: done.force_pairs,
            listings: done.listings,
            emitted: done.emitted,
            drained: done.drained,
            stopped: done.stopped,
            squeezed: done.squeezed,
            view: self.seen(),
            density_max_kg_per_m3: self.fluid.particles().map(|p| p.density).fold(0.0, f64::max),
            kinetic_energy_j: energy.kinetic,
            internal_energy_j: energy.internal,
            potential_energy_j: energy.potential,
            seconds: FluidSeconds { motion, neighbours, density, force, changes, sheets },
        }
    }
}
