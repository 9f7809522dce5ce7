//! Layers made ready for a picture: positions in eye space, normals, and triangles for the
//! rasteriser.

use nalgebra::Vector3;

use super::clip::{self, HalfSpace};
use super::colour::{Decoder, Light};
use super::lens::Lens;
use super::raster::{NOBODY, Prim};
use super::{Layer, Lines, Paint, RenderError, Surface};

/// All layers of one picture. Their triangles and segments are numbered through; the number is the
/// owner of a sample.
pub(super) struct Scene<'a> {
    parts: Vec<Part<'a>>,
    decoder: Decoder,
}

struct Part<'a> {
    /// Number of its first triangle or segment.
    first: usize,
    shape: Shape<'a>,
}

/// A layer ready to be drawn.
pub(super) enum Shape<'a> {
    Cloth(Cloth<'a>),
    Lines(Lines<'a>, Light),
}

/// A surface in eye space.
pub(super) struct Cloth<'a> {
    pub(super) surface: Surface<'a>,
    /// Positions; NaN where broken.
    points: Vec<Vector3<f64>>,
    /// Normals of unit length on the front, each the mean over the triangles around the point
    /// weighted by area; zero where there is none.
    normals: Vec<Vector3<f64>>,
}

impl Cloth<'_> {
    /// The corners of triangle `t`, `None` if one is broken.
    pub(super) fn corners(&self, t: usize) -> Option<[Vector3<f64>; 3]> {
        let corners = self.surface.triangles[t].map(|i| self.points[i as usize]);
        corners.iter().all(|c| !c.x.is_nan()).then_some(corners)
    }

    /// The normals at the corners of triangle `t`.
    pub(super) fn normals(&self, t: usize) -> [Vector3<f64>; 3] {
        self.surface.triangles[t].map(|i| self.normals[i as usize])
    }

    /// The colour of triangle `t` where its corners have the given weights.
    pub(super) fn albedo(
        &self,
        decoder: &Decoder,
        t: usize,
        weights: [f64; 3],
        front_seen: bool,
    ) -> Light {
        let light = |colour| decoder.decode(colour);
        match self.surface.paint {
            Paint::Sides { front, back } => light(if front_seen { front } else { back }),
            Paint::Triangles(colours) => light(colours[t]),
            Paint::Points(colours) => {
                let corner = self.surface.triangles[t].map(|i| light(colours[i as usize]));
                let channel = |c: usize| (0..3).map(|i| weights[i] as f32 * corner[i][c]).sum();
                std::array::from_fn(channel)
            }
        }
    }
}

impl<'a> Scene<'a> {
    pub(super) fn new(layers: &[Layer<'a>], lens: &Lens) -> Result<Self, RenderError> {
        let decoder = Decoder::new();
        let mut parts = Vec::with_capacity(layers.len());
        let mut first = 0_usize;
        for (place, layer) in layers.iter().enumerate() {
            let (count, shape) = match *layer {
                Layer::Surface(surface) => {
                    surface.check(place)?;
                    (surface.triangles.len(), Shape::Cloth(cloth(surface, lens)))
                }
                Layer::Lines(lines) => {
                    (lines.segments.len(), Shape::Lines(lines, decoder.decode(lines.colour)))
                }
            };
            parts.push(Part { first, shape });
            first = first.saturating_add(count);
        }
        if first > NOBODY as usize {
            return Err(RenderError::TooMany { n_parts: first, most: NOBODY as usize });
        }
        Ok(Self { parts, decoder })
    }

    /// Linear light of colours.
    pub(super) fn decoder(&self) -> &Decoder {
        &self.decoder
    }

    /// The surfaces.
    pub(super) fn cloths(&self) -> impl Iterator<Item = &Cloth<'a>> + Clone {
        self.parts.iter().filter_map(|part| match &part.shape {
            Shape::Cloth(cloth) => Some(cloth),
            Shape::Lines(..) => None,
        })
    }

    /// The layer of an owner, and its number in this layer.
    pub(super) fn find(&self, owner: u32) -> (&Shape<'a>, usize) {
        let owner = owner as usize;
        let part = &self.parts[self.parts.partition_point(|part| part.first <= owner) - 1];
        (&part.shape, owner - part.first)
    }

    /// Triangles for the rasteriser, clipped to the picture's guard band. Nearness is the inverse of
    /// depth, which is linear in the picture.
    pub(super) fn prims(&self, lens: &Lens) -> Vec<Prim> {
        let guard = clip::guard(Lens::NEAR);
        let mut prims = Vec::new();
        for part in &self.parts {
            match &part.shape {
                Shape::Cloth(cloth) => {
                    for t in 0..cloth.surface.triangles.len() {
                        if let Some(corners) = cloth.corners(t) {
                            let corners = corners.map(|c| lens.project(c));
                            project_triangle(corners, &guard, (part.first + t) as u32, &mut prims);
                        }
                    }
                }
                Shape::Lines(lines, _) => {
                    let width = if lines.width_px.is_finite() { lines.width_px } else { 1.0 };
                    let half = width.clamp(0.5, 64.0) / 2.0;
                    for (s, &ends) in lines.segments.iter().enumerate() {
                        if let [Some(a), Some(b)] = ends.map(|p| lens.eye_space(p)) {
                            let ends = [lens.project(a), lens.project(b)];
                            project_segment(
                                ends,
                                half,
                                &guard,
                                (part.first + s) as u32,
                                &mut prims,
                            );
                        }
                    }
                }
            }
        }
        prims
    }
}

fn cloth<'a>(surface: Surface<'a>, lens: &Lens) -> Cloth<'a> {
    let broken = Vector3::repeat(f64::NAN);
    let points: Vec<_> =
        surface.points.iter().map(|&p| lens.eye_space(p).unwrap_or(broken)).collect();
    let mut normals = vec![Vector3::zeros(); points.len()];
    for corners in surface.triangles {
        let [a, b, c] = corners.map(|i| points[i as usize]);
        let area_normal = (b - a).cross(&(c - a));
        if area_normal.iter().all(|x| x.is_finite()) {
            for &i in corners {
                normals[i as usize] += area_normal;
            }
        }
    }
    for normal in &mut normals {
        *normal = super::viewpoint::direction(*normal).unwrap_or(Vector3::zeros());
    }
    Cloth { surface, points, normals }
}

fn project_triangle(
    corners: [Vector3<f64>; 3],
    guard: &[HalfSpace],
    owner: u32,
    prims: &mut Vec<Prim>,
) {
    let [a, b, c] = corners;
    // 1/depth at (x, y) is (x, y, 1) · (b×c + c×a + a×b) / (a · b×c).
    let determinant = a.dot(&b.cross(&c));
    let plane = (b.cross(&c) + c.cross(&a) + a.cross(&b)) / determinant;
    let polygon = clip::triangle(corners, guard);
    let nearness = polygon.corners().iter().map(|p| 1.0 / p.z);
    let least = nearness.clone().fold(f64::INFINITY, f64::min);
    let most = nearness.fold(0.0, f64::max);
    polygon.fan(|corners| prims.extend(Prim::new(corners, plane.into(), [least, most], owner)));
}

/// Segments are drawn as if nearer by this part of their depth, so that those which lie on a surface
/// are seen.
const SEGMENT_LIFT: f64 = 1e-3;

fn project_segment(
    ends: [Vector3<f64>; 2],
    half_width: f64,
    guard: &[HalfSpace],
    owner: u32,
    prims: &mut Vec<Prim>,
) {
    let Some([a, b]) = clip::segment(ends, guard) else { return };
    let (near_a, near_b) = ((1.0 + SEGMENT_LIFT) / a.z, (1.0 + SEGMENT_LIFT) / b.z);
    let [[ax, ay], [bx, by]] = [a, b].map(|p| [p.x / p.z, p.y / p.z]);
    let length = ((bx - ax).powi(2) + (by - ay).powi(2)).sqrt();
    if !(length > 0.0 && length.is_finite()) {
        return;
    }
    let (dx, dy) = ((bx - ax) / length, (by - ay) / length);
    let slope = (near_b - near_a) / length;
    let plane = [slope * dx, slope * dy, near_a - slope * (ax * dx + ay * dy)];
    let range = [near_a.min(near_b), near_a.max(near_b)];
    // Half a width longer at both ends, so that corners of a frame close.
    let corner = |x: f64, y: f64, along: f64, aside: f64| {
        [x + half_width * (dx * along - dy * aside), y + half_width * (dy * along + dx * aside)]
    };
    let quad = [
        corner(ax, ay, -1.0, -1.0),
        corner(bx, by, 1.0, -1.0),
        corner(bx, by, 1.0, 1.0),
        corner(ax, ay, -1.0, 1.0),
    ];
    prims.extend(Prim::new([quad[0], quad[1], quad[2]], plane, range, owner));
    prims.extend(Prim::new([quad[0], quad[2], quad[3]], plane, range, owner));
}
