//! Words and signs of code without comments and literals.

/// A word (identifier, keyword, number) or a single sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Token<'a> {
    pub(crate) text: &'a str,
    /// Byte offset.
    pub(crate) at: usize,
}

/// The tokens of `code`; `::` and `->` count as one sign each.
pub(crate) fn tokens(code: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(c) = code[at..].chars().next() {
        let rest = &code[at..];
        let length = if is_word(c) {
            rest.find(|c| !is_word(c)).unwrap_or(rest.len())
        } else if rest.starts_with("::") || rest.starts_with("->") {
            2
        } else {
            c.len_utf8()
        };
        if !c.is_whitespace() {
            tokens.push(Token { text: &rest[..length], at });
        }
        at += length;
    }
    tokens
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_signs() {
        let texts: Vec<&str> = tokens("impl<A> x::B for _c2->D").iter().map(|t| t.text).collect();
        assert_eq!(texts, ["impl", "<", "A", ">", "x", "::", "B", "for", "_c2", "->", "D"]);
        assert_eq!(tokens("a  b")[1].at, 3);
    }
}
