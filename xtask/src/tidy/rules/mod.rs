//! The list of rules.

mod ci_script;
mod citations;
mod floors;
mod heads;
mod implementers;
mod leftovers;
mod length;
mod paths;
mod places;
mod quiet;
mod threads;
mod units;
mod unsafe_code;

use super::Violation;
use super::tree::Tree;

/// A house rule.
pub(crate) struct Rule {
    /// What it demands, in one line.
    pub(crate) says: &'static str,
    /// Finds what breaks it.
    pub(crate) check: fn(&Tree) -> Vec<Violation>,
}

/// Every rule.
pub(crate) const RULES: &[Rule] = &[
    floors::RULE,
    heads::RULE,
    length::RULE,
    implementers::RULE,
    citations::RULE,
    paths::RULE,
    threads::RULE,
    quiet::RULE,
    unsafe_code::RULE,
    leftovers::RULE,
    places::RULE,
    units::RULE,
    ci_script::RULE,
];

/// Asserts that a rule finds exactly these violations, written `file:line`, in these files.
#[cfg(test)]
fn assert_finds(rule: &Rule, files: &[(&str, &str)], expected: &[&str]) {
    let found = (rule.check)(&Tree::of(files));
    let places: Vec<String> = found.iter().map(|v| format!("{}:{}", v.file, v.line)).collect();
    assert_eq!(places, expected, "{found:#?}");
}
