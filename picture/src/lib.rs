//! Pictures: a few kinds of shapes, placed to a hundredth of a pixel, written as lines (SVG) or as points (PNG); axes of charts.
//!
//! | module | what it holds |
//! |---|---|
//! | [`drawing`] | a picture as the shapes that it is made of |
//! | [`chart`] | a frame with axes, round ticks and a legend |
//! | [`raster`] | PNG, with a font that is part of the program |
//! | [`text`] | lines of a length |

pub mod chart;
pub mod drawing;
pub mod raster;
mod svg;
pub mod text;

pub use drawing::{Anchor, Drawing};
pub use raster::RasterError;

use std::path::Path;

/// How a picture is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    /// Lines.
    #[default]
    Svg,
    /// Points.
    Png,
}

impl Format {
    /// All of them.
    pub const ALL: [Format; 2] = [Format::Svg, Format::Png];

    /// How the names of its files end.
    pub const fn ending(self) -> &'static str {
        match self {
            Format::Svg => "svg",
            Format::Png => "png",
        }
    }

    /// The format whose files end so, in small letters or capitals.
    pub fn named(ending: &str) -> Option<Format> {
        let ends = |format: &Format| format.ending().eq_ignore_ascii_case(ending);
        Format::ALL.into_iter().find(ends)
    }

    /// That of a file, by how its name ends; `None` where it ends otherwise.
    pub fn of(path: &Path) -> Option<Format> {
        Format::named(path.extension()?.to_str()?)
    }
}
