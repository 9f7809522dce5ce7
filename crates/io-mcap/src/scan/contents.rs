//! The content of chunks met on the walk: channels, ends of frames, checkpoints.

use std::collections::BTreeMap;
use std::io::{Read, Seek};

use prost::Message as _;

use crate::proto::FrameMark;
use crate::records::{self, Message, op};
use crate::topic::{Topic, TopicSet};
use crate::{CheckpointInfo, Error, FrameInfo, checkpoint};

use super::{CheckpointEntry, FrameEntry, Walk};

/// The frame of which messages are being met.
#[derive(Default)]
pub(super) struct Progress {
    /// The mark of a frame whose report is still to come.
    mark: Option<FrameMark>,
    /// Messages met of each frame since the last complete one; only those in chunks that were
    /// read.
    met: BTreeMap<u32, u32>,
    /// First chunk that may hold messages of the next frame.
    first_chunk: usize,
    last_ordinal: Option<u64>,
}

impl<R: Read + Seek> Walk<'_, R> {
    /// Reads the chunk at `position`, whose message indexes end at byte `end`. Damage is noted.
    ///
    /// # Errors
    /// The file cannot be read.
    pub(super) fn read_chunk(&mut self, position: usize, end: u64) -> Result<(), Error> {
        let chunk = &self.scan.chunks[position];
        let offset = chunk.offset;
        let mut topics = TopicSet::default();
        match chunk.content(self.source, self.limits) {
            Ok(content) => {
                for record in records::in_chunk(&content) {
                    match record {
                        Some((op::CHANNEL, body)) => self.channel(offset, body),
                        Some((op::MESSAGE, body)) => {
                            topics.extend(self.message(position, body));
                        }
                        Some(_) => {}
                        None => self.scan.note(offset, "a chunk that ends inside a record"),
                    }
                }
                // A chunk of meshes is of use only once the end of its frame is there.
                if !topics.is_only_geometry() {
                    self.scan.useful_until(end);
                }
            }
            Err(error @ Error::Io { .. }) => return Err(error),
            Err(Error::Damaged { what, .. }) => self.scan.note(offset, what),
            Err(error) => self.scan.note(offset, error.to_string()),
        }
        if self.scan.channels.is_empty() {
            // The chunk that tells the channels is damaged, but the format fixes their numbers.
            self.scan.channels = Topic::ALL.map(|topic| (topic.id(), Some(topic))).into();
        }
        self.scan.chunks[position].topics = Some(topics);
        Ok(())
    }

    fn channel(&mut self, offset: u64, body: &[u8]) {
        let Some((id, name)) = records::channel(body) else {
            self.scan.note(offset, "a channel that cannot be read");
            return;
        };
        let topic = Topic::named(name);
        let known = *self.scan.channels.entry(id).or_insert(topic);
        if known != topic {
            self.scan.note(offset, format!("channel {id} is {name:?}, but was another before"));
        }
    }

    /// The topic of a message, once its part in a frame or checkpoint is entered.
    fn message(&mut self, position: usize, body: &[u8]) -> Option<Topic> {
        let offset = self.scan.chunks[position].offset;
        let Some(message) = Message::parse(body) else {
            self.scan.note(offset, format!("a message of {} bytes", body.len()));
            return None;
        };
        let Some(&topic) = self.scan.channels.get(&message.channel) else {
            self.scan.note(offset, format!("a message on unknown channel {}", message.channel));
            return None;
        };
        let result = match topic? {
            Topic::Mark => self.mark(message),
            Topic::Report => self.report(position, message),
            Topic::Checkpoint => self.checkpoint(position, message),
            _ => {
                *self.progress.met.entry(message.sequence).or_default() += 1;
                Ok(())
            }
        };
        if let Err(what) = result {
            self.scan.note(offset, what);
        }
        topic
    }

    fn mark(&mut self, message: Message<'_>) -> Result<(), String> {
        let lost = self.progress.mark.take();
        let mark = FrameMark::decode(message.data).map_err(|e| format!("frame mark: {e}"))?;
        let last = self.scan.frames.last().map(|f| f.info.index);
        if mark.frame != u64::from(message.sequence) || last.is_some_and(|l| mark.frame <= l) {
            return Err(format!("frame {} marked after frame {last:?}", mark.frame));
        }
        let expected = self.progress.last_ordinal.map_or(0, |last| last.saturating_add(1));
        self.progress.last_ordinal = Some(mark.ordinal);
        let (frame, ordinal) = (mark.frame, mark.ordinal);
        self.progress.mark = Some(mark);
        if let Some(lost) = lost {
            return Err(format!("frame {} has no report", lost.frame));
        }
        if ordinal != expected {
            return Err(format!("frame {frame} is number {ordinal}, expected {expected}"));
        }
        Ok(())
    }

    fn report(&mut self, position: usize, message: Message<'_>) -> Result<(), String> {
        let sequence = message.sequence;
        let first_chunk = std::mem::replace(&mut self.progress.first_chunk, position);
        let met = std::mem::take(&mut self.progress.met);
        let mark = self
            .progress
            .mark
            .take()
            .filter(|mark| mark.frame == u64::from(sequence))
            .ok_or_else(|| format!("a report of frame {sequence} without its mark"))?;
        if self.validate {
            // The report is one of them.
            let met = met.get(&sequence).copied().unwrap_or_default().saturating_add(1);
            if met != mark.messages {
                return Err(format!(
                    "frame {sequence} is lost: {met} of its {} messages can be read",
                    mark.messages
                ));
            }
        }
        self.scan.frames.push(FrameEntry {
            info: FrameInfo { index: mark.frame, time_s: mark.time_s.unwrap_or_default() },
            ordinal: mark.ordinal,
            messages: mark.messages,
            chunks: (first_chunk, position),
        });
        Ok(())
    }

    fn checkpoint(&mut self, position: usize, message: Message<'_>) -> Result<(), String> {
        let checkpoint = checkpoint::decode(message.data)?;
        let info = CheckpointInfo { frame: checkpoint.frame, time_s: checkpoint.time_s };
        let last = self.scan.checkpoints.last().map(|c| c.info.frame);
        if last.is_some_and(|last| info.frame <= last) {
            return Err(format!("checkpoint {} after checkpoint {last:?}", info.frame));
        }
        self.scan.checkpoints.push(CheckpointEntry { info, chunk: position });
        Ok(())
    }

    /// Compares what was met with what the header and the end record tell.
    pub(super) fn check_end(&mut self) {
        let scan = &mut self.scan;
        let end = self.source.len();
        if let Some(missing) = scan.missing_header().filter(|_| !scan.has_damage())
            && !scan.add_to_cut(&missing)
        {
            scan.note(0, missing);
        }
        if scan.is_cut() {
            return;
        }
        let frames = scan.frames.len() as u64;
        match scan.frames_at_end {
            None => scan.cut_at(end, "the file was closed before the run ended"),
            Some(n) if n != frames && !scan.has_damage() => {
                scan.note(end, format!("{frames} of {n} frames can be read"));
            }
            Some(_) => {}
        }
    }
}
