//! Citations in comments resolve to an entry of `docs/references.md`.
//!
//! A citation is a key such as `Koh2014`, or prose such as "Nocedal and Wright 2006"; prose
//! resolves to an entry of that year that names the author.

use super::Rule;
use crate::tidy::Violation;
use crate::tidy::tree::Tree;

pub(crate) const RULE: Rule =
    Rule { says: "citations resolve to an entry of docs/references.md", check };

const REFERENCES: &str = "docs/references.md";
/// Words in front of a year that are not authors.
const NOT_AUTHORS: &[&str] = &["Rust", "Edition", "Eurographics"];

/// An entry: `- **Koh2014** – W. Koh, …`, to the next one.
struct Entry {
    key: String,
    text: String,
}

fn entries(text: &str) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    for line in text.lines() {
        if let Some((key, rest)) = line.strip_prefix("- **").and_then(|l| l.split_once("**")) {
            entries.push(Entry { key: key.to_owned(), text: rest.to_owned() });
        } else if let Some(entry) = entries.last_mut() {
            entry.text.push_str(line);
        }
    }
    entries
}

/// A citation found in a text.
#[derive(Debug, PartialEq, Eq)]
enum Citation<'a> {
    Key(&'a str),
    Prose { author: &'a str, year: &'a str },
}

impl Citation<'_> {
    fn resolves(&self, entries: &[Entry]) -> bool {
        match self {
            Citation::Key(key) => entries.iter().any(|e| e.key == *key),
            Citation::Prose { author, year } => {
                entries.iter().any(|e| e.key.contains(year) && e.text.contains(author))
            }
        }
    }

    fn written(&self) -> String {
        match self {
            Citation::Key(key) => (*key).to_owned(),
            Citation::Prose { author, year } => format!("{author} {year}"),
        }
    }
}

fn is_year(word: &str) -> bool {
    word.len() == 4
        && word.bytes().all(|b| b.is_ascii_digit())
        && (word.starts_with("19") || word.starts_with("20"))
}

/// An author's name: capitalised, and not an acronym.
fn is_name(word: &str) -> bool {
    word.starts_with(char::is_uppercase)
        && word.contains(char::is_lowercase)
        && word.chars().all(|c| c.is_alphabetic() || c == '-' || c == '\'' || c == '’')
}

/// A name and a year in one word, with a letter where a year has several.
fn is_key(word: &str) -> bool {
    let Some(digits) = word.find(|c: char| c.is_ascii_digit()) else { return false };
    let (name, year) = word.split_at(digits);
    let year = year.strip_suffix(|c: char| c.is_ascii_lowercase()).unwrap_or(year);
    is_name(name) && is_year(year)
}

/// The citations in lines of text, each with its line: a name may end one line and the year begin
/// the next.
fn citations<'a>(lines: &[(usize, &'a str)]) -> Vec<(usize, Citation<'a>)> {
    let words: Vec<(usize, &str)> = lines
        .iter()
        .flat_map(|&(line, text)| {
            let words = text.split(|c: char| !(c.is_alphanumeric() || "-'’_".contains(c)));
            words.filter(|word| !word.is_empty()).map(move |word| (line, word))
        })
        .collect();
    let mut found = Vec::new();
    for (i, &(line, word)) in words.iter().enumerate() {
        let key = word.split(['-', '\'', '’']).next().unwrap_or(word);
        let before = |k: usize| i.checked_sub(k).map_or("", |i| words[i].1);
        if is_key(key) {
            found.push((line, Citation::Key(key)));
        } else if is_year(word) {
            let author = if [before(2), before(1)] == ["et", "al"] { before(3) } else { before(1) };
            if is_name(author) && !NOT_AUTHORS.contains(&author) {
                found.push((line, Citation::Prose { author, year: word }));
            }
        }
    }
    found
}

fn check(tree: &Tree) -> Vec<Violation> {
    let entries = entries(tree.text(REFERENCES).unwrap_or(""));
    let mut violations = Vec::new();
    let mut look = |path: &str, lines: &[(usize, &str)]| {
        for (line, citation) in citations(lines).iter().filter(|(_, c)| !c.resolves(&entries)) {
            let what = format!("`{}` is not in {REFERENCES}", citation.written());
            violations.push(Violation::new(path, *line, what));
        }
    };
    for (file, source) in tree.rust() {
        let blocks = source.comments.chunk_by(|a, b| b.line == a.line + 1);
        for block in blocks {
            let lines: Vec<(usize, &str)> = block.iter().map(|c| (c.line, &*c.text)).collect();
            look(&file.path, &lines);
        }
    }
    for file in tree.texts().filter(|f| f.path.ends_with(".md") && f.path != REFERENCES) {
        let lines: Vec<(usize, &str)> = (1..).zip(file.text.lines()).collect();
        look(&file.path, &lines);
    }
    violations
}

#[cfg(test)]
mod tests {
    use super::super::assert_finds;
    use super::*;

    const KNOWN: (&str, &str) = (
        REFERENCES,
        "# References\n- **Koh2014** – W. Koh. A paper.\n- **Nocedal2006** – J. Nocedal,\n  S. Wright. A book.\n",
    );

    #[test]
    fn keys_resolve_or_are_found() {
        let text =
            "//! After Koh2014's Eq. (4).\n//!\n//! And Nobody1999, Koh2014-like.\nfn f() {}\n";
        assert_finds(&RULE, &[KNOWN, ("a.rs", text)], &["a.rs:3"]);
        assert_finds(&RULE, &[("a.rs", "// Koh2014\n")], &["a.rs:1"]);
        assert_finds(&RULE, &[KNOWN, ("docs/a.md", "x\nNobody1999\n")], &["docs/a.md:2"]);
    }

    #[test]
    fn prose_resolves_by_author_and_year() {
        let text = "/// See Nocedal and Wright 2006, or Koh et al.\n/// 2014; not Wright et al.\n/// 2014.\n";
        assert_finds(&RULE, &[KNOWN, ("a.rs", text)], &["a.rs:3"]);
    }

    #[test]
    fn code_and_other_numbers_are_not_citations() {
        let text =
            "// a 2023 server, SIGGRAPH 2012, Rust 2024, IEC 61966\nlet x = Vec2000::new();\n";
        assert_finds(&RULE, &[KNOWN, ("a.rs", text)], &[]);
    }

    #[test]
    fn words_of_a_citation() {
        assert!(is_key("Koh2014") && is_key("Li2021b") && is_key("OBrien1999"));
        assert!(!is_key("x2014") && !is_key("Koh20145") && !is_key("Koh") && !is_key("SI2014"));
    }
}
