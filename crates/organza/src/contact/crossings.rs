//! Whether anything has passed through anything.

use super::{ContactSettings, Obstacles};
use collision::intersect::EdgeTriangle;
use collision::{Aabb, Surface, intersect};
use mesh_core::{ClothState, World3};

/// Edges that pass through triangles.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossings {
    /// How many.
    pub n: usize,
    /// Where the first of them is: the middle of its edge (m).
    pub place: World3,
    /// Whether the first is with an obstacle.
    pub with_obstacle: bool,
    /// Balls around all of them that hold their edges and triangles: centre and radius (m).
    balls: Vec<(World3, f64)>,
}

impl Crossings {
    /// All that the settings look for, in one state of the cloth at one time (s); `None` if there is
    /// nothing.
    pub fn find(
        cloth: &ClothState,
        obstacles: Option<&Obstacles>,
        settings: &ContactSettings,
        time: f64,
    ) -> Option<Crossings> {
        let surface = Surface::new(cloth.mesh.n_vertices(), cloth.mesh.triangles()).ok()?;
        let x = &cloth.x;
        let tree = surface.tree(x);
        let ball = |(edges, x): (&Surface, &[World3]),
                    (triangles, y): (&Surface, &[World3]),
                    c: &EdgeTriangle| {
            let [a, b] = edges.ends(x, c.edge);
            let middle = (a + b) * 0.5;
            let corners = triangles.corners(y, c.triangle);
            (middle, corners.iter().chain([&a]).map(|p| (p - middle).norm()).fold(0.0, f64::max))
        };
        let mut found = Vec::new();
        let own = (&surface, x.as_slice());
        if settings.self_contact {
            let crossings = intersect::within(&surface, x, &tree);
            found.extend(crossings.iter().map(|c| (ball(own, own, c), false)));
        }
        let bodies = obstacles.map(|obstacles| (obstacles, (obstacles.motion)(time)));
        let cloth_box = tree.bounds();
        if let Some((obstacles, y)) = bodies.filter(|(_, y)| Aabb::around(y).overlaps(&cloth_box)) {
            let tree_y = obstacles.surface.tree(&y);
            let body = (&obstacles.surface, y.as_slice());
            let [cloth_side, body_side] = [(own.0, own.1, &tree), (body.0, body.1, &tree_y)];
            let into = intersect::between(cloth_side, body_side);
            found.extend(into.iter().map(|c| (ball(own, body, c), true)));
            let out_of = intersect::between(body_side, cloth_side);
            found.extend(out_of.iter().map(|c| (ball(body, own, c), true)));
        }
        let &((place, _), with_obstacle) = found.first()?;
        let balls: Vec<(World3, f64)> = found.iter().map(|(ball, _)| *ball).collect();
        Some(Crossings { n: found.len(), place, with_obstacle, balls })
    }

    /// Names of the vertices of a cloth that are near, in ascending order.
    pub fn vertices_near(&self, cloth: &ClothState) -> Vec<u64> {
        let is_near = |x: &World3| self.balls.iter().any(|(at, r)| (x - at).norm() <= 1.5 * r);
        let near = cloth.mesh.uids().iter().zip(&cloth.x).filter(|(_, x)| is_near(x));
        let mut names: Vec<u64> = near.map(|(uid, _)| *uid).collect();
        names.sort_unstable();
        names
    }
}
