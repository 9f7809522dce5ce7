//! Threads are started in one place, so that results cannot depend on how many there are.

use super::Rule;
use crate::tidy::Violation;
use crate::tidy::manifest::Manifest;
use crate::tidy::tokens::tokens;
use crate::tidy::tree::{Tree, line_of};

pub(crate) const RULE: Rule = Rule { says: "only mesh-core's par starts threads", check };

const PLACE: &str = "crates/mesh-core/src/par.rs";
const PLACE_MANIFEST: &str = "crates/mesh-core/Cargo.toml";
/// Crates made for starting threads.
const LIBRARIES: &[&str] =
    &["rayon", "rayon-core", "crossbeam", "crossbeam-channel", "tokio", "async-std", "threadpool"];

fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (file, source) in tree.rust() {
        if !file.path.starts_with("crates/") || file.path == PLACE {
            continue;
        }
        let tokens = tokens(&source.code);
        for (i, token) in tokens.iter().enumerate() {
            let before = |k: usize| i.checked_sub(k).map_or("", |i| tokens[i].text);
            let of_std = token.text == "thread" && before(1) == "::" && before(2) == "std";
            let starts = ["spawn", "scope", "Builder"].contains(&token.text)
                && before(1) == "::"
                && before(2) == "thread";
            if of_std || starts || LIBRARIES.contains(&&*token.text.replace('_', "-")) {
                let what = format!("`{}`: threads belong to {PLACE}", token.text);
                violations.push(Violation::new(&file.path, line_of(&file.text, token.at), what));
            }
        }
    }
    for file in tree.texts() {
        if file.path.starts_with("crates/")
            && file.path.ends_with("/Cargo.toml")
            && file.path != PLACE_MANIFEST
        {
            for dependency in Manifest::parse(&file.text).dependencies {
                if LIBRARIES.contains(&&*dependency.package) {
                    let what = format!("`{}`: threads belong to {PLACE}", dependency.package);
                    violations.push(Violation::new(&file.path, dependency.line, what));
                }
            }
        }
        if file.path.ends_with("Cargo.toml") {
            for (line, text) in (1..).zip(file.text.lines()) {
                if text.contains("\"rayon\"") || text.contains("\"parallel\"") {
                    let what = "a feature that starts threads outside of mesh-core's par";
                    violations.push(Violation::new(&file.path, line, what));
                }
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
    fn only_par_may() {
        let text = "use rayon::prelude::*;\nfn f() { std::thread::spawn(|| ()); }\n";
        assert_finds(&RULE, &[(PLACE, text)], &[]);
        let spawn = "crates/a/src/b.rs:2";
        assert_finds(&RULE, &[("crates/a/src/b.rs", text)], &["crates/a/src/b.rs:1", spawn, spawn]);
    }

    #[test]
    fn words_in_comments_start_nothing() {
        let text = "//! No rayon, no std::thread.\nfn thread(spawn: u8) -> u8 { spawn }\n";
        assert_finds(&RULE, &[("crates/a/src/b.rs", text)], &[]);
    }

    #[test]
    fn manifests_count_too() {
        let text = "[dependencies]\nrayon.workspace = true\nx = { version = \"1\", features = [\"rayon\"] }\n";
        let found = ["crates/a/Cargo.toml:2", "crates/a/Cargo.toml:3"];
        assert_finds(&RULE, &[("crates/a/Cargo.toml", text)], &found);
        let own = "[dependencies]\nrayon.workspace = true\n";
        assert_finds(&RULE, &[(PLACE_MANIFEST, own)], &[]);
    }
}
