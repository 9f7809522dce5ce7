//! What stands in the way of a camera: a coarse depth buffer.

use crate::camera::Camera;
use crate::error::{ViewError, check};
use crate::frustum::Frustum;
use mesh_core::World3;

/// The depths of the nearest surfaces that a camera sees, on a coarse grid of pixels. Draw bodies and
/// cloth into it, then ask what they hide.
///
/// It errs to the side of visibility: what it calls hidden lies behind drawn surfaces in every one of
/// its pixels that the bounding rectangle touches, and in those next to them, by more than the
/// thickness everywhere. Gaps narrower than one of its pixels can be missed.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthBuffer {
    frustum: Frustum,
    near: f64,
    /// Pixels of the buffer per unit of slope.
    focal: f64,
    columns: usize,
    rows: usize,
    thickness: f64,
    /// Row by row; infinite where nothing is drawn (m).
    depth: Vec<f64>,
}

impl DepthBuffer {
    /// Most pixels on the longer side.
    pub const MAX_SIDE: u32 = 2048;

    /// An empty buffer of `rows` rows for a camera. Surfaces nearer to each other than `thickness`
    /// (m) do not hide each other: layers of cloth, and a surface from itself.
    ///
    /// # Errors
    /// If a side is not from 1 to [`DepthBuffer::MAX_SIDE`] or the thickness is negative.
    pub fn new(camera: &Camera, rows: u32, thickness: f64) -> Result<DepthBuffer, ViewError> {
        let [width, height] = camera.resolution().map(f64::from);
        let columns = (f64::from(rows) * width / height).ceil().max(1.0);
        for (name, side) in [("rows", f64::from(rows)), ("columns", columns)] {
            check(name, side, "from 1 to 2048", |n| {
                (1.0..=f64::from(Self::MAX_SIDE)).contains(&n)
            })?;
        }
        check("the thickness", thickness, "at least 0 and finite (m)", |t| {
            t >= 0.0 && t.is_finite()
        })?;
        let (columns, rows) = (columns as usize, rows as usize);
        Ok(DepthBuffer {
            frustum: Frustum::new(camera),
            near: camera.near(),
            focal: camera.focal_px() * rows as f64 / height,
            columns,
            rows,
            thickness,
            depth: vec![f64::INFINITY; columns * rows],
        })
    }

    /// Draws a triangle of the world (m). One that comes nearer than the nearest depth is left out.
    pub fn draw(&mut self, corners: &[World3; 3]) {
        let Some(c) = self.project(corners) else { return };
        let Some([columns, rows]) = self.pixels(&c, 0.0) else { return };
        // Twice the area of the triangle that a pixel's centre makes with every edge.
        let edge = |k: usize, x: f64, y: f64| {
            let (a, b) = (c[(k + 1) % 3], c[(k + 2) % 3]);
            (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)
        };
        let area = edge(0, c[0].x, c[0].y);
        if area == 0.0 {
            return;
        }
        for row in rows.clone() {
            for column in columns.clone() {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let w = [0, 1, 2].map(|k| edge(k, x, y) / area);
                if w.iter().all(|&w| w >= 0.0) {
                    // One over the depth is linear in the picture.
                    let inverse: f64 = (0..3).map(|k| w[k] / c[k].z).sum();
                    let depth = &mut self.depth[row * self.columns + column];
                    *depth = depth.min(1.0 / inverse);
                }
            }
        }
    }

    /// True if a triangle of the world (m) is hidden by what has been drawn. What lies outside of the
    /// picture in part is judged by the rest; what does so wholly is not hidden.
    pub fn hides(&self, corners: &[World3; 3]) -> bool {
        let Some(c) = self.project(corners) else { return false };
        let Some([columns, rows]) = self.pixels(&c, 1.0) else { return false };
        let nearest = c[0].z.min(c[1].z).min(c[2].z);
        rows.into_iter().all(|row| {
            let line = &self.depth[row * self.columns..][columns.clone()];
            line.iter().all(|depth| depth + self.thickness < nearest)
        })
    }

    /// The corners as column, row (buffer pixels) and depth (m); none if one is too near.
    fn project(&self, corners: &[World3; 3]) -> Option<[World3; 3]> {
        let c = corners.map(|p| self.frustum.camera_space(p));
        let middle = [self.columns as f64 / 2.0, self.rows as f64 / 2.0];
        c.iter().all(|p| p.z >= self.near).then(|| {
            c.map(|p| {
                let scale = self.focal / p.z;
                World3::new(middle[0] + scale * p.x, middle[1] + scale * p.y, p.z)
            })
        })
    }

    /// The columns and rows that the bounding rectangle touches, made wider by some pixels.
    fn pixels(&self, c: &[World3; 3], wider: f64) -> Option<[std::ops::Range<usize>; 2]> {
        let span = |k: usize, n: usize| {
            let low = c[0][k].min(c[1][k]).min(c[2][k]) - wider;
            let high = c[0][k].max(c[1][k]).max(c[2][k]) + wider;
            // Numbers beyond the range of integers saturate, and no number is 0.
            let range = low.max(0.0) as usize..((high.max(0.0) as usize).saturating_add(1)).min(n);
            (high >= 0.0 && range.start < range.end).then_some(range)
        };
        Some([span(0, self.columns)?, span(1, self.rows)?])
    }
}
