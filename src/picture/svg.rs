//! Text of an SVG file: the few shapes that a picture is made of, numbers rounded to a hundredth of a pixel.

use std::fmt::Write as _;

/// An SVG under construction, in pixels, y downwards.
pub struct Svg {
    text: String,
}

/// Where a text stands relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Begins there.
    Start,
    /// Is centred there.
    Middle,
    /// Ends there.
    End,
}

impl Svg {
    /// An empty picture on white. `style` is CSS.
    pub fn new(width: f64, height: f64, title: &str, style: &str) -> Self {
        let (w, h) = (round(width), round(height));
        let title = escape(title);
        Self {
            text: format!(
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
                 role=\"img\">\n<title>{title}</title>\n<style>\n{style}</style>\n\
                 <rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n"
            ),
        }
    }

    /// Opens a group whose content is cut off outside a rectangle.
    pub fn open_clipped(&mut self, id: &str, [x, y, width, height]: [f64; 4]) {
        let _ = writeln!(
            self.text,
            "<clipPath id=\"{id}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n\
             <g clip-path=\"url(#{id})\">",
            round(x),
            round(y),
            round(width),
            round(height)
        );
    }

    /// Opens a group of a class, drawn with an opacity.
    pub fn open(&mut self, class: &str, opacity: f64) {
        let _ = write!(self.text, "<g class=\"{class}\"");
        if opacity < 1.0 {
            let _ = write!(self.text, " opacity=\"{}\"", round(opacity));
        }
        self.text.push_str(">\n");
    }

    /// Closes the last group.
    pub fn close(&mut self) {
        self.text.push_str("</g>\n");
    }

    /// A line.
    pub fn line(&mut self, class: &str, from: [f64; 2], to: [f64; 2]) {
        let [x1, y1, x2, y2] = [from[0], from[1], to[0], to[1]].map(round);
        let _ = writeln!(
            self.text,
            "<line class=\"{class}\" x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"/>"
        );
    }

    /// Several separate lines as one path.
    pub fn lines(&mut self, class: &str, lines: &[([f64; 2], [f64; 2])]) {
        if lines.is_empty() {
            return;
        }
        let _ = write!(self.text, "<path class=\"{class}\" d=\"");
        for (from, to) in lines {
            let [x1, y1, x2, y2] = [from[0], from[1], to[0], to[1]].map(round);
            let _ = write!(self.text, "M{x1} {y1}L{x2} {y2}");
        }
        self.text.push_str("\"/>\n");
    }

    /// A line through several points.
    pub fn polyline(&mut self, class: &str, points: &[[f64; 2]]) {
        let _ = write!(self.text, "<polyline class=\"{class}\" points=\"");
        for (i, point) in points.iter().enumerate() {
            let [x, y] = point.map(round);
            let gap = if i == 0 { "" } else { " " };
            let _ = write!(self.text, "{gap}{x},{y}");
        }
        self.text.push_str("\"/>\n");
    }

    /// A circle.
    pub fn circle(&mut self, class: &str, [x, y]: [f64; 2], radius: f64) {
        let [x, y, radius] = [x, y, radius].map(round);
        let _ = writeln!(
            self.text,
            "<circle class=\"{class}\" cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>"
        );
    }

    /// An ellipse, turned by an angle (clockwise as seen, degrees).
    pub fn ellipse(&mut self, class: &str, [x, y]: [f64; 2], semi: [f64; 2], degrees: f64) {
        let [x, y, rx, ry, turn] = [x, y, semi[0], semi[1], degrees].map(round);
        let _ = writeln!(
            self.text,
            "<ellipse class=\"{class}\" rx=\"{rx}\" ry=\"{ry}\" transform=\"translate({x} {y}) rotate({turn})\"/>"
        );
    }

    /// A rectangle.
    pub fn rectangle(&mut self, class: &str, [x, y, width, height]: [f64; 4]) {
        let [x, y, width, height] = [x, y, width, height].map(round);
        let _ = writeln!(
            self.text,
            "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/>"
        );
    }

    /// A text.
    pub fn label(&mut self, class: &str, [x, y]: [f64; 2], anchor: Anchor, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let ([x, y], text) = ([x, y].map(round), escape(text));
        let _ = writeln!(
            self.text,
            "<text class=\"{class}\" x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{text}</text>"
        );
    }

    /// The finished file.
    pub fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }
}

/// Hundredths, without a sign on zero.
fn round(value: f64) -> f64 {
    (value * 100.0).round() / 100.0 + 0.0
}

fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}
