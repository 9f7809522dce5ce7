//! The sheet and the matrix that the kernels in `benches/kernels.rs` work on.

#![warn(missing_docs)]
#![forbid(unsafe_code)]

use cloth_dynamics::law::{Bending, Membrane, NotPositive, Quadratic};
use cloth_dynamics::solver::{BlockMatrix, PatternBuilder};
use cloth_dynamics::{
    BendingModel, Damping, Elements, Fabric, Force, MembraneModel, RestTriangle,
    ShapeOperatorModel, Stiffness,
};
use mesh_core::ClothState;
use mesh_core::generate::{Diagonal, grid};
use nalgebra::{Matrix3, Vector3};
use std::error::Error;
use std::sync::Arc;

/// Areal density of the sheet (kg/m²).
const DENSITY: f64 = 0.2;
/// Time step that the matrix belongs to (s).
const STEP: f64 = 0.005;

/// Square cloth of 1 m in gentle waves: `2 cells²` triangles.
///
/// # Errors
/// If `cells` is zero or too large for a mesh.
pub fn wavy_sheet(cells: usize) -> Result<ClothState, Box<dyn Error>> {
    let sheet = grid([1.0, 1.0], [cells, cells], Diagonal::Alternating)?;
    let mut cloth = ClothState::at_rest(sheet.mesh, sheet.positions, vec![DENSITY])?;
    for x in &mut cloth.x {
        x.z = 0.05 * (9.0 * x.x).sin() * (7.0 * x.y).cos();
    }
    Ok(cloth)
}

/// Membrane and bending of a cloth, with the system that they add up to.
pub struct Assembly {
    forces: Vec<Box<dyn Force>>,
    matrix: BlockMatrix,
    gradient: Vec<Vector3<f64>>,
}

impl Assembly {
    /// Knit of 1000 N/m and 1e-5 N m.
    ///
    /// # Errors
    /// If the matrix would be too large.
    pub fn new(cloth: &ClothState) -> Result<Assembly, Box<dyn Error>> {
        let fabrics = Arc::new(vec![fabric()?]);
        let rest = Arc::new(RestTriangle::all(cloth));
        let triangles = cloth.mesh.triangles();
        let membrane = MembraneModel::new(triangles, rest.clone(), fabrics.clone());
        let mut forces: Vec<Box<dyn Force>> = vec![Box::new(Elements::new(membrane))];
        if let Some(bending) = ShapeOperatorModel::new(&cloth.mesh, rest, fabrics) {
            forces.push(Box::new(Elements::new(bending)));
        }
        let mut pattern = PatternBuilder::new(cloth.mesh.n_vertices());
        forces.iter().try_for_each(|force| force.couple(&mut pattern))?;
        let matrix = BlockMatrix::new(Arc::new(pattern.build()?));
        forces.iter_mut().for_each(|force| force.bind(matrix.pattern()));
        let gradient = vec![Vector3::zeros(); cloth.mesh.n_vertices()];
        Ok(Assembly { forces, matrix, gradient })
    }

    /// Gradient and stiffness at the positions of the cloth.
    pub fn assemble(&mut self, cloth: &ClothState) {
        self.matrix.set_zero();
        self.gradient.fill(Vector3::zeros());
        for force in &self.forces {
            force.add_system(&cloth.x, Stiffness::Projected, &mut self.gradient, &mut self.matrix);
        }
    }

    /// The matrix `M + h² K` of a step of implicit Euler (kg) and its right side (kg m/s²).
    pub fn step_matrix(&mut self, cloth: &ClothState) -> (BlockMatrix, Vec<Vector3<f64>>) {
        self.assemble(cloth);
        let mut matrix = self.matrix.clone();
        matrix.blocks_mut().iter_mut().for_each(|block| *block *= STEP * STEP);
        for (i, &m) in cloth.m.iter().enumerate() {
            *matrix.diagonal_mut(i) += Matrix3::identity() * m;
        }
        (matrix, self.gradient.iter().map(|g| -g).collect())
    }
}

fn fabric() -> Result<Fabric, NotPositive> {
    Ok(Fabric {
        density: DENSITY,
        membrane: Membrane::Orthotropic(Quadratic::isotropic(1000.0, 0.3)?),
        bending: Some(Bending::Orthotropic(Quadratic::isotropic(1e-5, 0.3)?)),
        bending_model: BendingModel::ShapeOperator,
        tension_field: false,
        strain_limits: None,
        damping: Damping::default(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cloth_dynamics::solver::{LinearSettings, LinearSolver, SparseCholesky};

    #[test]
    fn the_kernels_have_work_to_do() {
        let cloth = wavy_sheet(8).unwrap();
        assert_eq!(cloth.mesh.n_triangles(), 128);
        let mut assembly = Assembly::new(&cloth).unwrap();
        assert_eq!(assembly.forces.len(), 2);
        let (matrix, right) = assembly.step_matrix(&cloth);
        assert!(right.iter().all(|g| g.norm() > 0.0));
        let mut x = vec![Vector3::zeros(); right.len()];
        SparseCholesky::new(LinearSettings::default()).solve(&matrix, &right, &mut x).unwrap();
        assert!(x.iter().any(|x| x.norm() > 0.0));
    }
}
