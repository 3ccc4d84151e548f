//! Draws the share of each parameter in the variance of each response: bars of total indices with main indices in
//! front, and their 95 % intervals as lines. The parameter with the largest total index is on top.

use crate::study::Study;
use crate::summary::Summary;
use crate::summary::index::{Estimate, Sensitivity};
use crate::summary::text::method;
use bryant_picture::chart::{self, Axes};
use bryant_picture::{Anchor, Drawing};

/// Width of the bars in pixels, and least width of the names to the left of them.
const BARS: f64 = 420.0;
const NAMES: f64 = 120.0;
/// Width of a character of a name in pixels.
const LETTER: f64 = 7.4;
/// Height of a parameter in pixels.
const BAR: f64 = 20.0;
/// Height of a response's title in pixels, and of its axis.
const TITLE: f64 = 52.0;
const AXIS: f64 = 52.0;
/// Of more responses than this, two stand side by side.
const BELOW_EACH_OTHER: usize = 2;
/// Half the height of the ends of an interval in pixels.
const CAP: f64 = 2.5;
/// Largest number of parameters for each response: those with the largest totals.
const MOST: usize = 20;

/// Draws the picture; `None` if no response has indices.
pub fn draw(study: &Study, summary: &Summary) -> Option<Drawing> {
    let known: Vec<(&str, &Sensitivity)> = summary
        .responses
        .iter()
        .filter_map(|about| Some((about.name.as_str(), about.sensitivity.as_ref()?)))
        .collect();
    if known.is_empty() {
        return None;
    }
    let shown = study.varied.len().min(MOST);
    let letters = study.varied.iter().map(|p| p.name.chars().count());
    let left = NAMES.max(LETTER * letters.max().unwrap_or(0) as f64 + 20.0);
    let panel = TITLE + BAR * shown as f64 + AXIS;
    let style = chart::style()
        + ".total{fill:#e69f00}.main{fill:#0072b2}.interval{stroke:#000;stroke-width:1;fill:none}\n";
    let title = format!("shares of the variance of {}", study.model);
    let columns = 1 + usize::from(known.len() > BELOW_EACH_OTHER);
    let across = left + BARS + 40.0;
    let size = [
        across * columns as f64,
        panel * known.len().div_ceil(columns) as f64,
    ];
    let mut drawing = Drawing::new(size[0], size[1], &title, &style);
    let names_end = left;
    for (place, (name, sensitivity)) in known.iter().enumerate() {
        let mut order: Vec<usize> = (0..study.varied.len()).collect();
        let total = |p: usize| sensitivity.parameters[p].total;
        order.sort_by(|a, b| total(*b).value.total_cmp(&total(*a).value));
        order.truncate(shown);
        let right = order
            .iter()
            .map(|p| total(*p).high.max(total(*p).value))
            .fold(1.0, f64::max);
        let left = names_end + across * (place % columns) as f64;
        let top = panel * (place / columns) as f64 + TITLE;
        let height = BAR * shown as f64;
        let ranges = [0.0..1.02 * right, 0.0..shown as f64];
        let mut axes = Axes::new([left, top, BARS, height], ranges);
        axes.ticks[1].clear();
        let lines = chart::title_lines(name, BARS - 140.0).len() as f64;
        chart::title(
            &mut drawing,
            [left, top - 12.0 - 21.0 * lines.min(2.0)],
            BARS - 140.0,
            name,
        );
        for (k, (class, word)) in [("total", "total"), ("main", "main")]
            .into_iter()
            .enumerate()
        {
            let x = left + BARS - 130.0 + 70.0 * k as f64;
            drawing.rectangle(class, [x, top - 21.0, 12.0, 10.0]);
            drawing.label("axis", [x + 17.0, top - 12.0], Anchor::Start, word);
        }
        axes.draw(&mut drawing, [&method(sensitivity), ""]);
        for (row, parameter) in order.iter().enumerate() {
            let indices = sensitivity.parameters[*parameter];
            let above = top + BAR * row as f64;
            let x = |value: f64| axes.place([value.clamp(0.0, 1.02 * right), 0.0])[0];
            let mut bar = |class: &str, of: Estimate, inset: f64| {
                let (y, width) = (above + inset * BAR, x(of.value) - left);
                drawing.rectangle(class, [left, y, width, (1.0 - 2.0 * inset) * BAR]);
            };
            bar("total", indices.total, 0.15);
            bar("main", indices.main, 0.3);
            // both within the bars, one above the other
            for (of, at) in [(indices.total, 0.36), (indices.main, 0.64)] {
                let y = above + at * BAR;
                if of.low.is_finite() && of.high.is_finite() {
                    let [low, high] = [x(of.low), x(of.high)];
                    let cap = |x: f64| ([x, y - CAP], [x, y + CAP]);
                    drawing.lines("interval", &[([low, y], [high, y]), cap(low), cap(high)]);
                }
            }
            let name = &study.varied[*parameter].name;
            let beside = [left - 8.0, above + 0.5 * BAR + 4.0];
            drawing.label("axis", beside, Anchor::End, name);
        }
    }
    Some(drawing)
}
