//! Checks a crowd, and makes its members.

use super::super::check::At;
use super::super::data::{Cloth, MeshSource, Obstacle, ObstacleSource};
use super::super::format::{CharacterFile, ClothFile, CrowdFile};
use super::super::limits;
use super::super::motion::Transform;
use super::restraint::Run;
use super::{Context, cloth, obstacle};

/// The characters of a crowd, each with its cloth, in a scene of some duration (s).
pub(super) fn resolve(
    crowd: CrowdFile,
    run: Run,
    at: &At<'_>,
    context: &mut Context<'_, '_>,
) -> Option<Vec<(Obstacle, Cloth)>> {
    at.key("count").at_least(crowd.count, 1);
    if crowd.count as usize > limits::MAX_CROWD {
        let (n, limit) = (crowd.count, limits::MAX_CROWD);
        at.key("count").complain(format!("{n} characters are beyond the limit of {limit}"));
        return None;
    }
    for (i, spacing) in crowd.spacing_m.into_iter().enumerate() {
        at.key("spacing_m").index(i).not_negative(spacing, limits::MAX_COORDINATE_M, "m");
    }
    if let Some(columns) = crowd.columns {
        at.key("columns").at_least(columns, 1);
    }
    at.key("friction").not_negative(crowd.friction, limits::MAX_FRICTION, "");
    obstacle::check_character(&crowd.character, &at.key("character"));
    let cloths = at.key("cloths");
    if crowd.cloths.is_empty() {
        cloths.complain("a crowd needs at least one cloth to wear");
    }
    context.in_crowd = true;
    let wear: Vec<Option<Cloth>> = crowd
        .cloths
        .iter()
        .enumerate()
        .map(|(i, file)| worn(file, run, &cloths.index(i), context))
        .collect();
    context.in_crowd = false;
    let wear = wear.into_iter().collect::<Option<Vec<_>>>().filter(|wear| !wear.is_empty())?;
    Some((0..crowd.count).map(|k| member(k, &crowd, &wear)).collect())
}

/// A cloth that a crowd wears.
fn worn(file: &ClothFile, run: Run, at: &At<'_>, context: &mut Context<'_, '_>) -> Option<Cloth> {
    if file.name.is_some() {
        at.key("name")
            .complain("cloths of a crowd have the names of their characters: leave it out");
    }
    let cloth = cloth::resolve(file.clone(), String::new(), run, at, context)?;
    if matches!(cloth.mesh, MeshSource::Garment(_)) {
        return Some(cloth);
    }
    at.key("mesh").complain("a crowd wears garments alone");
    None
}

/// Character number `k` and its cloth.
fn member(k: u32, crowd: &CrowdFile, wear: &[Cloth]) -> (Obstacle, Cloth) {
    let columns =
        crowd.columns.unwrap_or_else(|| f64::from(crowd.count).sqrt().ceil() as u32).max(1);
    let rows = crowd.count.div_ceil(columns);
    // The middle of the first row to the last, around the origin.
    let along = |k: u32, n: u32| f64::from(k) - 0.5 * f64::from(n - 1);
    let place = [along(k % columns, columns.min(crowd.count)), along(k / columns, rows)];
    let name = format!("crowd{k}");
    let motion = match crowd.motions.len() {
        0 => crowd.character.motion,
        n => crowd.motions[k as usize % n],
    };
    // Steps of the golden ratio fill the cycle evenly, however many there are.
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let character = CharacterFile {
        motion,
        phase: (crowd.character.phase + GOLDEN * f64::from(k)).fract(),
        seed: crowd.character.seed.wrapping_add(k),
        ..crowd.character
    };
    let mut cloth = wear[k as usize % wear.len()].clone();
    cloth.name.clone_from(&name);
    if let MeshSource::Garment(garment) = &mut cloth.mesh {
        garment.on.clone_from(&name);
    }
    let translate = [place[0] * crowd.spacing_m[0], place[1] * crowd.spacing_m[1], 0.0];
    let obstacle = Obstacle {
        name,
        mesh: ObstacleSource::Character(character),
        transform: Transform { translate, ..Transform::default() },
        motion: None,
        friction: crowd.friction,
        thickness_m: None,
        start_s: 0.0,
        end_s: f64::INFINITY,
    };
    (obstacle, cloth)
}
