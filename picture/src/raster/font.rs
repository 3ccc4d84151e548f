//! Text as outlines of DejaVu Sans, from left to right, with kerning. A character that the font lacks becomes a box.

use super::RasterError;
use super::style::Style;
use crate::drawing::Anchor;
use ttf_parser::{Face, GlyphId, OutlineBuilder};
use zeno::{Command, PathBuilder};

/// The outlines of a text in pixels of the raster; `scale` is the number of these per pixel of the drawing.
pub fn outlines(
    text: &str,
    [x, y]: [f64; 2],
    anchor: Anchor,
    style: &Style,
    scale: f64,
) -> Result<Vec<Command>, RasterError> {
    let data = match style.bold {
        true => dejavu::sans::bold(),
        false => dejavu::sans::regular(),
    };
    let face = Face::parse(data, 0).map_err(|e| RasterError::Font(e.to_string()))?;
    // words are separated by one space, as in SVG
    let words = text.split(|c: char| c.is_whitespace() || c.is_control());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    let words = words.join(" ");
    let glyphs = words
        .chars()
        .map(|c| face.glyph_index(c).unwrap_or_default());
    let mut places = Vec::new();
    let mut width = 0.0;
    for glyph in glyphs {
        if let Some((_, before)) = places.last() {
            width += f64::from(kerning(&face, *before, glyph));
        }
        places.push((width, glyph));
        width += f64::from(face.glyph_hor_advance(glyph).unwrap_or(0));
    }
    let size = f64::from(style.font_size) * scale / f64::from(face.units_per_em());
    let start = match anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => 0.5 * width,
        Anchor::End => width,
    };
    let mut outline = Outline {
        path: Vec::new(),
        size: size as f32,
        origin: [0.0; 2],
    };
    for (place, glyph) in places {
        outline.origin = [scale * x + size * (place - start), scale * y].map(|at| at as f32);
        // a glyph without a bounding box, such as a space, has no outline
        let _ = face.outline_glyph(glyph, &mut outline);
    }
    Ok(outline.path)
}

fn kerning(face: &Face<'_>, left: GlyphId, right: GlyphId) -> i16 {
    let tables = face.tables().kern.iter().flat_map(|kern| kern.subtables);
    let horizontal = tables.filter(|table| table.horizontal && !table.variable);
    let values = horizontal.filter_map(|table| table.glyphs_kerning(left, right));
    values.sum()
}

/// The outline of a glyph, moved to its place: converts from font units (y upwards) to pixels (y downwards).
struct Outline {
    path: Vec<Command>,
    size: f32,
    origin: [f32; 2],
}

impl Outline {
    fn point(&self, x: f32, y: f32) -> [f32; 2] {
        let [left, base] = self.origin;
        [left + self.size * x, base - self.size * y]
    }
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        let to = self.point(x, y);
        self.path.move_to(to);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let to = self.point(x, y);
        self.path.line_to(to);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let (control, to) = (self.point(x1, y1), self.point(x, y));
        self.path.quad_to(control, to);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let controls = (self.point(x1, y1), self.point(x2, y2));
        let to = self.point(x, y);
        self.path.curve_to(controls.0, controls.1, to);
    }

    fn close(&mut self) {
        self.path.close();
    }
}
