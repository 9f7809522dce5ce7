//! Reads the files that a scene names, from the disk or from the attachments of a recording.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// A file that was read, to be kept with the recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// The name as the scene wrote it; for the scene itself, its name in messages.
    pub name: String,
    /// The content.
    pub bytes: Vec<u8>,
}

/// Whose rules say where a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dialect {
    /// A scene of Organza: relative to the scene's folder.
    Organza,
    /// A scene of ARCSim: relative to the working directory, to the scene's folder, or to one of
    /// the folders above it, the first that has the file.
    Arcsim,
}

/// A request for a file named in a scene.
#[derive(Debug, Clone, Copy)]
pub struct FileRequest<'a> {
    /// The name as the scene wrote it.
    pub name: &'a str,
    /// Whose rules say where the file is.
    pub dialect: Dialect,
    /// The size beyond which the file is refused (bytes).
    pub max_bytes: u64,
}

/// Why a file cannot be had; prints as a sentence.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FileError {
    /// There is no such file.
    #[error("{0}")]
    Missing(String),
    /// It is there and cannot be read, or is too large.
    #[error("{0}")]
    Unreadable(String),
}

/// Gives the content of a file named in a scene.
pub type Resolver<'a> = dyn Fn(&FileRequest<'_>) -> Result<Vec<u8>, FileError> + 'a;

/// The files of a scene, each of which is read once.
pub(crate) struct Files<'r> {
    pub(crate) dialect: Dialect,
    resolver: &'r Resolver<'r>,
    /// The scene, then the files it names in the order in which they were read.
    sources: Vec<Source>,
    /// Where in `sources` a name is. The scene is not among them: a file may have its name.
    by_name: BTreeMap<String, usize>,
}

impl<'r> Files<'r> {
    pub(crate) fn new(scene: Source, dialect: Dialect, resolver: &'r Resolver<'r>) -> Self {
        Self { dialect, resolver, sources: vec![scene], by_name: BTreeMap::new() }
    }

    /// The content of a file.
    ///
    /// # Errors
    /// It cannot be had.
    pub(crate) fn read(&mut self, name: &str, max_bytes: u64) -> Result<&[u8], FileError> {
        let index = match self.by_name.get(name) {
            Some(&index) => index,
            None => {
                let request = FileRequest { name, dialect: self.dialect, max_bytes };
                let bytes = (self.resolver)(&request)?;
                self.sources.push(Source { name: name.to_owned(), bytes });
                self.by_name.insert(name.to_owned(), self.sources.len() - 1);
                self.sources.len() - 1
            }
        };
        Ok(&self.sources[index].bytes)
    }

    /// The content of a file that has been read.
    pub(crate) fn get(&self, name: &str) -> Option<&[u8]> {
        self.by_name.get(name).map(|&index| self.sources[index].bytes.as_slice())
    }

    pub(crate) fn into_sources(self) -> Vec<Source> {
        self.sources
    }
}

/// A resolver that reads from the disk, for a scene that lies in `folder`.
pub fn from_disk(folder: &Path) -> impl Fn(&FileRequest<'_>) -> Result<Vec<u8>, FileError> {
    let folder = folder.to_owned();
    move |request| {
        let places = candidates(&folder, request);
        let Some(path) = places.iter().find(|path| path.is_file()) else {
            let tried: Vec<String> = places.iter().map(|p| p.display().to_string()).collect();
            return Err(FileError::Missing(format!(
                "there is no file `{}` (looked for {})",
                request.name,
                tried.join(", ")
            )));
        };
        read_limited(path, request.max_bytes)
            .map_err(|message| FileError::Unreadable(format!("`{}` {message}", path.display())))
    }
}

/// A resolver that knows only the files given, such as the attachments of a recording.
pub fn from_sources(sources: &[Source]) -> impl Fn(&FileRequest<'_>) -> Result<Vec<u8>, FileError> {
    move |request| {
        let found = sources.iter().find(|source| source.name == request.name);
        found.map(|source| source.bytes.clone()).ok_or_else(|| {
            let name = request.name;
            FileError::Missing(format!("there is no file `{name}` among those attached"))
        })
    }
}

fn candidates(folder: &Path, request: &FileRequest<'_>) -> Vec<PathBuf> {
    let name = Path::new(request.name);
    if name.is_absolute() || request.dialect == Dialect::Organza {
        return vec![folder.join(name)];
    }
    let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let mut places = vec![name.to_owned()];
    places.extend(folder.ancestors().map(|above| above.join(name)));
    places
}

/// Reads a file of at most `max_bytes`.
///
/// # Errors
/// A sentence without its subject, the file.
pub(crate) fn read_limited(path: &Path, max_bytes: u64) -> Result<Vec<u8>, String> {
    let fail = |error: std::io::Error| format!("cannot be read: {error}");
    let mut bytes = Vec::new();
    // One byte more than allowed tells "too large" from "just fits", also for endless devices.
    let mut file = File::open(path).map_err(fail)?.take(max_bytes + 1);
    file.read_to_end(&mut bytes).map_err(fail)?;
    if bytes.len() as u64 > max_bytes {
        return Err(format!("is larger than the limit of {max_bytes} bytes"));
    }
    Ok(bytes)
}
