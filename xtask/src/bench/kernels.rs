//! What criterion measured: the kernels of `benches`, taken from what `cargo bench` left.

use super::figure::Figure;
use super::report::Report;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// Adds a figure `kernels.…` for every estimate that criterion left below Cargo's target folder.
pub(super) fn take(report: &mut Report, root: &Path) {
    let named = |variable: &str| std::env::var_os(variable).map(PathBuf::from);
    let target = named("CARGO_TARGET_DIR").unwrap_or_else(|| root.join("target"));
    let folder = named("CRITERION_HOME").unwrap_or_else(|| target.join("criterion"));
    let mut found = Vec::new();
    collect(&folder, &mut found);
    found.sort();
    if found.is_empty() {
        report.remark(
            "No kernels: `cargo bench` has left nothing. Run it first to have them in the report.",
        );
    }
    for path in found {
        match estimate(&path) {
            Some((name, figure)) => report.add(&name, Some(figure)),
            None => report.remark(&format!(
                "An estimate of criterion is left out, as it cannot be read: {}",
                path.strip_prefix(&folder).unwrap_or(&path).display()
            )),
        }
    }
}

/// The folders `new` with an estimate of the last measurement.
fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            if path.ends_with("new") && path.join("estimates.json").is_file() {
                found.push(path);
            } else {
                collect(&path, found);
            }
        }
    }
}

/// Name and figure of one measurement.
fn estimate(folder: &Path) -> Option<(String, Figure)> {
    let path = folder.join("estimates.json");
    let read = |path: &Path| serde_json::from_str(&fs::read_to_string(path).ok()?).ok();
    let (estimates, sample): (Value, Option<Value>) =
        (read(&path)?, read(&folder.join("sample.json")));
    let named: Value = read(&folder.join("benchmark.json"))?;
    let n = sample.and_then(|s| Some(s["times"].as_array()?.len())).unwrap_or(1);
    let age = fs::metadata(&path).ok()?.modified().ok()?;
    let name = named["full_id"].as_str()?.replace('/', ".").replace(' ', "_");
    Some((format!("kernels.{name}"), figure(&estimates, n, age)?))
}

fn figure(estimates: &Value, n: usize, measured: SystemTime) -> Option<Figure> {
    let median = &estimates["median"];
    let interval = &median["confidence_interval"];
    // Criterion writes nanoseconds.
    let seconds = |value: &Value| value.as_f64().map(|ns| ns * 1e-9);
    let spread = [seconds(&interval["lower_bound"])?, seconds(&interval["upper_bound"])?];
    let day = measured.duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs() / 86_400);
    let (year, month, day) = date(day);
    let note = format!(
        "Wall time of one call: criterion's median and its confidence interval. Measured by \
         `cargo bench` on {year}-{month:02}-{day:02}, with the code as it was then."
    );
    Some(Figure::told(seconds(&median["point_estimate"])?, spread, n, "s", &note))
}

/// Year, month and day in the Gregorian calendar, of days since 1970-01-01.
fn date(days: u64) -> (u64, u64, u64) {
    // Years from March on: leap days come last. Eras have 400 years, 146 097 days.
    let z = days + 719_468;
    let (era, of_era) = (z / 146_097, z % 146_097);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let from_march = (5 * of_year + 2) / 153;
    let month = if from_march < 10 { from_march + 3 } else { from_march - 9 };
    (era * 400 + year + u64::from(month <= 2), month, of_year - (153 * from_march + 2) / 5 + 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn dates() {
        assert_eq!(date(0), (1970, 1, 1));
        assert_eq!(date(59), (1970, 3, 1));
        assert_eq!(date(11_016), (2000, 2, 29));
        assert_eq!(date(20_818), (2026, 12, 31));
    }

    #[test]
    fn nanoseconds_become_seconds() {
        let text = r#"{ "median": { "point_estimate": 2.5e6, "standard_error": 1,
            "confidence_interval": { "lower_bound": 2e6, "upper_bound": 3e6 } } }"#;
        let estimates = serde_json::from_str(text).unwrap();
        let at = UNIX_EPOCH + Duration::from_secs(86_400);
        let figure = figure(&estimates, 100, at).unwrap();
        assert!((figure.value - 2.5e-3).abs() < 1e-15);
        assert!((figure.spread[1] - 3e-3).abs() < 1e-15);
        assert!(figure.note.contains("1970-01-02"));
        assert_eq!(super::figure(&serde_json::json!({}), 1, at), None);
    }

    #[test]
    fn only_the_last_measurement_of_each_is_found() {
        let top = std::env::temp_dir().join(format!("xtask-kernels-{}", std::process::id()));
        for folder in ["group/one/new", "group/one/base", "two/new", "two/change"] {
            let folder = top.join(folder);
            fs::create_dir_all(&folder).unwrap();
            fs::write(folder.join("estimates.json"), "{}").unwrap();
        }
        let mut found = Vec::new();
        collect(&top, &mut found);
        found.sort();
        fs::remove_dir_all(&top).unwrap();
        assert_eq!(found, [top.join("group/one/new"), top.join("two/new")]);
    }
}
