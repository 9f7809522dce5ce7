//! Sums in a fixed order: chunks of a fixed length, each summed alone, then added in rising order.
//! The bits do not depend on how many threads share the chunks.

use nalgebra::Vector3;

/// Vertices per chunk.
pub(super) const CHUNK: usize = 1024;

/// The scalar product `aᵀ b`.
pub(super) fn dot(a: &[Vector3<f64>], b: &[Vector3<f64>]) -> f64 {
    let chunks = a.chunks(CHUNK).zip(b.chunks(CHUNK));
    chunks
        .map(|(a, b)| {
            // Three independent sums, so that the processor need not wait for each addition.
            let mut partial = Vector3::zeros();
            for (a_i, b_i) in a.iter().zip(b) {
                partial += a_i.component_mul(b_i);
            }
            partial.sum()
        })
        .sum()
}
