//! Whether anything has passed through anything.

use super::{ContactSettings, Obstacles};
use collision::{Surface, intersect};
use mesh_core::{ClothState, World3};

/// Edges that pass through triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossings {
    /// How many.
    pub n: usize,
    /// Where the first of them is: the middle of its edge (m).
    pub place: World3,
    /// Whether the first is with an obstacle.
    pub with_obstacle: bool,
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
        let middle = |surface: &Surface, x: &[World3], edge: u32| {
            let [a, b] = surface.ends(x, edge);
            (a + b) * 0.5
        };
        let mut found = Vec::new();
        if settings.self_contact {
            let own = intersect::within(&surface, x, &tree);
            found.extend(own.iter().map(|c| (middle(&surface, x, c.edge), false)));
        }
        if let Some(obstacles) = obstacles {
            let y = (obstacles.motion)(time);
            let body = (&obstacles.surface, y.as_slice(), &obstacles.surface.tree(&y));
            let cloth = (&surface, x.as_slice(), &tree);
            let into = intersect::between(cloth, body);
            found.extend(into.iter().map(|c| (middle(&surface, x, c.edge), true)));
            let out_of = intersect::between(body, cloth);
            found.extend(out_of.iter().map(|c| (middle(&obstacles.surface, &y, c.edge), true)));
        }
        let &(place, with_obstacle) = found.first()?;
        Some(Crossings { n: found.len(), place, with_obstacle })
    }
}
