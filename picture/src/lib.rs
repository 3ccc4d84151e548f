//! Pictures: a few kinds of shapes, written as vector graphics (SVG) or as pixels (PNG), and charts with axes.
//!
//! | module | what it holds |
//! |---|---|
//! | [`drawing`] | a picture as a list of shapes |
//! | [`chart`] | a frame with axes, round ticks and a legend |
//! | [`raster`] | PNG, with a font that is part of the program |
//! | [`text`] | splits text into lines |
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod chart;
pub mod drawing;
pub mod raster;
mod svg;
pub mod text;

pub use drawing::{Anchor, Drawing};
pub use raster::{RasterError, is_own_png};

use std::path::Path;

/// The format of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    /// Vector graphics.
    #[default]
    Svg,
    /// Pixels.
    Png,
}

impl Format {
    /// All formats.
    pub const ALL: [Format; 2] = [Format::Svg, Format::Png];

    /// The extension of its files.
    pub const fn ending(self) -> &'static str {
        match self {
            Format::Svg => "svg",
            Format::Png => "png",
        }
    }

    /// The format whose files have this extension, whose case does not matter.
    pub fn named(ending: &str) -> Option<Format> {
        let ends = |format: &Format| format.ending().eq_ignore_ascii_case(ending);
        Format::ALL.into_iter().find(ends)
    }

    /// The format of a file by its extension; `None` for other extensions.
    pub fn of(path: &Path) -> Option<Format> {
        Format::named(path.extension()?.to_str()?)
    }
}
