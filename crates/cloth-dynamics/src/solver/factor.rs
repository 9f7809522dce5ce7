//! The numbers of a sparse Cholesky factor `P A Pᵀ = L Lᵀ`, and solving with them.
//!
//! The factor may be held in single precision: computing it and solving with it then cost half. Such
//! a factor is no solution method by itself, but conjugate gradients with it as the preconditioner
//! gain several digits per iteration, up to full double precision, while the condition of the matrix
//! (after scaling its diagonal to one) stays well below 1e7.

use faer::Par;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError;
use faer::sparse::linalg::cholesky::supernodal;
use faer::sparse::{FaerError, SparseColMatRef};
use faer::traits::RealField;
use faer::{Conj, MatMut};
use nalgebra::Vector3;

use super::analysis::Analysis;
use super::conjugate_gradient::Preconditioner;
use super::matrix::BlockMatrix;
use super::sums::dot;

/// A number that a factor may be made of: `f32` or `f64`.
pub(super) trait Real: RealField + Copy {
    /// Rounds to this type.
    fn from_f64(value: f64) -> Self;
    /// Exact.
    fn to_f64(self) -> f64;
    /// A share of a diagonal entry that is lost in its rounding.
    const TRACE: f64;
    /// The square of anything smaller is no normal number.
    const SMALL: f64;
}

impl Real for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }
    fn to_f64(self) -> f64 {
        self
    }
    const TRACE: f64 = 1e-20;
    const SMALL: f64 = 1.5e-154;
}

impl Real for f32 {
    fn from_f64(value: f64) -> Self {
        value as f32
    }
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    const TRACE: f64 = 1e-10;
    const SMALL: f64 = 1.1e-19;
}

/// The pivot that was not positive: the matrix is not positive definite (in this precision).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct BadPivot {
    /// The vertex it belongs to.
    pub(super) vertex: usize,
}

/// A factor, with the analysis that it rests on and all the memory that a new one needs.
pub(super) struct Factor<T> {
    analysis: Analysis,
    /// The permuted matrix, divided by `scale`.
    matrix: Vec<T>,
    /// A power of two near the largest entry, so that the range of `f32` is no limit.
    scale: f64,
    /// The factor, supernode by supernode.
    values: Vec<T>,
    memory: MemBuffer,
    /// The permuted vector of a solve.
    y: Vec<T>,
}

impl<T: Real> Factor<T> {
    /// Makes room for factors of matrices of the analysed pattern; there are no numbers yet.
    pub(super) fn new(analysis: Analysis) -> Result<Self, FaerError> {
        let mut factor = Self {
            memory: scratch::<T>(&analysis)?,
            matrix: Vec::new(),
            values: Vec::new(),
            y: Vec::new(),
            scale: 1.0,
            analysis,
        };
        factor.make_room()?;
        Ok(factor)
    }

    /// Turns to another pattern and forgets the numbers. The memory is kept where it suffices: to be
    /// given fresh pages by the system costs as much as the analysis.
    pub(super) fn turn_to(&mut self, analysis: Analysis) -> Result<(), FaerError> {
        self.memory = scratch::<T>(&analysis)?;
        self.analysis = analysis;
        self.make_room()
    }

    fn make_room(&mut self) -> Result<(), FaerError> {
        resize(&mut self.matrix, self.analysis.scalar.row_idx().len())?;
        resize(&mut self.values, self.analysis.factor_len())?;
        resize(&mut self.y, self.analysis.symbolic.nrows())
    }

    pub(super) fn analysis(&self) -> &Analysis {
        &self.analysis
    }

    /// Gives the analysis back, to make a factor of another kind from.
    pub(super) fn into_analysis(self) -> Analysis {
        self.analysis
    }

    /// Factors `matrix` in place of the last one.
    pub(super) fn factorize(&mut self, matrix: &BlockMatrix) -> Result<(), BadPivot> {
        let diagonals = (0..matrix.n_vertices()).map(|i| matrix.diagonal(i).diagonal().amax());
        self.scale = power_of_two(diagonals.fold(0.0, f64::max));
        let inverse = 1.0 / self.scale;
        self.analysis.permute(matrix.blocks(), |v| T::from_f64(v * inverse), &mut self.matrix);
        self.couple();
        let result = supernodal::factorize_supernodal_numeric_llt(
            &mut self.values,
            SparseColMatRef::new(self.analysis.scalar.as_ref(), &self.matrix),
            Default::default(),
            &self.analysis.symbolic,
            Par::Seq,
            MemStack::new(&mut self.memory),
            Default::default(),
        );
        match result {
            Ok(_) => Ok(()),
            Err(LltError::NonPositivePivot { index }) => {
                Err(BadPivot { vertex: self.analysis.order[index / 3] as usize })
            }
        }
    }

    /// Whether many of its numbers are so small that their products are subnormal, with which
    /// processors reckon up to a hundred times more slowly.
    pub(super) fn is_slow(&self) -> bool {
        const EVERY: usize = 61;
        const SHARE: usize = 50;
        let is_small = |v: &&T| (f64::MIN_POSITIVE..T::SMALL).contains(&v.to_f64().abs());
        let seen = self.values.iter().step_by(EVERY);
        SHARE * seen.clone().filter(is_small).count() > seen.len()
    }

    /// Couples the three coordinates of every vertex by a trace of its diagonal entries, less than
    /// their rounding.
    ///
    /// A flat sheet across an axis hardly resists motion along it. That coordinate is then coupled to
    /// no other, and its part of the factor shrinks by orders of magnitude with every vertex on the
    /// way, down to subnormal numbers: factorisations took up to ten times as long. By way of the stiff
    /// coordinates no entry gets smaller than about the square of a trace, which double precision can
    /// do with; where single precision cannot, [`Factor::is_slow`] tells.
    fn couple(&mut self) {
        for columns in self.analysis.diagonal_columns() {
            for (r, c) in [(1, 0), (2, 0), (2, 1)] {
                let diagonal = |k: usize| self.matrix[columns[k] + k].to_f64();
                let trace = T::TRACE * diagonal(r).min(diagonal(c));
                for at in [columns[c] + r, columns[r] + c] {
                    self.matrix[at] = T::from_f64(self.matrix[at].to_f64() + trace);
                }
            }
        }
    }

    /// Solves `L Lᵀ x = b` (both in the order of the vertices).
    pub(super) fn solve(&mut self, b: &[Vector3<f64>], x: &mut [Vector3<f64>]) {
        let scale_b = power_of_two(b.iter().fold(0.0, |largest, b_i| b_i.amax().max(largest)));
        let inverse = 1.0 / scale_b;
        for (y, &vertex) in self.y.chunks_exact_mut(3).zip(&self.analysis.order) {
            for (y, b) in y.iter_mut().zip(&b[vertex as usize]) {
                *y = T::from_f64(b * inverse);
            }
        }
        let n = self.y.len();
        supernodal::SupernodalLltRef::new(&self.analysis.symbolic, &self.values)
            .solve_in_place_with_conj(
                Conj::No,
                MatMut::from_column_major_slice_mut(&mut self.y, n, 1),
                Par::Seq,
                MemStack::new(&mut self.memory),
            );
        let scale_x = scale_b / self.scale;
        for (y, &vertex) in self.y.chunks_exact(3).zip(&self.analysis.order) {
            for (x, y) in x[vertex as usize].iter_mut().zip(y) {
                *x = y.to_f64() * scale_x;
            }
        }
    }
}

impl<T: Real> Preconditioner for Factor<T> {
    fn apply(&mut self, r: &[Vector3<f64>], z: &mut [Vector3<f64>]) -> f64 {
        self.solve(r, z);
        dot(r, z)
    }
}

/// Working memory of factorisations and solves.
fn scratch<T: Real>(analysis: &Analysis) -> Result<MemBuffer, FaerError> {
    let factorize = supernodal::factorize_supernodal_numeric_llt_scratch::<u32, T>(
        &analysis.symbolic,
        Par::Seq,
        Default::default(),
    );
    let solve = analysis.symbolic.solve_in_place_scratch::<T>(1, Par::Seq);
    MemBuffer::try_new(factorize.or(solve)).map_err(|_| FaerError::OutOfMemory)
}

/// Gives `values` this length, whatever they are, or an error where there is no memory for it.
fn resize<T: Real>(values: &mut Vec<T>, len: usize) -> Result<(), FaerError> {
    if values.capacity() < len {
        *values = Vec::new();
        // Meshes often grow: an eighth more spares the next allocations.
        values.try_reserve_exact(len + len / 8).map_err(|_| FaerError::OutOfMemory)?;
    }
    values.resize(len, T::from_f64(0.0));
    Ok(())
}

/// The power of two just below a positive normal number; one for anything else. Multiplying by it
/// or its inverse rounds nothing.
fn power_of_two(value: f64) -> f64 {
    if value.is_normal() && value > 0.0 && value < f64::MAX.sqrt() && value > 1.0 / f64::MAX.sqrt()
    {
        f64::from_bits(value.to_bits() & f64::INFINITY.to_bits())
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::super::{BlockMatrix, PatternBuilder};
    use super::*;
    use nalgebra::Matrix3;
    use std::sync::Arc;

    /// Vertices in a square, coupled firmly in a plane and by next to nothing across it.
    fn flat_sheet(n: usize) -> BlockMatrix {
        let at = |i: usize, j: usize| (j * n + i) as u32;
        let mut builder = PatternBuilder::new(n * n);
        let mut pairs = Vec::new();
        for j in 0..n {
            for i in 0..n {
                pairs.extend((i + 1 < n).then(|| [at(i, j), at(i + 1, j)]));
                pairs.extend((j + 1 < n).then(|| [at(i, j), at(i, j + 1)]));
            }
        }
        builder.add(&pairs).unwrap();
        let mut matrix = BlockMatrix::new(Arc::new(builder.build().unwrap()));
        for i in 0..n * n {
            *matrix.diagonal_mut(i) = Matrix3::from_diagonal(&Vector3::new(4.1, 4.1, 1e-4));
        }
        for [a, b] in pairs {
            let slot = matrix.pattern().slot(a.max(b) as usize, a.min(b) as usize).unwrap();
            matrix.add(slot, &Matrix3::from_diagonal(&Vector3::new(-1.0, -1.0, -1e-11)));
        }
        matrix
    }

    fn factor<T: Real>(matrix: &BlockMatrix) -> Factor<T> {
        let analysis = Analysis::new(Arc::clone(matrix.pattern())).unwrap();
        let mut factor = Factor::<T>::new(analysis).unwrap();
        factor.factorize(matrix).unwrap();
        factor
    }

    #[test]
    fn double_factors_of_flat_sheets_have_normal_products() {
        let factor = factor::<f64>(&flat_sheet(60));
        let sizes = factor.values.iter().map(|v| v.abs()).filter(|v| *v > 0.0);
        assert!(sizes.fold(f64::INFINITY, f64::min) > f64::SMALL);
        assert!(!factor.is_slow());
    }

    #[test]
    fn single_factors_are_slow_for_flat_sheets_across_an_axis() {
        let mut matrix = flat_sheet(60);
        assert!(factor::<f32>(&matrix).is_slow());
        // The same sheet, tilted.
        let turn = *nalgebra::Rotation3::from_euler_angles(0.3, 0.4, 0.0).matrix();
        matrix.blocks_mut().iter_mut().for_each(|block| *block = turn * *block * turn.transpose());
        assert!(!factor::<f32>(&matrix).is_slow());
    }
}
