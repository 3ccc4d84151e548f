//! Which parameters the variance of each response comes from: bars of total indices, main indices in front of them, intervals of
//! 95 % as lines; the parameter with the largest total on top.

use super::{BLUE, GREY, ORANGE, PictureError};
use crate::study::Study;
use crate::summary::Summary;
use crate::summary::index::{Estimate, Sensitivity};
use crate::summary::text::method;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Pixels across.
const WIDTH: u32 = 760;
/// Pixels of names to the left of the bars.
const NAMES: i32 = 190;
/// Pixels of a parameter.
const BAR: u32 = 26;
/// Pixels of a response's title and axis.
const FRAME: u32 = 92;
/// Parameters drawn of each response at most, those with the largest totals.
const MOST: usize = 20;

/// Draws the picture; `None` where no response has indices.
///
/// # Errors
/// The drawing library fails.
pub fn draw(study: &Study, summary: &Summary) -> Result<Option<String>, PictureError> {
    let known: Vec<(String, &Sensitivity)> = summary
        .responses
        .iter()
        .filter_map(|about| Some((about.name.clone(), about.sensitivity.as_ref()?)))
        .collect();
    if known.is_empty() {
        return Ok(None);
    }
    let mut svg = String::new();
    bars(&mut svg, study, &known).map_err(|error| PictureError(error.to_string()))?;
    Ok(Some(svg))
}

fn bars(
    svg: &mut String,
    study: &Study,
    known: &[(String, &Sensitivity)],
) -> Result<(), Box<dyn std::error::Error>> {
    let shown = study.varied.len().min(MOST);
    let height = FRAME + BAR * shown as u32;
    let area =
        SVGBackend::with_string(svg, (WIDTH, height * known.len() as u32)).into_drawing_area();
    area.fill(&WHITE)?;
    let end = Pos::new(HPos::Right, VPos::Center);
    for ((name, sensitivity), panel) in known.iter().zip(area.split_evenly((known.len(), 1))) {
        let mut order: Vec<usize> = (0..study.varied.len()).collect();
        let total = |p: usize| sensitivity.parameters[p].total;
        order.sort_by(|a, b| total(*b).value.total_cmp(&total(*a).value));
        order.truncate(shown);
        let right = order
            .iter()
            .map(|p| total(*p).high.max(total(*p).value))
            .fold(1.0, f64::max);
        let mut chart = ChartBuilder::on(&panel)
            .caption(name, ("sans-serif", 15))
            .margin(10)
            .margin_left(NAMES)
            .x_label_area_size(40)
            .build_cartesian_2d(0.0..1.02 * right, 0.0..shown as f64)?;
        chart
            .configure_mesh()
            .disable_y_mesh()
            .disable_y_axis()
            .x_labels(6)
            .x_desc(method(sensitivity))
            .x_label_formatter(&|x| format!("{x:.1}"))
            .light_line_style(TRANSPARENT)
            .bold_line_style(GREY)
            .label_style(("sans-serif", 11))
            .axis_desc_style(("sans-serif", 12))
            .draw()?;
        for (place, parameter) in order.iter().enumerate() {
            let top = (shown - place) as f64;
            let indices = sensitivity.parameters[*parameter];
            let bar = |of: Estimate, inset: f64, colour: RGBColor| {
                Rectangle::new(
                    [(0.0, top - inset), (of.value.max(0.0), top - 1.0 + inset)],
                    colour.filled(),
                )
            };
            chart.draw_series([
                bar(indices.total, 0.15, ORANGE),
                bar(indices.main, 0.3, BLUE),
            ])?;
            for (of, at) in [(indices.total, 0.22), (indices.main, 0.5)] {
                let ends = [of.low, of.high].map(|x| (x.clamp(0.0, 1.02 * right), top - at));
                chart.draw_series([PathElement::new(ends.to_vec(), BLACK.stroke_width(1))])?;
            }
            let (_, y) = chart.backend_coord(&(0.0, top - 0.5));
            let (_, panel_top) = panel.get_base_pixel();
            let style = TextStyle::from(("sans-serif", 12).into_font()).pos(end);
            let name = study.varied[*parameter].name.clone();
            panel.draw(&Text::new(name, (NAMES - 4, y - panel_top), style))?;
        }
        let legend = [(ORANGE, "total"), (BLUE, "main")];
        for (k, (colour, word)) in legend.into_iter().enumerate() {
            let x = WIDTH as i32 - 70 - 70 * k as i32;
            panel.draw(&Rectangle::new([(x, 14), (x + 12, 24)], colour.filled()))?;
            let style = TextStyle::from(("sans-serif", 12).into_font())
                .pos(Pos::new(HPos::Left, VPos::Center));
            panel.draw(&Text::new(word, (x + 16, 19), style))?;
        }
    }
    area.present()?;
    Ok(())
}
