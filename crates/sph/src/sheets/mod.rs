//! Surfaces that move through a fluid: cloth and bodies, without thickness, wet on both sides.
//!
//! What they do to the fluid the corners of their triangles suffer, by barycentric weights, see
//! `forces`. That keeps fluid half a spacing off; what it fails to do `side` does: no particle comes to
//! the other side of a surface. Triangles near a particle are found by points that sample them.

mod forces;
mod meet;
mod near;
mod remade;
mod side;
mod triangle;

use crate::grid::Point;
use crate::settings::{Bounds, FluidError};
pub(crate) use forces::Surface;
use forces::Touch;
use nalgebra::Vector3;
use near::Near;

/// Edges of the parts that samples stand for are no longer than this, in spacings (1).
const PART: f64 = 0.75;
/// No point of a part is farther from its middle than two thirds of its longest edge (1).
const FARTHEST: f64 = 2.0 / 3.0 * PART;
/// Most samples of all surfaces.
const MOST_SAMPLES: f64 = 2e7;

/// Triangles that move through a fluid, see [`Fluid::advance_among`](crate::Fluid::advance_among).
#[derive(Clone, Debug)]
pub struct Sheets {
    triangles: Vec<[u32; 3]>,
    spacing: f64,
    /// Corners at the start and at the end of the time that goes by, now, and after the present step
    /// (m).
    from: Vec<Vector3<f64>>,
    to: Vec<Vector3<f64>>,
    x: Vec<Vector3<f64>>,
    next: Vec<Vector3<f64>>,
    /// Ways from start to end (m), and the longest.
    ways: Vec<Vector3<f64>>,
    longest_way: f64,
    /// The time from start to end (s), and what of it has gone by (1).
    duration: f64,
    gone: f64,
    samples: Vec<Sample>,
    /// Places of samples (m), and 0.
    places: Vec<Point>,
    /// Velocities of the corners (m/s).
    velocities: Vec<Vector3<f64>>,
    near: Near,
    /// What touches, by ascending particles, and the forces on corners by it (N).
    touches: Vec<Touch>,
    forces: Vec<Vector3<f64>>,
    /// What the corners have got since the start (N s).
    impulses: Vec<Vector3<f64>>,
    /// Particles with another density by surfaces than before the step.
    pub(crate) changed: Vec<u32>,
}

/// A part of a triangle.
#[derive(Clone, Copy, Debug)]
struct Sample {
    triangle: u32,
    /// Barycentric coordinates of its middle (1).
    weights: [f64; 3],
}

impl Sheets {
    /// Surfaces of these triangles, for a fluid of particles at a `spacing` (m). They have `n_corners`
    /// corners, which are where [`Sheets::place`] puts them.
    ///
    /// # Errors
    /// If a triangle has a corner that does not exist.
    pub fn new(
        triangles: Vec<[u32; 3]>,
        n_corners: usize,
        spacing: f64,
    ) -> Result<Self, FluidError> {
        for (triangle, c) in triangles.iter().enumerate() {
            if let Some(&corner) = c.iter().find(|&&corner| corner as usize >= n_corners) {
                return Err(FluidError::Corner { triangle, corner, n_corners });
            }
        }
        let zeros = vec![Vector3::zeros(); n_corners];
        Ok(Sheets {
            triangles,
            spacing,
            from: zeros.clone(),
            to: zeros.clone(),
            x: zeros.clone(),
            next: zeros.clone(),
            ways: zeros.clone(),
            longest_way: 0.0,
            duration: 0.0,
            gone: 0.0,
            samples: Vec::new(),
            places: Vec::new(),
            velocities: zeros.clone(),
            near: Near::default(),
            touches: Vec::new(),
            forces: zeros.clone(),
            impulses: zeros,
            changed: Vec::new(),
        })
    }

    /// Puts the corners in their places (m), where they stay.
    ///
    /// # Errors
    /// As for [`Sheets::move_between`].
    pub fn place(&mut self, x: &[Vector3<f64>]) -> Result<(), FluidError> {
        self.move_between(x, x)
    }

    /// Lets the corners go on straight ways from one place (m) to another in the time that is advanced
    /// next. What they have got from the fluid is counted from now on.
    ///
    /// # Errors
    /// If the lists have not the right length, a place is not finite, or the surfaces are too large for
    /// the spacing.
    pub fn move_between(
        &mut self,
        from: &[Vector3<f64>],
        to: &[Vector3<f64>],
    ) -> Result<(), FluidError> {
        let expected = self.from.len();
        for (list, what) in [(from, "corners at the start"), (to, "corners at the end")] {
            if list.len() != expected {
                return Err(FluidError::Length { what, found: list.len(), expected });
            }
            if let Some(bad) = list.iter().flat_map(Vector3::iter).find(|c| !c.is_finite()) {
                let (name, wanted) = ("coordinate of a surface", "finite");
                return Err(FluidError::OutOfRange { name, value: *bad, wanted });
            }
        }
        let parts = |c: &[u32; 3]| {
            let longest = |x: &[Vector3<f64>]| {
                let [a, b, c] = c.map(|k| x[k as usize]);
                (b - a).norm().max((c - b).norm()).max((a - c).norm())
            };
            (longest(from).max(longest(to)) / (PART * self.spacing)).ceil().max(1.0)
        };
        let parts: Vec<f64> = self.triangles.iter().map(parts).collect();
        let n: f64 = parts.iter().map(|n| n * n).sum();
        if n > MOST_SAMPLES {
            return Err(FluidError::TooMany { n: n as usize });
        }
        self.from.copy_from_slice(from);
        self.to.copy_from_slice(to);
        self.x.copy_from_slice(from);
        self.longest_way = 0.0;
        for ((way, from), to) in self.ways.iter_mut().zip(from).zip(to) {
            *way = to - from;
            self.longest_way = self.longest_way.max(way.norm());
        }
        self.samples.clear();
        for (triangle, &n) in (0..).zip(&parts) {
            sample(triangle, n as u32, &mut self.samples);
        }
        self.impulses.fill(Vector3::zeros());
        (self.gone, self.duration) = (0.0, 0.0);
        self.near.forget();
        Ok(())
    }

    /// What every corner has got from the fluid since its motion was given (N s).
    pub fn impulses(&self) -> &[Vector3<f64>] {
        &self.impulses
    }

    /// A box around the corners, all along their ways (m); `None` if there are none.
    pub fn bounds(&self) -> Option<Bounds> {
        let mut all = self.from.iter().chain(&self.to);
        let first = all.next()?;
        let start = Bounds::new(*first, *first);
        Some(all.fold(start, |b, x| Bounds::new(b.min.inf(x), b.max.sup(x))))
    }

    /// Sets the time (s) in which the corners go their ways; 0 if they stand still.
    pub(crate) fn start(&mut self, duration: f64) {
        (self.duration, self.gone) = (duration, 0.0);
        for (v, way) in self.velocities.iter_mut().zip(&self.ways) {
            *v = if duration > 0.0 { way / duration } else { Vector3::zeros() };
        }
        self.places.clear();
        self.places.resize(self.samples.len(), [0.0; 4]);
        self.put_samples();
    }

    /// The greatest speed of a corner (m/s).
    pub(crate) fn speed(&self) -> f64 {
        if self.longest_way > 0.0 { self.longest_way / self.duration } else { 0.0 }
    }

    /// Finds where the corners are after a step of `dt` (s); they do not go there yet.
    pub(crate) fn begin_step(&mut self, dt: f64) {
        let gone = self.gone + dt / self.duration;
        // The last step ends where the next motion begins, to the bit.
        let is_last = gone > 1.0 - 1e-9;
        for (((next, from), to), way) in
            self.next.iter_mut().zip(&self.from).zip(&self.to).zip(&self.ways)
        {
            *next = if is_last { *to } else { from + way * gone };
        }
        self.gone = gone;
    }

    /// Puts the corners where they are after the step.
    pub(crate) fn end_step(&mut self) {
        std::mem::swap(&mut self.x, &mut self.next);
        if self.longest_way > 0.0 {
            self.put_samples();
        }
    }

    fn put_samples(&mut self) {
        for (place, sample) in self.places.iter_mut().zip(&self.samples) {
            let corners = self.triangles[sample.triangle as usize].map(|k| self.x[k as usize]);
            let x = triangle::at(&sample.weights, &corners);
            *place = [x.x, x.y, x.z, 0.0];
        }
    }
}

/// The parts of a triangle: `n` along each edge.
fn sample(triangle: u32, n: u32, samples: &mut Vec<Sample>) {
    let mut push = |s: f64, t: f64| {
        let (s, t) = (s / f64::from(n), t / f64::from(n));
        samples.push(Sample { triangle, weights: [1.0 - s - t, s, t] });
    };
    for i in 0..n {
        for j in 0..n - i {
            let (s, t) = (f64::from(i), f64::from(j));
            push(s + 1.0 / 3.0, t + 1.0 / 3.0);
            if i + j + 2 <= n {
                push(s + 2.0 / 3.0, t + 2.0 / 3.0);
            }
        }
    }
}
