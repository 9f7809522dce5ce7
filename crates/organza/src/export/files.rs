//! Files numbered by frame in one folder, none of which is written over unasked.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Why numbered files could not be written.
#[derive(Debug, thiserror::Error)]
pub enum FilesError {
    /// The folder cannot be made.
    #[error("{}: cannot make this folder: {source}", folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A file exists, and overwriting was not asked for.
    #[error("{}: exists already; use --overwrite to replace it and others", path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// A file cannot be created.
    #[error("{}: cannot be created: {source}", path.display())]
    Create {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A file cannot hold what it should.
    #[error("{}: {source}", path.display())]
    Content {
        /// The file, which is not left behind.
        path: PathBuf,
        /// What is wrong.
        source: io::Error,
    },
    /// A file cannot be written to its end.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file, which is not left behind.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

/// Files `NAME_00000.EXT`, `NAME_00001.EXT`, … of a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NumberedFiles {
    folder: PathBuf,
    extension: &'static str,
}

impl NumberedFiles {
    /// Makes the folder, if it is not there, after a look at all `frames` to be written, a file of
    /// each of the `names` for each.
    ///
    /// # Errors
    /// A file exists (unless `overwrite`), or the folder cannot be made; nothing is changed then.
    pub fn prepare(
        folder: &Path,
        names: &[&str],
        extension: &'static str,
        frames: &[u64],
        overwrite: bool,
    ) -> Result<Self, FilesError> {
        let files = Self { folder: folder.to_owned(), extension };
        if !overwrite {
            let all = frames.iter().flat_map(|&k| names.iter().map(move |name| (name, k)));
            let mut paths = all.map(|(name, k)| files.path(name, k));
            if let Some(path) = paths.find(|p| p.symlink_metadata().is_ok()) {
                return Err(FilesError::Exists { path });
            }
        }
        fs::create_dir_all(folder)
            .map_err(|source| FilesError::Folder { folder: folder.to_owned(), source })?;
        Ok(files)
    }

    /// The file of a frame.
    pub fn path(&self, name: &str, frame: u64) -> PathBuf {
        self.folder.join(format!("{name}_{frame:05}.{}", self.extension))
    }

    /// Writes the file of a frame; one that cannot be written to its end is removed.
    ///
    /// # Errors
    /// See [`FilesError`].
    pub fn write(
        &self,
        name: &str,
        frame: u64,
        content: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<(), FilesError> {
        let path = self.path(name, frame);
        let file = match File::create(&path) {
            Ok(file) => file,
            Err(source) => return Err(FilesError::Create { path, source }),
        };
        let mut out = BufWriter::new(file);
        let Err(source) = content(&mut out).and_then(|()| out.flush()) else { return Ok(()) };
        // What the buffer still holds is not wanted; dropping it would try to write it again.
        drop(out.into_parts());
        let _ = fs::remove_file(&path);
        Err(match source.kind() {
            io::ErrorKind::InvalidInput => FilesError::Content { path, source },
            _ => FilesError::Write { path, source },
        })
    }
}
