//! Lines in a frame with axes: columns of a table over one of its columns.
//!
//! Columns over time are curves of time. A force over the quantity that it depends on shows its law along the run,
//! including loops of hysteresis.

use super::corridor::Corridor;
use crate::table::{Column, Table};
use bryant_picture::Drawing;
use bryant_picture::chart::{self, Axes, COLOURS, range};
use bryant_picture::text::typeset;

/// The columns that are drawn, and the column that they are drawn over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Request {
    /// Names of the columns drawn, at least one.
    pub of: Vec<String>,
    /// Name of the column that they are drawn over.
    pub over: String,
}

/// Why there is no plot.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlotError {
    /// Nothing is named.
    #[error(
        "a plot needs the name of a column\n  help: write it as 'NAME', 'NAME, NAME' or 'NAME over NAME'"
    )]
    Empty,
    /// No column has this name.
    #[error("there is no column \"{name}\" to plot\n  help: the columns are {}", .columns.join(", "))]
    Column {
        /// The name.
        name: String,
        /// The names there are.
        columns: Vec<String>,
    },
    /// Columns that do not fit one axis.
    #[error(
        "\"{first}\" in {first_unit} and \"{second}\" in {second_unit} do not fit one axis\n  help: give each a --plot of its own"
    )]
    Units {
        /// One column.
        first: String,
        /// Its unit.
        first_unit: String,
        /// Another.
        second: String,
        /// Its unit.
        second_unit: String,
    },
}

/// Pixels: the width of the picture, its margins to the left and right of the frame, the height of the frame.
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub const WIDTH: f64 = 760.0;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub const LEFT: f64 = 78.0;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub const RIGHT: f64 = 22.0;
const HEIGHT: f64 = 340.0;
/// How a corridor looks.
const CORRIDOR: &str = ".corridor{fill:#1a9850;fill-opacity:0.14;stroke:#1a9850;stroke-width:1}\n";
/// Share of a range that is left free at either end.
const MARGIN: f64 = 0.03;

impl Request {
    /// Reads "force", "force, friction" or "force over penetration" for a table with these columns, each given as
    /// (name, unit); without `over`, they are drawn over time. Names may contain commas and the word `over`: the name
    /// of a column is not split.
    ///
    /// # Errors
    /// Nothing is named, a column does not exist, or columns do not fit one axis.
    pub fn read(text: &str, columns: &[(&str, &str)]) -> Result<Request, PlotError> {
        let known = |name: &str| columns.iter().any(|(column, _)| *column == name);
        let list = |of: &str| {
            let pieces: Vec<&str> = of.split(',').collect();
            let mut names: Vec<String> = Vec::new();
            let mut from = 0;
            while from < pieces.len() {
                let name = |to: usize| pieces[from..to].join(",").trim().to_owned();
                let to = (from + 1..=pieces.len()).rev().find(|to| known(&name(*to)));
                let to = to.unwrap_or(from + 1);
                names.extend(Some(name(to)).filter(|name| !name.is_empty()));
                from = to;
            }
            names
        };
        // ways to read the text: as a whole, or split at each `over`, the last one first
        let splits = text.rmatch_indices(" over ");
        let splits = splits.map(|(at, word)| (&text[..at], text[at + word.len()..].trim()));
        let fits =
            |(of, over): &(&str, &str)| known(over) && list(of).iter().all(|name| known(name));
        let whole = (text, "time");
        let way = std::iter::once(whole).chain(splits.clone()).find(fits);
        let (of, over) = way.or(splits.clone().next()).unwrap_or(whole);
        let names = list(of);
        if names.is_empty() || over.is_empty() {
            return Err(PlotError::Empty);
        }
        let request = Request {
            of: names,
            over: over.to_owned(),
        };
        request.check(columns)?;
        Ok(request)
    }

    /// The request in the form that [`Request::read`] reads.
    pub fn text(&self) -> String {
        format!("{} over {}", self.of.join(", "), self.over)
    }

    /// Words for the name of a file: "belt-force-over-elongation". A name without letters and digits is replaced by the
    /// numbers of its characters.
    pub fn slug(&self) -> String {
        let plain = |name: &String| match name.contains(char::is_alphanumeric) {
            true => name.clone(),
            false => {
                let numbers = name.chars().map(|c| format!("u{:04x}", u32::from(c)));
                numbers.collect::<Vec<_>>().join(" ")
            }
        };
        let of: Vec<String> = self.of.iter().map(plain).collect();
        let text = format!("{} over {}", of.join(" "), plain(&self.over));
        let words = text.split(|c: char| !c.is_alphanumeric());
        let words: Vec<String> = words
            .filter(|word| !word.is_empty())
            .map(str::to_lowercase)
            .collect();
        words.join("-")
    }

    fn check(&self, columns: &[(&str, &str)]) -> Result<(), PlotError> {
        let find = |name: &String| {
            let found = columns.iter().find(|(column, _)| column == name);
            found.copied().ok_or_else(|| PlotError::Column {
                name: name.clone(),
                columns: columns.iter().map(|(name, _)| name.to_string()).collect(),
            })
        };
        find(&self.over)?;
        let of = self.of.iter().map(find).collect::<Result<Vec<_>, _>>()?;
        let Some(other) = of.iter().find(|(_, unit)| *unit != of[0].1) else {
            return Ok(());
        };
        let named = |unit: &str| match unit {
            "" => "pure numbers".to_owned(),
            unit => typeset(unit),
        };
        Err(PlotError::Units {
            first: of[0].0.to_owned(),
            first_unit: named(of[0].1),
            second: other.0.to_owned(),
            second_unit: named(other.1),
        })
    }

    /// Whether a corridor lies in this plot.
    pub fn shows(&self, corridor: &Corridor) -> bool {
        self.over == "time" && self.of.contains(&corridor.of)
    }

    /// Draws columns of a table, and the corridors that lie in it.
    ///
    /// # Errors
    /// A column does not exist, or columns have different units.
    pub fn draw(
        &self,
        title: &str,
        table: &Table,
        corridors: &[Corridor],
    ) -> Result<Drawing, PlotError> {
        let columns = table.columns.iter();
        let columns: Vec<(&str, &str)> = columns
            .map(|column| (column.name.as_str(), column.unit.as_str()))
            .collect();
        self.check(&columns)?;
        let find = |name: &String| table.columns.iter().find(|column| column.name == *name);
        let of: Vec<&Column> = self.of.iter().filter_map(find).collect();
        let Some(over) = find(&self.over) else {
            return Err(PlotError::Empty);
        };
        let shown: Vec<&Corridor> = corridors.iter().filter(|one| self.shows(one)).collect();
        Ok(draw(title, over, &of, &shown))
    }
}

fn draw(title: &str, over: &Column, of: &[&Column], corridors: &[&Corridor]) -> Drawing {
    let across = WIDTH - LEFT - RIGHT;
    let (upwards, names) = match of {
        [one] => (one.title(), Vec::new()),
        [first, ..] => {
            let unit = match first.unit.as_str() {
                "" => String::new(),
                unit => format!("[{}]", typeset(unit)),
            };
            (unit, of.iter().map(|column| column.name.as_str()).collect())
        }
        [] => (String::new(), Vec::new()),
    };
    let titles = 21.0 * chart::title_lines(title, across).len() as f64;
    let legend = chart::legend_height(&names, across);
    let top = 14.0 + titles + legend + 28.0;
    let values = of.iter().flat_map(|column| column.values.iter().copied());
    let bounded = |corridor: &Corridor| {
        let bounds = corridor.bounds[1].into_iter();
        bounds.filter(|bound| bound.is_finite()).collect::<Vec<_>>()
    };
    let ranges = [
        range(over.values.iter().copied(), MARGIN),
        range(
            values.chain(corridors.iter().flat_map(|one| bounded(one))),
            MARGIN,
        ),
    ];
    let frame = [LEFT, top, across, HEIGHT];
    let axes = Axes::new(frame, ranges);
    let mut style = chart::style();
    if !corridors.is_empty() {
        style.push_str(CORRIDOR);
    }
    let mut drawing = Drawing::new(WIDTH, top + HEIGHT + 48.0, title, &style);
    chart::title(&mut drawing, [LEFT, 10.0], across, title);
    chart::legend(&mut drawing, [LEFT, 14.0 + titles], across, &names);
    axes.draw(&mut drawing, [&over.title(), &upwards]);
    drawing.open_clipped("inside", frame);
    for corridor in corridors {
        let corner = |bound: usize| {
            let inside = |side: usize| {
                let range = &axes.ranges[side];
                corridor.bounds[side][bound].clamp(range.start, range.end)
            };
            axes.place([inside(0), inside(1)])
        };
        let [[left, bottom], [right, top]] = [corner(0), corner(1)];
        drawing.rectangle("corridor", [left, top, right - left, bottom - top]);
    }
    for (index, column) in of.iter().enumerate() {
        let class = format!("curve c{}", index % COLOURS.len());
        // a value that is not finite interrupts the line
        let points: Vec<[f64; 2]> = over
            .values
            .iter()
            .zip(&column.values)
            .map(|(x, y)| [*x, *y])
            .collect();
        for piece in points.split(|point| !point.iter().all(|part| part.is_finite())) {
            let piece: Vec<[f64; 2]> = piece.iter().map(|point| axes.place(*point)).collect();
            if !piece.is_empty() {
                drawing.polyline(&class, &piece);
            }
        }
    }
    drawing.close();
    drawing
}
