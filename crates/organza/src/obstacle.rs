//! Obstacles: bodies that cloth cannot pass.

use std::sync::Arc;

use mannequin::Mannequin;
use mesh_core::World3;
use mesh_core::generate::Surface;
use nalgebra::{Point3, Similarity3};

use crate::character::Character;
use crate::scene::motion::{Motion, Transform};

/// A body that cloth cannot pass: a triangle mesh, closed or open, that moves as prescribed and may
/// be there for a while only.
///
/// ```
/// use mesh_core::generate;
/// use organza::obstacle::Obstacle;
/// use organza::scene::motion::{Interpolation, Keyframe, Motion, Transform, Turning};
///
/// let at = |time_s, z| {
///     Keyframe::new(time_s, Transform { translate: [0.0, 0.0, z], ..Transform::default() })
/// };
/// let motion = Motion {
///     interpolation: Interpolation::Smooth,
///     turning: Turning::Shortest,
///     keyframes: vec![at(1.0, 0.0), at(2.0, 0.5)],
/// };
/// let ball = generate::sphere(0.1, 2)?;
/// let ball = Obstacle::new("ball", ball, &Transform::default(), Some(&motion), 0.3)?;
/// assert!(ball.is_moving());
/// assert_eq!(ball.positions(0.0), ball.positions(1.0));
/// assert!((ball.positions(9.0)[0].z - 0.6).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    /// Its name, unique among the obstacles of a scene.
    pub name: String,
    /// Three vertices each; of closed surfaces counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Coefficient of friction between it and cloth (1).
    pub friction: f64,
    /// Its thickness in contact (m); absent for that of the scene.
    pub thickness: Option<f64>,
    /// How its vertices move by themselves.
    shape: Arc<Shape>,
    /// From the frame of the shape to that of the motion.
    place: Similarity3<f64>,
    /// Absent where nothing moves.
    motion: Option<Motion>,
    /// When it appears and when it is gone (s).
    times: [f64; 2],
}

/// How the vertices of an obstacle move by themselves.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// They do not.
    Rigid(Surface),
    /// From frame to frame, on straight ways.
    Frames(Frames),
    /// With nodes and joints.
    Character(Character),
    /// As a mannequin.
    Mannequin(Mannequin),
}

impl From<Surface> for Shape {
    fn from(surface: Surface) -> Self {
        Shape::Rigid(surface)
    }
}

/// An animation by positions of all vertices in every frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Frames {
    /// Three vertices each.
    pub triangles: Vec<[u32; 3]>,
    /// Positions in every frame, at least one, each with as many vertices (m).
    pub positions: Vec<Vec<World3>>,
    /// Frame rate (1/s).
    pub frames_per_second: f64,
    /// Time of the first frame (s).
    pub start: f64,
}

impl Frames {
    /// Positions at a time (s): those of the first frame before it, of the last after it (m).
    fn at(&self, time: f64) -> Vec<World3> {
        let last = self.positions.len() - 1;
        let s = ((time - self.start) * self.frames_per_second).clamp(0.0, last as f64);
        let before = s.floor() as usize;
        let share = s - s.floor();
        if share == 0.0 {
            return self.positions[before].clone();
        }
        let ways = self.positions[before].iter().zip(&self.positions[before + 1]);
        ways.map(|(a, b)| a * (1.0 - share) + b * share).collect()
    }
}

impl Shape {
    fn triangles(&self) -> &[[u32; 3]] {
        match self {
            Shape::Rigid(surface) => &surface.triangles,
            Shape::Frames(frames) => &frames.triangles,
            Shape::Character(character) => character.triangles(),
            Shape::Mannequin(mannequin) => mannequin.triangles(),
        }
    }

    fn n_vertices(&self) -> usize {
        match self {
            Shape::Rigid(surface) => surface.positions.len(),
            Shape::Frames(frames) => frames.positions[0].len(),
            Shape::Character(character) => character.n_vertices(),
            Shape::Mannequin(mannequin) => mannequin.n_vertices(),
        }
    }

    fn is_moving(&self) -> bool {
        match self {
            Shape::Rigid(_) => false,
            Shape::Frames(frames) => frames.positions.windows(2).any(|pair| pair[0] != pair[1]),
            Shape::Character(character) => character.is_moving(),
            Shape::Mannequin(mannequin) => mannequin.is_moving(),
        }
    }
}

/// Why a surface is no obstacle.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ObstacleError {
    /// There is nothing to touch.
    #[error("has no triangles")]
    Empty,
    /// A triangle names a vertex that is not there, or one of them twice.
    #[error("triangle {triangle} has the vertices {vertices:?} of {n_vertices}")]
    Triangle {
        /// The triangle.
        triangle: usize,
        /// Its vertices.
        vertices: [u32; 3],
        /// Number of vertices.
        n_vertices: usize,
    },
    /// A position is not finite.
    #[error("the position of vertex {vertex} is not finite")]
    NotFinite {
        /// The vertex.
        vertex: usize,
    },
}

/// Slack in comparing times (s): steps add up with rounding.
const INSTANT: f64 = 1e-9;

impl Obstacle {
    /// The surface as placed by `transform` and moved by `motion`: a point that the shape has at x is
    /// at `motion.at(t) * transform * x`. It is there for all time.
    ///
    /// # Errors
    /// Where there are no triangles, one names a missing vertex or the same twice, or a position is
    /// not finite. Surfaces that are not manifold are as good as others.
    pub fn new(
        name: impl Into<String>,
        shape: impl Into<Shape>,
        transform: &Transform,
        motion: Option<&Motion>,
        friction: f64,
    ) -> Result<Self, ObstacleError> {
        let mut shape = shape.into();
        let triangles = shape.triangles().to_vec();
        if triangles.is_empty() {
            return Err(ObstacleError::Empty);
        }
        let n_vertices = shape.n_vertices();
        let bad = |&[a, b, c]: &[u32; 3]| {
            [a, b, c].iter().any(|&v| v as usize >= n_vertices) || a == b || b == c || c == a
        };
        if let Some(triangle) = triangles.iter().position(bad) {
            let vertices = triangles[triangle];
            return Err(ObstacleError::Triangle { triangle, vertices, n_vertices });
        }
        let mut place = transform.similarity();
        if let Some(still) = motion.filter(|motion| !motion.is_moving()) {
            place = still.at(0.0) * place;
        }
        if let Shape::Rigid(surface) = &mut shape {
            // What is rigid is placed once.
            surface.positions = placed(&place, &surface.positions);
            place = Similarity3::identity();
        }
        let obstacle = Self {
            name: name.into(),
            triangles,
            friction,
            thickness: None,
            shape: Arc::new(shape),
            place,
            motion: motion.filter(|motion| motion.is_moving()).cloned(),
            times: [0.0, f64::INFINITY],
        };
        let is_broken = |x: &World3| !x.iter().all(|c| c.is_finite());
        match obstacle.shape_at(0.0).iter().position(is_broken) {
            Some(vertex) => Err(ObstacleError::NotFinite { vertex }),
            None => Ok(obstacle),
        }
    }

    /// The same obstacle, there from `start` to `end` (s): from the beginning where `start` is 0, for
    /// ever where `end` is infinite.
    #[must_use]
    pub fn between(self, start: f64, end: f64) -> Self {
        Self { times: [start, end], ..self }
    }

    /// Whether cloth that was brought to `time` (s) had it in its way: after its start and until its
    /// end, both to the slack of adding up steps.
    pub fn is_there(&self, time: f64) -> bool {
        let [start, end] = self.times;
        (start <= 0.0 || time > start + INSTANT) && time <= end + INSTANT
    }

    /// When it appears and when it is gone (s): 0 for what is there from the beginning, infinity for
    /// what stays.
    pub fn times(&self) -> [f64; 2] {
        self.times
    }

    /// Where the vertices are at `time` (s); it depends on nothing else, and does not ask whether the
    /// obstacle is there. Before the first keyframe and after the last the obstacle rests, and
    /// between them the paths of vertices are as smooth as [`Motion::at`], their own animation apart.
    pub fn positions(&self, time: f64) -> Vec<World3> {
        let own = self.shape_at(time);
        match &self.motion {
            None => own,
            Some(motion) => placed(&motion.at(time), &own),
        }
    }

    /// Positions before the motion (m).
    fn shape_at(&self, time: f64) -> Vec<World3> {
        match &*self.shape {
            Shape::Rigid(surface) => surface.positions.clone(),
            Shape::Frames(frames) => placed(&self.place, &frames.at(time)),
            Shape::Character(character) => placed(&self.place, &character.positions(time)),
            Shape::Mannequin(mannequin) => placed(&self.place, &mannequin.positions(time)),
        }
    }

    /// Whether it is not always in the same place.
    pub fn is_moving(&self) -> bool {
        self.motion.is_some() || self.shape.is_moving()
    }

    /// Number of vertices.
    pub fn n_vertices(&self) -> usize {
        self.shape.n_vertices()
    }
}

fn placed(place: &Similarity3<f64>, x: &[World3]) -> Vec<World3> {
    x.iter().map(|x| place.transform_point(&Point3::from(*x)).coords).collect()
}
