//! Reading at places in a file, with a few kilobytes in memory.

use std::io::{BufReader, Read, Seek, SeekFrom};

use crate::Error;

/// A seekable reader that knows where it is and how much there is.
pub(crate) struct Source<R> {
    reader: BufReader<R>,
    position: u64,
    len: u64,
}

impl<R: Read + Seek> Source<R> {
    pub(crate) fn new(mut reader: R) -> Result<Self, Error> {
        let len = reader.seek(SeekFrom::End(0)).map_err(Error::io("find the size"))?;
        reader.seek(SeekFrom::Start(0)).map_err(Error::io("read"))?;
        Ok(Self { reader: BufReader::new(reader), position: 0, len })
    }

    /// Size of the file when it was opened (bytes).
    pub(crate) fn len(&self) -> u64 {
        self.len
    }

    /// Fills `bytes` from `offset` on.
    pub(crate) fn read_at(&mut self, offset: u64, bytes: &mut [u8]) -> Result<(), Error> {
        self.seek(offset)?;
        if let Err(error) = self.reader.read_exact(bytes) {
            // Where a failed read leaves the reader is not told: back to a known place.
            self.reader.seek(SeekFrom::Start(0)).map_err(Error::io("read"))?;
            self.position = 0;
            return Err(Error::io("read")(error));
        }
        self.position += bytes.len() as u64;
        Ok(())
    }

    /// `n` bytes from `offset` on; the caller has checked that the file has them and that they
    /// are not too many.
    pub(crate) fn bytes_at(&mut self, offset: u64, n: u64) -> Result<Vec<u8>, Error> {
        let mut bytes = vec![0; n as usize];
        self.read_at(offset, &mut bytes)?;
        Ok(bytes)
    }

    /// CRC-32 of `n` bytes from `offset` on.
    pub(crate) fn crc_at(&mut self, offset: u64, n: u64) -> Result<u32, Error> {
        let mut hasher = crc32fast::Hasher::new();
        let mut buffer = [0; 1 << 16];
        let mut done = 0;
        while done < n {
            let part = buffer.len().min((n - done) as usize);
            self.read_at(offset + done, &mut buffer[..part])?;
            hasher.update(&buffer[..part]);
            done += part as u64;
        }
        Ok(hasher.finalize())
    }

    fn seek(&mut self, offset: u64) -> Result<(), Error> {
        // Relative, so that the buffer survives the short hops from record to record.
        let step = offset.wrapping_sub(self.position) as i64;
        if step != 0 {
            self.reader.seek_relative(step).map_err(Error::io("find a place"))?;
            self.position = offset;
        }
        Ok(())
    }
}
