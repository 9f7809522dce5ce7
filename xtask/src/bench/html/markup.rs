//! Text in HTML and SVG.

use std::fmt::Write;

/// Text in which no character is taken for markup.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // Control characters are not allowed in XML.
            c if c.is_control() && c != '\n' => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// An SVG that grows by elements; x to the right and y down, in pixels at its natural size.
pub(super) struct Svg(String);

impl Svg {
    /// An empty picture; `title` is for those who cannot see it.
    pub(super) fn new([width, height]: [f64; 2], title: &str) -> Svg {
        let title = escape(title);
        Svg(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             role=\"img\" aria-label=\"{title}\">\n"
        ))
    }

    /// A line through points. `style` is a set of attributes.
    pub(super) fn line(&mut self, points: &[[f64; 2]], style: &str) {
        let points: Vec<String> = points.iter().map(|[x, y]| format!("{x:.2},{y:.2}")).collect();
        self.element(&format!("<polyline points=\"{}\" {style}/>", points.join(" ")));
    }

    /// Text beside a point.
    pub(super) fn text(&mut self, [x, y]: [f64; 2], style: &str, text: &str) {
        self.element(&format!("<text x=\"{x:.2}\" y=\"{y:.2}\" {style}>{}</text>", escape(text)));
    }

    /// A rectangle from its upper left corner, and what it says when pointed at.
    pub(super) fn rectangle(&mut self, [x, y]: [f64; 2], [w, h]: [f64; 2], style: &str, tip: &str) {
        self.element(&format!(
            "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{w:.2}\" height=\"{h:.2}\" {style}>\
             <title>{}</title></rect>",
            escape(tip)
        ));
    }

    /// The sign of the series `k` at a point, in its colour, and what it says when pointed at.
    pub(super) fn sign(&mut self, [x, y]: [f64; 2], k: usize, tip: &str) {
        let r = 4.5;
        let shape = match k % 4 {
            0 => format!("<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{r}\""),
            1 => polygon(x, y, &[[-r, -r], [r, -r], [r, r], [-r, r]]),
            2 => polygon(x, y, &[[0.0, -1.3 * r], [1.2 * r, r], [-1.2 * r, r]]),
            _ => polygon(x, y, &[[0.0, -1.4 * r], [1.4 * r, 0.0], [0.0, 1.4 * r], [-1.4 * r, 0.0]]),
        };
        let tag = &shape[1..shape.find(' ').unwrap_or(1)];
        self.element(&format!(
            "{shape} style=\"fill: {}\"><title>{}</title></{tag}>",
            colour(k),
            escape(tip)
        ));
    }

    fn element(&mut self, element: &str) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.0, "{element}");
    }

    /// The finished picture.
    pub(super) fn finish(self) -> String {
        self.0 + "</svg>\n"
    }
}

fn polygon(x: f64, y: f64, corners: &[[f64; 2]]) -> String {
    let corners: Vec<String> =
        corners.iter().map(|[dx, dy]| format!("{:.2},{:.2}", x + dx, y + dy)).collect();
    format!("<polygon points=\"{}\"", corners.join(" "))
}

/// The colour of a series, the same in light and in dark as far as it can be.
pub(super) fn colour(k: usize) -> String {
    format!("var(--s{})", k % 8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_taken_for_markup() {
        assert_eq!(escape("a<b> & \"c\"\u{1}"), "a&lt;b&gt; &amp; &quot;c&quot; ");
    }

    #[test]
    fn signs_are_closed_as_they_were_opened() {
        let mut svg = Svg::new([10.0, 10.0], "<t>");
        (0..4).for_each(|k| svg.sign([1.0, 2.0], k, "&"));
        let text = svg.finish();
        for (tag, n) in [("circle", 1), ("polygon", 3)] {
            assert_eq!(text.matches(&format!("<{tag} ")).count(), n);
            assert_eq!(text.matches(&format!("</{tag}>")).count(), n);
        }
        assert!(text.contains("aria-label=\"&lt;t&gt;\"") && text.contains("<title>&amp;</title>"));
    }
}
