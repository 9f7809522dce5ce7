//! Continues a recording from its last checkpoint.

use std::fs::File;
use std::path::Path;

use io_mcap::{Checkpoint, Overwrite, Recorder, Recording, Status};

use super::settings::same_version;
use super::{Run, RunError, Settings, place};
use crate::build::BuildError;
use crate::checkpoint::restore;
use crate::scene::Loaded;
use crate::world::World;

/// What became of a recording that was to be continued.
#[derive(Debug)]
pub enum Resumed {
    /// It has all its frames and its end: nothing is to be done.
    Complete {
        /// Number of its last frame.
        last_frame: u64,
    },
    /// It had all its frames but not its end, which it has now.
    Closed {
        /// Number of its last frame.
        last_frame: u64,
    },
    /// It goes on after frame `from`. Frames behind it are made again, with the same bits.
    Continues {
        /// The frame after which the run goes on.
        from: u64,
        /// Frames that could be read from the recording.
        found: u64,
        /// The run.
        run: Box<Run>,
    },
}

/// Continues the recording at `path` to frame `frames`, or to the last frame of its run.
///
/// It goes on from the last checkpoint that is a multiple of the interval, so that the result has
/// the same bits as a run that was never interrupted, also where that goes beyond what was asked
/// for at first. A recording without any complete frame is begun anew; one that is damaged is
/// continued from before the damage.
///
/// # Errors
/// The recording cannot be read, does not hold what the run needs, or cannot be written.
pub fn resume(path: &Path, frames: Option<u32>) -> Result<Resumed, RunError> {
    continue_with(path, frames, None::<fn(&Loaded) -> Result<World, BuildError>>)
}

/// As [`resume`], of a run that began with [`Run::start_with`] and the same `build`.
///
/// # Errors
/// As for [`resume`].
pub fn resume_with(
    path: &Path,
    frames: Option<u32>,
    build: impl FnOnce(&Loaded) -> Result<World, BuildError>,
) -> Result<Resumed, RunError> {
    continue_with(path, frames, Some(build))
}

fn continue_with(
    path: &Path,
    frames: Option<u32>,
    build: Option<impl FnOnce(&Loaded) -> Result<World, BuildError>>,
) -> Result<Resumed, RunError> {
    let mut recording = Recording::open(path).map_err(RunError::recording(path))?;
    let unusable = |what| RunError::Unusable { path: path.to_owned(), what };
    let mut settings = Settings::of(&recording).map_err(unusable)?;
    settings.frames = frames.unwrap_or(settings.frames);
    let goal = u64::from(settings.frames);
    // Looks at every byte: damage is repaired as a cut is. A gap can only come from damage; what is
    // behind it is made again.
    let complete = recording.verify().map_err(RunError::recording(path))? == Status::Complete;
    let found = (0..).zip(recording.frames()).take_while(|(k, frame)| frame.index == *k).count();
    let last = (found as u64).checked_sub(1);
    if let Some(last_frame) = last.filter(|&last| complete && last >= goal) {
        return Ok(Resumed::Complete { last_frame });
    }
    let (checkpoint, unbroken) = match last {
        Some(last) => last_checkpoint(&mut recording, &settings, last),
        None => (None, true),
    };
    let at_goal = recording.checkpoint(goal).is_ok();
    let all_made = |&last: &u64| unbroken && (last > goal || last == goal && at_goal);
    if let Some(last_frame) = last.filter(all_made) {
        drop(recording);
        let recorder = Recorder::resume(path, last_frame).map_err(RunError::recording(path))?;
        recorder.finish().map_err(RunError::recording(path))?;
        return Ok(Resumed::Closed { last_frame });
    }

    let loaded = settings.load(&mut recording, path)?;
    settings.check_frames(&loaded)?;
    let world = match build {
        Some(build) => build(&loaded),
        None if settings.own_world => {
            let what = "its world was built by a program of its own, which alone can continue it";
            return Err(unusable(what.into()));
        }
        None => World::new(&loaded),
    };
    let mut world = world.map_err(|error| place(&loaded, &error))?;
    let version = same_version(&recording);
    let mut run = if let Some(checkpoint) = &checkpoint {
        restore(&mut world, checkpoint)
            .map_err(|source| RunError::Restore { path: path.to_owned(), source })?;
        drop(recording);
        let recorder =
            Recorder::resume(path, checkpoint.frame).map_err(RunError::recording(path))?;
        Run::with(&loaded, world, recorder, &settings, path)
    } else {
        // Not even the state of frame 0: nothing is lost by another beginning.
        let header = recording.header().map_err(RunError::recording(path))?;
        drop(recording);
        Run::begin(&loaded, world, header, &settings, path, Overwrite::Yes)?
    };
    run.warnings.extend(version.err());
    Ok(Resumed::Continues { from: run.world.frame, found: found as u64, run: Box::new(run) })
}

/// The last regular checkpoint at or before frame `last` such that it and all before it are as they
/// were written, and whether those are all there should be.
fn last_checkpoint(
    recording: &mut Recording<File>,
    settings: &Settings,
    last: u64,
) -> (Option<Checkpoint>, bool) {
    let mut found = None;
    for frame in (0..=last).step_by(settings.checkpoint_every as usize) {
        match recording.checkpoint(frame) {
            Ok(checkpoint) => found = Some(checkpoint),
            // What is behind a damaged one could not be copied.
            Err(_) => return (found, false),
        }
    }
    (found, true)
}
