//! From element matrices to the system matrix: where each block of each element goes.

use nalgebra::Matrix3;

use super::matrix::BlockMatrix;
use super::pattern::{ABSENT, BlockPattern};

/// Bit of an entry of [`StencilSlots`]: the pair's block goes in transposed.
const TRANSPOSED: u32 = 1 << 31;
/// Bit of an entry of [`StencilSlots`]: two corners of the stencil are the same vertex.
const SAME_VERTEX: u32 = 1 << 30;
const SLOT: u32 = SAME_VERTEX - 1;

/// Where the blocks of each element of one family go: looked up once per pattern, so that assembly
/// does no searching.
///
/// ```
/// use cloth_dynamics::solver::{BlockMatrix, PatternBuilder, StencilSlots};
/// use nalgebra::Matrix3;
/// let springs = [[0, 1], [2, 1]];
/// let mut builder = PatternBuilder::new(3);
/// builder.add(&springs)?;
/// let mut matrix = BlockMatrix::new(builder.build()?.into());
/// let slots = StencilSlots::new(matrix.pattern(), &springs).expect("the pattern was made of these");
/// let k = Matrix3::identity() * 5.0;
/// for spring in 0..2 {
///     slots.scatter(spring, &[[k, -k], [-k, k]], &mut matrix);
/// }
/// assert_eq!(matrix.diagonal(1), &(k * 2.0));
/// # Ok::<(), cloth_dynamics::solver::PatternError>(())
/// ```
#[derive(Clone, Debug)]
pub struct StencilSlots<const N: usize> {
    /// Per stencil N (N + 1) / 2 entries: the pairs (a, b), a ≥ b, row by row.
    entries: Vec<u32>,
}

impl<const N: usize> StencilSlots<N> {
    const PAIRS: usize = N * (N + 1) / 2;

    /// Looks up the slot of every pair of corners. `None` if the pattern lacks one of them.
    pub fn new(pattern: &BlockPattern, stencils: &[[u32; N]]) -> Option<Self> {
        Self::look_up(pattern, stencils, |slot| slot)
    }

    /// Looks up the slots of the pairs that the pattern has. Blocks of the others are passed over by
    /// [`StencilSlots::scatter`].
    pub fn within(pattern: &BlockPattern, stencils: &[[u32; N]]) -> Self {
        Self::look_up(pattern, stencils, |slot| Some(slot.unwrap_or(ABSENT)))
            .expect("a pair without a slot counts as absent")
    }

    /// `settle` decides what becomes of a pair that may have no slot.
    fn look_up(
        pattern: &BlockPattern,
        stencils: &[[u32; N]],
        settle: impl Fn(Option<u32>) -> Option<u32>,
    ) -> Option<Self> {
        let mut entries = Vec::with_capacity(stencils.len() * Self::PAIRS);
        for corners in stencils {
            for (a, &va) in corners.iter().enumerate() {
                for (b, &vb) in corners[..=a].iter().enumerate() {
                    let entry = if va == ABSENT || vb == ABSENT {
                        Some(ABSENT)
                    } else {
                        let slot = pattern.slot(va.max(vb) as usize, va.min(vb) as usize);
                        let transposed = if va < vb { TRANSPOSED } else { 0 };
                        let same = if a != b && va == vb { SAME_VERTEX } else { 0 };
                        settle(slot.map(|slot| slot as u32 | transposed | same))
                    };
                    entries.push(entry?);
                }
            }
        }
        Some(Self { entries })
    }

    /// How many stencils.
    pub fn len(&self) -> usize {
        if N == 0 { 0 } else { self.entries.len() / Self::PAIRS }
    }

    /// Whether there is no stencil.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Adds the symmetric element matrix of stencil `stencil`: `blocks[a][b]` belongs to the corners
    /// `a`, `b`, and `blocks[b][a]` must be its transpose (only `a ≥ b` is read). Blocks of absent
    /// corners are passed over.
    ///
    /// The matrix must have the pattern in which the slots were looked up.
    ///
    /// # Panics
    /// If there is no stencil of that index.
    pub fn scatter(&self, stencil: usize, blocks: &[[Matrix3<f64>; N]; N], to: &mut BlockMatrix) {
        let entries = &self.entries[stencil * Self::PAIRS..][..Self::PAIRS];
        let mut k = 0;
        for a in 0..N {
            for b in 0..=a {
                let entry = entries[k];
                k += 1;
                if entry == ABSENT {
                    continue;
                }
                let block = &blocks[a][b];
                let target = &mut to.blocks_mut()[(entry & SLOT) as usize];
                if entry & SAME_VERTEX != 0 {
                    // Both A_ab and A_ba land on the diagonal block of that vertex.
                    *target += block + block.transpose();
                } else if entry & TRANSPOSED != 0 {
                    *target += block.transpose();
                } else {
                    *target += block;
                }
            }
        }
    }
}
