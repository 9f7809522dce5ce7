//! ARCSim's own flag at its own settings, where its files are at hand: beside what ARCSim takes.

use super::Context;
use super::program::Simulation;
use super::report::{Figure, Report};
use crate::command::{Failure, say};
use std::path::{Path, PathBuf};

/// Part of the flag that ARCSim 0.2.1 was timed on.
struct Mark {
    frames: usize,
    /// CPU time of ARCSim on one free core (s).
    arcsim_cpu_s: f64,
    /// Faces of ARCSim's mesh, averaged over the frames and at most.
    arcsim_faces: [f64; 2],
}

/// Measured with ARCSim 0.2.1 on one thread of a quiet machine (AMD EPYC). Its flag touches itself;
/// that costs it about a fifth of this time.
const MARKS: [Mark; 2] = [
    Mark { frames: 14, arcsim_cpu_s: 20.0, arcsim_faces: [3938.0, 11_376.0] },
    Mark { frames: 35, arcsim_cpu_s: 257.0, arcsim_faces: [9741.0, 21_623.0] },
];

/// Runs the first frames of ARCSim's flag and adds figures `flag.arcsim_…`.
pub(super) fn run(context: &Context, report: &mut Report) -> Result<(), Failure> {
    let folder = folder(&context.root);
    let scene = folder.join("conf/flag.json");
    if !scene.is_file() {
        let why = "ARCSim's own flag is left out: no conf/flag.json in the folder that \
                   ORGANZA_ARCSIM names, nor in shared/arcsim beside the workspace.";
        say(why);
        report.remark(why);
        return Ok(());
    }
    let warnings = warnings(context, &scene, &folder)?;
    let quick = context.options.quick;
    for mark in MARKS.iter().take(if quick { 1 } else { MARKS.len() }) {
        measure(context, report, mark, &scene, &warnings)?;
        context.save(report)?;
    }
    if quick {
        report.remark("The longer part of ARCSim's flag is left out of quick runs.");
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
    mark: &Mark,
    scene: &Path,
    warnings: &str,
) -> Result<(), Failure> {
    let Mark { frames, arcsim_cpu_s, arcsim_faces: [arcsim_mean, arcsim_max] } = mark;
    let simulation = Simulation {
        scene: scene.to_owned(),
        frames: *frames,
        sets: Vec::new(),
        out: context.runs().join(format!("flag_arcsim_{frames}.mcap")),
    };
    let mut measured = Vec::new();
    for again in 1..=context.options.runs() {
        say(format!("ARCSim's flag, run {again}: {frames} frames"));
        let run = context.program.simulate(&simulation)?;
        let (cpu_s, ratio) = (run.cpu_s, run.cpu_s / arcsim_cpu_s);
        say(format!(
            "  {cpu_s:.2} CPU seconds; ARCSim {arcsim_cpu_s:.1}, that is {ratio:.3} of it"
        ));
        measured.push(run);
    }
    let info = &measured[0].info;
    let name = |what: &str| format!("flag.arcsim_{frames}_frames_{what}");
    let times: Vec<f64> = measured.iter().map(|m| m.cpu_s).collect();
    let note = format!(
        "First {frames} frames, one thread, whole process, recording and picture included; median of \
         the runs. ARCSim 0.2.1 takes \
         {arcsim_cpu_s:.1} s on a free core of an AMD EPYC, with self-contact.{}{warnings}",
        info.troubles()
    );
    report.add(&name("cpu_s"), Figure::median(&times, "s", &note));
    let ratio: Vec<f64> = times.iter().map(|t| t / arcsim_cpu_s).collect();
    let note = format!("CPU seconds over the {arcsim_cpu_s:.1} s that ARCSim takes, as above.");
    report.add(&name("cpu_ratio"), Figure::median(&ratio, "1", &note));
    let note = format!("Over {frames} frames, spread too. ARCSim: {arcsim_mean} on average.");
    report.add(&name("faces.mean"), Figure::mean(&info.each("/faces"), "1", &note));
    let note = format!("Over {frames} frames. ARCSim: {arcsim_max} at most.");
    let most = info.max("/faces").and_then(|n| Figure::exact(n, "1", &note));
    report.add(&name("faces.max"), most);
    let note = "Extreme principal stretch over all faces and frames; the scene's limits are 0.95 \
                and 1.05.";
    for (what, extreme) in
        [("stretch.min", info.min("/stretch/min")), ("stretch.max", info.max("/stretch/max"))]
    {
        report.add(&name(what), extreme.and_then(|x| Figure::exact(x, "1", note)));
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
