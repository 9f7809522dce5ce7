//! A run that records itself: start it, step it, continue it after a cut.
//!
//! A recording is self-contained. It carries the text of the scene, every file the scene names, the
//! `--set` arguments and the interval of checkpoints, so that [`resume`](fn@resume) needs nothing
//! else. The bits of frame k depend on those alone: checkpoints are taken at frames decided by their
//! number, and a run that goes on from one has the same bits as a run that was never interrupted.
//!
//! ```no_run
//! use organza::record::{Run, RunOptions};
//! use organza::scene::{self, LoadOptions};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let load = LoadOptions::default();
//! let loaded = scene::load("scenes/hang.json5".as_ref(), &load)?;
//! let mut run = Run::start(&loaded, &load, "hang.mcap".as_ref(), &RunOptions::default())?;
//! while let Some(report) = run.next_frame()? {
//!     println!("frame {}: {} faces", report.frame, report.faces);
//! }
//! run.finish()?;
//! # Ok(())
//! # }
//! ```

mod camera;
mod error;
mod garments;
mod obstacles;
mod range;
mod resume;
mod settings;

pub use camera::camera;
pub use error::{RunError, place};
pub use garments::{PALETTE, garments};
pub use obstacles::obstacles;
pub use range::{FrameRange, RangeError};
pub use resume::{Resumed, resume, resume_with};
pub(crate) use settings::{FLUID, FLUID_SPACING, OBSTACLES, up};
pub use settings::{Settings, scene_of};

use std::path::{Path, PathBuf};

use io_mcap::{Frame, Garment, Header, Obstacle, Overwrite, Recorder, RecordingFile};

use crate::build::BuildError;
use crate::checkpoint;
use crate::report::FrameReport;
use crate::scene::{LoadOptions, Loaded};
use crate::world::World;
use sizing_view::CameraPath;

/// What of a run is not in its scene file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RunOptions {
    /// Number of frames after the first, instead of the scene's.
    pub frames: Option<u32>,
    /// Frames from checkpoint to checkpoint, instead of the scene's.
    pub checkpoint_every: Option<u32>,
    /// Whether a recording that exists may be replaced.
    pub overwrite: bool,
}

/// A world and the recording of its frames.
pub struct Run {
    world: World,
    recorder: Recorder<RecordingFile>,
    path: PathBuf,
    camera: Option<CameraPath>,
    frames: u32,
    checkpoint_every: u32,
    warnings: Vec<String>,
}

impl std::fmt::Debug for Run {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Run").field("path", &self.path).field("world", &self.world).finish()
    }
}

impl Run {
    /// Builds the world of a loaded scene and records frame 0, its initial state, to a new file at
    /// `path`. `load` is how the scene was loaded.
    ///
    /// # Errors
    /// The scene cannot be built, or the file cannot be written; no file is left then.
    pub fn start(
        loaded: &Loaded,
        load: &LoadOptions,
        path: &Path,
        options: &RunOptions,
    ) -> Result<Run, RunError> {
        Self::start_settled(
            loaded,
            Settings::new(loaded, load, options)?,
            path,
            options,
            World::new,
        )
    }

    /// As [`Run::start`], of a world that `build` makes: one with a sizing field of its own, say, see
    /// [`World::set_sizing`]. What `build` does is not in the recording, so only
    /// [`resume_with`] the same `build` continues it.
    ///
    /// # Errors
    /// As for [`Run::start`].
    pub fn start_with(
        loaded: &Loaded,
        load: &LoadOptions,
        path: &Path,
        options: &RunOptions,
        build: impl FnOnce(&Loaded) -> Result<World, BuildError>,
    ) -> Result<Run, RunError> {
        let settings = Settings { own_world: true, ..Settings::new(loaded, load, options)? };
        Self::start_settled(loaded, settings, path, options, build)
    }

    fn start_settled(
        loaded: &Loaded,
        settings: Settings,
        path: &Path,
        options: &RunOptions,
        build: impl FnOnce(&Loaded) -> Result<World, BuildError>,
    ) -> Result<Run, RunError> {
        let overwrite = if options.overwrite { Overwrite::Yes } else { Overwrite::No };
        let header = settings.header(loaded);
        let existed = path.symlink_metadata().is_ok();
        let world = build(loaded).map_err(|error| place(loaded, &error))?;
        Self::begin(loaded, world, header, &settings, path, overwrite).inspect_err(|_| {
            // What a failed first write leaves is no recording. A file that was there before is
            // not ours to remove.
            if !existed {
                let _ = std::fs::remove_file(path);
            }
        })
    }

    fn begin(
        loaded: &Loaded,
        world: World,
        header: Header,
        settings: &Settings,
        path: &Path,
        overwrite: Overwrite,
    ) -> Result<Run, RunError> {
        let recorder =
            Recorder::create(path, header, overwrite).map_err(RunError::recording(path))?;
        let mut run = Self::with(loaded, world, recorder, settings, path);
        run.record(&FrameReport::initial(&run.world))?;
        Ok(run)
    }

    fn with(
        loaded: &Loaded,
        world: World,
        recorder: Recorder<RecordingFile>,
        settings: &Settings,
        path: &Path,
    ) -> Run {
        Run {
            camera: loaded.scene.camera_path.clone(),
            warnings: loaded
                .warnings
                .iter()
                .map(ToString::to_string)
                .chain(world.warnings.iter().cloned())
                .collect(),
            world,
            recorder,
            path: path.to_owned(),
            frames: settings.frames,
            checkpoint_every: settings.checkpoint_every,
        }
    }

    /// Makes and records the next frame; `None` after the last one.
    ///
    /// # Errors
    /// A step fails, or the recording cannot be written. Every frame before is in the recording.
    pub fn next_frame(&mut self) -> Result<Option<FrameReport>, RunError> {
        if self.world.frame >= u64::from(self.frames) {
            return Ok(None);
        }
        let report = self.world.advance()?;
        self.record(&report)?;
        Ok(Some(report))
    }

    /// Closes the recording and hands back the world as it is after the last frame.
    ///
    /// # Errors
    /// The recording cannot be written.
    pub fn finish(self) -> Result<World, RunError> {
        self.recorder.finish().map_err(RunError::recording(&self.path))?;
        Ok(self.world)
    }

    /// The world after the last recorded frame.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// Number of the last frame that is in the recording; after an error that can be one less than
    /// the world has made.
    pub fn recorded(&self) -> u64 {
        self.recorder.last_frame().map_or(0, |frame| frame.index)
    }

    /// Number of the last frame of the run.
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// Where the recording is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What the user should know about how the run began.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn record(&mut self, report: &FrameReport) -> Result<(), RunError> {
        let report = serde_json::to_value(report).map_err(|error| RunError::Recording {
            path: self.path.clone(),
            source: io_mcap::Error::Unrecordable { what: format!("the report: {error}") },
        })?;
        let garments = garments(&self.world);
        let borrowed: Vec<Garment<'_>> = garments.iter().map(|g| g.borrowed()).collect();
        let obstacles = obstacles(&self.world);
        let obstacles: Vec<Obstacle<'_>> = obstacles.iter().map(|o| o.borrowed()).collect();
        let fluid = match &self.world.fluid {
            Some(water) => Some(water.particles().ok_or_else(|| RunError::Recording {
                path: self.path.clone(),
                source: io_mcap::Error::Unrecordable {
                    what: format!("fluid `{}`: more than 2³² particles", water.name),
                },
            })?),
            None => None,
        };
        let frame = Frame {
            index: self.world.frame,
            time_s: self.world.time(),
            garments: &borrowed,
            obstacles: &obstacles,
            fluid: fluid.as_deref(),
            camera: self.camera.as_ref().map(|path| camera(&path.at(self.world.time()))),
            transforms: &[],
            report: &report,
        };
        self.recorder.frame(&frame).map_err(RunError::recording(&self.path))?;
        self.checkpoint_if_due()
    }

    /// Saving makes the world forget, so it happens at frames that their number alone decides. After
    /// the last frame nothing follows whose bits could change.
    fn checkpoint_if_due(&mut self) -> Result<(), RunError> {
        let frame = self.world.frame;
        if frame.is_multiple_of(u64::from(self.checkpoint_every)) || frame == u64::from(self.frames)
        {
            let checkpoint = checkpoint::save(&mut self.world);
            self.recorder.checkpoint(&checkpoint).map_err(RunError::recording(&self.path))?;
        }
        Ok(())
    }
}
