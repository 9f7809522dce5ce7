//! A part of a cloth: the vertices whose forces are wanted, and those that these forces depend on.

use crate::solver::ABSENT;

/// Which vertices and elements of a mesh belong to a part.
///
/// Vertices and elements keep their order, so the sums over the elements of an answering vertex have
/// the same bits as in the whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    vertices: Vec<u32>,
    place: Vec<u32>,
    answers: Vec<bool>,
}

impl Part {
    /// The vertices that answer, one mark each, and `vertices` (ascending): these and all that share an
    /// element with them.
    pub fn new(answers: Vec<bool>, vertices: Vec<u32>) -> Part {
        let mut place = vec![ABSENT; answers.len()];
        for (k, &i) in vertices.iter().enumerate() {
            place[i as usize] = k as u32;
        }
        Part { vertices, place, answers }
    }

    /// The vertices of the part, ascending, by their numbers in the whole.
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// Number in the part of a vertex of the whole; [`ABSENT`] if it is not there.
    pub fn place(&self, i: usize) -> u32 {
        self.place[i]
    }

    /// Whether the force on a vertex of the whole is complete in the part.
    pub fn answers(&self, i: usize) -> bool {
        self.answers[i]
    }

    /// The elements of which some corner answers, with their corners as numbers in the part.
    pub fn elements<const N: usize>(&self, stencils: &[[u32; N]]) -> (Vec<u32>, Vec<[u32; N]>) {
        let here = |s: &[u32; N]| s.iter().any(|&i| i != ABSENT && self.answers[i as usize]);
        let place = |i: u32| if i == ABSENT { ABSENT } else { self.place[i as usize] };
        let chosen = stencils.iter().enumerate().filter(|(_, s)| here(s));
        chosen.map(|(e, s)| (e as u32, s.map(place))).unzip()
    }

    /// What the vertices of the part have of values of the whole.
    pub fn gather<T: Copy>(&self, whole: &[T]) -> Vec<T> {
        self.vertices.iter().map(|&i| whole[i as usize]).collect()
    }
}
