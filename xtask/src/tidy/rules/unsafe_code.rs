//! No unsafe code, and every library says so where no `allow` can take it back.

use super::Rule;
use crate::tidy::Violation;
use crate::tidy::tokens::tokens;
use crate::tidy::tree::{Tree, line_of};

pub(crate) const RULE: Rule =
    Rule { says: "no `unsafe`; every library forbids it at its root", check };

const FORBIDS: &str = "#![forbid(unsafe_code)]";

fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (file, source) in tree.rust() {
        for token in tokens(&source.code).iter().filter(|t| t.text == "unsafe") {
            let line = line_of(&file.text, token.at);
            violations.push(Violation::new(&file.path, line, "`unsafe` is not used here"));
        }
        let is_root = file.path.starts_with("crates/") && file.path.ends_with("/src/lib.rs");
        if is_root && !source.code.contains(FORBIDS) {
            violations.push(Violation::new(&file.path, 1, format!("lacks `{FORBIDS}`")));
        }
    }
    violations
}

#[cfg(test)]
mod tests {
    use super::super::assert_finds;
    use super::*;

    #[test]
    fn the_word_in_code_is_found() {
        let text = "//! Not unsafe.\nfn f() {\n unsafe { g() }\n}\n";
        assert_finds(&RULE, &[("xtask/src/b.rs", text)], &["xtask/src/b.rs:3"]);
    }

    #[test]
    fn libraries_forbid_it() {
        let forbids = format!("//! A.\n{FORBIDS}\n");
        assert_finds(&RULE, &[("crates/a/src/lib.rs", &forbids)], &[]);
        assert_finds(&RULE, &[("crates/a/src/lib.rs", "//! A.\n")], &["crates/a/src/lib.rs:1"]);
    }
}
