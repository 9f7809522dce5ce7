//! One measured number, with what it was made of.

use super::statistics::{mean, median, spread};
use serde_json::{Value, json};
use std::borrow::Cow;

/// What the spread of a figure is over, which says whether it is noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Of {
    /// Repetitions of one measurement: noise.
    Runs,
    /// Different things, such as frames: no noise.
    Things,
    /// One number that every repetition would give again, or one measurement.
    Once,
}

const OF: [(Of, &str); 3] = [(Of::Runs, "runs"), (Of::Things, "things"), (Of::Once, "once")];

/// One measured number.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Figure {
    /// In `unit`.
    pub(super) value: f64,
    pub(super) unit: Cow<'static, str>,
    /// Smallest and largest of what `value` was made of.
    pub(super) spread: [f64; 2],
    /// How many numbers `value` was made of.
    pub(super) n: usize,
    pub(super) of: Of,
    /// What one must know to understand the value.
    pub(super) note: String,
}

impl Figure {
    /// The median of repeated measurements, also of a single one of what varies from run to run;
    /// `None` if there are none.
    pub(super) fn median(values: &[f64], unit: &'static str, note: &str) -> Option<Figure> {
        Figure::made(Of::Runs, median(values), values, unit, note)
    }

    /// The mean of different things, such as frames; `None` if there are none.
    pub(super) fn mean(values: &[f64], unit: &'static str, note: &str) -> Option<Figure> {
        Figure::made(Of::Things, mean(values), values, unit, note)
    }

    /// The root mean square of different things; `None` if there are none.
    pub(super) fn rms(values: &[f64], unit: &'static str, note: &str) -> Option<Figure> {
        let squares: Vec<f64> = values.iter().map(|x| x * x).collect();
        Figure::made(Of::Things, mean(&squares).map(f64::sqrt), values, unit, note)
    }

    /// A number that every repetition would give again: no times, nor what is made of times.
    pub(super) fn exact(value: f64, unit: &'static str, note: &str) -> Option<Figure> {
        Figure::made(Of::Once, Some(value), &[value], unit, note)
    }

    /// A number that others made of `n` repetitions, and the bounds they give for it.
    pub(super) fn told(
        value: f64,
        spread: [f64; 2],
        n: usize,
        unit: &'static str,
        note: &str,
    ) -> Figure {
        Figure { value, unit: unit.into(), spread, n, of: Of::Runs, note: note.to_owned() }
    }

    fn made(
        of: Of,
        value: Option<f64>,
        values: &[f64],
        unit: &'static str,
        note: &str,
    ) -> Option<Figure> {
        let (value, spread, n) = (value?, spread(values)?, values.len());
        Some(Figure { value, unit: unit.into(), spread, n, of, note: note.to_owned() })
    }

    pub(super) fn json(&self) -> Value {
        let Figure { value, unit, spread, n, of, note } = self;
        let of = OF.iter().find(|(o, _)| o == of).map(|(_, name)| name);
        json!({ "value": value, "unit": unit, "spread": spread, "n": n, "of": of, "note": note })
    }

    /// Reads what [`Figure::json`] made; `None` if it is something else.
    pub(super) fn read(json: &Value) -> Option<Figure> {
        // JSON has no NaN and no infinity: they were written as null.
        let number = |v: &Value| if v.is_null() { Some(f64::NAN) } else { v.as_f64() };
        let name = json["of"].as_str()?;
        Some(Figure {
            value: number(json.get("value")?)?,
            unit: json["unit"].as_str()?.to_owned().into(),
            spread: [number(json["spread"].get(0)?)?, number(json["spread"].get(1)?)?],
            n: json["n"].as_u64()? as usize,
            of: OF.iter().find(|(_, other)| *other == name)?.0,
            note: json["note"].as_str()?.to_owned(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_reads_back() {
        for figure in [
            Figure::median(&[3.0, 1.0, 2.5], "s", "of \"all\"\nframes").unwrap(),
            Figure::mean(&[0.25, 0.75], "m", "").unwrap(),
            Figure::exact(12345.0, "1", "n").unwrap(),
            Figure::told(0.5, [0.25, 0.75], 100, "s", "n"),
        ] {
            let text = figure.json().to_string();
            let back = Figure::read(&serde_json::from_str(&text).unwrap());
            assert_eq!(back, Some(figure));
        }
        let broken = Figure::exact(f64::NAN, "1", "").unwrap().json();
        assert!(Figure::read(&broken).unwrap().value.is_nan());
    }

    #[test]
    fn what_is_no_figure_is_refused() {
        let good = Figure::exact(1.0, "1", "").unwrap().json();
        for (key, value) in [("value", json!("x")), ("of", json!("all")), ("spread", json!([1]))] {
            let mut bad = good.clone();
            bad[key] = value;
            assert_eq!(Figure::read(&bad), None, "{key}");
        }
        assert_eq!(Figure::read(&json!(3)), None);
    }
}
