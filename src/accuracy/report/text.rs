//! The table of a study: a group for each formula, a row for each point; points on the Pareto front are marked.

use crate::accuracy::conclusion::{Conclusion, bounded_by_stability};
use crate::accuracy::point::{Done, Known, Measure, Point, Status};
use crate::accuracy::setting::{Curves, Pace, Scheme, time, two_digits};
use crate::accuracy::study::Study;
use crate::command::fitted;
use bryant_picture::text::wrap;
use std::fmt::Write as _;

/// The mark in front of a point on the front.
const MARK: &str = "*";

/// Cells of a row; the first `WORDS` are left-aligned.
type Row = Vec<String>;

/// Number of columns with words, which are left-aligned and come before those with numbers.
const WORDS: usize = 5;

/// Columns in the order in which they are left out where there is no room: late times, operations, order, energy gap, evaluations, simulated time
/// over wall time. Files have all of them.
const LEAST: [usize; 6] = [12, 10, 6, 8, 9, 13];
/// Spaces between columns.
const GAP: usize = 2;
/// A cause has at least so many characters in a line.
const NARROWEST: usize = 24;

/// Head, groups and the meaning of the marks, in lines of at most `room` characters; the last line has no line end.
pub fn text(study: &Study, conclusion: &Conclusion, room: Option<usize>) -> String {
    let mut text = head(study);
    let rows: Vec<(usize, Row)> = study
        .points
        .iter()
        .enumerate()
        .map(|(index, point)| (index, row(study, point, conclusion.front.contains(&index))))
        .collect();
    let [heading, units] = heading(study);
    let columns = heading.len();
    let complete = rows
        .iter()
        .map(|(_, row)| row)
        .filter(|r| r.len() == columns);
    let widths: Vec<usize> = (0..columns)
        .map(|column| {
            let cells = complete.clone().chain([&heading, &units]);
            let lengths = cells.map(|row| row[column].chars().count());
            lengths.max().unwrap_or(0)
        })
        .collect();
    let columns = Columns::of(&widths, room);
    for scheme in schemes(study) {
        let _ = writeln!(
            text,
            "\n{}, {}, order {}",
            scheme.name(),
            scheme.title(),
            scheme.formula.order()
        );
        columns.line(&heading, &mut text);
        columns.line(&units, &mut text);
        for (index, row) in &rows {
            if study.points[*index].setting.scheme() == scheme {
                columns.line(row, &mut text);
            }
        }
    }
    let left_out = columns.left_out.iter().map(|column| {
        let named = format!("{} {}", heading[*column], units[*column]);
        named.trim_end().to_owned()
    });
    let left_out: Vec<String> = left_out.collect();
    if !left_out.is_empty() {
        let _ = write!(
            text,
            "\nnot shown, for want of room: {}; --csv has all columns\n",
            left_out.join(", ")
        );
    }
    let _ = write!(
        text,
        "\n{MARK} no other setting is both as accurate and as fast ({})\n≤ below the reference's own error\norder: seen between \
         this row and the one above, of the error in the state over the step, or over the tolerance",
        study.of.name(&study.reference.readings)
    );
    for (name, step, rate) in bounded_by_stability(study) {
        let _ = write!(
            text,
            "\n{name}: stability, not accuracy, bounds the steps, which are {} on average: the limit of a motion of {:.0} 1/s",
            time(two_digits(step)),
            two_digits(rate)
        );
    }
    if let Some(fastest) = &study.fastest {
        let _ = write!(text, "\n{}; rodas5 has no such bound", fastest.text());
    }
    match room {
        Some(room) => fitted(&text, room),
        None => text,
    }
}

/// The schemes of a study, in their usual order.
pub fn schemes(study: &Study) -> Vec<Scheme> {
    let there = |scheme: &Scheme| study.points.iter().any(|p| p.setting.scheme() == *scheme);
    Scheme::all().into_iter().filter(there).collect()
}

/// The subject of the study and its reference.
fn head(study: &Study) -> String {
    let mut text = format!(
        "{}: {} in samples of {}\nreference: {}\n",
        study.model,
        time(study.duration),
        time(study.every),
        study.reference.statement
    );
    if let Some(exchanged) = &study.exchanged {
        let worst = exchanged.readings.iter().copied().fold(0.0, f64::max);
        let _ = writeln!(
            text,
            "curves exchanged (cubics for straight lines): another scene, {} away in the state, {} in the worst reading; its rows are \
             measured against its own reference ({})",
            error(exchanged.state),
            error(worst),
            exchanged.reference.statement
        );
    }
    if let Some(why) = &study.not_exchanged {
        let _ = writeln!(
            text,
            "curves exchanged (cubics for straight lines): left out, {}",
            one_line(why)
        );
    }
    text
}

fn heading(study: &Study) -> [Row; 2] {
    let of = match study.of {
        // the state has a column of its own
        Measure::State | Measure::Worst => "worst reading".to_owned(),
        other => other.name(&study.reference.readings),
    };
    let columns = [
        ("", ""),
        ("step or", "tolerance"),
        ("scalar", ""),
        ("kinks", ""),
        ("curves", ""),
        ("error in", "the state"),
        ("order", "of it"),
        ("error in", &of),
        ("energy", "gap"),
        ("evaluations", ""),
        ("operations", "[10³]"),
        ("median", "[ms]"),
        ("95 %", "[ms]"),
        ("simulated", "/wall"),
    ];
    [
        columns.iter().map(|c| c.0.to_owned()).collect(),
        columns.iter().map(|c| c.1.to_owned()).collect(),
    ]
}

fn row(study: &Study, point: &Point, front: bool) -> Row {
    let setting = &point.setting;
    let mut row = vec![
        if front { MARK } else { "" }.to_owned(),
        match setting.pace {
            Pace::Step(step) => time(step),
            Pace::Tolerance(tolerance) => format!("{tolerance:e}"),
        },
        setting.scalar.name().to_owned(),
        setting.kinks().to_owned(),
        match setting.curves {
            Curves::Written => String::new(),
            Curves::Exchanged => "exchanged".to_owned(),
        },
    ];
    match &point.status {
        Status::Done(done) => row.extend(numbers(study, point, done)),
        Status::Failed(reason) => row.push(format!("failed: {}", one_line(reason))),
        Status::Skipped(reason) => row.push(format!("skipped: {}", one_line(reason))),
    }
    row
}

fn numbers(study: &Study, point: &Point, done: &Done) -> Row {
    let own = study.own(point.setting.curves);
    let of = match study.of {
        Measure::State => Measure::Worst,
        other => other,
    };
    let wall = done.timing.median;
    vec![
        known(done.error(Measure::State, own)),
        done.order.map_or("-".into(), order),
        known(done.error(of, own)),
        done.energy.map_or("-".into(), error),
        done.report.evaluations.to_string(),
        digits(done.operations as f64 / 1e3),
        digits(1e3 * wall),
        digits(1e3 * done.timing.late),
        digits(done.report.t / wall),
    ]
}

/// The first line of a text.
pub fn one_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().trim().to_owned()
}

/// An order with one decimal; zero has no sign.
fn order(value: f64) -> String {
    format!("{:.1}", (10.0 * value).round() / 10.0 + 0.0)
}

/// An error with two digits.
pub fn error(value: f64) -> String {
    format!("{value:.1e}")
}

/// An error; with "≤" if only a bound is known.
pub fn known(known: Known) -> String {
    let bound = if known.at_most { "≤" } else { "" };
    format!("{bound}{}", error(known.error))
}

/// A number with about three digits.
pub fn digits(value: f64) -> String {
    if !value.is_finite() {
        return "-".into();
    }
    let exponent = libm::log10(value.abs().max(1e-9)).floor() as i32;
    let decimals = (2 - exponent).clamp(0, 6) as usize;
    format!("{value:.decimals$}")
}

/// The columns that are shown.
struct Columns {
    /// Their indices and widths.
    shown: Vec<(usize, usize)>,
    /// The number of all columns.
    all: usize,
    /// The indices of those with content that have no room.
    left_out: Vec<usize>,
    room: Option<usize>,
}

impl Columns {
    /// All columns of these widths, or those for which there is room.
    fn of(widths: &[usize], room: Option<usize>) -> Self {
        let mut shown: Vec<(usize, usize)> = widths.iter().copied().enumerate().collect();
        let mut left_out = Vec::new();
        if let Some(room) = room {
            let too_wide = |shown: &[(usize, usize)]| {
                let widths = shown.iter().map(|(_, width)| width + GAP);
                widths.sum::<usize>() > room + GAP
            };
            for column in LEAST {
                if too_wide(&shown) {
                    shown.retain(|(index, _)| *index != column);
                    left_out.push(column);
                }
            }
            left_out.sort_unstable();
        }
        Columns {
            shown,
            all: widths.len(),
            left_out,
            room,
        }
    }

    /// Cells side by side; a shorter row ends in words, which may be long and go on below their beginning.
    fn line(&self, row: &Row, text: &mut String) {
        let whole = row.len() == self.all;
        let mut line = String::new();
        for (place, (column, width)) in self.shown.iter().enumerate() {
            let gap = if place == 0 { 0 } else { GAP };
            // Padding counts characters, not bytes.
            let _ = match row.get(*column) {
                Some(cell) if *column < WORDS => write!(line, "{:gap$}{cell:<width$}", ""),
                Some(cell) if whole => write!(line, "{:gap$}{cell:>width$}", ""),
                _ => break,
            };
        }
        if let (false, Some(words)) = (whole, row.get(WORDS)) {
            let begin = line.chars().count() + GAP;
            let room = self
                .room
                .map_or(usize::MAX, |room| room.saturating_sub(begin).max(NARROWEST));
            let words = wrap(words, room).join(&format!("\n{:begin$}", ""));
            let _ = write!(line, "{:GAP$}{words}", "");
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!(digits(0.21456), "0.215");
        assert_eq!(digits(21.456), "21.5");
        assert_eq!(digits(2145.6), "2146");
        assert_eq!(digits(f64::INFINITY), "-");
        assert_eq!((order(-0.04), order(3.96)), ("0.0".into(), "4.0".into()));
        let below = Known {
            error: 1.23e-10,
            at_most: true,
        };
        assert_eq!(known(below), "≤1.2e-10");
    }

    fn lines(rows: &[&[&str]], widths: &[usize], room: Option<usize>) -> String {
        let columns = Columns::of(widths, room);
        let mut text = String::new();
        for row in rows {
            let row = row.iter().map(|cell| cell.to_string()).collect();
            columns.line(&row, &mut text);
        }
        text
    }

    #[test]
    fn numbers_are_right_aligned_and_words_left() {
        let rows: [&[&str]; 2] = [
            &["*", "1e-3", "f64", "a", "", "1.5"],
            &["", "1e-3", "f64", "a", ""],
        ];
        assert_eq!(
            lines(&rows, &[1, 6, 3, 3, 3, 8], None),
            "*  1e-3    f64  a              1.5\n   1e-3    f64  a\n"
        );
    }

    #[test]
    fn columns_are_left_out_until_a_line_has_room() {
        let widths = [1, 9, 3, 7, 0, 9, 5, 13, 6, 11, 10, 6, 6, 9];
        let whole: Vec<String> = widths.iter().map(|width| "8".repeat(*width)).collect();
        let whole: Vec<&str> = whole.iter().map(String::as_str).collect();
        let cause = "skipped: not reached: the time was used up, and more of it would not help";
        let short = [&whole[..WORDS], &[cause]].concat();
        assert_eq!(Columns::of(&widths, None).left_out, [0; 0]);
        let all = lines(&[&whole, &short], &widths, None);
        assert!(
            all.lines()
                .next()
                .is_some_and(|line| line.chars().count() > 100)
        );
        for room in [80, 90, 100, 200] {
            let text = lines(&[&whole, &short], &widths, Some(room));
            assert!(
                text.lines().all(|line| line.chars().count() <= room),
                "{text}"
            );
            // all words are there, and as many columns as there is room for
            let words: Vec<&str> = text.split_whitespace().collect();
            assert!(words.join(" ").ends_with(cause), "{text}");
            let columns = Columns::of(&widths, Some(room));
            let first = text.lines().next().map_or(0, |line| line.chars().count());
            let last = columns.left_out.iter().map(|column| widths[*column]).max();
            assert!(last.is_none_or(|last| first + GAP + last > room), "{text}");
            assert_eq!(columns.left_out.is_empty(), room == 200);
        }
    }
}
