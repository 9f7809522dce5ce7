//! Which vertices are near which, by edges of the system matrix.

use crate::solver::BlockPattern;

/// The vertices next to every vertex.
#[derive(Debug)]
pub(crate) struct Neighbours {
    starts: Vec<u32>,
    list: Vec<u32>,
    /// By vertex, the number of the piece of cloth that it belongs to.
    pieces: Vec<usize>,
}

impl Neighbours {
    pub(crate) fn new(pattern: &BlockPattern) -> Neighbours {
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
        let mut pieces = vec![usize::MAX; n];
        let (mut n_pieces, mut found) = (0, Vec::new());
        for start in 0..n {
            if pieces[start] == usize::MAX {
                pieces[start] = n_pieces;
                found.push(start);
                while let Some(i) = found.pop() {
                    for &j in &list[starts[i] as usize..starts[i + 1] as usize] {
                        if pieces[j as usize] == usize::MAX {
                            pieces[j as usize] = n_pieces;
                            found.push(j as usize);
                        }
                    }
                }
                n_pieces += 1;
            }
        }
        Neighbours { starts, list, pieces }
    }

    /// The vertices next to one.
    pub(crate) fn of(&self, i: usize) -> &[u32] {
        &self.list[self.starts[i] as usize..self.starts[i + 1] as usize]
    }

    /// By vertex, the number of the piece of cloth that it belongs to.
    pub(crate) fn pieces(&self) -> &[usize] {
        &self.pieces
    }

    /// These vertices and all that are at most so many edges away, ascending.
    pub(crate) fn around(&self, of: impl IntoIterator<Item = u32>, rings: usize) -> Vec<u32> {
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
                for &j in self.of(i) {
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
