//! Scene files: text → checked, fully resolved [`Scene`].
//!
//! A scene is JSON5. [`load`] reads it from the disk, [`parse`] from memory; both also read the
//! scenes of ARCSim (see [`crate::arcsim`]). The way of a scene:
//!
//! ```text
//! text → JSON value → --set → typed SceneFile → Scene
//!        (guards)             (unknown keys)    (ranges, names, files)
//! ```
//!
//! Every complaint names file, line, column and the path of the value, and all complaints that a
//! stage can find are reported at once. The format itself is in [`mod@format`] and is published as
//! a JSON schema ([`json_schema`]).

pub(crate) mod check;
mod data;
mod files;
pub mod format;
pub(crate) mod issue;
pub mod limits;
pub(crate) mod locate;
pub mod motion;
pub(crate) mod overrides;
pub(crate) mod path;
pub(crate) mod pattern;
pub(crate) mod places;
pub(crate) mod read;
mod resolve;
mod strict;
pub(crate) mod text;
pub(crate) mod typed;
pub(crate) mod unsupported;

pub use data::{
    Cloth, Fluid, Garment, Handle, MeshSource, Obstacle, ObstacleSource, Scene, Sequence,
    Thresholds, View,
};
pub(crate) use files::Files;
pub use files::{Dialect, FileError, FileRequest, Resolver, Source, from_disk, from_sources};
pub use issue::{Issue, IssueKind, Origin, Position, SceneErrors};
pub use path::{PathError, Segment, ValuePath};
pub use places::Places;
pub use text::MAX_DEPTH;
pub(crate) use typed::suggestion;

use std::path::Path;

use serde_json::Value;

use self::check::Complaints;
use self::format::SceneFile;
use self::locate::Part;
use self::resolve::Context;
use self::typed::Complaint;
use crate::arcsim;

/// How a scene is read.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LoadOptions {
    /// `PATH=VALUE`, applied in order before anything is checked.
    pub sets: Vec<String>,
    /// Leave out what is not supported yet, with a warning, instead of failing.
    pub allow_unsupported: bool,
}

/// A scene that can be simulated.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// Whose format the file was in.
    pub dialect: Dialect,
    /// What the user should know: notices, and what was left out.
    pub warnings: Vec<Issue>,
    /// Every file read, the scene first; mesh files are found here by name.
    pub sources: Vec<Source>,
    /// Finds lines and columns for complaints of later stages.
    pub places: Places,
}

impl Loaded {
    /// The content of a file that the scene names.
    #[must_use]
    pub fn source(&self, name: &str) -> Option<&[u8]> {
        // The first source is the scene, whose name may equal that of a file it names.
        let named = self.sources.iter().skip(1).find(|source| source.name == name);
        named.map(|source| source.bytes.as_slice())
    }
}

/// Reads a scene from the disk.
///
/// # Errors
/// All that is wrong with the scene, with places.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, SceneErrors> {
    let name = path.display().to_string();
    let bytes = files::read_limited(path, limits::MAX_TEXT_BYTES).map_err(|message| Issue {
        kind: IssueKind::File,
        origin: Origin::File { name: name.clone(), position: None },
        path: String::new(),
        message,
    })?;
    let folder = path.parent().unwrap_or(Path::new(""));
    parse(bytes, &name, options, &from_disk(folder))
}

/// Reads a scene from memory. `name` stands in messages, and its file stem is the default name of
/// the scene; `resolver` gives the other files, see [`from_disk`] and [`from_sources`].
///
/// # Errors
/// All that is wrong with the scene, with places.
pub fn parse(
    text: impl AsRef<[u8]>,
    name: &str,
    options: &LoadOptions,
    resolver: &Resolver<'_>,
) -> Result<Loaded, SceneErrors> {
    let document = read::read_document(name, text.as_ref()).map_err(SceneErrors::new)?;
    let (mut value, mut places) = (document.value, document.places);
    places.set_overrides(apply_sets(&mut value, &options.sets)?);

    let mut complaints = Vec::new();
    let dialect = if arcsim::is_arcsim(&value) { Dialect::Arcsim } else { Dialect::Organza };
    let source = Source { name: name.to_owned(), bytes: text.as_ref().to_vec() };
    let mut files = Files::new(source, dialect, resolver);
    let (file, renames) = match dialect {
        Dialect::Arcsim => arcsim::read(&mut value, &mut files, &mut complaints).unzip(),
        Dialect::Organza => {
            unsupported::take(&mut value, &mut complaints);
            (typed::read::<SceneFile>(&mut value, &mut complaints), None)
        }
    };
    // Complaints so far name places of the file; from here on they name places of our format.
    let is_unknown_key = |c: &&Complaint| c.kind == IssueKind::Structure && c.part == Part::Key;
    let unknown = complaints.iter().filter(is_unknown_key);
    let unknown: Vec<ValuePath> = unknown.map(|c| c.path.parent()).collect();
    let mut issues: Vec<Issue> = places.resolve_some(complaints.into_iter());
    places.set_renames(renames.unwrap_or_default());

    let complaints = Complaints::default();
    let mut context = Context {
        files: &mut files,
        complaints: &complaints,
        foreign: Vec::new(),
        in_crowd: false,
    };
    let default_name = Path::new(name).file_stem().map_or(name.into(), |s| s.to_string_lossy());
    let scene = file.and_then(|file| resolve::resolve(file, &default_name, &mut context));
    let foreign = context.foreign;
    // An object with an unknown key may be wrong as a whole only because of that key.
    let complaints = complaints.into_vec().into_iter().filter(|c| !unknown.contains(&c.path));
    issues.extend(places.resolve_some(complaints));
    issues.extend(foreign);
    issues.sort_by_key(|issue| reading_order(issue, name, &options.sets));

    let (warnings, errors): (Vec<_>, Vec<_>) = issues.into_iter().partition(|i| match i.kind {
        IssueKind::Notice => true,
        IssueKind::Unsupported => options.allow_unsupported,
        _ => false,
    });
    match scene {
        Some(scene) if errors.is_empty() => {
            Ok(Loaded { scene, dialect, warnings, sources: files.into_sources(), places })
        }
        _ => Err(SceneErrors::new(errors)),
    }
}

fn apply_sets(value: &mut Value, sets: &[String]) -> Result<Vec<overrides::Override>, SceneErrors> {
    let (mut applied, mut issues) = (Vec::new(), Vec::new());
    for argument in sets {
        match overrides::apply(value, argument) {
            Ok(set) => applied.push(set),
            Err(issue) => issues.push(issue),
        }
    }
    if issues.is_empty() { Ok(applied) } else { Err(SceneErrors::new(issues)) }
}

/// Arguments first, then the scene from top to bottom, then other files.
fn reading_order(issue: &Issue, scene: &str, sets: &[String]) -> impl Ord + use<> {
    match &issue.origin {
        Origin::Set { argument } => {
            (sets.iter().position(|set| set == argument), false, String::new(), (false, None))
        }
        Origin::File { name, position } => {
            // Without a position it is about the file as a whole or about what was not shown.
            let position = position.map_or((true, None), |position| (false, Some(position)));
            (Some(sets.len()), name != scene, name.clone(), position)
        }
    }
}

/// The JSON schema of scene files, as published in `scenes/scene.schema.json`.
#[must_use]
pub fn json_schema() -> Value {
    let mut schema = schemars::schema_for!(SceneFile);
    schema.insert("$id".to_owned(), Value::from("scene.schema.json"));
    schema.to_value()
}
