//! Turns a complaint about a path into an issue with file, line and column, or with the `--set`
//! argument that wrote the value.

use super::issue::{Issue, IssueKind, Origin};
use super::limits;
use super::locate::{Part, locate};
use super::overrides::Override;
use super::path::ValuePath;
use super::typed::Complaint;

/// What is needed to find the place of any value of a loaded scene.
#[derive(Debug, Clone)]
pub struct Places {
    name: String,
    text: String,
    overrides: Vec<Override>,
    /// Pairs of our path and the path in the file, for files in a foreign format.
    renames: Vec<(ValuePath, ValuePath)>,
}

impl Places {
    pub(crate) fn new(name: &str, text: &str) -> Self {
        Self {
            name: name.to_owned(),
            text: text.to_owned(),
            overrides: Vec::new(),
            renames: Vec::new(),
        }
    }

    pub(crate) fn set_overrides(&mut self, overrides: Vec<Override>) {
        self.overrides = overrides;
    }

    /// From now on, paths are ours and are translated before they are looked up.
    pub(crate) fn set_renames(&mut self, renames: Vec<(ValuePath, ValuePath)>) {
        self.renames = renames;
    }

    /// An issue about the value at `path` (as in `cloths[0].mesh`), for checks that need more than
    /// the scene file, such as "vertex 9 of a mesh of 8".
    #[must_use]
    pub fn issue(&self, kind: IssueKind, path: &str, message: impl Into<String>) -> Issue {
        let path = ValuePath::parse(path).unwrap_or_default();
        self.resolve(Complaint { kind, path, part: Part::Value, message: message.into() })
    }

    /// The issues of complaints, as many as are shown: looking up each place reads the text.
    pub(crate) fn resolve_some(&self, complaints: impl Iterator<Item = Complaint>) -> Vec<Issue> {
        let mut complaints = complaints;
        let shown = complaints.by_ref().take(limits::MAX_ISSUES);
        let mut issues: Vec<Issue> = shown.map(|complaint| self.resolve(complaint)).collect();
        let more = complaints.count();
        if more > 0 {
            let origin = Origin::File { name: self.name.clone(), position: None };
            let message = format!("and {more} more complaints");
            issues.push(Issue { kind: IssueKind::Value, origin, path: String::new(), message });
        }
        issues
    }

    pub(crate) fn resolve(&self, complaint: Complaint) -> Issue {
        let path = self.renamed(complaint.path);
        // The last argument that touches the value wrote it.
        let set = self.overrides.iter().rev().find(|set| path.starts_with(&set.path));
        let origin = match set {
            Some(set) => Origin::Set { argument: set.argument.clone() },
            None => Origin::File {
                name: self.name.clone(),
                position: Some(locate(&self.text, &path, complaint.part)),
            },
        };
        let (path, message) = (clipped(path.to_string()), clipped(complaint.message));
        Issue { kind: complaint.kind, origin, path, message }
    }

    fn renamed(&self, path: ValuePath) -> ValuePath {
        let longest = self
            .renames
            .iter()
            .filter(|(ours, _)| path.starts_with(ours))
            .max_by_key(|(ours, _)| ours.0.len());
        match longest {
            Some((ours, theirs)) => {
                let tail = path.0[ours.0.len()..].iter().cloned();
                ValuePath(theirs.0.iter().cloned().chain(tail).collect())
            }
            None => path,
        }
    }
}

/// Keys and texts of a scene can be of any length.
fn clipped(text: String) -> String {
    match text.char_indices().nth(limits::MAX_SHOWN_CHARS) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}
