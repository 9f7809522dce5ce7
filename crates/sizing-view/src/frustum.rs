//! What a camera can see: the frustum as half-spaces, and distances to it.

use crate::camera::Camera;
use collision::distance::{edge_edge, vertex_triangle};
use mesh_core::World3;
use nalgebra::Matrix3;

/// The half-space normal · p ≥ offset with a unit normal.
#[derive(Clone, Copy, Debug, PartialEq)]
struct HalfSpace {
    normal: World3,
    offset: f64,
}

impl HalfSpace {
    /// Distance to the boundary, positive inside (m).
    #[inline]
    fn depth(&self, p: &World3) -> f64 {
        self.normal.dot(p) - self.offset
    }
}

/// Where a ball lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// All of it inside.
    Inside,
    /// All of it farther away than asked.
    Away,
    /// Neither can be told.
    Between,
}

/// The part of space in a camera's picture: between the four planes through its edges, beyond the
/// nearest depth, without end.
#[derive(Clone, Debug, PartialEq)]
pub struct Frustum {
    position: World3,
    camera_from_world: Matrix3<f64>,
    slopes: [f64; 2],
    near: f64,
    /// In camera space.
    planes: [HalfSpace; 5],
}

impl Frustum {
    /// The frustum of a camera.
    pub fn new(camera: &Camera) -> Frustum {
        let slopes @ [sx, sy] = camera.slopes();
        let side = |x: f64, y: f64, slope: f64| HalfSpace {
            normal: World3::new(x, y, slope) / 1.0f64.hypot(slope),
            offset: 0.0,
        };
        Frustum {
            position: camera.position(),
            camera_from_world: camera.world_from_camera().inverse().to_rotation_matrix().into(),
            slopes,
            near: camera.near(),
            planes: [
                HalfSpace { normal: World3::z(), offset: camera.near() },
                side(1.0, 0.0, sx),
                side(-1.0, 0.0, sx),
                side(0.0, 1.0, sy),
                side(0.0, -1.0, sy),
            ],
        }
    }

    /// The rotation from the axes of the world to those of camera space (1).
    pub(crate) fn camera_from_world(&self) -> &Matrix3<f64> {
        &self.camera_from_world
    }

    /// A point of the world (m) in camera space (m).
    #[inline]
    pub fn camera_space(&self, p: World3) -> World3 {
        self.camera_from_world * (p - self.position)
    }

    /// Distance between a triangle in the world and the frustum, 0 if they meet (m). A triangle with
    /// coordinates that are no numbers counts as inside.
    pub fn distance(&self, corners: &[World3; 3]) -> f64 {
        self.distance_in_camera(&corners.map(|p| self.camera_space(p)), f64::INFINITY)
    }

    /// The same for a triangle in camera space (m); exact below `enough`, otherwise any lower bound
    /// not below it.
    pub(crate) fn distance_in_camera(&self, c: &[World3; 3], enough: f64) -> f64 {
        if (c[0] + c[1] + c[2]).sum().is_nan() {
            return 0.0;
        }
        let depths = self.planes.map(|plane| c.map(|p| plane.depth(&p)));
        if (0..3).any(|k| depths.iter().all(|of| of[k] >= 0.0)) {
            return 0.0;
        }
        // Beyond one plane by so much, the triangle is so far from all that is within it.
        let beyond = depths.iter().map(|of| -of[0].max(of[1]).max(of[2]));
        let at_least = beyond.fold(0.0, f64::max);
        if at_least >= enough && at_least > 0.0 {
            return at_least;
        }
        // The usual case beside a side: no point is nearer than the nearest corner.
        let corner = c.iter().map(|p| self.distance_to_point(p)).fold(f64::INFINITY, f64::min);
        if at_least > 0.0 && corner <= at_least * (1.0 + 1e-12) {
            return corner;
        }
        if self.meets(c) {
            return 0.0;
        }
        let distance = self.distance_apart(c, corner);
        if distance.is_nan() { 0.0 } else { distance }
    }

    /// Where the ball about a point of the world (m) lies.
    pub fn place_of_ball(&self, centre: World3, radius: f64, away: f64) -> Place {
        let centre = self.camera_space(centre);
        let least = self.planes.iter().map(|p| p.depth(&centre)).fold(f64::INFINITY, f64::min);
        if least >= radius {
            Place::Inside
        } else if -least > radius + away {
            Place::Away
        } else {
            Place::Between
        }
    }

    /// True if something of the triangle is left when it is cut by all half-spaces.
    fn meets(&self, c: &[World3; 3]) -> bool {
        // Every cut adds at most one corner.
        let (mut polygon, mut n) = ([World3::zeros(); 8], 3);
        polygon[..3].copy_from_slice(c);
        for plane in &self.planes {
            let (old, n_old) = (polygon, n);
            n = 0;
            for k in 0..n_old {
                let (p, q) = (old[k], old[(k + 1) % n_old]);
                let (at_p, at_q) = (plane.depth(&p), plane.depth(&q));
                if at_p >= 0.0 {
                    polygon[n] = p;
                    n += 1;
                }
                if (at_p >= 0.0) != (at_q >= 0.0) && n < polygon.len() {
                    polygon[n] = p + (q - p) * (at_p / (at_p - at_q));
                    n += 1;
                }
            }
            if n == 0 {
                return false;
            }
        }
        true
    }

    /// Distance to a triangle that does not meet the frustum (m): the least over a corner and the
    /// frustum, which is given, a corner of the frustum and the triangle, and an edge of either.
    fn distance_apart(&self, c: &[World3; 3], mut least: f64) -> f64 {
        let [sx, sy] = self.slopes;
        let directions = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)]
            .map(|(x, y)| World3::new(x * sx, y * sy, 1.0));
        let near = directions.map(|d| d * self.near);
        for corner in near {
            least = least.min(vertex_triangle(&[corner, c[0], c[1], c[2]]).distance());
        }
        // The point of a ray that is closest to another point is no farther along than that is away.
        let reach = c.iter().chain(&near).map(|p| p.norm()).fold(0.0, f64::max) * 2.0;
        for (i, direction) in directions.iter().enumerate() {
            let end = near[i] + direction * (reach / direction.norm());
            for k in 0..3 {
                let (a, b) = (c[k], c[(k + 1) % 3]);
                least = least.min(edge_edge(&[near[i], end, a, b]).distance());
                least = least.min(edge_edge(&[near[i], near[(i + 1) % 4], a, b]).distance());
            }
        }
        least
    }

    /// Distance to a point of camera space (m): the nearest of its projections to the near face, two
    /// sides and the edge between them that lie on the frustum. One of four equal corners is enough.
    pub(crate) fn distance_to_point(&self, p: &World3) -> f64 {
        let ([sx, sy], near) = (self.slopes, self.near);
        let (x, y, z) = (p.x.abs(), p.y.abs(), p.z);
        if z >= near && x <= sx * z && y <= sy * z {
            return 0.0;
        }
        let to = |a: f64, b: f64, c: f64| World3::new(x - a, y - b, z - c).norm();
        let mut least = to(x.min(sx * near), y.min(sy * near), near);
        let on_x = (z + sx * x) / (1.0 + sx * sx);
        if on_x >= near && y <= sy * on_x {
            least = least.min(to(sx * on_x, y, on_x));
        }
        let on_y = (z + sy * y) / (1.0 + sy * sy);
        if on_y >= near && x <= sx * on_y {
            least = least.min(to(x, sy * on_y, on_y));
        }
        let on_edge = ((sx * x + sy * y + z) / (1.0 + sx * sx + sy * sy)).max(near);
        least.min(to(sx * on_edge, sy * on_edge, on_edge))
    }
}
