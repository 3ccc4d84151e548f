//! The text of an SVG file.

use super::drawing::{Anchor, Drawing, Item, Shape};
use std::fmt::Write as _;

/// Where a screen is dark, light and dark change places, and hues stay.
const IN_THE_DARK: &str =
    "@media screen and (prefers-color-scheme:dark){svg{filter:invert(.9) hue-rotate(180deg)}}\n";

/// The file of a drawing.
pub fn text(drawing: &Drawing) -> String {
    let ([w, h], title, style) = (drawing.size, escape(&drawing.title), &drawing.style);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
         role=\"img\">\n<title>{title}</title>\n<style>\n{style}{IN_THE_DARK}</style>\n\
         <rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n"
    );
    for item in &drawing.items {
        // writing to a string cannot fail
        let _ = write_item(&mut text, item);
        text.push('\n');
    }
    text.push_str("</svg>\n");
    text
}

fn write_item(out: &mut String, item: &Item) -> std::fmt::Result {
    match item {
        Item::Clip {
            id,
            rectangle: [x, y, width, height],
        } => write!(
            out,
            "<clipPath id=\"{id}\"><rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/></clipPath>\n\
             <g clip-path=\"url(#{id})\">"
        ),
        Item::Group { class, opacity } if *opacity < 1.0 => {
            write!(out, "<g class=\"{class}\" opacity=\"{opacity}\">")
        }
        Item::Group { class, .. } => write!(out, "<g class=\"{class}\">"),
        Item::Close => write!(out, "</g>"),
        Item::Shape { class, shape } => {
            write!(out, "<{} class=\"{class}\"", shape.element())?;
            write_shape(out, shape)
        }
    }
}

/// Writes the attributes of a shape that follow its class.
fn write_shape(out: &mut String, shape: &Shape) -> std::fmt::Result {
    match shape {
        Shape::Line([[x1, y1], [x2, y2]]) => {
            write!(out, " x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"/>")
        }
        Shape::Lines(lines) => {
            out.push_str(" d=\"");
            for [[x1, y1], [x2, y2]] in lines {
                write!(out, "M{x1} {y1}L{x2} {y2}")?;
            }
            write!(out, "\"/>")
        }
        Shape::Polyline(points) => {
            let points: Vec<String> = points.iter().map(|[x, y]| format!("{x},{y}")).collect();
            write!(out, " points=\"{}\"/>", points.join(" "))
        }
        Shape::Circle {
            centre: [x, y],
            radius,
        } => write!(out, " cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>"),
        Shape::Ellipse {
            centre: [x, y],
            semi: [rx, ry],
            degrees,
        } => write!(
            out,
            " rx=\"{rx}\" ry=\"{ry}\" transform=\"translate({x} {y}) rotate({degrees})\"/>"
        ),
        Shape::Rectangle([x, y, width, height]) => write!(
            out,
            " x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/>"
        ),
        Shape::Text {
            at: [x, y],
            anchor,
            text,
        } => {
            let anchor = match anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let text = escape(text);
            write!(
                out,
                " x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\">{text}</text>"
            )
        }
    }
}

impl Shape {
    /// The name of its SVG element, which selectors use.
    pub fn element(&self) -> &'static str {
        match self {
            Shape::Line(_) => "line",
            Shape::Lines(_) => "path",
            Shape::Polyline(_) => "polyline",
            Shape::Circle { .. } => "circle",
            Shape::Ellipse { .. } => "ellipse",
            Shape::Rectangle(_) => "rect",
            Shape::Text { .. } => "text",
        }
    }
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
