//! Who rests in a world: thresholds by cloth, the policy on a mesh, and what is told of it.

use super::World;
use crate::build::Garment;
use crate::eyes::Eyes;
use crate::fluid::Policy;
use crate::report::{RestraintSummary, StretchRange};
use crate::scene::{Scene, Thresholds};
use arps::{Held, Motion, Particle, Restraint};
use cloth_dynamics::{RestReport, RestingPolicy};
use mesh_core::{ClothState, World3};
use sizing_view::pixel_speeds;
use std::sync::Arc;
use std::time::Instant;

/// Thresholds of every cloth, and bleeding.
pub(super) struct Restraints {
    by_garment: Vec<Thresholds>,
    bleeding: Option<f64>,
    /// Speed of a pixel per frame for every vertex of the mesh (m/s), for the coming frame; empty where
    /// no threshold depends on a camera.
    pixel_speeds: Arc<Vec<f64>>,
}

/// The frames whose pictures a motion shows in: that at its start and that at its end.
const FRAMES_OF_MOTION: f64 = 2.0;

impl Restraints {
    /// Those of a scene; `None` if nothing in it may rest.
    pub(super) fn new(scene: &Scene) -> Option<Restraints> {
        let own = |cloth: &crate::scene::Cloth| cloth.restraint.unwrap_or(scene.restraint);
        let by_garment: Vec<Thresholds> = scene.cloths.iter().map(own).collect();
        let any = by_garment.iter().any(|thresholds| *thresholds != Thresholds::None);
        let pixel_speeds = Arc::default();
        any.then_some(Restraints { by_garment, bleeding: scene.bleeding_s, pixel_speeds })
    }

    /// True if a threshold depends on the cameras.
    fn looks(&self) -> bool {
        self.by_garment.iter().any(|thresholds| matches!(thresholds, Thresholds::View(_)))
    }

    /// Takes what the cameras see of every vertex; true if that has changed any threshold.
    fn look(&mut self, pixel_speeds: Vec<f64>) -> bool {
        let changed = *self.pixel_speeds != pixel_speeds;
        if changed {
            self.pixel_speeds = Arc::new(pixel_speeds);
        }
        changed
    }

    /// The policy for a mesh.
    pub(super) fn policy(&self, cloth: &ClothState, garments: &[Garment]) -> RestingPolicy {
        let mut of_vertex = vec![0; cloth.mesh.n_vertices()];
        for (corners, panel) in cloth.mesh.triangles().iter().zip(cloth.mesh.panels()) {
            let garment = garments.partition_point(|garment| garment.panels.end <= *panel);
            corners.iter().for_each(|&i| of_vertex[i as usize] = garment as u32);
        }
        let by_garment = self.by_garment.clone();
        let pixel_speeds = self.pixel_speeds.clone();
        let restraint = Arc::new(ByGarment { of_vertex, by_garment, pixel_speeds });
        RestingPolicy { restraint, bleeding: self.bleeding }
    }
}

/// The cameras that thresholds of rest depend on; `None` if none does.
pub(super) fn eyes(scene: &Scene, restraints: Option<&Restraints>) -> Option<Eyes> {
    let of_fluid = scene.fluid.as_ref().and_then(|fluid| fluid.policy.as_ref());
    let looks = restraints.is_some_and(Restraints::looks)
        || of_fluid.is_some_and(|policy| matches!(policy, Policy::View(_)));
    let view = scene.view.clone().unwrap_or_default();
    looks.then(|| Some(Eyes::new(scene, &view)?.ahead(FRAMES_OF_MOTION))).flatten()
}

/// What is measured at the end of the steps of a frame.
#[derive(Clone, Copy)]
pub(super) struct Measured {
    pub(super) stretch: StretchRange,
    /// Restrained energy (J), if anything may rest.
    pub(super) energy: f64,
}

impl World {
    /// Works out for the frame to come who may rest, where that depends on the cameras; how long that
    /// took (s).
    pub(crate) fn look_who_may_rest(&mut self) -> f64 {
        let time = self.time();
        let Some(eyes) = &self.eyes else { return 0.0 };
        let clock = Instant::now();
        let samples = eyes.samples(&self.cloth, time, &self.obstacles);
        let speeds = |x: &[World3]| {
            let speeds = pixel_speeds(x, &samples, eyes.frame_s(), eyes.settings());
            speeds.expect("a window has its camera, and the scene's settings have been checked")
        };
        if let Some(restraints) = self.restraints.as_mut().filter(|all| all.looks())
            && restraints.look(speeds(&self.cloth.x))
            && let Some(prepared) = &mut self.prepared
        {
            let policy = restraints.policy(&self.cloth, &self.garments);
            prepared.system.change_restraint(policy, &mut self.cloth, time);
        }
        if let Some(water) = &mut self.fluid {
            water.look(speeds);
        }
        clock.elapsed().as_secs_f64()
    }

    /// Measures the cloth as it is at a time (s).
    pub(super) fn measure(&mut self, time: f64) -> Measured {
        let stretch = StretchRange::of(&self.cloth);
        if let Some(prepared) = &mut self.prepared {
            self.potential_energy_j = prepared.system.energy_at_rest(&self.cloth.x);
        }
        let mut energy = 0.0;
        if let Some(restraints) = &self.restraints {
            let policy = restraints.policy(&self.cloth, &self.garments);
            energy = kinetic_energy(&policy, &self.cloth, time) + self.potential_energy_j;
        }
        Measured { stretch, energy }
    }

    /// Kinetic energy (J), the restrained one where anything may rest, and then who does.
    pub(crate) fn kinetic_energy(&self, rest: &RestReport) -> (f64, Option<RestraintSummary>) {
        let Some(restraints) = &self.restraints else { return (self.cloth.kinetic_energy(), None) };
        let policy = restraints.policy(&self.cloth, &self.garments);
        let (energy, summary) = summary(&policy, &self.cloth, &self.garments, self.time(), rest);
        (energy, Some(summary))
    }
}

/// The thresholds of the garment that a vertex belongs to.
struct ByGarment {
    of_vertex: Vec<u32>,
    by_garment: Vec<Thresholds>,
    /// By vertex (m/s); empty where no threshold depends on a camera.
    pixel_speeds: Arc<Vec<f64>>,
}

impl Restraint for ByGarment {
    fn at(&self, particle: &Particle) -> Held {
        match &self.by_garment[self.of_vertex[particle.index] as usize] {
            Thresholds::None => ().at(particle),
            Thresholds::Speed(speed) => speed.at(particle),
            Thresholds::Kinetic(kinetic) => kinetic.at(particle),
            Thresholds::View(pixels) => pixels.at(particle, self.pixel_speeds[particle.index]),
        }
    }

    fn is_steady(&self) -> bool {
        // They depend on nothing but the mass, and on what cameras see, which the system is told once a
        // frame.
        true
    }
}

/// Restrained kinetic energy (J).
pub(super) fn kinetic_energy(policy: &RestingPolicy, cloth: &ClothState, time: f64) -> f64 {
    let each = cloth.m.iter().zip(&cloth.x).enumerate().map(|(index, (&mass, &x))| {
        policy.kinetic_energy(&Particle { index, mass, x, time }, &cloth.v[index])
    });
    each.sum()
}

/// What every vertex does, and what is told of it: restrained kinetic energy (J) and a summary.
pub(super) fn summary(
    policy: &RestingPolicy,
    cloth: &ClothState,
    garments: &[Garment],
    time: f64,
    rest: &RestReport,
) -> (f64, RestraintSummary) {
    let mut motions = Vec::with_capacity(cloth.m.len());
    for (index, (&mass, &x)) in cloth.m.iter().zip(&cloth.x).enumerate() {
        motions.push(policy.motion(&Particle { index, mass, x, time }, &cloth.v[index]));
    }
    let count = |motion| motions.iter().filter(|m| **m == motion).count();
    let summary = RestraintSummary {
        active: count(Motion::Full),
        transition: count(Motion::Transition),
        resting: count(Motion::Rest),
        stages: rest.stages,
        stages_slept: rest.slept,
        solves: rest.solves,
        unknowns: rest.unknowns,
        untouched: rest.untouched,
        woken: rest.woken,
        parts_built: rest.parts,
        stages_redone: rest.redone,
        energy_j: 0.0,
        momenta_cut: rest.cut,
        states: states(&motions, cloth, garments),
    };
    (kinetic_energy(policy, cloth, time), summary)
}

/// Letters of the vertices of every garment in their order, each after how often it follows itself.
fn states(motions: &[Motion], cloth: &ClothState, garments: &[Garment]) -> Vec<String> {
    let mut of_vertex = vec![0; motions.len()];
    for (corners, panel) in cloth.mesh.triangles().iter().zip(cloth.mesh.panels()) {
        let garment = garments.partition_point(|garment| garment.panels.end <= *panel);
        corners.iter().for_each(|&i| of_vertex[i as usize] = garment);
    }
    let mut letters = vec![Vec::new(); garments.len()];
    for (motion, garment) in motions.iter().zip(of_vertex) {
        letters[garment].push(match motion {
            Motion::Rest => 'r',
            Motion::Transition => 't',
            Motion::Full => 'a',
        });
    }
    let coded = |letters: Vec<char>| {
        letters.chunk_by(|a, b| a == b).map(|run| format!("{}{}", run.len(), run[0])).collect()
    };
    letters.into_iter().map(coded).collect()
}
