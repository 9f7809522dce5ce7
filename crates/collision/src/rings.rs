//! What lies around each vertex, in order.

/// A vertex with more triangles than this has no ring.
pub(crate) const MOST: usize = 8;

/// The ring of every vertex: the other corners of its triangles, one after the other, so that each
/// triangle has two neighbours of the ring. It begins and ends at the boundary, or with the same vertex.
/// It is empty if the triangles around the vertex do not follow upon each other like this.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Rings {
    /// Where the ring of each vertex begins in `around`, and where the last one ends.
    starts: Vec<u32>,
    around: Vec<u32>,
    /// The triangle after each vertex of a ring; for the last one, that before it.
    triangles: Vec<u32>,
}

impl Rings {
    pub(crate) fn new(n_vertices: usize, triangles: &[[u32; 3]]) -> Rings {
        let mut ends = vec![0usize; n_vertices + 1];
        triangles.iter().flatten().for_each(|&v| ends[v as usize + 1] += 1);
        for v in 0..n_vertices {
            ends[v + 1] += ends[v];
        }
        let mut sides = vec![[0; 3]; 3 * triangles.len()];
        let mut at = ends.clone();
        for (t, corners) in (0..).zip(triangles) {
            for k in 0..3 {
                let slot = &mut at[corners[k] as usize];
                sides[*slot] = [corners[(k + 1) % 3], corners[(k + 2) % 3], t];
                *slot += 1;
            }
        }
        let mut rings = Rings { starts: vec![0], around: Vec::new(), triangles: Vec::new() };
        for v in 0..n_vertices {
            let own = &mut sides[ends[v]..ends[v + 1]];
            if chain(own) {
                rings.around.push(own[0][0]);
                rings.around.extend(own.iter().map(|side| side[1]));
                rings.triangles.extend(own.iter().map(|side| side[2]));
                rings.triangles.push(own[own.len() - 1][2]);
            }
            rings.starts.push(rings.around.len() as u32);
        }
        rings
    }

    /// Adds rings of vertices that follow these.
    pub(crate) fn extend(&mut self, other: &Rings, n_triangles: u32) {
        let (v, start) = (self.starts.len() as u32 - 1, self.around.len() as u32);
        self.starts.extend(other.starts[1..].iter().map(|s| s + start));
        self.around.extend(other.around.iter().map(|x| x + v));
        self.triangles.extend(other.triangles.iter().map(|x| x + n_triangles));
    }

    /// The ring of a vertex.
    #[inline]
    pub(crate) fn of(&self, vertex: usize) -> &[u32] {
        &self.around[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }

    /// The triangles around a vertex, in the order of its ring: triangle i is between its places i and
    /// i + 1.
    #[inline]
    pub(crate) fn triangles_of(&self, vertex: usize) -> &[u32] {
        let (start, end) = (self.starts[vertex] as usize, self.starts[vertex + 1] as usize);
        &self.triangles[start..end.max(start + 1) - 1]
    }
}

/// Orders sides such that each begins where the one before it ends, if they can all be had so.
fn chain(sides: &mut [[u32; 3]]) -> bool {
    if sides.is_empty() || sides.len() > MOST {
        return false;
    }
    let is_first = |a: &[u32; 3]| sides.iter().all(|b| b[1] != a[0]);
    let first = sides.iter().position(is_first);
    sides.swap(0, first.unwrap_or(0));
    for i in 1..sides.len() {
        let end = sides[i - 1][1];
        let Some(next) = sides[i..].iter().position(|side| side[0] == end) else {
            return false;
        };
        sides.swap(i, i + next);
    }
    first.is_some() || sides[sides.len() - 1][1] == sides[0][0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_are_closed_inside_and_open_at_the_boundary() {
        let rings = Rings::new(5, &[[2, 0, 4], [0, 1, 4], [1, 3, 4], [3, 2, 4]]);
        assert_eq!(rings.of(4), [2, 0, 1, 3, 2]);
        assert_eq!(rings.triangles_of(4), [0, 1, 2, 3]);
        assert_eq!((rings.of(0), rings.triangles_of(0)), (&[1, 4, 2][..], &[1, 0][..]));
    }

    #[test]
    fn what_does_not_follow_upon_each_other_has_no_ring() {
        // Three triangles at an edge, two that turn against each other, and two that share a corner.
        for list in [&[[0, 1, 2], [1, 0, 3], [0, 1, 4]][..], &[[0, 1, 2], [0, 1, 3]]] {
            let rings = Rings::new(5, list);
            assert!(rings.of(0).is_empty() && rings.of(1).is_empty() && !rings.of(2).is_empty());
        }
        assert!(Rings::new(5, &[[0, 1, 2], [0, 3, 4]]).of(0).is_empty());
        assert!(Rings::new(1, &[]).of(0).is_empty());
    }
}
