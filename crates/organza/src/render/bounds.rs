//! A box around points, for framing and for the floor.

/// A box along the axes around everything it was shown.
///
/// For a sequence, include the points of every frame, then frame the [`corners`](Self::corners)
/// with [`Viewpoint::fit`](super::Viewpoint::fit).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lowest coordinates (m).
    pub min: [f64; 3],
    /// Highest coordinates (m).
    pub max: [f64; 3],
}

impl Bounds {
    /// The box around nothing.
    pub const EMPTY: Self = Self { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] };

    /// The box around `points` (m).
    pub fn of(points: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let mut bounds = Self::EMPTY;
        bounds.extend(points);
        bounds
    }

    /// Whether nothing was included.
    pub fn is_empty(&self) -> bool {
        self.min[0] > self.max[0]
    }

    /// Grows the box to hold `point` (m). A point that is not finite is ignored.
    pub fn include(&mut self, point: [f64; 3]) {
        if point.iter().all(|x| x.is_finite()) {
            for i in 0..3 {
                self.min[i] = self.min[i].min(point[i]);
                self.max[i] = self.max[i].max(point[i]);
            }
        }
    }

    /// The eight corners (m); not finite if the box is empty.
    pub fn corners(&self) -> [[f64; 3]; 8] {
        std::array::from_fn(|i| {
            std::array::from_fn(|k| if i >> k & 1 == 0 { self.min[k] } else { self.max[k] })
        })
    }

    /// The lowest height of the box along `up`, which need not have unit length (m): where a floor
    /// touches the box. `None` if the box is empty or `up` has no direction.
    pub fn lowest(&self, up: [f64; 3]) -> Option<f64> {
        let length = up.iter().map(|x| x * x).sum::<f64>().sqrt();
        if self.is_empty() || !(length > 0.0 && length.is_finite()) {
            return None;
        }
        let heights =
            self.corners().map(|corner| (0..3).map(|k| corner[k] * up[k] / length).sum::<f64>());
        heights.into_iter().reduce(f64::min)
    }
}

impl Extend<[f64; 3]> for Bounds {
    fn extend<T: IntoIterator<Item = [f64; 3]>>(&mut self, points: T) {
        for point in points {
            self.include(point);
        }
    }
}
