//! Pictures of a study, as self-contained SVG: every response over every parameter, and which parameters its variance comes from.

pub mod scatter;
pub mod tornado;

use plotters::style::RGBColor;
use std::ops::Range;

/// A picture could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the picture cannot be drawn: {0}")]
pub struct PictureError(pub String);

/// Colours that remain distinct in print and for the colour-blind (Okabe and Ito).
const BLUE: RGBColor = RGBColor(0, 114, 178);
const ORANGE: RGBColor = RGBColor(230, 159, 0);
const GREY: RGBColor = RGBColor(225, 225, 225);

/// From the least to the largest finite value, with a margin; never empty.
fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values.filter(|value| value.is_finite()) {
        (low, high) = (low.min(value), high.max(value));
    }
    if low > high {
        return 0.0..1.0;
    }
    let margin = 0.04 * (high - low);
    // a single value still needs an axis on both sides of it
    let margin = match low.abs() {
        _ if margin > 0.0 => margin,
        0.0 => 0.5,
        size => 0.5 * size,
    };
    low - margin..high + margin
}

/// A number of an axis, with as many digits as tell its marks apart.
fn label(value: f64, over: &Range<f64>) -> String {
    let span = over.end - over.start;
    let largest = over.start.abs().max(over.end.abs());
    if !(1e-3..1e5).contains(&largest) {
        return format!("{value:.2e}");
    }
    let decimals = (1.5 - span.log10()).ceil().clamp(0.0, 6.0) as usize;
    let text = format!("{value:.decimals$}");
    // no sign on zero
    if text
        .trim_start_matches('-')
        .chars()
        .all(|c| c == '0' || c == '.')
    {
        text.trim_start_matches('-').to_owned()
    } else {
        text
    }
}
