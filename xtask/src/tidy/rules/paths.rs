//! Paths that the documents name exist: documentation must not outlive what it describes.
//!
//! Looked at are the targets of links, paths in `code`, and in fenced code the words that begin
//! with a folder of the project. Paths in code are relative to the root, links to the document.

use super::Rule;
use crate::tidy::Violation;
use crate::tidy::tree::{OUTPUT_FOLDERS, Tree};

pub(crate) const RULE: Rule = Rule { says: "paths named in the documents exist", check };

fn check(tree: &Tree) -> Vec<Violation> {
    let is_document = |path: &str| path.ends_with(".md") && !path.starts_with("crates/");
    let mut violations = Vec::new();
    for file in tree.texts().filter(|f| is_document(&f.path)) {
        let folder = file.path.rsplit_once('/').map_or("", |(folder, _)| folder);
        let mut fenced = false;
        for (line, text) in (1..).zip(file.text.lines()) {
            if text.trim_start().starts_with("```") {
                fenced = !fenced;
                continue;
            }
            let text = &*without_remarks(text);
            let named: Vec<String> = if fenced {
                text.split_whitespace().filter(|w| begins_here(tree, w)).map(plain).collect()
            } else {
                let linked = links(text).into_iter().map(|target| resolve(folder, target));
                let coded = in_code(text).into_iter().filter(|w| is_path(tree, w)).map(plain);
                linked.chain(coded).collect()
            };
            for path in named.iter().filter(|path| !exists(tree, path)) {
                let what = format!("names `{path}`, which does not exist");
                violations.push(Violation::new(&file.path, line, what));
            }
        }
    }
    violations
}

/// A line without its `<!-- remarks -->`: what is commented out is no documentation.
fn without_remarks(line: &str) -> String {
    let mut out = String::new();
    let mut rest = line;
    while let Some((before, after)) = rest.split_once("<!--") {
        out.push_str(before);
        rest = after.split_once("-->").map_or("", |(_, after)| after);
    }
    out + rest
}

/// Without the signs around a word in running code.
fn plain(word: &str) -> String {
    word.trim_matches(|c: char| "\"'(),;:".contains(c)).to_owned()
}

/// A path up to its first part with a wild card.
fn exists(tree: &Tree, path: &str) -> bool {
    let fixed: Vec<&str> = path.split('/').take_while(|part| !part.contains(['*', '…'])).collect();
    fixed.is_empty() || tree.contains(&fixed.join("/"))
}

/// True if the word is a path whose first part is a folder of the project.
fn begins_here(tree: &Tree, word: &str) -> bool {
    let word = plain(word);
    word.split_once('/').is_some_and(|(first, _)| !first.is_empty() && tree.contains(first))
}

/// True if a word in code reads as a path of the project: it begins with one of its folders, or has
/// a slash and ends like a file. What programs make is not looked at.
fn is_path(tree: &Tree, word: &str) -> bool {
    if word.contains([' ', '<', '{', '$', '=', '(']) || word.contains("::") || word.contains("//") {
        return false;
    }
    let Some((first, _)) = word.split_once('/') else { return false };
    let last = word.rsplit('/').next().unwrap_or("");
    let like_a_file = last.rsplit_once('.').is_some_and(|(stem, end)| {
        !stem.is_empty() && (1..=6).contains(&end.len()) && end.chars().all(char::is_alphanumeric)
    });
    !OUTPUT_FOLDERS.contains(&first) && !first.is_empty() && (tree.contains(first) || like_a_file)
}

/// The texts between single backticks.
fn in_code(line: &str) -> Vec<&str> {
    line.split('`').skip(1).step_by(2).collect()
}

/// The targets of links and pictures that stay in the project.
fn links(line: &str) -> Vec<&str> {
    let targets = line.match_indices("](").filter_map(|(at, _)| line[at + 2..].split(')').next());
    let own = targets.map(|t| t.split(['#', ' ']).next().unwrap_or(""));
    own.filter(|t| !t.is_empty() && !t.contains("://") && !t.starts_with("mailto:")).collect()
}

/// A link's target seen from the root.
fn resolve(folder: &str, target: &str) -> String {
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in target.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop();
            }
            part => parts.push(part),
        }
    }
    parts.join("/")
}

#[cfg(test)]
mod tests {
    use super::super::assert_finds;
    use super::*;

    const HERE: [(&str, &str); 2] = [("crates/a/src/lib.rs", ""), ("docs/notes.md", "fine")];

    fn finds(path: &str, text: &str, expected: &[&str]) {
        assert_finds(&RULE, &[HERE[0], HERE[1], (path, text)], expected);
    }

    #[test]
    fn paths_in_code() {
        finds("README.md", "See `crates/a/src/lib.rs`, `crates/a/` and `crates/*/src`.", &[]);
        finds("README.md", "x\nSee `crates/b` and `gone/x.rs`.", &["README.md:2", "README.md:2"]);
    }

    #[test]
    fn other_things_in_code() {
        finds("README.md", "`kg/m²`, `a::b/c.d`, `/cloth/material`, `out/x.png`, `f64/f32`", &[]);
    }

    #[test]
    fn links_are_relative_to_the_document() {
        finds("docs/b.md", "[n](notes.md) [r](../crates/a/src/lib.rs#x) [w](https://a.b/c)", &[]);
        finds(
            "docs/b.md",
            "[n](docs/notes.md) ![p](images/x.png)",
            &["docs/b.md:1", "docs/b.md:1"],
        );
    }

    #[test]
    fn remarks_do_not_count() {
        finds("README.md", "<!-- `gone/a.b` --> `crates/a` <!-- [x](gone.md)", &[]);
        finds("README.md", "<!-- x --> `gone/a.b`", &["README.md:1"]);
    }

    #[test]
    fn fenced_code() {
        finds("README.md", "```sh\nrun crates/a/src/lib.rs --out out/x/y.z\n```", &[]);
        finds("README.md", "```sh\nrun \"crates/a/src/gone.rs\"\n```", &["README.md:2"]);
    }
}
