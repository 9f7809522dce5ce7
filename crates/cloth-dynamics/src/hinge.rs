//! Bending by one angle per edge: the discrete hinge.
//!
//! E = ½ B l² θ²/(A + A′) with the rigidity B in the direction across the edge. It is cheap, but its
//! effective rigidity depends on the mesh: B on equilateral triangles, 0.75 to 3 times that on other
//! patterns (see `docs/decisions.md`).

use crate::dihedral;
use crate::element::{ElementModel, ElementSystem, Stiffness, chosen};
use crate::fabric::{BendingModel, Fabric};
use crate::force::Stage;
use crate::law::Law;
use mesh_core::{HalfEdge, Mesh, World3, geometry};
use nalgebra::Vector3;
use std::sync::Arc;

/// Hinges at all inner edges whose fabrics use them. Stencil: the edge's ends, then its apexes.
#[derive(Debug)]
pub struct HingeModel {
    stencils: Vec<[u32; 4]>,
    /// Stiffness of each angle (J): energy is half of it times θ².
    stiffness: Vec<f64>,
}

impl HingeModel {
    /// The hinges; `None` if no fabric uses them.
    pub fn new(mesh: &Mesh, fabrics: &Arc<Vec<Fabric>>) -> Option<Self> {
        let mut model = HingeModel { stencils: Vec::new(), stiffness: Vec::new() };
        let rigidity = |h: HalfEdge| {
            let fabric = &fabrics[mesh.panels()[h.triangle().index()] as usize];
            let law = fabric.bending.as_ref()?;
            let edge = mesh.material_edge(h).normalize();
            // A cylinder of unit curvature bent across the edge.
            let n = Vector3::new(edge.y * edge.y, edge.x * edge.x, -2.0 * edge.x * edge.y);
            (fabric.bending_model == BendingModel::Hinge).then(|| n.dot(&(law.at_rest() * n)))
        };
        for h in mesh.edges() {
            let Some(g) = mesh.twin(h) else { continue };
            let (Some(own), Some(other)) = (rigidity(h), rigidity(g)) else { continue };
            let length = 0.5 * (mesh.material_edge(h).norm() + mesh.material_edge(g).norm());
            let area = mesh.area(h.triangle()) + mesh.area(g.triangle());
            let ends = [mesh.origin(h), mesh.dest(h), mesh.opposite(h), mesh.opposite(g)];
            model.stencils.push(ends.map(|v| v.0));
            model.stiffness.push(0.5 * (own + other) * length * length / area);
        }
        (!model.stencils.is_empty()).then_some(model)
    }
}

impl ElementModel<4> for HingeModel {
    fn name(&self) -> &'static str {
        "hinges"
    }

    fn stencils(&self) -> &[[u32; 4]] {
        &self.stencils
    }

    fn begin(&mut self, _: Stage<'_>) {}

    fn predict(&mut self, _: &[World3], _: &[World3]) {}

    fn energy(&self, e: usize, x: &[World3; 4]) -> f64 {
        let theta = geometry::dihedral_angle(x[0], x[1], x[2], x[3]);
        0.5 * self.stiffness[e] * theta * theta
    }

    fn gradient(&self, e: usize, x: &[World3; 4]) -> [World3; 4] {
        let theta = geometry::dihedral_angle(x[0], x[1], x[2], x[3]);
        dihedral::gradient(x).map(|g| g * (self.stiffness[e] * theta))
    }

    fn system(&self, e: usize, x: &[World3; 4], kind: Stiffness, out: &mut ElementSystem<4>) {
        let theta = geometry::dihedral_angle(x[0], x[1], x[2], x[3]);
        let k = self.stiffness[e];
        let gradient = dihedral::gradient(x);
        out.active = true;
        for i in 0..4 {
            out.gradient[i] = gradient[i] * (k * theta);
            for j in 0..=i {
                out.stiffness[i][j] = gradient[i] * gradient[j].transpose() * k;
            }
        }
        if kind == Stiffness::Exact {
            let second = dihedral::hessian(x);
            for i in 0..4 {
                for j in 0..=i {
                    out.stiffness[i][j] += second[i][j] * (k * theta);
                }
            }
        }
    }

    fn part(&self, elements: &[u32], stencils: Vec<[u32; 4]>) -> Self {
        HingeModel { stencils, stiffness: chosen(&self.stiffness, elements) }
    }
}
