//! The table of `bryant effects`: row by row for people, or as JSON.

use crate::timing::{Measured, TimedMethod};
use bryant_generator::effect::{Entry, Reason};
use bryant_generator::expression::count::Count;
use bryant_generator::model::Model;
use bryant_picture::text::wrap;
use serde_json::{Value, json};

/// An effect with its cost.
pub struct Row<'a> {
    /// The effect.
    pub entry: &'a Entry,
    /// The method whose cost the effect changes.
    pub method: TimedMethod,
    /// The operations with the effect minus those without it.
    pub operations: Option<Difference>,
    /// Measurements with the effect and without it.
    pub measured: Option<(Measured, Measured)>,
}

/// Operations that an effect adds. They are negative if more common subexpressions are shared with the effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Sums, products and other arithmetic operations.
    pub operations: i64,
    /// Sines, cosines, angles and calls.
    pub calls: i64,
}

/// Number of sines, cosines, angles and calls.
fn calls(count: &Count) -> usize {
    count.trigonometric() + count.called()
}

impl Difference {
    /// The difference of two counts.
    pub fn between(with: &Count, without: &Count) -> Self {
        Difference {
            operations: with.total() as i64 - without.total() as i64,
            calls: calls(with) as i64 - calls(without) as i64,
        }
    }
}

/// The totals of the scene, and of the same scene with all effects in.
pub struct Total {
    /// The scene itself.
    pub scene: (Count, Option<Measured>),
    /// A second measurement of the scene.
    pub again: Option<Measured>,
    /// The scene with all effects in.
    pub general: (Count, Option<Measured>),
    /// Number of run-time parameters of the scene with all effects in.
    pub parameters: usize,
}

impl Total {
    /// The difference of two measurements of the scene \[s\]; smaller differences are noise.
    pub fn noise(&self) -> Option<f64> {
        Some((self.scene.1?.time - self.again?.time).abs())
    }
}

/// Cells of a row.
type Cells = [String; 7];

/// The columns of times; they are left out if nothing is timed.
const TIMES: std::ops::Range<usize> = 3..6;

/// A table whose numbers are right-aligned. Rows are written one by one, so the widths of columns are set before any
/// time is measured.
pub struct Table {
    widths: [usize; 7],
    timed: bool,
    /// Characters in a line; `None` without a limit.
    room: Option<usize>,
}

/// Least width of the last column \[characters\]; if there is less room, its text is put below the others.
const NARROWEST: usize = 24;
/// Indentation of the last column if it is below the others \[characters\].
const INDENT: usize = 4;

impl Table {
    /// A table for these rows, in lines of at most `room` characters; `timed` says whether times will follow.
    pub fn new<'a>(
        rows: impl Iterator<Item = &'a Row<'a>>,
        total: &Total,
        timed: bool,
        room: Option<usize>,
    ) -> Self {
        let mut lines = heading().to_vec();
        lines.extend(rows.map(cells));
        lines.extend(totals(total));
        Self::of(&lines, timed, room)
    }

    pub fn of(lines: &[Cells], timed: bool, room: Option<usize>) -> Self {
        let mut widths = [0; 7];
        for line in lines {
            for (width, cell) in widths.iter_mut().zip(line) {
                *width = cell.chars().count().max(*width);
            }
        }
        if timed {
            // wide enough for the longest likely number
            for column in TIMES {
                widths[column] = widths[column].max(LIKELY);
            }
        }
        Table {
            widths,
            timed,
            room,
        }
    }

    /// The lines with the names of the columns and their units.
    pub fn heading(&self) -> String {
        heading().iter().map(|line| self.line(line)).collect()
    }

    /// The line of an effect.
    pub fn row(&self, row: &Row<'_>) -> String {
        self.line(&cells(row))
    }

    /// The lines below the effects.
    pub fn totals(&self, total: &Total) -> String {
        let lines = totals(total);
        let mut text: String = "\n".to_owned();
        text.extend(lines.iter().map(|line| self.line(line)));
        if let Some(noise) = total.noise() {
            text += &format!(
                "\nThis scene was timed twice; the times differ by {} ns. Smaller differences mean nothing.\n\
                 A larger difference without more operations comes from registers, which every change of the equations assigns again.\n",
                nanoseconds(noise)
            );
        }
        text
    }

    pub fn line(&self, line: &Cells) -> String {
        let shown = |column: usize| self.timed || !TIMES.contains(&column);
        let mut text = String::new();
        let [before @ .., last] = line;
        for (column, cell) in before
            .iter()
            .enumerate()
            .filter(|(column, _)| shown(*column))
        {
            let width = self.widths[column];
            text += &match column {
                0 => format!("{cell:width$}"),
                2..6 => format!("  {cell:>width$}"),
                _ => format!("  {cell:width$}"),
            };
        }
        let begin = text.chars().count() + 2;
        let room = self.room.unwrap_or(usize::MAX);
        let (parts, begin) = match room.saturating_sub(begin) {
            beside if beside >= last.chars().count() => (vec![last.clone()], begin),
            beside if beside >= NARROWEST => (wrap(last, beside), begin),
            // below the other columns, so the first part is empty
            _ => {
                let below = wrap(last, room.saturating_sub(INDENT));
                ([vec![String::new()], below].concat(), INDENT)
            }
        };
        for (index, part) in parts.iter().enumerate() {
            match index {
                0 => text += &format!("  {part}"),
                _ => text += &format!("\n{:begin$}{part}", ""),
            }
            text.truncate(text.trim_end().len());
        }
        text.truncate(text.trim_end().len());
        text + "\n"
    }
}

/// Number of characters of a usual time or code length: 12345.6.
const LIKELY: usize = 7;

fn heading() -> [Cells; 2] {
    [
        ["effect", "", "operations", "with", "without", "code", "why"].map(str::to_owned),
        ["", "", "", "[ns]", "[ns]", "[B]", ""].map(str::to_owned),
    ]
}

fn cells(row: &Row<'_>) -> Cells {
    let (with, without, code) = match row.measured {
        Some((with, without)) => (
            nanoseconds(with.time),
            nanoseconds(without.time),
            bytes(with.bytes, without.bytes),
        ),
        None => Default::default(),
    };
    let state = if row.entry.is_in { "in" } else { "out" };
    [
        row.entry.name.clone(),
        state.to_owned(),
        row.operations.map(difference).unwrap_or_default(),
        with,
        without,
        code,
        why(row.entry),
    ]
}

fn totals(total: &Total) -> [Cells; 2] {
    let of = |name: &str, count: &Count, measured: Option<Measured>, why: String| {
        let operations = Difference {
            operations: count.total() as i64,
            calls: calls(count) as i64,
        };
        let time = measured.map_or_else(String::new, |m| nanoseconds(m.time));
        let code = measured.map_or_else(String::new, |m| bytes(m.bytes, Some(0)));
        let operations = difference(operations);
        [
            name.to_owned(),
            String::new(),
            operations,
            time,
            String::new(),
            code,
            why,
        ]
    };
    let (scene, of_scene) = &total.scene;
    let (general, of_general) = &total.general;
    let why = format!("in space, {} run-time parameters", total.parameters);
    [
        of("this scene", scene, *of_scene, String::new()),
        of("with nothing left out", general, *of_general, why),
    ]
}

/// "10", "10 + 2" with calls, "-3"
pub fn difference(difference: Difference) -> String {
    match difference.calls {
        0 => difference.operations.to_string(),
        calls if calls < 0 => format!("{} - {}", difference.operations, -calls),
        calls => format!("{} + {calls}", difference.operations),
    }
}

fn nanoseconds(seconds: f64) -> String {
    format!("{:.1}", seconds * 1e9)
}

fn bytes(with: Option<u64>, without: Option<u64>) -> String {
    match (with, without) {
        (Some(with), Some(without)) => (with as i64 - without as i64).to_string(),
        _ => String::new(),
    }
}

/// The reason why an effect is in or out, and the line of the text that decides it.
fn why(entry: &Entry) -> String {
    let mut text = entry.why.clone();
    if let Some(place) = entry
        .place
        .as_ref()
        .filter(|_| entry.reason != Reason::Absent)
    {
        let line = match place.text.as_str() {
            "" => place.to_string(),
            text => format!("{place} {text}"),
        };
        text = match text.as_str() {
            "" => line,
            text => format!("{text} ({line})"),
        };
    }
    text
}

/// The whole table as JSON; `complete` is false if an interruption left something out.
pub fn as_json(model: &Model, rows: &[Row<'_>], total: &Total, complete: bool) -> Value {
    let effects: Vec<Value> = rows
        .iter()
        .map(|row| {
            let entry = row.entry;
            let place = entry.place.as_ref();
            let place = place.map(|p| json!({ "file": p.file, "line": p.line, "text": p.text }));
            json!({
                "effect": entry.name,
                "in": entry.is_in,
                "reason": entry.reason.word(),
                "why": entry.why,
                "place": place,
                "method": row.method.name(),
                "operations": row.operations.map(|d| d.operations),
                "calls": row.operations.map(|d| d.calls),
                "time_with_s": row.measured.map(|(with, _)| with.time),
                "time_without_s": row.measured.map(|(_, without)| without.time),
                "code_bytes": row.measured.and_then(|(with, without)| {
                    Some(with.bytes? as i64 - without.bytes? as i64)
                }),
            })
        })
        .collect();
    let of = |(count, measured): &(Count, Option<Measured>)| {
        json!({
            "operations": count.total(),
            "calls": calls(count),
            "time_s": measured.map(|m| m.time),
            "code_bytes": measured.and_then(|m| m.bytes),
        })
    };
    let mut general = of(&total.general);
    general["parameters"] = json!(total.parameters);
    json!({
        "model": model.name,
        "digest": model.digest,
        "effects": effects,
        "scene": of(&total.scene),
        "nothing_left_out": general,
        "noise_s": total.noise(),
        "complete": complete,
    })
}
