//! Turning the edge between two triangles to their other diagonal.

use crate::edit::{Edit, Refusal};
use crate::geometry::is_sound;
use crate::ids::HalfEdge;
use crate::mesh::Mesh;

impl Mesh {
    /// Checks whether an edge can be flipped.
    pub fn can_flip(&self, h: HalfEdge) -> Result<(), Refusal> {
        let g = self.twin(h).ok_or(Refusal::Boundary)?;
        if self.is_feature(h) {
            return Err(Refusal::Feature);
        }
        let (c, d) = (self.opposite(h), self.opposite(g));
        if c == d || self.adjacent(c, d) {
            return Err(Refusal::Topology);
        }
        let [u_a, u_b] = [h, h.next()].map(|e| self.corner_material(e));
        let [u_c, u_d] = [h.prev(), g.prev()].map(|e| self.corner_material(e));
        if !is_sound(u_d, u_b, u_c) || !is_sound(u_c, u_a, u_d) {
            return Err(Refusal::Inverted);
        }
        Ok(())
    }

    /// Flips an edge: triangles (a, b, c), (b, a, d) become (d, b, c), (c, a, d).
    ///
    /// # Errors
    /// See [`Mesh::can_flip`]; the mesh is then unchanged.
    pub fn flip(&mut self, h: HalfEdge) -> Result<Edit, Refusal> {
        self.can_flip(h)?;
        let g = self.twin(h).ok_or(Refusal::Boundary)?;
        let (t, s) = (h.triangle(), g.triangle());
        let [a, b, c] = [h, h.next(), h.prev()].map(|e| self.origin(e).0);
        let d = self.opposite(g).0;
        let [u_a, u_b, u_c] = [h, h.next(), h.prev()].map(|e| self.corner_material(e));
        let u_d = self.corner_material(g.prev());
        let [bc, ca, ad, db] = [h.next(), h.prev(), g.next(), g.prev()];
        let outer = [bc, ca, ad, db].map(|e| self.twin[e.index()]);
        let anchors = [a, b, c, d].map(|v| self.out[v as usize]);

        self.tri[t.index()] = [d, b, c];
        self.material[t.index()] = [u_d, u_b, u_c];
        self.tri[s.index()] = [c, a, d];
        self.material[s.index()] = [u_c, u_a, u_d];
        let new_bc = t.half_edge(1);
        let new_ca = s.half_edge(0);
        let new_ad = s.half_edge(1);
        let new_db = t.half_edge(0);
        for (new, twin) in [new_bc, new_ca, new_ad, new_db].into_iter().zip(outer) {
            self.join(new.0, twin);
        }
        self.join(t.half_edge(2).0, s.half_edge(2).0);

        // Outer edges moved to other slots; the flipped edge itself only ever anchored an inner
        // vertex, for which any outgoing half-edge will do.
        let moved = |old: u32, fallback: HalfEdge| {
            let map = [(bc, new_bc), (ca, new_ca), (ad, new_ad), (db, new_db)];
            if old == h.0 || old == g.0 {
                return fallback.0;
            }
            map.iter().find(|(from, _)| from.0 == old).map_or(old, |(_, to)| to.0)
        };
        for (v, old, fallback) in [
            (a, anchors[0], new_ad),
            (b, anchors[1], new_bc),
            (c, anchors[2], new_ca),
            (d, anchors[3], new_db),
        ] {
            self.out[v as usize] = moved(old, fallback);
        }
        self.epoch += 1;
        Ok(Edit::Flip { triangles: [t, s] })
    }
}
