//! How large things may get.

/// Limits that keep a small hostile file from filling the memory, and a recorder from writing
/// what no reader with the same limits would read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Largest chunk, which is one frame or one checkpoint, before and after decompression
    /// (bytes).
    pub chunk_bytes: u64,
    /// Largest attachment (bytes).
    pub attachment_bytes: u64,
}

impl Default for Limits {
    /// 1 GiB each: a frame of about 20 million triangles.
    fn default() -> Self {
        Self { chunk_bytes: 1 << 30, attachment_bytes: 1 << 30 }
    }
}
