//! Records of MCAP, read without trust.
//!
//! The library's own parser reserves memory for whatever length a text claims, and indexes
//! past the end of a short attachment; this one gives `None` when bytes are missing. Layouts:
//! <https://mcap.dev/spec>.

use std::collections::BTreeMap;

pub(crate) use mcap::records::op;

/// Bytes of a record before its content: an opcode and a length.
pub(crate) const HEAD: u64 = 9;

/// Opcode and length of the content.
pub(crate) fn head(bytes: &[u8; HEAD as usize]) -> (u8, u64) {
    let [opcode, length @ ..] = *bytes;
    (opcode, u64::from_le_bytes(length))
}

/// Name of a record type, for messages.
pub(crate) fn name(opcode: u8) -> &'static str {
    match opcode {
        op::HEADER => "header",
        op::FOOTER => "footer",
        op::SCHEMA => "schema",
        op::CHANNEL => "channel",
        op::MESSAGE => "message",
        op::CHUNK => "chunk",
        op::MESSAGE_INDEX => "message index",
        op::CHUNK_INDEX => "chunk index",
        op::ATTACHMENT => "attachment",
        op::ATTACHMENT_INDEX => "attachment index",
        op::STATISTICS => "statistics",
        op::METADATA => "metadata",
        op::METADATA_INDEX => "metadata index",
        op::SUMMARY_OFFSET => "summary offset",
        op::DATA_END => "end of data",
        0x80.. => "private",
        _ => "unknown",
    }
}

/// Reads little-endian fields off the front of some bytes.
pub(crate) struct Cursor<'a>(pub(crate) &'a [u8]);

impl<'a> Cursor<'a> {
    pub(crate) fn take(&mut self, n: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.0.split_at_checked(n)?;
        self.0 = rest;
        Some(taken)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.take(N)?.try_into().ok()
    }

    pub(crate) fn u16(&mut self) -> Option<u16> {
        self.array().map(u16::from_le_bytes)
    }

    pub(crate) fn u32(&mut self) -> Option<u32> {
        self.array().map(u32::from_le_bytes)
    }

    pub(crate) fn u64(&mut self) -> Option<u64> {
        self.array().map(u64::from_le_bytes)
    }

    pub(crate) fn text(&mut self) -> Option<&'a str> {
        let length = self.u32()? as usize;
        str::from_utf8(self.take(length)?).ok()
    }
}

/// What a chunk says of itself, before its compressed records.
#[derive(Clone, Debug)]
pub(crate) struct ChunkHeader {
    pub(crate) uncompressed_size: u64,
    pub(crate) crc: u32,
    pub(crate) compression: String,
    pub(crate) compressed_size: u64,
    /// Bytes of this header.
    pub(crate) length: u64,
}

impl ChunkHeader {
    /// Bytes that hold any header of a chunk we can read.
    pub(crate) const ENOUGH: usize = 64;

    /// Bytes of the chunk with this header; absurd ones are as many as can be.
    pub(crate) fn chunk_bytes(&self) -> u64 {
        self.length.saturating_add(self.compressed_size)
    }

    /// `bytes` are the first of the chunk, [`Self::ENOUGH`] unless it is shorter.
    pub(crate) fn parse(bytes: &[u8]) -> Option<Self> {
        let mut cursor = Cursor(bytes);
        let (_start, _end) = (cursor.u64()?, cursor.u64()?);
        let (uncompressed_size, crc) = (cursor.u64()?, cursor.u32()?);
        let compression = cursor.text()?.to_owned();
        let compressed_size = cursor.u64()?;
        let length = (bytes.len() - cursor.0.len()) as u64;
        Some(Self { uncompressed_size, crc, compression, compressed_size, length })
    }
}

/// A message inside a chunk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Message<'a> {
    pub(crate) channel: u16,
    pub(crate) sequence: u32,
    pub(crate) data: &'a [u8],
}

impl<'a> Message<'a> {
    pub(crate) fn parse(body: &'a [u8]) -> Option<Self> {
        let mut cursor = Cursor(body);
        let (channel, sequence) = (cursor.u16()?, cursor.u32()?);
        let (_log_time, _publish_time) = (cursor.u64()?, cursor.u64()?);
        Some(Self { channel, sequence, data: cursor.0 })
    }
}

/// Id and topic of a channel record.
pub(crate) fn channel(body: &[u8]) -> Option<(u16, &str)> {
    let mut cursor = Cursor(body);
    let (id, _schema) = (cursor.u16()?, cursor.u16()?);
    Some((id, cursor.text()?))
}

/// Channel of a message index record and the log time (ns) of its first entry, if it has any.
pub(crate) fn message_index(body: &[u8]) -> Option<(u16, Option<u64>)> {
    let mut cursor = Cursor(body);
    let (channel, _bytes) = (cursor.u16()?, cursor.u32()?);
    Some((channel, cursor.u64()))
}

/// Name and entries of a metadata record.
pub(crate) fn metadata(body: &[u8]) -> Option<(String, BTreeMap<String, String>)> {
    let mut cursor = Cursor(body);
    let name = cursor.text()?.to_owned();
    let length = cursor.u32()? as usize;
    let mut cursor = Cursor(cursor.take(length)?);
    let mut entries = BTreeMap::new();
    while !cursor.0.is_empty() {
        entries.insert(cursor.text()?.to_owned(), cursor.text()?.to_owned());
    }
    Some((name, entries))
}

/// What an attachment says of itself, before its content.
#[derive(Clone, Debug)]
pub(crate) struct AttachmentHeader {
    pub(crate) name: String,
    pub(crate) media_type: String,
    pub(crate) data_size: u64,
    /// Bytes of this header.
    pub(crate) length: u64,
}

impl AttachmentHeader {
    /// `bytes` are the first of the attachment, enough to hold the header.
    pub(crate) fn parse(bytes: &[u8]) -> Option<Self> {
        let mut cursor = Cursor(bytes);
        let (_log_time, _create_time) = (cursor.u64()?, cursor.u64()?);
        let name = cursor.text()?.to_owned();
        let media_type = cursor.text()?.to_owned();
        let data_size = cursor.u64()?;
        let length = (bytes.len() - cursor.0.len()) as u64;
        Some(Self { name, media_type, data_size, length })
    }
}

/// The records inside the uncompressed content of a chunk, or `None` once where one is cut.
pub(crate) fn in_chunk(content: &[u8]) -> impl Iterator<Item = Option<(u8, &[u8])>> {
    let mut rest = content;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let mut cursor = Cursor(rest);
        let record = (|| {
            let opcode = cursor.take(1)?[0];
            let length = usize::try_from(cursor.u64()?).ok()?;
            Some((opcode, cursor.take(length)?))
        })();
        rest = if record.is_some() { cursor.0 } else { &[] };
        Some(record)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cut_records_give_none() {
        let mut chunk = Vec::new();
        for (opcode, body) in [(op::CHANNEL, &b"abc"[..]), (op::MESSAGE, &[7; 22])] {
            chunk.push(opcode);
            chunk.extend((body.len() as u64).to_le_bytes());
            chunk.extend(body);
        }
        let whole: Vec<_> = in_chunk(&chunk).collect();
        assert_eq!(whole, [Some((op::CHANNEL, &b"abc"[..])), Some((op::MESSAGE, &[7; 22]))]);
        for cut in 1..chunk.len() {
            let n = in_chunk(&chunk[..cut]).map_while(|r| r).count();
            assert_eq!(n, usize::from(cut >= 12), "cut at {cut}");
        }
        assert!(Message::parse(&[0; 21]).is_none());
        // A text that claims 4 GiB.
        assert!(metadata(&[0xff; 40]).is_none());
        assert!(ChunkHeader::parse(&[0xff; ChunkHeader::ENOUGH]).is_none());
    }
}
