//! All forces of a cloth and the system matrix they share: what exists is what the scene needs.

use crate::bending::ShapeOperatorForce;
use crate::contact::Contact;
use crate::element::{Elements, Stiffness};
use crate::fabric::Fabric;
use crate::force::{Force, Stage};
use crate::hinge::HingeModel;
use crate::membrane::MembraneModel;
use crate::point_forces::{Gravity, MassDamping, Springs};
use crate::rest::RestTriangle;
use crate::shape_operator::ShapeOperatorModel;
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
    /// Brings back what a step leaves out of its strain limits, if there are any.
    pub(crate) limits: Option<StrainProjection>,
}

impl std::fmt::Debug for System {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("System").field("forces", &self.force_names()).finish_non_exhaustive()
    }
}

/// A time in which nothing is dissipated (s).
const MOMENT: f64 = 1e-12;

impl System {
    /// Builds the forces that the fabrics and the environment call for, and the matrix pattern.
    /// Steps will be about `h` long (s), which decides how finely the stiffness is worked out, never
    /// what the forces are.
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

        let mut pattern = PatternBuilder::new(mesh.n_vertices());
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
            limits,
            contact: None,
        })
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
