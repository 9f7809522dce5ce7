//! The crates below the command line print nothing and read nothing that no caller gave them.

use super::Rule;
use crate::tidy::Violation;
use crate::tidy::tokens::tokens;
use crate::tidy::tree::{Tree, line_of};

pub(crate) const RULE: Rule =
    Rule { says: "crates below organza neither print nor read the environment", check };

const TOP: &str = "crates/organza/";
const PRINTS: &[&str] = &["print", "println", "eprint", "eprintln"];
/// `std::…` modules that reach out of the program, and the only crate whose subject they are.
const GLOBALS: &[(&str, &str)] =
    &[("env", ""), ("process", ""), ("fs", "crates/io-mcap/"), ("net", "")];

fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (file, source) in tree.product().filter(|(f, _)| !f.path.starts_with(TOP)) {
        let tokens = tokens(&source.product_code);
        for (i, token) in tokens.iter().enumerate() {
            let next = tokens.get(i + 1).map_or("", |t| t.text);
            let before = |k: usize| i.checked_sub(k).map_or("", |i| tokens[i].text);
            let prints = next == "!" && PRINTS.contains(&token.text);
            let global = before(1) == "::" && before(2) == "std" && {
                let allowed = GLOBALS.iter().find(|(name, _)| *name == token.text).map(|g| g.1);
                allowed.is_some_and(|home| home.is_empty() || !file.path.starts_with(home))
            };
            if prints || global {
                let what = format!("`{}` belongs to the callers in {TOP}", token.text);
                violations.push(Violation::new(&file.path, line_of(&file.text, token.at), what));
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
    fn low_crates_are_quiet() {
        let text =
            "fn f() {\n println!(\"x\");\n let a = std::env::args();\n std::fs::read(a);\n}\n";
        let found = ["crates/a/src/b.rs:2", "crates/a/src/b.rs:3", "crates/a/src/b.rs:4"];
        assert_finds(&RULE, &[("crates/a/src/b.rs", text)], &found);
        assert_finds(&RULE, &[("crates/organza/src/b.rs", text), ("xtask/src/b.rs", text)], &[]);
    }

    #[test]
    fn recordings_are_files_and_tests_may_print() {
        let text = "use std::fs::File;\nfn f(env: u8) -> u8 { env }\n\
                    #[cfg(test)]\nmod tests { fn g() { println!() } }\n";
        assert_finds(&RULE, &[("crates/io-mcap/src/b.rs", text)], &[]);
    }
}
