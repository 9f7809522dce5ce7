//! No file names a place on somebody's machine or network: a clone must work anywhere.

use super::Rule;
use crate::tidy::Violation;
use crate::tidy::tree::Tree;

pub(crate) const RULE: Rule =
    Rule { says: "no paths of one machine and no hosts of one network", check };

/// Folders at the root of a file system where people work, without their slash so that this list
/// does not break the rule.
const FOLDERS: &[&str] = &["work", "tmp", "root", "home", "Users", "mnt"];
/// Parts of host names that only resolve inside a network, or that stand for a package mirror.
const INSIDE: &[&str] = &[
    ".internal",
    ".local",
    ".lan",
    ".corp",
    ".intranet",
    "artifactory",
    "nexus",
    "mirror",
    "proxy",
];
/// The one registry.
const REGISTRY: &str = "registry+https://github.com/rust-lang/crates.io-index";
/// Keys of Cargo's configuration that send it to another registry.
const REDIRECTS: &[&str] = &["replace-with", "[source.", "[registries", "[registry"];

fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    for file in tree.texts() {
        for (line, text) in (1..).zip(file.text.lines()) {
            for found in [machine_path(text), inside_host(text), other_registry(&file.path, text)] {
                violations.extend(found.map(|what| Violation::new(&file.path, line, what)));
            }
        }
    }
    violations
}

/// An absolute path into one of the folders.
fn machine_path(text: &str) -> Option<String> {
    let starts = text.match_indices('/').filter(|&(at, _)| {
        // Not in the middle of a longer path or a URL.
        let before = text[..at].chars().next_back().unwrap_or(' ');
        !(before.is_alphanumeric() || "/.:-_~*)}]<>".contains(before))
    });
    let folder = |at: usize| -> Option<&str> {
        let rest = &text[at + 1..];
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '-'));
        let name = &rest[..end.unwrap_or(rest.len())];
        FOLDERS.contains(&name).then_some(name)
    };
    let unix = starts.into_iter().find_map(|(at, _)| folder(at)).map(|name| format!("/{name}"));
    let windows = text.contains(":\\Users\\").then(|| "a Windows user's folder".to_owned());
    unix.or(windows).map(|path| format!("names {path}, which only one machine has"))
}

/// The host of a URL that only resolves inside a network.
fn inside_host(text: &str) -> Option<String> {
    text.match_indices("://").find_map(|(at, _)| {
        let rest = &text[at + 3..];
        let rest = rest.split(['/', '"', '\'', ' ', ')', '>', '`']).next().unwrap_or("");
        let host = rest.rsplit('@').next().unwrap_or("").split(':').next().unwrap_or("");
        let numeric =
            host.split('.').count() == 4 && host.split('.').all(|p| p.parse::<u8>().is_ok());
        let known_inside = INSIDE.iter().any(|part| host.contains(part));
        let unqualified = !host.is_empty() && !host.contains('.');
        (numeric || known_inside || unqualified)
            .then(|| format!("names the host {host}, which only one network has"))
    })
}

/// A package source other than crates.io.
fn other_registry(path: &str, text: &str) -> Option<String> {
    let text = text.trim();
    let redirects = path.contains(".cargo/") && REDIRECTS.iter().any(|key| text.starts_with(key));
    let locked = path.ends_with("Cargo.lock")
        && text.starts_with("source = ")
        && text != format!("source = \"{REGISTRY}\"");
    (redirects || locked).then(|| "names a package source other than crates.io".to_owned())
}

#[cfg(test)]
mod tests {
    use super::super::assert_finds;
    use super::*;

    /// An absolute path that this file itself does not name.
    fn absolute(path: &str) -> String {
        format!("{}{path}", '/')
    }

    #[test]
    fn paths_of_a_machine() {
        for path in ["work/main", "tmp/x.mcap", "root", "home/me/a"].map(absolute) {
            let text = format!("fine\nlet p = \"{path}\";\n");
            assert_finds(&RULE, &[("a.rs", &text)], &["a.rs:2"]);
        }
        assert_finds(&RULE, &[("a.md", "see C:\\Users\\me")], &["a.md:1"]);
    }

    #[test]
    fn other_slashes() {
        let text =
            "docs/work https://a.org/home a/tmp/b ~/work ../root #!/usr/bin/env /cloth /tmpl m/s\n";
        assert_finds(&RULE, &[("a.md", text)], &[]);
    }

    #[test]
    fn hosts_of_a_network() {
        let url = |host: &str| format!("get https:{}{host}/x", "//");
        for host in ["build", "a.internal:80", "10.0.0.1", "me@artifactory.b.com"].map(url) {
            assert_finds(&RULE, &[("a.md", &host)], &["a.md:1"]);
        }
        assert_finds(&RULE, &[("a.md", "https://mcap.dev/spec and https://docs.rs")], &[]);
    }

    #[test]
    fn one_registry() {
        let good = format!("source = \"{REGISTRY}\"\n");
        assert_finds(&RULE, &[("Cargo.lock", &good)], &[]);
        let other = "source = \"registry+https://a.org/index\"\n";
        assert_finds(&RULE, &[("Cargo.lock", other)], &["Cargo.lock:1"]);
        let config = "[source.crates-io]\nreplace-with = \"b\"\n";
        let found = [".cargo/config.toml:1", ".cargo/config.toml:2"];
        assert_finds(&RULE, &[(".cargo/config.toml", config)], &found);
    }
}
