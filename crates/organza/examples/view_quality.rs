//! What mesh sizes by view do to what the camera sees, as one JSON object.
//!
//! ```text
//! view_quality error SCENE FIRST LAST EVERY HORIZON    distance from adaptive runs, floor, popping
//! view_quality edges SCENE FRAMES                      mean length of visible edges in every frame
//! view_quality against SCENE START HORIZON ALONG TRUTH OTHER ...   distance of others from the truth
//! view_quality recorded SCENE TRUTH OTHER ...    the same of recordings, mean over all frames
//! ```
//!
//! ALONG, TRUTH and OTHER are settings of the scene, `PATH=VALUE`, with `&&` between two; `-` for none.
//!
//! All in pixels of the scene's camera, over material points that it sees: inside the picture, on faces
//! that face it.

use std::error::Error;
use std::path::Path;

use io_mcap::{Checkpoint, OwnedGarment, Recording};
use mesh_core::geometry::inverse_edges;
use mesh_core::{ClothState, Material2, TriangleId, World3};
use organza::checkpoint::{restore, save};
use organza::scene::{LoadOptions, Loaded, load};
use organza::world::World;
use serde_json::json;
use sizing_view::{Camera, Frustum};

type Outcome<T> = Result<T, Box<dyn Error>>;

fn main() -> Outcome<()> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |k: usize| -> Outcome<u64> {
        Ok(words.get(k).ok_or("an argument is missing; see the head of the source")?.parse()?)
    };
    let scene = words.get(1).map(String::as_str).unwrap_or_default();
    let told = match words.first().map(String::as_str) {
        Some("error") => error(scene.as_ref(), [number(2)?, number(3)?, number(4)?], number(5)?)?,
        Some("edges") => edges(scene.as_ref(), number(2)?)?,
        Some("against") => against(scene.as_ref(), [number(2)?, number(3)?], &words[4..])?,
        Some("recorded") => recorded(scene.as_ref(), &words[2.min(words.len())..])?,
        _ => return Err("says neither `error` nor `edges` nor `against` nor `recorded`".into()),
    };
    println!("{told}");
    Ok(())
}

/// The scene with some changes.
fn scene(path: &Path, sets: Vec<String>) -> Outcome<Loaded> {
    Ok(load(path, &LoadOptions { sets, allow_unsupported: false })?)
}

/// Where the remeshing of every cloth stands in the file, so that it can be set.
fn remeshings(path: &Path) -> Outcome<Vec<(String, f64)>> {
    let file: serde_json::Value = json5_value(&std::fs::read_to_string(path)?)?;
    let mut all = Vec::new();
    for (list, at) in [(&file["cloths"], "cloths"), (&file["crowd"]["cloths"], "crowd.cloths")] {
        for (k, cloth) in list.as_array().into_iter().flatten().enumerate() {
            if let Some(least) = cloth["remeshing"]["size_m"]["min"].as_f64() {
                all.push((format!("{at}[{k}].remeshing"), least));
            }
        }
    }
    Ok(all)
}

fn json5_value(text: &str) -> Outcome<serde_json::Value> {
    Ok(json5::from_str(text)?)
}

/// Errors of whole runs, compared at every start, and over a short horizon: there one state is given to an
/// adaptive run, to one with view and to one with smallest edges longer by a tenth, which tells the floor.
/// It is that of the adaptive run, all of whose hidden cloth has to get coarse at once, and "onward" that of
/// the run with view. What one remeshing moves is the distance from a run without.
fn error(path: &Path, [first, last, every]: [u64; 3], horizon: u64) -> Outcome<serde_json::Value> {
    let plain = || vec!["view=null".to_owned()];
    let adaptive = scene(path, plain())?;
    let view = scene(path, Vec::new())?;
    let all = remeshings(path)?;
    let mut other = plain();
    other.extend(all.iter().map(|(at, least)| format!("{at}.size_m.min={}", 1.1 * least)));
    let other = scene(path, other)?;
    let mut fixed = plain();
    fixed.extend(all.iter().map(|(at, _)| format!("{at}=null")));
    let fixed = scene(path, fixed)?;

    let mut along = World::new(&adaptive)?;
    let mut seen = World::new(&view)?;
    let mut beside = World::new(&other)?;
    let (mut errors, mut floors) = (vec![], vec![]);
    let [mut short, mut onward] = [(); 2].map(|()| (Vec::new(), Vec::new()));
    let (mut pops, mut pop_floors) = (vec![], vec![]);
    let mut popped = Vec::new();
    for frame in 0..=last {
        if frame >= first && (frame - first) % every == 0 {
            let eye = Eye::new(&view, along.time());
            errors.push(eye.rms(&along.cloth, &seen.cloth));
            floors.push(eye.rms(&along.cloth, &beside.cloth));
            for (world, (errors, floors)) in [(&mut along, &mut short), (&mut seen, &mut onward)] {
                let start = save(world);
                let ahead = |loaded: &Loaded| ahead(loaded, &start, horizon);
                let truth = ahead(&adaptive)?;
                let eye = Eye::new(&view, truth.time());
                errors.push(eye.rms(&truth.cloth, &ahead(&view)?.cloth));
                floors.push(eye.rms(&truth.cloth, &ahead(&other)?.cloth));
            }
        }
        if frame < last {
            beside.advance()?;
        }
        if frame >= first && frame < last {
            // The next frame with its remeshing and without differ by it alone.
            let moved = |world: &mut World| -> Outcome<f64> {
                let start = save(world);
                let mut still = World::new(&fixed)?;
                restore(&mut still, &start)?;
                still.advance()?;
                world.advance()?;
                Ok(Eye::new(&view, world.time()).most(&still.cloth, &world.cloth))
            };
            let pop = moved(&mut seen)?;
            popped.push(json!({ "frame": frame + 1, "px": pop }));
            pops.push(pop);
            pop_floors.push(moved(&mut along)?);
        } else if frame < last {
            along.advance()?;
            seen.advance()?;
        }
    }
    let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    Ok(json!({
        "errors_px": errors, "floors_px": floors,
        "short_errors_px": short.0, "short_floors_px": short.1,
        "onward_errors_px": onward.0, "onward_floors_px": onward.1,
        "pop_px": most(&pops), "pop_floor_px": most(&pop_floors), "pops": popped,
    }))
}

/// A run some frames after it had a state.
fn ahead(loaded: &Loaded, state: &Checkpoint, frames: u64) -> Outcome<World> {
    let mut world = World::new(loaded)?;
    restore(&mut world, state)?;
    for _ in 0..frames {
        world.advance()?;
    }
    Ok(world)
}

/// Distances of runs from the truth some frames after all had the state that the run along has at the
/// start, over the clothes of characters that move.
fn against(
    path: &Path,
    [start, horizon]: [u64; 2],
    variants: &[String],
) -> Outcome<serde_json::Value> {
    let [along, truth, others @ ..] = variants else {
        return Err("an argument is missing; see the head of the source".into());
    };
    let variant = |sets: &String| {
        let each = sets.split("&&").map(str::trim).filter(|set| *set != "-");
        scene(path, each.map(str::to_owned).collect())
    };
    let mut along = World::new(&variant(along)?)?;
    for _ in 0..start {
        along.advance()?;
    }
    let state = save(&mut along);
    let ahead = |loaded: &Loaded| ahead(loaded, &state, horizon);
    let loaded = variant(truth)?;
    let truth = ahead(&loaded)?;
    let moves = |name: &str| truth.obstacles.iter().any(|o| o.name == name && o.is_moving());
    let moving: Vec<_> = truth.garments.iter().filter(|garment| moves(&garment.name)).collect();
    if moving.is_empty() {
        return Err(
            "no character that moves has the name of its cloth, as those of a crowd do".into()
        );
    }
    let counts = |panel: u32| moving.iter().any(|garment| garment.panels.contains(&panel));
    let eye = Eye::new(&loaded, truth.time());
    let mut errors = Vec::new();
    for other in others {
        errors.push(eye.rms_of(&truth.cloth, &ahead(&variant(other)?)?.cloth, &counts));
    }
    Ok(json!({ "errors_px": errors, "garments": moving.len() }))
}

/// Distances of recordings from the truth: of the same visible points in every frame but the first, RMS
/// over the area, mean over the frames.
fn recorded(path: &Path, recordings: &[String]) -> Outcome<serde_json::Value> {
    let [truth, others @ ..] = recordings else {
        return Err("an argument is missing; see the head of the source".into());
    };
    let loaded = scene(path, Vec::new())?;
    let open = |path: &String| Recording::open(Path::new(path));
    let mut truth = open(truth)?;
    let frames: Vec<u64> = truth.frames().map(|frame| frame.index).filter(|&k| k > 0).collect();
    let mut errors = Vec::new();
    for other in others {
        let mut other = open(other)?;
        let (mut sum, mut n) = (0.0, 0);
        for &k in &frames {
            let (a, b) = (truth.frame(k)?, other.frame(k)?);
            let eye = Eye::new(&loaded, a.time_s);
            let garments = a.garments.iter().zip(&b.garments);
            let all = garments.flat_map(|(a, b)| eye.distances_recorded(a, b)).collect::<Vec<_>>();
            sum += rms(&all);
            n += all.len();
        }
        if n == 0 {
            return Err("the camera sees no point that both recordings have".into());
        }
        errors.push(sum / frames.len() as f64);
    }
    Ok(json!({ "errors_px": errors }))
}

/// Mean length of visible edges in the picture, frame by frame.
fn edges(path: &Path, frames: u64) -> Outcome<serde_json::Value> {
    let loaded = scene(path, Vec::new())?;
    let mut world = World::new(&loaded)?;
    let (mut px, mut distances) = (Vec::new(), Vec::new());
    for _ in 0..frames {
        world.advance()?;
        let eye = Eye::new(&loaded, world.time());
        let cloth = &world.cloth;
        let (mut sum, mut n) = (0.0, 0.0);
        for t in cloth.mesh.triangle_ids().filter(|&t| eye.sees(cloth.corners(t))) {
            let corners = cloth.corners(t).map(|x| eye.picture(x));
            for k in 0..3 {
                sum += (corners[(k + 1) % 3] - corners[k]).norm();
                n += 1.0;
            }
        }
        px.push(sum / n);
        let middle = cloth.x.iter().sum::<World3>() / cloth.x.len() as f64;
        distances.push((middle - eye.camera.position()).norm());
    }
    Ok(json!({ "edge_px": px, "distance_m": distances }))
}

/// The camera of a scene at a time.
struct Eye {
    camera: Camera,
    frustum: Frustum,
}

impl Eye {
    fn new(loaded: &Loaded, time: f64) -> Eye {
        let path = loaded.scene.camera_path.as_ref().expect("a scene with view has a camera");
        let camera = path.at(time);
        Eye { camera, frustum: Frustum::new(&camera) }
    }

    /// Where a point is in the picture, from its middle (px).
    fn picture(&self, x: World3) -> Material2 {
        let c = self.frustum.camera_space(x);
        Material2::new(c.x, c.y) * (self.camera.focal_px() / c.z.max(self.camera.near()))
    }

    /// Whether a triangle is in the picture and faces the camera.
    fn sees(&self, corners: [World3; 3]) -> bool {
        let [a, b, c] = corners.map(|x| self.frustum.camera_space(x));
        let inside = corners.iter().all(|x| self.frustum.distance(&[*x; 3]) == 0.0);
        inside && (b - a).cross(&(c - a)).dot(&a) <= 0.0
    }

    /// Distances in the picture of the middles of all triangles of `a` that are seen from the same
    /// points of the material of `b`, with the areas they stand for (px, m²), of panels that count.
    fn distances(
        &self,
        a: &ClothState,
        b: &ClothState,
        counts: &dyn Fn(u32) -> bool,
    ) -> Vec<(f64, f64)> {
        let boxes = Lookup::new(b);
        let seen = a
            .mesh
            .triangle_ids()
            .filter(|&t| counts(a.mesh.panels()[t.index()]) && self.sees(a.corners(t)));
        seen.filter_map(|t| {
            let corners = a.corners(t);
            let [u, v, w] = a.mesh.material()[t.index()];
            let x = (corners[0] + corners[1] + corners[2]) / 3.0;
            let other = boxes.at(b, a.mesh.panels()[t.index()], (u + v + w) / 3.0)?;
            Some(((self.picture(x) - self.picture(other)).norm(), a.mesh.area(t)))
        })
        .collect()
    }

    /// Root of the mean square over the area.
    fn rms(&self, a: &ClothState, b: &ClothState) -> f64 {
        self.rms_of(a, b, &|_| true)
    }

    /// The same, of panels that count.
    fn rms_of(&self, a: &ClothState, b: &ClothState, counts: &dyn Fn(u32) -> bool) -> f64 {
        rms(&self.distances(a, b, counts))
    }

    /// [`Eye::distances`] of a garment in two recordings. The panels of a garment lie side by side.
    fn distances_recorded(&self, a: &OwnedGarment, b: &OwnedGarment) -> Vec<(f64, f64)> {
        let corners =
            |g: &OwnedGarment, t: usize| g.triangles[t].map(|v| World3::from(g.points[v as usize]));
        let seen = (0..a.triangles.len()).filter(|&t| self.sees(corners(a, t)));
        seen.filter_map(|t| {
            let [u, v, w] = a.material[t].map(Material2::from);
            let middle = (u + v + w) / 3.0;
            let other = (0..b.triangles.len()).find_map(|o| {
                interpolate(b.material[o].map(Material2::from), corners(b, o), middle)
            });
            let [p, q, r] = corners(a, t);
            let px = (self.picture((p + q + r) / 3.0) - self.picture(other?)).norm();
            Some((px, 0.5 * (v - u).perp(&(w - u)).abs()))
        })
        .collect()
    }

    fn most(&self, a: &ClothState, b: &ClothState) -> f64 {
        self.distances(a, b, &|_| true).into_iter().map(|(px, _)| px).fold(0.0, f64::max)
    }
}

/// Triangles by panel.
struct Lookup {
    panels: Vec<Vec<TriangleId>>,
}

impl Lookup {
    fn new(cloth: &ClothState) -> Lookup {
        let mut panels = vec![Vec::new(); cloth.densities().len()];
        for t in cloth.mesh.triangle_ids() {
            panels[cloth.mesh.panels()[t.index()] as usize].push(t);
        }
        Lookup { panels }
    }

    /// Where a material point of a panel is (m).
    fn at(&self, cloth: &ClothState, panel: u32, u: Material2) -> Option<World3> {
        self.panels[panel as usize]
            .iter()
            .find_map(|&t| interpolate(cloth.mesh.material()[t.index()], cloth.corners(t), u))
    }
}

/// Where a material point is that is on a triangle with these corners (m).
fn interpolate(material: [Material2; 3], corners: [World3; 3], u: Material2) -> Option<World3> {
    let low = material[0].inf(&material[1]).inf(&material[2]);
    let high = material[0].sup(&material[1]).sup(&material[2]);
    if u.x < low.x || u.y < low.y || u.x > high.x || u.y > high.y {
        return None;
    }
    // u = corner 0 + edges · s.
    let s = inverse_edges(material) * (u - material[0]);
    let weights = [1.0 - s.x - s.y, s.x, s.y];
    let inside = weights.iter().all(|w| *w >= -1e-9);
    inside.then(|| corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2])
}

/// Root of the mean square of distances over areas (px, m²).
fn rms(all: &[(f64, f64)]) -> f64 {
    let area: f64 = all.iter().map(|(_, area)| area).sum();
    if area == 0.0 {
        return 0.0;
    }
    (all.iter().map(|(px, area)| px * px * area).sum::<f64>() / area).sqrt()
}
