//! One chunk of a recording: where it lies, what it holds, its content checked by its CRC.

use std::io::{Read, Seek};

use crate::records::ChunkHeader;
use crate::source::Source;
use crate::topic::TopicSet;
use crate::{Error, Limits};

/// A chunk found in the file.
#[derive(Clone, Debug)]
pub(crate) struct Chunk {
    /// Offset of its record in the file.
    pub(crate) offset: u64,
    /// Offset of its compressed records.
    pub(crate) data: u64,
    pub(crate) header: ChunkHeader,
    /// Topics of its messages: known once it was read, before that as its message indexes,
    /// which carry no CRC, have it. `None` where these are missing.
    pub(crate) topics: Option<TopicSet>,
}

impl Chunk {
    /// The uncompressed records.
    ///
    /// # Errors
    /// The chunk is above the limit, does not decompress to the size it claims, or has another
    /// CRC than it was written with.
    pub(crate) fn content<R: Read + Seek>(
        &self,
        source: &mut Source<R>,
        limits: &Limits,
    ) -> Result<Vec<u8>, Error> {
        let ChunkHeader { uncompressed_size, compressed_size, crc, ref compression, .. } =
            self.header;
        let size = uncompressed_size.max(compressed_size);
        if size > limits.chunk_bytes {
            return Err(Error::TooLarge {
                what: "chunk",
                offset: self.offset,
                bytes: size,
                limit: limits.chunk_bytes,
            });
        }
        let compressed = source.bytes_at(self.data, compressed_size)?;
        let content = match &**compression {
            "" => compressed,
            "zstd" => inflate(&compressed, uncompressed_size)
                .map_err(|e| Error::damaged(self.offset, format!("chunk: {e}")))?,
            other => {
                let what = format!("chunk compressed by {other:?}, which is not supported");
                return Err(Error::damaged(self.offset, what));
            }
        };
        let computed = crc32fast::hash(&content);
        if content.len() as u64 != uncompressed_size || computed != crc {
            return Err(Error::damaged(
                self.offset,
                format!(
                    "chunk of {} bytes with CRC {computed:08x}, but {uncompressed_size} bytes \
                     with CRC {crc:08x} were written",
                    content.len()
                ),
            ));
        }
        Ok(content)
    }
}

/// At most one byte more than `size`: memory grows with what really comes out.
fn inflate(compressed: &[u8], size: u64) -> std::io::Result<Vec<u8>> {
    let mut content = Vec::new();
    zstd::stream::read::Decoder::with_buffer(compressed)?
        .take(size + 1)
        .read_to_end(&mut content)?;
    Ok(content)
}
