//! Tables: one with a run in each line, and a part of the table that a run prints.
//!
//! A table in Markdown with a run in each line has these marks:
//!
//! - `rows`: the command of all lines, of which a random third is run. What stands in code in the first cell of a line
//!   is added as `--set`. `{1}` is the last word of that cell.
//! - `columns`: for each further column the response that it shows, as behind `-r`, with the unit of the column in
//!   brackets; `-` is not compared, and a mark `other` says why. Columns are separated by `;`.
//! - `with`: `LABEL: OPTIONS` are further options of the line whose first cell is or begins with this label.

use super::compare::Number;
use super::page::Mark;
use super::share::share;

/// A unit of columns in SI. With a sign in front the column shows the opposite.
fn unit(name: &str) -> Option<f64> {
    Some(match name {
        "" => 1.0,
        "mm" | "ms" => 1e-3,
        "kN" | "kJ" | "kPa" => 1e3,
        "g" => 9.80665,
        "°" => std::f64::consts::PI / 180.0,
        "-°" => -std::f64::consts::PI / 180.0,
        "km/h" => 1.0 / 3.6,
        _ => return None,
    })
}

/// A column: the response that it shows and the size of its unit.
type Column = Option<(String, f64)>;

fn columns(text: &str) -> Result<Vec<Column>, String> {
    let one = |text: &str| {
        let text = text.trim();
        if text == "-" {
            return Ok(None);
        }
        let (response, name) = match text
            .strip_suffix(']')
            .and_then(|text| text.rsplit_once('['))
        {
            Some((response, name)) => (response.trim(), name),
            None => (text, ""),
        };
        let size = unit(name).ok_or(format!("there is no unit {name:?}"))?;
        Ok(Some((response.to_owned(), size)))
    };
    text.split(';').map(one).collect()
}

fn cells(line: &str) -> Vec<&str> {
    line.trim()
        .trim_matches('|')
        .split('|')
        .map(str::trim)
        .collect()
}

/// The command of a line, without what it reads.
fn command(base: &str, label: &str, mark: &Mark) -> String {
    let mut command = base.to_owned();
    for setting in label
        .split('`')
        .skip(1)
        .step_by(2)
        .filter(|code| code.contains('='))
    {
        command = format!("{command} --set {setting}");
    }
    let with = mark.all("with").filter_map(|with| with.split_once(": "));
    // the longest label that fits, so that "belt alone, 25 gn" is not "belt alone"
    let fits = with.filter(|(name, _)| label.starts_with(name));
    if let Some((_, options)) = fits.max_by_key(|(name, _)| name.len()) {
        command = format!("{command} {options}");
    }
    command
}

/// Whether a table consists of numbers for the most part: two or more, and a third of the cells beside the first
/// column.
pub fn has_numbers(lines: &[&str]) -> bool {
    let rows = lines.iter().skip(2).map(|line| cells(line));
    let all: Vec<String> = rows
        .flat_map(|row| {
            row[1..]
                .iter()
                .map(|cell| cell.trim_matches('*').replace(' ', ""))
                .collect::<Vec<_>>()
        })
        .collect();
    let with_unit = |cell: &str| {
        let number = cell
            .trim_end_matches(|c: char| c.is_alphabetic() || matches!(c, '%' | '°' | '/' | '²'));
        Number::of(number).is_some()
    };
    let count = all.iter().filter(|cell| with_unit(cell)).count();
    count >= 2 && 3 * count >= all.len()
}

/// A number as it is written in a cell: with as many digits behind the point.
fn like(cell: &str, value: f64) -> Option<String> {
    let plain = cell.trim_matches('*').replace([' ', '\u{202f}'], "");
    Number::of(&plain)?;
    let digits = plain.split_once('.').map_or(0, |(_, behind)| behind.len());
    let now = format!("{value:.digits$}").replacen('-', "−", usize::from(plain.contains('−')));
    let now = if plain.starts_with('.') {
        now.trim_start_matches('0').to_owned()
    } else {
        now
    };
    Some(if cell.starts_with("**") {
        format!("**{now}**")
    } else {
        now
    })
}

/// The lines of a table as they are now, of which one `of` so many is run. `read` runs a command and returns the values
/// of responses in SI, by their order.
pub fn renewed(
    lines: &[&str],
    mark: &Mark,
    of: usize,
    mut read: impl FnMut(&str, &[String]) -> Result<Vec<Option<f64>>, String>,
) -> Result<Vec<String>, String> {
    let base = mark.get("rows").ok_or("there is no `rows`")?;
    let columns = columns(mark.get("columns").ok_or("there is no `columns`")?)?;
    let mut now: Vec<String> = lines[..2].iter().map(|line| line.to_string()).collect();
    let mut used = 0;
    let of_runs = (2..lines.len()).filter(|at| !cells(lines[*at])[0].starts_with("limit"));
    let chosen = share(of, of_runs);
    for (at, line) in lines.iter().enumerate().skip(2) {
        let cells = cells(line);
        let label = cells[0];
        if cells.len() != columns.len() + 1 {
            return Err(format!(
                "{} columns are described, and a line has {}",
                columns.len() + 1,
                cells.len()
            ));
        }
        if !chosen.contains(&at) {
            now.push(line.to_string());
            continue;
        }
        let last = label.split_whitespace().last().unwrap_or_default();
        let place = |text: &str| text.replace("{1}", last);
        let command = place(&command(base, label, mark));
        let wanted: Vec<String> = columns
            .iter()
            .flatten()
            .map(|(response, _)| place(response))
            .collect();
        let mut values = read(&command, &wanted)?.into_iter();
        let mut row = format!("| {label} |");
        for (cell, column) in cells[1..].iter().zip(&columns) {
            let value = column
                .as_ref()
                .and_then(|(_, size)| Some(values.next()?? / size));
            let text = match (value, Number::of(&cell.trim_matches('*').replace(' ', ""))) {
                (Some(value), Some(shown)) => {
                    used += 1;
                    let near = (value - shown.value).abs() <= shown.unit;
                    if near {
                        cell.to_string()
                    } else {
                        like(cell, value).unwrap_or_default()
                    }
                }
                _ => cell.to_string(),
            };
            row = format!("{row} {text} |").replace("  |", " |");
        }
        now.push(row);
    }
    match used {
        // the lines that are run now may have words alone
        0 if of == 1 => Err("no number of the table is compared".to_owned()),
        _ => Ok(now),
    }
}

/// A column of a printed table: the lines of its heading, and its cells.
struct Printed {
    heading: Vec<String>,
    cells: Vec<String>,
}

impl Printed {
    fn name(&self) -> String {
        let words: Vec<&str> = self
            .heading
            .iter()
            .flat_map(|line| line.split_whitespace())
            .collect();
        words.join(" ")
    }
}

/// The columns of a printed table, whose cells are aligned at the right.
fn printed(text: &str) -> Option<Vec<Printed>> {
    let numbers = |line: &str| {
        line.split_whitespace()
            .next()
            .is_some_and(|word| Number::of(word).is_some())
    };
    let lines: Vec<&str> = text.lines().collect();
    let first = lines.iter().position(|line| numbers(line))?;
    let count = lines[first..]
        .iter()
        .take_while(|line| numbers(line))
        .count();
    let letters = |line: &str| line.chars().collect::<Vec<char>>();
    let row = letters(lines[first]);
    let mut found: Vec<Printed> = Vec::new();
    let mut begin = 0;
    for end in 1..=row.len() {
        let ends = row[end - 1] != ' ' && row.get(end).is_none_or(|next| *next == ' ');
        if !ends {
            continue;
        }
        let piece = |line: &&str| {
            let line = letters(line);
            let piece: String = line
                .get(begin.min(line.len())..end.min(line.len()))
                .unwrap_or_default()
                .iter()
                .collect();
            piece.trim().to_owned()
        };
        found.push(Printed {
            heading: lines[..first].iter().map(piece).collect(),
            cells: lines[first..first + count].iter().map(piece).collect(),
        });
        begin = end;
    }
    Some(found)
}

/// The shown part of a printed table as it is now: the same columns and rows.
pub fn part(shown: &[&str], out: &str) -> Result<Vec<String>, String> {
    let shown = printed(&shown.join("\n")).ok_or("the block is no table")?;
    let is = printed(out).ok_or("the command prints no table")?;
    let mut columns = Vec::new();
    for column in &shown {
        let name = column.name();
        let mut fits = is.iter().filter(|is| is.name() == name);
        columns.push(
            fits.next()
                .ok_or(format!("the command prints no column {name:?}"))?,
        );
    }
    let mut rows = Vec::new();
    for cell in &shown[0].cells {
        let row = columns[0].cells.iter().position(|is| is == cell);
        rows.push(row.ok_or(format!("the command prints no row {cell}"))?);
    }
    let headings = columns
        .iter()
        .map(|column| column.heading.len())
        .max()
        .unwrap_or(0);
    let mut lines = vec![String::new(); headings + rows.len()];
    for (k, column) in columns.iter().enumerate() {
        let pieces: Vec<&String> = column
            .heading
            .iter()
            .chain(rows.iter().map(|row| &column.cells[*row]))
            .collect();
        let width = pieces
            .iter()
            .map(|piece| piece.chars().count())
            .max()
            .unwrap_or(0);
        let gap = if k == 0 { "" } else { "  " };
        for (line, piece) in lines.iter_mut().zip(pieces) {
            *line = format!("{line}{gap}{piece:>width$}");
        }
    }
    Ok(lines
        .into_iter()
        .filter(|line| !line.trim().is_empty())
        .map(|line| line.trim_end().to_owned())
        .collect())
}

/// The rules themselves, which the test of all pages begins with.
pub fn rules_hold() -> Result<(), String> {
    let mark = Mark(
        [
            ("rows", "run it"),
            ("columns", "peak of belt [kN]; -; value at {1} of x [mm]"),
            ("with", "all 3: --set a=1"),
        ]
        .map(|(key, value)| (key.to_owned(), value.to_owned()))
        .to_vec(),
    );
    let table = [
        "| | a | b | c |",
        "|---|---|---|---|",
        "| free: `k='2 N'` 3 | **4.20** | 1 | 20 |",
        "| all 3 | 4.00 | 1 | – |",
    ];
    let mut asked = Vec::new();
    let now = renewed(&table, &mark, 1, |command, wanted| {
        asked.push(format!("{command}: {}", wanted.join(", ")));
        Ok(vec![Some(4006.0), Some(0.0204)])
    })?;
    let expected = [
        "| free: `k='2 N'` 3 | **4.01** | 1 | 20 |",
        "| all 3 | 4.00 | 1 | – |",
    ];
    let wanted = [
        "run it --set k='2 N': peak of belt, value at 3 of x",
        "run it --set a=1: peak of belt, value at 3 of x",
    ];
    if now[2..] != expected || asked != wanted {
        return Err(format!("{now:?}, asked as {asked:?}"));
    }
    let out = "       lap  cushion\n time  force    force\n  [s]    [N]      [N]\n0.000      0        1\n0.010     12        3\n";
    let out = out.replace("       lap  cushion", "        lap  cushion");
    let now = part(
        &["cushion", "time  force", " [s]  [N]", "0.010  7"].map(|line| line),
        &out,
    );
    match now {
        Ok(_) => Err("a table whose heading is not above its cells is read".to_owned()),
        Err(_) => {
            let shown = [
                " time  cushion",
                "         force",
                "  [s]      [N]",
                "0.010        7",
            ];
            let now = part(&shown, &out)?;
            match now
                == [
                    " time    cushion",
                    "           force",
                    "  [s]      [N]",
                    "0.010        3",
                ]
                || now
                    .last()
                    .is_some_and(|row| row.split_whitespace().eq(["0.010", "3"]))
            {
                true => Ok(()),
                false => Err(format!("{now:?}")),
            }
        }
    }
}
