//! All forces of a cloth and the system matrix they share: what exists is what the scene needs.

use crate::bending::ShapeOperatorForce;
use crate::contact::Contact;
use crate::element::{Elements, Stiffness};
use crate::fabric::Fabric;
use crate::force::{Force, Stage};
use crate::hinge::HingeModel;
use crate::integrator::Step;
use crate::membrane::MembraneModel;
use crate::part::Part;
use crate::point_forces::{Gravity, MassDamping, Springs};
use crate::rest::RestTriangle;
use crate::resting::{Resting, RestingPolicy};
use crate::shape_operator::ShapeOperatorModel;
use crate::solve_report::{RestReport, SolveReport};
use crate::solver::{BlockMatrix, BlockPattern, PatternBuilder, PatternError};
use crate::strain_limit::StrainLimitModel;
use crate::strain_projection::StrainProjection;
use crate::wind::{Wind, WindModel};
use mesh_core::{ClothState, World3};
use std::sync::Arc;

/// What acts on the cloth from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Environment {
    /// Acceleration of gravity (m/s²).
    pub gravity: World3,
    /// Wind, if any.
    pub wind: Option<Wind>,
}

/// Where vertices are held at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Constraints {
    /// Vertices fixed exactly, with their positions (m).
    pub fixed: Vec<(u32, World3)>,
    /// Vertices pulled by springs: where to (m) and how stiffly (N/m).
    pub springs: Vec<(u32, World3, f64)>,
}

/// How much more room than it needs contact may keep.
const FEW: usize = 8;

/// The forces of one mesh. Built anew when the mesh changes.
pub struct System {
    forces: Vec<Box<dyn Force>>,
    pub(crate) springs: Springs,
    pub(crate) matrix: BlockMatrix,
    /// The pattern of the forces, without contact.
    mesh_pattern: Arc<BlockPattern>,
    /// What keeps the cloth from passing through things, if anything does.
    pub(crate) contact: Option<Box<dyn Contact>>,
    /// Stages to come that need not look for a better start than rest.
    pub(crate) rests: u32,
    /// Whether impacts may leave more energy than there would be at rest.
    pub(crate) accepts_rise: bool,
    /// Whether the air does work.
    is_windy: bool,
    /// Brings back what a step leaves out of its strain limits, if there are any.
    pub(crate) limits: Option<StrainProjection>,
    /// Who rests, if anybody may.
    pub(crate) resting: Option<Box<Resting>>,
}

impl std::fmt::Debug for System {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("System").field("forces", &self.force_names()).finish_non_exhaustive()
    }
}

/// A time in which nothing is dissipated (s).
pub(crate) const MOMENT: f64 = 1e-12;

impl System {
    /// Builds the forces that the fabrics and the environment call for, and the matrix pattern.
    /// Implicit stages will be about `h` long (s), which decides how finely the stiffness is worked out,
    /// never what the forces are.
    ///
    /// # Errors
    /// If the matrix would be too large for its indices.
    pub fn new(
        cloth: &ClothState,
        fabrics: &Arc<Vec<Fabric>>,
        environment: &Environment,
        h: f64,
    ) -> Result<System, PatternError> {
        let mesh = &cloth.mesh;
        let triangles = mesh.triangles();
        let rest = Arc::new(RestTriangle::all(cloth));
        let mut forces: Vec<Box<dyn Force>> = Vec::new();
        let membrane = MembraneModel::new(triangles, rest.clone(), fabrics.clone());
        forces.push(Box::new(Elements::new(membrane)));
        if let Some(m) = ShapeOperatorModel::new(mesh, rest.clone(), fabrics.clone()) {
            forces.push(Box::new(ShapeOperatorForce::new(m, &cloth.m, h)));
        }
        if let Some(m) = HingeModel::new(mesh, fabrics) {
            forces.push(Box::new(Elements::new(m)));
        }
        if let Some(m) = StrainLimitModel::new(triangles, rest.clone(), fabrics.clone()) {
            forces.push(Box::new(Elements::new(m)));
        }
        let limits = StrainProjection::new(triangles, rest.clone(), fabrics.clone());
        if let Some(wind) = environment.wind {
            forces.push(Box::new(Elements::new(WindModel::new(triangles, wind))));
        }
        if environment.gravity != World3::zeros() {
            forces.push(Box::new(Gravity::new(cloth.m.clone(), environment.gravity)));
        }
        if let Some(damping) = MassDamping::new(mass_damping_rates(cloth, &rest, fabrics)) {
            forces.push(Box::new(damping));
        }

        let system = System::of(mesh.n_vertices(), forces, limits)?;
        Ok(System { is_windy: environment.wind.is_some(), ..system })
    }

    fn of(
        n_vertices: usize,
        mut forces: Vec<Box<dyn Force>>,
        limits: Option<StrainProjection>,
    ) -> Result<System, PatternError> {
        let mut pattern = PatternBuilder::new(n_vertices);
        for force in &forces {
            force.couple(&mut pattern)?;
        }
        let matrix = BlockMatrix::new(Arc::new(pattern.build()?));
        for force in &mut forces {
            force.bind(matrix.pattern());
        }
        Ok(System {
            forces,
            springs: Springs::default(),
            mesh_pattern: matrix.pattern().clone(),
            matrix,
            rests: 0,
            accepts_rise: true,
            is_windy: false,
            limits,
            contact: None,
            resting: None,
        })
    }

    /// The forces of a part of the cloth, without springs and contact. On vertices that answer they
    /// have the same bits as in the whole.
    ///
    /// # Errors
    /// If the matrix would be too large for its indices.
    pub fn part(&self, part: &Part) -> Result<System, PatternError> {
        let forces = self.forces.iter().filter_map(|force| force.part(part)).collect();
        let limits = self.limits.as_ref().and_then(|limits| limits.part(part));
        System::of(part.vertices().len(), forces, limits)
    }

    /// Lets vertices rest as a policy says. Velocities of the cloth are then momenta over mass.
    pub fn set_restraint(&mut self, policy: RestingPolicy) {
        self.resting = Some(Box::new(Resting::new(policy, self)));
    }

    /// Puts another policy, of the same vertices, in the place of the one in use at a time (s), between
    /// steps: who sleeps sleeps on if it may.
    pub fn change_restraint(&mut self, policy: RestingPolicy, cloth: &mut ClothState, time: f64) {
        self.settle(cloth, time);
        match &mut self.resting {
            Some(resting) => resting.change_policy(policy, cloth, time),
            None => self.set_restraint(policy),
        }
    }

    /// Brings the velocities of vertices that sleep up to a time (s): between steps they are those at
    /// the time at which the vertex went to sleep.
    pub fn settle(&self, cloth: &mut ClothState, time: f64) {
        if let Some(resting) = &self.resting {
            resting.settle(&mut cloth.v, &cloth.m, time);
        }
    }

    /// Whether vertices stand or are free: see [`RestingPolicy::bleeding`].
    pub(crate) fn rests_by_friction(&self) -> bool {
        self.resting.as_ref().is_some_and(|resting| !resting.conserves())
    }

    /// Puts vertices to rest at the end of a step that began with these velocities (m/s).
    pub(crate) fn put_to_rest(&mut self, cloth: &mut ClothState, before: &[World3], step: Step) {
        if let Some(mut resting) = self.resting.take() {
            resting.put_to_rest(cloth, self, before, step);
            self.resting = Some(resting);
        }
    }

    /// Wakes all vertices, whose velocities must have been [settled](System::settle): something other
    /// than these forces has changed velocities or masses.
    pub fn wake_all(&mut self) {
        if let Some(resting) = &mut self.resting {
            resting.wake_all();
        }
    }

    /// Wakes some vertices at a time (s), and what is near them; for the same reason as
    /// [`System::wake_all`].
    pub fn wake(&mut self, vertices: Vec<u32>, time: f64) {
        if let Some(resting) = &mut self.resting {
            resting.wake(vertices, time);
        }
    }

    /// The pattern of the forces, without contact.
    pub(crate) fn mesh_pattern(&self) -> &BlockPattern {
        &self.mesh_pattern
    }

    /// Whether a step changes nothing, because all that could move sleeps; `stages` are the ends of its
    /// stages (s).
    pub(crate) fn sleeps(
        &mut self,
        constraints: &dyn Fn(f64) -> Constraints,
        step: Step,
        stages: &[f64],
    ) -> Option<SolveReport> {
        let (contact, resting) = (self.contact.as_deref(), self.resting.as_mut()?);
        resting.sleeps(contact, constraints, step, stages).then(|| SolveReport {
            stages: stages.len(),
            rest: RestReport {
                stages: stages.len(),
                slept: stages.len(),
                untouched: stages.len() * self.mesh_pattern.n_vertices(),
                ..RestReport::default()
            },
            ..SolveReport::default()
        })
    }

    /// Gradient of all forces, contact among them (N).
    pub(crate) fn gradient_with_contact(&self, x: &[World3]) -> Vec<World3> {
        let mut gradient = self.gradient(x);
        if let Some(contact) = &self.contact {
            contact.add_gradient(x, &mut gradient);
        }
        gradient
    }

    /// Gives the cloth contact. Steps then keep apart what is apart.
    pub fn set_contact(&mut self, contact: Box<dyn Contact>) {
        self.contact = Some(contact);
    }

    /// Whether a stage may end with more energy than the start at rest has because something was in the
    /// way, as where an obstacle hits cloth; so at first. If not, it ends with
    /// [`SolveError::Rise`](crate::SolveError::Rise): a shorter step does better.
    pub fn accept_rise(&mut self, accepted: bool) {
        self.accepts_rise = accepted;
    }

    /// Whether something else than these potentials does work between two times (s), the first of which
    /// has the cloth at `x` (m): wind, or things that move.
    pub(crate) fn is_driven(
        &self,
        x: &[World3],
        constraints: &dyn Fn(f64) -> Constraints,
        times: [f64; 2],
    ) -> bool {
        let [from, to] = times.map(constraints);
        let is_pulled = to.fixed.iter().any(|&(i, place)| x[i as usize] != place);
        let is_pushed = || self.contact.as_ref().is_some_and(|contact| !contact.is_still(times));
        // Velocities that are momenta tell no energy.
        let conserves = self.resting.as_ref().is_some_and(|resting| resting.conserves());
        self.is_windy || conserves || is_pulled || from != to || is_pushed()
    }

    /// Takes the contact back, with what it remembers.
    pub fn take_contact(&mut self) -> Option<Box<dyn Contact>> {
        self.contact.take()
    }

    /// Names of the forces that exist, contact among them.
    pub fn force_names(&self) -> Vec<&'static str> {
        let forces = self.forces.iter().map(|f| f.name());
        forces.chain(self.contact.iter().map(|c| c.name())).collect()
    }

    /// Potential energy of all forces at `x` (J): the fabric's, gravity's and the springs', and
    /// whatever the current stage dissipates.
    pub fn energy(&self, x: &[World3]) -> f64 {
        self.forces.iter().map(|f| f.energy(x)).sum::<f64>() + self.springs.energy(x)
    }

    /// Potential energy of cloth that lies still at `x` (J): the fabric's, gravity's and the springs'.
    /// What lags is taken from there until the next stage begins.
    pub fn energy_at_rest(&mut self, x: &[World3]) -> f64 {
        self.begin(Stage { x_t0: x, base: x, h: MOMENT });
        self.energy(x)
    }

    /// Gradient of [`System::energy`] (N).
    pub fn gradient(&self, x: &[World3]) -> Vec<World3> {
        let mut gradient = vec![World3::zeros(); x.len()];
        for force in &self.forces {
            force.add_gradient(x, &mut gradient);
        }
        self.springs.add_gradient(x, &mut gradient);
        gradient
    }

    /// Starts a stage: the forces take what they lag.
    pub fn begin(&mut self, stage: Stage<'_>) {
        for force in &mut self.forces {
            force.begin(stage);
        }
    }

    /// Tells the forces the step that is about to be tried.
    pub(crate) fn predict(&mut self, x: &[World3], step: &[World3]) {
        for force in &mut self.forces {
            force.predict(x, step);
        }
    }

    /// Makes the pattern large enough for the current contacts. One that is too large stays, until it
    /// is [`FEW`] times as large as it need be.
    pub(crate) fn make_room_for_contact(&mut self) -> Result<(), PatternError> {
        let Some(contact) = &self.contact else { return Ok(()) };
        let couples = contact.couples();
        let pattern = self.matrix.pattern();
        let has =
            |[a, b]: &[u32; 2]| pattern.slot(*a.max(b) as usize, *a.min(b) as usize).is_some();
        let n_more = pattern.n_blocks() - self.mesh_pattern.n_blocks();
        if couples.iter().all(has) && n_more <= FEW * couples.len() {
            return Ok(());
        }
        let mut wider = PatternBuilder::new(pattern.n_vertices());
        wider.add(&self.mesh_pattern.pairs())?;
        wider.add(&couples)?;
        self.matrix = BlockMatrix::new(Arc::new(wider.build()?));
        for force in &mut self.forces {
            force.bind(self.matrix.pattern());
        }
        Ok(())
    }

    /// Sets the matrix to the stiffness and adds the gradient.
    pub(crate) fn assemble(&mut self, x: &[World3], kind: Stiffness, gradient: &mut [World3]) {
        self.matrix.set_zero();
        for force in &self.forces {
            force.add_system(x, kind, gradient, &mut self.matrix);
        }
        self.springs.add_system(x, kind, gradient, &mut self.matrix);
        if let Some(contact) = &self.contact {
            contact.add_system(x, gradient, &mut self.matrix);
        }
    }
}

/// α m of every vertex (kg/s), lumped like the masses.
fn mass_damping_rates(cloth: &ClothState, rest: &[RestTriangle], fabrics: &[Fabric]) -> Vec<f64> {
    let mut rates = vec![0.0; cloth.mesh.n_vertices()];
    for (corners, rest) in cloth.mesh.triangles().iter().zip(rest) {
        let fabric = &fabrics[rest.panel as usize];
        for &i in corners {
            rates[i as usize] += fabric.damping.mass * fabric.density * rest.area / 3.0;
        }
    }
    rates
}
