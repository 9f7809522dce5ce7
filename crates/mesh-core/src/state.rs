//! The state of cloth: mesh, positions, velocities and masses, kept together through edits.

use crate::construct::MeshError;
use crate::edit::{Edit, Refusal};
use crate::geometry::World3;
use crate::ids::{HalfEdge, TriangleId, VertexId};
use crate::mesh::Mesh;

/// Cloth in motion. Masses are lumped: a third of each triangle's mass goes to each corner, so they
/// are always a function of the mesh alone and the total is conserved to rounding; every edit also
/// conserves linear momentum to rounding.
#[derive(Clone, Debug, PartialEq)]
pub struct ClothState {
    /// Topology and material space.
    pub mesh: Mesh,
    /// World positions (m).
    pub x: Vec<World3>,
    /// Velocities (m/s).
    pub v: Vec<World3>,
    /// Lumped vertex masses (kg).
    pub m: Vec<f64>,
    /// Areal density of every panel (kg/m²).
    density: Vec<f64>,
}

impl ClothState {
    /// Cloth at the given positions (m) without velocity; `density` is the areal density of every
    /// panel (kg/m²).
    ///
    /// # Errors
    /// If lengths do not fit, a position is not finite, or a density is not positive.
    pub fn at_rest(mesh: Mesh, x: Vec<World3>, density: Vec<f64>) -> Result<Self, MeshError> {
        let v = vec![World3::zeros(); x.len()];
        ClothState::new(mesh, x, v, density)
    }

    /// Cloth with positions (m) and velocities (m/s).
    ///
    /// # Errors
    /// As for [`ClothState::at_rest`].
    pub fn new(
        mesh: Mesh,
        x: Vec<World3>,
        v: Vec<World3>,
        density: Vec<f64>,
    ) -> Result<Self, MeshError> {
        for (what, field) in [("position of vertex", &x), ("velocity of vertex", &v)] {
            if field.len() != mesh.n_vertices() {
                let expected = mesh.n_vertices();
                return Err(MeshError::Length { what, expected, got: field.len() });
            }
            if let Some(index) = field.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
                return Err(MeshError::NotFinite { what, index });
            }
        }
        let n_panels = mesh.panels().iter().max().map_or(0, |&p| p as usize + 1);
        if density.len() < n_panels {
            let (expected, got) = (n_panels, density.len());
            return Err(MeshError::Length { what: "panel densities", expected, got });
        }
        if let Some(panel) = density.iter().position(|d| !(d.is_finite() && *d > 0.0)) {
            return Err(MeshError::Density { panel, density: density[panel] });
        }
        let mut state = ClothState { m: vec![0.0; mesh.n_vertices()], mesh, x, v, density };
        for i in state.mesh.vertices() {
            state.m[i.index()] = state.lumped_mass(i);
        }
        Ok(state)
    }

    /// Areal densities of the panels (kg/m²).
    pub fn densities(&self) -> &[f64] {
        &self.density
    }

    /// World positions of a triangle's corners (m).
    #[inline]
    pub fn corners(&self, t: TriangleId) -> [World3; 3] {
        self.mesh.triangles()[t.index()].map(|i| self.x[i as usize])
    }

    /// Sum of the masses (kg).
    pub fn total_mass(&self) -> f64 {
        self.m.iter().sum()
    }

    /// Linear momentum (kg m/s).
    pub fn momentum(&self) -> World3 {
        self.m.iter().zip(&self.v).map(|(m, v)| v * *m).sum()
    }

    /// Angular momentum about the origin (kg m²/s).
    pub fn angular_momentum(&self) -> World3 {
        let terms = self.m.iter().zip(self.x.iter().zip(&self.v));
        terms.map(|(m, (x, v))| x.cross(v) * *m).sum()
    }

    /// Kinetic energy (J).
    pub fn kinetic_energy(&self) -> f64 {
        self.m.iter().zip(&self.v).map(|(m, v)| 0.5 * m * v.norm_squared()).sum()
    }

    /// Splits an edge: the new vertex gets the mean position and velocity of its ends.
    ///
    /// # Errors
    /// See [`Mesh::split`]; nothing is changed then.
    pub fn split(&mut self, h: HalfEdge) -> Result<Edit, Refusal> {
        let edit = self.mesh.split(h)?;
        if let Edit::Split { a, b, new, .. } = edit {
            let (a, b) = (a.index(), b.index());
            self.x.push((self.x[a] + self.x[b]) * 0.5);
            self.v.push((self.v[a] + self.v[b]) * 0.5);
            self.m.push(0.0);
            // Linear interpolation moves mass and momentum together: nothing to correct.
            self.lump_around(new);
        }
        Ok(edit)
    }

    /// Flips an edge; see [`Mesh::flip`].
    ///
    /// # Errors
    /// See [`Mesh::can_flip`]; nothing is changed then.
    pub fn flip(&mut self, h: HalfEdge) -> Result<Edit, Refusal> {
        let edit = self.mesh.flip(h)?;
        if let Edit::Flip { triangles: [t, s] } = edit {
            let [d, b, c] = self.mesh.triangles()[t.index()];
            let a = self.mesh.triangles()[s.index()][1];
            let patch = [a, b, c, d].map(VertexId);
            self.lump_conserving(&patch, World3::zeros());
        }
        Ok(edit)
    }

    /// Merges `removed` into `kept`; see [`Mesh::collapse`].
    ///
    /// # Errors
    /// See [`Mesh::can_collapse`]; nothing is changed then.
    pub fn collapse(&mut self, removed: VertexId, kept: VertexId) -> Result<Edit, Refusal> {
        let mut patch: Vec<VertexId> = self.mesh.neighbours(removed).collect();
        let edit = self.mesh.collapse(removed, kept)?;
        let lost = self.v[removed.index()] * self.m[removed.index()];
        self.x.swap_remove(removed.index());
        self.v.swap_remove(removed.index());
        self.m.swap_remove(removed.index());
        let last = VertexId(self.x.len() as u32);
        for v in &mut patch {
            if *v == last {
                *v = removed;
            }
        }
        self.lump_conserving(&patch, lost);
        Ok(edit)
    }

    /// Recomputes the masses of a patch and spreads the momentum that the change of masses made
    /// (plus `extra`, kg m/s) evenly over it, as one common change of velocity.
    fn lump_conserving(&mut self, patch: &[VertexId], extra: World3) {
        let momentum =
            |s: &Self| -> World3 { patch.iter().map(|i| s.v[i.index()] * s.m[i.index()]).sum() };
        let before = momentum(self) + extra;
        for &i in patch {
            self.m[i.index()] = self.lumped_mass(i);
        }
        let mass: f64 = patch.iter().map(|i| self.m[i.index()]).sum();
        let correction = (before - momentum(self)) / mass;
        for &i in patch {
            self.v[i.index()] += correction;
        }
    }

    /// Recomputes the masses of a vertex and its neighbours.
    fn lump_around(&mut self, v: VertexId) {
        let ring: Vec<VertexId> = self.mesh.neighbours(v).chain([v]).collect();
        for i in ring {
            self.m[i.index()] = self.lumped_mass(i);
        }
    }

    /// Brings the state to the form that depends on nothing but itself: first half-edges as in
    /// [`Mesh::normalise`] and masses summed in that order, as [`ClothState::new`] makes them from
    /// the same triangles. A state that was saved and restored then has the same bits as one that
    /// was not.
    pub fn normalise(&mut self) {
        self.mesh.normalise();
        let mut m = std::mem::take(&mut self.m);
        crate::par::fill(&mut m, |v| self.lumped_mass(VertexId(v as u32)));
        self.m = m;
    }

    fn lumped_mass(&self, v: VertexId) -> f64 {
        let third = |h: HalfEdge| {
            let t = h.triangle();
            self.density[self.mesh.panels()[t.index()] as usize] * self.mesh.area(t) / 3.0
        };
        self.mesh.outgoing(v).map(third).sum()
    }
}
