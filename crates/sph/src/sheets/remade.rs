//! Surfaces that are made of other triangles than before, as remeshed cloth is.

use super::forces::Touch;
use super::side::FLOOR;
use super::{Sheets, triangle};
use crate::fluid::{Fluid, hardest};
use crate::report::Seconds;
use arps::Restraint;
use nalgebra::Vector3;

/// Cosine of the angle between a normal and the way to a particle, above which it is clear on which side
/// the particle is: beyond an edge it is on none.
const CLEAR: f64 = 0.5;

impl<R: Restraint> Fluid<R> {
    /// Puts particles back on their sides of surfaces that stand still, where `old` triangles have been
    /// replaced by `new` ones nearly in the same places. Returns how many had come to the other side.
    pub fn keep_sides(&mut self, old: &mut Sheets, new: &mut Sheets) -> usize {
        for sheets in [&mut *old, &mut *new] {
            sheets.start(0.0);
            sheets.forget_particles();
            sheets.list(&self.laws, &self.state.x, 0.0);
            sheets.find_touches(&self.laws, &self.state.x);
        }
        let mut before = old.touches.iter().peekable();
        let mut n = 0;
        for touch in &new.touches {
            while before.next_if(|old| old.particle < touch.particle).is_some() {}
            let Some(was) = before.next_if(|old| old.particle == touch.particle) else { continue };
            let sides = [old.side(was), new.side(touch)];
            if sides[0] * sides[1] < 0.0 && sides.iter().all(|side| side.abs() > CLEAR) {
                let corners = new.corners(touch.triangle);
                let off = touch.distance.max(FLOOR * new.spacing);
                let x = triangle::at(&touch.weights, &corners) - touch.normal * off;
                self.state.x[touch.particle as usize][..3].copy_from_slice(x.as_slice());
                n += 1;
            }
        }
        if n > 0 {
            self.list_neighbours();
            self.evaluate_all(&mut Seconds::default());
            self.state.by_sheets.iter_mut().for_each(|by| by[..3].fill(0.0));
            self.hardest = hardest(&self.state.a);
        }
        n
    }
}

impl Sheets {
    /// Where the corners of a triangle are (m).
    fn corners(&self, triangle: u32) -> [Vector3<f64>; 3] {
        self.triangles[triangle as usize].map(|c| self.x[c as usize])
    }

    /// The cosine of the angle between the normal of the triangle and the way to the particle.
    fn side(&self, touch: &Touch) -> f64 {
        let [a, b, c] = self.corners(touch.triangle);
        let normal = (b - a).cross(&(c - a));
        normal.try_normalize(0.0).map_or(0.0, |normal| normal.dot(&touch.normal))
    }
}
