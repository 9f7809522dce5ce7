//! Obstacles: bodies that cloth cannot pass.

use mesh_core::World3;
use mesh_core::generate::Surface;
use nalgebra::Point3;

use crate::scene::motion::{Motion, Transform};

/// A body that cloth cannot pass: a triangle mesh, closed or open, that moves as prescribed.
///
/// ```
/// use mesh_core::generate;
/// use organza::obstacle::Obstacle;
/// use organza::scene::motion::{Interpolation, Keyframe, Motion, Transform, Turning};
///
/// let at = |time_s, z| Keyframe {
///     time_s,
///     transform: Transform { translate: [0.0, 0.0, z], ..Transform::default() },
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
    /// Positions before the motion, or for all time where there is none (m).
    rest: Vec<World3>,
    /// Absent where nothing moves.
    motion: Option<Motion>,
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

impl Obstacle {
    /// The surface as placed by `transform` and moved by `motion`: a point x is at
    /// `motion.at(t) * transform * x`.
    ///
    /// # Errors
    /// Where there are no triangles, one names a missing vertex or the same twice, or a position is
    /// not finite. Surfaces that are not manifold are as good as others.
    pub fn new(
        name: impl Into<String>,
        surface: Surface,
        transform: &Transform,
        motion: Option<&Motion>,
        friction: f64,
    ) -> Result<Self, ObstacleError> {
        let Surface { positions, triangles } = surface;
        if triangles.is_empty() {
            return Err(ObstacleError::Empty);
        }
        let n_vertices = positions.len();
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
        let rest: Vec<World3> =
            positions.iter().map(|x| place.transform_point(&Point3::from(*x)).coords).collect();
        match rest.iter().position(|x| !x.iter().all(|c| c.is_finite())) {
            Some(vertex) => Err(ObstacleError::NotFinite { vertex }),
            None => Ok(Self {
                name: name.into(),
                triangles,
                friction,
                rest,
                motion: motion.filter(|motion| motion.is_moving()).cloned(),
            }),
        }
    }

    /// Where the vertices are at `time` (s); it depends on nothing else. Before the first keyframe
    /// and after the last the obstacle rests, and between them the paths of vertices are as smooth
    /// as [`Motion::at`].
    pub fn positions(&self, time: f64) -> Vec<World3> {
        let Some(motion) = &self.motion else { return self.rest.clone() };
        let place = motion.at(time);
        self.rest.iter().map(|x| place.transform_point(&Point3::from(*x)).coords).collect()
    }

    /// Whether it is not always in the same place.
    pub fn is_moving(&self) -> bool {
        self.motion.is_some()
    }

    /// Number of vertices.
    pub fn n_vertices(&self) -> usize {
        self.rest.len()
    }
}
