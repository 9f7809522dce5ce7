//! Shadows of the key light: on the surfaces by a depth picture from the light, and a soft one on
//! the floor.

use nalgebra::Vector3;

use super::clip;
use super::lens::Lens;
use super::project::Scene;
use super::raster::{Prim, Strip};

/// Longest side of the depth picture (px).
const MAP: usize = 1024;
/// Greatest depth at which shadows must be fine, in distances to the target.
const FARTHEST_RECEIVER: f64 = 8.0;
/// Longest side of the picture of the soft shadow (px).
const SOFT: usize = 256;

/// What the key light sees.
pub(super) struct Shadow {
    /// Axes across the light and towards it.
    axes: [Vector3<f64>; 3],
    /// Lowest coordinates across the light, and pixels per unit.
    low: [f64; 2],
    scale: f64,
    width: usize,
    height: usize,
    /// Greatest coordinate towards the light in every pixel.
    depth: Vec<f32>,
}

impl Shadow {
    /// Shadows of the surfaces in light from the direction `light` of eye space; `None` if there is
    /// nothing to see them on. Covers what the picture shows, as finely as possible, or, if `whole`,
    /// the whole scene.
    pub(super) fn new(
        scene: &Scene<'_>,
        lens: &Lens,
        light: Vector3<f64>,
        whole: bool,
    ) -> Option<Self> {
        let right = Vector3::y().cross(&light).normalize();
        let axes = [right, light.cross(&right), light];
        let triangles = || {
            scene.cloths().flat_map(|cloth| {
                (0..cloth.surface.triangles.len()).filter_map(|t| cloth.corners(t))
            })
        };
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        let frustum = lens.frustum(FARTHEST_RECEIVER);
        let frustum = if whole { &frustum[..0] } else { &frustum[..] };
        for corners in triangles() {
            for corner in clip::triangle(corners, frustum).corners() {
                for k in 0..2 {
                    let x = axes[k].dot(corner);
                    (low[k], high[k]) = (low[k].min(x), high[k].max(x));
                }
            }
        }
        let span = [high[0] - low[0], high[1] - low[1]];
        let longest = span[0].max(span[1]);
        if !(longest > 1e-9 && longest.is_finite()) {
            return None;
        }
        // A free margin of two pixels, so that lookups beside the casters find light.
        let scale = (MAP - 4) as f64 / longest;
        let low = low.map(|x| x - 2.0 / scale);
        let [width, height] = span.map(|x| ((x * scale).ceil() as usize + 4).min(MAP));

        // Triangles that reach out of the depth picture throw shadows into it, too.
        let guard = clip::guard(0.5);
        let mut strip = Strip::<1>::new(&[[128, 128]], width, height, f32::NEG_INFINITY);
        for corners in triangles() {
            let at = corners
                .map(|p| [(axes[0].dot(&p) - low[0]) * scale, (axes[1].dot(&p) - low[1]) * scale]);
            let towards = corners.map(|p| axes[2].dot(&p));
            if let Some(plane) = plane(at, towards) {
                let least = towards.iter().fold(f64::INFINITY, |a, &b| a.min(b));
                let most = towards.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b));
                let at = at.map(|[x, y]| Vector3::new(x, y, 1.0));
                clip::triangle(at, &guard).fan(|at| {
                    if let Some(prim) = Prim::new(at, plane, [least, most], 0) {
                        strip.fill(&prim);
                    }
                });
            }
        }
        let depth = strip.nearness.into_iter().map(|[x]| x).collect();
        Some(Self { axes, low, scale, width, height, depth })
    }

    /// Part of the key light, 0 to 1, that reaches the point `p` of eye space on a surface with the
    /// unit normal `face`.
    pub(super) fn lit(&self, p: Vector3<f64>, face: &Vector3<f64>) -> f32 {
        // A surface must not shade itself: its point is moved off by what a pixel of the depth
        // picture and the filter can hide.
        let pixel = 1.0 / self.scale;
        let p = p + face * (1.5 * pixel);
        let [x, y] = [0, 1].map(|k| (self.axes[k].dot(&p) - self.low[k]) * self.scale - 0.5);
        let cos = face.dot(&self.axes[2]).abs().max(0.2);
        let slope = (1.0 - cos * cos).sqrt() / cos;
        let towards = (self.axes[2].dot(&p) + pixel * (0.5 + 1.0 * slope)) as f32;
        let (column, row) = (x.floor(), y.floor());
        let (fx, fy) = ((x - column) as f32, (y - row) as f32);
        let (column, row) = (column as i64, row as i64);
        // A box of three pixels, moved smoothly: four by four pixels, the outer ones in part.
        let (weights_x, weights_y) = ([1.0 - fx, 1.0, 1.0, fx], [1.0 - fy, 1.0, 1.0, fy]);
        let mut lit = 0.0;
        for (j, &weight_y) in weights_y.iter().enumerate() {
            let mut line = 0.0;
            for (i, &weight_x) in weights_x.iter().enumerate() {
                let hidden = self.at(column + i as i64 - 1, row + j as i64 - 1) > towards;
                line += if hidden { 0.0 } else { weight_x };
            }
            lit += line * weight_y;
        }
        lit / 9.0
    }

    fn at(&self, column: i64, row: i64) -> f32 {
        if column < 0 || row < 0 || column >= self.width as i64 || row >= self.height as i64 {
            return f32::NEG_INFINITY;
        }
        self.depth[row as usize * self.width + column as usize]
    }
}

/// The linear function with the values `f` at the places `at`: its slopes and its value at the
/// origin; `None` for places in a line.
fn plane(at: [[f64; 2]; 3], f: [f64; 3]) -> Option<[f64; 3]> {
    let [a, b, c] = at;
    let (bx, by, cx, cy) = (b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]);
    let area = bx * cy - by * cx;
    let (fb, fc) = (f[1] - f[0], f[2] - f[0]);
    let (dx, dy) = ((fb * cy - fc * by) / area, (fc * bx - fb * cx) / area);
    let plane = [dx, dy, f[0] - dx * a[0] - dy * a[1]];
    plane.iter().all(|x| x.is_finite()).then_some(plane)
}

/// A blurred picture of where the key light is held up: on a floor below everything, its shadow.
pub(super) struct SoftShadow {
    axes: [Vector3<f64>; 3],
    low: [f64; 2],
    scale: f64,
    width: usize,
    height: usize,
    cover: Vec<f32>,
}

impl SoftShadow {
    pub(super) fn new(shadow: &Shadow) -> Self {
        let shrink = MAP / SOFT;
        // Room around the casters for the blur to run out.
        let margin = SOFT / 8;
        let width = shadow.width.div_ceil(shrink) + 2 * margin;
        let height = shadow.height.div_ceil(shrink) + 2 * margin;
        let mut cover = vec![0.0; width * height];
        for row in 0..shadow.height {
            for column in 0..shadow.width {
                if shadow.depth[row * shadow.width + column] > f32::NEG_INFINITY {
                    let cell = (row / shrink + margin) * width + column / shrink + margin;
                    cover[cell] += 1.0 / (shrink * shrink) as f32;
                }
            }
        }
        // Three boxes make nearly a bell; their reach together stays inside the margin.
        let reach = margin / 3 - 1;
        let mut line = Vec::new();
        for _ in 0..3 {
            for row in 0..height {
                blur(&mut cover, row * width, 1, width, reach, &mut line);
            }
            for column in 0..width {
                blur(&mut cover, column, width, height, reach, &mut line);
            }
        }
        let scale = shadow.scale / shrink as f64;
        let low = shadow.low.map(|x| x - margin as f64 / scale);
        Self { axes: shadow.axes, low, scale, width, height, cover }
    }

    /// Part of the key light, 0 to 1, that is held up on the way to `p` of eye space.
    pub(super) fn cover(&self, p: Vector3<f64>) -> f32 {
        let [x, y] = [0, 1].map(|k| (self.axes[k].dot(&p) - self.low[k]) * self.scale - 0.5);
        if !(x >= 0.0 && y >= 0.0) || x >= (self.width - 1) as f64 || y >= (self.height - 1) as f64
        {
            return 0.0;
        }
        let (column, row) = (x as usize, y as usize);
        let (fx, fy) = ((x - column as f64) as f32, (y - row as f64) as f32);
        let at = |i, j| self.cover[(row + j) * self.width + column + i];
        let (upper, lower) =
            (at(0, 0) + (at(1, 0) - at(0, 0)) * fx, at(0, 1) + (at(1, 1) - at(0, 1)) * fx);
        upper + (lower - upper) * fy
    }
}

/// Replaces `count` values, `stride` apart, by the mean of those up to `reach` places away.
fn blur(
    values: &mut [f32],
    first: usize,
    stride: usize,
    count: usize,
    reach: usize,
    line: &mut Vec<f32>,
) {
    line.clear();
    line.extend((0..count).map(|i| values[first + i * stride]));
    let mut sum: f32 = line[..reach.min(count)].iter().sum();
    for i in 0..count {
        sum += line.get(i + reach).copied().unwrap_or(0.0);
        values[first + i * stride] = sum / (2 * reach + 1) as f32;
        sum -= if i >= reach { line[i - reach] } else { 0.0 };
    }
}
