//! A picture as a list of shapes, which is written as vector graphics (`svg`) or as pixels ([`crate::raster`]). Numbers
//! are rounded to a hundredth of a pixel, so that both formats show the same.

use crate::raster::{self, RasterError};
use crate::{Format, svg};

/// A picture under construction: coordinates in pixels, y downwards, a white background.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    pub(crate) size: [f64; 2],
    pub(crate) title: String,
    /// The style sheet in CSS.
    pub(crate) style: String,
    pub(crate) items: Vec<Item>,
}

/// An item of a drawing, in the order of painting.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Item {
    /// All items up to the matching `Close` are clipped by a rectangle.
    Clip { id: String, rectangle: [f64; 4] },
    /// All items up to the matching `Close` are drawn with an opacity.
    Group { class: String, opacity: f64 },
    /// Ends the last group.
    Close,
    /// A shape, drawn in the style of its classes.
    Shape { class: String, shape: Shape },
}

/// A shape. All lengths are in pixels.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Shape {
    Line([[f64; 2]; 2]),
    Lines(Vec<[[f64; 2]; 2]>),
    Polyline(Vec<[f64; 2]>),
    Circle {
        centre: [f64; 2],
        radius: f64,
    },
    Ellipse {
        centre: [f64; 2],
        semi: [f64; 2],
        /// Rotation, clockwise on the screen.
        degrees: f64,
    },
    /// Left, top, width, height.
    Rectangle([f64; 4]),
    Text {
        at: [f64; 2],
        anchor: Anchor,
        text: String,
    },
}

/// The position of a text relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// The text begins at the point.
    Start,
    /// The text is centred at the point.
    Middle,
    /// The text ends at the point.
    End,
}

impl Drawing {
    /// An empty picture. `style` is CSS.
    pub fn new(width: f64, height: f64, title: &str, style: &str) -> Self {
        Self {
            size: [width, height].map(round),
            title: title.to_owned(),
            style: style.to_owned(),
            items: Vec::new(),
        }
    }

    /// The text of the picture as an SVG file.
    pub fn svg(&self) -> String {
        svg::text(self)
    }

    /// The bytes of the picture as a PNG file.
    ///
    /// # Errors
    /// The style is not known, or the picture is too large.
    pub fn png(&self) -> Result<Vec<u8>, RasterError> {
        raster::png(self)
    }

    /// The bytes of the picture's file.
    ///
    /// # Errors
    /// Those of [`Drawing::png`].
    pub fn bytes(&self, format: Format) -> Result<Vec<u8>, RasterError> {
        match format {
            Format::Png => self.png(),
            Format::Svg => Ok(self.svg().into_bytes()),
        }
    }

    /// Opens a group that is clipped to a rectangle.
    pub fn open_clipped(&mut self, id: &str, rectangle: [f64; 4]) {
        self.items.push(Item::Clip {
            id: id.to_owned(),
            rectangle: rectangle.map(round),
        });
    }

    /// Opens a group with a class and an opacity.
    pub fn open(&mut self, class: &str, opacity: f64) {
        self.items.push(Item::Group {
            class: class.to_owned(),
            opacity: round(opacity),
        });
    }

    /// Closes the group that was opened last.
    pub fn close(&mut self) {
        self.items.push(Item::Close);
    }

    /// A line.
    pub fn line(&mut self, class: &str, from: [f64; 2], to: [f64; 2]) {
        self.add(class, Shape::Line([from, to].map(point)));
    }

    /// Several separate lines as one path.
    pub fn lines(&mut self, class: &str, lines: &[([f64; 2], [f64; 2])]) {
        if lines.is_empty() {
            return;
        }
        let lines = lines.iter().map(|(from, to)| [*from, *to].map(point));
        self.add(class, Shape::Lines(lines.collect()));
    }

    /// A line through several points.
    pub fn polyline(&mut self, class: &str, points: &[[f64; 2]]) {
        let points = points.iter().copied().map(point).collect();
        self.add(class, Shape::Polyline(points));
    }

    /// A circle.
    pub fn circle(&mut self, class: &str, centre: [f64; 2], radius: f64) {
        let (centre, radius) = (point(centre), round(radius));
        self.add(class, Shape::Circle { centre, radius });
    }

    /// An ellipse, rotated by an angle (clockwise on the screen, degrees). For a circle the angle is set to 0, because
    /// otherwise rounding would decide it.
    pub fn ellipse(&mut self, class: &str, centre: [f64; 2], semi: [f64; 2], degrees: f64) {
        let semi = point(semi);
        let is_circle = semi[0] == semi[1];
        let shape = Shape::Ellipse {
            centre: point(centre),
            semi,
            degrees: if is_circle { 0.0 } else { round(degrees) },
        };
        self.add(class, shape);
    }

    /// A rectangle: left, top, width, height.
    pub fn rectangle(&mut self, class: &str, rectangle: [f64; 4]) {
        self.add(class, Shape::Rectangle(rectangle.map(round)));
    }

    /// A text.
    pub fn label(&mut self, class: &str, at: [f64; 2], anchor: Anchor, text: &str) {
        let (at, text) = (point(at), text.to_owned());
        self.add(class, Shape::Text { at, anchor, text });
    }

    fn add(&mut self, class: &str, shape: Shape) {
        let class = class.to_owned();
        self.items.push(Item::Shape { class, shape });
    }
}

fn point(point: [f64; 2]) -> [f64; 2] {
    point.map(round)
}

/// The value rounded to hundredths; zero has no sign.
fn round(value: f64) -> f64 {
    (value * 100.0).round() / 100.0 + 0.0
}
