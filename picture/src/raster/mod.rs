//! Draws a [`Drawing`] as pixels (PNG). The font is part of the program, so the text does not depend on the fonts of
//! the machine. SVG files cannot be drawn.

mod canvas;
mod font;
mod png;
mod style;

use crate::drawing::{Drawing, Item, Shape};
use canvas::Canvas;
use style::{Rules, Style};
use zeno::{Command, Fill, PathBuilder, Stroke, Transform};

/// The picture could not be drawn.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RasterError {
    /// The style has an unknown rule.
    #[error(
        "the picture cannot be drawn as pixels: its style has \"{0}\"\n  help: write it as .svg"
    )]
    Style(String),
    /// Width and height in pixels.
    #[error(
        "the picture cannot be drawn as pixels: its size {} x {} is too large, or 0\n  help: write it as .svg",
        .0[0],
        .0[1]
    )]
    Size([f64; 2]),
    /// The coordinates of a shape are too far outside, or not finite.
    #[error(
        "the picture cannot be drawn as pixels: a shape lies at ({}, {})\n  help: write it as .svg",
        .0[0],
        .0[1]
    )]
    Place([f32; 2]),
    /// The font cannot be read.
    #[error("the picture cannot be drawn as pixels: its font: {0}\n  help: write it as .svg")]
    Font(String),
}

/// Pixels of the raster for each pixel of the drawing, so that pictures are sharp on screens of high resolution and in
/// print.
const SCALE: f64 = 2.0;

/// Largest distance of a shape from the corner of the picture \[pixels\]; shapes beyond are refused, because the
/// library would overflow.
const FARTHEST: f32 = 1e5;

/// The PNG of a drawing.
///
/// # Errors
/// The style is not known, or the picture is too large.
pub fn png(drawing: &Drawing) -> Result<Vec<u8>, RasterError> {
    let (size, points) = points(drawing)?;
    Ok(png::encode(size, &points))
}

/// True if these are the first bytes of a file that [`png()`] made.
pub fn is_own_png(begin: &[u8]) -> bool {
    png::is_own(begin)
}

/// Width and height; and red, green, blue of each pixel.
fn points(drawing: &Drawing) -> Result<([usize; 2], Vec<u8>), RasterError> {
    let rules = Rules::read(&drawing.style)?;
    let mut canvas = Canvas::new(drawing.size.map(|length| (SCALE * length).ceil()))?;
    for item in &drawing.items {
        match item {
            Item::Clip { rectangle, .. } => {
                let [x, y, width, height] = *rectangle;
                let edges = [x, y, x + width, y + height];
                canvas.open_clipped(edges.map(|edge| (SCALE * edge) as f32));
            }
            // shapes do not inherit the style of their group here
            Item::Group { class, .. } if rules.any("g", class) => {
                return Err(RasterError::Style(format!("g.{class}")));
            }
            Item::Group { opacity, .. } => canvas.open(*opacity as f32),
            Item::Close => canvas.close(),
            Item::Shape { class, shape } => {
                let style = rules.style(shape.element(), class);
                paint(&mut canvas, &path(shape, &style)?, &style)?;
            }
        }
    }
    Ok(canvas.finish())
}

/// The outline of a shape in pixels of the raster.
fn path(shape: &Shape, style: &Style) -> Result<Vec<Command>, RasterError> {
    let mut path: Vec<Command> = Vec::new();
    let scaled = |at: &[f64; 2]| at.map(|part| (SCALE * part) as f32);
    let length = |length: f64| (SCALE * length) as f32;
    match shape {
        Shape::Line([from, to]) => {
            path.move_to(scaled(from)).line_to(scaled(to));
        }
        Shape::Lines(lines) => {
            for [from, to] in lines {
                path.move_to(scaled(from)).line_to(scaled(to));
            }
        }
        Shape::Polyline(points) => {
            let mut points = points.iter().map(scaled);
            path.extend(points.next().map(|at| Command::MoveTo(at.into())));
            path.extend(points.map(|at| Command::LineTo(at.into())));
        }
        Shape::Circle { centre, radius } => {
            path.add_circle(scaled(centre), length(*radius));
        }
        Shape::Ellipse {
            centre,
            semi,
            degrees,
        } => {
            path.add_ellipse([0.0, 0.0], length(semi[0]), length(semi[1]));
            let [x, y] = scaled(centre);
            let turn = Transform::rotation(zeno::Angle::from_degrees(*degrees as f32));
            let place = turn.then_translate(x, y);
            path = path.iter().map(|part| part.transform(&place)).collect();
        }
        Shape::Rectangle([x, y, width, height]) => {
            path.add_rect(scaled(&[*x, *y]), length(*width), length(*height));
        }
        Shape::Text { at, anchor, text } => {
            return font::outlines(text, *at, *anchor, style, SCALE);
        }
    }
    Ok(path)
}

/// Paints the inside of a path, then its stroke.
fn paint(canvas: &mut Canvas, path: &[Command], style: &Style) -> Result<(), RasterError> {
    let points = path.iter().flat_map(|part| match *part {
        Command::MoveTo(a) | Command::LineTo(a) => vec![a],
        Command::QuadTo(a, b) => vec![a, b],
        Command::CurveTo(a, b, c) => vec![a, b, c],
        Command::Close => Vec::new(),
    });
    let near = |part: f32| part.abs() <= FARTHEST;
    if let Some(at) = points.into_iter().find(|at| !near(at.x) || !near(at.y)) {
        return Err(RasterError::Place([at.x, at.y]));
    }
    if let Some(colour) = style.fill {
        canvas.paint(path, Fill::NonZero.into(), colour, style.fill_opacity);
    }
    if let Some(colour) = style.stroke {
        let scale = SCALE as f32;
        let dashes: Vec<f32> = style.dashes.iter().map(|length| length * scale).collect();
        let mut stroke = Stroke::new(style.stroke_width * scale);
        stroke.cap(style.cap).join(style.join).dash(&dashes, 0.0);
        canvas.paint(path, stroke.into(), colour, style.stroke_opacity);
    }
    Ok(())
}

#[cfg(test)]
mod tests;
