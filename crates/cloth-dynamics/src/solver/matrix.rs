//! The system matrix: one 3×3 block per slot of a pattern, and what one does with it: add element
//! blocks, multiply by a vector, pin vertices.

use std::sync::Arc;

use nalgebra::{Matrix3, Vector3};

use super::pattern::BlockPattern;
use super::sums::{CHUNK, dot};

/// A symmetric matrix of 3×3 blocks. Slot `(i, j)`, `i ≥ j`, holds `A_ij`; the upper triangle is
/// its transpose and is not stored.
#[derive(Clone, Debug)]
pub struct BlockMatrix {
    pattern: Arc<BlockPattern>,
    blocks: Vec<Matrix3<f64>>,
}

impl BlockMatrix {
    /// The zero matrix of this pattern.
    pub fn new(pattern: Arc<BlockPattern>) -> Self {
        let blocks = vec![Matrix3::zeros(); pattern.n_blocks()];
        Self { pattern, blocks }
    }

    /// The pattern, shared.
    pub fn pattern(&self) -> &Arc<BlockPattern> {
        &self.pattern
    }

    /// Adds `share` of the Gershgorin row sums to the diagonal of every vertex. Whatever the matrix, a
    /// share above one makes it positive definite: no row then has more off the diagonal than on it.
    pub(super) fn shifted(&self, share: f64) -> Self {
        let mut shifted = self.clone();
        let sums = self.row_sums();
        let largest = sums.iter().copied().fold(0.0, f64::max);
        for (i, &sum) in sums.iter().enumerate() {
            // A vertex without any entry gets the scale of the others; of nothing at all, one.
            let scale = [sum, largest, 1.0].into_iter().find(|&s| s > 0.0).unwrap_or(1.0);
            let diagonal = shifted.diagonal_mut(i);
            *diagonal += Matrix3::from_diagonal_element(share * scale);
        }
        shifted
    }

    /// How many vertices (block rows).
    pub fn n_vertices(&self) -> usize {
        self.pattern.n_vertices()
    }

    /// All blocks, by slot.
    pub fn blocks(&self) -> &[Matrix3<f64>] {
        &self.blocks
    }

    /// All blocks, by slot, to be written.
    pub fn blocks_mut(&mut self) -> &mut [Matrix3<f64>] {
        &mut self.blocks
    }

    /// Sets every block to zero and keeps the pattern.
    pub fn set_zero(&mut self) {
        self.blocks.fill(Matrix3::zeros());
    }

    /// Adds `block` to `A_ij`, where `slot` is the slot of `(i, j)`, `i ≥ j` (see
    /// [`BlockPattern::slot`]).
    pub fn add(&mut self, slot: usize, block: &Matrix3<f64>) {
        self.blocks[slot] += block;
    }

    /// The matrix of some of the vertices, see [`BlockPattern::restricted`].
    pub(crate) fn restricted(&self, pattern: Arc<BlockPattern>, slots: &[u32]) -> Self {
        let blocks = slots.iter().map(|&slot| self.blocks[slot as usize]).collect();
        Self { pattern, blocks }
    }

    /// For each vertex, the sum of the absolute values of all that its row of A x is summed from.
    pub(crate) fn multiply_abs(&self, x: &[Vector3<f64>], y: &mut [f64]) {
        y.fill(0.0);
        for j in 0..self.n_vertices() {
            for slot in self.pattern.column(j) {
                let i = self.pattern.rows()[slot] as usize;
                let block = &self.blocks[slot];
                y[i] += (block * x[j]).abs().sum();
                if i != j {
                    y[j] += block.tr_mul(&x[i]).abs().sum();
                }
            }
        }
    }

    /// The block of a slot.
    pub fn block(&self, slot: usize) -> &Matrix3<f64> {
        &self.blocks[slot]
    }

    /// The diagonal block of vertex `i`.
    pub fn diagonal(&self, i: usize) -> &Matrix3<f64> {
        &self.blocks[self.pattern.diagonal_slot(i)]
    }

    /// The diagonal block of vertex `i`, to be written (mass goes here).
    pub fn diagonal_mut(&mut self, i: usize) -> &mut Matrix3<f64> {
        &mut self.blocks[self.pattern.diagonal_slot(i)]
    }

    /// The product `y = A x`.
    ///
    /// Each stored block is read once and used twice, for `A_ij` and for its transpose. Reading the
    /// whole matrix row by row instead takes 1.2 to 1.9 times as long: the blocks come from memory,
    /// and memory is the limit.
    ///
    /// # Panics
    /// If `x` or `y` does not have one entry per vertex.
    pub fn multiply(&self, x: &[Vector3<f64>], y: &mut [Vector3<f64>]) {
        self.multiply_dot(x, y);
    }

    /// The product `y = A x`, and `xᵀ A x` on the way.
    pub(super) fn multiply_dot(&self, x: &[Vector3<f64>], y: &mut [Vector3<f64>]) -> f64 {
        let n = self.n_vertices();
        assert!(x.len() == n && y.len() == n, "vectors must have one entry per vertex");
        y.fill(Vector3::zeros());
        let starts = self.pattern.column_starts();
        let rows = self.pattern.rows();
        let mut sum = 0.0;
        for first in (0..n).step_by(CHUNK) {
            let mut partial = Vector3::zeros();
            for j in first..(first + CHUNK).min(n) {
                let (begin, end) = (starts[j] as usize, starts[j + 1] as usize);
                let x_j = x[j];
                let mut y_j = self.blocks[begin] * x_j;
                for (block, &i) in self.blocks[begin + 1..end].iter().zip(&rows[begin + 1..end]) {
                    y_j += block.tr_mul(&x[i as usize]);
                    y[i as usize] += block * x_j;
                }
                // Columns up to j have all been seen, so this row is complete.
                y[j] += y_j;
                partial += x_j.component_mul(&y[j]);
            }
            sum += partial.sum();
        }
        sum
    }

    /// The residual `r = b − A x`; returns its squared norm.
    pub(super) fn residual(
        &self,
        b: &[Vector3<f64>],
        x: &[Vector3<f64>],
        r: &mut [Vector3<f64>],
    ) -> f64 {
        self.multiply(x, r);
        for (r_i, b_i) in r.iter_mut().zip(b) {
            *r_i = b_i - *r_i;
        }
        dot(r, r)
    }

    /// Takes the fixed vertices out of the system: their rows and columns become those of the
    /// identity. With a zero right-hand side there (see [`clear_fixed`]) the solution is zero at the
    /// fixed vertices, and at the others that of the system without them.
    ///
    /// The pattern stays, so pinning and letting go cost no new analysis.
    ///
    /// # Panics
    /// If `fixed` does not have one entry per vertex.
    pub fn eliminate(&mut self, fixed: &[bool]) {
        assert!(fixed.len() == self.n_vertices(), "the mask must have one entry per vertex");
        let starts = self.pattern.column_starts();
        let rows = self.pattern.rows();
        for j in 0..fixed.len() {
            let (begin, end) = (starts[j] as usize, starts[j + 1] as usize);
            for (block, &i) in self.blocks[begin..end].iter_mut().zip(&rows[begin..end]) {
                if fixed[j] || fixed[i as usize] {
                    *block = Matrix3::zeros();
                }
            }
            if fixed[j] {
                self.blocks[begin] = Matrix3::identity();
            }
        }
    }

    /// For each vertex, the largest sum of absolute values along one of its three scalar rows.
    ///
    /// By Gershgorin's theorem every eigenvalue lies within these sums of zero; the largest of them
    /// is the ∞-norm of the matrix.
    pub(super) fn row_sums(&self) -> Vec<f64> {
        let mut sums = vec![Vector3::<f64>::zeros(); self.n_vertices()];
        for j in 0..self.n_vertices() {
            for slot in self.pattern.column(j) {
                let i = self.pattern.rows()[slot] as usize;
                let block = self.blocks[slot].abs();
                sums[i] += block.column_sum();
                if i != j {
                    sums[j] += block.row_sum_tr();
                }
            }
        }
        // f64::max would pass over a NaN.
        let largest =
            |s: &Vector3<f64>| if s.iter().all(|v| v.is_finite()) { s.max() } else { f64::NAN };
        sums.iter().map(largest).collect()
    }
}

/// Sets the entries of the fixed vertices to zero: the right-hand side that goes with
/// [`BlockMatrix::eliminate`].
pub fn clear_fixed(vector: &mut [Vector3<f64>], fixed: &[bool]) {
    for (entry, &is_fixed) in vector.iter_mut().zip(fixed) {
        if is_fixed {
            *entry = Vector3::zeros();
        }
    }
}
