//! The state of a fluid as plain data: a run that goes on from it has the bits of one that never
//! stopped.

use crate::changes::Overdue;
use crate::fluid::Fluid;
use crate::settings::FluidError;
use arps::Restraint;
use serde::{Deserialize, Serialize};

/// All that a fluid carries from step to step, but for settings, walls, nozzles, sinks and policy, which
/// belong to the scene. Particles are in the order of [`Fluid::particles`].
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Simulated time (s).
    pub time: f64,
    /// Lasting numbers of the particles, and the next one to give.
    pub id: Vec<u64>,
    /// The next lasting number.
    pub next_id: u64,
    /// Positions (m) and p/ρ² (Pa m⁶/kg²).
    pub x: Vec<[f64; 4]>,
    /// Effective velocities (m/s) and the densities that accelerations have (kg/m³).
    pub w: Vec<[f64; 4]>,
    /// Momenta per mass (m/s), and 0.
    pub u: Vec<[f64; 4]>,
    /// Accelerations (m/s²), and 0.
    pub a: Vec<[f64; 4]>,
    /// Densities, without moving surfaces (kg/m³).
    pub density: Vec<f64>,
    /// Accelerations (m/s²) and densities (kg/m³) by moving surfaces; empty if there are none.
    pub by_sheets: Vec<[f64; 4]>,
    /// Impulses that moving surfaces have yet to get (N s), and 0; empty if there are none.
    pub given: Vec<[f64; 4]>,
    /// Positions when neighbours were last listed (m), and a number of no use.
    pub listed: Vec<[f64; 4]>,
    /// p/ρ² (Pa m⁶/kg²) and densities (kg/m³) of the particles of walls that fluid may touch.
    pub walls: Vec<[f64; 2]>,
    /// Which particles of walls these are.
    pub touched: Vec<u32>,
    /// How often a single particle has got a list of neighbours since all did.
    pub mended: u64,
    /// Greatest speed (m/s), acceleration (m/s²) and way from where neighbours were listed (m).
    pub greatest: [f64; 3],
    /// Layers that each nozzle has let out.
    pub layers: Vec<u64>,
    /// Steps since particles at rest got their accelerations.
    pub age: u32,
    /// What has changed since then: numbers of particles with movers near them, of particles with another
    /// pressure, and of `walls` with another pressure.
    pub overdue: [Vec<u32>; 3],
    /// True if the next step may begin from what this one has computed.
    pub incremental: bool,
}

impl<R: Restraint> Fluid<R> {
    /// The state as it is.
    pub fn checkpoint(&self) -> Checkpoint {
        let (state, touched, changes) = (&self.state, &self.touched, &self.scratch.changes);
        let walls = touched.x.iter().zip(&touched.density).map(|(x, &density)| [x[3], density]);
        Checkpoint {
            time: self.time,
            id: state.id.clone(),
            next_id: self.next_id,
            x: state.x.clone(),
            w: state.w.clone(),
            u: state.u.clone(),
            a: state.a.clone(),
            density: state.density.clone(),
            by_sheets: state.by_sheets.clone(),
            given: state.given.clone(),
            listed: self.listed.clone(),
            walls: walls.collect(),
            touched: touched.number.clone(),
            mended: self.neighbours.n_mended,
            greatest: [self.fastest, self.hardest, self.farthest],
            layers: self.emitters.iter().map(|emitter| emitter.n_layers).collect(),
            age: changes.overdue.age,
            overdue: changes.overdue.lists.clone(),
            incremental: changes.is_known(state.len()),
        }
    }

    /// Puts a fluid of the same scene into the state of a checkpoint.
    ///
    /// # Errors
    /// If the parts of the checkpoint do not fit each other or this scene, or a particle is outside of
    /// the domain. The fluid is then as it was.
    pub fn restore(&mut self, from: &Checkpoint) -> Result<(), FluidError> {
        let n = from.id.len();
        let check = |what, found: usize, expected: usize| match found == expected {
            true => Ok(()),
            false => Err(FluidError::Length { what, found, expected }),
        };
        for (what, list) in [
            ("positions", &from.x),
            ("effective velocities", &from.w),
            ("velocities", &from.u),
            ("accelerations", &from.a),
            ("positions of the lists", &from.listed),
        ] {
            check(what, list.len(), n)?;
        }
        check("densities", from.density.len(), n)?;
        if !from.by_sheets.is_empty() {
            check("accelerations by surfaces", from.by_sheets.len(), n)?;
            check("impulses to surfaces", from.given.len(), n)?;
        }
        check("emitters", from.layers.len(), self.emitters.len())?;
        for (k, id) in from.id.iter().enumerate() {
            for x in [&from.x[k], &from.listed[k]] {
                let inside =
                    self.settings.domain.contains(&nalgebra::Vector3::new(x[0], x[1], x[2]));
                if !inside || !from.u[k].iter().chain(&from.w[k]).all(|u| u.is_finite()) {
                    let speed = nalgebra::Vector4::from(from.u[k]).norm();
                    let (x, y, z) = (x[0], x[1], x[2]);
                    return Err(FluidError::Escaped { id: *id, x, y, z, speed });
                }
            }
        }
        for (list, n) in from.overdue.iter().zip([n, n, from.walls.len()]) {
            if let Some(&i) = list.iter().find(|&&i| i as usize >= n) {
                check("particles whose accelerations are overdue", i as usize + 1, n)?;
            }
        }
        check("particles of walls", from.touched.len(), from.walls.len())?;
        let n_walls = self.walls.n_particles();
        if let Some(&number) = from.touched.iter().find(|&&j| j as usize >= n_walls) {
            let (what, found) = ("particles of walls", number as usize + 1);
            return Err(FluidError::Length { what, found, expected: n_walls });
        }
        let before = self.checkpoint();
        self.take(from);
        let (found, expected) = (from.walls.len(), self.touched.x.len());
        if found != expected {
            self.take(&before);
            return Err(FluidError::Length { what: "particles of walls", found, expected });
        }
        Ok(())
    }

    fn take(&mut self, from: &Checkpoint) {
        self.time = from.time;
        self.next_id = from.next_id;
        self.state.id.clone_from(&from.id);
        self.state.x.clone_from(&from.x);
        self.state.w.clone_from(&from.w);
        self.state.u.clone_from(&from.u);
        self.state.a.clone_from(&from.a);
        self.state.density.clone_from(&from.density);
        self.state.by_sheets.clone_from(&from.by_sheets);
        self.state.given.clone_from(&from.given);
        self.listed.clone_from(&from.listed);
        self.list_around_listed(&from.touched);
        self.neighbours.n_mended = from.mended;
        for ((x, density), &[term, of_wall]) in
            self.touched.x.iter_mut().zip(&mut self.touched.density).zip(&from.walls)
        {
            (x[3], *density) = (term, of_wall);
        }
        [self.fastest, self.hardest, self.farthest] = from.greatest;
        for (emitter, &n_layers) in self.emitters.iter_mut().zip(&from.layers) {
            emitter.n_layers = n_layers;
        }
        let changes = &mut self.scratch.changes;
        if from.incremental {
            changes.evaluated_all(&self.state, &self.touched);
            changes.overdue = Overdue { age: from.age, lists: from.overdue.clone() };
        } else {
            changes.forget();
        }
    }
}
