//! The walk through a recording from its first byte to the last one that can be read.
//!
//! It goes from record to record and seeks over the meshes. What ends a frame is read, so the
//! frames are known; with `validate` every chunk and attachment is read and checked. The
//! summary at the end of a whole file is not used: one way to read whole and cut files.

mod contents;
mod found;
mod header_records;

use std::io::{Read, Seek};

use crate::chunk::Chunk;
use crate::records::{self, ChunkHeader, HEAD, op};
use crate::source::Source;
use crate::topic::{Topic, TopicSet};
use crate::{CheckpointInfo, Error, Limits, encode};

use contents::Progress;
pub(crate) use found::{AttachmentEntry, CheckpointEntry, FrameEntry, Scan};

impl Scan {
    /// Walks through the file; a file that is not clean is walked through again with every
    /// CRC checked.
    ///
    /// # Errors
    /// The file cannot be read, or is not a recording.
    pub(crate) fn of<R: Read + Seek>(
        source: &mut Source<R>,
        limits: &Limits,
        validate: bool,
    ) -> Result<Self, Error> {
        let scan = Walk::through(source, limits, validate)?;
        if validate || scan.is_clean() {
            return Ok(scan);
        }
        Walk::through(source, limits, true)
    }
}

/// The record at which the walk stands.
#[derive(Clone, Copy)]
struct Record {
    offset: u64,
    opcode: u8,
    size: u64,
}

impl Record {
    fn content(&self) -> u64 {
        self.offset + HEAD
    }

    fn end(&self) -> u64 {
        self.content() + self.size
    }
}

/// What follows a record.
enum Step {
    Next,
    /// The file has its end here.
    End,
    /// Nothing behind this record can be read, for this reason.
    Stop(String),
}

/// A chunk whose message indexes are still being read.
struct Unsettled {
    chunk: Chunk,
    /// Log time (ns) of the first message on each channel, as the indexes have it.
    indexed: Vec<(u16, Option<u64>)>,
    /// An index could not be read.
    unknown: bool,
}

/// A walk under way.
struct Walk<'a, R> {
    source: &'a mut Source<R>,
    limits: &'a Limits,
    validate: bool,
    scan: Scan,
    progress: Progress,
    unsettled: Option<Unsettled>,
    data_ended: bool,
}

impl<'a, R: Read + Seek> Walk<'a, R> {
    fn through(
        source: &'a mut Source<R>,
        limits: &'a Limits,
        validate: bool,
    ) -> Result<Scan, Error> {
        check_magic(source)?;
        let mut walk = Self {
            scan: Scan::new(source.len()),
            source,
            limits,
            validate,
            progress: Progress::default(),
            unsettled: None,
            data_ended: false,
        };
        let mut offset = mcap::MAGIC.len() as u64;
        loop {
            let record = match walk.record_at(offset)? {
                Ok(record) => record,
                Err(why) => {
                    walk.settle(offset)?;
                    walk.scan.cut_at(offset, why);
                    break;
                }
            };
            if record.opcode != op::MESSAGE_INDEX {
                walk.settle(offset)?;
            }
            match walk.take(record)? {
                Step::Next => offset = record.end(),
                Step::End => break,
                Step::Stop(why) => {
                    walk.scan.cut_at(offset, why);
                    break;
                }
            }
        }
        walk.finish()
    }

    /// The record at `offset`, or why there is none.
    fn record_at(&mut self, offset: u64) -> Result<Result<Record, String>, Error> {
        let left = self.source.len() - offset;
        if left == 0 {
            return Ok(Err("the file ends here without its end record".into()));
        }
        if left < HEAD {
            return Ok(Err(format!("a record needs {HEAD} bytes at least, {left} are left")));
        }
        let mut bytes = [0; HEAD as usize];
        self.source.read_at(offset, &mut bytes)?;
        let (opcode, size) = records::head(&bytes);
        if size > left - HEAD {
            return Ok(Err(format!(
                "a record ({}) of {size} bytes, {} are left",
                records::name(opcode),
                left - HEAD
            )));
        }
        Ok(Ok(Record { offset, opcode, size }))
    }

    fn take(&mut self, record: Record) -> Result<Step, Error> {
        match record.opcode {
            op::HEADER | 0x80.. => {}
            op::METADATA => self.metadata(record)?,
            op::ATTACHMENT => self.attachment(record)?,
            op::CHUNK => {
                self.chunk(record)?;
                return Ok(Step::Next);
            }
            op::MESSAGE_INDEX => {
                self.message_index(record)?;
                return Ok(Step::Next);
            }
            op::DATA_END => self.data_ended = true,
            op::FOOTER if self.data_ended => return self.footer(record),
            op::SCHEMA
            | op::CHANNEL
            | op::STATISTICS
            | op::CHUNK_INDEX
            | op::ATTACHMENT_INDEX
            | op::METADATA_INDEX
            | op::SUMMARY_OFFSET
                if self.data_ended => {}
            opcode => {
                let name = records::name(opcode);
                return Ok(Step::Stop(format!("a record of type {opcode:#04x} ({name})")));
            }
        }
        self.scan.useful_until(record.end());
        Ok(Step::Next)
    }

    fn footer(&mut self, record: Record) -> Result<Step, Error> {
        let magic = mcap::MAGIC;
        let left = self.source.len() - record.end();
        if left != magic.len() as u64 {
            return Ok(Step::Stop(format!("a footer with {left} bytes behind it instead of 8")));
        }
        let mut bytes = [0; 8];
        self.source.read_at(record.end(), &mut bytes)?;
        if bytes != magic {
            return Ok(Step::Stop(format!("a file that ends with {bytes:02x?}")));
        }
        self.scan.useful_until(self.source.len());
        Ok(Step::End)
    }

    fn chunk(&mut self, record: Record) -> Result<(), Error> {
        let n = record.size.min(ChunkHeader::ENOUGH as u64);
        let bytes = self.source.bytes_at(record.content(), n)?;
        match ChunkHeader::parse(&bytes) {
            Some(header) if header.chunk_bytes() <= record.size => {
                let data = record.content() + header.length;
                let chunk = Chunk { offset: record.offset, data, header, topics: None };
                self.unsettled = Some(Unsettled { chunk, indexed: Vec::new(), unknown: false });
            }
            Some(header) => self.scan.note(
                record.offset,
                format!(
                    "a chunk of {} bytes in a record of {}",
                    header.compressed_size, record.size
                ),
            ),
            None => self.scan.note(record.offset, "a chunk without a readable header"),
        }
        Ok(())
    }

    fn message_index(&mut self, record: Record) -> Result<(), Error> {
        // Channel, length and the first entry's time.
        let bytes = self.source.bytes_at(record.content(), record.size.min(14))?;
        if let Some(unsettled) = &mut self.unsettled {
            match records::message_index(&bytes) {
                Some(entry) if unsettled.indexed.len() < usize::from(u16::MAX) => {
                    unsettled.indexed.push(entry);
                }
                _ => unsettled.unknown = true,
            }
        }
        Ok(())
    }

    /// Enters the chunk whose message indexes end at `offset`, if there is one, and reads its
    /// content where that is needed.
    fn settle(&mut self, offset: u64) -> Result<(), Error> {
        let Some(unsettled) = self.unsettled.take() else { return Ok(()) };
        let topics = self.indexed_topics(&unsettled);
        let mut chunk = unsettled.chunk;
        chunk.topics = topics;
        let position = self.scan.chunks.len();
        self.scan.chunks.push(chunk);
        let Some(topics) = topics.filter(|topics| !self.validate && !topics.closes_frame()) else {
            return self.read_chunk(position, offset);
        };
        if topics.contains(Topic::Checkpoint) {
            // The index tells its time only. That is the last frame's, unless that one is lost.
            let id = self.scan.channel_of(Topic::Checkpoint);
            let time = unsettled.indexed.iter().find(|(c, _)| Some(*c) == id).and_then(|e| e.1);
            let last = self.scan.frames.last().map(|f| f.info);
            let Some(last) = last.filter(|last| encode::time_ns(last.time_s).ok() == time) else {
                return self.read_chunk(position, offset);
            };
            let info = CheckpointInfo { frame: last.index, time_s: last.time_s };
            self.scan.checkpoints.push(CheckpointEntry { info, chunk: position });
            self.scan.useful_until(offset);
        }
        Ok(())
    }

    /// Topics by the message indexes, if these are there and name known channels only.
    fn indexed_topics(&self, unsettled: &Unsettled) -> Option<TopicSet> {
        if unsettled.unknown || unsettled.indexed.is_empty() {
            return None;
        }
        let mut topics = TopicSet::default();
        for (channel, _) in &unsettled.indexed {
            if let Some(topic) = *self.scan.channels.get(channel)? {
                topics.insert(topic);
            }
        }
        Some(topics)
    }

    fn finish(mut self) -> Result<Scan, Error> {
        if !self.scan.is_recording {
            return Err(Error::NotRecording { bytes: self.source.len() });
        }
        self.check_end();
        Ok(self.scan)
    }
}

fn check_magic<R: Read + Seek>(source: &mut Source<R>) -> Result<(), Error> {
    let magic = mcap::MAGIC;
    if source.len() == 0 {
        return Err(Error::Empty);
    }
    let found = source.bytes_at(0, source.len().min(magic.len() as u64))?;
    if found != magic {
        return Err(Error::NotMcap { found });
    }
    Ok(())
}
