//! The file behind a recorder: there only once something is written to it.

use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::{Error, Overwrite};

/// A file to record to, created at the first write.
#[derive(Debug)]
pub struct RecordingFile {
    path: PathBuf,
    overwrite: Overwrite,
    file: Option<File>,
}

impl RecordingFile {
    /// Checks that the file can be there, without creating it.
    pub(crate) fn later(path: &Path, overwrite: Overwrite) -> Result<Self, Error> {
        if overwrite == Overwrite::No && path.symlink_metadata().is_ok() {
            return Err(Error::Exists);
        }
        if path.is_dir() {
            let source = io::Error::from(io::ErrorKind::IsADirectory);
            return Err(Error::Io { doing: "create the recording", source });
        }
        let folder = match path.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        match folder.metadata() {
            Ok(found) if found.is_dir() => {}
            Ok(_) => {
                let source = io::Error::from(io::ErrorKind::NotADirectory);
                return Err(Error::Io { doing: "create the recording in its folder", source });
            }
            Err(source) => {
                return Err(Error::Io { doing: "create the recording in its folder", source });
            }
        }
        Ok(Self { path: path.to_owned(), overwrite, file: None })
    }

    /// Writes to `file`, which is at `path` or will be renamed to it.
    pub(crate) fn opened(file: File, path: &Path) -> Self {
        Self { path: path.to_owned(), overwrite: Overwrite::No, file: Some(file) }
    }

    /// Waits until what was written is on the disk, to survive a loss of power. A kill of the
    /// program alone needs no such call.
    pub fn sync(&self) -> io::Result<()> {
        self.file.as_ref().map_or(Ok(()), File::sync_all)
    }

    /// Where the file is, or will be.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn file(&mut self) -> io::Result<&mut File> {
        if self.file.is_none() {
            let mut options = OpenOptions::new();
            match self.overwrite {
                Overwrite::No => options.write(true).create_new(true),
                Overwrite::Yes => options.write(true).create(true).truncate(true),
            };
            self.file = Some(options.open(&self.path)?);
        }
        self.file.as_mut().ok_or_else(|| io::ErrorKind::NotFound.into())
    }
}

impl Write for RecordingFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file()?.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_mut().map_or(Ok(()), File::flush)
    }
}
