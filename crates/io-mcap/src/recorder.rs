//! Writing a recording, frame by frame.

use std::io::Write;
use std::path::Path;

use prost::Message as _;

use crate::encode::{self, EncodedFrame, Shown};
use crate::proto::FrameMark;
use crate::recording_file::RecordingFile;
use crate::stream::{Stamp, Stream};
use crate::topic::Topic;
use crate::{
    Attachment, Checkpoint, Error, Frame, FrameInfo, Header, Limits, Overwrite, checkpoint, header,
};

/// Records frames and checkpoints.
///
/// Every frame is handed to the operating system before [`Self::frame`] returns: a kill loses
/// the frame being written and none before it. A recorder dropped without [`Self::finish`]
/// leaves a file that viewers read like any other, but that [`crate::Recording::status`] tells
/// from one whose run went to its end.
///
/// The same frames give the same bytes.
pub struct Recorder<W: Write> {
    state: State<W>,
    limits: Limits,
    last: Option<FrameInfo>,
    n_frames: u64,
    /// What the last frame showed.
    shown: Shown,
    last_checkpoint: Option<u64>,
}

enum State<W: Write> {
    /// Nothing is written yet.
    Waiting(W, Header),
    Recording(Box<Stream<W>>),
    Stopped,
}

impl Recorder<RecordingFile> {
    /// A recorder to the file at `path`, which is created when the first frame is recorded:
    /// a run that fails before leaves nothing behind.
    ///
    /// # Errors
    /// The file exists and `overwrite` is [`Overwrite::No`], its folder does not exist, or
    /// `header` cannot be recorded.
    pub fn create(
        path: impl AsRef<Path>,
        header: Header,
        overwrite: Overwrite,
    ) -> Result<Self, Error> {
        let path = path.as_ref();
        RecordingFile::later(path, overwrite)
            .and_then(|file| Self::new(file, header))
            .map_err(Error::in_file(path))
    }
}

impl<W: Write> Recorder<W> {
    /// A recorder to anything that takes bytes. Nothing is written before the first frame.
    ///
    /// # Errors
    /// `header` cannot be recorded: names used twice, or an attachment above the limit.
    pub fn new(writer: W, header: Header) -> Result<Self, Error> {
        let limits = Limits::default();
        header::check(&header, limits.attachment_bytes)?;
        Ok(Self::in_state(State::Waiting(writer, header)))
    }

    /// A recorder that continues `stream`, to which the header is written.
    pub(crate) fn with_stream(stream: Stream<W>) -> Self {
        Self::in_state(State::Recording(Box::new(stream)))
    }

    fn in_state(state: State<W>) -> Self {
        Self {
            state,
            limits: Limits::default(),
            last: None,
            n_frames: 0,
            shown: Shown::default(),
            last_checkpoint: None,
        }
    }

    /// Index and time of the last frame in the recording.
    pub fn last_frame(&self) -> Option<FrameInfo> {
        self.last
    }

    /// Records one frame and flushes it.
    ///
    /// # Errors
    /// The frame cannot be recorded (its index does not rise, its time falls, a triangle names
    /// a point that is not there, names repeat, the report is no JSON object, it is too
    /// large): nothing is written, and recording may continue. Or the writer refuses: then the
    /// recorder stops for good.
    pub fn frame(&mut self, frame: &Frame<'_>) -> Result<(), Error> {
        let encoded = encode::encode(frame, &self.shown)?;
        let info = FrameInfo { index: frame.index, time_s: frame.time_s };
        self.encoded_frame(info, &encoded)?;
        self.shown = Shown::by(frame);
        Ok(())
    }

    /// Records the exact state at the end of the last frame and flushes it.
    ///
    /// # Errors
    /// The checkpoint is not of the last frame, or is its second one, or is too large: nothing
    /// is written, and recording may continue. Or the writer refuses: then the recorder stops
    /// for good.
    pub fn checkpoint(&mut self, checkpoint: &Checkpoint) -> Result<(), Error> {
        self.encoded_checkpoint(checkpoint.frame, &checkpoint::encode(checkpoint))
    }

    /// Closes the recording and hands back the writer. A recording without a frame is written
    /// too.
    ///
    /// # Errors
    /// The writer refuses, now or earlier.
    pub fn finish(mut self) -> Result<W, Error> {
        self.stream()?;
        match std::mem::replace(&mut self.state, State::Stopped) {
            State::Recording(stream) => stream.finish(self.n_frames),
            _ => Err(Error::Stopped),
        }
    }

    /// Sets what [`Self::frame`] compares the next frame with.
    pub(crate) fn set_shown(&mut self, shown: Shown) {
        self.shown = shown;
    }

    pub(crate) fn encoded_frame(
        &mut self,
        info: FrameInfo,
        encoded: &EncodedFrame,
    ) -> Result<(), Error> {
        let refuse = |what: String| Error::unrecordable(format!("frame {}: {what}", info.index));
        if let Some(last) = self.last {
            if info.index <= last.index {
                return Err(refuse(format!("the last one was frame {}", last.index)));
            }
            if info.time_s < last.time_s {
                return Err(refuse(format!(
                    "its time is {} s, that of the last one {} s",
                    info.time_s, last.time_s
                )));
            }
        }
        let stamp = stamp(info).map_err(refuse)?;
        let bytes: usize = encoded.geometry.iter().map(|(_, data)| data.len()).sum();
        self.check_size(bytes.max(encoded.report.len())).map_err(refuse)?;
        let mark = FrameMark {
            frame: info.index,
            time_s: Some(info.time_s),
            ordinal: self.n_frames,
            messages: encoded.geometry.len() as u32 + 1,
        };
        self.write(|stream| {
            for (topic, data) in &encoded.geometry {
                stream.message(*topic, stamp, data)?;
            }
            // A chunk of its own for the end of the frame: lists of frames and reports are read
            // without touching the meshes.
            stream.flush()?;
            stream.message(Topic::Mark, stamp, &mark.encode_to_vec())?;
            stream.message(Topic::Report, stamp, &encoded.report)?;
            stream.flush()
        })?;
        self.last = Some(info);
        self.n_frames += 1;
        Ok(())
    }

    pub(crate) fn encoded_checkpoint(&mut self, frame: u64, data: &[u8]) -> Result<(), Error> {
        let refuse =
            |what: String| Error::unrecordable(format!("a checkpoint at frame {frame}: {what}"));
        let last = match self.last {
            Some(last) if last.index == frame => last,
            Some(last) => return Err(refuse(format!("the last frame is {}", last.index))),
            None => return Err(refuse("no frame is recorded yet".into())),
        };
        if self.last_checkpoint == Some(frame) {
            return Err(refuse("there is one already".into()));
        }
        self.check_size(data.len()).map_err(refuse)?;
        let stamp = stamp(last).map_err(refuse)?;
        self.write(|stream| {
            stream.message(Topic::Checkpoint, stamp, data)?;
            stream.flush()
        })?;
        self.last_checkpoint = Some(frame);
        Ok(())
    }

    fn check_size(&self, bytes: usize) -> Result<(), String> {
        // Record headers come on top: a few tens of bytes per message.
        let bytes = bytes as u64 + 1024;
        if bytes > self.limits.chunk_bytes {
            return Err(format!("{bytes} bytes, the limit is {}", self.limits.chunk_bytes));
        }
        Ok(())
    }

    /// Runs `write`; an error stops the recorder for good.
    fn write(
        &mut self,
        write: impl FnOnce(&mut Stream<W>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let result = write(self.stream()?);
        if result.is_err()
            && let State::Recording(stream) = std::mem::replace(&mut self.state, State::Stopped)
        {
            stream.abandon();
        }
        result
    }

    /// The stream, opened if nothing has been written yet.
    fn stream(&mut self) -> Result<&mut Stream<W>, Error> {
        if matches!(self.state, State::Waiting(..))
            && let State::Waiting(writer, header) =
                std::mem::replace(&mut self.state, State::Stopped)
        {
            let Header { software, metadata, attachments } = header;
            let mut stream = Stream::open(writer, &software, &metadata, attachments.len())?;
            for Attachment { name, media_type, data } in &attachments {
                stream.attach(name, media_type, data)?;
            }
            stream.flush()?;
            self.state = State::Recording(Box::new(stream));
        }
        match &mut self.state {
            State::Recording(stream) => Ok(stream),
            _ => Err(Error::Stopped),
        }
    }
}

fn stamp(info: FrameInfo) -> Result<Stamp, String> {
    let sequence = u32::try_from(info.index)
        .map_err(|_| format!("index {} is above {}", info.index, u32::MAX))?;
    Ok(Stamp { sequence, log_time: encode::time_ns(info.time_s)? })
}
