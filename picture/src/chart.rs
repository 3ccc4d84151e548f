//! Charts: axes in a frame with a grid, names and round ticks (at least three if they fit), and a legend above the
//! frame.

use crate::drawing::{Anchor, Drawing};
use crate::text::wrap;
use std::ops::Range;

/// Colours that remain distinct in print and for the colour-blind (Okabe and Ito).
pub const COLOURS: [&str; 6] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#7a5195", "#8c6d1f",
];

/// The style of axes, and of lines with the classes `c0`, `c1` …, which have the [`COLOURS`].
pub fn style() -> String {
    let mut style = "\
text{font-family:'DejaVu Sans',Arial,Helvetica,sans-serif;font-size:12px;fill:#222}
.title{font-size:16px;font-weight:bold}
.tick{font-size:11px;fill:#444}
.panel{fill:none;stroke:#999;stroke-width:1}
.grid{stroke:#e1e1e1;stroke-width:1;fill:none}
.curve{fill:none;stroke-width:1.8;stroke-linejoin:round;stroke-linecap:round}
"
    .to_owned();
    for (index, colour) in COLOURS.iter().enumerate() {
        style.push_str(&format!(".c{index}{{stroke:{colour}}}\n"));
    }
    style
}

/// Least number of labelled ticks of an axis, if they fit.
const TICKED: usize = 3;
/// Width of a character in pixels: in the label of a tick, and in a name.
const DIGIT: f64 = 7.0;
const LETTER: f64 = 7.4;
/// Distance between lines of text in pixels.
const LINE: f64 = 15.0;

/// Axes in a frame.
#[derive(Clone, Debug)]
pub struct Axes {
    /// Left, top, width, height \[px\].
    pub frame: [f64; 4],
    /// The ranges of values, horizontally and vertically.
    pub ranges: [Range<f64>; 2],
    /// The values of the ticks, horizontally and vertically.
    pub ticks: [Vec<f64>; 2],
    /// The label of a tick, for its value and the distance between ticks, horizontally and vertically.
    pub labels: [fn(f64, f64) -> String; 2],
}

impl Axes {
    /// Axes with round ticks. The ranges must not be empty.
    pub fn new(frame: [f64; 4], ranges: [Range<f64>; 2]) -> Self {
        let across = |step: f64| {
            let widest = multiples(step, &ranges[0])
                .into_iter()
                .map(|x| label(x, step).chars().count());
            DIGIT * widest.max().unwrap_or(0) as f64 + 10.0
        };
        let ticks = [
            ticks(&ranges[0], frame[2], across),
            ticks(&ranges[1], frame[3], |_| 2.0 * LINE),
        ];
        Axes {
            frame,
            ranges,
            ticks,
            labels: [label; 2],
        }
    }

    /// The place of a point in the drawing \[px\].
    pub fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, width, height] = self.frame;
        let share =
            |range: &Range<f64>, value: f64| (value - range.start) / (range.end - range.start);
        [
            left + width * share(&self.ranges[0], x),
            top + height * (1.0 - share(&self.ranges[1], y)),
        ]
    }

    /// Draws the grid, the ticks with their labels, the frame and the names. The name of the horizontal axis is below
    /// it, that of the vertical axis above it on the left.
    pub fn draw(&self, drawing: &mut Drawing, [across, upwards]: [&str; 2]) {
        let [left, top, width, height] = self.frame;
        let mut grid = Vec::new();
        for x in &self.ticks[0] {
            let [at, _] = self.place([*x, self.ranges[1].start]);
            grid.push(([at, top], [at, top + height]));
            let text = self.labels[0](*x, step(&self.ticks[0]));
            drawing.label("tick", [at, top + height + 16.0], Anchor::Middle, &text);
        }
        for y in &self.ticks[1] {
            let [_, at] = self.place([self.ranges[0].start, *y]);
            grid.push(([left, at], [left + width, at]));
            let text = self.labels[1](*y, step(&self.ticks[1]));
            drawing.label("tick", [left - 6.0, at + 4.0], Anchor::End, &text);
        }
        drawing.lines("grid", &grid);
        drawing.rectangle("panel", self.frame);
        let below = [left + 0.5 * width, top + height + 34.0];
        drawing.label("axis", below, Anchor::Middle, across);
        let above = [(left - 50.0).max(4.0), top - 9.0];
        drawing.label("axis", above, Anchor::Start, upwards);
    }
}

/// The range from the least to the largest finite value, with a margin of this share of the span at either end; never
/// empty.
pub fn range(values: impl Iterator<Item = f64>, share: f64) -> Range<f64> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values.filter(|value| value.is_finite()) {
        (low, high) = (low.min(value), high.max(value));
    }
    if low > high {
        return 0.0..1.0;
    }
    // values that differ only by rounding count as one, because no ticks fit between them
    let span = high - low;
    let size = low.abs().max(high.abs());
    let margin = match span > 1e-10 * size {
        true => share * span,
        false if size > 0.0 => 0.5 * size,
        false => 0.5,
    };
    low - margin..high + margin
}

/// The height \[px\] of a legend with these names, if the frame is `across` pixels wide.
pub fn legend_height(names: &[&str], across: f64) -> f64 {
    LINE * rows(names, across).len() as f64
}

/// Draws the legend with its upper left corner at this point, in at most `across` pixels.
pub fn legend(drawing: &mut Drawing, [left, top]: [f64; 2], across: f64, names: &[&str]) {
    for (row, entries) in rows(names, across).iter().enumerate() {
        let y = top + LINE * (row as f64 + 0.5);
        for (x, index) in entries {
            let class = format!("curve c{}", index % COLOURS.len());
            let x = left + x;
            drawing.line(&class, [x, y], [x + 20.0, y]);
            drawing.label("axis", [x + 26.0, y + 4.0], Anchor::Start, names[*index]);
        }
    }
}

/// The lines of a legend, each with the horizontal position and the index of its entries.
fn rows(names: &[&str], across: f64) -> Vec<Vec<(f64, usize)>> {
    let mut rows: Vec<Vec<(f64, usize)>> = Vec::new();
    let mut x = f64::INFINITY;
    for (index, name) in names.iter().enumerate() {
        let width = 44.0 + LETTER * name.chars().count() as f64;
        if x + width > across {
            rows.push(Vec::new());
            x = 0.0;
        }
        if let Some(row) = rows.last_mut() {
            row.push((x, index));
        }
        x += width;
    }
    rows
}

/// Draws a title with its upper left corner at this point, in as many lines as it needs; returns its height in pixels.
pub fn title(drawing: &mut Drawing, [left, top]: [f64; 2], across: f64, text: &str) -> f64 {
    let lines = title_lines(text, across);
    for (index, line) in lines.iter().enumerate() {
        let y = top + 16.0 + 21.0 * index as f64;
        drawing.label("title", [left, y], Anchor::Start, line);
    }
    21.0 * lines.len() as f64
}

/// The lines of a title that is at most `across` pixels wide.
pub fn title_lines(text: &str, across: f64) -> Vec<String> {
    wrap(text, (across / 11.2) as usize)
}

/// Round numbers in a range for ticks: as many as fit easily, else three if three fit at all. `room` returns the size
/// of a label \[px\] for ticks at a distance.
fn ticks(range: &Range<f64>, pixels: f64, room: impl Fn(f64) -> f64) -> Vec<f64> {
    let span = range.end - range.start;
    let fits = |step: &f64, ease: f64| step / span * pixels >= ease * room(*step);
    // from coarse to fine
    let coarsest = round_above(span);
    let steps =
        || std::iter::successors(Some(coarsest), |step| Some(round_above(0.39 * step))).take(9);
    let easily = steps().take_while(|step| fits(step, 1.5)).last();
    let first = easily.unwrap_or(coarsest);
    let mut best = multiples(first, range);
    for step in steps().skip_while(|step| *step >= first) {
        if best.len() >= TICKED || !fits(&step, 0.75) {
            break;
        }
        best = multiples(step, range);
    }
    best
}

/// 10^`exponent`: exact for whole numbers up to 10²², and the nearest double for their reciprocals.
pub fn power_of_ten(exponent: i32) -> f64 {
    let power = libm::pow(10.0, f64::from(exponent.abs()));
    if exponent < 0 { 1.0 / power } else { power }
}

/// The smallest number that is 1, 2 or 5 times a power of ten and not below `value`, which is positive.
fn round_above(value: f64) -> f64 {
    let power = power_of_ten(libm::log10(value).floor() as i32);
    let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * power >= value);
    factor.unwrap_or(10.0) * power
}

/// The multiples of a step in a range.
fn multiples(step: f64, range: &Range<f64>) -> Vec<f64> {
    let (first, last) = (range.start / step, range.end / step);
    // larger multiples cannot be distinguished as doubles
    let farthest = first.abs().max(last.abs());
    if farthest.is_nan() || farthest >= 1e12 {
        return vec![range.start, range.end];
    }
    let (first, last) = ((first - 1e-9).ceil() as i64, (last + 1e-9).floor() as i64);
    (first..=last).map(|k| k as f64 * step).collect()
}

/// The distance between ticks.
fn step(ticks: &[f64]) -> f64 {
    match ticks {
        [a, b, ..] => b - a,
        [a] if *a != 0.0 => a.abs(),
        _ => 1.0,
    }
}

/// The label of a tick, with as many digits as distinguish ticks at a distance of `step`.
pub fn label(value: f64, step: f64) -> String {
    let power = libm::log10(step * (1.0 + 1e-9)).floor();
    let size = value.abs();
    let text = match size {
        _ if size < 1e-6 * step => "0".to_owned(),
        _ if size >= 1e6 || (power < -5.0 && size < 1e-2) => {
            let digits = (libm::log10(size).floor() - power).clamp(0.0, 12.0) as usize;
            format!("{value:.digits$e}")
        }
        _ => format!("{value:.*}", (-power).clamp(0.0, 12.0) as usize),
    };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_has_three_round_ticks() {
        for (range, pixels) in [
            (0.0..0.16, 600.0),
            (-0.004..0.113, 160.0),
            (0.97..1.03, 150.0),
            (-2813.0..2.0, 150.0),
            (0.999_2..1.000_9, 300.0),
            (-6.3e-9..1.9e-9, 170.0),
            (4.1e6..9.9e6, 200.0),
            (0.0..1.02, 560.0),
        ] {
            let axes = Axes::new([0.0, 0.0, pixels, 150.0], [range.clone(), range.clone()]);
            for ticks in &axes.ticks {
                assert!(ticks.len() >= TICKED, "{range:?}: {ticks:?}");
                let labels: Vec<String> = ticks.iter().map(|x| label(*x, step(ticks))).collect();
                for pair in labels.windows(2) {
                    assert_ne!(pair[0], pair[1], "{range:?}: {labels:?}");
                }
                // each label stands for the value of its tick
                for (text, tick) in labels.iter().zip(ticks) {
                    let read: f64 = text.replace('−', "-").parse().unwrap();
                    assert!((read - tick).abs() < 1e-6 * step(ticks), "{text}, {tick}");
                }
            }
            // the labels of the horizontal axis do not overlap
            let ticks = &axes.ticks[0];
            let apart = axes.place([ticks[1], 0.0])[0] - axes.place([ticks[0], 0.0])[0];
            let widest = ticks
                .iter()
                .map(|x| label(*x, step(ticks)).chars().count())
                .max();
            assert!(apart > 6.6 * widest.unwrap() as f64, "{range:?}: {ticks:?}");
        }
    }

    #[test]
    fn ranges_are_never_empty() {
        let of = |values: &[f64]| range(values.iter().copied(), 0.1);
        assert_eq!(of(&[]), 0.0..1.0);
        assert_eq!(of(&[f64::NAN, f64::INFINITY]), 0.0..1.0);
        assert_eq!(of(&[2.0, 2.0]), 1.0..3.0);
        assert_eq!(of(&[0.0]), -0.5..0.5);
        assert_eq!(of(&[0.0, f64::NAN, 10.0]), -1.0..11.0);
        let rounding = of(&[1.0, 1.0 + f64::EPSILON]);
        assert!(rounding.start < 0.6 && rounding.end > 1.4);
    }

    #[test]
    fn places_are_in_the_frame() {
        let axes = Axes::new([10.0, 20.0, 100.0, 50.0], [0.0..2.0, -1.0..1.0]);
        assert_eq!(axes.place([0.0, -1.0]), [10.0, 70.0]);
        assert_eq!(axes.place([2.0, 1.0]), [110.0, 20.0]);
        assert_eq!(axes.place([1.0, 0.0]), [60.0, 45.0]);
    }

    #[test]
    fn a_legend_has_every_name_and_keeps_to_its_width() {
        let names = [
            "belt force",
            "friction",
            "the force of a strap with a long name",
        ];
        let rows = rows(&names, 260.0);
        assert_eq!(rows.len(), 2);
        assert_eq!(rows.iter().flatten().count(), 3);
        assert_eq!(legend_height(&names, 260.0), 30.0);
    }
}
