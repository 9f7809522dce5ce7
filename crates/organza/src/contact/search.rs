//! The search for pairs that may touch.

use super::candidates::Candidates;
use super::{SurfaceContact, pair::Sides};
use collision::{Aabb, Body, Pair, PairKind, swept};
use mesh_core::{World3, par};

/// Share of the thickness by which a vertex may be off its expected way before candidates are sought
/// anew. More would save few searches and make each much dearer.
const ROOM: f64 = 0.1;

impl SurfaceContact {
    /// Makes the candidates complete for the way of the cloth from the start `x` of the stage to `x_t1`
    /// (m), while obstacles go theirs; true if they had to be sought anew.
    pub(super) fn cover(&mut self, x: &[World3], x_t1: &[World3]) -> bool {
        let (now, then) = self.moving_way();
        let is_new = !self.candidates.are_complete([x, x_t1], [now, then]);
        if is_new {
            self.search(x, x_t1);
        }
        is_new
    }

    pub(super) fn obstacle_way(&self) -> (&[World3], &[World3]) {
        self.obstacles.as_ref().map_or((&[], &[]), |m| (&m.now, &m.then))
    }

    /// The same if any obstacle moves ever, and nothing if not: none of them is off its way then.
    pub(super) fn moving_way(&self) -> (&[World3], &[World3]) {
        let moves = self.obstacles.as_ref().is_some_and(|m| m.fixed.moves);
        if moves { self.obstacle_way() } else { (&[], &[]) }
    }

    /// Finds candidates anew, for this way and for what is near it.
    pub(super) fn search(&mut self, x: &[World3], x_t1: &[World3]) {
        let off = ROOM * self.settings.thickness;
        let radius = |v: u32| self.radius[v as usize] + off;
        let mut found: Vec<(usize, Pair, f64)> = Vec::new();
        if self.settings.self_contact {
            // What all of it has in common brings nothing nearer.
            let n = x.len().max(1) as f64;
            let drift = x.iter().zip(x_t1).map(|(from, to)| to - from).sum::<World3>() / n;
            let mut end = vec![World3::zeros(); x.len()];
            par::fill(&mut end, |i| x_t1[i] - drift);
            let mut body = Body::moving(&self.cloth, x, &end, &radius);
            if let Some([awake, _]) = self.sleep.awake() {
                body = body.awake(awake);
            }
            body.update_tree(&mut self.cloth_tree);
            let pairs = swept::near_within(body, &self.cloth_tree, |vertices, kind| {
                let n_first = if kind == PairKind::EdgeEdge { 2 } else { 1 };
                self.rest.most(vertices, n_first) + 2.0 * off
            });
            found.extend(pairs.into_iter().map(|(pair, distance)| (0, pair, distance)));
        }
        if let Some(moving) = &mut self.obstacles {
            let settings = &self.settings;
            let largest = self.radius.iter().copied().fold(0.0, f64::max);
            let room = largest + moving.largest_radius(settings) + 2.0 * off;
            let around = Aabb::around(x.iter().chain(x_t1)).grown(room);
            if around.overlaps(moving.bounds()) {
                let halves: Vec<f64> = (0..moving.now.len() as u32)
                    .map(|v| moving.radius(v, settings) + off)
                    .collect();
                let room = |v: u32| halves[v as usize];
                let mut other =
                    Body::moving(&moving.fixed.surface, &moving.now, &moving.then, &room);
                if moving.tree_way[0] != moving.now || moving.tree_way[1] != moving.then {
                    other.update_tree(&mut moving.tree);
                    moving.tree_way = [moving.now.clone(), moving.then.clone()];
                }
                let mut body = Body::moving(&self.cloth, x, x_t1, &radius);
                if let Some([cloth, bodies]) = self.sleep.awake() {
                    (body, other) = (body.awake(cloth), other.awake(bodies));
                }
                body.update_tree(&mut self.cloth_tree);
                let sides = ((body, &self.cloth_tree), (other, &moving.tree));
                let pairs = swept::near_between(sides.0, sides.1);
                found.extend(pairs.into_iter().map(|(pair, distance)| (1, pair, distance)));
            }
        }
        let mut pairs = vec![None; found.len()];
        par::fill(&mut pairs, |k| {
            let (set, pair, distance) = found[k];
            let sides = self.sides(set, pair);
            let (from, to) = (self.corners_now(&sides, x), self.corners_then(&sides, x_t1));
            let left = distance - sides.relative_motion(&from, &to);
            (left <= sides.thickness + 2.0 * off).then_some((sides, distance))
        });
        let (pairs, distances) = pairs.into_iter().flatten().unzip();
        let (now, then) = self.moving_way();
        self.candidates = Candidates::new(pairs, off, [x, x_t1], [now, then]);
        self.distances = distances;
    }

    /// Where things of a pair are: `set` is 0 within the cloth and 1 with obstacles.
    fn sides(&self, set: usize, pair: Pair) -> Sides {
        let other = match &self.obstacles {
            Some(moving) if set == 1 => &moving.fixed.surface,
            _ => &self.cloth,
        };
        let mut sides = Sides::new(pair, pair.vertices(&self.cloth, other), set == 0, 0.0);
        sides.thickness = self.thickness(&sides);
        sides
    }
}
