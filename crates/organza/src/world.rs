//! The world: state and policies of a running scene, and the step.

mod bodies;
mod flow;
mod rest;
mod skipped;
mod step;
mod tangled;
#[cfg(test)]
mod tests;

use crate::build::{BuildError, Built, Garment, build};
use crate::contact::{ContactSettings, Crossings, SurfaceContact};
use crate::eyes::Eyes;
use crate::fluid::Water;
use crate::handles::{Handles, by_name};
use crate::obstacle::Obstacle;
use crate::remeshing::Remeshing;
use crate::report::{FrameReport, Seconds};
use crate::scene::Loaded;
use crate::scene::format::{Integrator, LinearSolver as Method};
use bodies::{Bodies, appearing_in_cloth};
use cloth_dynamics::solver::{LinearSettings, LinearSolver, PatternError, SolverKind};
use cloth_dynamics::{
    Environment, Fabric, ImplicitEuler, NewtonSettings, Sdirk2, SolveError, SolveReport, Step,
    System, TimeIntegrator, Wind,
};
use collision::SurfaceError;
use mesh_core::{ClothState, World3};
use remesh::SizingField;
use rest::{Measured, Restraints};
use std::sync::Arc;
use std::time::Instant;
use tangled::Tangled;

/// Why a frame could not be finished. The world is as it was after the last finished frame.
#[derive(Debug, thiserror::Error)]
pub enum StepError {
    /// A step failed at every length that was tried.
    #[error("frame {frame}: the step at {time} s failed even when cut to {h} s: {source}")]
    Solve {
        /// The frame that was being made.
        frame: u64,
        /// Time at the start of the step (s).
        time: f64,
        /// The shortest step tried (s).
        h: f64,
        /// Why.
        source: SolveError,
    },
    /// The mesh grew beyond what the system matrix can hold.
    #[error("frame {frame}: {message}")]
    TooLarge {
        /// The frame that was being made.
        frame: u64,
        /// What was too large.
        message: String,
    },
    /// The fluid could not go on.
    #[error("frame {frame}: the fluid: {source}")]
    Fluid {
        /// The frame that was being made.
        frame: u64,
        /// Why.
        source: sph::FluidError,
    },
    /// A remeshing setting is out of range.
    #[error("frame {frame}: {source}")]
    Remesh {
        /// The frame that was being made.
        frame: u64,
        /// Why.
        source: remesh::RemeshError,
    },
}

/// No cloth of the scene is remeshed, so a sizing field would never be asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no cloth of the scene has `remeshing`, so there is nothing to size")]
pub struct NothingRemeshed;

/// A running scene. Optional parts that the scene does not need are absent.
pub struct World {
    /// Number of the last finished frame; 0 is the initial state.
    pub frame: u64,
    /// The cloth of all garments.
    pub cloth: ClothState,
    /// What holds vertices.
    pub handles: Handles,
    /// Which panels belong to which cloth of the scene.
    pub garments: Vec<Garment>,
    /// Bodies that cloth cannot pass, those too that are not there yet or any more.
    pub obstacles: Vec<Obstacle>,
    /// How things touch; absent where nothing does.
    pub contact: Option<ContactSettings>,
    /// The fluid, if the scene has one.
    pub fluid: Option<Water>,
    /// The obstacles that are there, as the contact sees them.
    bodies: Bodies,
    /// What passes through what.
    tangled: Tangled,
    /// What the user should know about how the scene was built.
    pub warnings: Vec<String>,
    fabrics: Arc<Vec<Fabric>>,
    environment: Environment,
    frame_s: f64,
    substeps: u32,
    integrator: Box<dyn TimeIntegrator>,
    newton: NewtonSettings,
    solver: Box<dyn LinearSolver>,
    remeshing: Option<Remeshing>,
    /// Mass of fluid that moves along with each vertex (kg); empty for none.
    wet: Vec<f64>,
    /// Who may rest, if anybody may.
    restraints: Option<Restraints>,
    /// The cameras that thresholds of rest depend on, of cloth or fluid; absent where none does.
    eyes: Option<Eyes>,
    /// Of the last frame; the same as long as all sleeps.
    measured: Option<Measured>,
    /// What is worked out once per mesh; absent after the mesh has changed.
    prepared: Option<Prepared>,
    /// At the last frame, before it was remeshed (J).
    pub(crate) potential_energy_j: f64,
}

/// What follows from the current mesh alone.
struct Prepared {
    /// Forces and matrix.
    system: System,
    /// Lasting names of the vertices with their indices, see [`by_name`].
    names: Vec<(u64, u32)>,
}

impl std::fmt::Debug for World {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("World").field("frame", &self.frame).finish_non_exhaustive()
    }
}

/// The scene has grown beyond what matrices or collision trees can hold.
#[derive(Debug, thiserror::Error)]
enum PrepareError {
    #[error(transparent)]
    Pattern(#[from] PatternError),
    #[error(transparent)]
    Surface(#[from] SurfaceError),
}

/// How often remeshing is made again around places where it took cloth through something.
const HOLD_ROUNDS: u32 = 4;
/// How often a failing step is halved before the run ends.
const MAX_HALVINGS: u32 = 6;
/// How often it is halved before impacts may bring energy into it.
const RISE_DEPTH: u32 = 3;
/// How often it is halved before obstacles let caught cloth through.
const YIELD_DEPTH: u32 = 3;

impl World {
    /// Builds the world of a loaded scene.
    ///
    /// # Errors
    /// See [`BuildError`].
    pub fn new(loaded: &Loaded) -> Result<World, BuildError> {
        let built = build(loaded)?;
        let Built { cloth, fabrics, garments, handles, obstacles, fluid, contact, warnings } =
            built;
        let contact = wanted_contact(contact.filter(|_| !garments.is_empty()), &obstacles);
        let mut bodies = Bodies::default();
        if contact.is_some() {
            let updated = bodies.update(&obstacles, 0.0);
            updated.map_err(|e| BuildError::TooLarge(e.to_string()))?;
        }
        let scene = &loaded.scene;
        let settings =
            LinearSettings { tolerance: scene.linear_tolerance, ..LinearSettings::default() };
        let solver = match scene.linear_solver {
            Method::Auto => SolverKind::Auto,
            Method::Cholesky => SolverKind::SparseCholesky,
            Method::StaleCholesky => SolverKind::StaleFactorCg,
            Method::Pcg => SolverKind::BlockJacobiCg,
        };
        let integrator: Box<dyn TimeIntegrator> = match scene.integrator {
            Integrator::ImplicitEuler => Box::new(ImplicitEuler),
            Integrator::Sdirk2 => Box::new(Sdirk2),
        };
        let wind = scene.wind.as_ref().map(|wind| Wind {
            velocity: wind.velocity.into(),
            density: wind.density,
            drag: wind.drag,
        });
        let together = fluid.as_ref().map_or(0, |water| water.steps_among_others(scene.frame_s()));
        let restraints = Restraints::new(scene);
        let mut world = World {
            frame: 0,
            remeshing: Remeshing::new(scene, &garments, &cloth.mesh),
            cloth,
            handles,
            garments,
            obstacles,
            contact,
            fluid,
            bodies,
            tangled: Tangled::default(),
            warnings,
            fabrics: Arc::new(fabrics),
            environment: Environment { gravity: World3::from(scene.gravity), wind },
            frame_s: scene.frame_s(),
            substeps: scene.substeps.max(together),
            integrator,
            newton: NewtonSettings {
                max_iterations: scene.newton.max_iterations as usize,
                tolerance: scene.newton.tolerance,
            },
            solver: solver.build(settings),
            wet: Vec::new(),
            eyes: rest::eyes(scene, restraints.as_ref()),
            restraints,
            measured: None,
            prepared: None,
            potential_energy_j: 0.0,
        };
        world.look_who_may_rest();
        world.note_tangles();
        if let Some(crossings) = world.crossings(0) {
            world.warnings.push(World::tangle_warning("in the initial state", &crossings));
        }
        world.prepare().map_err(|e| BuildError::TooLarge(e.to_string()))?;
        world.measure(0.0);
        Ok(world)
    }

    /// Puts a sizing field of your own in the place of the one in use, which `field` is given to
    /// build upon or to drop. A world starts with the `PhysicalSizing` of every cloth's `remeshing`.
    ///
    /// The field is asked about all cloths; [`World::garments`] tells whose panels are whose. Those
    /// without `remeshing` stay as they are, and limits of the scene that are not the field's hold on:
    /// aspect, hysteresis, number of vertices.
    ///
    /// # Errors
    /// If the scene remeshes nothing; the world is then as before.
    pub fn set_sizing<S: SizingField + 'static>(
        &mut self,
        field: impl FnOnce(Box<dyn SizingField>) -> S,
    ) -> Result<(), NothingRemeshed> {
        let old = self.remeshing.take().ok_or(NothingRemeshed)?;
        self.remeshing = Some(old.sized_by(field));
        Ok(())
    }

    /// Steps of the cloth in a frame: those of the scene, or more where cloth meets fluid.
    pub fn substeps(&self) -> u32 {
        self.substeps
    }

    /// Simulated time of the last finished frame (s).
    pub fn time(&self) -> f64 {
        self.frame as f64 * self.frame_s
    }

    /// Makes the next frame: all its steps, then one remeshing.
    ///
    /// # Errors
    /// See [`StepError`]. A frame is a transaction: the world is then as a checkpoint of the last
    /// finished frame would restore it, and another try makes the whole frame.
    pub fn advance(&mut self) -> Result<FrameReport, StepError> {
        // Nothing that can fail changes the mesh.
        let start = (self.cloth.x.clone(), self.cloth.v.clone(), self.handles.clone());
        let fluid = self.fluid.as_ref().map(|water| water.fluid.checkpoint());
        self.make_frame().inspect_err(|_| {
            (self.cloth.x, self.cloth.v, self.handles) = start;
            if let (Some(water), Some(start)) = (&mut self.fluid, &fluid) {
                water.restore(start).expect("a state of this fluid");
            }
            self.forget();
            self.note_tangles();
        })
    }

    fn make_frame(&mut self) -> Result<FrameReport, StepError> {
        let frame = self.frame + 1;
        self.tangled.warnings.clear();
        let (mut solve, mut seconds, mut retries) = (SolveReport::default(), Seconds::default(), 0);
        let clock = Instant::now();
        let h = self.frame_s / f64::from(self.substeps);
        let together = self.fluid.as_ref().is_some_and(|water| water.meeting.is_some());
        let n_steps = if self.has_cloth() { self.substeps } else { 0 };
        for k in 0..if together { self.substeps } else { n_steps } {
            let step = Step { time: self.time() + f64::from(k) * h, h };
            if together {
                self.step_together(step, frame, &mut solve, &mut retries, &mut seconds)?;
            } else {
                self.step(step, frame, 0, &mut solve, &mut retries, &mut seconds)?;
            }
        }
        let fluid = if together {
            self.fluid_among_others()
        } else {
            self.move_fluid(frame, &mut seconds)?
        };
        // Where all has slept, nothing has changed that could be measured or remeshed.
        let slept = solve.rest.slept > 0 && solve.rest.slept == solve.stages;
        let looks = self.remeshing.as_ref().is_some_and(Remeshing::looks);
        let end = frame as f64 * self.frame_s;
        if let Some(prepared) = &self.prepared {
            prepared.system.settle(&mut self.cloth, end);
        }
        let measured = match self.measured.filter(|_| slept) {
            Some(measured) => measured,
            None => self.measure(end),
        };
        self.measured = Some(measured);
        let mut remeshed = None;
        let mut crossings = None;
        if slept && !looks {
            // What passes through something is led out of it and does not sleep.
        } else if let Some(remeshing) = &self.remeshing {
            let (before, next) = (self.cloth.mesh.uids().to_vec(), self.cloth.mesh.next_uid());
            let keep = self.handles.names();
            let error = |source| StepError::Remesh { frame, source };
            let saved = self.contact.is_some().then(|| self.cloth.clone());
            let is_tangled = self.tangled.matters();
            let tangled_before = if is_tangled { self.contour_length(frame) } else { 0.0 };
            let bodies = self.bodies.surface.as_ref().zip(self.contact.map(|c| c.thickness));
            let run = |cloth: &mut ClothState, hold: &[u64]| {
                let time = frame as f64 * self.frame_s;
                remeshing.run(cloth, time, &self.obstacles, &keep, hold, bodies).map_err(error)
            };
            let mut done = run(&mut self.cloth, &[])?;
            if let Some(saved) = saved {
                // Where flips and collapses took cloth through something, only splits are made next
                // time; in the end, everywhere.
                let mut hold = Vec::new();
                for round in 0.. {
                    crossings = self.crossings(frame);
                    let may_go_on = done.report.n_edits() > 0 && round <= HOLD_ROUNDS;
                    let Some(found) = crossings.as_ref().filter(|_| may_go_on) else { break };
                    if tangled_before > 0.0 && self.contour_length(frame) <= tangled_before {
                        break;
                    }
                    self.cloth = saved.clone();
                    hold.extend(found.vertices_near(&self.cloth));
                    if round == HOLD_ROUNDS {
                        hold = self.cloth.mesh.uids().to_vec();
                    }
                    done = run(&mut self.cloth, &hold)?;
                }
            }
            if done.report.n_edits() > 0 {
                self.prepared = None;
                self.handles.follow(&before, next, &done.report.journal);
                if let Some(water) = &mut self.fluid {
                    let scene = (&self.garments[..], &self.obstacles[..]);
                    water.follow(&self.cloth, scene, end);
                }
            }
            (seconds.view, seconds.sizing) = (done.view_s, done.sizing_s);
            seconds.remesh = done.edits_s;
            remeshed = Some(done);
        } else if self.contact.is_some() {
            crossings = self.crossings(frame);
        }
        self.frame = frame;
        seconds.view += self.look_who_may_rest();
        let yielded = self.tangled.yielding.len();
        self.tangled.was_at_work = self.tangled.matters();
        self.note_crossings(crossings.as_ref());
        seconds.solve(&solve);
        seconds.total = clock.elapsed().as_secs_f64();
        let (substeps, remeshed) = (n_steps, remeshed.as_ref());
        let crossings = self.contact.map(|_| crossings.map_or(0, |crossings| crossings.n));
        let mut report = FrameReport::new(
            self,
            substeps,
            retries,
            &solve,
            remeshed,
            crossings,
            measured.stretch,
            seconds,
        );
        if let Some(restraint) = &mut report.restraint {
            restraint.energy_j = measured.energy;
        }
        report.yielded = yielded;
        // After the look ahead: what is told of particles and what is recorded of them is the same.
        let water = self.fluid.as_ref().zip(fluid);
        report.fluid = water.map(|(water, done)| water.summary(&done, self.frame_s));
        report.warnings = std::mem::take(&mut self.tangled.warnings);
        Ok(report)
    }

    /// True if there is any cloth.
    pub fn has_cloth(&self) -> bool {
        !self.garments.is_empty()
    }

    /// Brings the obstacles that are there at the end of a step, and takes away the others.
    fn bring_obstacles(&mut self, step: Step, frame: u64) -> Result<(), StepError> {
        let Some(settings) = &self.contact else { return Ok(()) };
        let end = step.time + step.h;
        let changed = self.bodies.update(&self.obstacles, end);
        if changed.map_err(|e| StepError::TooLarge { frame, message: e.to_string() })? {
            if let Some(prepared) = self.prepared.take() {
                prepared.system.settle(&mut self.cloth, step.time);
            }
            let (times, time) = ([step.time, end], step.time);
            let found = appearing_in_cloth(&self.obstacles, &self.cloth, settings, times);
            if let Some((obstacle, crossings)) = found {
                let what = format!("obstacle `{obstacle}` appears at {time} s where cloth is");
                self.tangled.warnings.push(World::tangle_warning(&what, &crossings));
                self.tangled.is_so = true;
            }
        }
        Ok(())
    }

    /// What passes through what at the end of a frame; `None` if nothing does, or contact is off.
    pub fn crossings(&self, frame: u64) -> Option<Crossings> {
        let time = frame as f64 * self.frame_s;
        let settings = self.contact.as_ref()?;
        Crossings::find(&self.cloth, self.bodies.surface.as_ref(), settings, time)
    }

    /// Builds forces, contact, matrix and names if the mesh has changed.
    fn prepare(&mut self) -> Result<(), PrepareError> {
        if self.prepared.is_none() && self.has_cloth() {
            let h = self.integrator.stage(self.frame_s / f64::from(self.substeps));
            let mut system = System::new(&self.cloth, &self.fabrics, &self.environment, h)?;
            if let Some(settings) = self.contact {
                let contact =
                    SurfaceContact::new(&self.cloth, self.bodies.surface.as_ref(), settings)?
                        .with_thickness(&self.cloth, |panel| {
                            let of = |garment: &&Garment| garment.panels.contains(&panel);
                            self.garments.iter().find(of).and_then(|garment| garment.thickness)
                        });
                let contact = if self.tangled.matters() {
                    contact.tangled(&self.tangled.yielding)
                } else {
                    contact
                };
                system.set_contact(Box::new(contact));
            }
            if let Some(restraints) = &self.restraints {
                system.set_restraint(restraints.policy(&self.cloth, &self.garments));
            }
            self.prepared = Some(Prepared { system, names: by_name(&self.cloth.mesh) });
        }
        Ok(())
    }

    /// Forgets what a solver carries from step to step, so that a run that goes on from here and
    /// one that starts from a checkpoint of this state have the same bits.
    pub fn forget(&mut self) {
        self.solver.reset();
        self.prepared = None;
        if let Some(meeting) = self.fluid.as_mut().and_then(|water| water.meeting.as_mut()) {
            meeting.forget();
        }
    }

    /// Names of the forces that exist.
    pub fn force_names(&self) -> Vec<&'static str> {
        self.prepared.as_ref().map(|p| p.system.force_names()).unwrap_or_default()
    }
}

/// The contact to simulate: none where neither obstacles nor cloth itself can be touched.
fn wanted_contact(
    contact: Option<ContactSettings>,
    obstacles: &[Obstacle],
) -> Option<ContactSettings> {
    contact.filter(|settings| settings.self_contact || !obstacles.is_empty())
}
