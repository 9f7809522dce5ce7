//! What a recording says about itself: metadata and attachments, written before any frame.
//!
//! MCAP protects attachments by a CRC of their own, but not metadata. Ours carries its CRC as
//! one more entry, `crc32`.

use std::collections::{BTreeMap, BTreeSet};

use mcap::records::Metadata;

use crate::Error;

/// The format this version writes, and the only one it reads.
pub(crate) const FORMAT: &str = "1";
/// Metadata record that makes an MCAP a recording of ours.
pub(crate) const RECORDING: &str = "organza.recording";
/// Metadata record with the caller's entries.
pub(crate) const RUN: &str = "organza.run";
/// Metadata record that tells that the run went to its end.
pub(crate) const END: &str = "organza.end";

/// Largest metadata record (bytes).
pub(crate) const METADATA_LIMIT: u64 = 16 << 20;
/// Largest header of an attachment: its name, media type and 40 bytes.
pub(crate) const ATTACHMENT_HEADER_LIMIT: u64 = 8 << 10;

const CRC: &str = "crc32";

/// What to write ahead of the first frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Header {
    /// The program that records, with its version.
    pub software: String,
    /// Anything else worth keeping, by name. The name `crc32` is taken.
    pub metadata: BTreeMap<String, String>,
    /// Files to keep with the recording: the scene, meshes, materials. Names are unique.
    pub attachments: Vec<Attachment>,
}

/// A file inside the recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Attachment {
    /// Name, unique and not empty.
    pub name: String,
    /// Media type, for example `application/json`.
    pub media_type: String,
    /// Content.
    pub data: Vec<u8>,
}

/// An attachment as listed by [`crate::Recording::attachments`].
#[derive(Clone, Debug, PartialEq)]
pub struct AttachmentInfo {
    /// See [`Attachment::name`].
    pub name: String,
    /// See [`Attachment::media_type`].
    pub media_type: String,
    /// Size (bytes).
    pub bytes: u64,
}

/// Whether a file that exists may be replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overwrite {
    /// Refuse.
    No,
    /// Replace it when the first frame is recorded.
    Yes,
}

/// Says why `header` cannot be recorded, if so.
pub(crate) fn check(header: &Header, attachment_limit: u64) -> Result<(), Error> {
    if header.metadata.contains_key(CRC) {
        return Err(Error::unrecordable("metadata named \"crc32\": the name is taken"));
    }
    let texts = header.metadata.iter().map(|(key, value)| key.len() + value.len() + 8);
    let bytes = texts.sum::<usize>().max(header.software.len()) as u64 + 1024;
    if bytes > METADATA_LIMIT {
        let what = format!("metadata of {bytes} bytes: the limit is {METADATA_LIMIT}");
        return Err(Error::unrecordable(what));
    }
    let mut names = BTreeSet::new();
    for attachment in &header.attachments {
        let Attachment { name, media_type, data } = attachment;
        if (name.len() + media_type.len()) as u64 + 40 > ATTACHMENT_HEADER_LIMIT {
            return Err(Error::unrecordable("an attachment whose name fills kilobytes"));
        }
        if name.is_empty() {
            return Err(Error::unrecordable("an attachment without a name"));
        }
        if !names.insert(name) {
            return Err(Error::unrecordable(format!("two attachments named {name:?}")));
        }
        if data.len() as u64 > attachment_limit {
            return Err(Error::unrecordable(format!(
                "attachment {name:?} of {} bytes: the limit is {attachment_limit}",
                data.len()
            )));
        }
    }
    Ok(())
}

/// A metadata record with its CRC among the entries.
pub(crate) fn sealed(name: &str, mut entries: BTreeMap<String, String>) -> Metadata {
    let crc = crc_of(name, &entries);
    entries.insert(CRC.into(), format!("{crc:08x}"));
    Metadata { name: name.into(), metadata: entries }
}

/// The entries of a metadata record without the CRC, or what is wrong with it.
pub(crate) fn unsealed(
    name: &str,
    mut entries: BTreeMap<String, String>,
) -> Result<BTreeMap<String, String>, String> {
    let stored =
        entries.remove(CRC).ok_or_else(|| format!("metadata {name:?} has lost its CRC"))?;
    let computed = format!("{:08x}", crc_of(name, &entries));
    if stored != computed {
        return Err(format!("metadata {name:?} has CRC {computed}, but {stored:?} was written"));
    }
    Ok(entries)
}

fn crc_of(name: &str, entries: &BTreeMap<String, String>) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    // Lengths first, so that no text can move between name, keys and values unseen.
    for text in [name].into_iter().chain(entries.iter().flat_map(|(k, v)| [&**k, &**v])) {
        hasher.update(&(text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    }
    hasher.finalize()
}

/// The record that opens a recording.
pub(crate) fn recording_metadata(software: &str, n_attachments: usize) -> Metadata {
    sealed(
        RECORDING,
        BTreeMap::from([
            ("format".into(), FORMAT.into()),
            ("software".into(), software.to_owned()),
            ("attachments".into(), n_attachments.to_string()),
        ]),
    )
}

/// The record that closes a recording of `n_frames` frames.
pub(crate) fn end_metadata(n_frames: u64) -> Metadata {
    sealed(END, BTreeMap::from([("frames".into(), n_frames.to_string())]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changed_metadata_is_seen() {
        let entries = BTreeMap::from([("a".to_owned(), "bc".to_owned())]);
        let record = sealed(RUN, entries.clone());
        assert_eq!(unsealed(RUN, record.metadata.clone()), Ok(entries));
        assert!(unsealed(END, record.metadata.clone()).is_err());
        let mut moved = record.metadata.clone();
        moved.remove("a");
        moved.insert("ab".into(), "c".into());
        assert!(unsealed(RUN, moved).is_err());
    }

    #[test]
    fn header_names_are_checked() {
        let attachment =
            |name: &str| Attachment { name: name.into(), media_type: String::new(), data: vec![1] };
        let header = |names: &[&str]| Header {
            attachments: names.iter().map(|n| attachment(n)).collect(),
            ..Header::default()
        };
        assert!(check(&header(&["a", "b"]), 1).is_ok());
        assert!(check(&header(&["a", "a"]), 1).is_err());
        assert!(check(&header(&[""]), 1).is_err());
        assert!(check(&header(&["a"]), 0).is_err());
    }
}
