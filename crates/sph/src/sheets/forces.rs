//! What surfaces do to a fluid and it to them.

use super::near::squared_distance;
use super::{Sample, Sheets};
use crate::grid::Point;
use crate::pair::{Laws, Side};
use nalgebra::Vector3;

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

    /// Gives the corners what the present forces give in a time `dt` (s).
    pub(crate) fn push(&mut self, dt: f64) {
        for (impulse, force) in self.impulses.iter_mut().zip(&self.forces) {
            *impulse += force * dt;
        }
    }

    /// Densities that the surfaces give to particles at `x` (kg/m³), into the fourth number of `by`;
    /// whose has changed is noted.
    pub(crate) fn densities(&mut self, laws: &Laws, x: &[Point], by: &mut [Point]) {
        self.changed.clear();
        let mut k = 0;
        for (i, by) in by.iter_mut().enumerate() {
            let mut density = 0.0;
            if self.near.who.get(k).is_some_and(|&who| who as usize == i) {
                let mut nearest = f64::INFINITY;
                for &s in self.near.samples(k) {
                    let place = &self.places[s as usize];
                    let squared = squared_distance(&x[i], place);
                    nearest = nearest.min(squared);
                    density += place[3] * laws.kernel.value(squared);
                }
                self.near.nearest[k] = nearest;
                k += 1;
            }
            if by[3] != density {
                by[3] = density;
                self.changed.push(i as u32);
            }
        }
    }

    /// Accelerations by the surfaces (m/s²), added to `a` and kept in `by`, which must have none; and
    /// the forces on the corners, exactly opposite but for rounding.
    pub(crate) fn accelerations(
        &mut self,
        laws: &Laws,
        x: &[Point],
        w: &[Point],
        a: &mut [Point],
        by: &mut [Point],
    ) {
        self.on_samples.fill([0.0; 3]);
        let support_squared = laws.kernel.support() * laws.kernel.support();
        for (k, &i) in self.near.who.iter().enumerate() {
            let i = i as usize;
            let mut sum = [0.0; 3];
            for &s in self.near.samples(k) {
                let (place, v) = (&self.places[s as usize], &self.velocities[s as usize]);
                let squared = squared_distance(&x[i], place);
                if squared >= support_squared {
                    continue;
                }
                let relative = [w[i][0] - v[0], w[i][1] - v[1], w[i][2] - v[2], w[i][3]];
                let here = Side::new(&x[i], &relative);
                let slope = laws.kernel.slope_over_r(squared);
                let at = [place[0], place[1], place[2]];
                let by = laws.by_wall(&here, &at, 0.0, place[3], slope);
                let back = &mut self.on_samples[s as usize];
                for c in 0..3 {
                    sum[c] += by[c];
                    back[c] -= laws.mass * by[c];
                }
            }
            for c in 0..3 {
                by[i][c] = sum[c];
                a[i][c] += sum[c];
            }
        }
        self.forces.fill(Vector3::zeros());
        for (sample, force) in self.samples.iter().zip(&self.on_samples) {
            let corners = self.triangles[sample.triangle as usize];
            for (corner, weight) in corners.into_iter().zip(sample.weights) {
                self.forces[corner as usize] += Vector3::from(*force) * weight;
            }
        }
    }

    /// Calls `give` with every particle that surfaces touch, every corner that it touches, and the share
    /// that the corner has in it: for a particle they add up to one.
    pub(crate) fn shares(
        &self,
        laws: &Laws,
        x: &[Point],
        mut give: impl FnMut(usize, usize, f64),
    ) {
        for (k, &i) in self.near.who.iter().enumerate() {
            let i = i as usize;
            let weight = |s: u32| {
                let place = &self.places[s as usize];
                place[3] * laws.kernel.value(squared_distance(&x[i], place))
            };
            let all: f64 = self.near.samples(k).iter().map(|&s| weight(s)).sum();
            if all <= 0.0 {
                continue;
            }
            for &s in self.near.samples(k) {
                let share = weight(s) / all;
                if share > 0.0 {
                    let Sample { triangle, weights, .. } = self.samples[s as usize];
                    let corners = self.triangles[triangle as usize];
                    for (corner, weight) in corners.into_iter().zip(weights) {
                        give(i, corner as usize, share * weight);
                    }
                }
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
