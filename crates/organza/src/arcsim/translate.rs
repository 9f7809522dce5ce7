//! From ARCSim's keys to the project's own scene format.

use serde_json::Value;

use super::cloth;
use super::format::{ArcsimFile, Magic};
use super::handle;
use super::motion::Motions;
use super::obstacle;
use crate::scene::Files;
use crate::scene::format::{Integrator, Newton, SceneFile, Wind};
use crate::scene::issue::IssueKind;
use crate::scene::locate::Part;
use crate::scene::path::ValuePath;
use crate::scene::typed::{self, Complaint, suggestion};
use crate::scene::unsupported::{asks, unsupported};

/// Pairs of a path in our format and the path in ARCSim's file.
pub(super) type Renames = Vec<(ValuePath, ValuePath)>;

/// Frames of a scene that names no end.
const FRAMES_WITHOUT_END: u32 = 500;

/// Parts of ARCSim that `disable` can name.
const PARTS: [&str; 9] = [
    "proximity",
    "physics",
    "strainlimiting",
    "collision",
    "remeshing",
    "separation",
    "popfilter",
    "plasticity",
    "fracture",
];

/// Collects complaints and renames while translating.
#[derive(Default)]
pub(super) struct Notes {
    pub(super) complaints: Vec<Complaint>,
    pub(super) renames: Renames,
    /// The parts that the scene disables.
    disabled: Vec<String>,
}

impl Notes {
    pub(super) fn is_disabled(&self, part: &str) -> bool {
        self.disabled.iter().any(|disabled| disabled == part)
    }

    /// Our path stands for theirs, parts included.
    pub(super) fn rename(&mut self, ours: &str, theirs: &str) {
        let read = |path| ValuePath::parse(path).unwrap_or_default();
        self.renames.push((read(ours), read(theirs)));
    }

    pub(super) fn unsupported(&mut self, path: &str, what: &str) {
        self.complaints.push(unsupported(ValuePath::parse(path).unwrap_or_default(), what));
    }

    pub(super) fn complain(&mut self, path: &str, message: impl Into<String>) {
        self.note(IssueKind::Value, path, message);
    }

    pub(super) fn notice(&mut self, path: &str, message: impl Into<String>) {
        self.note(IssueKind::Notice, path, message);
    }

    pub(super) fn note(&mut self, kind: IssueKind, path: &str, message: impl Into<String>) {
        let path = ValuePath::parse(path).unwrap_or_default();
        self.complaints.push(Complaint { kind, path, part: Part::Value, message: message.into() });
    }
}

/// True where a file speaks ARCSim: it has keys that only ARCSim knows and none that only we know,
/// or its cloths name their mesh by a plain text.
pub(crate) fn is_arcsim(scene: &Value) -> bool {
    let has = |keys: &[&str]| keys.iter().any(|key| scene.get(key).is_some());
    if has(&["frames", "frames_per_second", "substeps", "integrator", "$schema"]) {
        return false;
    }
    let meshes = scene.get("cloths").and_then(Value::as_array).into_iter().flatten();
    has(&["frame_time", "frame_steps", "timestep", "save_frames", "end_time", "end_frame", "magic"])
        || has(&["motions", "disable", "obs_friction"])
        || meshes.filter_map(|cloth| cloth.get("mesh")).any(Value::is_string)
}

/// Reads an ARCSim scene as one of ours, with the pairs of paths that differ. Complaints name
/// places in ARCSim's file. Nothing is returned where the file is too wrong to go on.
pub(crate) fn read(
    value: &mut Value,
    files: &mut Files<'_>,
    complaints: &mut Vec<Complaint>,
) -> Option<(SceneFile, Renames)> {
    let mut notes = Notes::default();
    let arcsim: Option<ArcsimFile> = typed::read(value, complaints);
    let scene = arcsim.and_then(|arcsim| translate(arcsim, files, &mut notes));
    complaints.append(&mut notes.complaints);
    scene.map(|scene| (scene, notes.renames))
}

fn translate(
    mut arcsim: ArcsimFile,
    files: &mut Files<'_>,
    notes: &mut Notes,
) -> Option<SceneFile> {
    check_parts(&arcsim, notes);
    let time = time(&arcsim, notes);
    let motions = Motions::read(std::mem::take(&mut arcsim.motions), files, notes);
    let (obstacles, contact) = obstacle::translate(&arcsim, &motions, files, notes);
    let extras = arcsim.organza;
    // Still air resists motion too: ARCSim's wind has a density even where none is written.
    let wind = arcsim.wind.as_ref();
    let wind = Wind {
        velocity: wind.and_then(|w| w.velocity).unwrap_or_default(),
        density: wind.and_then(|w| w.density).unwrap_or(1.0),
        drag: wind.and_then(|w| w.drag).unwrap_or(0.0),
    };
    let handles = handle::translate(&arcsim.handles, &motions, &arcsim.magic, notes);
    let cloths = arcsim.cloths.iter().enumerate();
    let cloths: Vec<_> = cloths
        .map(|(i, cloth)| cloth::translate(cloth, i, extras.bending.unwrap_or_default(), notes))
        .collect();
    for key in ["name", "integrator", "newton", "linear_solver", "linear_tolerance", "camera"] {
        notes.rename(key, &format!("organza.{key}"));
    }
    notes.rename("recording", "organza.recording");
    let time = time?;
    Some(SceneFile {
        crowd: None,
        schema: None,
        name: extras.name,
        frames: time.frames,
        frames_per_second: time.frames_per_second,
        substeps: time.substeps,
        gravity: arcsim.gravity.unwrap_or_default(),
        wind: Some(wind),
        // As ARCSim: implicit Euler, solved for what one sees rather than to the last digit.
        integrator: extras.integrator.unwrap_or(Integrator::ImplicitEuler),
        newton: extras.newton.unwrap_or(Newton { max_iterations: 4, tolerance: 0.1 }),
        linear_solver: extras.linear_solver.unwrap_or_default(),
        linear_tolerance: extras.linear_tolerance.unwrap_or(1e-3),
        cloths: cloths.into_iter().collect::<Option<_>>()?,
        handles,
        obstacles,
        fluids: Vec::new(),
        contact,
        camera: extras.camera,
        shots: Vec::new(),
        view: None,
        restraint: None,
        recording: extras.recording.unwrap_or_default(),
    })
}

struct Time {
    frames: u32,
    frames_per_second: f64,
    substeps: u32,
}

/// Frame rate, substeps and number of frames, from either of the two ways to write them.
fn time(arcsim: &ArcsimFile, notes: &mut Notes) -> Option<Time> {
    let (frame_s, substeps, key) = match (arcsim.frame_time, arcsim.timestep) {
        (Some(frame_s), _) => {
            notes.rename("substeps", "frame_steps");
            (frame_s, arcsim.frame_steps.unwrap_or(1), "frame_time")
        }
        (None, Some(step_s)) => {
            notes.rename("substeps", "save_frames");
            let substeps = arcsim.save_frames.unwrap_or(1);
            (step_s * f64::from(substeps.max(1)), substeps, "timestep")
        }
        (None, None) => {
            notes.note(IssueKind::Structure, "", "key `frame_time` is missing");
            return None;
        }
    };
    notes.rename("frames_per_second", key);
    if !(frame_s > 0.0 && frame_s.is_finite()) {
        notes.complain(key, format!("must be positive and finite, got {frame_s}"));
        return None;
    }
    // ARCSim stops at whichever end comes first.
    let ends = [
        ("end_time", arcsim.end_time.map(|s| s / frame_s)),
        ("duration", arcsim.duration.map(|s| s / frame_s)),
        ("end_frame", arcsim.end_frame.map(f64::from)),
    ];
    let ends = ends.into_iter().filter_map(|(key, end)| Some((key, end?.round())));
    let (key, frames) = match ends.min_by(|a, b| a.1.total_cmp(&b.1)) {
        Some(end) => end,
        None => {
            let message = format!("the scene names no end: {FRAMES_WITHOUT_END} frames are run");
            notes.notice("", message);
            (key, f64::from(FRAMES_WITHOUT_END))
        }
    };
    notes.rename("frames", key);
    if !(1.0..=f64::from(u32::MAX)).contains(&frames) {
        notes.complain(key, format!("asks for {frames} frames, must be at least 1 and below 4e9"));
        return None;
    }
    // The range is checked above and the value is whole.
    let frames = frames as u32;
    Some(Time { frames, frames_per_second: 1.0 / frame_s, substeps })
}

/// Everything that is not translated because this version has no such part.
fn check_parts(arcsim: &ArcsimFile, notes: &mut Notes) {
    for (i, part) in arcsim.disable.iter().enumerate() {
        if !PARTS.contains(&part.as_str()) {
            let hint = suggestion(part, &PARTS);
            notes.complain(&format!("disable[{i}]"), format!("unknown part `{part}`{hint}"));
        }
    }
    notes.disabled = arcsim.disable.clone();
    if notes.is_disabled("physics") {
        notes.unsupported("disable", "a scene without physics");
    }
    if arcsim.morphs.as_ref().is_some_and(asks) {
        notes.unsupported("morphs", "morphs");
    }
    check_magic(&arcsim.magic, notes);
}

fn check_magic(magic: &Magic, notes: &mut Notes) {
    let switches = [
        ("fixed_high_res_mesh", magic.fixed_high_res_mesh == Some(true), "a fixed fine mesh"),
        ("rib_stiffening", magic.rib_stiffening.is_some_and(|x| x != 1.0), "rib stiffening"),
        ("preserve_creases", magic.preserve_creases == Some(true), "creases kept by remeshing"),
        ("combine_tensors", magic.combine_tensors == Some(false), "sizing by averaged tensors"),
        ("add_jitter", magic.add_jitter == Some(true), "jitter"),
        (
            "relax_initial_state",
            magic.relax_initial_state == Some(true),
            "relaxing the initial state",
        ),
    ];
    for (key, asked, what) in switches {
        if asked {
            notes.unsupported(&format!("magic.{key}"), what);
        }
    }
}
