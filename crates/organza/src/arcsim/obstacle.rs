//! Obstacles and contact of ARCSim.

use super::cloth::translate_transform;
use super::format::ArcsimFile;
use super::motion;
use super::translate::Notes;
use crate::scene::format::{ContactFile, ObstacleFile, ObstacleMesh};

/// Friction of cloth on cloth and on obstacles where the scene names none (1).
const FRICTION: f64 = 0.6;
const OBSTACLE_FRICTION: f64 = 0.3;
/// Thickness of contact where the scene names none (m).
const THICKNESS_M: f64 = 1e-3;

/// Translates obstacles and contact. Everything touches everything, unless the scene disables both
/// ways to see to it; then obstacles are left out with what they do.
pub(super) fn translate(
    arcsim: &ArcsimFile,
    notes: &mut Notes,
) -> (Vec<ObstacleFile>, Option<ContactFile>) {
    let friction = arcsim.obs_friction.unwrap_or(OBSTACLE_FRICTION);
    let mut translated = Vec::with_capacity(arcsim.obstacles.len());
    for (i, obstacle) in arcsim.obstacles.iter().enumerate() {
        let at = format!("obstacles[{i}]");
        notes.rename(&format!("{at}.mesh.obj"), &format!("{at}.mesh"));
        notes.rename(&format!("{at}.friction"), "obs_friction");
        if obstacle.start_time.is_some_and(|s| s > 0.0) || obstacle.end_time.is_some() {
            let key = if obstacle.end_time.is_some() { "end_time" } else { "start_time" };
            notes.unsupported(&format!("{at}.{key}"), "obstacles that come and go");
        }
        let place = format!("{at}.transform");
        translated.push(ObstacleFile {
            name: None,
            mesh: ObstacleMesh { obj: Some(obstacle.mesh.clone()), ..ObstacleMesh::default() },
            transform: translate_transform(obstacle.transform, [&place, &place], notes),
            motion: motion::translate(obstacle.motion, &arcsim.motions, [&at, &at], notes),
            friction,
        });
    }
    if notes.is_disabled("collision") && notes.is_disabled("proximity") {
        if !translated.is_empty() {
            notes.notice("obstacles", "the scene disables contact; obstacles are left out");
        }
        return (Vec::new(), None);
    }
    notes.rename("contact.thickness_m", "magic.repulsion_thickness");
    notes.rename("contact.friction", "friction");
    let contact = ContactFile {
        thickness_m: arcsim.magic.repulsion_thickness.unwrap_or(THICKNESS_M),
        friction: arcsim.friction.unwrap_or(FRICTION),
        self_contact: true,
    };
    (translated, Some(contact))
}
