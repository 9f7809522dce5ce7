//! The obstacles as contact sees them.

use super::ContactSettings;
use crate::obstacle::Obstacle;
use collision::{Aabb, Bvh, Surface, SurfaceError};
use mesh_core::World3;
use std::sync::Arc;

/// Where the vertices of all obstacles are at a time (s).
pub type Motion = Arc<dyn Fn(f64) -> Vec<World3> + Send + Sync>;

/// All obstacles of a scene as one surface.
#[derive(Clone)]
pub struct Obstacles {
    /// Their triangles.
    pub surface: Surface,
    /// Where their vertices are.
    pub motion: Motion,
    /// Whether any of them moves ever.
    pub moves: bool,
    /// Friction coefficient of every triangle's obstacle on cloth, by vertex (1).
    pub friction: Vec<f64>,
    /// Thickness of every triangle's obstacle, by vertex (m); absent for that of the settings.
    pub thickness: Vec<Option<f64>>,
}

impl Obstacles {
    /// All obstacles of a scene; `None` if there are none.
    ///
    /// # Errors
    /// If there are too many triangles.
    pub fn new(obstacles: &[Obstacle]) -> Result<Option<Obstacles>, SurfaceError> {
        let mut surface: Option<Surface> = None;
        let (mut friction, mut thickness) = (Vec::new(), Vec::new());
        for obstacle in obstacles {
            let n = obstacle.n_vertices();
            let own = Surface::new(n, &obstacle.triangles)?;
            surface = Some(match surface {
                None => own,
                Some(others) => others.joined(&own),
            });
            friction.extend(std::iter::repeat_n(obstacle.friction, n));
            thickness.extend(std::iter::repeat_n(obstacle.thickness, n));
        }
        let moves = obstacles.iter().any(Obstacle::is_moving);
        // What stands still is placed once.
        let bodies: Vec<(Obstacle, Option<Vec<World3>>)> = obstacles
            .iter()
            .map(|body| (body.clone(), (!body.is_moving()).then(|| body.positions(0.0))))
            .collect();
        let motion: Motion = Arc::new(move |time| {
            let mut all = Vec::new();
            for (body, still) in &bodies {
                match still {
                    Some(still) => all.extend_from_slice(still),
                    None => all.extend(body.positions(time)),
                }
            }
            all
        });
        Ok(surface.map(|surface| Obstacles { surface, motion, moves, friction, thickness }))
    }
}

/// The obstacles on their way.
pub(super) struct Moving {
    pub(super) fixed: Obstacles,
    pub(super) tree: Bvh,
    /// The way for which the tree was made (m); empty if there is none.
    pub(super) tree_way: [Vec<World3>; 2],
    /// Where they are at the start and at the end of the stage (m).
    pub(super) now: Vec<World3>,
    pub(super) then: Vec<World3>,
    /// The times of these (s).
    times: [f64; 2],
    /// The box around both (m).
    bounds: Aabb,
    /// The largest thickness of their own (m).
    thickest: Option<f64>,
}

impl Moving {
    pub(super) fn new(fixed: &Obstacles) -> Moving {
        Moving {
            fixed: fixed.clone(),
            tree: Bvh::build(0, |_| Aabb::EMPTY),
            tree_way: [Vec::new(), Vec::new()],
            now: Vec::new(),
            then: Vec::new(),
            times: [f64::NAN; 2],
            bounds: Aabb::EMPTY,
            thickest: fixed.thickness.iter().flatten().copied().reduce(f64::max),
        }
    }

    /// Half the thickness around a vertex (m).
    pub(super) fn radius(&self, v: u32, settings: &ContactSettings) -> f64 {
        0.5 * self.fixed.thickness[v as usize].unwrap_or(settings.thickness)
    }

    /// Whether all are between two times (s) where they were at the end of the last stage: at both ends
    /// of them and half-way.
    pub(super) fn is_still(&self, [from, to]: [f64; 2]) -> bool {
        let times = [from, 0.5 * (from + to), to];
        !self.fixed.moves || times.into_iter().all(|time| (self.fixed.motion)(time) == self.then)
    }

    /// The largest radius of any of them (m), if not a larger one.
    pub(super) fn largest_radius(&self, settings: &ContactSettings) -> f64 {
        0.5 * self.thickest.map_or(settings.thickness, |own| own.max(settings.thickness))
    }

    /// The box around the way of all (m).
    pub(super) fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    /// Goes to the stage between two times (s). What never moves does so once.
    pub(super) fn go_to(&mut self, [from, to]: [f64; 2]) {
        if !self.fixed.moves && !self.now.is_empty() {
            return;
        }
        if self.times[1] == from {
            std::mem::swap(&mut self.now, &mut self.then);
        } else if self.times[0] != from {
            self.now = (self.fixed.motion)(from);
        }
        self.then = (self.fixed.motion)(to);
        self.times = [from, to];
        self.bounds = Aabb::around(self.now.iter().chain(&self.then));
    }
}
