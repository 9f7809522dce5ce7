//! Mesh sizes by view (Koh2014): what they save, and what that costs the picture.

mod growth;
mod options;
mod plot;
mod quality;
mod table;

use super::program::Program;
use super::report::Report;
use super::{Benchmark, Context, told_by_tests};
use crate::command::Failure;
use serde_json::Value;
use std::path::PathBuf;

/// The names of its figures.
const FIGURES: &[&str] = &[
    "view.*.faces.*",
    "view.*.vertices.*",
    "view.*.s_per_frame.*",
    "view.*.crossings.*",
    "view.*.speedup",
    "view.*.speedup_over_fixed",
    "view.*.overhead_fraction",
    "view.overhead_fraction",
    "view.*.pixel_error",
    "view.*.chaos_floor",
    "view.*.short.pixel_error",
    "view.*.short.chaos_floor",
    "view.*.onward.pixel_error",
    "view.*.onward.chaos_floor",
    "view.*.pop",
    "view.*.pop_floor",
    "view.distance.edge_px",
    "view.distance.edge_px_spread",
    "view.coarse_sag.*",
    "view.option.*.cpu_ratio",
    "view.option.*.faces_ratio",
    "view.crowd.*.cpu_s_per_frame.*",
    "view.crowd.*.speedup",
];

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "view",
    summary: "mesh sizes by view: speed-up, error in pixels, growth with the scene",
    figures: FIGURES,
    run,
};

/// The scenes of Table 1 with the frames of a whole run and of a quick one, of adaptive and of fixed
/// meshes. A fixed mesh as fine as the finest edges is expensive, and as expensive in any frame.
const SCENES: [Scene; 3] = [
    Scene {
        name: "karate",
        cloths: &["cloths[0]", "cloths[1]"],
        finest: 0.013,
        frames: [240, 4],
        fixed_frames: [4, 1],
        starts: [50, 110, 15],
    },
    Scene {
        name: "dancer",
        cloths: &["cloths[0]"],
        finest: 0.015,
        frames: [300, 12],
        fixed_frames: [8, 0],
        starts: [40, 280, 20],
    },
    Scene {
        name: "dancers",
        cloths: &["crowd.cloths[0]"],
        finest: 0.015,
        frames: [300, 3],
        fixed_frames: [2, 0],
        starts: [20, 50, 15],
    },
];

/// A scene of Table 1.
struct Scene {
    name: &'static str,
    /// The cloths that are remeshed.
    cloths: &'static [&'static str],
    /// Length of the edges of a fixed mesh: the shortest that an adaptive one may have (m).
    finest: f64,
    /// Frames of a whole run and of a quick one.
    frames: [usize; 2],
    /// The same on a fixed mesh; 0 for no such run.
    fixed_frames: [usize; 2],
    /// First and last frame from which short runs start, and their distance.
    starts: [usize; 3],
}

impl Scene {
    fn path(&self, context: &Context) -> PathBuf {
        context.root.join(format!("scenes/{}.json5", self.name))
    }
}

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let tables = SCENES.iter().map(|scene| scene.name);
    let parts: Vec<&str> = tables.chain(["tests", "distance", "options", "crowd"]).collect();
    for name in context.chosen(report, &parts, |name| name) {
        let measure = |report: &mut Report| match *name {
            "tests" => told_by_tests::sag(context, report),
            "distance" => quality::distance(context, report),
            "options" => options::run(context, report),
            "crowd" => growth::run(context, report),
            name => SCENES.iter().filter(|scene| scene.name == name).try_for_each(|scene| {
                table::run(context, report, scene)?;
                context.save(report)?;
                quality::error(context, report, scene)
            }),
        };
        context.part(report, &format!("view/{name}"), measure)?;
    }
    Ok(())
}

/// Asks the program that measures pictures.
pub(super) fn ask(program: &Program, arguments: &[String]) -> Result<Value, Failure> {
    let told = program.example("view_quality", arguments)?;
    serde_json::from_str(&told).map_err(|e| Failure::Unable(format!("view_quality: {e}")))
}
