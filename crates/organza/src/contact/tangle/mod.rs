//! Untangling: cloth that passes through something is led back, along the shortest way that there is.
//!
//! Each stage begins with the contours along which surfaces cross. Contact would lock what lies behind
//! one, a plug, so that pairs of the two sides are exempt from it there. Every crossing is driven
//! against what it crosses, at a fixed speed: along the way on which the plug comes out, or on which the
//! contour gets shorter (Volino2006), see [`Exit`]; the plug follows. All of this depends on the
//! positions at the start of the stage alone, so that a run can go on from any of them. It is not there
//! while nothing is tangled.

mod drive;
mod exit;
mod region;

pub(super) use drive::Drive;

use super::pair::Sides;
use collision::contour::{Contours, Push};
use collision::{Aabb, Bvh, Surface, SurfaceError};
use exit::Exit;
use mesh_core::{ClothState, World3};
use region::{Regions, Traces};

/// Speed at which things are led apart (m/s).
const SPEED: f64 = 1.0;
/// Sets of vertices are told apart as bits of a number: beyond these, contours share them.
const N_BITS: usize = 64;
/// Share of the size of everything by which places are changed to keep them from just touching.
const OFF: f64 = 1e-9;
/// The golden ratio: its multiples have the most even fractions.
const GOLDEN: f64 = 1.618_033_988_749_895;

/// The cloth and all obstacles as one surface, cloth first.
pub(super) struct Joined {
    surface: Surface,
    n_cloth: usize,
    n_cloth_triangles: usize,
}

impl Joined {
    pub(super) fn new(cloth: &Surface, obstacles: Option<&Surface>) -> Joined {
        let surface = obstacles.map_or_else(|| cloth.clone(), |o| cloth.joined(o));
        Joined { surface, n_cloth: cloth.n_vertices(), n_cloth_triangles: cloth.n_triangles() }
    }

    /// Contours of cloth with cloth, if it touches itself, and with obstacles; `x` are positions of
    /// all (m).
    pub(super) fn contours(&self, x: &[World3], self_contact: bool) -> Contours {
        let x = &generic(x);
        let of_cloth = |edge: u32| (self.surface.edges()[edge as usize][0] as usize) < self.n_cloth;
        let keep = |edge: u32, t: u32| match (of_cloth(edge), (t as usize) < self.n_cloth_triangles)
        {
            (true, true) => self_contact,
            (false, false) => false,
            _ => true,
        };
        let tree: Bvh = self.surface.tree(x);
        Contours::find(&self.surface, x, &tree, keep)
    }
}

/// Positions a little off their places, so that nothing just touches: a contour along which vertices of
/// one surface lie in the other is as good as its neighbours.
fn generic(x: &[World3]) -> Vec<World3> {
    let extent = Aabb::around(x).extent();
    let off = |i: usize| {
        let noise = |k: usize| ((3 * i + k) as f64 * GOLDEN).fract() - 0.5;
        World3::new(noise(0), noise(1), noise(2)) * (OFF * extent)
    };
    x.iter().enumerate().map(|(i, x)| x + off(i)).collect()
}

/// Total length of all contours along which a cloth passes through itself, if it can touch itself, and
/// through obstacles at a time (m).
///
/// # Errors
/// If there are too many triangles.
pub fn contour_length(
    cloth: &ClothState,
    obstacles: Option<&super::Obstacles>,
    self_contact: bool,
    time: f64,
) -> Result<f64, SurfaceError> {
    let surface = Surface::new(cloth.mesh.n_vertices(), cloth.mesh.triangles())?;
    let joined = Joined::new(&surface, obstacles.map(|o| &o.surface));
    let mut x = cloth.x.clone();
    x.extend(obstacles.map(|o| (o.motion)(time)).unwrap_or_default());
    Ok(joined.contours(&x, self_contact).length())
}

/// A stage in which something is tangled.
pub(super) struct Start<'a> {
    /// Positions of the cloth (m).
    pub(super) x: &'a [World3],
    /// Positions of the obstacles at the start and at the end of the stage (m).
    pub(super) obstacles: [&'a [World3]; 2],
    /// Mass over h² by vertex of the cloth (N/m).
    pub(super) inertia: &'a [f64],
    /// How long the way takes (s).
    pub(super) duration: f64,
    /// Whether cloth touches cloth.
    pub(super) self_contact: bool,
}

/// Where the cloth passes through something.
pub(super) struct Tangle {
    joined: Joined,
    /// Sets that each vertex of all is in, as a plug or as what it goes through.
    plugs: Vec<u64>,
    walls: Vec<u64>,
    pub(super) drives: Vec<Drive>,
    /// Places where cloth may pass through obstacles: centre and radius (m).
    yielding: Vec<(World3, f64)>,
    /// Whether a vertex of the cloth is at such a place.
    yields: Vec<bool>,
}

impl Tangle {
    pub(super) fn new(joined: Joined, yielding: Vec<(World3, f64)>) -> Tangle {
        let (plugs, walls, drives) = (Vec::new(), Vec::new(), Vec::new());
        Tangle { joined, plugs, walls, drives, yielding, yields: Vec::new() }
    }

    /// Looks for what is tangled at the start of a stage; false if nothing is or will be.
    pub(super) fn begin(&mut self, start: &Start<'_>) -> bool {
        let surface = &self.joined.surface;
        let mut x = start.x.to_vec();
        x.extend_from_slice(start.obstacles[0]);
        let contours = self.joined.contours(&x, start.self_contact);
        let is_near = |x: &World3| self.yielding.iter().any(|(at, r)| (x - at).norm() <= *r);
        self.yields = start.x.iter().map(is_near).collect();
        self.plugs = vec![0; x.len()];
        self.walls = vec![0; x.len()];
        self.drives.clear();
        if contours.is_empty() {
            return !self.yielding.is_empty();
        }
        let pushes = contours.pushes(surface, &generic(&x));
        let mut regions = Regions::new(surface, &contours.crossings);
        let way = SPEED * start.duration;
        let mut is_driven = vec![false; contours.crossings.len()];
        for (number, contour) in contours.contours.iter().enumerate() {
            let traces = Traces::of(&contours, contour);
            let own: Vec<(&Push, f64)> =
                traces.crossings.iter().map(|&(i, sign)| (&pushes[i as usize], sign)).collect();
            let exit = Exit::find(surface, &x, &mut regions, &traces, &own, contour.length, way);
            let bit = 1 << (number % N_BITS);
            exit.plug.iter().for_each(|&v| self.plugs[v as usize] |= bit);
            exit.wall.iter().for_each(|&v| self.walls[v as usize] |= bit);
            for (push, sign) in own {
                is_driven[push.crossing as usize] = true;
                let want = match exit.direction {
                    Some(direction) => direction * (sign * way),
                    None => push.displacement(way, 1.0),
                };
                self.drives.extend(Drive::new(push, want, start, self.joined.n_cloth));
            }
        }
        for &[i, j] in surface.edges() {
            let [a, b] = [i, j].map(|v| (self.plugs[v as usize], self.walls[v as usize]));
            let is_near = a.0 & b.0 != 0 || a.1 & b.1 != 0;
            if is_near && (j as usize) < self.joined.n_cloth {
                self.drives.push(Drive::together([i, j], start));
            }
        }
        // What only touches makes no contour, and may go on as well.
        for (i, crossing) in contours.crossings.iter().enumerate().filter(|&(i, _)| !is_driven[i]) {
            let bit = 1 << (i % N_BITS);
            let ends = surface.edges()[crossing.edge as usize];
            ends.iter().for_each(|&v| self.plugs[v as usize] |= bit);
            let corners = surface.triangles()[crossing.triangle as usize];
            corners.iter().for_each(|&v| self.walls[v as usize] |= bit);
        }
        true
    }

    /// Energy of all drives (J).
    pub(super) fn energy(&self, x: &[World3]) -> f64 {
        self.drives.iter().map(|drive| drive.energy(x)).sum()
    }

    /// Whether a pair may come together and pass.
    pub(super) fn is_exempt(&self, sides: &Sides) -> bool {
        let index = |k: usize| {
            let first = if sides.is_cloth[k] { 0 } else { self.joined.n_cloth };
            first + sides.vertices[k] as usize
        };
        let bits = |of: &[u64], first: bool| {
            let side = (0..4).filter(|&k| sides.is_first[k] == first);
            side.fold(0, |bits, k| bits | of[index(k)])
        };
        if bits(&self.plugs, true) & bits(&self.walls, false) != 0
            || bits(&self.plugs, false) & bits(&self.walls, true) != 0
        {
            return true;
        }
        let yields = |k: usize| sides.is_cloth[k] && self.yields[sides.vertices[k] as usize];
        !sides.is_within_cloth() && (0..4).any(yields)
    }
}
