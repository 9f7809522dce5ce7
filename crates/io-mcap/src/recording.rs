//! Reading a recording: what it holds, then one frame, report or checkpoint at a time.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;

use crate::encode::EncodedFrame;
use crate::records::{self, Message, op};
use crate::scan::{AttachmentEntry, FrameEntry, Scan};
use crate::source::Source;
use crate::status::Status;
use crate::topic::Topic;
use crate::{
    AttachmentInfo, Checkpoint, CheckpointInfo, Error, FrameInfo, Header, Limits, OwnedFrame,
    checkpoint, decode, header,
};

/// A recording open for reading, whole or cut.
///
/// In memory are the places of its parts, and one chunk while it is read; every chunk is
/// checked by its CRC each time. A whole file is opened without reading its meshes; one that is
/// cut or damaged is read through once, and frames with damage are not listed.
pub struct Recording<R> {
    source: Source<R>,
    scan: Scan,
    limits: Limits,
}

impl Recording<File> {
    /// Opens the file at `path` with the default [`Limits`].
    ///
    /// # Errors
    /// The file cannot be read, or is not a recording. A recording that is cut or damaged is
    /// no error: see [`Self::status`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::open_with(path, Limits::default())
    }

    /// Opens the file at `path` with limits of the caller's.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn open_with(path: impl AsRef<Path>, limits: Limits) -> Result<Self, Error> {
        let path = path.as_ref();
        File::open(path)
            .map_err(Error::io("open the recording"))
            .and_then(|file| Self::read(file, limits))
            .map_err(Error::in_file(path))
    }
}

impl<R: Read + Seek> Recording<R> {
    /// Opens a recording in anything that is read like a file.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn read(reader: R, limits: Limits) -> Result<Self, Error> {
        let mut source = Source::new(reader)?;
        let scan = Scan::of(&mut source, &limits, false)?;
        Ok(Self { source, scan, limits })
    }

    /// Whether the recording is whole. Damage inside the meshes of a whole file shows only when
    /// they are read, or by [`Self::verify`].
    pub fn status(&self) -> Status {
        self.scan.status()
    }

    /// Reads everything once and checks every CRC. From then on damaged frames are not listed.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn verify(&mut self) -> Result<Status, Error> {
        self.scan = Scan::of(&mut self.source, &self.limits, true)?;
        Ok(self.scan.status())
    }

    /// The program that recorded; see [`Header::software`].
    pub fn software(&self) -> &str {
        &self.scan.software
    }

    /// See [`Header::metadata`].
    pub fn metadata(&self) -> &BTreeMap<String, String> {
        static NONE: BTreeMap<String, String> = BTreeMap::new();
        self.scan.metadata.as_ref().unwrap_or(&NONE)
    }

    /// The attachments, in the order recorded.
    pub fn attachments(&self) -> Vec<AttachmentInfo> {
        self.scan.attachments.iter().map(|entry| entry.info.clone()).collect()
    }

    /// The content of the attachment called `name`.
    ///
    /// # Errors
    /// There is none, it is damaged, or above the limit.
    pub fn attachment(&mut self, name: &str) -> Result<Vec<u8>, Error> {
        let entries = &self.scan.attachments;
        let Some(entry) = entries.iter().find(|entry| entry.info.name == name) else {
            let held = entries.iter().map(|e| format!("{:?}", e.info.name));
            return Err(Error::NoAttachment { name: name.into(), held: list(held) });
        };
        entry.data(&mut self.source, &self.limits)
    }

    /// All of the header, with the content of every attachment.
    ///
    /// # Errors
    /// As [`Self::attachment`].
    pub fn header(&mut self) -> Result<Header, Error> {
        let mut attachments = Vec::new();
        for entry in &self.scan.attachments {
            attachments.push(header::Attachment {
                name: entry.info.name.clone(),
                media_type: entry.info.media_type.clone(),
                data: entry.data(&mut self.source, &self.limits)?,
            });
        }
        let (software, metadata) = (self.scan.software.clone(), self.metadata().clone());
        Ok(Header { software, metadata, attachments })
    }

    /// Index and time of every complete frame, in rising order.
    pub fn frames(&self) -> impl ExactSizeIterator<Item = FrameInfo> + '_ {
        self.scan.frames.iter().map(|entry| entry.info)
    }

    /// The frame with number `index`.
    ///
    /// # Errors
    /// It is not in the recording, is damaged, or above the limit.
    pub fn frame(&mut self, index: u64) -> Result<OwnedFrame, Error> {
        let entry = self.entry(index)?;
        let EncodedFrame { geometry, report } = self.encoded_frame(&entry)?;
        decode::decode(entry.info, &geometry, &report)
            .map_err(|what| self.frame_damage(&entry, what))
    }

    /// The report of frame `index`, read without its meshes.
    ///
    /// # Errors
    /// As [`Self::frame`].
    pub fn report(&mut self, index: u64) -> Result<serde_json::Value, Error> {
        let entry = self.entry(index)?;
        let report = self.report_bytes(&entry)?;
        decode::decode_report(&report).map_err(|what| self.frame_damage(&entry, what))
    }

    /// Frame and time of every checkpoint, in rising order.
    pub fn checkpoints(&self) -> impl ExactSizeIterator<Item = CheckpointInfo> + '_ {
        self.scan.checkpoints.iter().map(|entry| entry.info)
    }

    /// The checkpoint taken at frame `frame`.
    ///
    /// # Errors
    /// There is none, it is damaged, or above the limit.
    pub fn checkpoint(&mut self, frame: u64) -> Result<Checkpoint, Error> {
        match self.encoded_checkpoint(frame)? {
            Some((_, checkpoint)) => Ok(checkpoint),
            None => {
                let held = list(self.checkpoints().map(|c| c.frame.to_string()));
                Err(Error::NoCheckpoint { frame, held })
            }
        }
    }

    pub(crate) fn scan(&self) -> &Scan {
        &self.scan
    }

    /// The entry of frame `index`.
    pub(crate) fn entry(&self, index: u64) -> Result<FrameEntry, Error> {
        let frames = &self.scan.frames;
        frames.binary_search_by_key(&index, |entry| entry.info.index).map(|k| frames[k]).map_err(
            |_| {
                let held = match (frames.first(), frames.last()) {
                    (Some(a), Some(b)) => {
                        let (a, b) = (a.info.index, b.info.index);
                        format!("{} frames from {a} to {b}", frames.len())
                    }
                    _ => "no frame".into(),
                };
                Error::NoFrame { frame: index, held }
            },
        )
    }

    /// The messages of a frame, checked to be all there.
    pub(crate) fn encoded_frame(&mut self, entry: &FrameEntry) -> Result<EncodedFrame, Error> {
        let (first, last) = entry.chunks;
        let mut geometry = Vec::new();
        for position in first..=last {
            if self.scan.chunks[position].topics.is_none_or(|topics| topics.has_geometry()) {
                self.messages(position, |topic, message| {
                    if Topic::GEOMETRY.contains(&topic)
                        && u64::from(message.sequence) == entry.info.index
                    {
                        geometry.push((topic, message.data.to_vec()));
                    }
                })?;
            }
        }
        if geometry.len() as u64 + 1 != u64::from(entry.messages) {
            let what = format!("{} messages instead of {}", geometry.len() + 1, entry.messages);
            return Err(self.frame_damage(entry, what));
        }
        Ok(EncodedFrame { geometry, report: self.report_bytes(entry)? })
    }

    /// The checkpoint at `frame` as written and as decoded, if there is one.
    pub(crate) fn encoded_checkpoint(
        &mut self,
        frame: u64,
    ) -> Result<Option<(Vec<u8>, Checkpoint)>, Error> {
        let checkpoints = &self.scan.checkpoints;
        let Ok(k) = checkpoints.binary_search_by_key(&frame, |entry| entry.info.frame) else {
            return Ok(None);
        };
        let position = checkpoints[k].chunk;
        let mut found = None;
        self.messages(position, |topic, message| {
            if topic == Topic::Checkpoint && u64::from(message.sequence) == frame {
                found = Some(message.data.to_vec());
            }
        })?;
        let decoded = found
            .ok_or_else(|| format!("no checkpoint of frame {frame}"))
            .and_then(|bytes| checkpoint::decode(&bytes).map(|c| (bytes, c)))
            .and_then(|(bytes, checkpoint)| {
                if checkpoint.frame == frame {
                    Ok((bytes, checkpoint))
                } else {
                    Err(format!("the checkpoint of frame {}, not {frame}", checkpoint.frame))
                }
            });
        decoded.map(Some).map_err(|what| Error::damaged(self.scan.chunks[position].offset, what))
    }

    fn report_bytes(&mut self, entry: &FrameEntry) -> Result<Vec<u8>, Error> {
        let mut report = None;
        self.messages(entry.chunks.1, |topic, message| {
            if topic == Topic::Report && u64::from(message.sequence) == entry.info.index {
                report = Some(message.data.to_vec());
            }
        })?;
        report.ok_or_else(|| self.frame_damage(entry, "no report".into()))
    }

    fn frame_damage(&self, entry: &FrameEntry, what: String) -> Error {
        let offset = self.scan.chunks[entry.chunks.1].offset;
        Error::damaged(offset, format!("frame {}: {what}", entry.info.index))
    }

    /// Hands every message of a chunk to `each`.
    fn messages(
        &mut self,
        position: usize,
        mut each: impl FnMut(Topic, Message<'_>),
    ) -> Result<(), Error> {
        let content = self.scan.chunks[position].content(&mut self.source, &self.limits)?;
        for (opcode, body) in records::in_chunk(&content).flatten() {
            if opcode == op::MESSAGE
                && let Some(message) = Message::parse(body)
                && let Some(&Some(topic)) = self.scan.channels.get(&message.channel)
            {
                each(topic, message);
            }
        }
        Ok(())
    }
}

impl AttachmentEntry {
    /// What is wrong with the attachment, if anything.
    pub(crate) fn check<R: Read + Seek>(
        &self,
        source: &mut Source<R>,
    ) -> Result<Result<(), String>, Error> {
        let end = self.data + self.info.bytes;
        let computed = source.crc_at(self.start, end - self.start)?;
        let mut stored = [0; 4];
        source.read_at(end, &mut stored)?;
        let stored = u32::from_le_bytes(stored);
        if stored == computed {
            return Ok(Ok(()));
        }
        let name = &self.info.name;
        Ok(Err(format!("attachment {name:?} has CRC {computed:08x}, but {stored:08x} was written")))
    }

    fn data<R: Read + Seek>(
        &self,
        source: &mut Source<R>,
        limits: &Limits,
    ) -> Result<Vec<u8>, Error> {
        let (bytes, limit) = (self.info.bytes, limits.attachment_bytes);
        if bytes > limit {
            return Err(Error::TooLarge { what: "attachment", offset: self.start, bytes, limit });
        }
        self.check(source)?.map_err(|what| Error::damaged(self.start, what))?;
        source.bytes_at(self.data, bytes)
    }
}

fn list(words: impl Iterator<Item = String>) -> String {
    let words: Vec<String> = words.collect();
    if words.is_empty() { "none".into() } else { words.join(", ") }
}
