//! `organza simulate`.

use std::path::{Path, PathBuf};

use organza::picture::{poster_path, write_poster};
use organza::record::{Run, RunError, RunOptions};
use organza::scene::{self, LoadOptions};
use organza::world::StepError;

use super::args::Simulate;
use super::progress::Progress;
use super::summary::Summary;
use super::{Failure, output, with_threads};

pub(crate) fn run(args: &Simulate) -> Result<(), Failure> {
    let out = out(args)?;
    with_threads(args.threads.threads, || {
        let load = LoadOptions {
            sets: args.scene.sets.clone(),
            allow_unsupported: args.scene.allow_unsupported,
        };
        let loaded = scene::load(&args.scene.scene, &load)?;
        let options = RunOptions {
            frames: args.frames,
            checkpoint_every: args.checkpoint_every,
            overwrite: args.overwrite,
        };
        let run = Run::start(&loaded, &load, &out, &options)?;
        run.warnings().iter().for_each(|warning| output::warning(warning));
        if args.overwrite {
            // The picture of the recording that is no more; most often there is none.
            let _ = std::fs::remove_file(poster_path(&out));
        }
        finish(run, args.quiet)
    })
}

/// Where to record, after a look at what is there already.
fn out(args: &Simulate) -> Result<PathBuf, Failure> {
    let scene = &args.scene.scene;
    let out = match (&args.out, scene.file_stem()) {
        (Some(out), _) => out.clone(),
        (None, Some(stem)) => {
            let mut name = stem.to_owned();
            name.push(".mcap");
            PathBuf::from(name)
        }
        (None, None) => {
            let message = format!("{}: not the name of a scene file", scene.display());
            return Err(Failure::bad_input(message));
        }
    };
    if out.is_dir() || out.file_name().is_none() {
        return Err(Failure::bad_input(format!("{}: a folder, not a file", out.display())));
    }
    let poster = poster_path(&out);
    if poster == out {
        let message = "the name is needed for the picture beside the recording";
        return Err(Failure::bad_input(format!("{}: {message}", out.display())));
    }
    if same_file(&out, scene) || same_file(&poster, scene) {
        let message = "the recording or its picture would replace the scene";
        return Err(Failure::bad_input(format!("{}: {message}", out.display())));
    }
    for path in [&out, &poster] {
        if !args.overwrite && path.symlink_metadata().is_ok() {
            let message = "exists already; use --overwrite to replace it";
            return Err(Failure::bad_input(format!("{}: {message}", path.display())));
        }
    }
    Ok(out)
}

fn same_file(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// Makes all frames that are left, then the poster and the summary.
pub(crate) fn finish(mut run: Run, quiet: bool) -> Result<(), Failure> {
    let path = run.path().to_owned();
    let mut progress = Progress::new(run.world().frame, u64::from(run.frames()), quiet);
    let mut summary = Summary::default();
    loop {
        match run.next_frame() {
            Ok(Some(report)) => {
                progress.done(report.frame, || match &report.fluid {
                    Some(fluid) if report.faces == 0 => format!("{} particles", fluid.particles),
                    _ => format!("{} faces", report.faces),
                });
                report.warnings.iter().for_each(|warning| progress.warn(warning));
                summary.add(&report);
            }
            Ok(None) => break,
            Err(error) => {
                progress.stop();
                return Err(half_way(&path, run.recorded(), &error));
            }
        }
    }
    progress.stop();
    let last = run.recorded();
    run.finish().map_err(|error| half_way(&path, last, &error))?;
    let poster = poster_path(&path);
    write_poster(&path, &poster).map_err(|error| {
        let whole = format!("{}: the recording is complete, but not its picture", path.display());
        Failure::failed(format!("{whole}: {error}"))
    })?;
    if quiet { Ok(()) } else { output::print(&summary.text(&path, &poster)) }
}

/// The message of a run that failed after frame `last`.
fn half_way(path: &Path, last: u64, error: &RunError) -> Failure {
    let path = path.display();
    let kept = format!("{path} keeps frames 0 to {last}");
    let hint = match error {
        RunError::Step(StepError::Fluid { .. }) => format!(
            "{kept}. The same run fails at the same place: give the fluid a larger `domain`, or sinks \
             where it leaves it"
        ),
        RunError::Step(_) => format!(
            "{kept}. The same run fails at the same place: try smaller steps, such as \
             --set substeps=16 (`organza resume {path}` helps only if the cause lay outside)"
        ),
        _ => format!("{kept}; `organza resume {path}` continues it"),
    };
    Failure::failed(format!("{error}\n{hint}"))
}
