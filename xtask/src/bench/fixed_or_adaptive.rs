//! One scene on an adaptive mesh and on a fixed one with as many faces: time, and distance from a
//! finer reference.

use super::Context;
use super::figure::Figure;
use super::program::{Measured, Simulation, fixed_grid};
use super::report::Report;
use super::stages;
use super::surface::{Surface, lattice};
use crate::command::{Failure, say};
use std::fs;
use std::path::{Path, PathBuf};

/// Frames whose error is measured: later ones of a chaotic motion tell nothing.
const HORIZON: usize = 10;
/// Material points in each direction at which surfaces are compared.
const LATTICE: [usize; 2] = [25, 17];
/// How much finer the reference is, in each direction of the sheet and in time.
const FINER: usize = 2;

/// One way to run the scene.
struct Variant<'a> {
    /// `adaptive`, `fixed` or `reference`.
    name: &'static str,
    simulation: Simulation,
    /// Repetitions so far.
    measured: Vec<Measured>,
    context: &'a Context,
}

impl<'a> Variant<'a> {
    fn new(
        context: &'a Context,
        scene: (&str, &Path),
        name: &'static str,
        frames: usize,
        sets: Vec<String>,
    ) -> Variant<'a> {
        let out = context.runs().join(format!("{}_{name}.mcap", scene.0));
        let simulation = Simulation { scene: scene.1.to_owned(), frames, sets, out };
        Variant { name, simulation, measured: Vec::new(), context }
    }

    /// One more repetition.
    fn run(&mut self) -> Result<(), Failure> {
        let (name, again) = (self.name, self.measured.len() + 1);
        say(format!("{name}, run {again}: {} frames", self.simulation.frames));
        let measured = self.context.program.simulate(&self.simulation)?;
        let (cpu_s, faces) = (measured.cpu_s, measured.info.mean("/faces"));
        say(format!("  {cpu_s:.2} CPU seconds, {faces:.0} faces on average"));
        self.measured.push(measured);
        Ok(())
    }

    /// CPU seconds a frame of every repetition.
    fn cpu_s_per_frame(&self) -> Vec<f64> {
        self.measured.iter().map(|m| m.cpu_s / self.simulation.frames as f64).collect()
    }

    /// Surfaces of frames 0 to `last`.
    fn surfaces(&self, last: usize) -> Result<Vec<Surface>, Failure> {
        let folder: PathBuf = self.simulation.out.with_extension("frames");
        self.context.program.export_obj(&self.simulation.out, last, &folder)?;
        let read = |frame| Surface::read(&folder.join(format!("frame_{frame:05}.obj")));
        let surfaces = (0..=last).map(read).collect::<Result<_, _>>().map_err(Failure::Unable);
        // The recording holds all that is in them.
        let _ = fs::remove_dir_all(&folder);
        surfaces
    }
}

/// Runs the scene at `path` in all variants and adds figures that begin with `name`. The scene must
/// have one cloth, made by `grid`.
pub(super) fn run(
    context: &Context,
    report: &mut Report,
    name: &str,
    path: &Path,
) -> Result<(), Failure> {
    let options = &context.options;
    let frames = options.frames();
    let last = frames.min(HORIZON);
    let variant = |kind, frames, sets| Variant::new(context, (name, path), kind, frames, sets);

    let mut adaptive = variant("adaptive", frames, Vec::new());
    adaptive.run()?;
    let adaptive_surfaces = adaptive.surfaces(last)?;
    let info = &adaptive.measured[0].info;
    let extent = adaptive_surfaces[0].extent();
    let cells = cells(extent, info.mean("/faces"));
    // A frame of which no step failed has as many as the scene says.
    let substeps = info.min("/substeps").map_or(1, |n| n.max(1.0) as usize);

    let mut fixed = variant("fixed", frames, fixed_grid(cells));
    fixed.run()?;
    let mut reference_sets = fixed_grid(cells.map(|n| FINER * n));
    reference_sets.push(format!("substeps={}", FINER * substeps));
    let mut reference = variant("reference", last, reference_sets);
    // Taking turns, so that a change of load on the machine meets both alike.
    for _ in 1..options.runs() {
        adaptive.run()?;
        fixed.run()?;
    }
    reference.run()?;

    for v in [&fixed, &adaptive] {
        times(report, name, v);
    }
    faces(report, name, [&adaptive, &fixed, &reference]);
    say("comparing surfaces");
    let reference_surfaces = reference.surfaces(last)?;
    let points = lattice(extent, LATTICE);
    for (v, surfaces) in [(&fixed, fixed.surfaces(last)?), (&adaptive, adaptive_surfaces)] {
        let errors = surfaces.iter().zip(&reference_surfaces).skip(1);
        let errors = errors
            .map(|(surface, truth)| surface.rms_distance(truth, &points))
            .collect::<Result<Vec<f64>, String>>()
            .map_err(|why| Failure::Unable(format!("{name}, {}: {why}", v.name)))?;
        let note = error_note(last, reference.measured[0].info.mean("/faces"), FINER * substeps);
        report.add(&format!("{name}.error.{}", v.name), Figure::mean(&errors, "m", &note));
    }
    Ok(())
}

fn error_note(last: usize, faces: f64, substeps: usize) -> String {
    let [nx, ny] = LATTICE;
    format!(
        "RMS distance from the reference ({faces:.0} faces, {substeps} steps a frame) at the same \
         {nx} × {ny} material points; mean over frames 1 to {last}, spread over these frames. Flags \
         are chaotic: small differences grow until later frames have nothing in common, so only the \
         first frames are compared; the reference too is only one of the possible motions."
    )
}

/// Cells of a grid over a sheet, nearly square, that make about this many faces.
fn cells([low, high]: [[f64; 2]; 2], faces: f64) -> [usize; 2] {
    let [width, height] = [high[0] - low[0], high[1] - low[1]];
    // Two faces a cell.
    let per_m = (0.5 * faces / (width * height)).sqrt();
    [width, height].map(|side| (side * per_m).round().max(1.0) as usize)
}

/// CPU seconds, and wall seconds by stage.
fn times(report: &mut Report, name: &str, v: &Variant<'_>) {
    let info = &v.measured[0].info;
    let note = format!(
        "Whole process over {} frames, recording and picture included, one thread; median of the \
         runs.{}",
        v.simulation.frames,
        info.troubles()
    );
    let figure = Figure::median(&v.cpu_s_per_frame(), "s", &note);
    report.add(&format!("{name}.cpu_s_per_frame.{}", v.name), figure);
    let note = "Peak of resident memory of the process; median of the runs.";
    let peaks: Vec<f64> = v.measured.iter().filter_map(|m| m.peak_mb).collect();
    report.add(&format!("{name}.peak_mb.{}", v.name), Figure::median(&peaks, "MB", note));
    stages::add(report, name, v.name, &v.measured);
}

fn faces(report: &mut Report, name: &str, [adaptive, fixed, reference]: [&Variant<'_>; 3]) {
    let note = format!("Over {} frames, spread too.", adaptive.simulation.frames);
    let of_frames = adaptive.measured[0].info.each("/faces");
    report.add(&format!("{name}.faces.mean"), Figure::mean(&of_frames, "1", &note));
    for v in [fixed, reference] {
        let faces = Figure::exact(v.measured[0].info.mean("/faces"), "1", "The mesh is fixed.");
        report.add(&format!("{name}.faces.{}", v.name), faces);
    }
    let note = format!(
        "Whole process over {} frames, recording and picture included, one thread.{}",
        reference.simulation.frames,
        reference.measured[0].info.troubles()
    );
    let cost = Figure::median(&reference.cpu_s_per_frame(), "s", &note);
    report.add(&format!("{name}.cpu_s_per_frame.reference"), cost);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_square_and_make_the_faces_asked_for() {
        let flag = [[0.0, 0.0], [3.0, 2.0]];
        assert_eq!(cells(flag, 48.0), [6, 4]);
        assert_eq!(cells([[-1.0, 2.0], [2.0, 4.0]], 48.0), [6, 4]);
        for faces in [500.0, 3742.0, 20_000.0] {
            let [nx, ny] = cells(flag, faces);
            assert!(((2 * nx * ny) as f64 / faces - 1.0).abs() < 0.05, "{faces}: {nx} × {ny}");
        }
        assert_eq!(cells(flag, 1.0), [1, 1]);
    }
}
