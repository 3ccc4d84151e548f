//! Every response over every parameter, a point per run; a sample of the runs where they are many.

use super::{BLUE, GREY, PictureError, label, range};
use crate::design::permutation::Permutation;
use crate::study::Study;
use crate::summary::sample::Sample;
use crate::table::csv::heading;
use plotters::prelude::*;

/// Pixels of a panel.
const PANEL: (u32, u32) = (230, 190);
/// Points of a panel at most.
const MOST_POINTS: usize = 2000;
/// Points of the picture at most.
const MOST_IN_ALL: usize = 60_000;

/// Draws the picture: a row per response, a column per parameter.
///
/// # Errors
/// The drawing library fails.
pub fn draw(study: &Study, sample: &Sample) -> Result<String, PictureError> {
    let mut svg = String::new();
    panels(&mut svg, study, sample).map_err(|error| PictureError(error.to_string()))?;
    Ok(svg)
}

fn panels(
    svg: &mut String,
    study: &Study,
    sample: &Sample,
) -> Result<(), Box<dyn std::error::Error>> {
    let (columns, rows) = (study.varied.len(), study.responses.len());
    let most = MOST_POINTS
        .min(MOST_IN_ALL / (columns * rows).max(1))
        .max(1);
    // a step through the rows would miss values of a grid
    let order = Permutation::new(sample.count as u64, 0, 0);
    let chosen: Vec<usize> = (0..sample.count.min(most))
        .map(|k| order.of(k as u64) as usize)
        .collect();
    let size = (PANEL.0 * columns as u32, PANEL.1 * rows as u32);
    let area = SVGBackend::with_string(svg, size).into_drawing_area();
    area.fill(&WHITE)?;
    for (place, panel) in area.split_evenly((rows, columns)).iter().enumerate() {
        let (response, parameter) = (place / columns, place % columns);
        let value = |row: usize| sample.values[row * columns + parameter];
        let answer = |row: usize| sample.responses[row * rows + response];
        let across = range(chosen.iter().map(|row| value(*row)));
        let up = range(chosen.iter().map(|row| answer(*row)));
        let (x, y) = (&study.varied[parameter], &study.responses[response]);
        let mut chart = ChartBuilder::on(panel)
            .margin(8)
            .x_label_area_size(36)
            .y_label_area_size(58)
            .build_cartesian_2d(across.clone(), up.clone())?;
        chart
            .configure_mesh()
            .x_desc(heading(&x.name, &x.unit))
            .y_desc(heading(&y.name, &y.unit))
            .x_labels(3)
            .y_labels(4)
            .x_label_formatter(&|x| label(*x, &across))
            .y_label_formatter(&|y| label(*y, &up))
            .light_line_style(TRANSPARENT)
            .bold_line_style(GREY)
            .label_style(("sans-serif", 10))
            .axis_desc_style(("sans-serif", 11))
            .draw()?;
        let points = chosen.iter().map(|row| (value(*row), answer(*row)));
        let points = points.filter(|(_, y)| y.is_finite());
        chart.draw_series(points.map(|point| Circle::new(point, 1, BLUE.mix(0.5).filled())))?;
    }
    area.present()?;
    Ok(())
}
