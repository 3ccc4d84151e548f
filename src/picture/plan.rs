//! The positions of the panels on a sheet, and the scale.

use super::figure::{Figure, Point};
use super::nice_above;

/// Margins of the sheet and between panels \[px\].
pub const LEFT: f64 = 58.0;
pub const RIGHT: f64 = 18.0;
pub const TITLE: f64 = 40.0;
pub const TITLE_LINE: f64 = 21.0;
pub const TITLE_LETTER: f64 = 11.2;
pub const TIME: f64 = 22.0;
pub const TICKS: f64 = 20.0;
pub const GAP: f64 = 14.0;
/// Widest sheet and largest panel \[px\].
pub const WIDTH: f64 = 1240.0;
pub const PANEL: f64 = 360.0;
pub const OVERLAY: f64 = 640.0;
/// Least width of a panel: its time and its ticks must fit \[px\].
pub const NARROWEST: f64 = 120.0;

/// The part of the plane that every panel shows \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Lower left corner.
    pub low: Point,
    /// Upper right corner.
    pub high: Point,
}

impl Window {
    /// A window around all figures, with a margin.
    pub fn around(figures: &[Figure]) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let mut include = |point: Point, margin: f64| {
            for axis in 0..2 {
                low[axis] = low[axis].min(point[axis] - margin);
                high[axis] = high[axis].max(point[axis] + margin);
            }
        };
        for figure in figures {
            for (_, from, to) in &figure.bones {
                include(*from, 0.0);
                include(*to, 0.0);
            }
            figure.joints.iter().for_each(|(_, at)| include(*at, 0.0));
            figure
                .outer
                .iter()
                .for_each(|(at, reach)| include(*at, *reach));
            let belts = figure.belts.iter().flat_map(|belt| &belt.points);
            belts.for_each(|point| include(*point, 0.0));
            figure
                .springs
                .iter()
                .flatten()
                .for_each(|end| include(*end, 0.0));
            figure
                .bushings
                .iter()
                .flatten()
                .for_each(|end| include(*end, 0.0));
        }
        if !low.iter().chain(&high).all(|v| v.is_finite()) {
            return Window {
                low: [-0.5; 2],
                high: [0.5; 2],
            };
        }
        let size = (high[0] - low[0]).max(high[1] - low[1]).max(1e-6);
        // the panel of a motion along a line still has some width
        for axis in 0..2 {
            let lacking = (0.25 * size - (high[axis] - low[axis])).max(0.0) / 2.0;
            low[axis] -= lacking + 0.06 * size;
            high[axis] += lacking + 0.06 * size;
        }
        Window { low, high }
    }

    /// Width and height \[m\].
    pub fn size(&self) -> [f64; 2] {
        [self.high[0] - self.low[0], self.high[1] - self.low[1]]
    }
}

/// The positions of the panels, and the scale.
pub struct Plan {
    /// The part of the plane that every panel shows.
    pub window: Window,
    /// Panels side by side.
    pub columns: usize,
    /// Panels above each other.
    pub rows: usize,
    /// px per metre.
    pub scale: f64,
    /// Distance between ticks, across and upwards \[m\].
    pub steps: [f64; 2],
    /// Lines of the title.
    pub title: Vec<String>,
}

impl Plan {
    /// Panels in columns and rows, as large as possible.
    pub fn new(window: &Window, (columns, rows): (usize, usize)) -> Self {
        let [width, height] = window.size();
        let room = (WIDTH - LEFT - RIGHT - GAP * (columns - 1) as f64) / columns as f64;
        let limit = if columns * rows == 1 { OVERLAY } else { PANEL };
        let scale = (room.min(limit) / width).min(limit / height);
        // labels such as −0.25 need some 40 px
        let step = nice_above((44.0 / scale).min(width.max(height) / 2.0));
        let steps = [0, 1].map(|axis| {
            let (low, high) = (window.low[axis], window.high[axis]);
            let fits = |step: f64| {
                let letters = tick(step, low)
                    .chars()
                    .count()
                    .max(tick(step, high).chars().count());
                let room = if axis == 0 {
                    6.8 * letters as f64 + 5.0
                } else {
                    15.0
                };
                step * scale >= room
            };
            enough(step, [low, high], fits)
        });
        Plan {
            window: *window,
            columns,
            rows,
            scale,
            steps,
            title: Vec::new(),
        }
    }

    /// True if elements are so short that lines and joints of the usual thickness would touch each other.
    pub fn fine(&self, figures: &[Figure]) -> bool {
        let Some(figure) = figures.first() else {
            return false;
        };
        let mut lengths: Vec<f64> = figure
            .bones
            .iter()
            .map(|(_, a, b)| self.scale * libm::hypot(b[0] - a[0], b[1] - a[1]))
            .collect();
        lengths.sort_by(f64::total_cmp);
        lengths
            .get(lengths.len() / 2)
            .is_some_and(|median| *median < 40.0)
    }

    /// Width and height of a panel \[px\].
    pub fn panel_size(&self) -> [f64; 2] {
        let [width, height] = self.window.size().map(|s| s * self.scale);
        [width.max(NARROWEST), height]
    }

    /// Upper left corner of a panel.
    pub fn panel(&self, index: usize) -> Point {
        let [width, height] = self.panel_size();
        let (column, row) = (index % self.columns, index / self.columns);
        [
            LEFT + column as f64 * (width + GAP),
            TITLE
                + TITLE_LINE * self.title.len().saturating_sub(1) as f64
                + TIME
                + row as f64 * (height + TIME + TICKS),
        ]
    }

    /// The place of a point in the panel with this corner \[px\].
    pub fn place(&self, corner: Point, point: Point) -> Point {
        let [width, height] = self.panel_size();
        let extra = width - self.window.size()[0] * self.scale;
        [
            corner[0] + extra / 2.0 + (point[0] - self.window.low[0]) * self.scale,
            corner[1] + height - (point[1] - self.window.low[1]) * self.scale,
        ]
    }

    /// Lower edge of the lowest ticks.
    pub fn bottom(&self) -> f64 {
        let last = self.panel((self.rows - 1) * self.columns)[1];
        last + self.panel_size()[1] + TICKS
    }

    /// Width of the sheet \[px\].
    pub fn width(&self) -> f64 {
        let panels = self.columns as f64 * (self.panel_size()[0] + GAP) - GAP;
        (LEFT + panels + RIGHT).max(560.0)
    }

    /// Round numbers in the window along an axis.
    pub fn ticks(&self, axis: usize) -> impl Iterator<Item = f64> + use<> {
        let (low, high, step) = (
            self.window.low[axis],
            self.window.high[axis],
            self.steps[axis],
        );
        multiples(step, [low, high]).map(move |k| k as f64 * step)
    }

    /// A tick's label along an axis.
    pub fn tick(&self, axis: usize, value: f64) -> String {
        tick(self.steps[axis], value)
    }
}

/// An axis has at least this many labelled ticks, if they fit.
const TICKED: usize = 3;

/// A step no larger than `step` with which an axis has enough ticks, or as many as fit.
pub fn enough(step: f64, ends: [f64; 2], fits: impl Fn(f64) -> bool) -> f64 {
    let count = |step: f64| multiples(step, ends).count();
    let finer = std::iter::successors(Some(step), |step| Some(nice_above(0.39 * step)));
    let finer = finer
        .take(4)
        .take_while(|finer| *finer == step || fits(*finer));
    let mut best = step;
    for finer in finer {
        best = finer;
        if count(best) >= TICKED {
            break;
        }
    }
    best
}

/// The multiples of a step between two ends, by their factors.
fn multiples(step: f64, [low, high]: [f64; 2]) -> std::ops::RangeInclusive<i64> {
    (low / step).ceil() as i64..=(high / step).floor() as i64
}

/// A label of a multiple of a step.
pub fn tick(step: f64, value: f64) -> String {
    let decimals = (-libm::log10(step * (1.0 + 1e-9)).floor()).clamp(0.0, 9.0) as usize;
    format!("{:.decimals$}", value + 0.0).replace('-', "−")
}
