//! Nothing that was only meant for while the code was being written.

use super::Rule;
use crate::tidy::Violation;
use crate::tidy::tokens::tokens;
use crate::tidy::tree::{Tree, line_of};

pub(crate) const RULE: Rule = Rule { says: "no dbg!, todo!, unimplemented!", check };

const MACROS: &[&str] = &["dbg", "todo", "unimplemented"];

fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (file, source) in tree.rust() {
        for pair in tokens(&source.code).windows(2) {
            if pair[1].text == "!" && MACROS.contains(&pair[0].text) {
                let line = line_of(&file.text, pair[0].at);
                violations.push(Violation::new(&file.path, line, format!("`{}!`", pair[0].text)));
            }
        }
    }
    violations
}

#[cfg(test)]
mod tests {
    use super::super::assert_finds;
    use super::*;

    #[test]
    fn calls_are_found_words_are_not() {
        let text = "// todo!()\nfn todo() {}\nfn f() { let s = \"dbg!\";\n todo! (); dbg!(s) }\n";
        assert_finds(&RULE, &[("a.rs", text)], &["a.rs:4", "a.rs:4"]);
    }
}
