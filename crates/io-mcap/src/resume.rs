//! Continuing a recording: its frames so far are copied, then recording goes on behind them.

use std::fs::File;
use std::path::{Path, PathBuf};

use crate::recording_file::RecordingFile;
use crate::stream::Stream;
use crate::{Attachment, Error, Header, Recorder, Recording, decode};

impl Recorder<RecordingFile> {
    /// Continues the recording at `path`, cut or whole, after frame `up_to_frame`: that frame,
    /// those before it and their checkpoints are kept, later ones are dropped.
    ///
    /// What is kept is copied to `path` with `.partial` appended, which then takes the place of
    /// the old file; a kill on the way leaves the old file as it was. The copied frames give
    /// the same bytes as in a recording that was never interrupted.
    ///
    /// # Errors
    /// The file cannot be read or is not a recording, `up_to_frame` is not in it, something
    /// before the end of that frame is damaged, or the copy cannot be written.
    pub fn resume(path: impl AsRef<Path>, up_to_frame: u64) -> Result<Self, Error> {
        let path = path.as_ref();
        let mut recording = Recording::open(path)?;
        // A link stays a link: what it leads to is replaced.
        let target = path.canonicalize().map_err(Error::io("find the recording"));
        let target = target.map_err(Error::in_file(path))?;
        let mut partial = target.as_os_str().to_owned();
        partial.push(".partial");
        let partial = PathBuf::from(partial);
        let mut copy = || {
            recording.entry(up_to_frame)?;
            let file = File::create(&partial).map_err(Error::io("create the copy"))?;
            // A second handle, as the recorder keeps the first.
            let handle = file.try_clone().map_err(Error::io("create the copy"))?;
            let file = RecordingFile::opened(file, path);
            let recorder = copy(&mut recording, file, up_to_frame)?;
            // On the disk before it takes the place of what is known to be there.
            handle.sync_all().map_err(Error::io("write the copy to the disk"))?;
            std::fs::rename(&partial, &target).map_err(Error::io("put the copy in place"))?;
            Ok(recorder)
        };
        copy().map_err(|error| {
            // The copy is of no use; that it is gone already is fine too.
            let _ = std::fs::remove_file(&partial);
            Error::in_file(path)(error)
        })
    }
}

fn copy(
    recording: &mut Recording<File>,
    file: RecordingFile,
    up_to_frame: u64,
) -> Result<Recorder<RecordingFile>, Error> {
    let scan = recording.scan();
    let entries: Vec<_> =
        scan.frames.iter().take_while(|e| e.info.index <= up_to_frame).copied().collect();
    for (k, entry) in (0..).zip(&entries) {
        if entry.ordinal != k {
            let offset = scan.chunks[entry.chunks.1].offset;
            let what = format!("frames are missing before frame {}", entry.info.index);
            return Err(Error::damaged(offset, what));
        }
    }
    if let Some(missing) = scan.missing_header() {
        return Err(Error::damaged(0, missing));
    }
    let Header { software, metadata, attachments } = recording.header()?;
    let mut stream = Stream::open(file, &software, &metadata, attachments.len())?;
    for Attachment { name, media_type, data } in &attachments {
        stream.attach(name, media_type, data)?;
    }
    stream.flush()?;
    let mut recorder = Recorder::with_stream(stream);
    for entry in &entries {
        let encoded = recording.encoded_frame(entry)?;
        recorder.encoded_frame(entry.info, &encoded)?;
        if let Some((bytes, _)) = recording.encoded_checkpoint(entry.info.index)? {
            recorder.encoded_checkpoint(entry.info.index, &bytes)?;
        }
        if entry.info.index == up_to_frame {
            let offset = recording.scan().chunks[entry.chunks.0].offset;
            let shown = decode::shown(&encoded.geometry);
            recorder.set_shown(shown.map_err(|what| Error::damaged(offset, what))?);
        }
    }
    Ok(recorder)
}
