//! `.ci/run`, `cargo xtask ci` and the README make the same checks.

use super::Rule;
use crate::ci::STEPS;
use crate::tidy::Violation;
use crate::tidy::tree::Tree;

pub(crate) const RULE: Rule =
    Rule { says: ".ci/run makes the checks of `cargo xtask ci`, in that order", check };

const SCRIPT: &str = ".ci/run";
const README: &str = "README.md";

fn check(tree: &Tree) -> Vec<Violation> {
    let mut violations = Vec::new();
    let lines: Vec<&str> = tree.text(SCRIPT).unwrap_or("").lines().map(str::trim).collect();
    let mut from = 0;
    for step in STEPS {
        match lines[from..].iter().position(|line| line.ends_with(step)) {
            Some(at) => from += at + 1,
            None => {
                let what = format!("does not run `{step}` after line {from}");
                violations.push(Violation::new(SCRIPT, 0, what));
            }
        }
    }
    let tests = STEPS[STEPS.len() - 1];
    if !tree.text(README).unwrap_or("").lines().any(|line| line.trim() == tests) {
        violations.push(Violation::new(README, 0, format!("does not show `{tests}`")));
    }
    violations
}

#[cfg(test)]
mod tests {
    use super::super::assert_finds;
    use super::*;

    #[test]
    fn the_same_steps_in_the_same_order() {
        let readme = (README, &*format!("Tests:\n\n    {}\n", STEPS[2]));
        let whole = STEPS.map(|step| format!("run {step}\n")).concat();
        assert_finds(&RULE, &[(SCRIPT, &whole), readme], &[]);
        let turned = format!("run {}\nrun {}\nrun {}\n", STEPS[1], STEPS[0], STEPS[2]);
        assert_finds(&RULE, &[(SCRIPT, &turned), readme], &[".ci/run:0"]);
        assert_finds(&RULE, &[(SCRIPT, &whole)], &["README.md:0"]);
    }
}
