//! Contact of the cloth with itself and with obstacles: what `collision` finds, as the energies and
//! the free ways that the solver wants.

mod candidates;
mod crossings;
mod impact;
mod obstacles;
mod pair;
mod rest;
mod search;
mod sleep;
mod slip;
mod tangle;
mod touch;

use candidates::Candidates;
use cloth_dynamics::Stage;
use cloth_dynamics::contact::{Blocked, Contact, STIFFNESS, penalty};
use cloth_dynamics::solver::BlockMatrix;
use collision::{Aabb, Bvh, Surface, SurfaceError};
use mesh_core::{ClothState, World3, par};
use obstacles::Moving;
use pair::{ClosestPoints, Sides};
use rest::RestSheet;
use sleep::Sleep;
use slip::Slip;
use std::collections::HashSet;
use tangle::{Joined, Start, Tangle};
use touch::{Touch, approach};

pub use crossings::Crossings;
pub use obstacles::{Motion, Obstacles};
pub use tangle::contour_length;

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

/// Share of the thickness below which a gap that no energy keeps open is worth one.
const OVERLOOKED: f64 = 0.5;
/// By what the stiffness of things grows at most that are pressed together.
const MOST_PRESSED: f64 = 100.0;
/// Speed at which things that are nearer than their thickness go apart at most (m/s): without it,
/// whatever brings them nearer at once, an impact or an edit of the mesh, would throw them apart.
const RECOVERY: f64 = 0.1;
/// Speed below which things stick (m/s).
const STICK: f64 = 1e-3;

/// Contact of a cloth on its current mesh.
pub struct SurfaceContact {
    settings: ContactSettings,
    cloth: Surface,
    /// Half the thickness around each vertex of the cloth (m).
    radius: Vec<f64>,
    rest: RestSheet,
    cloth_tree: Bvh,
    obstacles: Option<Moving>,
    /// All that may matter for a while.
    candidates: Candidates,
    /// Distance of each candidate at the start of the stage (m).
    distances: Vec<f64>,
    touches: Vec<Touch>,
    slips: Vec<Slip>,
    sleep: Sleep,
    /// What is tangled; absent where the start of a stage was found free.
    tangle: Option<Tangle>,
    /// Mass over h² by vertex (N/m).
    inertia: Vec<f64>,
    /// Where the stage starts, and where it would end without forces (m).
    x_t0: Vec<World3>,
    target: Vec<World3>,
    /// By what the last stage of length `h` (s) ended off its target (m).
    off_target: Vec<World3>,
    h: f64,
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
        Ok(SurfaceContact {
            settings,
            cloth: Surface::new(cloth.mesh.n_vertices(), cloth.mesh.triangles())?,
            radius: vec![0.5 * settings.thickness; cloth.mesh.n_vertices()],
            rest: RestSheet::new(cloth),
            cloth_tree: Bvh::build(0, |_| Aabb::EMPTY),
            obstacles: obstacles.map(Moving::new),
            candidates: Candidates::default(),
            distances: Vec::new(),
            touches: Vec::new(),
            slips: Vec::new(),
            sleep: Sleep::default(),
            tangle: None,
            inertia: Vec::new(),
            x_t0: Vec::new(),
            target: Vec::new(),
            off_target: Vec::new(),
            h: 0.0,
        })
    }

    /// The same contact, in which panels of the cloth have a thickness of their own (m) where one is
    /// given: things of two thicknesses keep the mean of them.
    #[must_use]
    pub fn with_thickness(
        mut self,
        cloth: &ClothState,
        of_panel: impl Fn(u32) -> Option<f64>,
    ) -> SurfaceContact {
        let thickness = |panel| of_panel(panel).unwrap_or(self.settings.thickness);
        self.radius.fill(f64::INFINITY);
        for (corners, &panel) in cloth.mesh.triangles().iter().zip(cloth.mesh.panels()) {
            for &i in corners {
                let radius = &mut self.radius[i as usize];
                *radius = radius.min(0.5 * thickness(panel));
            }
        }
        self
    }

    /// The same contact of a cloth that passes through something, which it is led out of. Until nothing
    /// passes through anything any more, obstacles let cloth pass within balls around the places
    /// `yielding`, centre and radius (m).
    #[must_use]
    pub fn tangled(mut self, yielding: &[(World3, f64)]) -> SurfaceContact {
        let obstacles = self.obstacles.as_ref().map(|moving| &moving.fixed.surface);
        self.tangle = Some(Tangle::new(Joined::new(&self.cloth, obstacles), yielding.to_vec()));
        self
    }

    /// Finds out what is tangled at the start of a stage.
    fn begin_tangle(&mut self, x_t0: &[World3], duration: f64) {
        let Some(mut tangle) = self.tangle.take() else { return };
        let (now, then) = self.obstacle_way();
        let start = Start {
            x: x_t0,
            obstacles: [now, then],
            inertia: &self.inertia,
            duration,
            self_contact: self.settings.self_contact,
        };
        self.tangle = tangle.begin(&start).then_some(tangle);
    }

    /// Whether a pair may pass, because it is part of a tangle.
    fn is_exempt(&self, sides: &Sides) -> bool {
        self.tangle.as_ref().is_some_and(|tangle| tangle.is_exempt(sides))
    }

    /// The corners of a pair at the start of the stage (m).
    fn corners_now(&self, sides: &Sides, x: &[World3]) -> [World3; 4] {
        sides.corners(x, self.obstacles.as_ref().map_or(&[], |moving| &moving.now))
    }

    /// The corners of a pair at the end of the stage (m).
    fn corners_then(&self, sides: &Sides, x: &[World3]) -> [World3; 4] {
        sides.corners(x, self.obstacles.as_ref().map_or(&[], |moving| &moving.then))
    }

    /// Distance below which the things of a pair repel each other (m).
    fn thickness(&self, sides: &Sides) -> f64 {
        let radius = |k: usize| {
            if sides.is_cloth[k] {
                self.radius[sides.vertices[k] as usize]
            } else {
                self.obstacles.as_ref().map_or(0.0, |m| m.radius(sides.vertices[k], &self.settings))
            }
        };
        let largest = |side: bool| {
            (0..4).filter(|&k| sides.is_first[k] == side).map(radius).fold(0.0, f64::max)
        };
        let thickness = largest(true) + largest(false);
        let n_first = if sides.is_edges { 2 } else { 1 };
        if sides.is_within_cloth() {
            thickness.min(self.rest.most(&sides.vertices, n_first))
        } else {
            thickness
        }
    }

    /// Stiffness of a pair at some distance (N/m): what has been pressed together resists more.
    fn stiffness(&self, sides: &Sides, distance: f64) -> f64 {
        let cloth = (0..4).filter(|&k| sides.is_cloth[k]);
        let of = |k: usize| self.inertia[sides.vertices[k] as usize];
        let pressed = (sides.thickness / distance).clamp(1.0, MOST_PRESSED);
        pressed * STIFFNESS * cloth.clone().map(of).sum::<f64>() / cloth.count() as f64
    }

    /// Gap below which a pair at some distance repels each other in this stage (m).
    fn reach(&self, sides: &Sides, distance: f64) -> f64 {
        sides.thickness.min(distance + RECOVERY * self.h)
    }

    /// The contact of a pair on the way to `x`, if it comes near on it.
    fn touch(&self, sides: &Sides, start: ClosestPoints, x: &[World3]) -> Option<Touch> {
        let thickness = self.reach(sides, start.distance);
        let (from, to) = (self.corners_now(sides, &self.x_t0), self.corners_then(sides, x));
        let closest = approach(sides, [&from, &to], start, thickness)?;
        // The distance to the end of an edge is that of a vertex, which has a pair of its own.
        let is_repeated = sides.is_edges && closest.weights.contains(&0.0);
        let new =
            || Touch::new(*sides, &closest, &to, thickness, self.stiffness(sides, start.distance));
        (!is_repeated).then(new)
    }

    /// What holds things back that touch at the start of a stage.
    fn find_slips(&mut self, near: &[(Sides, ClosestPoints)], stage: &Stage<'_>, times: [f64; 2]) {
        self.slips.clear();
        let moving = self.obstacles.as_ref();
        let slides = moving.is_some_and(|m| m.fixed.friction.iter().any(|&mu| mu > 0.0));
        if near.is_empty() || (self.settings.friction == 0.0 && !slides) {
            return;
        }
        let mover = moving.filter(|moving| moving.fixed.moves);
        let before = mover.map(|moving| (moving.fixed.motion)(times[1] - stage.h));
        for (sides, closest) in near {
            let reach = self.reach(sides, closest.distance);
            let [_, slope, _] = penalty(closest.distance, reach);
            let (mut mu, mut way) = (self.settings.friction, World3::zeros());
            if let (Some(moving), false) = (moving, sides.is_within_cloth()) {
                mu = 0.0;
                for k in (0..4).filter(|&k| !sides.is_cloth[k]) {
                    let i = sides.vertices[k] as usize;
                    mu = f64::max(mu, moving.fixed.friction[i]);
                    if let Some(before) = &before {
                        way += (moving.then[i] - before[i]) * closest.weights[k];
                    }
                }
            }
            let most = -slope * self.stiffness(sides, closest.distance) * mu;
            self.slips.extend(Slip::new(*sides, closest, most, way, STICK * stage.h));
        }
        for slip in &mut self.slips {
            slip.set_base(stage.base);
        }
    }
}

impl Contact for SurfaceContact {
    fn name(&self) -> &'static str {
        "contact"
    }

    fn begin(&mut self, stage: Stage<'_>, times: [f64; 2], mass: &[f64], target: &[World3]) {
        self.inertia.clear();
        self.inertia.extend(mass.iter().map(|m| m / (stage.h * stage.h)));
        self.x_t0.clear();
        self.x_t0.extend_from_slice(stage.x_t0);
        if let Some(moving) = &mut self.obstacles {
            moving.go_to(times);
        }
        // Forces change little from one stage to the next.
        if self.h != stage.h {
            self.off_target.clear();
        }
        self.h = stage.h;
        self.begin_tangle(stage.x_t0, times[1] - times[0]);
        self.begin_sleep(stage.x_t0);
        self.target = target.to_vec();
        let mut target = target.to_vec();
        target.iter_mut().zip(&self.off_target).for_each(|(target, off)| *target += off);
        // What the last stage found serves this one too: what it lacks comes from afar at a speed that
        // only the test of the whole way has to stop.
        if !self.candidates.are_around(stage.x_t0, self.moving_way().0) {
            self.search(stage.x_t0, &target);
        }
        let pairs = &self.candidates.pairs;
        let mut found = vec![(0.0, None, None); pairs.len()];
        par::fill(&mut found, |k| {
            let sides = &pairs[k];
            let start = sides.closest(&self.corners_now(sides, stage.x_t0));
            let (distance, thickness) = (start.distance, sides.thickness);
            if self.is_exempt(sides) {
                return (distance, None, None);
            }
            let touch = self.touch(sides, start, &target);
            let is_near = touch.is_some() && distance < thickness;
            (distance, touch, is_near.then_some((*sides, start)))
        });
        self.distances = found.iter().map(|(distance, ..)| *distance).collect();
        self.touches = found.iter().filter_map(|(_, touch, _)| *touch).collect();
        let near: Vec<(Sides, ClosestPoints)> =
            found.into_iter().filter_map(|(.., near)| near).collect();
        self.find_slips(&near, &stage, times);
    }

    fn rest(&mut self, sleepers: Option<&[bool]>) {
        self.sleep.tell(sleepers);
    }

    fn couples(&self) -> Vec<[u32; 2]> {
        let touches = self.touches.iter().flat_map(|touch| touch.sides.couples());
        let drives = self.tangle.iter().flat_map(|tangle| &tangle.drives);
        touches.chain(drives.flat_map(|drive| drive.couples())).collect()
    }

    fn energy(&self, x: &[World3]) -> f64 {
        par::sum(self.touches.len(), |k| self.touches[k].energy(x))
            + par::sum(self.slips.len(), |k| self.slips[k].energy(x))
            + self.tangle.as_ref().map_or(0.0, |tangle| tangle.energy(x))
    }

    fn add_gradient(&self, x: &[World3], gradient: &mut [World3]) {
        self.touches.iter().for_each(|touch| touch.add_gradient(x, gradient));
        self.slips.iter().for_each(|slip| slip.add_gradient(x, gradient));
        self.sleep.add_gradient(gradient);
        let drives = self.tangle.iter().flat_map(|tangle| &tangle.drives);
        drives.for_each(|drive| drive.add_gradient(x, gradient));
    }

    fn add_grip(&self, stands: &[bool], grip: &mut [f64]) {
        self.slips.iter().for_each(|slip| slip.add_grip(stands, grip));
    }

    fn add_system(&self, x: &[World3], gradient: &mut [World3], stiffness: &mut BlockMatrix) {
        self.add_gradient(x, gradient);
        for touch in &self.touches {
            touch.add_stiffness(x, stiffness);
        }
        for slip in &self.slips {
            slip.add_stiffness(x, stiffness);
        }
        for drive in self.tangle.iter().flat_map(|tangle| &tangle.drives) {
            drive.add_stiffness(stiffness);
        }
    }

    fn look(&mut self, x: &[World3]) -> bool {
        // Those that are not candidates are found when the way is secured: a search costs more than it
        // gains here.
        let known: HashSet<[u32; 5]> = self.touches.iter().map(|t| t.sides.key()).collect();
        let pairs = &self.candidates.pairs;
        let more = par::collect(pairs.len(), |k, more| {
            let sides = &pairs[k];
            let (from, to) = (self.corners_now(sides, &self.x_t0), self.corners_then(sides, x));
            let thickness = OVERLOOKED * sides.thickness;
            let is_far = self.distances[k] - sides.relative_motion(&from, &to) > thickness;
            if is_far || known.contains(&sides.key()) || self.is_exempt(sides) {
                return;
            }
            let start = sides.closest(&from);
            more.extend(self.touch(sides, start, x).filter(|touch| touch.gap(x) < thickness));
        });
        let is_new = !more.is_empty();
        self.touches.extend(more);
        is_new
    }

    fn is_passed(&self, x: &[World3]) -> bool {
        self.touches.iter().any(|touch| touch.gap(x) <= 0.0)
    }

    fn secure(&mut self, x: &mut [World3], fixed: &[bool]) -> Result<usize, Blocked> {
        let n_moved = self.free_way(x, fixed)?;
        self.off_target = x.iter().zip(&self.target).map(|(x, target)| x - target).collect();
        Ok(n_moved)
    }

    fn n_touches(&self) -> usize {
        self.touches.len()
    }

    fn is_still(&self, times: [f64; 2]) -> bool {
        self.tangle.is_none() && self.obstacles.as_ref().is_none_or(|o| o.is_still(times))
    }
}
