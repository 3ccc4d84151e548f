//! Lines in a frame with axes: columns of a table over one of them, as self-contained SVG.
//!
//! What is plotted over time are curves of time; a force over what it depends on is its law as the run went through it,
//! loops of hysteresis included.

use crate::table::{Column, Table};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::ops::Range;

/// Which columns over which.
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
    /// The library failed.
    #[error("the plot cannot be drawn: {0}")]
    Drawing(String),
}

const SIZE: (u32, u32) = (720, 440);

/// Colours that remain distinct in print and for the colour-blind (Okabe and Ito), as in the other pictures.
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(122, 81, 149),
    RGBColor(140, 109, 31),
];

impl Request {
    /// Reads "force", "force, friction" or "force over penetration" of a table with these columns, given as (name, unit); without `over`, over
    /// time. Names may have commas and the word `over` in them: what is the name of a column is not taken apart.
    ///
    /// # Errors
    /// Nothing is named, a column that is not there, columns that do not fit one axis.
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
        // ways to read it: as a whole, or apart at each `over`, the last one first
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

    /// What is asked for, as [`Request::read`] reads it.
    pub fn text(&self) -> String {
        format!("{} over {}", self.of.join(", "), self.over)
    }

    /// Words for the name of a file: "belt-force-over-elongation". A name without letters and digits is told by the numbers of its
    /// characters.
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
            unit => unit.to_owned(),
        };
        Err(PlotError::Units {
            first: of[0].0.to_owned(),
            first_unit: named(of[0].1),
            second: other.0.to_owned(),
            second_unit: named(other.1),
        })
    }

    /// Draws columns of a table.
    ///
    /// # Errors
    /// A column that is not there, columns of different units, a failure of the drawing library.
    pub fn draw(&self, title: &str, table: &Table) -> Result<String, PlotError> {
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
        let mut svg = String::new();
        draw(&mut svg, title, over, &of).map_err(|e| PlotError::Drawing(e.to_string()))?;
        Ok(svg)
    }
}

fn draw(
    svg: &mut String,
    title: &str,
    over: &Column,
    of: &[&Column],
) -> Result<(), Box<dyn std::error::Error>> {
    let area = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    area.fill(&WHITE)?;
    let horizontal = range(over.values.iter().copied());
    let vertical = range(of.iter().flat_map(|column| column.values.iter().copied()));
    let vertical_heading = match of {
        [one] => one.heading(),
        [first, ..] if first.unit.is_empty() => String::new(),
        [first, ..] => format!("[{}]", first.unit),
        [] => String::new(),
    };
    let mut chart = ChartBuilder::on(&area)
        .caption(title, ("sans-serif", 16))
        .margin(14)
        .x_label_area_size(44)
        .y_label_area_size(74)
        .build_cartesian_2d(horizontal.clone(), vertical.clone())?;
    chart
        .configure_mesh()
        .x_desc(over.heading())
        .y_desc(vertical_heading)
        .x_labels(9)
        .y_labels(8)
        .x_label_formatter(&|x| label(*x, &horizontal))
        .y_label_formatter(&|y| label(*y, &vertical))
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(225, 225, 225))
        .label_style(("sans-serif", 12))
        .axis_desc_style(("sans-serif", 13))
        .draw()?;
    for (i, column) in of.iter().enumerate() {
        let colour = COLOURS[i % COLOURS.len()];
        // what is not finite interrupts the line
        let points: Vec<(f64, f64)> = over
            .values
            .iter()
            .copied()
            .zip(column.values.iter().copied())
            .collect();
        for piece in points.split(|(x, y)| !x.is_finite() || !y.is_finite()) {
            chart.draw_series(LineSeries::new(
                piece.iter().copied(),
                colour.stroke_width(2),
            ))?;
        }
    }
    if of.len() > 1 {
        // a legend in the upper right corner, one line per column
        for (i, column) in of.iter().enumerate() {
            let y = 40 + 18 * i as i32;
            let right = SIZE.0 as i32 - 30;
            let colour = COLOURS[i % COLOURS.len()];
            let line = [(right - 24, y), (right, y)];
            area.draw(&PathElement::new(line.to_vec(), colour.stroke_width(2)))?;
            let style = TextStyle::from(("sans-serif", 12).into_font())
                .pos(Pos::new(HPos::Right, VPos::Center));
            area.draw(&Text::new(column.name.clone(), (right - 30, y), style))?;
        }
    }
    area.present()?;
    Ok(())
}

/// From the least to the largest finite value, with a margin; never empty.
fn range(values: impl Iterator<Item = f64>) -> Range<f64> {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for value in values.filter(|value| value.is_finite()) {
        (low, high) = (low.min(value), high.max(value));
    }
    if low > high {
        return 0.0..1.0;
    }
    let margin = match 0.03 * (high - low) {
        margin if margin > 0.0 => margin,
        _ => 0.5 * high.abs().max(1.0),
    };
    low - margin..high + margin
}

/// A number on an axis: as many digits as tell ticks apart.
fn label(value: f64, range: &Range<f64>) -> String {
    let span = range.end - range.start;
    let largest = range.start.abs().max(range.end.abs());
    if !(1e-4..1e6).contains(&largest) {
        return format!("{value:.1e}");
    }
    let decimals = (1 - span.log10().floor() as i32).clamp(0, 8) as usize;
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| matches!(c, '0' | '.')) => rest.to_owned(),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let column = |name: &str, unit: &str, values: &[f64]| Column {
            name: name.into(),
            unit: unit.into(),
            values: values.to_vec(),
        };
        Table {
            columns: vec![
                column("time", "s", &[0.0, 0.1, 0.2]),
                column("belt force", "N", &[0.0, 120.0, f64::NAN]),
                column("elongation", "", &[0.0, 0.02, 0.05]),
                column("friction", "N", &[1.0, 2.0, 3.0]),
            ],
        }
    }

    const COLUMNS: [(&str, &str); 7] = [
        ("time", "s"),
        ("belt force", "N"),
        ("elongation", ""),
        ("friction", "N"),
        ("force, left", "N"),
        ("force over all", "N"),
        ("{}", "N"),
    ];

    fn request(of: &[&str], over: &str) -> Request {
        Request {
            of: of.iter().map(|name| name.to_string()).collect(),
            over: over.into(),
        }
    }

    #[test]
    fn requests_are_read() {
        let read = |text| Request::read(text, &COLUMNS);
        assert_eq!(read("belt force"), Ok(request(&["belt force"], "time")));
        assert_eq!(
            read("belt force , friction over elongation"),
            Ok(request(&["belt force", "friction"], "elongation"))
        );
        assert_eq!(read(" , "), Err(PlotError::Empty));
        for (text, of, over) in [
            ("force, left", &["force, left"][..], "time"),
            (
                "friction, force, left, {}",
                &["friction", "force, left", "{}"],
                "time",
            ),
            ("force over all", &["force over all"], "time"),
            (
                "friction over force over all",
                &["friction"],
                "force over all",
            ),
            ("force over all over time", &["force over all"], "time"),
            ("friction over force, left", &["friction"], "force, left"),
            (
                "friction, force over all",
                &["friction", "force over all"],
                "time",
            ),
        ] {
            assert_eq!(read(text), Ok(request(of, over)), "{text}");
        }
        let missing = read("friction, force over time").unwrap_err().to_string();
        assert!(missing.contains("no column \"force\""), "{missing}");
    }

    #[test]
    fn files_are_told_apart() {
        let slug = |of: &str| request(&[of], "time").slug();
        assert_eq!(slug("belt force"), "belt-force-over-time");
        assert_eq!(slug("{}"), "u007b-u007d-over-time");
        assert_eq!(slug("--"), "u002d-u002d-over-time");
    }

    #[test]
    fn columns_are_drawn_and_named() {
        let request = request(&["belt force", "friction"], "elongation");
        let svg = request.draw("a <belt>", &table()).unwrap();
        for word in [
            "<svg",
            "a &lt;belt&gt;",
            "elongation",
            "belt force",
            "friction",
            "[N]",
        ] {
            assert!(svg.contains(word), "{word}: {svg}");
        }
        assert_eq!(svg, request.draw("a <belt>", &table()).unwrap());
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let error = |text: &str| Request::read(text, &COLUMNS).unwrap_err();
        assert!(
            error("tension")
                .to_string()
                .contains("time, belt force, elongation")
        );
        assert!(
            error("belt force, elongation")
                .to_string()
                .contains("pure numbers")
        );
    }
}
