//! Contact of the cloth with itself and with obstacles: what `collision` finds, as the potential and
//! the bound on steps that the solver wants.

mod candidates;
mod crossings;
mod pair;
mod slip;

use crate::obstacle::Obstacle;
use candidates::Candidates;
use cloth_dynamics::Stage;
use cloth_dynamics::contact::{Contact, STIFFNESS, barrier};
use cloth_dynamics::solver::BlockMatrix;
use collision::{Body, Bvh, Pair, Surface, SurfaceError, ccd, swept};
use mesh_core::{ClothState, World3, par};
use pair::Sides;
use slip::Slip;
use std::sync::Arc;

pub use crossings::Crossings;

/// Where the vertices of all obstacles are at a time (s).
pub type Motion = Arc<dyn Fn(f64) -> Vec<World3> + Send + Sync>;

/// How cloth touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSettings {
    /// Distance below which things repel each other (m).
    pub thickness: f64,
    /// Friction coefficient of cloth on cloth (1).
    pub friction: f64,
    /// Whether cloth touches cloth.
    pub self_contact: bool,
}

/// All obstacles of a scene as one surface.
#[derive(Clone)]
pub struct Obstacles {
    /// Their triangles.
    pub surface: Surface,
    /// Where their vertices are.
    pub motion: Motion,
    /// Friction coefficient of every triangle's obstacle on cloth, by vertex (1).
    pub friction: Vec<f64>,
}

impl Obstacles {
    /// All obstacles of a scene; `None` if there are none.
    ///
    /// # Errors
    /// If there are too many triangles.
    pub fn new(obstacles: &[Obstacle]) -> Result<Option<Obstacles>, SurfaceError> {
        let mut surface: Option<Surface> = None;
        let mut friction = Vec::new();
        for obstacle in obstacles {
            let n = obstacle.n_vertices();
            let own = Surface::new(n, &obstacle.triangles)?;
            surface = Some(match surface {
                None => own,
                Some(others) => others.joined(&own),
            });
            friction.extend(std::iter::repeat_n(obstacle.friction, n));
        }
        let bodies = obstacles.to_vec();
        let motion = move |time| bodies.iter().flat_map(|body| body.positions(time)).collect();
        Ok(surface.map(|surface| Obstacles { surface, friction, motion: Arc::new(motion) }))
    }
}

/// Share of the lowest height of the triangles around a vertex that its radius may have: parts of
/// flat cloth are then not in contact with each other.
const RADIUS_OF_HEIGHT: f64 = 0.2;
/// Share of the thickness that is far more than the rounding of a distance: what keeps it needs no
/// continuous test.
const CLEAR: f64 = 0.1;
/// Share of the thickness by which things may come nearer before candidates are sought anew.
const SKIN: f64 = 0.5;
/// Speed below which things stick (m/s).
const STICK: f64 = 1e-3;

/// Contact of a cloth on its current mesh.
pub struct SurfaceContact {
    settings: ContactSettings,
    cloth: Surface,
    /// Half the thickness around each vertex of the cloth (m).
    radius: Vec<f64>,
    cloth_tree: Bvh,
    obstacles: Option<Moving>,
    /// All that may matter for a while.
    candidates: Candidates,
    /// Pairs that may come near on the way that was last looked at.
    near: Vec<Sides>,
    /// Those that do touch on it.
    in_the_way: Vec<Sides>,
    slips: Vec<Slip>,
    /// Mass over h² by vertex (N/m).
    inertia: Vec<f64>,
}

/// The obstacles on their way.
struct Moving {
    fixed: Obstacles,
    tree: Bvh,
    /// Where they are, and where they are to be at the end of the stage (m).
    now: Vec<World3>,
    then: Vec<World3>,
}

impl SurfaceContact {
    /// Contact of a cloth with itself, if the settings say so, and with obstacles.
    ///
    /// # Errors
    /// If there are too many triangles.
    pub fn new(
        cloth: &ClothState,
        obstacles: Option<&Obstacles>,
        settings: ContactSettings,
    ) -> Result<SurfaceContact, SurfaceError> {
        let surface = Surface::new(cloth.mesh.n_vertices(), cloth.mesh.triangles())?;
        let radius = radii(cloth, 0.5 * settings.thickness);
        let cloth_tree = Body::still(&surface, &cloth.x, &|v| radius[v as usize]).tree();
        let obstacles = obstacles.map(|fixed| {
            let now = (fixed.motion)(0.0);
            let half = 0.5 * settings.thickness;
            let tree = Body::still(&fixed.surface, &now, &|_| half).tree();
            Moving { fixed: fixed.clone(), tree, then: now.clone(), now }
        });
        Ok(SurfaceContact {
            settings,
            cloth: surface,
            radius,
            cloth_tree,
            obstacles,
            candidates: Candidates::default(),
            near: Vec::new(),
            in_the_way: Vec::new(),
            slips: Vec::new(),
            inertia: Vec::new(),
        })
    }

    /// Where things of a pair are: `set` is 0 within the cloth and 1 with obstacles.
    fn sides(&self, set: usize, pair: Pair) -> Sides {
        let other = match &self.obstacles {
            Some(moving) if set == 1 => &moving.fixed.surface,
            _ => &self.cloth,
        };
        Sides::new(pair, pair.vertices(&self.cloth, other), set == 0)
    }

    fn corners(&self, sides: &Sides, x: &[World3]) -> [World3; 4] {
        self.corners_at(sides, x, self.obstacles.as_ref().map_or(&[], |moving| &moving.now))
    }

    fn corners_at(&self, sides: &Sides, x: &[World3], obstacles: &[World3]) -> [World3; 4] {
        std::array::from_fn(|k| {
            let i = sides.vertices[k] as usize;
            if sides.is_cloth[k] { x[i] } else { obstacles[i] }
        })
    }

    /// Distance below which the things of a pair repel each other (m).
    fn thickness(&self, sides: &Sides) -> f64 {
        let radius = |k: usize| {
            if sides.is_cloth[k] {
                self.radius[sides.vertices[k] as usize]
            } else {
                0.5 * self.settings.thickness
            }
        };
        let largest = |side: bool| {
            (0..4).filter(|&k| sides.is_first[k] == side).map(radius).fold(0.0, f64::max)
        };
        largest(true) + largest(false)
    }

    /// Stiffness of a pair (N/m).
    fn stiffness(&self, sides: &Sides) -> f64 {
        let cloth = (0..4).filter(|&k| sides.is_cloth[k]);
        let of = |k: usize| self.inertia[sides.vertices[k] as usize];
        STIFFNESS * cloth.clone().map(of).sum::<f64>() / cloth.count() as f64
    }

    /// What holds things back that touch at the start of a stage, at `x`.
    fn find_slips(&mut self, stage: &Stage<'_>, times: [f64; 2]) {
        self.slips.clear();
        let moving = self.obstacles.as_ref();
        let slides = moving.is_some_and(|m| m.fixed.friction.iter().any(|&mu| mu > 0.0));
        if self.settings.friction == 0.0 && !slides {
            return;
        }
        let before = moving.map(|moving| (moving.fixed.motion)(times[1] - stage.h));
        for sides in &self.near {
            let closest = sides.closest(&self.corners(sides, stage.x_t0));
            let [_, slope, _] = barrier(closest.distance, self.thickness(sides));
            let (mut mu, mut way) = (self.settings.friction, World3::zeros());
            if let (Some(moving), Some(before), true) = (moving, &before, !sides.is_within_cloth())
            {
                mu = 0.0;
                for k in (0..4).filter(|&k| !sides.is_cloth[k]) {
                    let i = sides.vertices[k] as usize;
                    mu = f64::max(mu, moving.fixed.friction[i]);
                    way += (moving.then[i] - before[i]) * closest.weights[k];
                }
            }
            let most = -slope * self.stiffness(sides) * mu;
            self.slips.extend(Slip::new(*sides, &closest, most, way, STICK * stage.h));
        }
    }

    /// Looks at the way as [`Contact::look_ahead`] does.
    fn look(&mut self, x: &[World3], x_t1: &[World3]) -> f64 {
        let (now, then): (&[World3], &[World3]) =
            self.obstacles.as_ref().map_or((&[], &[]), |m| (&m.now, &m.then));
        if !self.candidates.are_complete([x, x_t1], [now, then]) {
            self.search(x, x_t1);
        }
        let (now, then): (&[World3], &[World3]) =
            self.obstacles.as_ref().map_or((&[], &[]), |m| (&m.now, &m.then));
        let Candidates { pairs: found, start, .. } = &self.candidates;
        let mut free = vec![None; found.len()];
        par::fill(&mut free, |k| {
            let (sides, distance) = &found[k];
            let thickness = self.thickness(sides);
            let at_start = self.corners_at(sides, &start[0], &start[1]);
            let x_t0 = self.corners_at(sides, x, now);
            let x_t1 = self.corners_at(sides, x_t1, then);
            let nearer = sides.relative_motion(&at_start, &x_t0);
            if distance - nearer.max(sides.relative_motion(&at_start, &x_t1)) > thickness {
                return None;
            }
            let left = sides.closest(&x_t0).distance - sides.relative_motion(&x_t0, &x_t1);
            if left > thickness {
                None
            } else if left > CLEAR * thickness {
                Some(1.0)
            } else if sides.is_edges {
                Some(ccd::edge_edge(&x_t0, &x_t1, 0.0).free_until())
            } else {
                Some(ccd::vertex_triangle(&x_t0, &x_t1, 0.0).free_until())
            }
        });
        let kept =
            found.iter().zip(&free).filter_map(|((sides, _), free)| free.map(|t| (*sides, t)));
        let kept: Vec<(Sides, f64)> = kept.collect();
        self.near = kept.iter().map(|(sides, _)| *sides).collect();
        let hits = kept.iter().filter(|(_, t)| *t < 1.0);
        self.in_the_way = hits.map(|(sides, _)| *sides).collect();
        kept.into_iter().map(|(_, t)| t).fold(1.0, f64::min)
    }

    /// Finds candidates anew, for this way and for what is near it.
    fn search(&mut self, x: &[World3], x_t1: &[World3]) {
        let skin = SKIN * self.settings.thickness;
        let radius = |v: u32| self.radius[v as usize] + 0.5 * skin;
        let body = Body::moving(&self.cloth, x, x_t1, &radius);
        body.update_tree(&mut self.cloth_tree);
        let mut found: Vec<(usize, Pair)> = Vec::new();
        if self.settings.self_contact {
            let pairs = swept::candidates_within(body, &self.cloth_tree);
            found.extend(pairs.into_iter().map(|pair| (0, pair)));
        }
        if let Some(moving) = &mut self.obstacles {
            let half = 0.5 * (self.settings.thickness + skin);
            let room = |_: u32| half;
            let other = Body::moving(&moving.fixed.surface, &moving.now, &moving.then, &room);
            other.update_tree(&mut moving.tree);
            let pairs = swept::candidates_between((body, &self.cloth_tree), (other, &moving.tree));
            found.extend(pairs.into_iter().map(|pair| (1, pair)));
        }
        let (now, then): (&[World3], &[World3]) =
            self.obstacles.as_ref().map_or((&[], &[]), |m| (&m.now, &m.then));
        let mut pairs = vec![None; found.len()];
        par::fill(&mut pairs, |k| {
            let sides = self.sides(found[k].0, found[k].1);
            let x_t0 = self.corners_at(&sides, x, now);
            let x_t1 = self.corners_at(&sides, x_t1, then);
            let distance = sides.closest(&x_t0).distance;
            let left = distance - sides.relative_motion(&x_t0, &x_t1);
            (left <= self.thickness(&sides) + skin).then_some((sides, distance))
        });
        let pairs = pairs.into_iter().flatten().collect();
        self.candidates = Candidates::new(pairs, skin, [x, x_t1], [now, then]);
    }
}

/// Radii of the vertices: `most`, but less where the mesh is fine (m).
fn radii(cloth: &ClothState, most: f64) -> Vec<f64> {
    let mesh = &cloth.mesh;
    let lowest = |t: mesh_core::TriangleId| {
        let edges = [0, 1, 2].map(|k| mesh.material_edge(t.half_edge(k)).norm());
        2.0 * mesh.area(t) / edges.into_iter().fold(0.0, f64::max)
    };
    let mut radii = vec![most; mesh.n_vertices()];
    for (t, corners) in mesh.triangle_ids().zip(mesh.triangles()) {
        let radius = RADIUS_OF_HEIGHT * lowest(t);
        for &i in corners {
            radii[i as usize] = radii[i as usize].min(radius);
        }
    }
    radii
}

impl Contact for SurfaceContact {
    fn name(&self) -> &'static str {
        "contact"
    }

    fn begin(&mut self, stage: Stage<'_>, times: [f64; 2], mass: &[f64]) {
        self.inertia.clear();
        self.inertia.extend(mass.iter().map(|m| m / (stage.h * stage.h)));
        if let Some(moving) = &mut self.obstacles {
            moving.now = (moving.fixed.motion)(times[0]);
            moving.then = (moving.fixed.motion)(times[1]);
        }
        self.look(stage.x_t0, stage.x_t0);
        self.find_slips(&stage, times);
        for slip in &mut self.slips {
            slip.set_base(stage.base);
        }
    }

    fn look_ahead(&mut self, x: &[World3], step: &[World3]) -> f64 {
        let x_t1: Vec<World3> = x.iter().zip(step).map(|(x, d)| x + d).collect();
        self.look(x, &x_t1)
    }

    fn carry(&self, x: &[World3], step: &mut [World3]) -> bool {
        let mut carried: Vec<Option<World3>> = vec![None; x.len()];
        for sides in &self.in_the_way {
            let way = match &self.obstacles {
                Some(moving) if !sides.is_within_cloth() => {
                    let weights = sides.closest(&self.corners(sides, x)).weights;
                    let way = |k: usize| {
                        let i = sides.vertices[k] as usize;
                        (moving.then[i] - moving.now[i]) * weights[k].abs()
                    };
                    (0..4).filter(|&k| !sides.is_cloth[k]).map(way).sum()
                }
                // Cloth that runs into cloth takes it along.
                _ => sides.vertices.map(|i| step[i as usize]).into_iter().fold(
                    World3::zeros(),
                    |a, b| {
                        if a.norm_squared() >= b.norm_squared() { a } else { b }
                    },
                ),
            };
            for k in (0..4).filter(|&k| sides.is_cloth[k]) {
                let slot = &mut carried[sides.vertices[k] as usize];
                if slot.is_none_or(|old| old.norm_squared() < way.norm_squared()) {
                    *slot = Some(way);
                }
            }
        }
        let mut changed = false;
        for (step, way) in step.iter_mut().zip(&carried) {
            if let Some(way) = way.filter(|way| way != step) {
                *step = way;
                changed = true;
            }
        }
        changed
    }

    fn follow(&mut self, share: f64) {
        if let Some(moving) = &mut self.obstacles {
            if share == 1.0 {
                moving.now.clone_from(&moving.then);
            } else {
                for (now, then) in moving.now.iter_mut().zip(&moving.then) {
                    *now += (*then - *now) * share;
                }
            }
        }
    }

    fn has_arrived(&self) -> bool {
        self.obstacles.as_ref().is_none_or(|moving| moving.now == moving.then)
    }

    fn energy(&self, x: &[World3]) -> f64 {
        let pair = |k: usize| {
            let sides = &self.near[k];
            let distance = sides.closest(&self.corners(sides, x)).distance;
            let [energy, ..] = barrier(distance, self.thickness(sides));
            if energy == 0.0 { 0.0 } else { energy * self.stiffness(sides) }
        };
        let repulsion = par::sum(self.near.len(), pair);
        repulsion + self.slips.iter().map(|slip| slip.energy(x)).sum::<f64>()
    }

    fn add_system(&self, x: &[World3], gradient: &mut [World3], stiffness: &mut BlockMatrix) {
        for sides in &self.near {
            let closest = sides.closest(&self.corners(sides, x));
            let [_, slope, curvature] = barrier(closest.distance, self.thickness(sides));
            if slope < 0.0 {
                let k = self.stiffness(sides);
                let normal = closest.offset / closest.distance;
                sides.add_gradient(&closest.weights, &(normal * (slope * k)), gradient);
                // The distance is nearly linear, and what is left of its Hessian is not positive.
                let along = normal * normal.transpose() * (curvature * k);
                sides.add_stiffness(&closest.weights, &along, stiffness);
            }
        }
        for slip in &self.slips {
            slip.add_system(x, gradient, stiffness);
        }
    }
}
