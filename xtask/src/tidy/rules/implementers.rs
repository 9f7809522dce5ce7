//! A public trait is there because two things implement it. One thing needs no trait.

use super::Rule;
use crate::tidy::Violation;
use crate::tidy::tokens::{Token, tokens};
use crate::tidy::tree::{Tree, line_of};
use std::collections::{BTreeMap, BTreeSet};

pub(crate) const RULE: Rule =
    Rule { says: "every public trait has at least two implementers outside of tests", check };

const FEWEST: usize = 2;

fn check(tree: &Tree) -> Vec<Violation> {
    let mut implementers: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
    let mut traits = Vec::new();
    for (file, source) in tree.product() {
        let tokens = tokens(&source.product_code);
        for (i, token) in tokens.iter().enumerate() {
            let is = |k: usize, text: &str| tokens.get(k).is_some_and(|t| t.text == text);
            if token.text == "trait" && i > 0 && is(i - 1, "pub") {
                if let Some(name) = tokens.get(i + 1) {
                    traits.push((file, name.text, line_of(&file.text, token.at)));
                }
            } else if token.text == "impl"
                && (i == 0 || ["}", "{", ";", "]", "unsafe"].contains(&tokens[i - 1].text))
                && let Some((name, by)) = implementation(&tokens[i + 1..])
                && !forwards(&by)
            {
                implementers.entry(name).or_default().insert(by);
            }
        }
    }
    let too_few = |&(file, name, line): &(&crate::tidy::tree::TextFile, &str, usize)| {
        let n = implementers.get(name).map_or(0, BTreeSet::len);
        let what = format!("`pub trait {name}` has {n} implementers; it needs {FEWEST}");
        (n < FEWEST).then(|| Violation::new(&file.path, line, what))
    };
    traits.iter().filter_map(too_few).collect()
}

/// What follows `impl`: the trait's name and the type, or nothing for an inherent block.
fn implementation<'a>(tokens: &[Token<'a>]) -> Option<(&'a str, String)> {
    let mut depth = 0;
    let mut name = None;
    let mut by: Option<String> = None;
    for token in tokens {
        match token.text {
            "<" => depth += 1,
            ">" => depth -= 1,
            "{" | ";" => break,
            "where" if depth == 0 => break,
            "for" if depth == 0 && by.is_none() => {
                by = Some(String::new());
                continue;
            }
            text if depth == 0 && by.is_none() => name = Some(text),
            _ => {}
        }
        if let Some(by) = &mut by {
            by.push_str(token.text);
        }
    }
    Some((name?, by?))
}

/// True for references and boxes of something that implements the trait itself.
fn forwards(by: &str) -> bool {
    by.starts_with('&') || ["Box<", "Rc<", "Arc<"].iter().any(|start| by.starts_with(start))
}

#[cfg(test)]
mod tests {
    use super::super::assert_finds;
    use super::*;

    #[test]
    fn two_are_enough_also_across_crates() {
        let files = [
            ("crates/a/src/lib.rs", "pub trait T {}\nimpl T for () {}\n"),
            (
                "crates/b/src/lib.rs",
                "struct S;\nimpl<A: Copy, const N: usize> a::T for S<A, N>\nwhere A: X {}\n",
            ),
        ];
        assert_finds(&RULE, &files, &[]);
    }

    #[test]
    fn one_is_not_enough() {
        let files = [("crates/a/src/lib.rs", "//! A.\npub trait T {}\nimpl T for () {}\n")];
        assert_finds(&RULE, &files, &["crates/a/src/lib.rs:2"]);
    }

    #[test]
    fn tests_forwarding_and_repeats_do_not_count() {
        let text = "pub trait T<A> {}\nimpl T<u8> for () {}\nimpl T<u16> for () {}\n\
                    impl<S: T<u8> + ?Sized> T<u8> for &S {}\nimpl<S: T<u8>> T<u8> for Box<S> {}\n\
                    #[cfg(test)]\nmod tests { impl T<u8> for u8 {} }\n// impl T for u16\n";
        let files = [("crates/a/src/lib.rs", text), ("crates/a/tests/t.rs", "impl T for S {}\n")];
        assert_finds(&RULE, &files, &["crates/a/src/lib.rs:1"]);
    }

    #[test]
    fn arguments_and_private_traits_are_something_else() {
        let text = "trait Own {}\npub(crate) trait Inner {}\nfn f(x: impl Fn(u8) -> u8) {}\n\
                    struct S;\nimpl S { fn g(&self) { for i in 0..2 {} } }\n";
        assert_finds(&RULE, &[("crates/a/src/lib.rs", text)], &[]);
    }
}
