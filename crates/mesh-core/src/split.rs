//! Splitting an edge at its material midpoint.

use crate::edit::{Edit, Refusal};
use crate::geometry::is_sound;
use crate::ids::{HalfEdge, NONE, VertexId};
use crate::mesh::Mesh;

impl Mesh {
    /// Splits an edge at its middle; on a seam each side gets the middle of its own material edge.
    ///
    /// # Errors
    /// If a half would be too thin to keep a clear orientation; the mesh is then unchanged.
    pub fn split(&mut self, h: HalfEdge) -> Result<Edit, Refusal> {
        for side in [Some(h), self.twin(h)].into_iter().flatten() {
            let [u_a, u_b, u_c] = [side, side.next(), side.prev()].map(|e| self.corner_material(e));
            let middle = (u_a + u_b) * 0.5;
            if !is_sound(u_a, middle, u_c) || !is_sound(middle, u_b, u_c) {
                return Err(Refusal::Inverted);
            }
        }
        let (a, b) = (self.origin(h), self.dest(h));
        let g = self.twin(h);
        let new = VertexId(self.n_vertices() as u32);

        let upper = self.cut_triangle(h, new);
        self.out.push(upper.0);
        let lower = g.map(|g| (g, self.cut_triangle(g, new)));
        match lower {
            None => {
                self.twin[h.index()] = NONE;
                self.twin[upper.index()] = NONE;
            }
            Some((g, lower)) => {
                self.join(h.0, lower.0);
                self.join(g.0, upper.0);
            }
        }
        self.uid.push(self.next_uid);
        self.next_uid += 1;
        self.epoch += 1;
        Ok(Edit::Split { a, b, new, parents: [Some(h.triangle()), g.map(HalfEdge::triangle)] })
    }

    /// Turns the triangle (a, b, c) of half-edge a→b into (a, n, c) and pushes (n, b, c).
    /// Returns the half-edge n→b of the new triangle.
    fn cut_triangle(&mut self, h: HalfEdge, new: VertexId) -> HalfEdge {
        let t = h.triangle().index();
        let (kb, kc) = (h.next().corner(), h.prev().corner());
        let (b, c) = (self.tri[t][kb], self.tri[t][kc]);
        let (u_b, u_c) = (self.material[t][kb], self.material[t][kc]);
        let middle = (self.corner_material(h) + u_b) * 0.5;
        let bc = h.next();
        let outer = self.twin[bc.index()];

        let first = HalfEdge(3 * self.tri.len() as u32);
        self.tri.push([new.0, b, c]);
        self.material.push([middle, u_b, u_c]);
        self.panel.push(self.panel[t]);
        self.twin.extend([NONE; 3]);
        self.tri[t][kb] = new.0;
        self.material[t][kb] = middle;

        self.join(first.next().0, outer);
        self.join(first.prev().0, bc.0);
        if self.out[b as usize] == bc.0 {
            self.out[b as usize] = first.next().0;
        }
        first
    }
}
