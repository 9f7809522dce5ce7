//! Walls of particles that do not move (Crespo2007, Akinci2012): boxes and triangle meshes, two layers
//! thick.
//!
//! One layer leaks. Two fill the support of a particle that touches the wall, so that fluid at rest
//! goes on into the wall as if it were fluid, and what presses in is still pushed out.

use crate::grid::{Columns, Grid, Point};
use crate::kernel::CubicSpline;
use crate::place::squared_distance;
use crate::settings::{Bounds, FluidError};
use nalgebra::Vector3;
use std::collections::HashMap;

/// Layers of particles in a wall.
const LAYERS: i64 = 2;

/// Which faces of a box are open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Open {
    /// Faces at the smallest x, y and z.
    pub low: [bool; 3],
    /// Faces at the largest x, y and z.
    pub high: [bool; 3],
}

impl Open {
    /// A basin: only the face at the largest z is open.
    pub const TOP: Open = Open { low: [false; 3], high: [false, false, true] };
}

/// Particles of walls, each with the mass of fluid that it stands for.
#[derive(Clone, Debug, Default)]
pub struct Walls {
    /// Positions (m) and volumes (m³), 0 where it is not known yet. Sorted by the cells of the grid once
    /// prepared.
    points: Vec<Point>,
    /// Masses (kg).
    masses: Vec<f64>,
    /// Densities without any fluid (kg/m³), at most the rest density.
    own: Vec<f64>,
    grid: Grid,
    columns: Columns,
}

impl Walls {
    /// No walls.
    pub fn none() -> Self {
        Walls::default()
    }

    /// The inside of a box, sampled at `spacing` (m) or a little closer. Particles lie half a spacing
    /// outside of the faces and one spacing further.
    ///
    /// # Errors
    /// If the box or the spacing is not positive, or there are too many particles.
    pub fn add_box(&mut self, inside: &Bounds, open: Open, spacing: f64) -> Result<(), FluidError> {
        check_spacing(spacing)?;
        let size = inside.size();
        let n: [i64; 3] = [0, 1, 2].map(|k| (size[k] / spacing - 1e-9).ceil() as i64);
        for k in 0..3 {
            if !(size[k] > 0.0 && size[k].is_finite()) {
                let wanted = "positive and finite";
                return Err(FluidError::OutOfRange { name: "size of box", value: size[k], wanted });
            }
        }
        let around = |k: usize| (n[k] + 2 * LAYERS) as f64;
        check_count(
            around(0) * around(1) * around(2) - n.map(|n| n as f64).iter().product::<f64>(),
        )?;
        let volume = (0..3).map(|k| size[k] / n[k] as f64).product();
        let range = |k: usize| {
            let low = if open.low[k] { 0 } else { -LAYERS };
            low..n[k] + if open.high[k] { 0 } else { LAYERS }
        };
        let is_inside = |k: usize, at: i64| (0..n[k]).contains(&at);
        let place = |k: usize, at: i64| inside.min[k] + (at as f64 + 0.5) * size[k] / n[k] as f64;
        for z in range(2) {
            for y in range(1) {
                let row_inside = is_inside(1, y) && is_inside(2, z);
                for x in range(0).filter(|&x| !(row_inside && is_inside(0, x))) {
                    self.points.push([place(0, x), place(1, y), place(2, z), volume]);
                }
            }
        }
        Ok(())
    }

    /// A surface of triangles whose normals (right-hand rule) point to the fluid. Particles lie half a
    /// spacing (m) behind it and one spacing further, nowhere farther apart than about `spacing`.
    ///
    /// # Errors
    /// If a corner does not exist or is not finite, or there are too many particles.
    pub fn add_mesh(
        &mut self,
        corners: &[Vector3<f64>],
        triangles: &[[u32; 3]],
        spacing: f64,
    ) -> Result<(), FluidError> {
        check_spacing(spacing)?;
        for (triangle, &c) in triangles.iter().enumerate() {
            let n_corners = corners.len();
            if let Some(&corner) = c.iter().find(|&&corner| corner as usize >= n_corners) {
                return Err(FluidError::Corner { triangle, corner, n_corners });
            }
            for x in c.iter().flat_map(|&corner| corners[corner as usize].iter()) {
                if !x.is_finite() {
                    let (name, wanted) = ("coordinate of a wall", "finite");
                    return Err(FluidError::OutOfRange { name, value: *x, wanted });
                }
            }
        }
        for layer in 0..LAYERS {
            let depth = (layer as f64 + 0.5) * spacing;
            let mut samples = Samples::new(0.5 * spacing);
            for c in triangles {
                let [a, b, c] = c.map(|corner| corners[corner as usize]);
                let normal = (b - a).cross(&(c - a));
                if normal.norm() > 0.0 {
                    let back = normal.normalize() * depth;
                    samples.cover([a - back, b - back, c - back], spacing / 5.0)?;
                }
            }
            self.points.extend(samples.points.iter().map(|x| [x.x, x.y, x.z, 0.0]));
        }
        check_count(self.points.len() as f64)
    }

    /// Number of particles.
    pub fn n_particles(&self) -> usize {
        self.points.len()
    }

    /// Positions of the particles (m).
    pub fn positions(&self) -> impl ExactSizeIterator<Item = Vector3<f64>> + '_ {
        self.points.iter().map(|p| Vector3::new(p[0], p[1], p[2]))
    }

    /// Sorts the particles into cells, for looking `reach` (m) around, and gives each its mass: the
    /// density `full` (kg/m³) of fluid that would just have the rest density without gaps, times its
    /// volume, which for meshes is `factor` / Σ W (Akinci2012 Eq. (5)).
    pub(crate) fn prepare(
        &mut self,
        kernel: &CubicSpline,
        (full, rest_density): (f64, f64),
        factor: f64,
        reach: f64,
    ) {
        let mut order = Vec::new();
        self.grid.build(&self.points, reach, &mut order);
        self.points = order.iter().map(|&i| self.points[i as usize]).collect();
        self.columns.fill(&self.points);
        self.grid.mark_near();
        let sum = |p: &Point, weight: &dyn Fn(usize) -> f64| -> f64 {
            let near = self.grid.rows(p).into_iter().flatten();
            let value = |q: &Point| {
                let d = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
                kernel.value(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
            };
            near.map(|j| weight(j) * value(&self.points[j])).sum()
        };
        let volume = |p: &Point| if p[3] > 0.0 { p[3] } else { factor / sum(p, &|_| 1.0) };
        let masses: Vec<f64> = self.points.iter().map(|p| full * volume(p)).collect();
        let own = |p: &Point| sum(p, &|j| masses[j]).min(rest_density);
        self.own = self.points.iter().map(own).collect();
        self.masses = masses;
    }

    /// The cells of the particles.
    pub(crate) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Adds the particles within `reach` (m) of `p` to `found`, in ascending order.
    pub(crate) fn near(&self, p: &Point, reach: f64, found: &mut Vec<u32>) {
        if self.grid.may_be_near(p) {
            let rows = self.grid.rows(p).into_iter().flatten().map(|j| j as u32);
            found.extend(
                rows.filter(|&j| squared_distance(p, &self.points[j as usize]) < reach * reach),
            );
        }
    }

    /// Coordinates of the particles.
    pub(crate) fn columns(&self) -> &Columns {
        &self.columns
    }
}

/// The particles of walls that fluid may touch until neighbours are listed again.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct WallState {
    /// Position (m) and P = p/ρ² as the accelerations have it.
    pub(crate) x: Vec<Point>,
    /// Mass (kg).
    pub(crate) mass: Vec<f64>,
    /// Density without and with fluid (kg/m³).
    pub(crate) own: Vec<f64>,
    pub(crate) density: Vec<f64>,
    /// Which particle of the walls each is.
    pub(crate) number: Vec<u32>,
    /// For each particle of the walls where it is here, or `NOWHERE`.
    place: Vec<u32>,
}

/// Not in a [`WallState`].
const NOWHERE: u32 = u32::MAX;

impl WallState {
    /// Starts anew, with nothing of these walls. Returns what there was.
    pub(crate) fn restart(&mut self, walls: &Walls) -> WallState {
        let place = vec![NOWHERE; walls.points.len()];
        std::mem::replace(self, WallState { place, ..WallState::default() })
    }

    /// Where particle `j` of the walls is; if need be it is added, as it was `before`.
    pub(crate) fn place_of(&mut self, walls: &Walls, before: &WallState, j: u32) -> u32 {
        let at = j as usize;
        if self.place[at] == NOWHERE {
            self.place[at] = self.x.len() as u32;
            let [x, y, z, _] = walls.points[at];
            let was = before.place.get(at).map_or(NOWHERE, |&place| place) as usize;
            // What is new here has no fluid within its support yet, and so no pressure.
            let term = before.x.get(was).map_or(0.0, |x| x[3]);
            self.x.push([x, y, z, term]);
            self.mass.push(walls.masses[at]);
            self.number.push(j);
            self.own.push(walls.own[at]);
            self.density.push(before.density.get(was).copied().unwrap_or(walls.own[at]));
        }
        self.place[at]
    }
}

/// Σ W over a lattice of this spacing (m): over all of it, and over a plate of two layers.
///
/// Their quotient is the `factor` of [`Walls::prepare`]: with it a plate acts on fluid at rest as the
/// whole half-space of fluid that it replaces.
pub(crate) fn lattice_sums(kernel: &CubicSpline, spacing: f64) -> (f64, f64) {
    let n = (kernel.support() / spacing).ceil() as i64;
    let layer = |z: i64| lattice_layer(kernel, spacing, z);
    ((-n..=n).map(layer).sum(), (0..LAYERS).map(layer).sum())
}

/// Σ W over the layer of the lattice in which the middle lies.
pub(crate) fn layer_sum(kernel: &CubicSpline, spacing: f64) -> f64 {
    lattice_layer(kernel, spacing, 0)
}

/// Σ W over the layer of a lattice that is `z` layers off.
fn lattice_layer(kernel: &CubicSpline, spacing: f64, z: i64) -> f64 {
    let n = (kernel.support() / spacing).ceil() as i64;
    let squared = |x: i64, y: i64| ((x * x + y * y + z * z) as f64) * spacing * spacing;
    (-n..=n).map(|y| (-n..=n).map(|x| kernel.value(squared(x, y))).sum::<f64>()).sum()
}

/// Points no closer to each other than a distance, found by offering many.
struct Samples {
    distance: f64,
    points: Vec<Vector3<f64>>,
    /// Points by cells of the size of the distance.
    cells: HashMap<[i64; 3], Vec<u32>>,
}

impl Samples {
    fn new(distance: f64) -> Self {
        Samples { distance, points: Vec::new(), cells: HashMap::new() }
    }

    /// Covers a triangle: what is offered are points of a lattice with at most `fine` (m) between them.
    fn cover(&mut self, [a, b, c]: [Vector3<f64>; 3], fine: f64) -> Result<(), FluidError> {
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        let n = (longest / fine).ceil().max(1.0);
        check_count(n * n / 20.0)?;
        let n = n as u32;
        for i in 0..=n {
            for j in 0..=n - i {
                let (s, t) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
                self.offer(a + (b - a) * s + (c - a) * t);
            }
        }
        Ok(())
    }

    fn offer(&mut self, x: Vector3<f64>) {
        let at = [x.x, x.y, x.z].map(|x| (x / self.distance).floor() as i64);
        let around = |k: usize| at[k] - 1..=at[k] + 1;
        for i in around(0) {
            for j in around(1) {
                for k in around(2) {
                    let near = self.cells.get(&[i, j, k]).map_or(&[][..], |list| list);
                    if near.iter().any(|&p| (self.points[p as usize] - x).norm() < self.distance) {
                        return;
                    }
                }
            }
        }
        self.cells.entry(at).or_default().push(self.points.len() as u32);
        self.points.push(x);
    }
}

fn check_spacing(spacing: f64) -> Result<(), FluidError> {
    match spacing.is_finite() && spacing > 0.0 {
        true => Ok(()),
        false => {
            let wanted = "positive and finite";
            Err(FluidError::OutOfRange { name: "spacing of walls", value: spacing, wanted })
        }
    }
}

fn check_count(n: f64) -> Result<(), FluidError> {
    const MOST: f64 = 1e8;
    if n > MOST { Err(FluidError::TooMany { n: n as usize }) } else { Ok(()) }
}
