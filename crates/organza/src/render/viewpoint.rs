//! Where a picture is taken from, and how to frame a scene.

use nalgebra::{Vector2, Vector3};

use super::{Bounds, Size};

/// Where a picture is taken from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewpoint {
    /// Place of the eye (m).
    pub eye: [f64; 3],
    /// Place seen in the middle of the picture; its distance also sets the nearest depth that is
    /// drawn, a thousandth of it (m).
    pub target: [f64; 3],
    /// Direction that points up in the picture; any length (1).
    pub up: [f64; 3],
    /// Angle between the top and the bottom of the picture (rad).
    pub vertical_fov: f64,
}

/// Coordinates beyond this are taken for broken: their squares and products would overflow.
pub(super) const FARTHEST: f64 = 1e60;

impl Viewpoint {
    /// Vertical field of view of [`Viewpoint::fit`] (rad): 28°, a slight telephoto lens.
    const FOV: f64 = 28.0 * std::f64::consts::PI / 180.0;
    /// Part of the picture kept free on every side by [`Viewpoint::fit`], of half its size.
    const MARGIN: f64 = 0.10;
    /// Turn away from the broad side (rad): 28°.
    const TURN: f64 = 28.0 * std::f64::consts::PI / 180.0;

    /// Frames all `points` (m) in a picture of `size` from a three-quarter direction.
    ///
    /// `up` is the direction against gravity; a zero or broken `up` counts as +z. The eye looks at
    /// the broad side of the points, turned and raised a little, more where the points lie flat. For
    /// a sequence give the corners of the [`Bounds`] of all its frames, so that the picture stands
    /// still. Points that are not finite are ignored; without any, the eye looks at the origin.
    ///
    /// The points are gone through five times.
    pub fn fit<I>(points: I, up: [f64; 3], size: Size) -> Self
    where
        I: IntoIterator<Item = [f64; 3]>,
        I::IntoIter: Clone,
    {
        let points =
            points.into_iter().filter(|p| p.iter().all(|x| x.abs() <= FARTHEST)).map(Vector3::from);
        let bounds = Bounds::of(points.clone().map(Into::into));
        let (centre, radius) = if bounds.is_empty() {
            (Vector3::zeros(), 0.0)
        } else {
            let (min, max) = (Vector3::from(bounds.min), Vector3::from(bounds.max));
            ((min + max) / 2.0, (max - min).norm() / 2.0)
        };
        let radius = if radius > 0.0 { radius } else { 1.0 };

        let up = direction(up.into()).unwrap_or(Vector3::z());
        let offsets = points.map(|p| (p - centre) / radius);
        let back = three_quarter(offsets.clone(), up);
        let right = up.cross(&back).normalize();
        let top = back.cross(&right);

        // The eye sits at e = (ex, ey, ez) in these axes. A point (x, y, z) is inside the picture
        // where |x - ex| ≤ tan_x (ez - z), and so for y: four half-spaces, whose tightest positions
        // give the nearest eye in closed form.
        let tan_y = (Self::FOV / 2.0).tan() * (1.0 - Self::MARGIN);
        let tan_x = tan_y * size.aspect();
        let mut side = [f64::NEG_INFINITY; 4];
        let mut nearest = f64::NEG_INFINITY;
        for offset in offsets.clone() {
            let (x, y, z) = (offset.dot(&right), offset.dot(&top), offset.dot(&back));
            let reach = [x + tan_x * z, -x + tan_x * z, y + tan_y * z, -y + tan_y * z];
            side = std::array::from_fn(|i| side[i].max(reach[i]));
            nearest = nearest.max(z);
        }
        if nearest == f64::NEG_INFINITY {
            (side, nearest) = ([0.0; 4], 0.0);
        }
        let (mut ex, mut ey) = ((side[0] - side[1]) / 2.0, (side[2] - side[3]) / 2.0);
        let distance_x = (side[0] + side[1]) / (2.0 * tan_x);
        let distance_y = (side[2] + side[3]) / (2.0 * tan_y);
        // Never closer than a radius: points in line with the eye would put it among them.
        let ez = distance_x.max(distance_y).max(nearest + 1.0);

        // Where one pair of half-spaces leaves room, the points move to the middle of the picture.
        // Two rounds are enough for the eye; the half-spaces hold throughout.
        for _ in 0..2 {
            let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
            for offset in offsets.clone() {
                let depth = ez - offset.dot(&back);
                let slope = [(offset.dot(&right) - ex) / depth, (offset.dot(&top) - ey) / depth];
                for k in 0..2 {
                    (low[k], high[k]) = (low[k].min(slope[k]), high[k].max(slope[k]));
                }
            }
            if low[0] <= high[0] {
                let (x, y) =
                    (ex + (low[0] + high[0]) / 2.0 * ez, ey + (low[1] + high[1]) / 2.0 * ez);
                ex = x.max(side[0] - tan_x * ez).min(tan_x * ez - side[1]);
                ey = y.max(side[2] - tan_y * ez).min(tan_y * ez - side[3]);
            }
        }

        let target = centre + (right * ex + top * ey) * radius;
        let eye = target + back * (ez * radius);
        Self { eye: eye.into(), target: target.into(), up: up.into(), vertical_fov: Self::FOV }
    }
}

/// Unit vector along `v`, if it has a direction.
pub(super) fn direction(v: Vector3<f64>) -> Option<Vector3<f64>> {
    // Divided first by its largest part, since the square of a very long or short vector would
    // overflow or vanish.
    let largest = v.amax();
    (largest > 0.0 && v.iter().all(|x| x.is_finite())).then(|| (v / largest).normalize())
}

/// Direction from the scene to the eye. `offsets` are the points from their centre, at most of unit
/// length.
fn three_quarter(offsets: impl Iterator<Item = Vector3<f64>>, up: Vector3<f64>) -> Vector3<f64> {
    // The horizontal axis that runs to the right when nothing else decides: x, or y where x is up.
    let hint = if up.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
    let right = (hint - up * hint.dot(&up)).normalize();
    let back = right.cross(&up);

    let (mut count, mut sum) = (0.0, Vector3::zeros());
    let mut square = [0.0; 4];
    for offset in offsets {
        let (a, b, h) = (offset.dot(&right), offset.dot(&back), offset.dot(&up));
        count += 1.0;
        sum += Vector3::new(a, b, h);
        square = [square[0] + a * a, square[1] + a * b, square[2] + b * b, square[3] + h * h];
    }
    if count > 0.0 {
        let mean = sum / count;
        square[0] = square[0] / count - mean.x * mean.x;
        square[1] = square[1] / count - mean.x * mean.y;
        square[2] = square[2] / count - mean.y * mean.y;
        square[3] = (square[3] / count - mean.z * mean.z).max(0.0);
    }
    let [aa, ab, bb, hh] = square;
    let half = (aa + bb) / 2.0;
    let spread = ((aa - bb) / 2.0).hypot(ab);
    // Broad side only where it is clearly broader; otherwise noise would choose.
    let broad = if spread > 0.15 * half {
        let angle = 0.5 * (2.0 * ab).atan2(aa - bb);
        Vector2::new(angle.cos(), angle.sin())
    } else {
        Vector2::x()
    };
    let (right, back) = (right * broad.x + back * broad.y, back * broad.x - right * broad.y);

    // From 14° above the horizon for upright scenes to 34° for flat ones.
    let flatness = if half > 0.0 { half / (half + 2.0 * hh) } else { 0.5 };
    let elevation = (14.0 + 20.0 * flatness * flatness).to_radians();
    let (turn_sin, turn_cos) = Viewpoint::TURN.sin_cos();
    let level = back * turn_cos + right * turn_sin;
    level * elevation.cos() + up * elevation.sin()
}
