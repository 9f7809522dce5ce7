//! The obstacles as the contact sees them: those that are there.

use crate::contact::{ContactSettings, Crossings, Obstacles};
use crate::obstacle::Obstacle;
use collision::SurfaceError;
use mesh_core::ClothState;

/// The obstacles that are there at a time.
#[derive(Default)]
pub(super) struct Bodies {
    /// Which of the scene's obstacles they are.
    there: Vec<bool>,
    /// As one surface; absent where there are none.
    pub(super) surface: Option<Obstacles>,
}

impl Bodies {
    /// Brings the list up to `time` (s), and says whether it has changed.
    ///
    /// # Errors
    /// If there are too many triangles.
    pub(super) fn update(&mut self, all: &[Obstacle], time: f64) -> Result<bool, SurfaceError> {
        let there: Vec<bool> = all.iter().map(|obstacle| obstacle.is_there(time)).collect();
        if there == self.there {
            return Ok(false);
        }
        let shown = all.iter().zip(&there).filter(|(_, there)| **there);
        let shown: Vec<Obstacle> = shown.map(|(obstacle, _)| obstacle.clone()).collect();
        self.surface = Obstacles::new(&shown)?;
        self.there = there;
        Ok(true)
    }
}

/// The first obstacle that comes between two times (s) where cloth lies across it, and where.
pub(super) fn appearing_in_cloth(
    all: &[Obstacle],
    cloth: &ClothState,
    settings: &ContactSettings,
    [before, after]: [f64; 2],
) -> Option<(String, Crossings)> {
    let settings = ContactSettings { self_contact: false, ..*settings };
    let comes = |o: &&Obstacle| !o.is_there(before) && o.is_there(after);
    all.iter().filter(comes).find_map(|obstacle| {
        // Its triangles have been counted before.
        let surface = Obstacles::new(std::slice::from_ref(obstacle)).ok()?;
        let crossings = Crossings::find(cloth, surface.as_ref(), &settings, before)?;
        Some((obstacle.name.clone(), crossings))
    })
}
