//! What a recording keeps of its run besides frames: enough to build the same world again.

use std::collections::BTreeMap;
use std::io::{Read, Seek};
use std::path::Path;

use io_mcap::{Attachment, Header, Recording};

use super::{RunError, RunOptions};
use crate::scene::{self, LoadOptions, Loaded, Source, limits};

/// The program as recordings name it.
const SOFTWARE: &str = concat!("organza ", env!("CARGO_PKG_VERSION"));
/// Folders of the attachments.
const SCENE_FOLDER: &str = "scene/";
const FILE_FOLDER: &str = "files/";
/// Keys of the metadata.
const SETS: &str = "sets";
const ALLOW_UNSUPPORTED: &str = "allow_unsupported";
const FRAMES: &str = "frames";
const CHECKPOINT_EVERY: &str = "checkpoint_every_frames";
const OWN_WORLD: &str = "own_world";
/// Names of the obstacles, a list as JSON; absent where there are none.
pub(crate) const OBSTACLES: &str = "obstacles";
/// Name of the fluid and distance of its particles at rest (m); absent where there is none.
pub(crate) const FLUID: &str = "fluid";
pub(crate) const FLUID_SPACING: &str = "fluid_spacing_m";

/// How a run was made. With the attached files it decides every bit of its frames.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// How the scene was loaded.
    pub load: LoadOptions,
    /// Number of frames after the first.
    pub frames: u32,
    /// Frames from checkpoint to checkpoint.
    pub checkpoint_every: u32,
    /// True if the world is not just what the scene says, see [`Run::start_with`].
    ///
    /// [`Run::start_with`]: super::Run::start_with
    pub own_world: bool,
}

impl Settings {
    /// The settings of a new run.
    ///
    /// # Errors
    /// More frames than can be simulated.
    pub fn new(
        loaded: &Loaded,
        load: &LoadOptions,
        options: &RunOptions,
    ) -> Result<Self, RunError> {
        let frames = options.frames.unwrap_or(loaded.scene.frames);
        let every = options.checkpoint_every;
        let every = every.unwrap_or(loaded.scene.recording.checkpoint_every_frames).max(1);
        let load = load.clone();
        let settings = Self { load, frames, checkpoint_every: every, own_world: false };
        settings.check_frames(loaded)?;
        Ok(settings)
    }

    /// # Errors
    /// More frames than can be simulated.
    pub(super) fn check_frames(&self, loaded: &Loaded) -> Result<(), RunError> {
        let (frames, scene) = (self.frames, &loaded.scene);
        let steps = f64::from(frames) * f64::from(scene.substeps);
        let seconds = f64::from(frames) * scene.frame_s();
        let too_many = |what, got: f64, limit: f64| {
            let why = format!("they take {got:e} {what}, above the limit of {limit:e}");
            Err(RunError::Frames { frames, why })
        };
        if steps > limits::MAX_STEPS {
            return too_many("steps", steps, limits::MAX_STEPS);
        }
        if seconds > limits::MAX_TIME_S {
            return too_many("s", seconds, limits::MAX_TIME_S);
        }
        Ok(())
    }

    /// What to write ahead of the first frame.
    pub fn header(&self, loaded: &Loaded) -> Header {
        let scene = &loaded.scene;
        let text = |value: serde_json::Value| value.to_string();
        let mut metadata = BTreeMap::from([
            ("name".to_owned(), scene.name.clone()),
            ("frames_per_second".to_owned(), scene.frames_per_second.to_string()),
            ("substeps".to_owned(), scene.substeps.to_string()),
            ("up".to_owned(), text(scene.up().as_slice().into())),
            (SETS.to_owned(), text(self.load.sets.as_slice().into())),
            (ALLOW_UNSUPPORTED.to_owned(), self.load.allow_unsupported.to_string()),
            (FRAMES.to_owned(), self.frames.to_string()),
            (CHECKPOINT_EVERY.to_owned(), self.checkpoint_every.to_string()),
        ]);
        if !scene.obstacles.is_empty() {
            let names: Vec<&str> = scene.obstacles.iter().map(|o| o.name.as_str()).collect();
            metadata.insert(OBSTACLES.to_owned(), text(names.into()));
        }
        if let Some(fluid) = &scene.fluid {
            metadata.insert(FLUID.to_owned(), fluid.name.clone());
            metadata.insert(FLUID_SPACING.to_owned(), fluid.file.spacing_m.to_string());
        }
        if self.own_world {
            metadata.insert(OWN_WORLD.to_owned(), true.to_string());
        }
        let attachments = loaded.sources.iter().enumerate().map(|(k, source)| {
            let name = if k == 0 {
                let file = Path::new(&source.name).file_name();
                format!("{SCENE_FOLDER}{}", file.unwrap_or("scene".as_ref()).to_string_lossy())
            } else {
                format!("{FILE_FOLDER}{}", source.name)
            };
            let media_type = media_type(&name).to_owned();
            Attachment { name, media_type, data: source.bytes.clone() }
        });
        Header { software: SOFTWARE.into(), metadata, attachments: attachments.collect() }
    }

    /// Reads the settings back from a recording.
    ///
    /// # Errors
    /// A sentence about what is missing.
    pub fn of<R: Read + Seek>(recording: &Recording<R>) -> Result<Self, String> {
        let metadata = recording.metadata();
        let get = |key: &str| {
            let value = metadata.get(key);
            value.ok_or_else(|| format!("its metadata has no `{key}`: the run cannot be repeated"))
        };
        let count = |key: &str| {
            let value = get(key)?;
            let number = value.parse::<u32>().ok().filter(|&n| n > 0);
            number.ok_or_else(|| format!("its metadata has `{key}` {value:?}, not a count"))
        };
        let sets = get(SETS)?;
        let load = LoadOptions {
            sets: serde_json::from_str(sets)
                .map_err(|_| format!("its metadata has `{SETS}` {sets:?}, not a list of texts"))?,
            allow_unsupported: get(ALLOW_UNSUPPORTED)? == "true",
        };
        let (frames, checkpoint_every) = (count(FRAMES)?, count(CHECKPOINT_EVERY)?);
        let own_world = metadata.get(OWN_WORLD).is_some_and(|own| own == "true");
        Ok(Self { load, frames, checkpoint_every, own_world })
    }

    /// Loads the scene that is attached to a recording at `path`.
    pub(super) fn load<R: Read + Seek>(
        &self,
        recording: &mut Recording<R>,
        path: &Path,
    ) -> Result<Loaded, RunError> {
        let attachments = recording.header().map_err(RunError::recording(path))?.attachments;
        let mut sources = attachments.into_iter();
        let scene = sources.next().filter(|a| a.name.starts_with(SCENE_FOLDER));
        let scene = scene.ok_or_else(|| RunError::Unusable {
            path: path.to_owned(),
            what: "no scene is attached to it".into(),
        })?;
        let files: Vec<Source> = sources
            .filter_map(|a| {
                let name = a.name.strip_prefix(FILE_FOLDER)?.to_owned();
                Some(Source { name, bytes: a.data })
            })
            .collect();
        // Messages name the recording as a folder; the name of the scene is then as it was.
        let name = format!("{}/{}", path.display(), scene.name);
        Ok(scene::parse(scene.data, &name, &self.load, &scene::from_sources(&files))?)
    }
}

/// The scene that is attached to the recording at `path`, as it was run.
///
/// # Errors
/// The recording cannot be read, or holds no scene.
pub fn scene_of<R: Read + Seek>(
    recording: &mut Recording<R>,
    path: &Path,
) -> Result<Loaded, RunError> {
    let unusable = |what| RunError::Unusable { path: path.to_owned(), what };
    Settings::of(recording).map_err(unusable)?.load(recording, path)
}

/// True if the recording was made by this version, whose bits are the ones that can be continued.
pub(super) fn same_version<R: Read + Seek>(recording: &Recording<R>) -> Result<(), String> {
    let software = recording.software();
    if software == SOFTWARE {
        return Ok(());
    }
    Err(format!("recorded by {software:?}, continued by {SOFTWARE:?}: the bits may differ"))
}

/// The direction against gravity that a recording notes; z where it notes none.
pub(crate) fn up<R: Read + Seek>(recording: &Recording<R>) -> [f64; 3] {
    let noted = recording.metadata().get("up").and_then(|up| serde_json::from_str(up).ok());
    noted.unwrap_or([0.0, 0.0, 1.0])
}

fn media_type(name: &str) -> &'static str {
    match name.rsplit_once('.').map(|(_, extension)| extension) {
        Some("obj") => "model/obj",
        Some("glb") => "model/gltf-binary",
        Some("gltf") => "model/gltf+json",
        Some("json" | "json5") => "application/json",
        _ => "application/octet-stream",
    }
}
