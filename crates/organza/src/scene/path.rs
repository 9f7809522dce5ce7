//! The place of a value inside a scene file, written `cloths[0].fabric.custom.density_kg_per_m2`.

use std::fmt;

/// One step from a value to a part of it.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Segment {
    /// The value of an object's key.
    Key(String),
    /// The element of a list, counted from 0.
    Index(usize),
}

/// The steps from the top of a file to one of its values. The empty path is the whole file.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct ValuePath(pub Vec<Segment>);

/// Why a text is not a path; prints as a sentence.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{text}` is not a path such as `cloths[0].remeshing.size_m.min`: {why}")]
pub struct PathError {
    text: String,
    why: &'static str,
}

impl ValuePath {
    /// Reads a path as it is written after `--set`.
    ///
    /// # Errors
    /// When a key is empty, a bracket is not closed, or an index is not a whole number.
    pub fn parse(text: &str) -> Result<Self, PathError> {
        let fail = |why| PathError { text: text.to_owned(), why };
        let mut segments = Vec::new();
        for part in text.split('.') {
            let (key, mut rest) = part.split_at(part.find('[').unwrap_or(part.len()));
            if key.is_empty() {
                return Err(fail("a key is empty"));
            }
            segments.push(Segment::Key(key.trim().to_owned()));
            while !rest.is_empty() {
                let inner = rest.strip_prefix('[').ok_or_else(|| fail("text after a `]`"))?;
                let end = inner.find(']').ok_or_else(|| fail("a `[` is not closed"))?;
                let index = inner[..end].trim().parse();
                segments.push(Segment::Index(
                    index.map_err(|_| fail("an index is not a whole number"))?,
                ));
                rest = &inner[end + 1..];
            }
        }
        Ok(Self(segments))
    }

    /// This path with one more key.
    #[must_use]
    pub fn key(&self, key: &str) -> Self {
        self.with(Segment::Key(key.to_owned()))
    }

    /// This path with one more index.
    #[must_use]
    pub fn index(&self, index: usize) -> Self {
        self.with(Segment::Index(index))
    }

    fn with(&self, segment: Segment) -> Self {
        let mut segments = self.0.clone();
        segments.push(segment);
        Self(segments)
    }

    /// True where `self` is `start` or a part of it.
    #[must_use]
    pub fn starts_with(&self, start: &Self) -> bool {
        self.0.starts_with(&start.0)
    }

    /// This path without its last step; the whole file encloses itself.
    #[must_use]
    pub fn parent(&self) -> Self {
        Self(self.0.split_last().map_or(Vec::new(), |(_, parents)| parents.to_vec()))
    }

    /// The last step, absent for the whole file.
    #[must_use]
    pub fn last(&self) -> Option<&Segment> {
        self.0.last()
    }
}

impl From<&serde_path_to_error::Path> for ValuePath {
    fn from(path: &serde_path_to_error::Path) -> Self {
        use serde_path_to_error::Segment as From;
        let segments = path.iter().filter_map(|segment| match segment {
            From::Seq { index } => Some(Segment::Index(*index)),
            From::Map { key } => Some(Segment::Key(key.clone())),
            From::Enum { variant } => Some(Segment::Key(variant.clone())),
            From::Unknown => None,
        });
        Self(segments.collect())
    }
}

impl fmt::Display for ValuePath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, segment) in self.0.iter().enumerate() {
            match segment {
                Segment::Key(key) if i == 0 => write!(f, "{key}")?,
                Segment::Key(key) => write!(f, ".{key}")?,
                Segment::Index(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}
