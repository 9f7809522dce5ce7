//! Where and from what figures come: machine, commit, options.

use super::machine::Machine;
use serde_json::{Value, json};
use std::hash::{DefaultHasher, Hasher};
use std::path::Path;
use std::process::Command;

/// All that figures depend on.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Provenance {
    pub(super) machine: Machine,
    /// The commit of the workspace, with `-dirty` behind it where files have changed since. `None`
    /// where there is no git.
    pub(super) commit: Option<String>,
    /// A digest of what has changed since the commit.
    changes: Option<String>,
    /// The options that the figures depend on.
    options: Value,
}

impl Provenance {
    /// This machine and the workspace at `root`.
    pub(super) fn here(root: &Path, options: Value) -> Provenance {
        let git = |arguments: &[&str]| {
            let output = Command::new("git").args(arguments).current_dir(root).output().ok()?;
            output.status.success().then_some(output.stdout)
        };
        let described = git(&["describe", "--always", "--dirty", "--abbrev=40", "--exclude=*"]);
        let commit = described.and_then(|text| String::from_utf8(text).ok());
        let commit = commit.map(|c| c.trim().to_owned()).filter(|c| !c.is_empty());
        let new_files = git(&["ls-files", "--others", "--exclude-standard", "-z"]);
        let changes = git(&["diff", "--binary", "HEAD"]).zip(new_files);
        let changes = changes.map(|(diff, new_files)| digest(root, &diff, &new_files));
        Provenance { machine: Machine::here(), commit, changes, options }
    }

    /// True if figures of one may stand beside those of the other as if measured together.
    pub(super) fn is_same(&self, other: &Provenance) -> bool {
        self.commit.is_some()
            && self.commit == other.commit
            && self.changes == other.changes
            && self.options == other.options
            && self.machine.is_same(&other.machine)
    }

    /// True if times measured under both can be compared.
    pub(super) fn is_comparable(&self, other: &Provenance) -> bool {
        self.options == other.options && self.machine.is_same(&other.machine)
    }

    pub(super) fn json(&self) -> Value {
        let Provenance { machine, commit, changes, options } = self;
        json!({
            "machine": machine.json(), "commit": commit, "changes": changes, "options": options,
        })
    }

    /// Reads what [`Provenance::json`] made, among other keys.
    pub(super) fn read(json: &Value) -> Option<Provenance> {
        let text = |key: &str| json.get(key).map(|v| v.as_str().map(str::to_owned));
        Some(Provenance {
            machine: Machine::read(json.get("machine")?),
            commit: text("commit")?,
            changes: text("changes")?,
            options: json.get("options")?.clone(),
        })
    }
}

/// A digest of changes and of files that git does not know, whose names end with zero bytes.
fn digest(root: &Path, diff: &[u8], new_files: &[u8]) -> String {
    let mut hasher = DefaultHasher::new();
    hasher.write(diff);
    for name in new_files.split(|&byte| byte == 0).filter(|name| !name.is_empty()) {
        hasher.write(name);
        // A file that cannot be read has no content to depend on.
        hasher
            .write(&std::fs::read(root.join(&*String::from_utf8_lossy(name))).unwrap_or_default());
    }
    format!("{:016x}", hasher.finish())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn provenance() -> Provenance {
        let options = json!({ "quick": true });
        let (commit, changes) = (Some("abc".to_owned()), Some("01".to_owned()));
        Provenance { commit, changes, options, ..Provenance::default() }
    }

    #[test]
    fn json_reads_back() {
        assert_eq!(Provenance::read(&provenance().json()), Some(provenance()));
        assert_eq!(Provenance::read(&json!({})), None);
    }

    #[test]
    fn every_difference_counts() {
        let ours = provenance();
        assert!(ours.is_same(&provenance()));
        let others = [
            Provenance { commit: Some("abd".into()), ..provenance() },
            Provenance { changes: None, ..provenance() },
            Provenance { options: json!({ "quick": false }), ..provenance() },
        ];
        assert!(others.iter().all(|other| !ours.is_same(other)));
        let unknown = Provenance { commit: None, ..provenance() };
        assert!(!unknown.is_same(&unknown));
    }

    #[test]
    fn the_digest_depends_on_changes_and_new_files() {
        let here = Path::new(".");
        let one = digest(here, b"a", b"");
        assert_eq!(one, digest(here, b"a", b"\0"));
        assert_ne!(one, digest(here, b"b", b""));
        assert_ne!(one, digest(here, b"a", b"new\0"));
    }
}
