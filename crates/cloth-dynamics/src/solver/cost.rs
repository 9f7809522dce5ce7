//! What the methods cost, by counting: the choice between them must not depend on a clock, or two
//! runs of one scene would differ.
//!
//! The unit is a nanosecond of one core of a 2023 server (AMD EPYC, 2.6 GHz); only the ratios
//! matter. The constants are fits to what `examples/solver_costs.rs` prints from 900 to 60,000
//! vertices: within a fifth for factorisations, within a factor of two for the methods whose speed
//! depends on whether the matrix fits into the cache.

use super::analysis::Analysis;
use super::pattern::BlockPattern;

/// Product with the matrix, per stored block.
const PRODUCT: f64 = 4.0;
/// The rest of a block-Jacobi iteration, per vertex.
const VECTORS: f64 = 9.0;
/// Factorisation: per operation, and per entry of the factor.
const FACTOR_FLOP: f64 = 0.02;
const FACTOR_ENTRY: f64 = 5.8;
/// Solve with the factor, per entry.
const SOLVE_ENTRY: f64 = 1.6;
/// Analysis, per stored block.
const ANALYSIS_BLOCK: f64 = 290.0;
/// Single precision costs this share of double precision.
const SINGLE: f64 = 0.55;

/// Counted size of a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FactorSize {
    /// Vertices of the matrix.
    pub n_vertices: usize,
    /// Floating-point operations of one factorisation (1).
    pub flops: f64,
    /// Scalars in the factor (1).
    pub entries: f64,
}

impl FactorSize {
    /// Of a pattern that has been analysed.
    pub(super) fn known(analysis: &Analysis) -> Self {
        Self {
            n_vertices: analysis.order.len(),
            flops: analysis.factor_flops,
            entries: analysis.factor_len() as f64,
        }
    }

    /// Of a pattern that has not: by the laws of nested dissection in the plane, `n^{3/2}` operations
    /// and `n log n` entries (George 1973). The constants come from an earlier factor where there is
    /// one, and from grids otherwise.
    pub(super) fn guess(pattern: &BlockPattern, earlier: Option<Self>) -> Self {
        let n = pattern.n_vertices().max(2) as f64;
        let blocks_per_row = pattern.n_blocks_full() as f64 / n;
        let (flops, entries) = (n.powf(1.5), n * n.log2());
        let (flop_constant, entry_constant) = match earlier {
            Some(size) if size.n_vertices > 1 => {
                let n = size.n_vertices as f64;
                (size.flops / n.powf(1.5), size.entries / (n * n.log2()))
            }
            _ => (14.0 * blocks_per_row.powi(2), 4.0 * blocks_per_row),
        };
        Self {
            n_vertices: pattern.n_vertices(),
            flops: flop_constant * flops,
            entries: entry_constant * entries,
        }
    }

    fn precision(single: bool) -> f64 {
        if single { SINGLE } else { 1.0 }
    }

    /// One factorisation.
    pub(super) fn factorize(&self, single: bool) -> f64 {
        (FACTOR_FLOP * self.flops + FACTOR_ENTRY * self.entries) * Self::precision(single)
    }

    /// One iteration of conjugate gradients with this factor.
    pub(super) fn iteration(&self, pattern: &BlockPattern, single: bool) -> f64 {
        SOLVE_ENTRY * self.entries * Self::precision(single)
            + PRODUCT * pattern.n_blocks() as f64
            + VECTORS * pattern.n_vertices() as f64
    }
}

/// Analysis of a pattern.
pub(super) fn analysis(pattern: &BlockPattern) -> f64 {
    ANALYSIS_BLOCK * pattern.n_blocks() as f64
}

/// One iteration of block-Jacobi conjugate gradients.
pub(super) fn jacobi_iteration(pattern: &BlockPattern) -> f64 {
    PRODUCT * pattern.n_blocks() as f64 + VECTORS * pattern.n_vertices() as f64
}
