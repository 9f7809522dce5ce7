//! The files of the workspace, read once; or made up by a test.

use super::Violation;
use super::rust_source::RustSource;
use std::collections::BTreeSet;
use std::fs;
use std::io::Error;
use std::path::Path;

/// Folders at the root that hold what the programs make, not what the project is.
pub(crate) const OUTPUT_FOLDERS: [&str; 2] = ["out", "target"];
/// Ends of file names that programs make anywhere.
const OUTPUT_ENDS: [&str; 2] = [".mcap", ".partial"];
/// Larger files are data: their names count, their content does not.
const LARGEST_TEXT: u64 = 4 << 20;

/// A text file.
pub(crate) struct TextFile {
    /// Relative to the root, with `/` between its parts.
    pub(crate) path: String,
    pub(crate) text: String,
    /// For `.rs` files.
    pub(crate) rust: Option<RustSource>,
}

/// All files of the workspace except outputs.
pub(crate) struct Tree {
    files: Vec<TextFile>,
    /// Every file and folder, text or not.
    names: BTreeSet<String>,
}

impl Tree {
    /// Reads the files below `root`. What cannot be read is reported.
    pub(crate) fn read(root: &Path) -> (Tree, Vec<Violation>) {
        let mut tree = Tree { files: Vec::new(), names: BTreeSet::new() };
        let mut unread = Vec::new();
        tree.walk(root, "", &mut unread);
        tree.files.sort_by(|a, b| a.path.cmp(&b.path));
        (tree, unread)
    }

    /// A tree of these paths and texts, for tests of rules.
    #[cfg(test)]
    pub(crate) fn of(files: &[(&str, &str)]) -> Tree {
        let mut tree = Tree { files: Vec::new(), names: BTreeSet::new() };
        for (path, text) in files {
            let folders = path.match_indices('/').map(|(at, _)| path[..at].to_owned());
            tree.names.extend(folders);
            tree.add(path, (*text).to_owned());
        }
        tree
    }

    fn add(&mut self, path: &str, text: String) {
        let rust = path.ends_with(".rs").then(|| RustSource::new(&text));
        self.names.insert(path.to_owned());
        self.files.push(TextFile { path: path.to_owned(), text, rust });
    }

    /// Adds everything below a folder; `prefix` is its path from the root.
    fn walk(&mut self, folder: &Path, prefix: &str, unread: &mut Vec<Violation>) {
        let unreadable =
            |path: &str, error: Error| Violation::new(path, 0, format!("cannot read: {error}"));
        let entries = fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, Error>>);
        let entries = match entries {
            Ok(entries) => entries,
            Err(error) => {
                let folder = if prefix.is_empty() { "." } else { prefix };
                return unread.push(unreadable(folder, error));
            }
        };
        for entry in entries {
            let name = entry.file_name().to_string_lossy().into_owned();
            let path = if prefix.is_empty() { name.clone() } else { format!("{prefix}/{name}") };
            if is_output(prefix, &name) {
                continue;
            }
            // Of the entry itself: a link is not followed, so the walk ends.
            match entry.metadata() {
                Ok(data) if data.is_dir() => self.walk(&entry.path(), &path, unread),
                Ok(data) if data.is_file() && data.len() <= LARGEST_TEXT => {
                    match fs::read(entry.path()).map(String::from_utf8) {
                        Ok(Ok(text)) if !text.contains('\0') => self.add(&path, text),
                        Ok(_) => {}
                        Err(error) => unread.push(unreadable(&path, error)),
                    }
                }
                Ok(_) => {}
                Err(error) => unread.push(unreadable(&path, error)),
            }
            self.names.insert(path);
        }
    }

    /// True if there is a file or folder of this name.
    pub(crate) fn contains(&self, path: &str) -> bool {
        self.names.contains(path.trim_end_matches('/'))
    }

    /// All text files, sorted by path.
    pub(crate) fn texts(&self) -> impl Iterator<Item = &TextFile> {
        self.files.iter()
    }

    /// The text of one file.
    pub(crate) fn text(&self, path: &str) -> Option<&str> {
        self.files.iter().find(|f| f.path == path).map(|f| &*f.text)
    }

    /// All Rust files.
    pub(crate) fn rust(&self) -> impl Iterator<Item = (&TextFile, &RustSource)> {
        self.files.iter().filter_map(|f| f.rust.as_ref().map(|rust| (f, rust)))
    }

    /// The Rust files of the crates below `crates/` that are part of the product: not their tests,
    /// examples and benches.
    pub(crate) fn product(&self) -> impl Iterator<Item = (&TextFile, &RustSource)> {
        self.rust().filter(|(f, _)| f.path.starts_with("crates/") && !is_test(&f.path))
    }
}

/// True for what programs make, and for the folder of the version control.
fn is_output(prefix: &str, name: &str) -> bool {
    (prefix.is_empty() && OUTPUT_FOLDERS.contains(&name))
        || name == ".git"
        || name == "target"
        || OUTPUT_ENDS.iter().any(|end| name.ends_with(end))
}

/// True for files that are compiled for tests, benches or examples only.
fn is_test(path: &str) -> bool {
    let folder = |name: &str| path.split('/').any(|part| part == name);
    folder("tests") || folder("benches") || folder("examples") || path.ends_with("/tests.rs")
}

/// The line of a byte offset, counted from 1.
pub(crate) fn line_of(text: &str, offset: usize) -> usize {
    1 + text[..offset].bytes().filter(|&b| b == b'\n').count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_and_files_are_known_by_name() {
        let tree = Tree::of(&[("crates/a/src/lib.rs", "//! A."), ("docs/x.md", "x")]);
        assert!(tree.contains("crates/a/") && tree.contains("docs/x.md"));
        assert!(!tree.contains("crates/b"));
    }

    #[test]
    fn tests_are_not_part_of_the_product() {
        let tree = Tree::of(&[
            ("crates/a/src/lib.rs", ""),
            ("crates/a/src/b/tests.rs", ""),
            ("crates/a/src/b/tests/c.rs", ""),
            ("crates/a/tests/d.rs", ""),
            ("xtask/src/main.rs", ""),
        ]);
        let product: Vec<&str> = tree.product().map(|(f, _)| &*f.path).collect();
        assert_eq!(product, ["crates/a/src/lib.rs"]);
        assert_eq!(tree.rust().count(), 5);
    }

    #[test]
    fn lines_count_from_one() {
        assert_eq!(line_of("a\nb\nc", 0), 1);
        assert_eq!(line_of("a\nb\nc", 4), 3);
    }
}
