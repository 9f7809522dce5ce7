//! What surfaces do to a fluid and it to them.
//!
//! A particle is touched by the point of all surfaces that is closest to it, as by the border of a half
//! space of fluid. What lies behind adds ρ₀ A (c − d)² to its density, at a distance d < c in spacings.
//! Two conditions set A and c: half a spacing off, where the first layer of a lattice lies, it makes up
//! for the share f of the density that is missing behind, and bears there the pressure that the layer
//! has, that is, its slope is ρ₀ per spacing: c = 1/2 + 2f, A = 1/4f. The force is the gradient of the
//! energy, and the surface has it the other way round, at the point that touches.

use super::{FARTHEST, Sheets, triangle};
use crate::grid::Point;
use crate::pair::Laws;
use crate::place::squared_distance;
use nalgebra::Vector3;

/// A particle and the point of the surfaces that is closest to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    pub(super) particle: u32,
    pub(super) triangle: u32,
    /// Barycentric coordinates of the point (1).
    pub(super) weights: [f64; 3],
    /// From the point to the particle (1), and how far (m).
    pub(super) normal: Vector3<f64>,
    pub(super) distance: f64,
}

impl Sheets {
    /// Lists the samples around particles at `x`, if need be; `ahead` (m) is how far samples and
    /// particles will come towards each other before [`Sheets::end_step`].
    pub(crate) fn list(&mut self, laws: &Laws, x: &[Point], ahead: f64) {
        self.near.list(x, &self.places, [laws.kernel.support(), self.spacing, ahead]);
    }

    /// The particles are in another order, or others.
    pub(crate) fn forget_particles(&mut self) {
        self.near.forget();
    }

    /// Notes how far (m) particles and samples have come towards each other at most.
    pub(crate) fn travel(&mut self, way: f64) {
        self.near.travel(way);
    }

    /// Gives the corners what the present forces give in a time `dt` (s), and notes in `given` by which
    /// particles, which have this `mass` (kg).
    pub(crate) fn push(&mut self, (dt, mass): (f64, f64), by: &[Point], given: &mut [Point]) {
        for (by, given) in by.iter().zip(given) {
            (0..3).for_each(|c| given[c] -= mass * dt * by[c]);
        }
        for (impulse, force) in self.impulses.iter_mut().zip(&self.forces) {
            *impulse += force * dt;
        }
    }

    /// Finds what touches whom, for particles at `x`.
    pub(crate) fn find_touches(&mut self, laws: &Laws, x: &[Point]) {
        self.touches.clear();
        let reach = laws.surface.reach;
        for k in 0..self.near.who.len() {
            let touch = self.closest(k, x, reach);
            self.touches.extend(touch.filter(|touch| touch.distance < reach));
        }
    }

    /// The point of the surfaces closest to the `k`th particle that they are near, if it may be within
    /// `reach` (m); notes how far its nearest sample is.
    fn closest(&mut self, k: usize, x: &[Point], reach: f64) -> Option<Touch> {
        let particle = self.near.who[k];
        let p = &x[particle as usize];
        let squared = |s: &u32| squared_distance(p, &self.places[*s as usize]);
        let nearest = self.near.samples(k).iter().map(squared).fold(f64::INFINITY, f64::min);
        self.near.nearest[k] = nearest;
        // Whatever is closer than a sample belongs to one that is no farther than this.
        let farthest = nearest.sqrt() + FARTHEST * self.spacing;
        if nearest.sqrt() > reach + FARTHEST * self.spacing {
            return None;
        }
        let x = Vector3::new(p[0], p[1], p[2]);
        let (mut found, mut last): (Option<Touch>, u32) = (None, u32::MAX);
        for s in self.near.samples(k) {
            let name = self.samples[*s as usize].triangle;
            if name == last || squared(s) > farthest * farthest {
                continue;
            }
            last = name;
            let corners = self.triangles[name as usize].map(|c| self.x[c as usize]);
            let weights = triangle::closest(&x, &corners);
            let off = x - triangle::at(&weights, &corners);
            let distance = off.norm();
            if found.is_none_or(|found| distance < found.distance) {
                let normal = if distance > 0.0 { off / distance } else { Vector3::zeros() };
                found = Some(Touch { particle, triangle: name, weights, normal, distance });
            }
        }
        found
    }

    /// Densities that the surfaces give to the particles that they touch (kg/m³), into the fourth
    /// number of `by`; whose has changed is noted.
    pub(crate) fn densities(&mut self, laws: &Laws, by: &mut [Point]) {
        self.changed.clear();
        let mut touches = self.touches.iter().peekable();
        for (i, by) in by.iter_mut().enumerate() {
            let touch = touches.next_if(|touch| touch.particle as usize == i);
            let density = touch.map_or(0.0, |touch| laws.surface.density(touch.distance));
            if by[3] != density {
                by[3] = density;
                self.changed.push(i as u32);
            }
        }
    }

    /// Accelerations by the surfaces (m/s²), added to `a` and kept in `by`, which must have none; and
    /// the forces on the corners, opposite but for rounding.
    pub(crate) fn accelerations(
        &mut self,
        laws: &Laws,
        x: &[Point],
        w: &[Point],
        a: &mut [Point],
        by: &mut [Point],
    ) {
        self.forces.fill(Vector3::zeros());
        for touch in &self.touches {
            let i = touch.particle as usize;
            let corners = self.triangles[touch.triangle as usize];
            let v = triangle::at(&touch.weights, &corners.map(|c| self.velocities[c as usize]));
            let opening = (Vector3::new(w[i][0], w[i][1], w[i][2]) - v).dot(&touch.normal);
            let push = touch.normal * laws.by_surface(x[i][3], w[i][3], touch.distance, opening);
            for c in 0..3 {
                by[i][c] = push[c];
                a[i][c] += push[c];
            }
            for (corner, weight) in corners.into_iter().zip(touch.weights) {
                self.forces[corner as usize] -= push * (laws.mass * weight);
            }
        }
    }

    /// Calls `give` with every particle within the support of a surface, the corners of the triangle
    /// that is closest to it, and the share of each in it: for a particle they add up to one.
    pub(crate) fn shares(
        &mut self,
        laws: &Laws,
        x: &[Point],
        mut give: impl FnMut(usize, usize, f64),
    ) {
        let reach = laws.kernel.support();
        for k in 0..self.near.who.len() {
            let touch = self.closest(k, x, reach);
            let Some(touch) = touch.filter(|touch| touch.distance < reach) else { continue };
            let corners = self.triangles[touch.triangle as usize];
            for (corner, weight) in corners.into_iter().zip(touch.weights) {
                give(touch.particle as usize, corner as usize, weight);
            }
        }
    }

    /// Gives the corners of a triangle an impulse (N s) at a point of it.
    pub(super) fn hit(&mut self, triangle: u32, weights: &[f64; 3], impulse: &Vector3<f64>) {
        for (corner, weight) in self.triangles[triangle as usize].into_iter().zip(weights) {
            self.impulses[corner as usize] += impulse * *weight;
        }
    }
}

/// Takes the accelerations by surfaces, kept in `by`, away from all, and forgets them.
pub(crate) fn take_away(a: &mut [Point], by: &mut [Point]) {
    for (a, by) in a.iter_mut().zip(by) {
        for c in 0..3 {
            a[c] -= by[c];
            by[c] = 0.0;
        }
    }
}

/// What a surface adds to the density of a particle, by its distance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    /// Distance from which on it adds nothing (m).
    pub(crate) reach: f64,
    /// ρ₀ A per squared spacing (kg/m⁵).
    scale: f64,
}

impl Surface {
    /// For a fluid in which the share `missing` (1) of the density comes from the layers behind one.
    pub(crate) fn new(missing: f64, spacing: f64, rest_density: f64) -> Self {
        let scale = rest_density / (4.0 * missing * spacing * spacing);
        Surface { reach: (0.5 + 2.0 * missing) * spacing, scale }
    }

    /// At a distance (m) within its reach (kg/m³).
    pub(crate) fn density(&self, distance: f64) -> f64 {
        let depth = self.reach - distance;
        self.scale * depth * depth
    }

    /// How much less that is farther off (kg/m⁴).
    pub(crate) fn slope(&self, distance: f64) -> f64 {
        2.0 * self.scale * (self.reach - distance)
    }
}
