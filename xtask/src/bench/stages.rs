//! Figures of where the time of a frame goes.

use super::figure::Figure;
use super::program::Measured;
use super::report::Report;

/// Adds figures `NAME.stage_s.STAGE.VARIANT` for every stage that the runs tell; the page draws them as
/// bars of shares, one for each variant.
pub(super) fn add(report: &mut Report, name: &str, variant: &str, runs: &[Measured]) {
    let Some(first) = runs.first() else { return };
    let note = "Wall seconds a frame, longer than CPU seconds on a machine that others use; median of \
                the runs.";
    for stage in first.info.stages() {
        let pointer = format!("/seconds/{stage}");
        let values: Vec<f64> = runs.iter().map(|run| run.info.mean(&pointer)).collect();
        report
            .add(&format!("{name}.stage_s.{stage}.{variant}"), Figure::median(&values, "s", note));
    }
}
