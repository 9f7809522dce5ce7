//! One frame: what goes into a recording and what comes out.

/// One frame of a simulation, borrowed from the caller.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Number of the frame; 0 is the initial state. Frames are recorded in rising order; the
    /// largest is `u32::MAX`.
    pub index: u64,
    /// Simulated time, not negative (s).
    pub time_s: f64,
    /// Garments in the order in which they are read back. Names are unique and not empty.
    pub garments: &'a [Garment<'a>],
    /// Bodies that cloth cannot pass, where they are now, in the order in which they are read back.
    /// Names are unique and not empty; garments may have the same.
    pub obstacles: &'a [Obstacle<'a>],
    /// The particles of a fluid, if there is one, in the order in which they are read back.
    pub fluid: Option<&'a [Particle]>,
    /// The camera that watches the scene, if any.
    pub camera: Option<Camera>,
    /// Where rigid things are. The names `world` and `camera` are taken.
    pub transforms: &'a [Transform<'a>],
    /// What the step reported: a JSON object.
    pub report: &'a serde_json::Value,
}

/// One garment as a triangle mesh.
#[derive(Clone, Copy, Debug)]
pub struct Garment<'a> {
    /// Name, the id of the entity that Foxglove draws.
    pub name: &'a str,
    /// World positions (m), `n_points`.
    pub points: &'a [[f64; 3]],
    /// Points of every triangle, `n_triangles`.
    pub triangles: &'a [[u32; 3]],
    /// Material coordinates of every triangle corner (m), `n_triangles`; a point on a seam has
    /// other ones on the other side.
    pub material: &'a [[[f64; 2]; 3]],
    /// Colour: red, green, blue, alpha from 0 to 1.
    pub color: [f32; 4],
}

/// An obstacle as a triangle mesh.
#[derive(Clone, Copy, Debug)]
pub struct Obstacle<'a> {
    /// Name, the id of the entity that Foxglove draws.
    pub name: &'a str,
    /// World positions (m), `n_points`.
    pub points: &'a [[f64; 3]],
    /// Points of every triangle.
    pub triangles: &'a [[u32; 3]],
    /// Colour: red, green, blue, alpha from 0 to 1.
    pub color: [f32; 4],
}

/// A particle of a fluid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Particle {
    /// Lasting number.
    pub id: u32,
    /// World position (m).
    pub position: [f64; 3],
    /// Momentum per mass (m/s).
    pub velocity: [f32; 3],
    /// Speed with which it changes its place (m/s): less than that of `velocity` where it is
    /// restrained.
    pub speed: f32,
    /// Density (kg/m³).
    pub density: f32,
    /// 0 for a particle that moves freely, 1 for one in transition, 2 for one at rest.
    pub state: u8,
}

/// A pinhole camera: x to the right of the picture, y down, z forward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Width of the picture (px).
    pub width_px: u32,
    /// Height of the picture (px).
    pub height_px: u32,
    /// Focal length along x and y (px).
    pub focal_px: [f64; 2],
    /// Where the axis meets the picture (px).
    pub center_px: [f64; 2],
    /// Where the camera stands in the world (m).
    pub position: [f64; 3],
    /// `world_from_camera` as a unit quaternion x, y, z, w (1).
    pub rotation: [f64; 4],
}

/// Where a rigid thing is in the world.
#[derive(Clone, Copy, Debug)]
pub struct Transform<'a> {
    /// Name, unique and not empty.
    pub name: &'a str,
    /// Translation (m).
    pub translation: [f64; 3],
    /// Rotation into the world as a unit quaternion x, y, z, w (1).
    pub rotation: [f64; 4],
}

/// A frame read back; every number has the bits that were recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnedFrame {
    /// See [`Frame::index`].
    pub index: u64,
    /// See [`Frame::time_s`] (s).
    pub time_s: f64,
    /// See [`Frame::garments`].
    pub garments: Vec<OwnedGarment>,
    /// See [`Frame::obstacles`].
    pub obstacles: Vec<OwnedObstacle>,
    /// See [`Frame::fluid`].
    pub fluid: Option<Vec<Particle>>,
    /// See [`Frame::camera`].
    pub camera: Option<Camera>,
    /// See [`Frame::transforms`].
    pub transforms: Vec<OwnedTransform>,
    /// See [`Frame::report`].
    pub report: serde_json::Value,
}

/// A garment read back.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnedGarment {
    /// See [`Garment::name`].
    pub name: String,
    /// See [`Garment::points`] (m).
    pub points: Vec<[f64; 3]>,
    /// See [`Garment::triangles`]; every index is below `points.len()`.
    pub triangles: Vec<[u32; 3]>,
    /// See [`Garment::material`] (m).
    pub material: Vec<[[f64; 2]; 3]>,
    /// See [`Garment::color`].
    pub color: [f32; 4],
}

/// An obstacle read back.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnedObstacle {
    /// See [`Obstacle::name`].
    pub name: String,
    /// See [`Obstacle::points`] (m).
    pub points: Vec<[f64; 3]>,
    /// See [`Obstacle::triangles`]; every index is below `points.len()`.
    pub triangles: Vec<[u32; 3]>,
    /// See [`Obstacle::color`].
    pub color: [f32; 4],
}

/// A transform read back.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnedTransform {
    /// See [`Transform::name`].
    pub name: String,
    /// See [`Transform::translation`] (m).
    pub translation: [f64; 3],
    /// See [`Transform::rotation`] (1).
    pub rotation: [f64; 4],
}

impl OwnedGarment {
    /// The garment as the recorder takes it.
    pub fn borrowed(&self) -> Garment<'_> {
        Garment {
            name: &self.name,
            points: &self.points,
            triangles: &self.triangles,
            material: &self.material,
            color: self.color,
        }
    }
}

impl OwnedObstacle {
    /// The obstacle as the recorder takes it.
    pub fn borrowed(&self) -> Obstacle<'_> {
        Obstacle {
            name: &self.name,
            points: &self.points,
            triangles: &self.triangles,
            color: self.color,
        }
    }
}

impl OwnedTransform {
    /// The transform as the recorder takes it.
    pub fn borrowed(&self) -> Transform<'_> {
        Transform { name: &self.name, translation: self.translation, rotation: self.rotation }
    }
}

/// A frame as listed by [`crate::Recording::frames`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameInfo {
    /// See [`Frame::index`].
    pub index: u64,
    /// See [`Frame::time_s`] (s).
    pub time_s: f64,
}
