//! Which vertices are near which, by edges of the system matrix.

use crate::solver::BlockPattern;

/// The vertices next to every vertex.
#[derive(Debug)]
pub(super) struct Neighbours {
    starts: Vec<u32>,
    list: Vec<u32>,
}

impl Neighbours {
    pub(super) fn new(pattern: &BlockPattern) -> Neighbours {
        let n = pattern.n_vertices();
        let pairs = pattern.pairs();
        let mut starts = vec![0u32; n + 1];
        for i in pairs.iter().flatten() {
            starts[*i as usize + 1] += 1;
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut list = vec![0; 2 * pairs.len()];
        for &[i, j] in &pairs {
            for (of, other) in [(i, j), (j, i)] {
                list[next[of as usize] as usize] = other;
                next[of as usize] += 1;
            }
        }
        Neighbours { starts, list }
    }

    /// These vertices and all that are at most so many edges away, ascending.
    pub(super) fn around(&self, of: impl IntoIterator<Item = u32>, rings: usize) -> Vec<u32> {
        let mut seen = vec![false; self.starts.len() - 1];
        let mut found: Vec<u32> = Vec::new();
        for i in of {
            if !std::mem::replace(&mut seen[i as usize], true) {
                found.push(i);
            }
        }
        let mut first = 0;
        for _ in 0..rings {
            let last = found.len();
            for k in first..last {
                let i = found[k] as usize;
                for &j in &self.list[self.starts[i] as usize..self.starts[i + 1] as usize] {
                    if !std::mem::replace(&mut seen[j as usize], true) {
                        found.push(j);
                    }
                }
            }
            first = last;
        }
        found.sort_unstable();
        found
    }
}
