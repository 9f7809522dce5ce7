//! Every Rust file says in its first line what it is for.

use super::Rule;
use crate::tidy::Violation;
use crate::tidy::tree::Tree;

pub(crate) const RULE: Rule = Rule { says: "every .rs file begins with a //! head", check };

fn check(tree: &Tree) -> Vec<Violation> {
    let has_head = |text: &str| {
        let first = text.lines().next().unwrap_or("");
        first.strip_prefix("//!").is_some_and(|head| !head.trim().is_empty())
    };
    tree.rust()
        .filter(|(file, _)| !has_head(&file.text))
        .map(|(file, _)| Violation::new(&file.path, 1, "begins without a `//!` head"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::assert_finds;
    use super::*;

    #[test]
    fn a_head_is_the_first_line_and_says_something() {
        let files = [
            ("a.rs", "//! What it is.\nfn a() {}\n"),
            ("b.rs", "// not a head\n"),
            ("c.rs", "//!\n"),
            ("d.rs", ""),
            ("e.rs", "use x;\n//! Late.\n"),
            ("f.py", "print()\n"),
        ];
        assert_finds(&RULE, &files, &["b.rs:1", "c.rs:1", "d.rs:1", "e.rs:1"]);
    }
}
