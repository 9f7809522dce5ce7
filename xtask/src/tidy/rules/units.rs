//! The documentation of a public field of numbers says the unit in round brackets.

use super::Rule;
use crate::tidy::Violation;
use crate::tidy::tokens::tokens;
use crate::tidy::tree::Tree;

pub(crate) const RULE: Rule = Rule {
    says: "public fields of f64 say their unit in round brackets: (m), (kg/m²), (1)",
    check,
};

/// Types made of f64.
const NUMBERS: &[&str] = &["f64", "World3", "Material2", "Vector2", "Vector3"];
/// Symbols that units are made of.
const SYMBOLS: &[&str] = &[
    "m", "mm", "cm", "km", "px", "s", "ms", "ns", "kg", "g", "N", "J", "W", "Pa", "Hz", "rad", "°",
    "K", "bytes", "degrees", "pixels",
];
/// What stands for no unit. Others say so in words: "(no unit)", "(unit of the values)".
const NONE: &[&str] = &["1", "dimensionless"];
const POWERS: &[char] = &['²', '³', '⁴', '⁻', '¹'];

fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    for (file, source) in tree.product() {
        let code: Vec<&str> = source.product_code.lines().collect();
        let text: Vec<&str> = file.text.lines().collect();
        for (i, line) in code.iter().enumerate() {
            let Some((name, rest)) = public_field(line) else { continue };
            let kind = tokens(rest);
            let is_function = kind.iter().any(|t| ["fn", "Fn", "FnMut"].contains(&t.text));
            if is_function || !kind.iter().any(|t| NUMBERS.contains(&t.text)) {
                continue;
            }
            if !has_unit(&documentation(&text[..i])) {
                let what = format!("`{name}`: its documentation says no unit, such as (m) or (1)");
                violations.push(Violation::new(&file.path, i + 1, what));
            }
        }
    }
    violations
}

/// Name and type of a line `pub name: type,`.
fn public_field(line: &str) -> Option<(&str, &str)> {
    let (name, kind) = line.trim().strip_prefix("pub ")?.split_once(':')?;
    let is_name = name.chars().all(|c| c.is_alphanumeric() || c == '_');
    (is_name && !kind.starts_with(':')).then_some((name, kind))
}

/// The `///` lines above a field, with attributes in between.
fn documentation(above: &[&str]) -> String {
    let mut lines = Vec::new();
    let mut in_attribute = false;
    for line in above.iter().rev().map(|line| line.trim()) {
        if let Some(text) = line.strip_prefix("///") {
            lines.push(text);
        } else if line.starts_with("#[") {
            in_attribute = false;
        } else if in_attribute || line.ends_with(")]") {
            in_attribute = true;
        } else {
            break;
        }
    }
    lines.reverse();
    lines.join(" ")
}

/// True if some round brackets hold a unit, alone or followed by more after a comma or semicolon.
fn has_unit(text: &str) -> bool {
    text.match_indices('(').any(|(open, _)| {
        let inside = &text[open + 1..];
        let mut depth = 1;
        let end = inside.find(|c| {
            depth += i32::from(c == '(') - i32::from(c == ')');
            depth == 0 || (depth == 1 && (c == ',' || c == ';'))
        });
        end.is_some_and(|end| is_unit(inside[..end].trim()))
    })
}

/// True for `m`, `kg/m²`, `kg/(m² s)`, `N·m`, `1/m`, for what stands for no unit, and for words about
/// the unit.
fn is_unit(text: &str) -> bool {
    let product = text.strip_prefix("1/").unwrap_or(text);
    let is_symbol = |part: &str| SYMBOLS.contains(&part.trim_end_matches(POWERS));
    let mut parts = product.split(['/', ' ', '·', '(', ')']).filter(|part| !part.is_empty());
    let left_open = text.split(' ').any(|word| word == "unit");
    left_open || NONE.contains(&text) || (!text.is_empty() && parts.all(is_symbol))
}

#[cfg(test)]
mod tests {
    use super::super::assert_finds;
    use super::*;

    #[test]
    fn units() {
        for unit in ["m", "m/s²", "kg/m²", "kg/(m² s)", "N·m", "N m", "1/m", "1", "rad", "no unit"]
        {
            assert!(is_unit(unit), "{unit}");
        }
        for other in ["", "metres", "x", "in (0", "m or s", "1 to 2", "Koh2014"] {
            assert!(!is_unit(other), "{other}");
        }
    }

    #[test]
    fn brackets() {
        assert!(has_unit("Position (m)."));
        assert!(has_unit("Where to (see below) and how stiffly (N/m)"));
        assert!(has_unit("Focal length (px; both axes)") && has_unit("Ratio, in (0, 1] (1)."));
        assert!(!has_unit("Position [m].") && !has_unit("Position (metres)"));
    }

    #[test]
    fn fields_of_numbers_need_one() {
        let text = "//! A.\npub struct S {\n    /// Width (m).\n    pub a: f64,\n    /// Width.\n    \
                    pub b: Vec<Vector3<f64>>,\n    /// How many.\n    pub n: usize,\n    c: f64,\n    \
                    /// Load (N).\n    #[serde(\n        default\n    )]\n    pub d: Option<f64>,\n    \
                    pub e: [f64; 2],\n    /// Law.\n    pub f: fn(f64) -> f64,\n}\n";
        let found = ["crates/a/src/b.rs:6", "crates/a/src/b.rs:15"];
        assert_finds(&RULE, &[("crates/a/src/b.rs", text), ("xtask/src/b.rs", text)], &found);
    }
}
