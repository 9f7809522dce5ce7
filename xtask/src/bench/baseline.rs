//! Comparison with an earlier report: what has changed by more than noise.

use super::figure::{Figure, Of};
use super::number::short;
use super::report::{Content, Report};
use super::table::{Cell, Table, Tone};
use crate::command::Failure;
use std::fs;
use std::path::Path;

/// By how much both ends of the spread of a time are widened, with three runs or more: what medians
/// of so many runs differ by on a quiet machine.
const REPEATED: f64 = 1.1;
/// The same for fewer runs: other load on a machine makes CPU seconds this much longer.
const SINGLE: f64 = 1.6;
/// By how much the bounds of overheads, differences and exponents, which can be near zero, are widened
/// besides on either side, with three runs or more and with fewer.
const SLACK: [f64; 2] = [0.02, 0.1];
/// The same for peaks of memory.
const MEMORY: f64 = 1.05;
/// The same for all else, which has the same bits in every run of one program.
const SAME: f64 = 1.0 + 1e-9;

/// How a number has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Change {
    Better,
    Worse,
    /// Different where neither is better.
    Other,
}

/// A number that both reports have.
struct Pair {
    name: String,
    before: Figure,
    now: Figure,
}

/// Reads the report in a folder.
///
/// # Errors
/// If there is none, or it is no such report.
pub(super) fn read(folder: &Path) -> Result<Report, Failure> {
    let path = folder.join("report.json");
    let told = |what: String| Failure::Unable(format!("--baseline: {}: {what}", path.display()));
    let text = fs::read_to_string(&path).map_err(|error| told(error.to_string()))?;
    Report::read(&text).map_err(told)
}

/// What has changed by more than noise, as a table with the worst first. The note tells how many
/// numbers were compared.
pub(super) fn compare(before: &Report, now: &Report) -> Table {
    let pairs = pairs(before, now);
    let n = pairs.len();
    let mut changes: Vec<(Change, Pair)> =
        pairs.into_iter().filter_map(|pair| Some((change(&pair)?, pair))).collect();
    let count = |kind| changes.iter().filter(|(change, _)| *change == kind).count();
    let (worse, better) = (count(Change::Worse), count(Change::Better));
    let other = changes.len() - worse - better;
    let mut note = format!(
        "{n} numbers are in both reports: {worse} worse beyond noise, {better} better, {other} \
         changed where neither is better. Earlier commit: {}.",
        before.provenance.commit.as_deref().unwrap_or("unknown")
    );
    if !before.provenance.is_comparable(&now.provenance) {
        note += " Machine or options were others: times do not compare.";
    }
    changes.sort_by_key(|(change, _)| {
        [Change::Worse, Change::Other, Change::Better].iter().position(|c| c == change)
    });
    let rows = changes.iter().map(|(change, pair)| row(*change, pair)).collect();
    let columns = ["figure", "earlier", "now", "unit", "now / earlier", ""];
    Table { columns: columns.map(str::to_owned).to_vec(), rows, note }
}

/// The table as text.
pub(super) fn text(table: &Table) -> String {
    let line = |row: &Vec<Cell>| {
        let words: Vec<&str> = row.iter().map(|cell| cell.text.as_str()).collect();
        format!("  {}\n", words.join("  "))
    };
    format!("{}{}", table.rows.iter().map(line).collect::<String>(), table.note)
}

fn row(change: Change, Pair { name, before, now }: &Pair) -> Vec<Cell> {
    let (word, tone) = match change {
        Change::Better => ("better", Tone::Good),
        Change::Worse => ("worse", Tone::Bad),
        Change::Other => ("changed", Tone::Plain),
    };
    let shown = |f: &Figure| match f.of {
        Of::Runs => {
            format!("{} ({} to {})", short(f.value), short(f.spread[0]), short(f.spread[1]))
        }
        Of::Things | Of::Once => short(f.value),
    };
    let ratio = short(now.value / before.value);
    let texts = [name.clone(), shown(before), shown(now), now.unit.to_string(), ratio];
    let mut row: Vec<Cell> = texts.into_iter().map(Cell::plain).collect();
    row.push(Cell { text: word.into(), tone });
    row
}

/// The numbers of both reports: figures by name, points by series and label.
fn pairs(before: &Report, now: &Report) -> Vec<Pair> {
    let old = numbers(before);
    let find = |name: &str| old.iter().find(|(other, _)| other == name).map(|(_, f)| f.clone());
    let pair = |(name, now): (String, Figure)| Some(Pair { before: find(&name)?, name, now });
    numbers(now).into_iter().filter_map(pair).filter(|p| p.before.unit == p.now.unit).collect()
}

fn numbers(report: &Report) -> Vec<(String, Figure)> {
    let mut all = Vec::new();
    for entry in &report.entries {
        match &entry.content {
            // Wall seconds, which other load makes longer without bound.
            Content::Figure(_) if entry.name.contains(".stage_s.") => {}
            Content::Figure(figure) => all.push((entry.name.clone(), figure.clone())),
            Content::Points(points) => {
                for (k, p) in points.points.iter().enumerate() {
                    let at = if p.label.is_empty() { &k.to_string() } else { &p.label };
                    let name = format!("{} [{at}]", entry.name);
                    for (axis, value, spread, of) in
                        [(0, p.x, [p.x, p.x], Of::Once), (1, p.y, p.spread, Of::Runs)]
                    {
                        let unit = points.units[axis].clone().into();
                        let figure =
                            Figure { value, unit, spread, n: p.n, of, note: String::new() };
                        all.push((format!("{name} {}", points.axes[axis]), figure));
                    }
                }
            }
            Content::Table(_) => {}
        }
    }
    all
}

/// The change beyond noise; `None` if there is none.
fn change(Pair { name, before, now }: &Pair) -> Option<Change> {
    let is_single = before.n.min(now.n) < 3;
    let is_near_zero =
        ["overhead", "difference", "exponent"].iter().any(|word| name.contains(word));
    let slack =
        if is_near_zero && now.of == Of::Runs { SLACK[usize::from(is_single)] } else { 0.0 };
    let widening = match (&*now.unit, now.of) {
        ("s", _) | (_, Of::Runs) if is_single => SINGLE,
        ("s", _) | (_, Of::Runs) => REPEATED,
        ("MB" | "B", _) => MEMORY,
        _ => SAME,
    };
    let bounds = |f: &Figure| {
        // The spread over frames is no noise.
        let [low, high] = if f.of == Of::Runs { f.spread } else { [f.value; 2] };
        let [low, high] = [low.min(high), low.max(high)];
        // Away from zero upwards and towards it downwards, whatever the sign.
        let wider = |x: f64, up: bool| if (x > 0.0) == up { x * widening } else { x / widening };
        [wider(low, false) - slack, wider(high, true) + slack]
    };
    let ([old_low, old_high], [low, high]) = (bounds(before), bounds(now));
    // Written so that a number that has become none counts as different.
    let rises = low > old_high;
    let same = low <= old_high && old_low <= high;
    let both_none = before.value.is_nan() && now.value.is_nan();
    if same || both_none {
        return None;
    }
    Some(match (less_is_better(name, &now.unit), rises || now.value.is_nan()) {
        (false, _) => Change::Other,
        (true, true) => Change::Worse,
        (true, false) => Change::Better,
    })
}

/// True for what costs or is wrong.
fn less_is_better(name: &str, unit: &str) -> bool {
    let words = [
        "error",
        "exponent",
        "ratio",
        "overhead",
        "intersections",
        "false_negatives",
        "unstable",
        "difference",
    ];
    matches!(unit, "s" | "MB" | "B") || words.iter().any(|word| name.contains(word))
}

#[cfg(test)]
mod tests {
    use super::super::points::{Point, Points};
    use super::super::provenance::Provenance;
    use super::*;

    fn pair(name: &str, before: Option<Figure>, now: Option<Figure>) -> Option<Change> {
        change(&Pair { name: name.into(), before: before.unwrap(), now: now.unwrap() })
    }

    #[test]
    fn times_change_when_widened_spreads_are_apart() {
        let times = |values: &[f64]| Figure::median(values, "s", "");
        let before = [1.0, 1.1, 1.3];
        let judge = |now: &[f64]| pair("a.cpu_s", times(&before), times(now));
        assert_eq!(judge(&[1.2, 1.4, 1.5]), None);
        // 1.3 · 1.1 = 1.43 against 1.5 / 1.1 = 1.36.
        assert_eq!(judge(&[1.5, 1.6, 1.7]), None);
        assert_eq!(judge(&[1.6, 1.7, 1.8]), Some(Change::Worse));
        assert_eq!(judge(&[0.7, 0.75, 0.8]), Some(Change::Better));
        // One run does not tell its noise.
        assert_eq!(judge(&[2.5]), None);
        assert_eq!(judge(&[3.5]), Some(Change::Worse));
        assert_eq!(pair("a.share", Figure::exact(1.0, "s", ""), Figure::exact(2.5, "s", "")), None);
        // What is near zero differs by many times itself.
        let share = |x| Figure::median(&[x], "1", "");
        assert_eq!(pair("a.overhead", share(0.004), share(-0.02)), None);
        assert_eq!(pair("a.overhead", share(0.004), share(0.5)), Some(Change::Worse));
        assert_eq!(pair("a.ratio", share(0.01), share(0.05)), Some(Change::Worse));
    }

    #[test]
    fn what_has_the_same_bits_changes_by_any_difference() {
        let exact = |x| Figure::exact(x, "1", "");
        assert_eq!(pair("a.faces", exact(10.0), exact(10.0)), None);
        assert_eq!(pair("a.faces", exact(10.0), exact(11.0)), Some(Change::Other));
        assert_eq!(pair("a.intersections", exact(0.0), exact(1.0)), Some(Change::Worse));
        assert_eq!(pair("a.intersections", exact(1.0), exact(0.0)), Some(Change::Better));
        assert_eq!(pair("a.slope", exact(-2.0), exact(-2.0)), None);
        assert_eq!(pair("a.error", exact(1.0), exact(f64::NAN)), Some(Change::Worse));
        assert_eq!(pair("a.error", exact(f64::NAN), exact(f64::NAN)), None);
        // The spread over frames is no excuse.
        let frames = |x| Figure::mean(&[0.0, 2.0 * x], "m", "");
        assert_eq!(pair("a.error.fixed", frames(1.0), frames(1.1)), Some(Change::Worse));
        let peak = |x| Figure::exact(x, "MB", "");
        assert_eq!(pair("a.peak_mb", peak(100.0), peak(105.0)), None);
        assert_eq!(pair("a.peak_mb", peak(100.0), peak(120.0)), Some(Change::Worse));
    }

    #[test]
    fn points_are_compared_by_label() {
        let report = |x, y, label: &str| {
            let mut report = Report::new(Provenance::default());
            let point = Point { x, y, spread: [y, y], n: 1, label: label.into() };
            report.points("pareto.a.fixed", Points::errors("a", "m", vec![point], 0.0, ""));
            report.add("a.cpu_s", Figure::median(&[1.0], "s", ""));
            report.add("a.stage_s.linear.fixed", Figure::median(&[1e3 * x * x], "s", ""));
            report
        };
        let before = report(0.1, 1.0, "h 1/8");
        let table = compare(&before, &report(0.2, 1.1, "h 1/8"));
        assert_eq!(table.rows.len(), 1);
        assert!(table.rows[0][0].text.contains("[h 1/8] RMS error"), "{table:?}");
        assert_eq!(table.rows[0][5].tone, Tone::Bad);
        assert!(table.note.contains("3 numbers") && table.note.contains("1 worse"));
        assert!(text(&table).contains("worse"));
        let other = compare(&before, &report(0.2, 1.1, "h 1/9"));
        assert!(other.rows.is_empty() && other.note.contains("1 numbers"));
    }

    #[test]
    fn a_missing_baseline_is_named() {
        let why = read("/no/such".as_ref()).unwrap_err();
        assert!(matches!(why, Failure::Unable(why) if why.contains("/no/such/report.json")));
    }
}
