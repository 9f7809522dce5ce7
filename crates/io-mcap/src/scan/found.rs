//! What a walk through a recording has found.

use std::collections::BTreeMap;

use crate::chunk::Chunk;
use crate::status::{self, Damage, Status};
use crate::topic::Topic;
use crate::{AttachmentInfo, CheckpointInfo, FrameInfo, header};

/// A complete frame and the chunks that hold it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameEntry {
    pub(crate) info: FrameInfo,
    /// Frames recorded before it.
    pub(crate) ordinal: u64,
    /// Its messages without the mark.
    pub(crate) messages: u32,
    /// First and last position in [`Scan::chunks`]; its report is in the last.
    pub(crate) chunks: (usize, usize),
}

/// A checkpoint and the chunk that holds it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CheckpointEntry {
    pub(crate) info: CheckpointInfo,
    /// Position in [`Scan::chunks`].
    pub(crate) chunk: usize,
}

/// An attachment and where it lies.
#[derive(Clone, Debug)]
pub(crate) struct AttachmentEntry {
    pub(crate) info: AttachmentInfo,
    /// Offset of the content of its record, where the CRC begins to count.
    pub(crate) start: u64,
    /// Offset of the data.
    pub(crate) data: u64,
}

/// What a recording holds.
#[derive(Debug)]
pub(crate) struct Scan {
    pub(crate) software: String,
    /// `None` until its record is met.
    pub(crate) metadata: Option<BTreeMap<String, String>>,
    pub(crate) attachments: Vec<AttachmentEntry>,
    /// Attachments announced by the header.
    pub(super) n_attachments: usize,
    /// Topic of each channel id; `None` for topics of others.
    pub(crate) channels: BTreeMap<u16, Option<Topic>>,
    pub(crate) chunks: Vec<Chunk>,
    pub(crate) frames: Vec<FrameEntry>,
    pub(crate) checkpoints: Vec<CheckpointEntry>,
    /// The opening metadata was read.
    pub(super) is_recording: bool,
    /// The frames that the end record counts.
    pub(super) frames_at_end: Option<u64>,
    damage: Vec<Damage>,
    /// Where and how the file stops, if early.
    cut: Option<Damage>,
    useful_end: u64,
    file_len: u64,
}

impl Scan {
    pub(super) fn new(file_len: u64) -> Self {
        Self {
            software: String::new(),
            metadata: None,
            attachments: Vec::new(),
            n_attachments: 0,
            channels: BTreeMap::new(),
            chunks: Vec::new(),
            frames: Vec::new(),
            checkpoints: Vec::new(),
            is_recording: false,
            frames_at_end: None,
            damage: Vec::new(),
            cut: None,
            useful_end: 0,
            file_len,
        }
    }

    pub(crate) fn status(&self) -> Status {
        let frames_complete = self.frames.len() as u64;
        let Some(cut) = &self.cut else {
            if self.damage.is_empty() {
                return Status::Complete;
            }
            return Status::Damaged { frames_complete, reason: status::describe(&self.damage) };
        };
        let mut reason = cut.to_string();
        if !self.damage.is_empty() {
            reason = format!("{reason}; and damage: {}", status::describe(&self.damage));
        }
        Status::Cut { frames_complete, bytes_lost: self.file_len - self.useful_end, reason }
    }

    pub(crate) fn is_clean(&self) -> bool {
        self.cut.is_none() && self.damage.is_empty()
    }

    /// What of the header cannot be read, if anything.
    pub(crate) fn missing_header(&self) -> Option<String> {
        let (here, announced) = (self.attachments.len(), self.n_attachments);
        match &self.metadata {
            None => Some(format!("metadata {:?} cannot be read", header::RUN)),
            _ if here == announced => None,
            _ => Some(format!("{here} of {announced} attachments can be read")),
        }
    }

    /// The id of the channel of `topic`.
    pub(super) fn channel_of(&self, topic: Topic) -> Option<u16> {
        self.channels.iter().find(|(_, t)| **t == Some(topic)).map(|(id, _)| *id)
    }

    pub(super) fn has_damage(&self) -> bool {
        !self.damage.is_empty()
    }

    pub(super) fn is_cut(&self) -> bool {
        self.cut.is_some()
    }

    /// Everything up to byte `end` is of use.
    pub(super) fn useful_until(&mut self, end: u64) {
        self.useful_end = end;
    }

    pub(super) fn cut_at(&mut self, offset: u64, what: impl Into<String>) {
        self.cut = Some(Damage { offset, what: what.into() });
    }

    /// Says more about the cut, if there is one.
    pub(super) fn add_to_cut(&mut self, more: &str) -> bool {
        if let Some(cut) = &mut self.cut {
            cut.what = format!("{}; {more}", cut.what);
        }
        self.cut.is_some()
    }

    /// Notes damage. A file of nothing else must not fill the memory with notes.
    pub(super) fn note(&mut self, offset: u64, what: impl Into<String>) {
        const MOST: usize = 1000;
        if self.damage.len() < MOST {
            self.damage.push(Damage { offset, what: what.into() });
        }
    }
}
