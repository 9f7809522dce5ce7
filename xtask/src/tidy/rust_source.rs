//! A Rust file taken apart as far as the rules need: code without comments and literals, and the
//! comments.
//!
//! Not a parser. It knows the lexical rules that decide where comments, strings and characters end,
//! and which items are compiled for tests only.

use super::tree::line_of;

/// A comment. Several `//` lines in a row are several comments.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Comment {
    /// Counted from 1.
    pub(crate) line: usize,
    /// With its slashes.
    pub(crate) text: String,
}

/// The parts of a Rust file.
pub(crate) struct RustSource {
    /// The file with comments and the insides of literals blanked; offsets and lines are kept.
    pub(crate) code: String,
    /// The same without the items under `#[cfg(test)]`.
    pub(crate) product_code: String,
    /// In order.
    pub(crate) comments: Vec<Comment>,
}

impl RustSource {
    pub(crate) fn new(text: &str) -> RustSource {
        let mut lexer = Lexer { text, at: 0, blanked: Vec::new(), comments: Vec::new() };
        lexer.run();
        let code = blank(text, &lexer.blanked);
        let product_code = blank(&code, &test_items(&code));
        RustSource { code, product_code, comments: lexer.comments }
    }
}

/// The text with the given byte ranges replaced by spaces, lines kept.
fn blank(text: &str, ranges: &[(usize, usize)]) -> String {
    let mut out = String::with_capacity(text.len());
    let mut from = 0;
    for &(start, end) in ranges {
        out.push_str(&text[from..start]);
        let keep_lines = |b: u8| if b == b'\n' { '\n' } else { ' ' };
        out.extend(text[start..end].bytes().map(keep_lines));
        from = end;
    }
    out.push_str(&text[from..]);
    out
}

struct Lexer<'a> {
    text: &'a str,
    at: usize,
    blanked: Vec<(usize, usize)>,
    comments: Vec<Comment>,
}

impl Lexer<'_> {
    fn rest(&self) -> &str {
        &self.text[self.at..]
    }

    fn run(&mut self) {
        let mut before = ' ';
        while let Some(c) = self.rest().chars().next() {
            let in_word = before.is_alphanumeric() || before == '_';
            let start = self.at;
            if self.rest().starts_with("//") {
                self.at += self.rest().find('\n').unwrap_or(self.rest().len());
                self.comment(start);
            } else if self.rest().starts_with("/*") {
                self.block_comment();
                self.comment(start);
            } else if let Some(hashes) = self.raw_string_hashes().filter(|_| !in_word) {
                self.raw_string(hashes);
            } else if c == '"' {
                self.at += 1;
                self.literal('"');
            } else if c == '\'' && self.is_character() {
                self.at += 1;
                self.literal('\'');
            } else {
                self.at += c.len_utf8();
            }
            before = c;
        }
    }

    fn comment(&mut self, start: usize) {
        self.blanked.push((start, self.at));
        let line = line_of(self.text, start);
        self.comments.push(Comment { line, text: self.text[start..self.at].to_owned() });
    }

    fn block_comment(&mut self) {
        let mut depth = 0;
        while self.at < self.text.len() {
            if self.rest().starts_with("/*") {
                depth += 1;
                self.at += 2;
            } else if self.rest().starts_with("*/") {
                depth -= 1;
                self.at += 2;
                if depth == 0 {
                    return;
                }
            } else {
                self.at += self.rest().chars().next().map_or(1, char::len_utf8);
            }
        }
    }

    /// Number of `#` if a raw string starts here (`r"`, `br#"` and the like).
    fn raw_string_hashes(&self) -> Option<usize> {
        let rest = self.rest();
        let rest = rest.strip_prefix(['b', 'c']).unwrap_or(rest).strip_prefix('r')?;
        let hashes = rest.bytes().take_while(|&b| b == b'#').count();
        rest[hashes..].starts_with('"').then_some(hashes)
    }

    fn raw_string(&mut self, hashes: usize) {
        let opening = self.rest().find('"').unwrap_or(0) + 1;
        let start = self.at + opening;
        let close = format!("\"{}", "#".repeat(hashes));
        let end = self.text[start..].find(&close).map_or(self.text.len(), |n| start + n);
        self.blanked.push((start, end));
        self.at = (end + close.len()).min(self.text.len());
    }

    /// A quote opens a character unless it opens a lifetime or a label.
    fn is_character(&self) -> bool {
        let mut inside = self.rest().chars().skip(1);
        match inside.next() {
            Some('\\') => true,
            Some(_) => inside.next() == Some('\''),
            None => false,
        }
    }

    /// From behind the opening quote to behind the closing one.
    fn literal(&mut self, quote: char) {
        let start = self.at;
        let mut escaped = false;
        while let Some(c) = self.rest().chars().next() {
            self.at += c.len_utf8();
            if escaped {
                escaped = false;
            } else if c == '\\' {
                escaped = true;
            } else if c == quote {
                self.blanked.push((start, self.at - 1));
                return;
            }
        }
        self.blanked.push((start, self.at));
    }
}

/// Byte ranges of the items under `#[cfg(test)]` in code without comments and literals.
fn test_items(code: &str) -> Vec<(usize, usize)> {
    const ATTRIBUTE: &str = "#[cfg(test)]";
    let mut ranges: Vec<(usize, usize)> = Vec::new();
    for (start, _) in code.match_indices(ATTRIBUTE) {
        if ranges.last().is_some_and(|&(_, end)| start < end) {
            continue;
        }
        let mut depth = 0;
        let after = start + ATTRIBUTE.len();
        let mut end = code.len();
        for (at, b) in code.bytes().enumerate().skip(after) {
            match b {
                b'{' | b'(' | b'[' => depth += 1,
                b'}' | b')' | b']' => depth -= 1,
                _ => {}
            }
            if depth == 0 && (b == b'}' || b == b';') {
                end = at + 1;
                break;
            }
        }
        ranges.push((start, end));
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_literals_are_blanked_and_lines_kept() {
        let text =
            "let a = \"// no\"; // yes\n/* b /* c */ d */ let e = '\"'; let f = r#\"\"x\"\"#;";
        let source = RustSource::new(text);
        assert_eq!(source.code.len(), text.len());
        assert_eq!(source.code.lines().count(), 2);
        assert!(!source.code.contains("no") && !source.code.contains('x'));
        assert!(source.code.contains("let e") && source.code.contains("let f"));
        let comments: Vec<&str> = source.comments.iter().map(|c| &*c.text).collect();
        assert_eq!(comments, ["// yes", "/* b /* c */ d */"]);
        assert_eq!(source.comments[1].line, 2);
    }

    #[test]
    fn lifetimes_are_not_characters() {
        let source = RustSource::new("fn f<'a>(x: &'a str) -> char { 'u' } // 'tis");
        assert!(source.code.contains("&'a str"));
        assert!(!source.code.contains("'u'"));
    }

    #[test]
    fn escapes_do_not_end_a_literal() {
        let source = RustSource::new(r#"let s = "a\"b unsafe"; let c = '\''; unsafe {}"#);
        assert_eq!(source.code.matches("unsafe").count(), 1);
    }

    #[test]
    fn letters_beyond_ascii_keep_the_offsets() {
        let text = "// ℓ² → κ\nfn f() {}";
        let source = RustSource::new(text);
        assert_eq!(source.code.len(), text.len());
        assert_eq!(source.code.find("fn"), text.find("fn"));
    }

    #[test]
    fn test_items_are_left_out_of_the_product() {
        let text = "fn a() {}\n#[cfg(test)]\nmod tests {\n fn b() { [0; 2] }\n}\n\
                    #[cfg(test)]\nuse x::y;\n#[cfg(test)]\nmod t;\nfn c() {}";
        let source = RustSource::new(text);
        assert!(source.code.contains("fn b"));
        assert!(!source.product_code.contains("fn b") && !source.product_code.contains("x::y"));
        assert!(source.product_code.contains("fn a") && source.product_code.contains("fn c"));
    }
}
