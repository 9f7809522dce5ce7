//! The mannequin: skin, skeleton and motion together.

use crate::error::{MannequinError, check};
use crate::motion::{Action, Motion};
use crate::skeleton::weights;
use crate::skin::skin;
use mesh_core::World3;
use nalgebra::{Point3, Vector3};
use std::sync::Arc;

/// A body with a closed skin that moves for ever.
///
/// ```
/// use mannequin::{Action, Mannequin, Motion};
///
/// let dance = Motion { action: Action::Dance, ..Motion::STAND };
/// let dancer = Mannequin::new(0.04, dance)?;
/// assert_eq!(dancer.positions(0.0).len(), dancer.n_vertices());
/// assert_ne!(dancer.positions(0.0), dancer.positions(7.0));
/// # Ok::<(), mannequin::MannequinError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Mannequin {
    body: Arc<Body>,
    motion: Motion,
}

/// What does not move.
#[derive(Clone, Debug, PartialEq)]
struct Body {
    /// Wanted length of edges (m).
    cell: f64,
    triangles: Vec<[u32; 3]>,
    /// Positions in the body at rest (m).
    rest: Vec<World3>,
    /// Joint and weight; those of a vertex add up to one.
    influences: Vec<(usize, f64)>,
    /// The first influence of every vertex, and the number of all.
    first: Vec<usize>,
}

impl Mannequin {
    /// Shortest length of edges (m).
    pub const MIN_CELL: f64 = 0.008;
    /// Greatest length of edges (m): longer ones would lose hands and feet.
    pub const MAX_CELL: f64 = 0.04;
    /// Parts of the skin that face each other stay farther apart than this, whatever it does (m):
    /// enough for two layers of cloth 6 mm thick and the distance that contact keeps.
    pub const ROOM: f64 = 0.02;

    /// A mannequin with edges of about `cell` (m) that moves so.
    ///
    /// # Errors
    /// If the length of edges or a number of the motion is out of range.
    pub fn new(cell: f64, motion: Motion) -> Result<Mannequin, MannequinError> {
        check("the length of edges", cell, "from 0.008 to 0.04 (m)", |cell| {
            (Mannequin::MIN_CELL..=Mannequin::MAX_CELL).contains(&cell)
        })?;
        check_motion(&motion)?;
        let surface = skin(cell)?;
        let (mut influences, mut first) = (Vec::new(), vec![0]);
        for x in &surface.positions {
            let own = weights(x);
            let sum: f64 = own.iter().map(|(_, weight)| weight).sum();
            influences.extend(own.into_iter().map(|(joint, w)| (joint as usize, w / sum)));
            first.push(influences.len());
        }
        let (triangles, rest) = (surface.triangles, surface.positions);
        Ok(Mannequin { body: Arc::new(Body { cell, triangles, rest, influences, first }), motion })
    }

    /// The same body with another motion; both share the skin.
    ///
    /// # Errors
    /// If a number of the motion is out of range.
    pub fn moving(&self, motion: Motion) -> Result<Mannequin, MannequinError> {
        check_motion(&motion)?;
        Ok(Mannequin { body: self.body.clone(), motion })
    }

    /// The length of edges that it was made with (m).
    pub fn cell(&self) -> f64 {
        self.body.cell
    }

    /// Three vertices each, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.body.triangles
    }

    /// Number of vertices.
    pub fn n_vertices(&self) -> usize {
        self.body.rest.len()
    }

    /// How it moves.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Whether it moves.
    pub fn is_moving(&self) -> bool {
        self.motion.action != Action::Stand
    }

    /// Where the vertices are at `time` (s), the floor at z = 0 (m): the weighted means of where
    /// their bones take them.
    pub fn positions(&self, time: f64) -> Vec<World3> {
        let bones = self.motion.pose(time).bones();
        let Body { rest, influences, first, .. } = &*self.body;
        let place = |v: usize| {
            let x = Point3::from(rest[v]);
            let parts = &influences[first[v]..first[v + 1]];
            parts.iter().fold(Vector3::zeros(), |sum, &(bone, weight)| {
                sum + (bones[bone] * x).coords * weight
            })
        };
        (0..rest.len()).map(place).collect()
    }
}

fn check_motion(motion: &Motion) -> Result<(), MannequinError> {
    check("the phase", motion.phase, "finite", f64::is_finite)?;
    check("the start", motion.start, "finite (s)", f64::is_finite)?;
    check("the time to ease in", motion.ease, "from 0 on and finite (s)", |ease| {
        ease >= 0.0 && ease.is_finite()
    })
}
