//! The only place that starts threads: maps over slices whose results do not depend on the number
//! of threads, because every output is written by exactly one pure call.
//!
//! With one thread in the pool (or little work) the loops run in the caller, at no extra cost.

use rayon::prelude::*;

/// Below this many items a parallel loop costs more than it saves.
const SERIAL_BELOW: usize = 256;

/// True if a loop of `n` items should be spread over threads.
fn worth_it(n: usize) -> bool {
    n >= SERIAL_BELOW && rayon::current_num_threads() > 1
}

/// Sets every `out[i] = f(i)`.
pub fn fill<T: Send>(out: &mut [T], f: impl Fn(usize) -> T + Sync) {
    if worth_it(out.len()) {
        out.par_iter_mut().with_min_len(64).enumerate().for_each(|(i, slot)| *slot = f(i));
    } else {
        for (i, slot) in out.iter_mut().enumerate() {
            *slot = f(i);
        }
    }
}

/// Calls `f(i, &mut out[i])` for every item.
pub fn for_each<T: Send>(out: &mut [T], f: impl Fn(usize, &mut T) + Sync) {
    if worth_it(out.len()) {
        out.par_iter_mut().with_min_len(64).enumerate().for_each(|(i, slot)| f(i, slot));
    } else {
        for (i, slot) in out.iter_mut().enumerate() {
            f(i, slot);
        }
    }
}

/// Calls `f(b, &mut blocks[b], part)` for every block, where `part` is the block's own `size` items of
/// `out` (fewer for the last one). For blocks that are each worth a task of their own.
///
/// # Panics
/// If there are not as many blocks as parts.
pub fn blocks<B: Send, T: Send>(
    blocks: &mut [B],
    out: &mut [T],
    size: usize,
    f: impl Fn(usize, &mut B, &mut [T]) + Sync,
) {
    assert_eq!(blocks.len(), out.len().div_ceil(size), "one block per {size} items");
    if blocks.len() > 1 && rayon::current_num_threads() > 1 {
        let parts = blocks.par_iter_mut().zip(out.par_chunks_mut(size));
        parts.enumerate().for_each(|(b, (block, part))| f(b, block, part));
    } else {
        for (b, (block, part)) in blocks.iter_mut().zip(out.chunks_mut(size)).enumerate() {
            f(b, block, part);
        }
    }
}

/// The lists that `f(i, &mut list)` adds to, one after the other in the order of `0..n`: the same
/// list at any number of threads.
pub fn collect<T: Send>(n: usize, f: impl Fn(usize, &mut Vec<T>) + Sync) -> Vec<T> {
    const BLOCK: usize = 64;
    let block = |b: usize, list: &mut Vec<T>| {
        (b * BLOCK..((b + 1) * BLOCK).min(n)).for_each(|i| f(i, list));
    };
    let mut all = Vec::new();
    if worth_it(n) {
        let mut lists: Vec<Vec<T>> = Vec::new();
        lists.resize_with(n.div_ceil(BLOCK), Vec::new);
        lists.par_iter_mut().enumerate().for_each(|(b, list)| block(b, list));
        all.reserve_exact(lists.iter().map(Vec::len).sum());
        lists.iter_mut().for_each(|list| all.append(list));
    } else {
        (0..n.div_ceil(BLOCK)).for_each(|b| block(b, &mut all));
    }
    all
}

/// Sum of `f(i)` over `0..n`, in blocks of fixed size added in order: the same bits at any number
/// of threads.
pub fn sum(n: usize, f: impl Fn(usize) -> f64 + Sync) -> f64 {
    const BLOCK: usize = 1024;
    let block = |b: usize| (b * BLOCK..((b + 1) * BLOCK).min(n)).map(&f).sum::<f64>();
    let mut partial = vec![0.0; n.div_ceil(BLOCK)];
    if worth_it(n) {
        partial.par_iter_mut().enumerate().for_each(|(b, slot)| *slot = block(b));
    } else {
        for (b, slot) in partial.iter_mut().enumerate() {
            *slot = block(b);
        }
    }
    partial.iter().sum()
}

/// Number of threads that the maps use.
pub fn n_threads() -> usize {
    rayon::current_num_threads()
}

/// Runs `work` with exactly `n` threads (0: one per core).
///
/// # Errors
/// If the operating system refuses the threads.
pub fn with_threads<R: Send>(
    n: usize,
    work: impl FnOnce() -> R + Send,
) -> Result<R, rayon::ThreadPoolBuildError> {
    Ok(rayon::ThreadPoolBuilder::new().num_threads(n).build()?.install(work))
}
