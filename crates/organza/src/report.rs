//! What each frame of a run reports.

use crate::remeshing::Remeshed;
use crate::world::World;
use cloth_dynamics::{RestTriangle, SolveReport, principal_stretches};
use mesh_core::ClothState;
use serde::{Deserialize, Serialize};
use sizing_view::ViewFactors;

/// Seconds of wall time by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Seconds {
    /// The whole frame (s).
    pub total: f64,
    /// Forces and matrix pattern after a change of mesh (s).
    pub build: f64,
    /// Forces and matrix entries (s).
    pub assembly: f64,
    /// Linear solver (s).
    pub linear: f64,
    /// Energies in the line search (s).
    pub energy: f64,
    /// Finding contacts and keeping ways free (s).
    pub contact: f64,
    /// View factors (s).
    pub view: f64,
    /// Sizing field (s).
    pub sizing: f64,
    /// Mesh edits (s).
    pub remesh: f64,
    /// The fluid (s).
    pub fluid: f64,
}

impl Seconds {
    pub(crate) fn solve(&mut self, solve: &SolveReport) {
        self.assembly = solve.assembly_s;
        self.linear = solve.linear_s;
        self.energy = solve.energy_s;
        self.contact = solve.contact_s;
    }
}

/// Seconds of wall time that a fluid takes, by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FluidSeconds {
    /// New velocities and positions, nozzles and sinks (s).
    pub motion: f64,
    /// Listing neighbours (s).
    pub neighbours: f64,
    /// Densities of all particles (s).
    pub density: f64,
    /// Accelerations of all particles (s).
    pub force: f64,
    /// Densities and accelerations by what has changed (s).
    pub changes: f64,
    /// Meeting cloth and bodies that move (s).
    pub sheets: f64,
}

/// Speeds up to which particles of a fluid rest, by what the cameras see.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FluidViewSummary {
    /// The least (m/s).
    pub rest_min_m_per_s: f64,
    /// The greatest (m/s).
    pub rest_max_m_per_s: f64,
}

/// The fluid in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct FluidSummary {
    /// Particles at the end of the frame.
    pub particles: usize,
    /// Of those, how many move freely.
    pub active: usize,
    /// How many are on the way from rest to full dynamics.
    pub transition: usize,
    /// How many rest.
    pub restrained: usize,
    /// Time steps.
    pub steps: u64,
    /// Mean length of a step (s).
    pub step_s: f64,
    /// Particles that changed their place, summed over the steps.
    pub moved: u64,
    /// Steps in which everything was computed anew.
    pub sweeps: u64,
    /// Pairs of particles that were looked at for densities, summed over the steps.
    pub density_pairs: u64,
    /// The same for accelerations.
    pub force_pairs: u64,
    /// How often neighbours were listed anew.
    pub listings: u64,
    /// New particles.
    pub emitted: u64,
    /// Removed particles.
    pub drained: u64,
    /// How often a particle was stopped at cloth or a body that moves, summed over the steps.
    pub stopped: u64,
    /// How often these left a particle no room, so that it may have come through.
    pub squeezed: u64,
    /// What the cameras made of the thresholds of rest, if these depend on them.
    pub view: Option<FluidViewSummary>,
    /// Largest density of a particle (kg/m³).
    pub density_max_kg_per_m3: f64,
    /// Kinetic energy of the momenta (J).
    pub kinetic_energy_j: f64,
    /// Energy of compression, also of the walls (J).
    pub internal_energy_j: f64,
    /// Energy of gravity, from the origin up (J).
    pub potential_energy_j: f64,
    /// Wall time by stage.
    pub seconds: FluidSeconds,
}

/// Extreme principal stretches over all triangles, at the end of the steps and before remeshing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StretchRange {
    /// Smallest (1).
    pub min: f64,
    /// Largest (1).
    pub max: f64,
}

impl StretchRange {
    /// Measures a cloth.
    pub fn of(cloth: &ClothState) -> StretchRange {
        let mut range = StretchRange { min: f64::INFINITY, max: 0.0 };
        for (rest, t) in RestTriangle::all(cloth).iter().zip(cloth.mesh.triangle_ids()) {
            let ([high, low], _) =
                principal_stretches(&rest.deformation_gradient(&cloth.corners(t)));
            range.min = range.min.min(low);
            range.max = range.max.max(high);
        }
        range
    }
}

/// Remeshing of one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RemeshSummary {
    /// Split edges.
    pub splits: usize,
    /// Flipped edges.
    pub flips: usize,
    /// Removed vertices.
    pub collapses: usize,
    /// Smallest aspect of a triangle in material space (1).
    pub min_aspect: f64,
    /// True if the mesh could not be made as fine as wanted.
    pub limit_reached: bool,
}

/// What the camera saw of the cloth when the frame was remeshed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ViewSummary {
    /// Triangles to be meshed as finely as visible ones: in the picture now, or at a cut.
    pub visible: usize,
    /// Mean view factor of all triangles (1).
    pub mean_factor: f64,
}

impl ViewSummary {
    pub(crate) fn of(factors: &ViewFactors) -> ViewSummary {
        let values = factors.values();
        ViewSummary {
            visible: values.iter().filter(|&&v| v == 1.0).count(),
            mean_factor: values.iter().sum::<f64>() / values.len() as f64,
        }
    }
}

/// What restraint did in a frame, and who rests at its end.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RestraintSummary {
    /// Vertices with full dynamics.
    pub active: usize,
    /// Vertices that move, but slower than their momentum.
    pub transition: usize,
    /// Vertices that stand still.
    pub resting: usize,
    /// Implicit stages.
    pub stages: usize,
    /// Stages slept through: nothing was evaluated, assembled or solved.
    pub stages_slept: usize,
    /// Linear systems of the others.
    pub solves: usize,
    /// Vertices in these, summed.
    pub unknowns: usize,
    /// Vertices on which no force was evaluated, summed over stages.
    pub untouched: usize,
    /// Vertices that woke because their momentum or contact said so.
    pub woken: usize,
    /// Times that forces were built for a part of the cloth.
    pub parts_built: usize,
    /// Stages made again with a larger part.
    pub stages_redone: usize,
    /// Restrained kinetic energy and potential energy, that of contact left out, at the end of the steps
    /// (J).
    pub energy_j: f64,
    /// Momenta at rest that were cut, in stages that did not converge.
    pub momenta_cut: usize,
    /// What the vertices of every garment do in their order, each letter after how often it follows
    /// itself: `a`ctive, in `t`ransition, `r`esting, as in `12r3t`.
    pub states: Vec<String>,
}

/// Report of one frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameReport {
    /// Number of the frame; 0 is the initial state.
    pub frame: u64,
    /// Simulated time (s).
    pub time_s: f64,
    /// Vertices after remeshing.
    pub vertices: usize,
    /// Triangles after remeshing.
    pub faces: usize,
    /// Steps.
    pub substeps: u32,
    /// Steps that failed and were redone in halves.
    pub retries: u32,
    /// Newton iterations.
    pub newton_iterations: usize,
    /// Iterations of the linear solver.
    pub linear_iterations: usize,
    /// Numeric factorisations.
    pub factorisations: usize,
    /// Symbolic analyses.
    pub analyses: usize,
    /// Halvings in the line search.
    pub halvings: usize,
    /// Implicit stages solved.
    pub stages: usize,
    /// Implicit stages that stopped before they reached the tolerance.
    pub unconverged_stages: usize,
    /// Contacts with an energy, over all stages.
    pub contacts: usize,
    /// Vertices whose way was shortened at the end of a stage, because something was in it.
    pub shortened_ways: usize,
    /// Edges that pass through triangles at the end of the frame; absent without contact.
    pub crossings: Option<usize>,
    /// Places where obstacles let cloth through, because it had no room.
    #[serde(default)]
    pub yielded: usize,
    /// What the user should know of this frame.
    #[serde(default)]
    pub warnings: Vec<String>,
    /// Largest change of velocity in a last iteration (m/s).
    pub residual_m_per_s: f64,
    /// Extreme principal stretches.
    pub stretch: Option<StretchRange>,
    /// Remeshing, if the scene has any.
    pub remesh: Option<RemeshSummary>,
    /// What the camera saw, if mesh sizes depend on it.
    #[serde(default)]
    pub view: Option<ViewSummary>,
    /// The fluid, if the scene has one.
    #[serde(default)]
    pub fluid: Option<FluidSummary>,
    /// Who rests, if anything may.
    #[serde(default)]
    pub restraint: Option<RestraintSummary>,
    /// Kinetic energy of the cloth, the restrained one where anything may rest (J).
    pub kinetic_energy_j: f64,
    /// Potential energy of fabrics, gravity and springs at the end of the steps, before remeshing (J);
    /// absent in old recordings.
    #[serde(default)]
    pub potential_energy_j: Option<f64>,
    /// Stages that the scene does not need, and why.
    pub skipped: Vec<String>,
    /// Wall time.
    pub seconds: Seconds,
}

impl FrameReport {
    /// The report of the initial state: nothing was done.
    pub fn initial(world: &World) -> FrameReport {
        let solve = SolveReport::default();
        let stretch = StretchRange::of(&world.cloth);
        let crossings = world.contact.map(|_| world.crossings(world.frame).map_or(0, |c| c.n));
        let seconds = Seconds::default();
        let report = FrameReport::new(world, 0, 0, &solve, None, crossings, stretch, seconds);
        let nothing = sph::StepReport::default();
        let fluid = world.fluid.as_ref().map(|water| water.summary(&nothing, 0.0));
        FrameReport { fluid, ..report }
    }

    pub(crate) fn new(
        world: &World,
        substeps: u32,
        retries: u32,
        solve: &SolveReport,
        remeshed: Option<&Remeshed>,
        crossings: Option<usize>,
        stretch: StretchRange,
        seconds: Seconds,
    ) -> FrameReport {
        let (kinetic_energy_j, restraint) = world.kinetic_energy(&solve.rest);
        FrameReport {
            frame: world.frame,
            time_s: world.time(),
            vertices: world.cloth.mesh.n_vertices(),
            faces: world.cloth.mesh.n_triangles(),
            substeps,
            retries,
            newton_iterations: solve.iterations,
            linear_iterations: solve.linear_iterations,
            factorisations: solve.factorisations,
            analyses: solve.analyses,
            halvings: solve.halvings,
            stages: solve.stages,
            unconverged_stages: solve.unconverged,
            contacts: solve.touches,
            shortened_ways: solve.shortened,
            crossings,
            yielded: 0,
            warnings: Vec::new(),
            residual_m_per_s: solve.residual,
            stretch: (world.cloth.mesh.n_triangles() > 0).then_some(stretch),
            remesh: remeshed.map(|r| &r.report).map(|r| RemeshSummary {
                splits: r.n_splits,
                flips: r.n_flips,
                collapses: r.n_collapses,
                min_aspect: r.quality.aspect_min,
                limit_reached: r.limit_reached(),
            }),
            view: remeshed.and_then(|r| r.view),
            fluid: None,
            restraint,
            // A sum of nothing is -0.
            kinetic_energy_j: kinetic_energy_j + 0.0,
            potential_energy_j: Some(world.potential_energy_j),
            skipped: world.skipped(),
            seconds,
        }
    }
}
