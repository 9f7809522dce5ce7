//! What a recording tells about its run: a row per frame, and totals.

use std::path::Path;

use io_mcap::{Recording, Status};
use serde::ser::{SerializeMap, Serializer};
use serde::{Deserialize, Serialize};

use crate::record::{FLUID, OBSTACLES, RunError};
use crate::report::{FluidSummary, FrameReport, RestraintSummary};

/// Whether a recording is whole.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Wholeness {
    /// `complete`, `cut` or `damaged`.
    pub state: String,
    /// The same in a sentence, with what is missing.
    pub message: String,
}

impl Wholeness {
    fn of(status: &Status) -> Self {
        let state = match status {
            Status::Complete => "complete",
            Status::Cut { .. } => "cut",
            Status::Damaged { .. } => "damaged",
        };
        Self { state: state.into(), message: status.to_string() }
    }
}

/// Smallest, mean and largest value and the sum of a figure over frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Smallest (unit of the values).
    pub min: f64,
    /// Mean (unit of the values).
    pub mean: f64,
    /// Largest (unit of the values).
    pub max: f64,
    /// Sum (unit of the values).
    pub sum: f64,
}

impl Spread {
    /// The spread of some values; `None` for none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values = values.into_iter();
        let first = values.next()?;
        let (mut n, mut spread) = (1.0, Self { min: first, mean: 0.0, max: first, sum: first });
        for value in values {
            spread.min = spread.min.min(value);
            spread.max = spread.max.max(value);
            spread.sum += value;
            n += 1.0;
        }
        spread.mean = spread.sum / n;
        Some(spread)
    }
}

/// A named number of every frame.
type Figure = (&'static str, fn(&FrameReport) -> f64);

/// The figures of [`Info::totals`], in the order shown.
const FIGURES: [Figure; 31] = [
    ("vertices", |r| r.vertices as f64),
    ("faces", |r| r.faces as f64),
    ("substeps", |r| f64::from(r.substeps)),
    ("retries", |r| f64::from(r.retries)),
    ("newton_iterations", |r| r.newton_iterations as f64),
    ("linear_iterations", |r| r.linear_iterations as f64),
    ("factorisations", |r| r.factorisations as f64),
    ("unconverged_stages", |r| r.unconverged_stages as f64),
    ("contacts", |r| r.contacts as f64),
    ("shortened_ways", |r| r.shortened_ways as f64),
    ("crossings", |r| r.crossings.unwrap_or(0) as f64),
    ("yielded", |r| r.yielded as f64),
    ("splits", |r| r.remesh.map_or(0.0, |m| m.splits as f64)),
    ("flips", |r| r.remesh.map_or(0.0, |m| m.flips as f64)),
    ("collapses", |r| r.remesh.map_or(0.0, |m| m.collapses as f64)),
    ("kinetic_energy_j", |r| r.kinetic_energy_j),
    ("active", |r| rest(r, |s| s.active)),
    ("transition", |r| rest(r, |s| s.transition)),
    ("resting", |r| rest(r, |s| s.resting)),
    ("stages_slept", |r| rest(r, |s| s.stages_slept)),
    ("solves", |r| rest(r, |s| s.solves)),
    ("unknowns", |r| rest(r, |s| s.unknowns)),
    ("woken", |r| rest(r, |s| s.woken)),
    ("seconds.total", |r| r.seconds.total),
    ("seconds.build", |r| r.seconds.build),
    ("seconds.assembly", |r| r.seconds.assembly),
    ("seconds.linear", |r| r.seconds.linear),
    ("seconds.energy", |r| r.seconds.energy),
    ("seconds.contact", |r| r.seconds.contact),
    ("seconds.sizing", |r| r.seconds.sizing),
    ("seconds.remesh", |r| r.seconds.remesh),
];

/// A named number of the fluid in every frame.
type FluidFigure = (&'static str, fn(&FluidSummary) -> f64);

/// More of them, for recordings with a fluid.
const FLUID_FIGURES: [FluidFigure; 23] = [
    ("fluid.particles", |f| f.particles as f64),
    ("fluid.active", |f| f.active as f64),
    ("fluid.transition", |f| f.transition as f64),
    ("fluid.restrained", |f| f.restrained as f64),
    ("fluid.steps", |f| f.steps as f64),
    ("fluid.step_s", |f| f.step_s),
    ("fluid.moved", |f| f.moved as f64),
    ("fluid.sweeps", |f| f.sweeps as f64),
    ("fluid.density_pairs", |f| f.density_pairs as f64),
    ("fluid.force_pairs", |f| f.force_pairs as f64),
    ("fluid.listings", |f| f.listings as f64),
    ("fluid.emitted", |f| f.emitted as f64),
    ("fluid.drained", |f| f.drained as f64),
    ("fluid.stopped", |f| f.stopped as f64),
    ("fluid.squeezed", |f| f.squeezed as f64),
    ("fluid.density_max_kg_per_m3", |f| f.density_max_kg_per_m3),
    ("fluid.kinetic_energy_j", |f| f.kinetic_energy_j),
    ("fluid.seconds.motion", |f| f.seconds.motion),
    ("fluid.seconds.neighbours", |f| f.seconds.neighbours),
    ("fluid.seconds.density", |f| f.seconds.density),
    ("fluid.seconds.force", |f| f.seconds.force),
    ("fluid.seconds.changes", |f| f.seconds.changes),
    ("fluid.seconds.sheets", |f| f.seconds.sheets),
];

/// A number of the restraint of a frame; zero where nothing is restrained.
fn rest(report: &FrameReport, of: fn(&RestraintSummary) -> usize) -> f64 {
    report.restraint.as_ref().map_or(0.0, |summary| of(summary) as f64)
}

/// What a recording tells about its run. As JSON an object with these keys; `totals` is an object
/// from the name of a figure, such as `faces` or `seconds.total`, to its [`Spread`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Info {
    /// The file as it was named by the caller.
    pub recording: String,
    /// The program that recorded, with its version.
    pub software: String,
    /// Name of the scene.
    pub scene: String,
    /// Number of frames that the run was to have after the first; absent if the file does not say.
    pub frames_planned: Option<u64>,
    /// Whether the recording is whole.
    pub status: Wholeness,
    /// Frames with a checkpoint.
    pub checkpoints: Vec<u64>,
    /// Names of the obstacles in the order of the scene.
    pub obstacles: Vec<String>,
    /// Name of the fluid, if there is one.
    pub fluid: Option<String>,
    /// Names of the attached files, the scene first.
    pub attachments: Vec<String>,
    /// The report of every complete frame; frame 0 is the initial state.
    pub frames: Vec<FrameReport>,
    /// Spread of every figure over all frames but frame 0; empty if there are none.
    #[serde(serialize_with = "as_object")]
    pub totals: Vec<(&'static str, Spread)>,
    /// Stages that the scene did not need, and why, each once.
    pub skipped: Vec<String>,
}

impl Info {
    /// Reads the reports of a recording, and none of its meshes.
    ///
    /// # Errors
    /// The recording cannot be read, or holds reports of another form.
    pub fn read(path: &Path) -> Result<Info, RunError> {
        let mut recording = Recording::open(path).map_err(RunError::recording(path))?;
        let indices: Vec<u64> = recording.frames().map(|frame| frame.index).collect();
        let mut frames = Vec::with_capacity(indices.len());
        for index in indices {
            let report = recording.report(index).map_err(RunError::recording(path))?;
            let report = FrameReport::deserialize(report).map_err(|error| {
                let what = format!("the report of frame {index} is of another form: {error}");
                RunError::Unusable { path: path.to_owned(), what }
            })?;
            frames.push(report);
        }
        let metadata = recording.metadata();
        let obstacles = metadata.get(OBSTACLES);
        let mut skipped: Vec<String> = Vec::new();
        for stage in frames.iter().flat_map(|frame| &frame.skipped) {
            if !skipped.contains(stage) {
                skipped.push(stage.clone());
            }
        }
        Ok(Info {
            recording: path.display().to_string(),
            software: recording.software().to_owned(),
            scene: metadata.get("name").cloned().unwrap_or_default(),
            frames_planned: metadata.get("frames").and_then(|n| n.parse().ok()),
            status: Wholeness::of(&recording.status()),
            checkpoints: recording.checkpoints().map(|c| c.frame).collect(),
            obstacles: obstacles
                .and_then(|names| serde_json::from_str(names).ok())
                .unwrap_or_default(),
            fluid: metadata.get(FLUID).cloned(),
            attachments: recording.attachments().into_iter().map(|a| a.name).collect(),
            totals: totals(&frames),
            skipped,
            frames,
        })
    }

    /// The spread of one figure.
    pub fn total(&self, figure: &str) -> Option<Spread> {
        self.totals.iter().find(|(name, _)| *name == figure).map(|(_, spread)| *spread)
    }
}

/// Spread of every figure over all frames but frame 0.
pub fn totals(frames: &[FrameReport]) -> Vec<(&'static str, Spread)> {
    let made = || frames.iter().filter(|frame| frame.frame > 0);
    let spread = |(name, figure): Figure| Some((name, Spread::of(made().map(figure))?));
    let of_fluid = |(name, figure): FluidFigure| {
        Some((name, Spread::of(made().filter_map(|frame| frame.fluid.as_ref()).map(figure))?))
    };
    let all = FIGURES.into_iter().filter_map(spread);
    all.chain(FLUID_FIGURES.into_iter().filter_map(of_fluid)).collect()
}

fn as_object<S: Serializer>(
    totals: &[(&'static str, Spread)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(totals.len()))?;
    for (name, spread) in totals {
        map.serialize_entry(name, spread)?;
    }
    map.end()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spreads_of_none_one_and_many() {
        assert_eq!(Spread::of([]), None);
        assert_eq!(Spread::of([3.0]), Some(Spread { min: 3.0, mean: 3.0, max: 3.0, sum: 3.0 }));
        let many = Spread::of([2.0, -1.0, 5.0]);
        assert_eq!(many, Some(Spread { min: -1.0, mean: 2.0, max: 5.0, sum: 6.0 }));
    }
}
