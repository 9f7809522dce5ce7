//! Figures that tests print: counts over more cases than one would like to repeat here. Quick runs are
//! without them: tests take minutes to compile.

use super::Context;
use super::figure::Figure;
use super::report::Report;
use crate::command::{Failure, say};
use std::process::{Command, Stdio};

/// Adds `contact.ccd.false_negatives` and `contact.tangles.resolved`.
///
/// # Errors
/// If Cargo cannot be started, or a test tells nothing.
pub(super) fn contact(context: &Context, report: &mut Report) -> Result<(), Failure> {
    if is_left_out(context, report, "contact.ccd and contact.tangles") {
        return Ok(());
    }
    let told = told_by(context, "collision", "ccd")?;
    let counts = |key: &str| told.lines().filter_map(|line| count_after(line, key)).sum::<u64>();
    let (hits, missed) = (counts("hits: "), counts(" missed: "));
    let note = format!("Of {hits} queries that hit, by exact arithmetic or by construction.");
    say(format!("continuous collision: {missed} of {hits} hits are missed"));
    let missed = (hits > 0).then_some(missed as f64);
    report.add("contact.ccd.false_negatives", missed.and_then(|n| Figure::exact(n, "1", &note)));

    let told = told_by(context, "organza", "tangles")?;
    let (free, all) = resolved(&told);
    say(format!("tangles: {free} of {all} come apart"));
    let note = format!("Of {all} generated tangles, free of crossings within 50 frames.");
    let free = (all > 0).then_some(free as f64);
    report.add("contact.tangles.resolved", free.and_then(|n| Figure::exact(n, "1", &note)));
    Ok(())
}

/// Adds `view.coarse_sag.plain` and `.tension_field`.
///
/// # Errors
/// If Cargo cannot be started.
pub(super) fn sag(context: &Context, report: &mut Report) -> Result<(), Failure> {
    if is_left_out(context, report, "view.coarse_sag") {
        return Ok(());
    }
    let told = told_by(context, "cloth-dynamics", "tension_field")?;
    let [fine, plain, wrinkled] = ["fine ", "coarse ", "wrinkled "]
        .map(|key| told.lines().find_map(|l| metres_after(l, key)));
    let error = |coarse: Option<f64>| Some((coarse? - fine?).abs());
    for (name, coarse, who) in
        [("plain", plain, "as it is"), ("tension_field", wrinkled, "with compression let go")]
    {
        let note = format!(
            "Of the height at which a sheet of one metre hangs between two corners 0.8 m apart, with 4 x 4 \
             cells, {who}; against 24 x 24 cells."
        );
        let figure = error(coarse).and_then(|error| Figure::exact(error, "m", &note));
        report.add(&format!("view.coarse_sag.{name}"), figure);
    }
    Ok(())
}

/// Whether a run is quick, and says then what it is without.
fn is_left_out(context: &Context, report: &mut Report, figures: &str) -> bool {
    if context.options.quick {
        report.remark(&format!("{figures} are told by tests and left out of quick runs."));
    }
    context.options.quick
}

/// What a test of a package prints, whether it passes or fails.
fn told_by(context: &Context, package: &str, test: &str) -> Result<String, Failure> {
    say(format!("test `{test}` of {package}"));
    let output = Command::new("cargo")
        .args(["test", "--release", "--package", package, "--test", test, "--", "--nocapture"])
        .current_dir(&context.root)
        .stderr(Stdio::null())
        .output()
        .map_err(|error| Failure::Unable(format!("cannot start cargo: {error}")))?;
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// The whole number behind a key, of lines that belong to a tally.
fn count_after(line: &str, key: &str) -> Option<u64> {
    let (_, rest) = line.split_once("Tally {")?.1.split_once(key)?;
    rest.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()
}

/// The length behind a key, of the line that tells how far sheets hang down.
fn metres_after(line: &str, key: &str) -> Option<f64> {
    let (_, rest) = line.split_once("below the corners: ")?.1.split_once(key)?;
    rest.split_once(" m")?.0.parse().ok()
}

/// Tangles that came apart, and all.
fn resolved(told: &str) -> (usize, usize) {
    let free = told.lines().filter(|line| line.contains(" gone in ")).count();
    let stuck = told.lines().filter(|line| line.contains(" does not: [")).count();
    (free, free + stuck)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_stand_behind_their_keys() {
        let line = "near     Tally { hits: 66801, missed: 3, late: 0 }";
        assert_eq!(
            (count_after(line, "hits: "), count_after(line, " missed: ")),
            (Some(66801), Some(3))
        );
        assert_eq!(count_after("hits: 3", "hits: "), None);
        let line = "below the corners: fine 0.53 m, coarse 0.52 m, wrinkled 0.54 m";
        assert_eq!(metres_after(line, "coarse "), Some(0.52));
        let told = "loop: 0.5 m gone in 3 frames\nbump does not: [1.0] m\ntest a ... ok\n";
        assert_eq!(resolved(told), (1, 2));
    }
}
