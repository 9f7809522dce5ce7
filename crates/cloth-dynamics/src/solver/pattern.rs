//! The sparsity pattern of a symmetric matrix of 3×3 blocks, one block row per vertex.
//!
//! Two vertices share a block when some element (triangle, hinge, handle, contact) sees both.
//! The matrix is symmetric, so only the lower triangle is kept, column by column: column `j`
//! lists the rows `i ≥ j`, sorted, the diagonal first. The place of a block in that list is its
//! *slot*; a [`BlockMatrix`](super::BlockMatrix) is one 3×3 block per slot.

/// The entry of a stencil that stands for no vertex (a hinge on the boundary, say).
pub const ABSENT: u32 = u32::MAX;

/// The most blocks a pattern may hold: 9 scalars each must be countable by a signed 32-bit index.
const MAX_BLOCKS: usize = (i32::MAX as usize) / 9;

/// Why a pattern could not be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PatternError {
    /// A stencil names a vertex that does not exist.
    #[error("stencil {stencil} names vertex {vertex}, but there are {n_vertices} vertices")]
    NoSuchVertex {
        /// Index of the stencil in the slice that was handed over.
        stencil: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many vertices there are.
        n_vertices: usize,
    },
    /// More blocks or vertices than 32-bit scalar indices can count.
    #[error("{n_blocks} blocks are more than the {limit} that a system matrix can hold")]
    TooLarge {
        /// Blocks (or pairs of vertices, before repeats are merged) that were asked for.
        n_blocks: usize,
        /// The most there may be.
        limit: usize,
    },
}

/// Collects the stencils of all element families, then builds a [`BlockPattern`].
///
/// ```
/// use cloth_dynamics::solver::PatternBuilder;
/// let mut builder = PatternBuilder::new(4);
/// builder.add(&[[0, 1, 2], [2, 1, 3]])?; // two triangles
/// let pattern = builder.build()?;
/// assert_eq!(pattern.n_blocks(), 4 + 5); // the diagonal and five edges
/// assert_eq!(pattern.slot(3, 0), None); // 0 and 3 are opposite corners: no element sees both
/// # Ok::<(), cloth_dynamics::solver::PatternError>(())
/// ```
#[derive(Clone, Debug)]
pub struct PatternBuilder {
    n_vertices: usize,
    /// Off-diagonal pairs `[row, column]`, row > column, with repeats.
    pairs: Vec<[u32; 2]>,
}

impl PatternBuilder {
    /// A pattern of the diagonal alone, over `n_vertices` vertices.
    pub fn new(n_vertices: usize) -> Self {
        Self { n_vertices, pairs: Vec::new() }
    }

    /// Makes room for a block between every two corners of every stencil. Corners that are
    /// [`ABSENT`] are passed over.
    pub fn add<const N: usize>(&mut self, stencils: &[[u32; N]]) -> Result<(), PatternError> {
        self.pairs.reserve(stencils.len() * (N * N.saturating_sub(1)) / 2);
        for (stencil, corners) in stencils.iter().enumerate() {
            for (a, &va) in corners.iter().enumerate() {
                if va == ABSENT {
                    continue;
                }
                if va as usize >= self.n_vertices {
                    let n_vertices = self.n_vertices;
                    return Err(PatternError::NoSuchVertex { stencil, vertex: va, n_vertices });
                }
                for &vb in &corners[..a] {
                    if vb != ABSENT && vb != va {
                        self.pairs.push([va.max(vb), va.min(vb)]);
                    }
                }
            }
        }
        Ok(())
    }

    /// Merges the repeats and sorts, in time proportional to the number of pairs.
    ///
    /// Two passes of bucket sort and no comparison: the pairs are dealt out by row; then the rows
    /// are walked in rising order and dealt out by column, so that each column receives its rows
    /// already sorted, and a repeat is seen as "this column has just received this row".
    pub fn build(self) -> Result<BlockPattern, PatternError> {
        let n = self.n_vertices;
        let too_large = |n_blocks| PatternError::TooLarge { n_blocks, limit: MAX_BLOCKS };
        if n > MAX_BLOCKS {
            return Err(too_large(n));
        }
        if self.pairs.len() > u32::MAX as usize {
            return Err(too_large(self.pairs.len()));
        }
        let row_start = starts(n, self.pairs.iter().map(|pair| pair[0]));
        let mut columns = vec![0u32; self.pairs.len()];
        let mut fill = row_start.clone();
        for &[row, column] in &self.pairs {
            columns[fill[row as usize] as usize] = column;
            fill[row as usize] += 1;
        }
        drop(self.pairs);

        // Which row each column received last: rows rise, so equality means a repeat.
        let mut last = vec![ABSENT; n];
        let mut kept = 0;
        for row in 0..n {
            let begin = row_start[row] as usize;
            let end = row_start[row + 1] as usize;
            let first_kept = kept;
            for k in begin..end {
                let column = columns[k];
                if last[column as usize] != row as u32 {
                    last[column as usize] = row as u32;
                    columns[kept] = column;
                    kept += 1;
                }
            }
            fill[row] = (kept - first_kept) as u32;
        }
        columns.truncate(kept);
        if n + kept > MAX_BLOCKS {
            return Err(too_large(n + kept));
        }

        let all = columns.iter().copied().chain(0..n as u32);
        let col_ptr = starts(n, all);
        let mut rows = vec![0u32; n + kept];
        let mut next = col_ptr.clone();
        let mut k = 0;
        for row in 0..n {
            // Rows rise, so every column gets its diagonal first and then ever larger rows.
            for &column in &columns[k..k + fill[row] as usize] {
                rows[next[column as usize] as usize] = row as u32;
                next[column as usize] += 1;
            }
            k += fill[row] as usize;
            rows[next[row] as usize] = row as u32;
            next[row] += 1;
        }
        Ok(BlockPattern { col_ptr, rows })
    }
}

/// Counts the keys below `n` and returns where the bucket of each one starts (n + 1 entries).
fn starts(n: usize, keys: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut start = vec![0u32; n + 1];
    for key in keys {
        start[key as usize + 1] += 1;
    }
    for i in 0..n {
        start[i + 1] += start[i];
    }
    start
}

/// Which blocks of the lower triangle exist: column `j` lists its rows `i ≥ j`, sorted, and the place
/// in that list is the block's slot. Immutable: share it by
/// [`Arc`](std::sync::Arc), and solvers keep their analysis of it for as long as it is the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockPattern {
    /// Slots of column `j`: `col_ptr[j]..col_ptr[j + 1]`.
    col_ptr: Vec<u32>,
    /// Row of each slot; sorted in each column, the diagonal first.
    rows: Vec<u32>,
}

impl BlockPattern {
    /// How many vertices (block rows).
    pub fn n_vertices(&self) -> usize {
        self.col_ptr.len() - 1
    }

    /// How many blocks are stored, the diagonal included.
    pub fn n_blocks(&self) -> usize {
        self.rows.len()
    }

    /// How many blocks the full symmetric matrix has.
    pub fn n_blocks_full(&self) -> usize {
        2 * self.rows.len() - self.n_vertices()
    }

    /// First slot of each column, and one past the last slot (n + 1 entries).
    pub fn column_starts(&self) -> &[u32] {
        &self.col_ptr
    }

    /// Row of each slot.
    pub fn rows(&self) -> &[u32] {
        &self.rows
    }

    /// Row and column of every block below the diagonal.
    pub fn pairs(&self) -> Vec<[u32; 2]> {
        let below = |j: usize| self.column(j).skip(1).map(move |slot| [self.rows[slot], j as u32]);
        (0..self.n_vertices()).flat_map(below).collect()
    }

    /// The pattern of some of the vertices (ascending) and the slot here of each of its blocks; `place`
    /// is a vertex's place among them, or [`usize::MAX`].
    pub(crate) fn restricted(&self, vertices: &[usize], place: &[usize]) -> (Self, Vec<u32>) {
        let (mut col_ptr, mut rows, mut slots) = (vec![0], Vec::new(), Vec::new());
        for &j in vertices {
            for slot in self.column(j) {
                let row = place[self.rows[slot] as usize];
                if row != usize::MAX {
                    rows.push(row as u32);
                    slots.push(slot as u32);
                }
            }
            col_ptr.push(rows.len() as u32);
        }
        (BlockPattern { col_ptr, rows }, slots)
    }

    /// The slots of column `j`.
    pub(super) fn column(&self, j: usize) -> std::ops::Range<usize> {
        self.col_ptr[j] as usize..self.col_ptr[j + 1] as usize
    }

    /// The slot of the block in row `i`, column `j` of the lower triangle (`i ≥ j`). `None` where
    /// there is no such block, or where `i < j`. Binary search in the column.
    pub fn slot(&self, i: usize, j: usize) -> Option<usize> {
        if j >= self.n_vertices() || i > u32::MAX as usize {
            return None;
        }
        let column = self.column(j);
        let k = self.rows[column.clone()].binary_search(&(i as u32)).ok()?;
        Some(column.start + k)
    }

    /// The slot of the diagonal block of vertex `i`; `i` must be below
    /// [`n_vertices`](Self::n_vertices).
    pub fn diagonal_slot(&self, i: usize) -> usize {
        self.col_ptr[i] as usize
    }
}
