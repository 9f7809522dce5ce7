//! A crate may only use crates on lower floors, also in its tests.

use super::Rule;
use crate::tidy::Violation;
use crate::tidy::manifest::Manifest;
use crate::tidy::tree::Tree;

pub(crate) const RULE: Rule =
    Rule { says: "crates only use crates on lower floors (ARCHITECTURE.md)", check };

/// The floor of every crate of the workspace.
const FLOORS: &[(&str, u32)] = &[
    ("mesh-core", 0),
    ("arps", 0),
    ("remesh", 1),
    ("cloth-dynamics", 1),
    ("io-mcap", 1),
    ("collision", 1),
    ("sph", 1),
    ("sph", 1),
    ("mannequin", 1),
    ("sizing-view", 2),
    ("organza", 3),
    // Around the building: they may use everything and nothing uses them.
    ("xtask", 4),
    ("organza-benches", 4),
    // Outside of the workspace.
    ("salva-dam-break", 4),
    ("organza-tests", 5),
];

fn floor(package: &str) -> Option<u32> {
    FLOORS.iter().find(|(name, _)| *name == package).map(|&(_, floor)| floor)
}

fn check(tree: &Tree) -> Vec<Violation> {
    let manifests: Vec<(&str, Manifest)> = tree
        .texts()
        .filter(|f| f.path.ends_with("/Cargo.toml"))
        .map(|f| (&*f.path, Manifest::parse(&f.text)))
        .collect();
    let is_ours = |package: &str| manifests.iter().any(|(_, m)| m.name == package);
    let mut violations = Vec::new();
    for (path, manifest) in &manifests {
        let name = &manifest.name;
        let Some(own) = floor(name) else {
            let what = format!("crate `{name}` has no floor: add it to xtask's table of floors");
            violations.push(Violation::new(*path, 1, what));
            continue;
        };
        for dependency in manifest.dependencies.iter().filter(|d| is_ours(&d.package)) {
            let package = &dependency.package;
            if let Some(other) = floor(package)
                && other >= own
            {
                let what = format!("`{name}` on floor {own} uses `{package}` on floor {other}");
                violations.push(Violation::new(*path, dependency.line, what));
            }
        }
    }
    violations
}

#[cfg(test)]
mod tests {
    use super::super::assert_finds;
    use super::*;

    const CORE: (&str, &str) = ("crates/mesh-core/Cargo.toml", "[package]\nname = \"mesh-core\"\n");
    const REMESH: (&str, &str) = (
        "crates/remesh/Cargo.toml",
        "[package]\nname = \"remesh\"\n[dependencies]\nmesh-core.workspace = true\n",
    );

    #[test]
    fn down_is_allowed() {
        assert_finds(&RULE, &[CORE, REMESH], &[]);
    }

    #[test]
    fn sideways_and_up_are_not() {
        let sideways =
            "[package]\nname = \"cloth-dynamics\"\n[dev-dependencies]\nremesh.workspace = true\n";
        let up =
            "[package]\nname = \"mesh-core\"\n[dependencies]\nremesh = { path = \"../remesh\" }\n";
        let files = [("crates/a/Cargo.toml", sideways), ("crates/b/Cargo.toml", up), REMESH];
        assert_finds(&RULE, &files, &["crates/a/Cargo.toml:4", "crates/b/Cargo.toml:4"]);
    }

    #[test]
    fn every_crate_needs_a_floor() {
        let files = [("crates/new/Cargo.toml", "[package]\nname = \"new\"\n")];
        assert_finds(&RULE, &files, &["crates/new/Cargo.toml:1"]);
    }

    #[test]
    fn crates_of_others_have_none() {
        let text = "[package]\nname = \"mesh-core\"\n[dependencies]\nnalgebra.workspace = true\n";
        assert_finds(&RULE, &[("crates/mesh-core/Cargo.toml", text)], &[]);
    }
}
