//! What a sparse Cholesky factorisation can know before it sees numbers: the order of elimination,
//! where the factor has entries, and what computing it will cost.
//!
//! Eliminating a vertex joins all its neighbours ("fill"), so the order decides the cost. A good
//! order of the *vertices* comes from the approximate minimum degree heuristic (Amestoy et al.
//! 1996): the three coordinates of a vertex have the same neighbours, so the graph of vertices, nine
//! times smaller than that of the unknowns, says all. Columns of the factor with the same structure
//! are then gathered into *supernodes*, dense panels on which the work is that of dense matrices.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::sparse::linalg::cholesky::{simplicial, supernodal};
use faer::sparse::linalg::{SymbolicSupernodalParams, amd};
use faer::sparse::{FaerError, SymbolicSparseColMat, SymbolicSparseColMatRef};
use nalgebra::Matrix3;

use super::pattern::BlockPattern;

/// Flag in [`Analysis::source`]: the block goes in transposed.
const TRANSPOSED: u32 = 1 << 31;

/// The analysis of one pattern. Scalar unknown `3 k + c` of the permuted system is coordinate `c` of
/// the vertex eliminated as `k`-th.
#[derive(Debug)]
pub(super) struct Analysis {
    pattern: Arc<BlockPattern>,
    /// The vertex eliminated as `k`-th.
    pub(super) order: Vec<u32>,
    /// The permuted lower triangle, scalar by scalar; the diagonal blocks are stored whole.
    pub(super) scalar: SymbolicSparseColMat<u32>,
    /// Slots of the permuted block columns in `source`.
    block_starts: Vec<u32>,
    /// For each permuted block: its slot in the pattern, and [`TRANSPOSED`].
    source: Vec<u32>,
    pub(super) symbolic: supernodal::SymbolicSupernodalCholesky<u32>,
    /// Floating-point operations of one factorisation.
    pub(super) factor_flops: f64,
}

impl Analysis {
    /// Orders the vertices and finds the structure of the factor.
    pub(super) fn new(pattern: Arc<BlockPattern>) -> Result<Self, FaerError> {
        let n = pattern.n_vertices();
        let (order, position) = minimum_degree(&pattern)?;
        let lower = PermutedLower::new(&pattern, &position);
        let symbolic = symbolic_factor(n, &lower)?;
        let factor_flops = flops(&symbolic);
        let scalar = lower.expand(n);
        let PermutedLower { block_starts, source, .. } = lower;
        Ok(Self { pattern, order, scalar, block_starts, source, symbolic, factor_flops })
    }

    /// Whether this is the analysis of `pattern`.
    pub(super) fn is_of(&self, pattern: &Arc<BlockPattern>) -> bool {
        Arc::ptr_eq(&self.pattern, pattern) || *self.pattern == **pattern
    }

    /// How many scalars the factor has.
    pub(super) fn factor_len(&self) -> usize {
        self.symbolic.len_val()
    }

    /// For each permuted block column: where the three scalar columns of its diagonal block begin
    /// among the permuted scalars.
    pub(super) fn diagonal_columns(&self) -> impl Iterator<Item = [usize; 3]> {
        self.block_starts.windows(2).map(|starts| {
            let (begin, n) = (9 * starts[0] as usize, 3 * (starts[1] - starts[0]) as usize);
            [begin, begin + n, begin + 2 * n]
        })
    }

    /// Writes the scalars of a matrix of this pattern in permuted order, each through `convert`.
    pub(super) fn permute<T>(
        &self,
        blocks: &[Matrix3<f64>],
        convert: impl Fn(f64) -> T,
        values: &mut [T],
    ) {
        for starts in self.block_starts.windows(2) {
            let (begin, end) = (starts[0] as usize, starts[1] as usize);
            let (c0, rest) = values[9 * begin..9 * end].split_at_mut(3 * (end - begin));
            let (c1, c2) = rest.split_at_mut(3 * (end - begin));
            let columns = c0.chunks_exact_mut(3).zip(c1.chunks_exact_mut(3));
            let columns = columns.zip(c2.chunks_exact_mut(3));
            for (&source, ((c0, c1), c2)) in self.source[begin..end].iter().zip(columns) {
                let stored = &blocks[(source & !TRANSPOSED) as usize];
                let block = if source & TRANSPOSED != 0 { stored.transpose() } else { *stored };
                for (c, column) in [c0, c1, c2].into_iter().enumerate() {
                    for (r, value) in column.iter_mut().enumerate() {
                        *value = convert(block[(r, c)]);
                    }
                }
            }
        }
    }
}

/// Elimination order of the vertices, and its inverse.
fn minimum_degree(pattern: &BlockPattern) -> Result<(Vec<u32>, Vec<u32>), FaerError> {
    let n = pattern.n_vertices();
    let (mut order, mut position) = (vec![0u32; n], vec![0u32; n]);
    let graph =
        SymbolicSparseColMatRef::new_checked(n, n, pattern.column_starts(), None, pattern.rows());
    let mut memory = MemBuffer::try_new(amd::order_scratch::<u32>(n, pattern.n_blocks()))
        .map_err(|_| FaerError::OutOfMemory)?;
    let stack = MemStack::new(&mut memory);
    amd::order(&mut order, &mut position, graph, amd::Control::default(), stack)?;
    Ok((order, position))
}

/// The blocks of the lower triangle after the permutation, by column and by row.
struct PermutedLower {
    block_starts: Vec<u32>,
    rows: Vec<u32>,
    source: Vec<u32>,
    /// By row: the columns left of the diagonal.
    row_starts: Vec<u32>,
    columns: Vec<u32>,
}

impl PermutedLower {
    fn new(pattern: &BlockPattern, position: &[u32]) -> Self {
        let n = pattern.n_vertices();
        // As in the pattern itself: dealt out by row first, then by column, rows come out sorted.
        let mut row_starts = vec![0u32; n + 1];
        let mut block_starts = vec![0u32; n + 1];
        let permuted = |j: usize, slot: usize| {
            let (row, column) = (position[pattern.rows()[slot] as usize], position[j]);
            let transposed = if row < column { TRANSPOSED } else { 0 };
            (row.max(column), row.min(column), slot as u32 | transposed)
        };
        for j in 0..n {
            for slot in pattern.column(j) {
                let (row, column, _) = permuted(j, slot);
                block_starts[column as usize + 1] += 1;
                row_starts[row as usize + 1] += u32::from(row != column);
            }
        }
        for k in 0..n {
            block_starts[k + 1] += block_starts[k];
            row_starts[k + 1] += row_starts[k];
        }
        let mut by_row = vec![(0u32, 0u32); row_starts[n] as usize];
        let mut diagonal = vec![0u32; n];
        let mut next = row_starts.clone();
        for j in 0..n {
            for slot in pattern.column(j) {
                let (row, column, source) = permuted(j, slot);
                if row == column {
                    diagonal[row as usize] = source;
                } else {
                    by_row[next[row as usize] as usize] = (column, source);
                    next[row as usize] += 1;
                }
            }
        }
        let mut rows = vec![0u32; pattern.n_blocks()];
        let mut source = vec![0u32; pattern.n_blocks()];
        next.copy_from_slice(&block_starts);
        for row in 0..n {
            let left = &by_row[row_starts[row] as usize..row_starts[row + 1] as usize];
            for &(column, from) in left.iter().chain([&(row as u32, diagonal[row])]) {
                let place = next[column as usize] as usize;
                rows[place] = row as u32;
                source[place] = from;
                next[column as usize] += 1;
            }
        }
        let columns = by_row.into_iter().map(|(column, _)| column).collect();
        Self { block_starts, rows, source, row_starts, columns }
    }

    /// Three scalar columns per block column, three scalar rows per block.
    fn expand(&self, n: usize) -> SymbolicSparseColMat<u32> {
        let mut starts = Vec::with_capacity(3 * n + 1);
        let mut rows = Vec::with_capacity(9 * self.rows.len());
        starts.push(0);
        for k in 0..n {
            let range = self.block_starts[k] as usize..self.block_starts[k + 1] as usize;
            for _ in 0..3 {
                rows.extend(self.rows[range.clone()].iter().flat_map(|&i| 3 * i..3 * i + 3));
                starts.push(rows.len() as u32);
            }
        }
        SymbolicSparseColMat::new_checked(3 * n, 3 * n, starts, None, rows)
    }

    /// The upper triangle of a scalar matrix whose factor has the same structure, with a third of
    /// the entries: of the three unknowns of an earlier vertex only the first is named, since the
    /// elimination of the first hands all its neighbours to the second, and so on.
    fn thin_upper(&self, n: usize) -> SymbolicSparseColMat<u32> {
        let mut starts = Vec::with_capacity(3 * n + 1);
        let mut rows = Vec::with_capacity(3 * (self.columns.len() + 2 * n));
        starts.push(0);
        for k in 0..n as u32 {
            let range =
                self.row_starts[k as usize] as usize..self.row_starts[k as usize + 1] as usize;
            for c in 0..3 {
                rows.extend(self.columns[range.clone()].iter().map(|&j| 3 * j));
                if c > 0 {
                    rows.push(3 * k);
                }
                rows.push(3 * k + c);
                starts.push(rows.len() as u32);
            }
        }
        SymbolicSparseColMat::new_unsorted_checked(3 * n, 3 * n, starts, None, rows)
    }
}

/// Structure of the factor, by supernodes.
fn symbolic_factor(
    n: usize,
    lower: &PermutedLower,
) -> Result<supernodal::SymbolicSupernodalCholesky<u32>, FaerError> {
    let upper = lower.thin_upper(n);
    let scratch = StackReq::any_of(&[
        simplicial::prefactorize_symbolic_cholesky_scratch::<u32>(3 * n, upper.row_idx().len()),
        supernodal::factorize_supernodal_symbolic_cholesky_scratch::<u32>(3 * n),
    ]);
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| FaerError::OutOfMemory)?;
    let stack = MemStack::new(&mut memory);
    let mut tree = vec![0i32; 3 * n];
    let mut counts = vec![0u32; 3 * n];
    let tree =
        simplicial::prefactorize_symbolic_cholesky(&mut tree, &mut counts, upper.as_ref(), stack);
    supernodal::factorize_supernodal_symbolic_cholesky(
        upper.as_ref(),
        tree,
        &counts,
        stack,
        SymbolicSupernodalParams::default(),
    )
}

/// Operations of the dense work: a column with `m` entries below the diagonal costs one root, `m`
/// divisions and `m (m + 1)` operations of the update it causes.
fn flops(symbolic: &supernodal::SymbolicSupernodalCholesky<u32>) -> f64 {
    let sizes = symbolic.supernode_begin().iter().zip(symbolic.supernode_end()).enumerate();
    let per_supernode = sizes.map(|(s, (&begin, &end))| {
        let width = (end - begin) as usize;
        let below = symbolic.supernode(s).pattern().len();
        (0..width)
            .map(|c| {
                let m = (below + width - 1 - c) as f64;
                1.0 + m + m * (m + 1.0)
            })
            .sum::<f64>()
    });
    per_supernode.sum()
}
