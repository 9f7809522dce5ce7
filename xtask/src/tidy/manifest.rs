//! What a `Cargo.toml` says about the crate's name and dependencies.
//!
//! Reads the plain TOML that manifests are written in: tables, one key per line.

/// A dependency line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Dependency {
    /// The package, also where the crate renames it.
    pub(crate) package: String,
    /// Counted from 1.
    pub(crate) line: usize,
}

/// The manifest of a crate.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Manifest {
    /// Name of the package; empty in the manifest of a workspace.
    pub(crate) name: String,
    /// All dependencies: normal, for tests, for build scripts, for targets.
    pub(crate) dependencies: Vec<Dependency>,
}

impl Manifest {
    pub(crate) fn parse(text: &str) -> Manifest {
        let mut manifest = Manifest::default();
        let mut table = String::new();
        for (i, line) in text.lines().enumerate() {
            let (line, number) = (line.split(" #").next().unwrap_or("").trim(), i + 1);
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            if let Some(name) = line.strip_prefix('[') {
                table = name.trim_end_matches(']').trim().replace(['"', '\''], "");
                // [dependencies.name]
                if let Some((kind, package)) = table.rsplit_once('.')
                    && is_dependencies(kind)
                {
                    let package = package.to_owned();
                    manifest.dependencies.push(Dependency { package, line: number });
                }
                continue;
            }
            let Some((key, value)) = line.split_once('=') else { continue };
            let name = key.split('.').next().unwrap_or("").trim().trim_matches('"').to_owned();
            if table == "package" && name == "name" {
                manifest.name = string(value);
            } else if is_dependencies(&table) {
                let renamed = value.split_once("package").and_then(|(_, v)| v.split_once('='));
                let package = renamed.map_or(name, |(_, v)| string(v));
                manifest.dependencies.push(Dependency { package, line: number });
            } else if let Some((kind, _)) = table.rsplit_once('.')
                && is_dependencies(kind)
                && name == "package"
                && let Some(last) = manifest.dependencies.last_mut()
            {
                last.package = string(value);
            }
        }
        manifest
    }
}

fn is_dependencies(table: &str) -> bool {
    let last = table.rsplit('.').next().unwrap_or("");
    let known = ["dependencies", "dev-dependencies", "build-dependencies"].contains(&last);
    known && !table.starts_with("workspace")
}

/// The first quoted text of a value.
fn string(value: &str) -> String {
    value.split(['"', '\'']).nth(1).unwrap_or("").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_ways_to_write_a_dependency() {
        let text = r#"
[package]
name = "a"  # the name
version.workspace = true

[dependencies]
b.workspace = true
c = { workspace = true, features = ["x"] }
# d = "1"
e = { package = "real-e", version = "1" }

[dependencies.f]
version = "1"

[dev-dependencies.g]
package = "real-g"

[target.'cfg(unix)'.build-dependencies]
h = "1"

[features]
i = []
"#;
        let manifest = Manifest::parse(text);
        assert_eq!(manifest.name, "a");
        let found: Vec<(&str, usize)> =
            manifest.dependencies.iter().map(|d| (&*d.package, d.line)).collect();
        let expected = [("b", 7), ("c", 8), ("real-e", 10), ("f", 12), ("real-g", 15), ("h", 19)];
        assert_eq!(found, expected);
    }

    #[test]
    fn the_table_of_the_workspace_is_not_a_crates_own() {
        let manifest = Manifest::parse("[workspace.dependencies]\na = \"1\"\n");
        assert_eq!(manifest, Manifest::default());
    }
}
