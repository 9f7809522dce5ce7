//! The flag in the wind: fixed against adaptive, and ARCSim's own flag.

use super::report::Report;
use super::{Benchmark, Context, arcsim, fixed_or_adaptive};
use crate::command::Failure;

/// The names of its figures.
const FIGURES: &[&str] = &[
    "flag.cpu_s_per_frame.*",
    "flag.peak_mb.*",
    "flag.stage_s.*.*",
    "flag.faces.*",
    "flag.error.*",
    "flag.arcsim_*_cpu_s",
    "flag.arcsim_*_cpu_ratio",
    "flag.arcsim_*_peak_mb",
    "flag.arcsim_*_faces.*",
    "flag.arcsim_*_stretch.*",
    "flag.arcsim_*_intersections",
];

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "flag",
    summary: "cloth on a fixed and on an adaptive mesh, against a finer reference and ARCSim",
    figures: FIGURES,
    run,
};

fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    if let Some(scene) = &context.options.scene {
        // Figures of another scene bear its name, so that they are not taken for the flag's.
        let name = scene.file_stem().unwrap_or_default().to_string_lossy();
        return fixed_or_adaptive::run(context, report, &name, scene);
    }
    context.part(report, "flag/scene", |report| {
        fixed_or_adaptive::run(context, report, "flag", &context.root.join("scenes/flag.json5"))
    })?;
    context.part(report, "flag/arcsim", |report| arcsim::run(context, report, &arcsim::FLAG))
}
