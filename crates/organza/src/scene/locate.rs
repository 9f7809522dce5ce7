//! Finds the line and column of a value in JSON5 text that is known to parse.
//!
//! Runs only when there is something to complain about, so it scans the text anew and stays small:
//! it knows comments, strings and brackets, and leaves numbers and words to the parser.

use super::issue::Position;
use super::path::{Segment, ValuePath};

/// Which part of an object member a complaint is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Part {
    Key,
    Value,
}

/// The position of the value (or key) at `path`; of its nearest enclosing value where the path
/// leads nowhere.
pub(crate) fn locate(text: &str, path: &ValuePath, part: Part) -> Position {
    let mut scanner = Scanner { text, at: 0 };
    scanner.skip_blank();
    let mut found = scanner.at;
    for (i, segment) in path.0.iter().enumerate() {
        let member = match segment {
            Segment::Key(key) => scanner.find_key(key),
            Segment::Index(index) => scanner.find_element(*index).map(|at| (at, at)),
        };
        let Some((key_at, value_at)) = member else { break };
        let last = i + 1 == path.0.len();
        found = if last && part == Part::Key { key_at } else { value_at };
        scanner.at = value_at;
    }
    position_of(text, found)
}

/// Line and column of a byte offset.
pub(crate) fn position_of(text: &str, offset: usize) -> Position {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |i| i + 1);
    let line = 1 + before.matches('\n').count();
    let column = 1 + before[line_start..].chars().filter(|c| *c != '\u{feff}').count();
    Position { line, column }
}

struct Scanner<'t> {
    text: &'t str,
    at: usize,
}

impl<'t> Scanner<'t> {
    fn rest(&self) -> &'t str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn bump(&mut self) {
        self.at += self.peek().map_or(0, char::len_utf8);
    }

    fn skip_to(&mut self, end: &str) {
        self.at += self.rest().find(end).map_or(self.rest().len(), |i| i + end.len());
    }

    /// Passes white space and comments.
    fn skip_blank(&mut self) {
        loop {
            let rest = self.rest();
            if rest.starts_with("//") {
                self.skip_to("\n");
            } else if rest.starts_with("/*") {
                self.skip_to("*/");
            } else if self.peek().is_some_and(|c| c.is_whitespace() || c == '\u{feff}') {
                self.bump();
            } else {
                return;
            }
        }
    }

    /// Passes a quoted string; returns what stands between the quotes, escapes as written.
    fn skip_string(&mut self) -> &'t str {
        let quote = self.peek();
        self.bump();
        let start = self.at;
        while let Some(c) = self.peek() {
            if Some(c) == quote {
                let inner = &self.text[start..self.at];
                self.bump();
                return inner;
            }
            if c == '\\' {
                self.bump();
            }
            self.bump();
        }
        &self.text[start..]
    }

    /// Passes a bare word or number.
    fn skip_word(&mut self) -> &'t str {
        let start = self.at;
        while let Some(c) = self.peek() {
            if c.is_whitespace() || ",:]}[{\"'/".contains(c) {
                break;
            }
            self.bump();
        }
        &self.text[start..self.at]
    }

    fn skip_value(&mut self) {
        let mut depth = 0usize;
        loop {
            self.skip_blank();
            match self.peek() {
                None => return,
                Some('"' | '\'') => {
                    self.skip_string();
                }
                Some('{' | '[') => {
                    depth += 1;
                    self.bump();
                }
                Some('}' | ']') => {
                    depth = depth.saturating_sub(1);
                    self.bump();
                }
                Some(',' | ':' | '/') => self.bump(),
                Some(_) => {
                    self.skip_word();
                }
            }
            if depth == 0 {
                return;
            }
        }
    }

    /// Offsets of a member's key and value. Of a key given twice, the last, which is the one that
    /// counts.
    fn find_key(&mut self, key: &str) -> Option<(usize, usize)> {
        if self.peek() != Some('{') {
            return None;
        }
        self.bump();
        let mut found = None;
        loop {
            self.skip_blank();
            let key_at = self.at;
            let name = match self.peek()? {
                '}' => return found,
                ',' => {
                    self.bump();
                    continue;
                }
                '"' | '\'' => self.skip_string(),
                _ => self.skip_word(),
            };
            self.skip_blank();
            if self.peek()? == ':' {
                self.bump();
            }
            self.skip_blank();
            if unescaped(name) == key {
                found = Some((key_at, self.at));
            }
            let before = self.at;
            self.skip_value();
            if self.at <= before {
                return found;
            }
        }
    }

    fn find_element(&mut self, index: usize) -> Option<usize> {
        if self.peek() != Some('[') {
            return None;
        }
        self.bump();
        for i in 0.. {
            self.skip_blank();
            if matches!(self.peek()?, ']') {
                return None;
            }
            if i == index {
                return Some(self.at);
            }
            let before = self.at;
            self.skip_value();
            self.skip_blank();
            if self.peek()? == ',' {
                self.bump();
            }
            if self.at <= before {
                return None;
            }
        }
        None
    }
}

/// The key meant by what is written between the quotes.
fn unescaped(written: &str) -> String {
    if !written.contains('\\') {
        return written.to_owned();
    }
    // A quote inside is escaped already or of the other kind, so one of the two forms parses.
    ['"', '\'']
        .iter()
        .find_map(|quote| json5::from_str::<String>(&format!("{quote}{written}{quote}")).ok())
        .unwrap_or_else(|| written.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str, path: &str, part: Part) -> (usize, usize) {
        let position = locate(text, &ValuePath::parse(path).unwrap(), part);
        (position.line, position.column)
    }

    #[test]
    fn finds_values_behind_comments_strings_and_brackets() {
        let text = "// {a: 1}\n{\n  \"x\": '}\\'{', /* b: 2 */\n  b: [1, {c: [2, 3,], },\n    {'c': -7}],\n}";
        assert_eq!(at(text, "x", Part::Value), (3, 8));
        assert_eq!(at(text, "x", Part::Key), (3, 3));
        assert_eq!(at(text, "b[1].c[1]", Part::Value), (4, 18));
        assert_eq!(at(text, "b[2].c", Part::Value), (5, 11));
    }

    #[test]
    fn missing_parts_fall_back_to_what_encloses_them() {
        let text = "{a: {b: 1}}";
        assert_eq!(at(text, "a.c.d", Part::Value), (1, 5));
        assert_eq!(at(text, "a[3]", Part::Value), (1, 5));
        assert_eq!(at(text, "z", Part::Key), (1, 1));
        assert_eq!(at("", "a.b", Part::Value), (1, 1));
    }

    #[test]
    fn the_last_of_two_equal_keys_counts_and_columns_count_characters() {
        assert_eq!(at("{a: 1, 'ä': 2, a: 3}", "a", Part::Key), (1, 16));
        assert_eq!(at("{'a\\u0062': 1}", "ab", Part::Value), (1, 13));
    }

    #[test]
    fn any_text_terminates() {
        for text in ["{", "[", "{a", "{a:", "[1,", "{'a", "/*", "[/", "{/:/", "]", "{]}", "[}]"] {
            for path in ["a", "a[0]", "b.c"] {
                at(text, path, Part::Value);
            }
            locate(text, &ValuePath(vec![Segment::Index(1)]), Part::Value);
        }
    }
}
