//! Tables of words, such as verdicts of one scene after the other.

use serde_json::{Value, json};

/// How a cell is to be taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tone {
    /// As it should be.
    Good,
    /// Neither.
    Plain,
    /// As it should not be.
    Bad,
}

const TONES: [(Tone, &str); 3] = [(Tone::Good, "good"), (Tone::Plain, "plain"), (Tone::Bad, "bad")];

impl Tone {
    /// Its name in reports.
    pub(super) fn name(self) -> &'static str {
        TONES.iter().find(|(t, _)| *t == self).map_or("plain", |(_, name)| name)
    }
}

/// One cell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Cell {
    pub(super) text: String,
    pub(super) tone: Tone,
}

impl Cell {
    /// A cell of words without judgement.
    pub(super) fn plain(text: impl Into<String>) -> Cell {
        Cell { text: text.into(), tone: Tone::Plain }
    }
}

/// A table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Table {
    /// Heads of the columns, that of the row names first.
    pub(super) columns: Vec<String>,
    /// The cells of each row, its name first.
    pub(super) rows: Vec<Vec<Cell>>,
    /// What one must know to understand the table.
    pub(super) note: String,
}

impl Table {
    pub(super) fn json(&self) -> Value {
        let cell = |c: &Cell| json!({ "text": c.text, "tone": c.tone.name() });
        let row = |row: &Vec<Cell>| row.iter().map(cell).collect::<Vec<_>>();
        let rows: Vec<_> = self.rows.iter().map(row).collect();
        json!({ "columns": self.columns, "rows": rows, "note": self.note })
    }

    /// Reads what [`Table::json`] made; `None` if it is something else.
    pub(super) fn read(json: &Value) -> Option<Table> {
        let text = |v: &Value| v.as_str().map(str::to_owned);
        let cell = |v: &Value| {
            let tone = v["tone"].as_str()?;
            let tone = TONES.iter().find(|(_, name)| *name == tone)?.0;
            Some(Cell { text: text(&v["text"])?, tone })
        };
        let row = |v: &Value| v.as_array()?.iter().map(cell).collect();
        Some(Table {
            columns: json["columns"].as_array()?.iter().map(text).collect::<Option<_>>()?,
            rows: json["rows"].as_array()?.iter().map(row).collect::<Option<_>>()?,
            note: text(&json["note"])?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_reads_back() {
        let row = vec![Cell::plain("hang"), Cell { text: "<0>".into(), tone: Tone::Bad }];
        let table = Table {
            columns: vec!["scene".into(), "×10²".into()],
            rows: vec![row],
            note: "n".into(),
        };
        let text = table.json().to_string();
        assert_eq!(Table::read(&serde_json::from_str(&text).unwrap()), Some(table));
        assert_eq!(Table::read(&json!({ "columns": [] })), None);
    }
}
