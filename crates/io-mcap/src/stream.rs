//! The MCAP being written: header first, then messages whose chunks end where we say.

use std::collections::BTreeMap;
use std::io::{BufWriter, Write};

use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{Compression, WriteOptions};

use crate::topic::Topic;
use crate::{Error, header};

/// Which frame a message belongs to, as MCAP stores it.
#[derive(Clone, Copy)]
pub(crate) struct Stamp {
    /// Frame index.
    pub(crate) sequence: u32,
    /// Time on the clock of the file (ns).
    pub(crate) log_time: u64,
}

/// An open MCAP. Nothing is rewritten: bytes only ever follow bytes, so that what a kill
/// leaves behind is a beginning of the file.
pub(crate) struct Stream<W: Write> {
    writer: mcap::Writer<NoSeek<BufWriter<W>>>,
}

impl<W: Write> Stream<W> {
    /// Writes the metadata and the channels, and flushes. `n_attachments` must follow by
    /// [`Self::attach`].
    pub(crate) fn open(
        inner: W,
        software: &str,
        metadata: &BTreeMap<String, String>,
        n_attachments: usize,
    ) -> Result<Self, Error> {
        let options = WriteOptions::new()
            .compression(Some(Compression::Zstd))
            // Level 1 takes half the time of the default level 3, for files larger by a
            // twentieth: coordinates hardly compress.
            .compression_level(1)
            // Chunks end with a frame, not at a size; no threads; no seeking back.
            .chunk_size(None)
            .compression_threads(0)
            .disable_seeking(true)
            .library(concat!("io-mcap ", env!("CARGO_PKG_VERSION")));
        let mut writer = options.create(NoSeek::new(BufWriter::new(inner)))?;
        writer.write_metadata(&header::recording_metadata(software, n_attachments))?;
        writer.write_metadata(&header::sealed(header::RUN, metadata.clone()))?;
        // The channels get a chunk of their own: with it every later chunk can be read, even
        // if all others are damaged.
        for topic in Topic::ALL {
            let (id, schema_id) = (topic.id(), topic.schema_id());
            let (message_encoding, encoding) = topic.encodings();
            if schema_id == id {
                writer.add_schema_with_id(id, topic.schema_name(), encoding, &topic.schema())?;
            }
            let (name, none) = (topic.name(), BTreeMap::new());
            writer.add_channel_with_id(id, schema_id, name, message_encoding, &none)?;
        }
        writer.flush()?;
        Ok(Self { writer })
    }

    pub(crate) fn attach(
        &mut self,
        name: &str,
        media_type: &str,
        data: &[u8],
    ) -> Result<(), Error> {
        Ok(self.writer.attach(&mcap::Attachment {
            log_time: 0,
            create_time: 0,
            name: name.into(),
            media_type: media_type.into(),
            data: data.into(),
        })?)
    }

    pub(crate) fn message(&mut self, topic: Topic, stamp: Stamp, data: &[u8]) -> Result<(), Error> {
        let Stamp { sequence, log_time } = stamp;
        let header =
            MessageHeader { channel_id: topic.id(), sequence, log_time, publish_time: log_time };
        Ok(self.writer.write_to_known_channel(&header, data)?)
    }

    /// Ends the chunk and hands everything to the operating system.
    pub(crate) fn flush(&mut self) -> Result<(), Error> {
        Ok(self.writer.flush()?)
    }

    /// Writes the end record, the summary and the closing magic.
    pub(crate) fn finish(mut self, n_frames: u64) -> Result<W, Error> {
        self.writer.write_metadata(&header::end_metadata(n_frames))?;
        self.writer.finish()?;
        let buffered = self.writer.into_inner().into_inner();
        buffered.into_inner().map_err(|e| Error::io("write the recording")(e.into_error()))
    }

    /// Lets go of the stream without writing anything more.
    pub(crate) fn abandon(self) {
        // Taken apart, the buffer is dropped unwritten; dropped whole, the writer would try to
        // close the file and the buffer to write what an error left in it.
        let _ = self.writer.into_inner().into_inner().into_parts();
    }
}
