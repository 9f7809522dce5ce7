//! Symmetric matrices of 3 × 3 blocks, one row of blocks per particle.

use crate::error::StateError;
use crate::{Matrix3, Vector3};
use nalgebra::DMatrix;

/// A symmetric matrix of 3 × 3 blocks, as the convex step looks at it: rows of blocks. Stiffness
/// matrices are in N/m.
pub trait Blocks {
    /// Number of rows of blocks.
    fn n_rows(&self) -> usize;
    /// The block on the diagonal.
    fn diagonal(&self, i: usize) -> Matrix3;
    /// Calls `visit` with column and block for every other block of a row that is not zero, in a
    /// fixed order.
    fn visit_row(&self, i: usize, visit: impl FnMut(usize, &Matrix3));

    /// Row i times a vector of blocks.
    fn row_times(&self, i: usize, d: &[Vector3]) -> Vector3 {
        let mut sum = self.diagonal(i) * d[i];
        self.visit_row(i, |j, block| sum += block * d[j]);
        sum
    }
}

/// A symmetric positive semidefinite map from displacements (m) to forces (N), as the convex step
/// looks at it.
pub trait Stiffness {
    /// Sets `out` to the matrix times `d`.
    fn multiply(&self, d: &[Vector3], out: &mut [Vector3]);
    /// Sets `out` to the sum of the absolute values of all that a particle's row of the product is
    /// summed from: the measure of its rounding.
    fn multiply_abs(&self, d: &[Vector3], out: &mut [f64]);
}

impl<B: Blocks> Stiffness for B {
    fn multiply(&self, d: &[Vector3], out: &mut [Vector3]) {
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.row_times(i, d);
        }
    }

    fn multiply_abs(&self, d: &[Vector3], out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            let mut sum = (self.diagonal(i) * d[i]).abs().sum();
            self.visit_row(i, |j, block| sum += (block * d[j]).abs().sum());
            *out = sum;
        }
    }
}

/// A matrix of which only the blocks of interacting particles are kept, both halves.
#[derive(Clone, Debug, PartialEq)]
pub struct SparseBlocks {
    diagonal: Vec<Matrix3>,
    start: Vec<usize>,
    column: Vec<usize>,
    block: Vec<Matrix3>,
}

impl SparseBlocks {
    /// A matrix of zeros for n particles, of which these pairs interact. The order of pairs does not
    /// matter, nor do repetitions.
    ///
    /// # Errors
    /// A pair that names a particle that is not there.
    pub fn new(
        n: usize,
        pairs: impl IntoIterator<Item = [usize; 2]>,
    ) -> Result<SparseBlocks, StateError> {
        let mut rows = vec![Vec::new(); n];
        for pair @ [i, j] in pairs {
            if i >= n || j >= n {
                return Err(StateError::Pair { pair, n });
            }
            if i != j {
                rows[i].push(j);
                rows[j].push(i);
            }
        }
        let mut start = vec![0];
        let mut column = Vec::new();
        for row in &mut rows {
            row.sort_unstable();
            row.dedup();
            column.extend_from_slice(row);
            start.push(column.len());
        }
        let block = vec![Matrix3::zeros(); column.len()];
        Ok(SparseBlocks { diagonal: vec![Matrix3::zeros(); n], start, column, block })
    }

    /// Sets every block to zero.
    pub fn clear(&mut self) {
        self.diagonal.fill(Matrix3::zeros());
        self.block.fill(Matrix3::zeros());
    }

    /// Adds a symmetric block on the diagonal.
    pub fn add_diagonal(&mut self, i: usize, block: &Matrix3) {
        self.diagonal[i] += block;
    }

    /// Adds a block at row i and column j, and its transpose at row j and column i.
    ///
    /// # Panics
    /// If the pair is not one of those that interact.
    pub fn add_pair(&mut self, i: usize, j: usize, block: &Matrix3) {
        let place = |i: usize, j: usize| {
            let row = &self.column[self.start[i]..self.start[i + 1]];
            let at = row.binary_search(&j).ok().map(|at| self.start[i] + at);
            at.unwrap_or_else(|| panic!("particles {i} and {j} do not interact"))
        };
        let (a, b) = (place(i, j), place(j, i));
        self.block[a] += block;
        self.block[b] += block.transpose();
    }

    /// Adds the stiffness k of a spring between i and j: k on both diagonal blocks, −k between them.
    ///
    /// # Panics
    /// If the pair is not one of those that interact.
    pub fn add_spring(&mut self, i: usize, j: usize, k: &Matrix3) {
        self.add_diagonal(i, k);
        self.add_diagonal(j, k);
        self.add_pair(i, j, &-k);
    }
}

impl Blocks for SparseBlocks {
    fn n_rows(&self) -> usize {
        self.diagonal.len()
    }

    #[inline]
    fn diagonal(&self, i: usize) -> Matrix3 {
        self.diagonal[i]
    }

    #[inline]
    fn visit_row(&self, i: usize, mut visit: impl FnMut(usize, &Matrix3)) {
        for at in self.start[i]..self.start[i + 1] {
            visit(self.column[at], &self.block[at]);
        }
    }
}

/// A dense symmetric matrix with three rows per particle, for small systems in which all interact.
impl Blocks for DMatrix<f64> {
    fn n_rows(&self) -> usize {
        self.nrows() / 3
    }

    fn diagonal(&self, i: usize) -> Matrix3 {
        self.fixed_view::<3, 3>(3 * i, 3 * i).into_owned()
    }

    fn visit_row(&self, i: usize, mut visit: impl FnMut(usize, &Matrix3)) {
        for j in (0..self.n_rows()).filter(|&j| j != i) {
            let block = self.fixed_view::<3, 3>(3 * i, 3 * j).into_owned();
            if block != Matrix3::zeros() {
                visit(j, &block);
            }
        }
    }
}
