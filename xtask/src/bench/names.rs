//! The names of figures: every suite lists its own, and what documents say of speed and accuracy names
//! one of them.

use super::Benchmark;
use super::report::{Report, suite_of};

/// Says which results of a suite it does not list.
pub(super) fn check(report: &mut Report, suite: &Benchmark) {
    let ours = report.entries.iter().filter(|entry| suite_of(&entry.part) == suite.name);
    let unknown = ours.filter(|entry| !lists(suite, &entry.name));
    let names: Vec<String> = unknown.map(|entry| entry.name.clone()).collect();
    if !names.is_empty() {
        report.remark(&format!("The suite {} does not list {}.", suite.name, names.join(", ")));
    }
}

/// Whether a suite lists a figure.
fn lists(suite: &Benchmark, name: &str) -> bool {
    suite.figures.iter().any(|pattern| fits(pattern, name))
}

/// Whether a name is one of a pattern, where `*` stands for anything without a dot.
fn fits(pattern: &str, name: &str) -> bool {
    let Some((before, after)) = pattern.split_once('*') else { return pattern == name };
    let Some(rest) = name.strip_prefix(before) else { return false };
    let ends = rest.char_indices().map(|(at, _)| at).chain([rest.len()]);
    let mut ends = ends.take_while(|&at| !rest[..at].contains('.'));
    ends.any(|at| at > 0 && fits(after, &rest[at..]))
}

#[cfg(test)]
mod tests {
    use super::super::BENCHMARKS;
    use super::*;

    /// What speaks of figures.
    const DOCUMENTS: [&str; 5] = [
        "README.md",
        "docs/performance.md",
        "docs/validation.md",
        "docs/report.md",
        "docs/decisions.md",
    ];

    fn read(document: &str) -> String {
        let path = format!("{}/../{document}", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
    }

    /// The names of figures in a text: between backticks, beginning like those of a suite. Words in
    /// capitals stand for any.
    fn names(text: &str) -> Vec<String> {
        let families: Vec<&str> = BENCHMARKS
            .iter()
            .flat_map(|suite| suite.figures)
            .filter_map(|figure| figure.split('.').next())
            .collect();
        let any = |word: &str| {
            let is_any = word.chars().all(|c| c.is_ascii_uppercase() || c == '_');
            if is_any { "any".to_owned() } else { word.to_owned() }
        };
        text.split('`')
            .skip(1)
            .step_by(2)
            .filter(|token| token.split_once('.').is_some_and(|(head, _)| families.contains(&head)))
            .filter(|token| !token.ends_with(".mcap") && !token.ends_with(".png"))
            .map(|token| token.split('.').map(any).collect::<Vec<_>>().join("."))
            .collect()
    }

    fn is_known(name: &str) -> bool {
        // A placeholder may stand where a suite has one of a few words.
        let stands_for = |pattern: &str| {
            let (pattern, name) = (pattern.split('.'), name.split('.'));
            pattern.clone().count() == name.clone().count()
                && pattern.zip(name).all(|(p, n)| n == "any" || fits(p, n))
        };
        BENCHMARKS.iter().flat_map(|suite| suite.figures).any(|pattern| stands_for(pattern))
    }

    #[test]
    fn patterns_stay_within_dots() {
        for (pattern, name, expected) in [
            ("a.*.c", "a.b.c", true),
            ("a.*.c", "a.b.b.c", false),
            ("a.*_x", "a.b_c_x", true),
            ("a.*", "a.", false),
            ("a.b", "a.b", true),
            ("a.b", "a.bc", false),
            ("a.*.*", "a.b.c", true),
        ] {
            assert_eq!(fits(pattern, name), expected, "{pattern} {name}");
        }
    }

    #[test]
    fn documents_name_figures_that_a_suite_lists() {
        let mut n = 0;
        for document in DOCUMENTS {
            for name in names(&read(document)) {
                assert!(is_known(&name), "{document}: no suite has `{name}`");
                n += 1;
            }
        }
        assert!(n > 10, "only {n} figures are named");
        assert!(!is_known("pay.any.nothing") && !is_known("nothing.any"));
    }

    #[test]
    fn every_claim_names_its_figure() {
        let text = read("docs/performance.md");
        let (_, claims) = text.split_once("## Claims").expect("a section of claims");
        let claims = claims.split("\n## ").next().unwrap_or_default();
        let rows: Vec<&str> =
            claims.lines().filter(|line| line.starts_with("| ")).skip(1).collect();
        assert!(rows.len() > 5, "{rows:?}");
        for row in rows {
            let figures = row.trim_end_matches('|').rsplit('|').next().unwrap_or_default();
            assert!(!names(figures).is_empty(), "no figure: {row}");
        }
    }
}
