//! Growth with the vertices of a fixed mesh, and memory for each.

use super::super::Context;
use super::super::machine;
use super::super::program::Simulation;
use super::super::report::{Figure, Report};
use super::{Growth, LIMIT_S, Sample, too_large};
use crate::command::{Failure, say};

/// A way to solve.
struct Way {
    /// Its figures are `scaling.NAME` and `memory.MEMORY`.
    name: &'static str,
    memory: &'static str,
    /// More keys of the scene.
    keys: &'static str,
    /// Cells along each side: a whole run, and a quick one.
    cells: [&'static [usize]; 2],
    says: &'static str,
}

const WAYS: [Way; 2] = [
    Way {
        name: "vertices",
        memory: "bytes_per_vertex",
        keys: "substeps: 2",
        cells: [&[31, 99, 315], &[15, 31, 79]],
        says: "Second-order steps of 20 ms, Newton's method to 1e-3 m/s, sparse Cholesky.",
    },
    Way {
        name: "vertices_fast",
        memory: "bytes_per_vertex_fast",
        keys: "substeps: 4, integrator: 'implicit-euler', newton: { max_iterations: 1 }, \
               linear_solver: 'pcg', linear_tolerance: 1e-2",
        cells: [&[31, 99, 315, 999], &[15, 31, 79]],
        says: "Implicit Euler steps of 10 ms of one iteration, conjugate gradients to 1e-2.",
    },
];

/// Frames whose cost is measured.
const FRAMES: usize = 4;
/// How much more memory than foretold a run may need.
const ROOM: f64 = 1.5;

pub(super) fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    WAYS.iter().try_for_each(|way| one(context, report, way))
}

fn one(context: &Context, report: &mut Report, way: &Way) -> Result<(), Failure> {
    let Way { name, memory, keys, cells, says } = way;
    say(format!("{name}: a sheet that falls from two corners"));
    let mut samples: Vec<Sample> = Vec::new();
    for cells in cells[usize::from(context.options.quick)] {
        let size = ((cells + 1) * (cells + 1)) as f64;
        if let Some(why) = samples.last().and_then(|last| why_not(last, size)) {
            too_large(report, name, size, &why);
            break;
        }
        let text = format!(
            "{{ frames: 1, {keys}, cloths: [{{ fabric: 'woven-light',
                 mesh: {{ grid: {{ size_m: [1, 1], cells: [{cells}, {cells}] }} }} }}],
               handles: [{{ select: {{ corners: ['upper-left', 'upper-right'] }} }}],
               camera: {{ position: [2.6, -2.2, 0.6], target: [0.5, 0.7, -0.35],
                 resolution: [128, 72] }} }}"
        );
        let scene = context.scene(&format!("scaling_{name}_{cells}"), &text)?;
        let out = scene.with_extension("mcap");
        let simulation = Simulation { scene, frames: FRAMES, sets: Vec::new(), out };
        samples.push(Sample::take(context, size, &simulation)?);
    }
    let iterations: Vec<String> = samples
        .iter()
        .map(|Sample { run: r, .. }| {
            let per_stage = |what: &str| r.info.sum(what) / r.info.sum("/stages");
            format!(
                "{:.1} and {:.0}",
                per_stage("/newton_iterations"),
                per_stage("/linear_iterations")
            )
        })
        .collect();
    let note = format!(
        "A square sheet of one metre that falls from two corners, frames 2 to {}. {says} Newton's and \
         linear iterations a stage: {}.",
        1 + FRAMES,
        iterations.join(", ")
    );
    Growth { name, plot: "growth with the mesh", axis: "vertices", note }.tell(report, &samples);
    let note = "Growth of the peak of resident memory of the process from the smallest mesh to the \
                largest, by the vertices that it has more.";
    report.add(
        &format!("memory.{memory}"),
        per_vertex(&samples).and_then(|bytes| Figure::exact(bytes, "B", &format!("{note} {says}"))),
    );
    Ok(())
}

/// Why a mesh of so many vertices is not for this machine, judged by a smaller one.
fn why_not(last: &Sample, size: f64) -> Option<String> {
    if last.forbids(size) {
        return Some(format!("it may take more than {LIMIT_S:.0} CPU seconds"));
    }
    let needed = last.run.peak_mb? * ROOM * size / last.size;
    let available = machine::available_mb()?;
    (needed > available)
        .then(|| format!("it may need {needed:.0} MB of memory, and {available:.0} MB are free"))
}

/// Bytes that a vertex takes, without what every process takes.
fn per_vertex(samples: &[Sample]) -> Option<f64> {
    let (first, last) = (samples.first()?, samples.last()?);
    let more = last.size - first.size;
    (more > 0.0).then_some(1e6 * (last.run.peak_mb? - first.run.peak_mb?) / more)
}
