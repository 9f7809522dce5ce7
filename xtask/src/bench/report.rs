//! What benchmarks found: figures, points and tables by name, as JSON and as text.

pub(super) use super::figure::Figure;
use super::number::short;
use super::points::Points;
use super::provenance::Provenance;
use super::table::Table;
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// Version of the JSON document; see `docs/report.md`.
const FORMAT: u64 = 1;

/// Something with a name.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Content {
    Figure(Figure),
    Points(Points),
    Table(Table),
}

/// A named result.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub(super) name: String,
    /// The part of the run that found it: `suite` or `suite/part`.
    pub(super) part: String,
    pub(super) content: Content,
}

/// The results of a benchmark run.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Report {
    pub(super) provenance: Provenance,
    pub(super) entries: Vec<Entry>,
    /// What was left out, and why, after the part that says so.
    pub(super) remarks: Vec<(String, String)>,
    /// Parts that were measured to their end.
    finished: Vec<String>,
    /// True if every suite that is in it was measured to its end.
    pub(super) complete: bool,
    /// The part that is being measured.
    part: String,
}

/// The suite that a part is of.
pub(super) fn suite_of(part: &str) -> &str {
    part.split('/').next().unwrap_or(part)
}

impl Report {
    pub(super) fn new(provenance: Provenance) -> Report {
        Report { provenance, ..Report::default() }
    }

    /// Adds a figure under a dotted name, in place of an earlier one of that name. One that could
    /// not be measured is left out.
    pub(super) fn add(&mut self, name: &str, figure: Option<Figure>) {
        match figure {
            Some(figure) => self.put(name, Content::Figure(figure)),
            None => self.remark(&format!("{name} is left out: there was nothing to measure")),
        }
    }

    /// Adds points under a dotted name. They are drawn as they say, and in the JSON document they
    /// are a figure whose value is the list of (x, y).
    pub(super) fn points(&mut self, name: &str, points: Points) {
        self.put(name, Content::Points(points));
    }

    /// Adds a table under a dotted name.
    pub(super) fn table_of(&mut self, name: &str, table: Table) {
        self.put(name, Content::Table(table));
    }

    /// The value of a figure that has been added.
    pub(super) fn value(&self, name: &str) -> Option<f64> {
        self.figures().find(|(other, _)| *other == name).map(|(_, figure)| figure.value)
    }

    /// Adds a sentence on what was left out.
    pub(super) fn remark(&mut self, remark: &str) {
        self.remarks.push((self.part.clone(), remark.to_owned()));
    }

    fn put(&mut self, name: &str, content: Content) {
        self.entries.retain(|other| other.name != name);
        self.entries.push(Entry { name: name.to_owned(), part: self.part.clone(), content });
    }

    /// True if the part was measured to its end.
    pub(super) fn is_finished(&self, part: &str) -> bool {
        self.finished.iter().any(|p| p == part)
    }

    /// True if every suite of which something is here was measured to its end.
    pub(super) fn all_is_finished(&self) -> bool {
        let parts = self.entries.iter().map(|e| &e.part).chain(&self.finished);
        parts.map(|part| suite_of(part)).all(|suite| self.is_finished(suite))
    }

    /// What follows belongs to this part; what a stopped run left of it goes. The return value is
    /// the part around it.
    pub(super) fn begin(&mut self, part: &str) -> String {
        self.forget(|p| p == part);
        std::mem::replace(&mut self.part, part.to_owned())
    }

    /// The part that is being measured is finished; what follows belongs to the one around it.
    pub(super) fn finish(&mut self, around: String) {
        self.finished.push(std::mem::replace(&mut self.part, around));
    }

    /// Forgets a suite and its parts.
    pub(super) fn forget_suite(&mut self, suite: &str) {
        self.forget(|part| suite_of(part) == suite);
    }

    fn forget(&mut self, gone: impl Fn(&str) -> bool) {
        self.entries.retain(|entry| !gone(&entry.part));
        self.remarks.retain(|(part, _)| !gone(part));
        self.finished.retain(|part| !gone(part));
    }

    /// The figures by name.
    pub(super) fn figures(&self) -> impl Iterator<Item = (&str, &Figure)> {
        self.entries.iter().filter_map(|entry| match &entry.content {
            Content::Figure(figure) => Some((entry.name.as_str(), figure)),
            _ => None,
        })
    }

    /// The tables by name.
    pub(super) fn tables(&self) -> impl Iterator<Item = (&str, &Table)> {
        self.entries.iter().filter_map(|entry| match &entry.content {
            Content::Table(table) => Some((entry.name.as_str(), table)),
            _ => None,
        })
    }

    /// The report as a JSON document, as `docs/report.md` describes it.
    pub(super) fn json(&self) -> String {
        let (mut figures, mut tables) = (Map::new(), Map::new());
        for Entry { name, part, content } in &self.entries {
            let (map, mut json) = match content {
                Content::Figure(figure) => (&mut figures, figure.json()),
                Content::Points(points) => (&mut figures, points.json()),
                Content::Table(table) => (&mut tables, table.json()),
            };
            json["part"] = part.as_str().into();
            map.insert(name.clone(), json);
        }
        let remark = |(part, text): &(String, String)| json!({ "part": part, "text": text });
        let mut document = self.provenance.json();
        document["format"] = FORMAT.into();
        document["complete"] = self.complete.into();
        document["finished"] = self.finished.as_slice().into();
        document["figures"] = figures.into();
        document["tables"] = tables.into();
        document["remarks"] = self.remarks.iter().map(remark).collect();
        format!("{document:#}\n")
    }

    /// Reads what [`Report::json`] made; the error says what is wrong with it.
    pub(super) fn read(text: &str) -> Result<Report, String> {
        let json: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if json["format"] != FORMAT {
            let format = &json["format"];
            return Err(format!("`format` is {format} instead of {FORMAT}: not such a report"));
        }
        let provenance = Provenance::read(&json).ok_or("`machine` or `commit` is missing")?;
        let mut report = Report::new(provenance);
        report.complete = json["complete"].as_bool().ok_or("`complete` is no truth value")?;
        let of = |key: &str| json[key].as_object().ok_or(format!("`{key}` is missing"));
        for (name, value) in of("figures")? {
            let wrong = || format!("`figures.{name}` is no figure");
            let content = if value["value"].is_array() {
                Points::read(value).map(Content::Points)
            } else {
                Figure::read(value).map(Content::Figure)
            };
            let part = value["part"].as_str().ok_or_else(wrong)?.to_owned();
            let content = content.ok_or_else(wrong)?;
            report.entries.push(Entry { name: name.clone(), part, content });
        }
        for (name, value) in of("tables")? {
            let wrong = || format!("`tables.{name}` is no table");
            let part = value["part"].as_str().ok_or_else(wrong)?.to_owned();
            let content = Content::Table(Table::read(value).ok_or_else(wrong)?);
            report.entries.push(Entry { name: name.clone(), part, content });
        }
        for remark in json["remarks"].as_array().ok_or("`remarks` is missing")? {
            let text = |key: &str| remark[key].as_str().map(str::to_owned);
            let both = text("part").zip(text("text"));
            report.remarks.push(both.ok_or("`remarks` holds something else")?);
        }
        for part in json["finished"].as_array().ok_or("`finished` is missing")? {
            let part = part.as_str().ok_or("`finished` holds something else")?;
            report.finished.push(part.to_owned());
        }
        Ok(report)
    }

    /// The figures as text, with each note once below it.
    pub(super) fn text(&self) -> String {
        let mut notes: Vec<&str> = Vec::new();
        let width = self.figures().map(|(name, _)| name.len()).max().unwrap_or(0);
        let mut out = String::new();
        for (name, figure) in self.figures() {
            let Figure { value, unit, spread: [low, high], n, note, .. } = figure;
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
        for (_, remark) in &self.remarks {
            let _ = write!(out, "\n{remark}");
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::super::table::Cell;
    use super::*;

    fn report() -> Report {
        let mut report = Report::new(Provenance::default());
        let around = report.begin("flag");
        report.add("flag.time", Figure::median(&[3.0, 1.0, 2.5], "s", "of \"all\"\nframes"));
        report.add("flag.error", Figure::mean(&[0.25, 0.75, 2.0], "m", "over frames"));
        report.add("flag.faces", Figure::exact(12345.0, "1", "over frames"));
        report.finish(around);
        report
    }

    #[test]
    fn json_says_it_all() {
        let json: Value = serde_json::from_str(&report().json()).unwrap();
        let time = &json["figures"]["flag.time"];
        assert_eq!(time["value"], 2.5);
        assert_eq!(time["unit"], "s");
        assert_eq!(time["spread"], json!([1.0, 3.0]));
        assert_eq!(time["n"], 3);
        assert_eq!(time["part"], "flag");
        assert_eq!(time["note"], "of \"all\"\nframes");
        assert_eq!(json["figures"]["flag.error"]["value"], 1.0);
        assert_eq!(json["figures"]["flag.faces"]["n"], 1);
        assert_eq!(json["machine"]["cores"], Value::Null);
        assert_eq!(json["remarks"], json!([]));
    }

    #[test]
    fn reports_read_back() {
        let mut report = report();
        let around = report.begin("growth/sheets");
        report.remark("something is left out");
        let pairs = [(1.0, 2.0), (10.0, 30.0)];
        let growth = Points::growth("growth", ["faces", "time"], ["1", "s"], &pairs, "");
        report.points("growth.sheets", growth);
        let rows = vec![vec![Cell::plain("a")]];
        report.table_of("growth.table", Table { rows, ..Table::default() });
        report.finish(around);
        report.complete = true;
        // The document sorts names.
        report.entries.sort_by_key(|e| (matches!(e.content, Content::Table(_)), e.name.clone()));
        let json: Value = serde_json::from_str(&report.json()).unwrap();
        assert_eq!(json["figures"]["growth.sheets"]["value"], json!([[1.0, 2.0], [10.0, 30.0]]));
        assert_eq!(Report::read(&report.json()), Ok(report));
    }

    #[test]
    fn bad_documents_are_named() {
        let good = report().json();
        for (from, to, word) in [
            ("\"format\": 1", "\"format\": 7", "`format` is 7"),
            ("\"unit\": \"s\"", "\"unit\": 1", "`figures.flag.time`"),
            ("\"figures\"", "\"figure\"", "`figures`"),
            ("{", "", "line 2"),
        ] {
            let why = Report::read(&good.replacen(from, to, 1)).unwrap_err();
            assert!(why.contains(word), "{from}: {why}");
        }
    }

    #[test]
    fn what_was_not_measured_is_no_figure() {
        let mut report = report();
        report.add("flag.none", Figure::median(&[], "s", ""));
        assert!(report.figures().all(|(name, _)| name != "flag.none"));
        assert!(report.remarks[0].1.contains("flag.none"));
    }

    #[test]
    fn a_name_has_one_figure() {
        let mut report = report();
        report.add("flag.faces", Figure::exact(7.0, "1", ""));
        let json: Value = serde_json::from_str(&report.json()).unwrap();
        assert_eq!(json["figures"]["flag.faces"]["value"], 7.0);
        assert_eq!(report.text().matches("flag.faces").count(), 1);
    }

    #[test]
    fn a_part_begun_again_loses_what_a_stopped_run_left() {
        let mut report = report();
        let around = report.begin("flag/late");
        report.add("flag.late", Figure::exact(1.0, "1", ""));
        // Stopped here.
        report.part = around;
        assert!(report.is_finished("flag") && !report.is_finished("flag/late"));
        let around = report.begin("flag/late");
        assert_eq!(report.figures().count(), 3);
        report.finish(around);
        assert!(report.is_finished("flag/late"));
        report.forget_suite("flag");
        assert_eq!((report.figures().count(), report.is_finished("flag/late")), (0, false));
    }

    #[test]
    fn the_text_tells_spread_and_notes_once() {
        let table = report().text();
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines[0], "flag.time       2.500 s      [1] 1.000 to 3.000, n = 3");
        assert_eq!(lines[2], "flag.faces      12345 1      [2]");
        assert_eq!(table.matches("over frames").count(), 1);
    }
}
