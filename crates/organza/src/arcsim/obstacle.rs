//! Obstacles and contact of ARCSim.

use super::cloth::translate_transform;
use super::format::{ArcsimFile, ArcsimObstacle, ArcsimObstacles};
use super::motion::Motions;
use super::translate::Notes;
use crate::scene::format::{ContactFile, ObstacleFile, ObstacleMesh};
use crate::scene::issue::IssueKind;
use crate::scene::limits::{MAX_MESH_BYTES, MAX_OBSTACLES};
use crate::scene::motion::Transform;
use crate::scene::pattern::Pattern;
use crate::scene::{FileError, Files};

/// Friction of cloth on cloth and on obstacles where the scene names none (1).
const FRICTION: f64 = 0.6;
const OBSTACLE_FRICTION: f64 = 0.3;
/// Thickness of contact where the scene names none (m).
const THICKNESS_M: f64 = 1e-3;

/// Translates obstacles and contact. Everything touches everything, unless the scene disables both
/// ways to see to it; then obstacles are left out with what they do.
pub(super) fn translate(
    arcsim: &ArcsimFile,
    motions: &Motions,
    files: &mut Files<'_>,
    notes: &mut Notes,
) -> (Vec<ObstacleFile>, Option<ContactFile>) {
    if notes.is_disabled("collision") && notes.is_disabled("proximity") {
        let given = match &arcsim.obstacles {
            ArcsimObstacles::List(list) => !list.is_empty(),
            ArcsimObstacles::Pattern(_) => true,
        };
        if given {
            notes.notice("obstacles", "the scene disables contact; obstacles are left out");
        }
        return (Vec::new(), None);
    }
    let friction = arcsim.obs_friction.unwrap_or(OBSTACLE_FRICTION);
    let obstacles = match &arcsim.obstacles {
        ArcsimObstacles::List(list) => {
            let listed = list.iter().enumerate();
            listed
                .map(|(i, obstacle)| listed_obstacle(obstacle, i, friction, motions, notes))
                .collect()
        }
        ArcsimObstacles::Pattern(pattern) => {
            numbered(pattern, friction, motions, files, notes).unwrap_or_default()
        }
    };
    notes.rename("contact.thickness_m", "magic.repulsion_thickness");
    notes.rename("contact.friction", "friction");
    let contact = ContactFile {
        thickness_m: arcsim.magic.repulsion_thickness.unwrap_or(THICKNESS_M),
        friction: arcsim.friction.unwrap_or(FRICTION),
        self_contact: true,
    };
    (obstacles, Some(contact))
}

/// Translates obstacle number `i` of the list.
fn listed_obstacle(
    obstacle: &ArcsimObstacle,
    i: usize,
    friction: f64,
    motions: &Motions,
    notes: &mut Notes,
) -> ObstacleFile {
    let at = format!("obstacles[{i}]");
    notes.rename(&format!("{at}.mesh.obj"), &format!("{at}.mesh"));
    notes.rename(&format!("{at}.friction"), "obs_friction");
    notes.rename(&format!("{at}.start_s"), &format!("{at}.start_time"));
    notes.rename(&format!("{at}.end_s"), &format!("{at}.end_time"));
    let place = format!("{at}.transform");
    ObstacleFile {
        name: None,
        mesh: ObstacleMesh { obj: Some(obstacle.mesh.clone()), ..ObstacleMesh::default() },
        transform: translate_transform(obstacle.transform, [&place, &place], notes),
        motion: motions.translate(obstacle.motion, [&at, &at], notes),
        friction,
        thickness_m: None,
        start_s: obstacle.start_time.unwrap_or(0.0),
        end_s: obstacle.end_time,
    }
}

/// Obstacles of the files whose names have the numbers 0, 1 and so on until there is none; each has
/// the motion of its number if there is one.
fn numbered(
    pattern: &str,
    friction: f64,
    motions: &Motions,
    files: &mut Files<'_>,
    notes: &mut Notes,
) -> Option<Vec<ObstacleFile>> {
    let pattern =
        Pattern::parse(pattern).map_err(|message| notes.complain("obstacles", message)).ok()?;
    let mut obstacles = Vec::new();
    for number in 0..MAX_OBSTACLES {
        let name = pattern.name(number as u32);
        match files.read(&name, MAX_MESH_BYTES) {
            Ok(_) => {}
            Err(FileError::Missing(message)) => {
                if number == 0 {
                    notes.note(IssueKind::File, "obstacles", message);
                }
                break;
            }
            Err(FileError::Unreadable(message)) => {
                notes.note(IssueKind::File, "obstacles", message);
                return None;
            }
        }
        let at = format!("obstacles[{number}]");
        let motion = motions.count().filter(|&n| number < n).map(|_| number as i64);
        notes.rename(&format!("{at}.mesh"), "obstacles");
        notes.rename(&format!("{at}.mesh.obj"), "obstacles");
        notes.rename(&format!("{at}.friction"), "obs_friction");
        let motion = motions.translate(motion, [&at, "obstacles"], notes);
        obstacles.push(ObstacleFile {
            name: None,
            mesh: ObstacleMesh { obj: Some(name), ..ObstacleMesh::default() },
            transform: Transform::default(),
            motion,
            friction,
            thickness_m: None,
            start_s: 0.0,
            end_s: None,
        });
    }
    Some(obstacles)
}
