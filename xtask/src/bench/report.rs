//! Named figures, written as JSON and as a table.

use super::machine::Machine;
use super::statistics::{mean, median, spread};
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// One measured number.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Figure {
    /// In `unit`.
    value: f64,
    unit: &'static str,
    /// Smallest and largest of what `value` was made of.
    spread: [f64; 2],
    /// How many numbers `value` was made of.
    n: usize,
    /// What one must know to understand the value.
    note: String,
}

impl Figure {
    /// The median of repeated measurements; `None` if there are none.
    pub(super) fn median(values: &[f64], unit: &'static str, note: &str) -> Option<Figure> {
        Figure::of(median(values), values, unit, note)
    }

    /// The mean of different things, such as frames; `None` if there are none.
    pub(super) fn mean(values: &[f64], unit: &'static str, note: &str) -> Option<Figure> {
        Figure::of(mean(values), values, unit, note)
    }

    /// The root mean square of different things; `None` if there are none.
    pub(super) fn rms(values: &[f64], unit: &'static str, note: &str) -> Option<Figure> {
        let squares: Vec<f64> = values.iter().map(|x| x * x).collect();
        Figure::of(mean(&squares).map(f64::sqrt), values, unit, note)
    }

    /// A number that every repetition would give again.
    pub(super) fn exact(value: f64, unit: &'static str, note: &str) -> Option<Figure> {
        Figure::of(Some(value), &[value], unit, note)
    }

    fn of(value: Option<f64>, values: &[f64], unit: &'static str, note: &str) -> Option<Figure> {
        let (value, spread, n) = (value?, spread(values)?, values.len());
        Some(Figure { value, unit, spread, n, note: note.to_owned() })
    }

    fn json(&self) -> Value {
        let Figure { value, unit, spread, n, note } = self;
        json!({ "value": value, "unit": unit, "spread": spread, "n": n, "note": note })
    }
}

/// The figures of a benchmark run.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Report {
    machine: Machine,
    commit: Option<String>,
    figures: Vec<(String, Figure)>,
    /// What was left out, and why.
    remarks: Vec<String>,
}

impl Report {
    pub(super) fn new(machine: Machine, commit: Option<String>) -> Report {
        Report { machine, commit, figures: Vec::new(), remarks: Vec::new() }
    }

    /// Adds a figure under a dotted name, in place of an earlier one of that name. One that could
    /// not be measured is left out.
    pub(super) fn add(&mut self, name: &str, figure: Option<Figure>) {
        let Some(figure) = figure else {
            return self.remark(&format!("{name} is left out: there was nothing to measure"));
        };
        self.figures.retain(|(other, _)| other != name);
        self.figures.push((name.to_owned(), figure));
    }

    /// The value of a figure that has been added.
    pub(super) fn value(&self, name: &str) -> Option<f64> {
        self.figures.iter().find(|(other, _)| other == name).map(|(_, figure)| figure.value)
    }

    /// Adds a sentence on what was left out.
    pub(super) fn remark(&mut self, remark: &str) {
        self.remarks.push(remark.to_owned());
    }

    /// The report as a JSON document: `machine`, `commit`, `figures` by name, `remarks`. A spread is
    /// `[smallest, largest]`.
    pub(super) fn json(&self) -> String {
        let figures: Map<String, Value> =
            self.figures.iter().map(|(name, figure)| (name.clone(), figure.json())).collect();
        let document = json!({
            "machine": self.machine.json(),
            "commit": self.commit,
            "figures": figures,
            "remarks": self.remarks,
        });
        format!("{document:#}\n")
    }

    /// The figures as a table, with each note once below it.
    pub(super) fn table(&self) -> String {
        let mut notes: Vec<&str> = Vec::new();
        let width = self.figures.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        let mut out = String::new();
        for (name, figure) in &self.figures {
            let Figure { value, unit, spread: [low, high], n, note } = figure;
            let place = notes.iter().position(|other| other == note).unwrap_or_else(|| {
                notes.push(note);
                notes.len() - 1
            });
            let spread = if n > &1 {
                format!("{} to {}, n = {n}", short(*low), short(*high))
            } else {
                String::new()
            };
            let line =
                format!("{name:width$} {:>10} {unit:<6} [{}] {spread}", short(*value), place + 1);
            // Writing to a String cannot fail.
            let _ = writeln!(out, "{}", line.trim_end());
        }
        for (number, note) in (1..).zip(&notes) {
            let _ = write!(out, "\n[{number}] {note}");
        }
        for remark in &self.remarks {
            let _ = write!(out, "\n{remark}");
        }
        out
    }
}

/// Four significant digits, or all digits of a large number before its point.
fn short(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    if x.abs() < 1e-4 {
        return format!("{x:.3e}");
    }
    let digits = (3.0 - x.abs().log10().floor()).max(0.0) as usize;
    format!("{x:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report() -> Report {
        let mut report = Report::new(Machine::default(), Some("abc-dirty".into()));
        report.add("flag.time", Figure::median(&[3.0, 1.0, 2.5], "s", "of \"all\"\nframes"));
        report.add("flag.error", Figure::mean(&[0.25, 0.75, 2.0], "m", "over frames"));
        report.add("flag.faces", Figure::exact(12345.0, "1", "over frames"));
        report
    }

    #[test]
    fn json_reads_back() {
        let json: Value = serde_json::from_str(&report().json()).unwrap();
        let time = &json["figures"]["flag.time"];
        assert_eq!(time["value"], 2.5);
        assert_eq!(time["unit"], "s");
        assert_eq!(time["spread"], json!([1.0, 3.0]));
        assert_eq!(time["n"], 3);
        assert_eq!(time["note"], "of \"all\"\nframes");
        assert_eq!(json["figures"]["flag.error"]["value"], 1.0);
        assert_eq!(json["figures"]["flag.faces"]["n"], 1);
        assert_eq!(json["commit"], "abc-dirty");
        assert_eq!(json["machine"]["cores"], Value::Null);
        assert_eq!(json["remarks"], json!([]));
    }

    #[test]
    fn what_was_not_measured_is_no_figure() {
        let mut report = report();
        report.add("flag.none", Figure::median(&[], "s", ""));
        let json: Value = serde_json::from_str(&report.json()).unwrap();
        assert!(json["figures"].get("flag.none").is_none());
        assert!(json["remarks"][0].as_str().unwrap().contains("flag.none"));
    }

    #[test]
    fn a_name_has_one_figure() {
        let mut report = report();
        report.add("flag.faces", Figure::exact(7.0, "1", ""));
        let json: Value = serde_json::from_str(&report.json()).unwrap();
        assert_eq!(json["figures"]["flag.faces"]["value"], 7.0);
        assert_eq!(report.table().matches("flag.faces").count(), 1);
    }

    #[test]
    fn the_table_tells_spread_and_notes_once() {
        let table = report().table();
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines[0], "flag.time       2.500 s      [1] 1.000 to 3.000, n = 3");
        assert_eq!(lines[2], "flag.faces      12345 1      [2]");
        assert_eq!(table.matches("over frames").count(), 1);
    }

    #[test]
    fn numbers_are_short() {
        for (x, text) in [
            (0.0, "0"),
            (2.0, "2.000"),
            (-0.012345, "-0.01235"),
            (123.456, "123.5"),
            (123456.7, "123457"),
            (1.5e-7, "1.500e-7"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(short(x), text);
        }
    }
}
