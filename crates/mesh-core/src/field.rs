//! Values on vertices and triangles that follow the edits of a mesh.

use crate::edit::Edit;
use crate::mesh::Mesh;
use nalgebra::{Vector2, Vector3};

/// A value that a new vertex in the middle of an edge can inherit.
pub trait Blend: Clone {
    /// The value half-way between two others.
    fn midpoint(&self, other: &Self) -> Self;
}

impl Blend for f64 {
    fn midpoint(&self, other: &Self) -> Self {
        0.5 * (self + other)
    }
}

impl Blend for Vector2<f64> {
    fn midpoint(&self, other: &Self) -> Self {
        (self + other) * 0.5
    }
}

impl Blend for Vector3<f64> {
    fn midpoint(&self, other: &Self) -> Self {
        (self + other) * 0.5
    }
}

/// One value per vertex.
#[derive(Clone, Debug, PartialEq)]
pub struct VertexField<T> {
    values: Vec<T>,
    epoch: u64,
}

impl<T: Blend> VertexField<T> {
    /// A field on the mesh as it is now.
    ///
    /// # Panics
    /// If there is not one value per vertex.
    pub fn new(mesh: &Mesh, values: Vec<T>) -> Self {
        assert_eq!(values.len(), mesh.n_vertices(), "one value per vertex");
        VertexField { values, epoch: mesh.epoch() }
    }

    /// The values in vertex order.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The values in vertex order, to change.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// The mesh epoch that the field is in step with.
    pub fn epoch(&self) -> u64 {
        self.epoch
    }

    /// Replays edits: a split vertex gets the mean of its edge's ends, a collapsed one goes.
    ///
    /// # Panics
    /// If an edit does not fit the field: one was skipped.
    pub fn follow(&mut self, edits: &[Edit]) {
        for edit in edits {
            match *edit {
                Edit::Split { a, b, new, .. } => {
                    assert_eq!(new.index(), self.values.len(), "the field missed an edit");
                    let value = self.values[a.index()].midpoint(&self.values[b.index()]);
                    self.values.push(value);
                }
                Edit::Flip { .. } => {}
                Edit::Collapse { removed, .. } => {
                    self.values.swap_remove(removed.index());
                }
            }
        }
        self.epoch += edits.len() as u64;
    }
}

/// One value per triangle; children inherit their parent's value.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleField<T> {
    values: Vec<T>,
    epoch: u64,
}

impl<T: Clone> TriangleField<T> {
    /// A field on the mesh as it is now.
    ///
    /// # Panics
    /// If there is not one value per triangle.
    pub fn new(mesh: &Mesh, values: Vec<T>) -> Self {
        assert_eq!(values.len(), mesh.n_triangles(), "one value per triangle");
        TriangleField { values, epoch: mesh.epoch() }
    }

    /// The values in triangle order.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The values in triangle order, to change.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// The mesh epoch that the field is in step with.
    pub fn epoch(&self) -> u64 {
        self.epoch
    }

    /// Replays edits: triangles cut by a split copy their parent's value; a flip keeps both.
    pub fn follow(&mut self, edits: &[Edit]) {
        for edit in edits {
            match *edit {
                Edit::Split { parents, .. } => {
                    for parent in parents.into_iter().flatten() {
                        let value = self.values[parent.index()].clone();
                        self.values.push(value);
                    }
                }
                Edit::Flip { .. } => {}
                Edit::Collapse { triangles, .. } => {
                    for gone in triangles.into_iter().flatten() {
                        self.values.swap_remove(gone.index());
                    }
                }
            }
        }
        self.epoch += edits.len() as u64;
    }
}
