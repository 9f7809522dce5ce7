//! Metadata and attachments met on the walk.

use std::io::{Read, Seek};

use crate::header::{self, END, FORMAT, RECORDING, RUN};
use crate::records::{self, AttachmentHeader};
use crate::{AttachmentInfo, Error};

use super::{AttachmentEntry, Record, Walk};

impl<R: Read + Seek> Walk<'_, R> {
    /// # Errors
    /// The metadata that opens the recording cannot be read or names another format.
    pub(super) fn metadata(&mut self, record: Record) -> Result<(), Error> {
        if record.size > header::METADATA_LIMIT {
            self.scan.note(record.offset, format!("metadata of {} bytes", record.size));
            return Ok(());
        }
        let bytes = self.source.bytes_at(record.content(), record.size)?;
        let Some((name, entries)) = records::metadata(&bytes) else {
            self.scan.note(record.offset, "metadata that cannot be read");
            return Ok(());
        };
        if ![RECORDING, RUN, END].contains(&&*name) {
            return Ok(());
        }
        // The format first: another one may seal its metadata in another way.
        if name == RECORDING && !self.scan.is_recording {
            let format = entries.get("format").map_or("", |f| f);
            if format != FORMAT {
                return Err(Error::Format { found: format.into(), supported: FORMAT });
            }
        }
        let mut entries = match header::unsealed(&name, entries) {
            Ok(entries) => entries,
            Err(what) if name == RECORDING => return Err(Error::damaged(record.offset, what)),
            Err(what) => {
                self.scan.note(record.offset, what);
                return Ok(());
            }
        };
        match &*name {
            RECORDING => {
                self.scan.is_recording = true;
                self.scan.software = entries.remove("software").unwrap_or_default();
                let announced = entries.get("attachments").and_then(|n| n.parse().ok());
                self.scan.n_attachments = announced.unwrap_or_default();
            }
            RUN => self.scan.metadata = Some(entries),
            _ => self.scan.frames_at_end = entries.get("frames").and_then(|n| n.parse().ok()),
        }
        Ok(())
    }

    pub(super) fn attachment(&mut self, record: Record) -> Result<(), Error> {
        const CRC_BYTES: u64 = 4;
        let n = record.size.min(header::ATTACHMENT_HEADER_LIMIT);
        let bytes = self.source.bytes_at(record.content(), n)?;
        let parsed = AttachmentHeader::parse(&bytes)
            .filter(|h| record.size.checked_sub(h.length + CRC_BYTES) == Some(h.data_size));
        let Some(AttachmentHeader { name, media_type, data_size, length }) = parsed else {
            self.scan.note(record.offset, "an attachment that cannot be read");
            return Ok(());
        };
        let entry = AttachmentEntry {
            info: AttachmentInfo { name, media_type, bytes: data_size },
            start: record.content(),
            data: record.content() + length,
        };
        // The only parts in which names are listed before anything is read: always checked.
        if let Err(what) = entry.check(self.source)? {
            self.scan.note(record.offset, what);
            return Ok(());
        }
        self.scan.attachments.push(entry);
        Ok(())
    }
}
