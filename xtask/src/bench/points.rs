//! Measured points to be drawn: error against time, growth with size.

use serde_json::{Value, json};

/// How points are drawn, always on two logarithmic axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    /// Less of both is better: a line joins the points that no other point of the series beats.
    Front,
    /// y grows with x as a power: the best straight line is drawn, and its slope told.
    Growth,
}

const SHAPES: [(Shape, &str); 2] = [(Shape::Front, "front"), (Shape::Growth, "growth")];

/// One point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Point {
    pub(super) x: f64,
    pub(super) y: f64,
    /// Smallest and largest of repeated measurements of y.
    pub(super) spread: [f64; 2],
    /// How often y was measured.
    pub(super) n: usize,
    /// Which settings made it.
    pub(super) label: String,
}

/// A series of points.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Points {
    /// Title of the plot; series with the same title share one.
    pub(super) plot: String,
    pub(super) shape: Shape,
    /// What x and y are.
    pub(super) axes: [String; 2],
    /// Units of x and y.
    pub(super) units: [String; 2],
    pub(super) points: Vec<Point>,
    /// Below this x points say nothing: drawn as a line across the plot.
    pub(super) floor: Option<f64>,
    /// What one must know to understand the points.
    pub(super) note: String,
}

impl Points {
    /// Errors and CPU seconds of one method; `scene` is the plot.
    pub(super) fn errors(
        scene: &str,
        unit: &str,
        points: Vec<Point>,
        floor: f64,
        note: &str,
    ) -> Points {
        Points {
            plot: format!("{scene}: error against CPU time"),
            shape: Shape::Front,
            axes: ["RMS error".into(), "CPU time".into()],
            units: [unit.to_owned(), "s".into()],
            points,
            floor: Some(floor),
            note: note.to_owned(),
        }
    }

    /// How something grows: pairs of (size, cost).
    pub(super) fn growth(
        plot: &str,
        axes: [&str; 2],
        units: [&str; 2],
        pairs: &[(f64, f64)],
        note: &str,
    ) -> Points {
        let point =
            |&(x, y): &(f64, f64)| Point { x, y, spread: [y, y], n: 1, label: String::new() };
        Points {
            plot: plot.to_owned(),
            shape: Shape::Growth,
            axes: axes.map(str::to_owned),
            units: units.map(str::to_owned),
            points: pairs.iter().map(point).collect(),
            floor: None,
            note: note.to_owned(),
        }
    }

    pub(super) fn json(&self) -> Value {
        let Points { plot, shape, axes, units, points, floor, note } = self;
        let shape = SHAPES.iter().find(|(s, _)| s == shape).map(|(_, name)| name);
        let value: Vec<[f64; 2]> = points.iter().map(|p| [p.x, p.y]).collect();
        let spread: Vec<[f64; 2]> = points.iter().map(|p| p.spread).collect();
        let n: Vec<usize> = points.iter().map(|p| p.n).collect();
        let labels: Vec<&str> = points.iter().map(|p| p.label.as_str()).collect();
        json!({
            "value": value, "unit": units, "spread": spread, "n": n, "labels": labels, "axes": axes,
            "plot": plot, "shape": shape, "floor": floor, "note": note,
        })
    }

    /// Reads what [`Points::json`] made; `None` if it is something else.
    pub(super) fn read(json: &Value) -> Option<Points> {
        let two_texts = |key: &str| -> Option<[String; 2]> {
            let text = |k: usize| Some(json[key].get(k)?.as_str()?.to_owned());
            Some([text(0)?, text(1)?])
        };
        // JSON has no NaN and no infinity: they were written as null.
        let number = |v: &Value| if v.is_null() { Some(f64::NAN) } else { v.as_f64() };
        let pair =
            |v: &Value| -> Option<[f64; 2]> { Some([number(v.get(0)?)?, number(v.get(1)?)?]) };
        let point = |(k, value): (usize, &Value)| {
            let [x, y] = pair(value)?;
            let label = json["labels"].get(k)?.as_str()?.to_owned();
            let n = json["n"].get(k)?.as_u64()? as usize;
            Some(Point { x, y, spread: pair(json["spread"].get(k)?)?, n, label })
        };
        let shape = json["shape"].as_str()?;
        Some(Points {
            plot: json["plot"].as_str()?.to_owned(),
            shape: SHAPES.iter().find(|(_, name)| *name == shape)?.0,
            axes: two_texts("axes")?,
            units: two_texts("unit")?,
            points: json["value"]
                .as_array()?
                .iter()
                .enumerate()
                .map(point)
                .collect::<Option<_>>()?,
            floor: json["floor"].as_f64(),
            note: json["note"].as_str()?.to_owned(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_reads_back() {
        let point = Point { x: 0.01, y: 2.0, spread: [1.5, 3.0], n: 3, label: "h 1/8 m".into() };
        let errors = Points::errors("hang", "m", vec![point.clone(), point], 1e-3, "a \"note\"");
        let growth =
            Points::growth("g", ["faces", "time"], ["1", "s"], &[(1.0, 2.0), (10.0, 30.0)], "");
        for points in [errors, growth] {
            let text = points.json().to_string();
            assert_eq!(Points::read(&serde_json::from_str(&text).unwrap()), Some(points));
        }
        assert_eq!(Points::read(&json!({ "value": [[1, 2]] })), None);
        let broken = Points::growth("g", ["a", "b"], ["1", "s"], &[(1.0, f64::NAN)], "").json();
        assert!(Points::read(&broken).unwrap().points[0].y.is_nan());
    }
}
