//! The work–precision diagram: error across, time upwards, both logarithmic. The best variant of each method is a line
//! in a colour of its own, all others are grey; the Pareto front lies behind the lines, the legend is beside, and a
//! sentence below.

use crate::accuracy::setting::time;
use bryant_picture::chart::{Axes, power_of_ten};
use bryant_picture::text::wrap;
use bryant_picture::{Anchor, Drawing};
use std::ops::Range;

/// What is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagram {
    /// The title above the frame.
    pub title: String,
    /// The quantity whose error is shown.
    pub error: String,
    /// Names of the methods; each has a colour.
    pub methods: Vec<String>,
    /// Names of the variants, the usual one first.
    pub variants: Vec<String>,
    /// The lines, each from coarse to fine.
    pub lines: Vec<Line>,
    /// The front as pairs of error and time \[s\]; the error falls.
    pub front: Vec<[f64; 2]>,
    /// Errors below this are not known.
    pub own: f64,
    /// The sentence below the frame.
    pub sentence: String,
}

/// Points that differ only in their step or tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Index of the method.
    pub method: usize,
    /// Index of the variant.
    pub variant: usize,
    /// Steps are fixed; otherwise the error is controlled.
    pub fixed: bool,
    /// Pairs of error and time \[s\].
    pub points: Vec<[f64; 2]>,
}

/// Colours that remain distinct in print and for the colour-blind (Okabe and Ito, and three more), black last, in the
/// order of methods.
const COLOURS: [&str; 9] = [
    "#56b4e9", "#8c6d1f", "#e69f00", "#cc79a7", "#0072b2", "#009e73", "#d55e00", "#7a5195",
    "#1a1a1a",
];

const STYLE: &str = "\
text{font-family:'DejaVu Sans',Verdana,sans-serif;font-size:12px;fill:#222}
.title{font-size:15px}
.tick{font-size:11px;fill:#444}
.head{fill:#666}
.panel{fill:none;stroke:#999;stroke-width:1}
.grid{stroke:#e4e4e4;stroke-width:1;fill:none}
.unknown{fill:#f3f3f3}
.front{fill:none;stroke:#222;stroke-opacity:.22;stroke-width:9;stroke-linejoin:round;stroke-linecap:round}
.ring{fill:none;stroke:#222;stroke-width:1.3}
.line{fill:none;stroke-width:1.9}
.other{fill:none;stroke:#c4c4c4;stroke-width:1}
.mark{stroke:none}
.grey{fill:#c4c4c4}
";

/// The frame: left, top, width, height.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub const FRAME: [f64; 4] = [64.0, 58.0, 620.0, 440.0];
const WIDTH: f64 = 1020.0;
const LEGEND: f64 = FRAME[0] + FRAME[2] + 24.0;
const LINE_HEIGHT: f64 = 18.0;
/// Characters of a line of text below the frame.
const CHARACTERS: usize = 120;

/// Larger errors are no accuracy at all and are not drawn.
const LARGEST_ERROR: f64 = 1.0;
/// Half decades of error down to rounding.
const FINEST: i32 = 34;

impl Diagram {
    /// The picture.
    pub fn drawing(&self) -> Drawing {
        let [left, top, width, height] = FRAME;
        let axes = self.axes();
        let sentence = wrap(&self.sentence, CHARACTERS);
        let below = top + height + 62.0;
        let bottom = below + LINE_HEIGHT * sentence.len() as f64;
        let legend = self.legend_lines() as f64 * LINE_HEIGHT + top;
        let mut drawing = Drawing::new(WIDTH, bottom.max(legend) + 4.0, &self.title, &self.style());

        drawing.label("title", [left, 24.0], Anchor::Start, &self.title);
        // errors that the reference cannot resolve
        let [own, _] = place(&axes, [self.own, 1.0]);
        if own > left {
            drawing.rectangle("unknown", [left, top, own.min(left + width) - left, height]);
        }
        let across = format!("error in {}, relative", self.error);
        axes.draw(&mut drawing, [&across, "time of a run"]);
        drawing.open_clipped("inside", FRAME);
        let front: Vec<[f64; 2]> = self.visible(&self.front).map(|p| place(&axes, p)).collect();
        if front.len() > 1 {
            drawing.polyline("front", &front);
        }
        // the best are drawn above the others
        let best = self.best();
        for others in [true, false] {
            for (index, line) in self.lines.iter().enumerate() {
                if best.contains(&Some(index)) != others {
                    self.line(line, !others, &axes, &mut drawing);
                }
            }
        }
        for place in &front {
            drawing.circle("ring", *place, 6.0);
        }
        drawing.close();
        self.legend(&best, &mut drawing);
        for (i, text) in sentence.iter().enumerate() {
            let y = below + LINE_HEIGHT * i as f64;
            drawing.label("", [left, y], Anchor::Start, text);
        }
        drawing
    }

    /// Points that are on the sheet.
    fn visible<'a>(&self, points: &'a [[f64; 2]]) -> impl Iterator<Item = [f64; 2]> + use<'a> {
        let on =
            |p: &&[f64; 2]| p[0] > 0.0 && p[0] <= LARGEST_ERROR && p[1] > 0.0 && p[1].is_finite();
        points.iter().filter(on).copied()
    }

    fn style(&self) -> String {
        let mut style = STYLE.to_owned();
        for index in 0..self.methods.len() {
            let colour = COLOURS[index % COLOURS.len()];
            style += &format!(".m{index}{{stroke:{colour}}}.f{index}{{fill:{colour}}}\n");
        }
        style
    }

    /// The best line of each method: the one that is fastest for most errors, among half decades that any line of the
    /// method reaches.
    // Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
    #[doc(hidden)]
    pub fn best(&self) -> Vec<Option<usize>> {
        let of_method = |method: usize| {
            let lines = self.lines.iter().enumerate();
            let lines: Vec<(usize, &Line)> = lines.filter(|(_, l)| l.method == method).collect();
            let mut wins = vec![0; lines.len()];
            for half in 0..FINEST {
                let wanted = libm::pow(10.0, -0.5 * f64::from(half));
                let time = |(_, line): &(usize, &Line)| {
                    let enough = self.visible(&line.points).filter(|p| p[0] <= wanted);
                    enough.map(|p| p[1]).fold(f64::INFINITY, f64::min)
                };
                let times: Vec<f64> = lines.iter().map(time).collect();
                let least = times.iter().copied().fold(f64::INFINITY, f64::min);
                for (wins, time) in wins.iter_mut().zip(&times) {
                    *wins += i32::from(time.is_finite() && *time == least);
                }
            }
            // of equals the most usual one
            let best = (0..lines.len()).max_by_key(|&i| (wins[i], std::cmp::Reverse(i)));
            best.filter(|&i| wins[i] > 0).map(|i| lines[i].0)
        };
        (0..self.methods.len()).map(of_method).collect()
    }

    fn line(&self, line: &Line, best: bool, axes: &Axes, drawing: &mut Drawing) {
        let places: Vec<[f64; 2]> = self.visible(&line.points).map(|p| place(axes, p)).collect();
        let method = line.method;
        let (stroke, fill, size) = match best {
            true => (format!("line m{method}"), format!("mark f{method}"), 3.2),
            false => ("other".to_owned(), "mark grey".to_owned(), 1.6),
        };
        if places.len() > 1 {
            drawing.polyline(&stroke, &places);
        }
        for place in places {
            mark(drawing, &fill, line.fixed, place, size);
        }
    }

    /// The name of a method, and the variant in which it is best.
    fn name(&self, method: usize, best: &[Option<usize>]) -> String {
        let name = &self.methods[method];
        let variant = best[method].map(|line| &self.variants[self.lines[line].variant]);
        match variant.filter(|_| self.variants.len() > 1) {
            Some(variant) => format!("{name}, {variant}"),
            None => name.clone(),
        }
    }

    fn legend_lines(&self) -> usize {
        self.methods.len() + 9
    }

    fn legend(&self, best: &[Option<usize>], drawing: &mut Drawing) {
        let mut y = FRAME[1] + 6.0;
        let mut next = |lines: f64| {
            let now = y;
            y += lines * LINE_HEIGHT;
            now
        };
        let label = |drawing: &mut Drawing, y: f64, text: &str| {
            drawing.label("", [LEGEND + 40.0, y + 4.0], Anchor::Start, text);
        };
        let sample = |y: f64| [[LEGEND, y], [LEGEND + 32.0, y]];
        for method in 0..self.methods.len() {
            let y = next(1.0);
            drawing.polyline(&format!("line m{method}"), &sample(y));
            label(drawing, y, &self.name(method, best));
        }
        if self.lines.len() > best.iter().flatten().count() {
            let y = next(1.0);
            drawing.polyline("other", &sample(y));
            label(drawing, y, "their other variants");
        }
        next(0.5);
        for (fixed, name) in [(false, "error controlled"), (true, "fixed steps")] {
            let y = next(1.0);
            mark(drawing, "mark grey", fixed, [LEGEND + 16.0, y], 3.2);
            label(drawing, y, name);
        }
        let y = next(1.0);
        drawing.polyline("front", &sample(y));
        drawing.circle("ring", [LEGEND + 16.0, y], 6.0);
        label(drawing, y, "Pareto front");
        let y = next(1.0);
        drawing.rectangle("unknown", [LEGEND, y - 6.0, 32.0, 12.0]);
        label(drawing, y, "below the reference's error");
    }
}

/// A point: a square for fixed steps, a disc for controlled errors.
fn mark(drawing: &mut Drawing, class: &str, fixed: bool, [x, y]: [f64; 2], size: f64) {
    if fixed {
        drawing.rectangle(class, [x - size, y - size, 2.0 * size, 2.0 * size]);
    } else {
        drawing.circle(class, [x, y], 1.1 * size);
    }
}

impl Diagram {
    /// Axes of decimal logarithms around all points; their ends are half decades, and ticks are powers of ten.
    // Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
    #[doc(hidden)]
    pub fn axes(&self) -> Axes {
        let lists = || {
            self.lines
                .iter()
                .map(|line| &line.points)
                .chain([&self.front])
        };
        let range = |axis: usize, empty: Range<f64>| {
            let points = lists().flat_map(|list| self.visible(list));
            let exponents = points.map(|p| libm::log10(p[axis]));
            let (low, high) = exponents.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), e| {
                (l.min(e), h.max(e))
            });
            if low > high {
                return empty;
            }
            let from = 0.5 * (2.0 * low).floor();
            from..(0.5 * (2.0 * high).ceil()).max(from + 1.0)
        };
        let ranges = [range(0, -6.0..0.0), range(1, -4.0..-1.0)];
        let ticks = ranges.each_ref().map(|range| {
            let every = if range.end - range.start > 14.0 { 2 } else { 1 };
            let whole = range.start.ceil() as i32..=range.end.floor() as i32;
            let shown = whole.filter(|exponent| exponent % every == 0);
            shown.map(f64::from).collect()
        });
        Axes {
            frame: FRAME,
            ranges,
            ticks,
            labels: [
                |exponent, _| power(exponent as i32),
                |exponent, _| time(power_of_ten(exponent as i32)),
            ],
        }
    }
}

/// The place of a point on the sheet.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn place(axes: &Axes, point: [f64; 2]) -> [f64; 2] {
    axes.place(point.map(libm::log10))
}

/// "10⁻⁶", "1"
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn power(exponent: i32) -> String {
    if exponent == 0 {
        return "1".into();
    }
    let digits = exponent.to_string();
    let raised = digits.chars().map(|c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
    });
    format!("10{}", raised.collect::<String>())
}
