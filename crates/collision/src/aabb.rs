//! Axis-aligned boxes.

use mesh_core::World3;

/// A closed axis-aligned box: all points with `lo ≤ x ≤ hi` on every axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates (m).
    pub lo: [f64; 3],
    /// Largest coordinates (m).
    pub hi: [f64; 3],
}

impl Aabb {
    /// The box without points: it overlaps nothing, and its union with a box is that box.
    pub const EMPTY: Aabb = Aabb { lo: [f64::INFINITY; 3], hi: [f64::NEG_INFINITY; 3] };

    /// The smallest box around some points (m). A coordinate that is not a number is as if absent.
    #[inline]
    pub fn around<'a>(points: impl IntoIterator<Item = &'a World3>) -> Aabb {
        let mut all = Aabb::EMPTY;
        for x in points {
            for k in 0..3 {
                all.lo[k] = all.lo[k].min(x[k]);
                all.hi[k] = all.hi[k].max(x[k]);
            }
        }
        all
    }

    /// The smallest box that contains both.
    #[inline]
    #[must_use]
    pub fn union(&self, other: &Aabb) -> Aabb {
        let mut all = *self;
        for k in 0..3 {
            all.lo[k] = all.lo[k].min(other.lo[k]);
            all.hi[k] = all.hi[k].max(other.hi[k]);
        }
        all
    }

    /// The box grown by `margin` ≥ 0 (m) on every side, rounded outwards: it certainly contains every
    /// point whose coordinates are within the margin of the box.
    #[inline]
    #[must_use]
    pub fn grown(&self, margin: f64) -> Aabb {
        if margin == 0.0 {
            return *self;
        }
        Aabb {
            lo: self.lo.map(|x| (x - margin).next_down()),
            hi: self.hi.map(|x| (x + margin).next_up()),
        }
    }

    /// True if the boxes have a point in common.
    #[inline]
    pub fn overlaps(&self, other: &Aabb) -> bool {
        // Without short cuts: six comparisons are cheaper than a branch that is hard to foresee.
        (self.lo[0] <= other.hi[0])
            & (self.lo[1] <= other.hi[1])
            & (self.lo[2] <= other.hi[2])
            & (other.lo[0] <= self.hi[0])
            & (other.lo[1] <= self.hi[1])
            & (other.lo[2] <= self.hi[2])
    }

    /// Sum of the three edge lengths (m); 0 for the empty box.
    #[inline]
    pub fn extent(&self) -> f64 {
        (0..3).map(|k| (self.hi[k] - self.lo[k]).max(0.0)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_empty_box_is_neutral_and_overlaps_nothing() {
        let unit = Aabb { lo: [0.0; 3], hi: [1.0; 3] };
        assert_eq!(Aabb::EMPTY.union(&unit), unit);
        assert!(!Aabb::EMPTY.overlaps(&unit) && !unit.overlaps(&Aabb::EMPTY));
        assert!(!Aabb::EMPTY.overlaps(&Aabb::EMPTY));
        assert_eq!(Aabb::EMPTY.extent(), 0.0);
    }

    #[test]
    fn what_is_no_number_counts_as_absent() {
        let odd = World3::new(f64::NAN, 1.0, 2.0);
        let around = Aabb::around(&[odd, World3::zeros(), odd]);
        assert_eq!(around, Aabb { lo: [0.0; 3], hi: [0.0, 1.0, 2.0] });
    }

    #[test]
    fn boxes_are_closed() {
        let unit = Aabb { lo: [0.0; 3], hi: [1.0; 3] };
        let corner = Aabb { lo: [1.0; 3], hi: [2.0; 3] };
        assert!(unit.overlaps(&corner) && corner.overlaps(&unit));
        let beyond = Aabb { lo: [1.0, 1.0, 1.0f64.next_up()], hi: [2.0; 3] };
        assert!(!unit.overlaps(&beyond));
    }

    #[test]
    fn growing_rounds_outwards() {
        // 1e6 - 1e-11 rounds to 1e6: growing to nearest would lose a point 1e-11 away.
        let at = Aabb::around([&World3::new(1e6, 0.0, -1e6)]).grown(1e-11);
        assert!(at.lo[0] < 1e6 && at.hi[0] > 1e6 && at.lo[2] < -1e6 && at.hi[2] > -1e6);
    }
}
