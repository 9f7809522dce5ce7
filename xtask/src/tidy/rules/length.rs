//! Files stay short enough to be read in one go.

use super::Rule;
use crate::tidy::Violation;
use crate::tidy::tree::Tree;

pub(crate) const RULE: Rule = Rule { says: "code files have at most 500 lines", check };

const MOST_LINES: usize = 500;

fn check(tree: &Tree) -> Vec<Violation> {
    let is_code = |path: &str| [".rs", ".py", ".sh"].iter().any(|end| path.ends_with(end));
    let too_long = |(path, n): (&str, usize)| {
        let what = format!("{n} lines; a file has at most {MOST_LINES}");
        (n > MOST_LINES).then(|| Violation::new(path, MOST_LINES + 1, what))
    };
    let files = tree.texts().filter(|f| is_code(&f.path));
    files.map(|f| (&*f.path, f.text.lines().count())).filter_map(too_long).collect()
}

#[cfg(test)]
mod tests {
    use super::super::assert_finds;
    use super::*;

    #[test]
    fn the_limit_itself_is_allowed() {
        let (full, over) = ("x\n".repeat(MOST_LINES), "x\n".repeat(MOST_LINES + 1));
        let files = [("a.rs", &*full), ("b.rs", &over), ("c.py", &over), ("d.json", &over)];
        assert_finds(&RULE, &files, &["b.rs:501", "c.py:501"]);
    }
}
