//! The sheet with the figures: panels of one scale, ticks in metres, times, a bar of known length, a legend.

use super::figure::{Ellipse, Figure, Point};
use super::nice_above;
use super::plan::{LEFT, Plan, RIGHT, TICKS, TIME, TITLE_LETTER, TITLE_LINE, Window};
use bryant_picture::text::wrap;
use bryant_picture::{Anchor, Drawing};

/// The arrangement of several figures on a sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Arrangement {
    /// Side by side, one panel for each time.
    #[default]
    Row,
    /// On top of each other, early figures pale.
    Overlay,
}

/// Everything that is drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// The title above the panels.
    pub title: String,
    /// The direction of the view, if it needs to be said.
    pub view: Option<String>,
    /// Names of the axes, across and upwards.
    pub axes: [&'static str; 2],
    /// Names of the systems, for the legend.
    pub systems: Vec<String>,
    /// In the order of time.
    pub figures: Vec<Figure>,
    /// Until when each stands for the motion \[s\].
    until: Vec<f64>,
    /// Their arrangement.
    pub arrangement: Arrangement,
}

/// Colours that remain distinct in print and for the colour-blind (Okabe and Ito).
const COLOURS: [&str; 5] = ["#0072b2", "#009e73", "#cc79a7", "#7a5195", "#8c6d1f"];

const STYLE: &str = "\
text{font-family:'DejaVu Sans',Arial,Helvetica,sans-serif;font-size:12px;fill:#222}
.title{font-size:16px;font-weight:bold}
.time{font-size:13px;font-weight:bold}
.tick{font-size:11px;fill:#444}
.panel{fill:none;stroke:#999;stroke-width:1}
.grid{stroke:#e6e6e6;stroke-width:1;fill:none}
.plane{stroke:#444;stroke-width:2;stroke-linecap:round}
.face{stroke:#888;stroke-width:1.2;fill:#888;fill-opacity:.06}
.mesh{fill-opacity:.12;stroke-width:.9;stroke-opacity:.6}
.bag{stroke:#5c6f82;stroke-width:1.4;fill:#5c6f82;fill-opacity:.10}
.hatch{stroke:#888;stroke-width:1;fill:none}
.ellipse{fill-opacity:.08;stroke-width:1.2;stroke-opacity:.75}
.bone{stroke-width:3.5;stroke-linecap:round;fill:none}
.joint{fill:#fff;stroke-width:1.6}
.taut{fill:none;stroke:#d55e00;stroke-width:2.2;stroke-linecap:round}
.spring{fill:none;stroke:#333;stroke-width:1.3;stroke-linejoin:round}
.slack{fill:none;stroke:#d55e00;stroke-width:1.5;stroke-dasharray:4 3}
.end{fill:#d55e00}
.bar{stroke:#222;stroke-width:2;fill:none}
";

/// A figure is left out if nothing in it has moved by more than this part of the window since the one before.
const STILL: f64 = 0.01;

impl Sheet {
    /// A sheet with those of these figures whose time is in `times`, less those since the one before which nothing has
    /// moved, at no time between.
    pub fn new(
        title: String,
        view: Option<String>,
        axes: [&'static str; 2],
        systems: Vec<String>,
        (all, times): (Vec<Figure>, &[f64]),
        arrangement: Arrangement,
    ) -> Self {
        let [width, height] = Window::around(&all).size();
        let (mut figures, mut until): (Vec<Figure>, Vec<f64>) = (Vec::new(), Vec::new());
        let mut moved = true;
        for figure in all {
            let change = figures.last().map(|before| figure.change(before));
            moved |= change.is_none_or(|change| change >= STILL * width.max(height));
            if !times.contains(&figure.time) {
                continue;
            }
            match until.last_mut() {
                Some(end) if !moved => *end = figure.time,
                _ => {
                    until.push(figure.time);
                    figures.push(figure);
                    moved = false;
                }
            }
        }
        Sheet {
            title,
            view,
            axes,
            systems,
            figures,
            until,
            arrangement,
        }
    }

    /// The picture.
    pub fn drawing(&self) -> Drawing {
        let window = Window::around(&self.figures);
        let grid = self.grid(&window);
        let mut plan = Plan::new(&window, grid);
        let letters = ((plan.width() - LEFT - RIGHT) / TITLE_LETTER) as usize;
        plan.title = wrap(&self.title, letters);
        let plan = plan;
        let legend = self.legend_lines(&plan);
        let height = plan.bottom() + 24.0 + 22.0 * legend.len().max(1) as f64 + 26.0;
        let mut style = STYLE.to_owned();
        for (index, colour) in COLOURS.iter().enumerate() {
            style.push_str(&format!(
                ".s{index}{{stroke:{colour}}}.ellipse.s{index},.mass.s{index}{{fill:{colour}}}.mesh.s{index}{{fill:{colour}}}\n"
            ));
        }
        if plan.fine(&self.figures) {
            style.push_str(".bone{stroke-width:2.2}.joint{stroke-width:1.1}\n");
        }
        style.push_str(
            ".frame{stroke:#444}.ellipse.frame,.mesh.frame{fill:#444}.mesh.hole{fill:none}\n",
        );
        let mut drawing = Drawing::new(plan.width(), height, &self.title, &style);
        for (index, line) in plan.title.iter().enumerate() {
            let y = 26.0 + TITLE_LINE * index as f64;
            drawing.label("title", [LEFT, y], Anchor::Start, line);
        }
        match self.arrangement {
            Arrangement::Row => {
                for (index, figure) in self.figures.iter().enumerate() {
                    let origin = plan.panel(index);
                    let mut heading = time(figure.time);
                    if self.until[index] > figure.time {
                        heading += &format!(" to {}", time(self.until[index]));
                    }
                    if figure.travel > 0.0 {
                        heading += &format!(", gone {} m", significant(figure.travel));
                    }
                    self.panel(&mut drawing, &plan, index, origin, &heading);
                    self.figure(&mut drawing, &plan, origin, figure);
                    drawing.close();
                }
            }
            Arrangement::Overlay => {
                let label = match self.figures.as_slice() {
                    [] => String::new(),
                    [only] => time(only.time),
                    [first, .., last] => format!("{} to {}", time(first.time), time(last.time)),
                };
                let origin = plan.panel(0);
                self.panel(&mut drawing, &plan, 0, origin, &label);
                for (index, figure) in self.figures.iter().enumerate() {
                    drawing.open("instant", self.opacity(index));
                    self.figure(&mut drawing, &plan, origin, figure);
                    drawing.close();
                }
                drawing.close();
            }
        }
        self.axis_names(&mut drawing, &plan);
        self.legend(&mut drawing, &plan, &legend);
        drawing
    }

    /// Opacity of a figure among others: the last one has full colour.
    fn opacity(&self, index: usize) -> f64 {
        let last = self.figures.len().saturating_sub(1).max(1) as f64;
        0.25 + 0.75 * index as f64 / last
    }

    /// Columns and rows of panels: the arrangement with the largest panels, then the one with the fewest empty places.
    fn grid(&self, window: &Window) -> (usize, usize) {
        if self.arrangement == Arrangement::Overlay || self.figures.len() < 2 {
            return (1, 1);
        }
        let count = self.figures.len();
        let score = |columns: usize| {
            let rows = count.div_ceil(columns);
            let scale = Plan::new(window, (columns, rows)).scale;
            // A motion is read along a row: a height beyond two thirds of a screen counts against the size, as empty
            // places do.
            let height = rows as f64 * (window.size()[1] * scale + TIME + TICKS);
            let full = count as f64 / (columns * rows) as f64;
            scale * full / (height / 600.0).max(1.0)
        };
        let better = |best: usize, next: usize| {
            if score(next) > score(best) * (1.0 - 1e-9) {
                next
            } else {
                best
            }
        };
        let columns = (2..=count).fold(1, better);
        (columns, count.div_ceil(columns))
    }

    /// Frame, grid, ticks and heading of a panel; the clipped group for its content stays open.
    fn panel(
        &self,
        drawing: &mut Drawing,
        plan: &Plan,
        index: usize,
        origin: Point,
        heading: &str,
    ) {
        let [width, height] = plan.panel_size();
        let rectangle = [origin[0], origin[1], width, height];
        let mut lines = Vec::new();
        let column = index % plan.columns;
        let lowest = index + plan.columns >= self.panels();
        for x in plan.ticks(0) {
            let at = plan.place(origin, [x, plan.window.low[1]])[0];
            lines.push(([at, origin[1]], [at, origin[1] + height]));
            if lowest {
                let below = [at, origin[1] + height + 14.0];
                drawing.label("tick", below, Anchor::Middle, &plan.tick(0, x));
            }
        }
        for z in plan.ticks(1) {
            let at = plan.place(origin, [plan.window.low[0], z])[1];
            lines.push(([origin[0], at], [origin[0] + width, at]));
            if column == 0 {
                let beside = [origin[0] - 6.0, at + 4.0];
                drawing.label("tick", beside, Anchor::End, &plan.tick(1, z));
            }
        }
        drawing.lines("grid", &lines);
        drawing.rectangle("panel", rectangle);
        let above = [origin[0] + 2.0, origin[1] - 6.0];
        drawing.label("time", above, Anchor::Start, heading);
        drawing.open_clipped(&format!("panel{index}"), rectangle);
    }

    fn panels(&self) -> usize {
        match self.arrangement {
            Arrangement::Row => self.figures.len(),
            Arrangement::Overlay => 1,
        }
    }

    /// One stick figure; parts behind are drawn first.
    fn figure(&self, drawing: &mut Drawing, plan: &Plan, origin: Point, figure: &Figure) {
        let place = |point: Point| plan.place(origin, point);
        let colour = |system: usize| format!("s{}", system % COLOURS.len());
        for plane in &figure.planes {
            let (from, to) = (place(plane.from), place(plane.to));
            let back = [-plane.normal[0], plane.normal[1]];
            drawing.lines("hatch", &hatch(from, to, back));
            drawing.line("plane", from, to);
        }
        let of = |system: Option<usize>| system.map_or("frame".to_owned(), colour);
        for (system, lines) in &figure.meshes {
            for line in lines {
                // around a hole it leads clockwise
                let pairs = line.windows(2);
                let area: f64 = pairs.map(|p| p[0][0] * p[1][1] - p[1][0] * p[0][1]).sum();
                let class = if area < 0.0 { "mesh hole" } else { "mesh" };
                let line: Vec<Point> = line.iter().map(|point| place(*point)).collect();
                drawing.polyline(&format!("{class} {}", of(*system)), &line);
            }
        }
        for [a, b, c, d] in figure.faces.iter().map(|face| face.map(place)) {
            drawing.polyline("face", &[a, b, c, d, a]);
        }
        let mut round = |class: &str, ellipse: &Ellipse| {
            let semi = ellipse.semi_axes.map(|a| a * plan.scale);
            let turn = -ellipse.angle.to_degrees();
            drawing.ellipse(class, place(ellipse.centre), semi, turn);
        };
        for ellipse in &figure.ellipses {
            round(&format!("ellipse {}", of(ellipse.system)), ellipse);
        }
        for bag in &figure.bags {
            round("bag", bag);
        }
        for (system, outline) in &figure.boxes {
            let outline: Vec<Point> = outline.iter().map(|point| place(*point)).collect();
            drawing.polyline(&format!("ellipse {}", of(*system)), &outline);
        }
        for (system, from, to) in &figure.bones {
            drawing.line(
                &format!("bone {}", colour(*system)),
                place(*from),
                place(*to),
            );
        }
        for belt in &figure.belts {
            let class = if belt.taut { "taut" } else { "slack" };
            let points: Vec<Point> = belt.points.iter().map(|point| place(*point)).collect();
            let ends = [points[0], points[points.len() - 1]];
            match points.len() {
                2 => drawing.line(class, ends[0], ends[1]),
                _ => drawing.polyline(class, &points),
            }
            for end in ends {
                drawing.circle("end", end, 2.2);
            }
        }
        for ends in &figure.springs {
            drawing.polyline("spring", &coil(ends.map(place)));
        }
        for [from, to] in &figure.bushings {
            drawing.line("spring", place(*from), place(*to));
            drawing.circle("spring", place(*from), BUSHING);
        }
        let size = if plan.fine(&self.figures) { 0.66 } else { 1.0 };
        for (system, at) in &figure.masses {
            let class = format!("mass {}", colour(*system));
            drawing.circle(&class, place(*at), 3.2 * size);
        }
        for (system, at) in &figure.joints {
            let class = format!("joint {}", colour(*system));
            drawing.circle(&class, place(*at), 3.0 * size);
        }
    }

    fn axis_names(&self, drawing: &mut Drawing, plan: &Plan) {
        let below = [
            plan.panel(0)[0] + plan.panel_size()[0] / 2.0,
            plan.bottom() + 14.0,
        ];
        drawing.label("axis", below, Anchor::Middle, self.axes[0]);
        let first = plan.panel(0);
        drawing.label("axis", [8.0, first[1] - 6.0], Anchor::Start, self.axes[1]);
    }

    /// Entries of the legend in lines that fit the sheet.
    fn legend_lines(&self, plan: &Plan) -> Vec<Vec<(f64, Entry)>> {
        let any = |test: &dyn Fn(&Figure) -> bool| self.figures.iter().any(test);
        let mut entries: Vec<Entry> = self.systems.iter().enumerate().map(Entry::system).collect();
        entries.push(Entry::new("joint", "joint"));
        if any(&|f| !f.masses.is_empty()) {
            entries.push(Entry::new("mass", "centre of gravity"));
        }
        if any(&|f| !f.ellipses.is_empty() || !f.boxes.is_empty()) {
            let name = match any(&|f| f.some_meet_nothing) {
                true => "ellipsoid",
                false => "contact ellipsoid",
            };
            entries.push(Entry::new("ellipse", name));
        }
        if any(&|f| !f.bags.is_empty()) {
            entries.push(Entry::new("bag", "airbag"));
        }
        if any(&|f| !f.meshes.is_empty()) {
            entries.push(Entry::new("mesh", "mesh (only shown)"));
        }
        if any(&|f| !f.planes.is_empty()) {
            entries.push(Entry::new("plane", "contact plane (hatched behind)"));
        }
        if any(&|f| !f.faces.is_empty()) {
            entries.push(Entry::new("face", "contact plane"));
        }
        if any(&|f| f.belts.iter().any(|b| b.taut)) {
            entries.push(Entry::new("taut", "belt"));
        }
        if any(&|f| f.belts.iter().any(|b| !b.taut)) {
            entries.push(Entry::new("slack", "belt, slack"));
        }
        if any(&|f| !f.springs.is_empty()) {
            entries.push(Entry::new("spring", "spring"));
        }
        if any(&|f| !f.bushings.is_empty()) {
            entries.push(Entry::new("bushing", "bushing"));
        }
        if self.arrangement == Arrangement::Overlay && self.figures.len() > 1 {
            entries.extend(
                self.figures
                    .iter()
                    .enumerate()
                    .map(|(index, figure)| Entry {
                        opacity: self.opacity(index),
                        text: time(figure.time),
                        ..Entry::system((0, &String::new()))
                    }),
            );
        }
        let mut lines: Vec<Vec<(f64, Entry)>> = vec![Vec::new()];
        let mut x = LEFT;
        for entry in entries {
            let width = 40.0 + 7.6 * entry.text.chars().count() as f64;
            if x + width > plan.width() - RIGHT && !lines[lines.len() - 1].is_empty() {
                lines.push(Vec::new());
                x = LEFT;
            }
            lines.last_mut().expect("starts with one").push((x, entry));
            x += width;
        }
        lines
    }

    fn legend(&self, drawing: &mut Drawing, plan: &Plan, lines: &[Vec<(f64, Entry)>]) {
        // A bar of round length, about a third of a panel.
        let length = nice_above(plan.window.size()[0] / 8.0);
        let (x, mut y) = (LEFT, plan.bottom() + 36.0);
        let end = x + length * plan.scale;
        drawing.lines(
            "bar",
            &[
                ([x, y], [end, y]),
                ([x, y - 4.0], [x, y + 4.0]),
                ([end, y - 4.0], [end, y + 4.0]),
            ],
        );
        let view = self
            .view
            .as_ref()
            .map_or(String::new(), |view| format!(", {view}"));
        let metres = format!("{} m{view}", plain(length));
        drawing.label("axis", [end + 8.0, y + 4.0], Anchor::Start, &metres);
        for line in lines {
            y += 22.0;
            for (x, entry) in line {
                entry.draw(drawing, [*x, y]);
            }
        }
    }
}

/// An entry of the legend.
#[derive(Clone, Debug)]
struct Entry {
    kind: &'static str,
    class: String,
    text: String,
    opacity: f64,
}

/// A zigzag between two ends, straight at both.
fn coil([from, to]: [Point; 2]) -> Vec<Point> {
    const TEETH: usize = 6;
    const HALF_WIDTH: f64 = 4.0;
    let span = [to[0] - from[0], to[1] - from[1]];
    let length = libm::hypot(span[0], span[1]);
    if length == 0.0 {
        return vec![from, to];
    }
    let across = [-span[1] / length, span[0] / length];
    let at = |share: f64, aside: f64| {
        [0, 1].map(|axis| from[axis] + share * span[axis] + aside * across[axis])
    };
    let (first, last) = (0.15, 0.85);
    let mut points = vec![from, at(first, 0.0)];
    for tooth in 0..2 * TEETH {
        let share = (tooth as f64 + 0.5) / (2 * TEETH) as f64;
        let aside = if tooth % 2 == 0 {
            HALF_WIDTH
        } else {
            -HALF_WIDTH
        };
        points.push(at(first + share * (last - first), aside));
    }
    points.extend([at(last, 0.0), to]);
    points
}

impl Entry {
    fn new(kind: &'static str, text: &str) -> Self {
        Self {
            kind,
            class: format!("{kind} frame"),
            text: text.to_owned(),
            opacity: 1.0,
        }
    }

    fn system((index, name): (usize, &String)) -> Self {
        Self {
            kind: "bone",
            class: format!("bone s{}", index % COLOURS.len()),
            text: name.clone(),
            opacity: 1.0,
        }
    }

    fn draw(&self, drawing: &mut Drawing, [x, y]: Point) {
        let middle = [x + 11.0, y];
        match self.kind {
            "joint" => drawing.circle(&self.class, middle, 3.0),
            "mass" => drawing.circle("mass", middle, 3.2),
            "ellipse" | "bag" => drawing.ellipse(&self.class, middle, [10.0, 6.0], 0.0),
            "plane" => {
                let (from, to) = ([x, y - 2.0], [x + 22.0, y - 2.0]);
                drawing.lines("hatch", &hatch(from, to, [0.0, 1.0]));
                drawing.line("plane", from, to);
            }
            "face" => {
                let corners = [
                    [x, y + 5.0],
                    [x + 16.0, y + 5.0],
                    [x + 22.0, y - 5.0],
                    [x + 6.0, y - 5.0],
                ];
                let [a, b, c, d] = corners;
                drawing.polyline("face", &[a, b, c, d, a]);
            }
            "mesh" => {
                let corners = [
                    [x, y + 6.0],
                    [x + 22.0, y + 6.0],
                    [x + 15.0, y - 6.0],
                    [x + 4.0, y - 4.0],
                ];
                let [a, b, c, d] = corners;
                drawing.polyline(&self.class, &[a, b, c, d, a]);
            }
            "bone" => {
                drawing.open("sample", self.opacity);
                drawing.line(&self.class, [x, y], [x + 22.0, y]);
                drawing.close();
            }
            "spring" => drawing.polyline("spring", &coil([[x, y], [x + 22.0, y]])),
            "bushing" => drawing.circle("spring", [x + 11.0, y], BUSHING),
            kind => drawing.line(kind, [x, y], [x + 22.0, y]),
        }
        drawing.label("axis", [x + 28.0, y + 4.0], Anchor::Start, &self.text);
    }
}

/// Radius of the ring that stands for a bushing, in the line of springs and wider than a joint \[px\].
const BUSHING: f64 = 6.0;

/// Short strokes behind a plane.
fn hatch(from: Point, to: Point, back: Point) -> Vec<(Point, Point)> {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = libm::hypot(along[0], along[1]);
    if !(length.is_finite() && length > 0.0) {
        return Vec::new();
    }
    let along = along.map(|a| a / length);
    let count = (length / 9.0).floor().clamp(1.0, 400.0);
    let stroke = |k: usize| {
        let at = (k as f64 + 0.5) * length / count;
        let start: Point = std::array::from_fn(|i| from[i] + at * along[i]);
        let end = std::array::from_fn(|i| start[i] + 6.0 * back[i] - 4.0 * along[i]);
        (start, end)
    };
    (0..count as usize).map(stroke).collect()
}

/// A time in the unit that is easiest to read.
fn time(seconds: f64) -> String {
    if seconds.abs() < 10.0 {
        let milliseconds = (seconds * 1e6).round() / 1e3;
        if milliseconds.abs() < 1000.0 {
            return format!("{} ms", plain(milliseconds));
        }
    }
    format!("{} s", plain((seconds * 1e4).round() / 1e4))
}

/// A length to three digits.
fn significant(value: f64) -> String {
    let decimals = (2.0 - libm::log10(value).floor()).clamp(0.0, 3.0) as usize;
    format!("{value:.decimals$}")
}

fn plain(value: f64) -> String {
    // Rounded to twelve digits, so that 3 · 0.1 is 0.3.
    let rounded: f64 = format!("{value:.12e}").parse().unwrap_or(value);
    format!("{}", rounded + 0.0)
}
