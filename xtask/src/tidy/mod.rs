//! `cargo xtask tidy`: the house rules, checked.
//!
//! Every rule is a pure function from the [`Tree`](tree::Tree) of files to violations, in a file of
//! its own with tests that show it can fail. The rules also run inside `cargo test`.

mod manifest;
mod rules;
mod rust_source;
mod tokens;
mod tree;

use crate::command::{Command, Failure, no_arguments, say};
use rules::RULES;
use std::fmt;
use std::path::Path;
use tree::Tree;

/// One breach of a rule.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Violation {
    /// The file, relative to the root of the workspace, with `/` between its parts.
    pub file: String,
    /// The line, counted from 1; 0 if it is about the file as a whole.
    pub line: usize,
    /// What is wrong and what to do.
    pub message: String,
}

impl Violation {
    fn new(file: impl Into<String>, line: usize, message: impl Into<String>) -> Self {
        Violation { file: file.into(), line, message: message.into() }
    }
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.file, self.line, self.message)
    }
}

/// Checks every rule on the workspace at `root`. Violations come sorted by file and line. What
/// cannot be read is a violation too, so that nothing is ever passed unseen.
pub fn run(root: &Path) -> Vec<Violation> {
    let (tree, mut violations) = Tree::read(root);
    if !tree.contains("Cargo.toml") || tree.rust().next().is_none() {
        let what = format!("{} holds no Rust workspace", root.display());
        violations.push(Violation::new("Cargo.toml", 0, what));
    }
    violations.extend(RULES.iter().flat_map(|rule| (rule.check)(&tree)));
    violations.sort();
    violations.dedup();
    violations
}

/// The command.
pub const COMMAND: Command = Command {
    name: "tidy",
    summary: "Check the house rules on every file; prints file:line: message",
    help,
    run: command,
};

fn help() -> String {
    let rules: String = RULES.iter().map(|rule| format!("  {}\n", rule.says)).collect();
    format!(
        "Usage: cargo xtask tidy\n\nRules:\n{rules}\nExit code 1 if one is broken.\n\n\
         Examples:\n  cargo xtask tidy\n  cargo test --release -p organza-tests --test tidy\n"
    )
}

fn command(root: &Path, arguments: &[String]) -> Result<(), Failure> {
    no_arguments(arguments)?;
    let violations = run(root);
    for violation in &violations {
        say(violation);
    }
    if violations.is_empty() {
        say(format!("tidy: {} rules kept", RULES.len()));
        Ok(())
    } else {
        eprintln!("tidy: {} violations", violations.len());
        Err(Failure::Found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_without_a_workspace_does_not_pass() {
        let violations = run(Path::new("there/is/no/such/folder"));
        assert!(violations.iter().any(|v| v.message.contains("no Rust workspace")));
        assert!(violations.iter().any(|v| v.message.contains("cannot read")));
    }

    #[test]
    fn a_violation_prints_as_editors_read_it() {
        let violation = Violation::new("crates/a/src/b.rs", 3, "too long");
        assert_eq!(violation.to_string(), "crates/a/src/b.rs:3: too long");
    }
}
