//! Draws every response over every parameter, one point for each run; a sample of the runs if there are many.

use crate::design::permutation::Permutation;
use crate::study::Study;
use crate::summary::sample::Sample;
use crate::table::csv::heading;
use bryant_picture::chart::{self, Axes, range};
use bryant_picture::text::{typeset, wrap};
use bryant_picture::{Anchor, Drawing};

/// Sizes of a panel and of its frame, and offset of the frame from the panel's corner, in pixels.
const PANEL: [f64; 2] = [300.0, 240.0];
const FRAME: [f64; 2] = [214.0, 150.0];
const CORNER: [f64; 2] = [70.0, 46.0];
/// Number of characters of a name that fit in one line.
const NAME: usize = 36;
/// Share of a range that stays empty at either end.
const MARGIN: f64 = 0.04;
/// Largest number of points in a panel.
const MOST_POINTS: usize = 2000;
/// Largest number of points in the picture.
const MOST_IN_ALL: usize = 60_000;

/// Draws the picture: a row for each response, a column for each parameter.
pub fn draw(study: &Study, sample: &Sample) -> Drawing {
    let (columns, rows) = (study.varied.len(), study.responses.len());
    let most = MOST_POINTS
        .min(MOST_IN_ALL / (columns * rows).max(1))
        .max(1);
    // taking every n-th row would miss values of a grid
    let order = Permutation::new(sample.count as u64, 0, 0);
    let chosen: Vec<usize> = (0..sample.count.min(most))
        .map(|k| order.of(k as u64) as usize)
        .collect();
    let style = chart::style() + ".point{fill:#0072b2;fill-opacity:.5}\n";
    let size = [columns as f64 * PANEL[0], rows as f64 * PANEL[1] + 8.0];
    let title = format!("responses of {} over its parameters", study.model);
    let mut drawing = Drawing::new(size[0], size[1], &title, &style);
    for (response, parameter) in (0..rows).flat_map(|r| (0..columns).map(move |p| (r, p))) {
        let point = |row: &usize| {
            let value = sample.values[row * columns + parameter];
            [value, sample.responses[row * rows + response]]
        };
        let points: Vec<[f64; 2]> = chosen.iter().map(point).collect();
        let ranges = [0, 1].map(|axis| range(points.iter().map(|point| point[axis]), MARGIN));
        let corner = [
            parameter as f64 * PANEL[0] + CORNER[0],
            response as f64 * PANEL[1] + CORNER[1],
        ];
        let axes = Axes::new([corner[0], corner[1], FRAME[0], FRAME[1]], ranges);
        let (x, y) = (&study.varied[parameter], &study.responses[response]);
        axes.draw(&mut drawing, [&heading(&x.name, &typeset(&x.unit)), ""]);
        let lines = wrap(&heading(&y.name, &typeset(&y.unit.name)), NAME);
        for (index, line) in lines.iter().rev().enumerate() {
            let at = [corner[0] - 54.0, corner[1] - 8.0 - 14.0 * index as f64];
            drawing.label("axis", at, Anchor::Start, line);
        }
        for point in points.iter().filter(|point| point[1].is_finite()) {
            drawing.circle("point", axes.place(*point), 1.3);
        }
    }
    drawing
}
