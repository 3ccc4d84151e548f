//! A table of columns with units: as text for people, as CSV, as JSON; and columns of words side by side.
//!
//! In text, the number of decimals of a column follows from its unit (newtons without decimals, metres to the
//! millimetre); there are more if three digits of the largest value need them. Files have all digits.

use bryant_picture::text::{typeset, wrap};
use std::fmt::Write as _;
use std::io;

/// Named columns of equal length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The columns from left to right; all others are functions of the first.
    pub columns: Vec<Column>,
}

/// A column: the values of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Heading.
    pub name: String,
    /// Unit of the values, "" for a pure number.
    pub unit: String,
    /// One value for each row.
    pub values: Vec<f64>,
}

/// The layout of a table for people.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// Significant digits of the largest value of each column; `None` if the unit determines the decimals.
    pub digits: Option<usize>,
    /// Width of lines in characters; `None` without a limit. Columns that do not fit are printed below, again with the
    /// first column.
    pub width: Option<usize>,
}

/// Characters between two columns.
const GAP: usize = 2;
/// Width in characters beyond which headings are wrapped between words.
const HEADING: usize = 12;

impl Table {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |c| c.values.len())
    }

    /// The table as aligned text: headings, units, a line for each row.
    pub fn text(&self, layout: Layout) -> String {
        let cells: Vec<Cells> = self
            .columns
            .iter()
            .map(|column| Cells::new(column, layout.digits))
            .collect();
        side_by_side(&cells, layout.width)
    }

    /// A number as a table for people shows it.
    pub fn number(value: f64, unit: &str) -> String {
        let alone = Column {
            name: String::new(),
            unit: unit.to_owned(),
            values: vec![value],
        };
        Format::of(&alone, None).print(value)
    }

    /// Writes CSV with all digits; units are in the headings: `chest belt force [N]`. The first heading is in quotation
    /// marks, by which the program recognises its own tables (`own`); readers of CSV ignore them.
    pub fn write_csv(&self, mut out: impl io::Write) -> io::Result<()> {
        let mut headings = self.columns.iter().map(Column::heading);
        let first = headings.next().unwrap_or_default().replace('"', "\"\"");
        write!(
            out,
            "\"{first}\"{}",
            if headings.len() > 0 { "," } else { "\n" }
        )?;
        // flexible, because the first heading is already written, so the line of headings is one field shorter
        let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(out);
        if headings.len() > 0 {
            writer.write_record(headings)?;
        }
        for row in 0..self.rows() {
            writer.write_record(self.columns.iter().map(|c| number(c.values[row])))?;
        }
        writer.flush()
    }

    /// The table as JSON: `{"columns": [{"name", "unit"}, …], "rows": [[…], …]}`; a value that is not finite is `null`.
    pub fn json(&self) -> serde_json::Value {
        let columns: Vec<_> = self
            .columns
            .iter()
            .map(|c| serde_json::json!({ "name": c.name, "unit": c.unit }))
            .collect();
        let rows: Vec<Vec<f64>> = (0..self.rows())
            .map(|row| self.columns.iter().map(|c| c.values[row]).collect())
            .collect();
        serde_json::json!({ "columns": columns, "rows": rows })
    }
}

impl Column {
    /// Name and unit in one line, in the form of files.
    pub fn heading(&self) -> String {
        self.with(&self.unit)
    }

    /// Name and unit in one line, in the form for people.
    pub fn title(&self) -> String {
        self.with(&typeset(&self.unit))
    }

    fn with(&self, unit: &str) -> String {
        match unit {
            "" => self.name.clone(),
            unit => format!("{} [{unit}]", self.name),
        }
    }
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 {
        "0".into()
    } else if (1e-5..1e16).contains(&magnitude) || !value.is_finite() {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}

/// The texts of a column.
pub struct Cells {
    heading: Vec<String>,
    unit: String,
    values: Vec<String>,
    width: usize,
    left: bool,
}

/// Columns as aligned text: headings, units, a line for each row. Columns that do not fit into lines of `width`
/// characters are printed below, again with the first column.
pub fn side_by_side(columns: &[Cells], width: Option<usize>) -> String {
    let mut text = String::new();
    for (index, block) in blocks(columns, width).into_iter().enumerate() {
        if index > 0 {
            text.push('\n');
        }
        block_text(columns, &block, &mut text);
    }
    text
}

impl Cells {
    fn new(column: &Column, digits: Option<usize>) -> Self {
        let format = Format::of(column, digits);
        let unit = match column.unit.as_str() {
            "" => "-",
            unit => unit,
        };
        let values = column.values.iter().map(|v| format.print(*v));
        Cells::of_words(&column.name, unit, values.collect())
    }

    /// A column of these texts, right-aligned; one without a unit has none in its heading.
    pub fn of_words(name: &str, unit: &str, values: Vec<String>) -> Self {
        let unit = match unit {
            "" => String::new(),
            unit => format!("[{}]", typeset(unit)),
        };
        let widths = values.iter().map(|v| v.chars().count());
        let widest = widths.max().unwrap_or(0);
        let heading = wrap(name, HEADING.max(widest));
        let width = heading
            .iter()
            .chain([&unit])
            .map(|line| line.chars().count())
            .fold(widest, usize::max);
        Self {
            heading,
            unit,
            values,
            width,
            left: false,
        }
    }

    /// The column, left-aligned.
    pub fn left_aligned(self) -> Self {
        Cells { left: true, ..self }
    }
}

/// The format of the numbers of a column.
#[derive(Clone, Copy)]
enum Format {
    Decimals(usize),
    /// Number of decimals of the mantissa.
    Scientific(usize),
}

impl Format {
    fn of(column: &Column, digits: Option<usize>) -> Self {
        let largest = column
            .values
            .iter()
            .map(|v| v.abs())
            .filter(|v| v.is_finite())
            .fold(0.0, f64::max);
        let natural = natural_decimals(&column.unit);
        if largest == 0.0 {
            return Format::Decimals(natural);
        }
        let wanted = digits.unwrap_or(3).max(1);
        let exponent = libm::log10(largest).floor() as i64;
        if !(-6..=9).contains(&exponent) {
            return Format::Scientific(wanted - 1);
        }
        let needed = (wanted as i64 - 1 - exponent).max(0) as usize;
        match digits {
            Some(_) => Format::Decimals(needed),
            None => {
                let decimals = spacing_decimals(column).unwrap_or(needed.max(natural));
                Format::Decimals(decimals)
            }
        }
    }

    fn print(self, value: f64) -> String {
        if !value.is_finite() {
            return "-".into();
        }
        let text = match self {
            Format::Decimals(decimals) => format!("{value:.decimals$}"),
            Format::Scientific(digits) => format!("{value:.digits$e}"),
        };
        // a number that rounds to zero has no sign
        match text.strip_prefix('-') {
            Some(rest) if rest.bytes().all(|b| matches!(b, b'0' | b'.')) => rest.to_owned(),
            _ => text,
        }
    }
}

/// Number of decimals with which engineers usually give a quantity in this unit.
fn natural_decimals(unit: &str) -> usize {
    match unit {
        "s" | "m" | "rad" => 3,
        "m/s" | "rad/s" | "kN" => 2,
        "J" | "N*m" | "g" | "deg" | "kPa" => 1,
        _ => 0,
    }
}

/// Number of decimals that distinguish the rows of a column of equidistant times; `None` for other columns.
fn spacing_decimals(column: &Column) -> Option<usize> {
    let values = &column.values;
    if !["s", "ms"].contains(&column.unit.as_str()) || values.len() < 2 {
        return None;
    }
    let step = values[1] - values[0];
    let equidistant = |pair: &[f64]| (pair[1] - pair[0] - step).abs() <= 1e-6 * step;
    // the last sample of a run may be nearer than the others
    if step <= 0.0 || !values[..values.len() - 1].windows(2).all(equidistant) {
        return None;
    }
    (0..=9).find(|&decimals| {
        let whole = |value: f64| {
            let scaled = value * bryant_picture::chart::power_of_ten(decimals as i32);
            (scaled - scaled.round()).abs() < 1e-3
        };
        step * bryant_picture::chart::power_of_ten(decimals as i32) > 0.5
            && values.iter().all(|v| whole(*v))
    })
}

/// The columns of each block; the columns of a block fit side by side.
fn blocks(cells: &[Cells], width: Option<usize>) -> Vec<Vec<usize>> {
    let Some(first) = cells.first() else {
        return Vec::new();
    };
    let limit = width.unwrap_or(usize::MAX);
    let mut blocks = vec![vec![0]];
    let mut used = first.width;
    for (index, cell) in cells.iter().enumerate().skip(1) {
        let block = blocks.last_mut().expect("starts with one");
        if used + GAP + cell.width > limit && block.len() > 1 {
            blocks.push(vec![0, index]);
            used = first.width + GAP + cell.width;
        } else {
            block.push(index);
            used += GAP + cell.width;
        }
    }
    blocks
}

fn block_text(cells: &[Cells], block: &[usize], text: &mut String) {
    let height = block
        .iter()
        .map(|&i| cells[i].heading.len())
        .max()
        .unwrap_or(0);
    let mut line = |cell: &dyn Fn(&Cells) -> String| {
        for (position, &index) in block.iter().enumerate() {
            let (gap, width) = (if position == 0 { 0 } else { GAP }, cells[index].width);
            let content = cell(&cells[index]);
            // the width is in characters, not bytes, because units have superscripts
            let _ = match cells[index].left {
                true => write!(text, "{:gap$}{content:<width$}", ""),
                false => write!(text, "{:gap$}{content:>width$}", ""),
            };
        }
        text.truncate(text.trim_end().len());
        text.push('\n');
    };
    for row in 0..height {
        line(&|cell| {
            let above = height - cell.heading.len();
            match row.checked_sub(above) {
                Some(row) => cell.heading[row].clone(),
                None => String::new(),
            }
        });
    }
    line(&|cell| cell.unit.clone());
    let rows = block.first().map_or(0, |&i| cells[i].values.len());
    for row in 0..rows {
        line(&|cell| cell.values[row].clone());
    }
}
