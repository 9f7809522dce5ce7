//! A report as one page of HTML that needs nothing else: no scripts, no other files.

mod axis;
mod bars;
mod markup;
mod plot;

use super::number::short;
use super::points::{Points, Shape};
use super::report::{Content, Entry, Report, suite_of};
use super::table::{Table, Tone};
use markup::escape;
use std::fmt::Write;

/// The page. `changes` is a comparison with an earlier report.
pub(super) fn page(report: &Report, changes: Option<&Table>) -> String {
    let mut out = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <title>Organza: error against run time</title>\n<style>\n{}</style>\n</head>\n<body>\n\
         <h1>Organza: error against run time</h1>\n",
        include_str!("page.css")
    );
    let machine = escape(&report.provenance.machine.text());
    let commit = escape(report.provenance.commit.as_deref().unwrap_or("unknown"));
    // Writing to a String cannot fail, here and below.
    let _ = writeln!(
        out,
        "<p>Commit <code>{commit}</code>. {machine}. CPU seconds of whole processes on one thread \
         unless a note says otherwise; other load makes them longer, so compare ratios.</p>"
    );
    if !report.complete {
        out += "<p class=\"bad\">This run is not finished: suites are missing below.</p>\n";
    }
    if let Some(changes) = changes {
        out += "<h2>Changes beyond noise</h2>\n";
        out += &table(changes);
    }
    for suite in suites(report) {
        section(&mut out, report, suite);
    }
    out + "</body>\n</html>\n"
}

/// The suites in the order of their first results.
fn suites(report: &Report) -> Vec<&str> {
    let parts = report.entries.iter().map(|entry| &entry.part);
    let mut suites = Vec::new();
    for part in parts.chain(report.remarks.iter().map(|(part, _)| part)) {
        let suite = suite_of(part);
        if !suites.contains(&suite) {
            suites.push(suite);
        }
    }
    suites
}

fn section(out: &mut String, report: &Report, suite: &str) {
    let entries: Vec<&Entry> =
        report.entries.iter().filter(|entry| suite_of(&entry.part) == suite).collect();
    let _ = writeln!(out, "<h2>{}</h2>", escape(if suite.is_empty() { "other" } else { suite }));
    plots(out, &entries);
    let bars = bars::bars(report, suite);
    if !bars.is_empty() {
        *out += "<h3>Where the time goes</h3>\n<div class=\"plots\">\n";
        for (scene, svg) in bars {
            let _ = writeln!(
                out,
                "<figure>{svg}<figcaption>{}: share of a frame's wall seconds by stage</figcaption>\
                 </figure>",
                escape(&scene)
            );
        }
        *out += "</div>\n";
    }
    for entry in &entries {
        if let Content::Table(content) = &entry.content {
            let _ = writeln!(out, "<h3>{}</h3>\n{}", escape(&entry.name), table(content));
        }
    }
    figures(out, &entries);
    for (_, remark) in report.remarks.iter().filter(|(part, _)| suite_of(part) == suite) {
        let _ = writeln!(out, "<p class=\"remark\">{}</p>", escape(remark));
    }
}

/// Series of points, those with the same plot together.
fn plots_of<'a>(entries: impl Iterator<Item = &'a Entry>) -> Vec<Vec<(&'a str, &'a Points)>> {
    let mut plots: Vec<Vec<(&str, &Points)>> = Vec::new();
    for entry in entries {
        let Content::Points(points) = &entry.content else { continue };
        let one = (entry.name.as_str(), points);
        match plots.iter_mut().find(|plot| plot[0].1.plot == points.plot) {
            Some(plot) => plot.push(one),
            None => plots.push(vec![one]),
        }
    }
    plots
}

/// Every plot as an SVG of its own, with a name for its file.
pub(super) fn files(report: &Report) -> Vec<(String, String)> {
    let style = format!("<style>\n{}</style>\n", include_str!("page.css"));
    let file = |series: Vec<(&str, &Points)>| {
        // What the names of all its series begin with.
        let name = series[0].0.rsplit_once('.').map_or(series[0].0, |(stem, _)| stem);
        let svg = plot::plot(&series)?;
        let (head, rest) = svg.split_once('\n')?;
        Some((format!("{}.svg", name.replace('.', "_")), format!("{head}\n{style}{rest}")))
    };
    plots_of(report.entries.iter()).into_iter().filter_map(file).collect()
}

fn plots(out: &mut String, entries: &[&Entry]) {
    let plots = plots_of(entries.iter().copied());
    if plots.is_empty() {
        return;
    }
    *out += "<div class=\"plots\">\n";
    for series in plots {
        let Some(svg) = plot::plot(&series) else { continue };
        let mut notes: Vec<String> = Vec::new();
        for note in series.iter().map(|(_, points)| escape(&points.note)) {
            if !notes.contains(&note) {
                notes.push(note);
            }
        }
        let how = match series[0].1.shape {
            Shape::Front => {
                "Left and below is better. A line joins the settings that no other of the method \
                 beats; the broad line, those that none at all beats. Bars are spreads of runs. "
            }
            Shape::Growth => "Lines are least-squares fits of the logarithms. ",
        };
        let _ = writeln!(
            out,
            "<figure><h3>{}</h3>\n{svg}<figcaption>{how}{}</figcaption></figure>",
            escape(&series[0].1.plot),
            notes.join(" ")
        );
    }
    *out += "</div>\n";
}

fn figures(out: &mut String, entries: &[&Entry]) {
    let mut notes: Vec<&str> = Vec::new();
    let mut rows = String::new();
    for entry in entries {
        let Content::Figure(figure) = &entry.content else { continue };
        let place = notes.iter().position(|note| *note == figure.note).unwrap_or_else(|| {
            notes.push(&figure.note);
            notes.len() - 1
        });
        let [low, high] = figure.spread;
        let spread = match figure.n {
            0 | 1 => String::new(),
            n => format!("{} to {} (n = {n})", short(low), short(high)),
        };
        let _ = writeln!(
            rows,
            "<tr><td>{}</td><td class=\"number\">{}</td><td>{}</td><td class=\"number\">{spread}\
             </td><td class=\"number\">{}</td></tr>",
            escape(&entry.name),
            short(figure.value),
            escape(if figure.unit == "1" { "" } else { &figure.unit }),
            place + 1
        );
    }
    if rows.is_empty() {
        return;
    }
    let _ = writeln!(
        out,
        "<h3>Figures</h3>\n<div class=\"wide\"><table>\n<tr><th>figure</th><th>value</th>\
         <th>unit</th><th>spread</th><th>note</th></tr>\n{rows}</table></div>"
    );
    *out += "<ol class=\"notes\">\n";
    for note in notes {
        let _ = writeln!(out, "<li>{}</li>", escape(note));
    }
    *out += "</ol>\n";
}

fn table(content: &Table) -> String {
    let head: String = content.columns.iter().map(|c| format!("<th>{}</th>", escape(c))).collect();
    let mut out = String::from("<div class=\"wide\"><table>\n");
    if content.rows.is_empty() {
        out.clear();
    } else {
        let _ = writeln!(out, "<tr>{head}</tr>");
        for row in &content.rows {
            out += "<tr>";
            for cell in row {
                let class = match cell.tone {
                    Tone::Plain => String::new(),
                    tone => format!(" class=\"{}\"", tone.name()),
                };
                let _ = write!(out, "<td{class}>{}</td>", escape(&cell.text));
            }
            out += "</tr>\n";
        }
        out += "</table></div>\n";
    }
    let _ = writeln!(out, "<p class=\"note\">{}</p>", escape(&content.note));
    out
}

#[cfg(test)]
mod tests {
    use super::super::figure::Figure;
    use super::super::points::Point;
    use super::super::provenance::Provenance;
    use super::super::table::Cell;
    use super::*;

    fn report() -> Report {
        let mut report = Report::new(Provenance::default());
        let around = report.begin("pareto/hang");
        let points = [(0.1, 1.0), (0.01, 9.0)].map(|(x, y)| Point {
            x,
            y,
            spread: [y, 1.1 * y],
            n: 2,
            label: "h < 1/8 & \"fast\"".into(),
        });
        report.points(
            "pareto.hang.fixed",
            Points::errors("hang", "m", points.to_vec(), 1e-3, "a < b"),
        );
        report.add("pareto.hang.floor", Figure::exact(1e-3, "m", "between <two> references"));
        let bad = Cell { text: "a & b".into(), tone: Tone::Bad };
        let rows = vec![vec![Cell::plain("<x>"), bad]];
        let columns = vec!["1".into(), "2".into()];
        report.table_of("pareto.hang", Table { columns, rows, note: "t".into() });
        report.finish(around);
        let around = report.begin("growth");
        let pairs = [(1.0, 2.0), (10.0, 30.0)];
        report.points("g", Points::growth("g", ["faces", "time"], ["1", "s"], &pairs, ""));
        report.add("growth.stage_s.total.a", Figure::exact(2.0, "s", ""));
        report.add("growth.stage_s.linear.a", Figure::exact(1.0, "s", ""));
        report.remark("what < was left out");
        report.finish(around);
        report
    }

    /// Elements that are open at the end, or closed in the wrong order.
    fn unbalanced(html: &str) -> Vec<String> {
        let mut open: Vec<String> = Vec::new();
        for piece in html.split('<').skip(1) {
            let (tag, _) = piece.split_once('>').expect("tags are closed");
            assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
            let name = tag.split([' ', '/']).find(|w| !w.is_empty()).unwrap_or_default();
            if tag.starts_with('!') || tag.ends_with('/') {
                continue;
            }
            if tag.starts_with('/') {
                if open.pop().as_deref() != Some(name) {
                    return vec![format!("</{name}>")];
                }
            } else {
                open.push(name.to_owned());
            }
        }
        open
    }

    #[test]
    fn the_page_is_well_formed_and_needs_nothing_else() {
        let changes = Table { note: "none".into(), ..Table::default() };
        for changes in [None, Some(&changes)] {
            let page = page(&report(), changes);
            assert_eq!(unbalanced(&page), Vec::<String>::new());
            assert!(!page.contains("<script") && !page.contains("<link"));
            assert!(!page.contains("href") && !page.contains("url(") && !page.contains("@import"));
        }
    }

    #[test]
    fn plots_are_files_of_their_own() {
        let files = files(&report());
        let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["pareto_hang.svg", "g.svg"]);
        for (_, svg) in files {
            assert!(svg.starts_with("<svg xmlns=") && svg.contains("--ink"));
            assert_eq!(unbalanced(&svg), Vec::<String>::new());
        }
    }

    #[test]
    fn everything_is_on_the_page() {
        let page = page(&report(), None);
        for text in [
            "pareto.hang.floor",
            "between &lt;two&gt; references",
            "<td class=\"bad\">a &amp; b</td>",
            "what &lt; was left out",
            "linear: 50.0 %",
            "grows as the power",
            "hang: error against CPU time",
            "not finished",
        ] {
            assert!(page.contains(text), "{text}");
        }
        assert_eq!(page.matches("<svg").count(), 3);
        assert_eq!(page.matches("<h2>").count(), 2);
    }
}
