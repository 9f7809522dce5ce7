//! ARCSim's own scenes at its own settings, where its files are at hand: beside what ARCSim takes.

use super::Context;
use super::figure::Figure;
use super::program::Simulation;
use super::report::Report;
use crate::command::{Failure, say};
use std::path::{Path, PathBuf};

/// Part of a scene that ARCSim 0.2.1 was timed on.
struct Mark {
    frames: usize,
    /// CPU time of ARCSim on one free core (s).
    arcsim_cpu_s: f64,
    /// Faces of ARCSim's mesh, averaged over the frames and at most.
    arcsim_faces: [f64; 2],
}

/// A scene of ARCSim. Measured with ARCSim 0.2.1 on one thread of a quiet machine (AMD EPYC).
pub(super) struct Scene {
    /// Name of its file, without ending.
    name: &'static str,
    /// What its figures begin with.
    prefix: &'static str,
    /// The shortest first; the others are left out of quick runs.
    marks: &'static [Mark],
    /// What else to know of ARCSim's times.
    note: &'static str,
}

/// Its cloth touches itself, which costs it about a fifth of this time.
pub(super) const FLAG: Scene = Scene {
    name: "flag",
    prefix: "flag",
    marks: &[
        Mark { frames: 14, arcsim_cpu_s: 20.0, arcsim_faces: [3938.0, 11_376.0] },
        Mark { frames: 35, arcsim_cpu_s: 257.0, arcsim_faces: [9741.0, 21_623.0] },
    ],
    note: "with self-contact",
};

/// A sheet, a moving sphere and self-contact.
pub(super) const SPHERE: Scene = Scene {
    name: "sphere",
    prefix: "contact.sphere",
    marks: &[
        Mark { frames: 25, arcsim_cpu_s: 6.1, arcsim_faces: [1426.0, 3263.0] },
        Mark { frames: 221, arcsim_cpu_s: 333.0, arcsim_faces: [5931.0, 18_607.0] },
    ],
    note: "the faces of the longer part are those of 250 frames",
};

/// Runs the first frames of a scene and adds figures `….arcsim_…`.
pub(super) fn run(context: &Context, report: &mut Report, scene: &Scene) -> Result<(), Failure> {
    let folder = folder(&context.root);
    let path = folder.join(format!("conf/{}.json", scene.name));
    if !path.is_file() {
        let why = format!(
            "ARCSim's own {0} is left out: no conf/{0}.json in the folder that ORGANZA_ARCSIM \
             names, nor in shared/arcsim beside the workspace.",
            scene.name
        );
        say(&why);
        report.remark(&why);
        return Ok(());
    }
    let warnings = warnings(context, &path, &folder)?;
    let quick = context.options.quick;
    for mark in scene.marks.iter().take(if quick { 1 } else { scene.marks.len() }) {
        measure(context, report, scene, mark, &path, &warnings)?;
        context.save(report)?;
    }
    if quick {
        report.remark(&format!(
            "The longer part of ARCSim's {} is left out of quick runs.",
            scene.name
        ));
    }
    Ok(())
}

/// The folder of ARCSim's files, whether it exists or not.
fn folder(root: &Path) -> PathBuf {
    let named = std::env::var_os("ORGANZA_ARCSIM").map(PathBuf::from);
    named.unwrap_or_else(|| root.join("../shared/arcsim"))
}

/// What the program says of the scene.
fn warnings(context: &Context, scene: &Path, folder: &Path) -> Result<String, Failure> {
    Ok(sentences(&context.program.warnings(scene)?, folder))
}

/// The warnings one after the other, without where the files are on this machine.
fn sentences(warnings: &[String], folder: &Path) -> String {
    let folder = format!("{}/", folder.display());
    warnings.iter().map(|w| format!(" {}.", w.replace(&folder, ""))).collect()
}

fn measure(
    context: &Context,
    report: &mut Report,
    of: &Scene,
    mark: &Mark,
    scene: &Path,
    warnings: &str,
) -> Result<(), Failure> {
    let Mark { frames, arcsim_cpu_s, arcsim_faces: [arcsim_mean, arcsim_max] } = mark;
    let simulation = Simulation {
        scene: scene.to_owned(),
        frames: *frames,
        sets: Vec::new(),
        out: context.runs().join(format!("{}_arcsim_{frames}.mcap", of.name)),
    };
    let mut measured = Vec::new();
    for again in 1..=context.options.runs() {
        say(format!("ARCSim's {}, run {again}: {frames} frames", of.name));
        let run = context.program.simulate(&simulation)?;
        let (cpu_s, ratio) = (run.cpu_s, run.cpu_s / arcsim_cpu_s);
        say(format!(
            "  {cpu_s:.2} CPU seconds; ARCSim {arcsim_cpu_s:.1}, that is {ratio:.3} of it"
        ));
        measured.push(run);
    }
    let info = &measured[0].info;
    let name = |what: &str| format!("{}.arcsim_{frames}_frames_{what}", of.prefix);
    let times: Vec<f64> = measured.iter().map(|m| m.cpu_s).collect();
    let note = format!(
        "First {frames} frames, one thread, whole process, recording and picture included; median of \
         the runs. ARCSim 0.2.1 takes \
         {arcsim_cpu_s:.1} s on a free core of an AMD EPYC ({}).{}{warnings}",
        of.note,
        info.troubles()
    );
    report.add(&name("cpu_s"), Figure::median(&times, "s", &note));
    let peaks: Vec<f64> = measured.iter().filter_map(|m| m.peak_mb).collect();
    let note = "Peak of resident memory of the process; median of the runs.";
    report.add(&name("peak_mb"), Figure::median(&peaks, "MB", note));
    let ratio: Vec<f64> = times.iter().map(|t| t / arcsim_cpu_s).collect();
    let note = format!("CPU seconds over the {arcsim_cpu_s:.1} s that ARCSim takes, as above.");
    report.add(&name("cpu_ratio"), Figure::median(&ratio, "1", &note));
    let note = format!("Over {frames} frames, spread too. ARCSim: {arcsim_mean} on average.");
    report.add(&name("faces.mean"), Figure::mean(&info.each("/faces"), "1", &note));
    let note = format!("Over {frames} frames. ARCSim: {arcsim_max} at most.");
    let most = info.max("/faces").and_then(|n| Figure::exact(n, "1", &note));
    report.add(&name("faces.max"), most);
    let note = "Extreme principal stretch over all faces and frames; the flag's limits are 0.95 and \
                1.05, the sphere's cloth has none.";
    for (what, extreme) in
        [("stretch.min", info.min("/stretch/min")), ("stretch.max", info.max("/stretch/max"))]
    {
        report.add(&name(what), extreme.and_then(|x| Figure::exact(x, "1", note)));
    }
    let crossings = info.each("/crossings");
    if !crossings.is_empty() {
        let note = "Edges that pass through triangles, over all frames.";
        report.add(&name("intersections"), Figure::exact(crossings.iter().sum(), "1", note));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reports_do_not_name_places_on_this_machine() {
        let warnings = ["/a/b/conf/flag.json:3:1: no contact".to_owned(), "two rows".to_owned()];
        let text = sentences(&warnings, Path::new("/a/b"));
        assert_eq!(text, " conf/flag.json:3:1: no contact. two rows.");
    }
}
