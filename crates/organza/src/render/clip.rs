//! Cutting triangles and segments to what the rasteriser can take.

use nalgebra::Vector3;

/// The points with `normal · p ≥ offset`.
pub(super) struct HalfSpace {
    pub(super) normal: Vector3<f64>,
    pub(super) offset: f64,
}

impl HalfSpace {
    fn height(&self, p: &Vector3<f64>) -> f64 {
        self.normal.dot(p) - self.offset
    }
}

/// Columns and rows kept are within this of zero (px): 2^15, so that the products of snapped
/// coordinates, 2^24 each, stay far from the end of 64-bit integers.
const GUARD_PX: f64 = 32768.0;

/// The half-spaces in which projected geometry must lie: beyond `near`, and inside the guard band.
pub(super) fn guard(near: f64) -> [HalfSpace; 5] {
    let half = |x, y, z, offset| HalfSpace { normal: Vector3::new(x, y, z), offset };
    [
        half(0.0, 0.0, 1.0, near),
        half(1.0, 0.0, GUARD_PX, 0.0),
        half(-1.0, 0.0, GUARD_PX, 0.0),
        half(0.0, 1.0, GUARD_PX, 0.0),
        half(0.0, -1.0, GUARD_PX, 0.0),
    ]
}

/// Corners of a triangle clipped by six half-spaces: each adds at most one.
const MOST_CORNERS: usize = 9;

/// A convex polygon.
pub(super) struct Polygon {
    corners: [Vector3<f64>; MOST_CORNERS],
    n_corners: usize,
}

impl Polygon {
    fn push(&mut self, corner: Vector3<f64>) {
        // Rounding might make a polygon not quite convex and give a corner more than there should
        // be; it is left out.
        if self.n_corners < self.corners.len() {
            self.corners[self.n_corners] = corner;
            self.n_corners += 1;
        }
    }

    pub(super) fn corners(&self) -> &[Vector3<f64>] {
        &self.corners[..self.n_corners]
    }

    /// Calls `draw` with the triangles that make up the polygon (px).
    pub(super) fn fan(&self, mut draw: impl FnMut([[f64; 2]; 3])) {
        let pixel = |p: &Vector3<f64>| [p.x / p.z, p.y / p.z];
        if let Some((first, rest)) = self.corners().split_first() {
            for pair in rest.windows(2) {
                draw([pixel(first), pixel(&pair[0]), pixel(&pair[1])]);
            }
        }
    }
}

/// The part of a triangle inside all half-spaces (Sutherland and Hodgman).
pub(super) fn triangle(corners: [Vector3<f64>; 3], half_spaces: &[HalfSpace]) -> Polygon {
    let mut polygon = Polygon { corners: [Vector3::zeros(); MOST_CORNERS], n_corners: 0 };
    corners.into_iter().for_each(|corner| polygon.push(corner));
    for half in half_spaces {
        let mut kept = Polygon { corners: [Vector3::zeros(); MOST_CORNERS], n_corners: 0 };
        let n = polygon.n_corners;
        for i in 0..n {
            let (a, b) = (&polygon.corners[i], &polygon.corners[(i + 1) % n]);
            let (height_a, height_b) = (half.height(a), half.height(b));
            if height_a >= 0.0 {
                kept.push(*a);
            }
            // Always from the inner to the outer end: two triangles that share this edge find the
            // same bits, and no crack opens between them.
            if height_a >= 0.0 && height_b < 0.0 {
                kept.push(a + (b - a) * (height_a / (height_a - height_b)));
            } else if height_a < 0.0 && height_b >= 0.0 {
                kept.push(b + (a - b) * (height_b / (height_b - height_a)));
            }
        }
        polygon = kept;
    }
    polygon
}

/// The part of a segment inside all half-spaces.
pub(super) fn segment(
    [a, b]: [Vector3<f64>; 2],
    half_spaces: &[HalfSpace],
) -> Option<[Vector3<f64>; 2]> {
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for half in half_spaces {
        let (height_a, height_b) = (half.height(&a), half.height(&b));
        match (height_a >= 0.0, height_b >= 0.0) {
            (true, true) => {}
            (true, false) => to = to.min(height_a / (height_a - height_b)),
            (false, true) => from = from.max(height_a / (height_a - height_b)),
            (false, false) => return None,
        }
    }
    (from < to).then(|| [a + (b - a) * from, a + (b - a) * to])
}
