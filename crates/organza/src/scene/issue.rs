//! What is wrong with a scene, and where: one complaint per line, each with file, line and column.

use std::fmt;

/// The kind of a complaint or remark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IssueKind {
    /// The text is not JSON5.
    Syntax,
    /// A key is unknown or missing, or a value has the wrong type.
    Structure,
    /// A value is out of range or contradicts another.
    Value,
    /// A file named in the scene cannot be read.
    File,
    /// The scene asks for something that this version does not simulate.
    Unsupported,
    /// Worth knowing, and never an error.
    Notice,
}

/// A place in a text, counted from 1; columns count characters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// Line, the first is 1.
    pub line: usize,
    /// Column, the first is 1.
    pub column: usize,
}

/// Where the value at fault was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// In a file; the position is absent where the file has no text to point at.
    File {
        /// The file as named by the caller or by the scene.
        name: String,
        /// Line and column.
        position: Option<Position>,
    },
    /// On the command line.
    Set {
        /// The whole `PATH=VALUE`.
        argument: String,
    },
}

/// One complaint or remark. Prints as `FILE:LINE:COLUMN: PATH: MESSAGE`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Issue {
    /// What kind of issue this is.
    pub kind: IssueKind,
    /// Where the value was written.
    pub origin: Origin,
    /// The place in the scene, such as `cloths[0].transform.scale`; empty for the whole file.
    pub path: String,
    /// What happened, with the numbers.
    pub message: String,
}

impl fmt::Display for Issue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.origin {
            Origin::File { name, position: Some(p) } => {
                write!(f, "{name}:{}:{}: ", p.line, p.column)?;
            }
            Origin::File { name, position: None } => write!(f, "{name}: ")?,
            Origin::Set { argument } => write!(f, "--set {argument}: ")?,
        }
        if !self.path.is_empty() {
            write!(f, "{}: ", self.path)?;
        }
        if self.kind == IssueKind::Unsupported {
            write!(f, "not supported yet: ")?;
        }
        write!(f, "{}", self.message)
    }
}

/// Everything that is wrong with a scene; never empty. Prints one issue per line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SceneErrors {
    issues: Vec<Issue>,
}

impl SceneErrors {
    /// Wraps the issues found.
    ///
    /// # Panics
    /// In debug builds, when `issues` is empty.
    pub(crate) fn new(issues: Vec<Issue>) -> Self {
        debug_assert!(!issues.is_empty(), "errors without an error");
        Self { issues }
    }

    /// The issues in the order of the checks.
    #[must_use]
    pub fn issues(&self) -> &[Issue] {
        &self.issues
    }
}

impl From<Issue> for SceneErrors {
    fn from(issue: Issue) -> Self {
        Self::new(vec![issue])
    }
}

impl fmt::Display for SceneErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, issue) in self.issues.iter().enumerate() {
            if i > 0 {
                writeln!(f)?;
            }
            write!(f, "{issue}")?;
        }
        if self.issues.iter().any(|issue| issue.kind == IssueKind::Unsupported) {
            write!(f, "\nuse --allow-unsupported to run without what is not supported yet")?;
        }
        Ok(())
    }
}

impl std::error::Error for SceneErrors {}
