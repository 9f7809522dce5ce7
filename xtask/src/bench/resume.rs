//! Going on where an earlier run was stopped.

use super::provenance::Provenance;
use super::report::Report;

/// The report to begin with: what an earlier run in the same folder has measured under the same
/// circumstances, without what is to be measured again. `suites` are those asked for.
pub(super) fn start(
    earlier: Option<Report>,
    provenance: Provenance,
    suites: &[&str],
    fresh: bool,
) -> Report {
    let usable = |report: &Report| !fresh && report.provenance.is_same(&provenance);
    let Some(mut report) = earlier.filter(usable) else { return Report::new(provenance) };
    if report.complete {
        // A new run of what was finished is a new measurement; other suites stay.
        suites.iter().for_each(|suite| report.forget_suite(suite));
    }
    report.complete = false;
    report
}

#[cfg(test)]
mod tests {
    use super::super::figure::Figure;
    use super::*;
    use serde_json::json;

    fn provenance(commit: &str) -> Provenance {
        let document = json!({ "machine": {}, "commit": commit, "changes": null, "options": {} });
        Provenance::read(&document).unwrap()
    }

    /// The suite `a` is finished, of `b` one part.
    fn stopped() -> Report {
        let mut report = Report::new(provenance("1"));
        let top = report.begin("a");
        report.add("a.x", Figure::exact(1.0, "1", ""));
        report.finish(top);
        let top = report.begin("b");
        let around = report.begin("b/one");
        report.add("b.one", Figure::exact(1.0, "1", ""));
        report.finish(around);
        report.add("b.rest", Figure::exact(1.0, "1", ""));
        // Stopped here; what is on disk does not know what was being measured.
        drop(top);
        Report::read(&report.json()).unwrap()
    }

    #[test]
    fn a_stopped_run_keeps_what_was_finished() {
        let mut report = start(Some(stopped()), provenance("1"), &["a", "b"], false);
        assert!(report.is_finished("a") && report.is_finished("b/one") && !report.is_finished("b"));
        let top = report.begin("b");
        let names: Vec<&str> = report.figures().map(|(name, _)| name).collect();
        assert_eq!(names, ["a.x", "b.one"]);
        assert!(!report.all_is_finished());
        report.finish(top);
        assert!(report.all_is_finished());
    }

    #[test]
    fn a_complete_run_keeps_what_is_not_asked_for_again() {
        let mut complete = stopped();
        complete.complete = true;
        let report = start(Some(complete), provenance("1"), &["b"], false);
        assert!(report.is_finished("a") && !report.is_finished("b/one") && !report.complete);
        assert_eq!(report.figures().count(), 1);
    }

    #[test]
    fn other_circumstances_start_over() {
        let other = start(Some(stopped()), provenance("2"), &["a"], false);
        let fresh = start(Some(stopped()), provenance("1"), &["a"], true);
        let first = start(None, provenance("1"), &["a"], false);
        assert!([other, fresh, first].iter().all(|report| report.figures().count() == 0));
    }
}
