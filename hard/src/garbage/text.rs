//! Text that is almost a model, or far from one.

use super::panics::Tried;
use super::sample;
use crate::bench::{Bench, Trouble};
use crate::case::{Case, Group};
use crate::random::Random;
use bryant_generator::Diagnostics;
use bryant_generator::description::table::{Column, Fault, Table};
use bryant_generator::model::Model;

/// Damaged models, and text that is made to cost time or stack space.
pub const MODELS: Case = Case {
    group: Group::Garbage,
    name: "text that is no model",
    law: "Any text is a model or gets problems with places inside the text: a thousand problems at most, in messages that do not grow with \
          the text.",
    run: models,
};

/// Damaged tables.
pub const TABLES: Case = Case {
    group: Group::Garbage,
    name: "tables that are none",
    law: "A text of columns gives points with finite numbers, or gets a problem with a place inside the text.",
    run: tables,
};

/// Pieces with a meaning in YAML, and pieces without any meaning.
const PIECES: [&str; 46] = [
    "&a ",
    "*a",
    "<<: *a",
    "!!binary ",
    "!x ",
    "\0",
    "\r\n",
    "\r",
    "\u{feff}",
    "é",
    "𝄞",
    "\u{202e}",
    "\u{2028}",
    "\u{85}",
    "{",
    "[",
    "}",
    "]",
    "- ",
    "? ",
    ": ",
    "|",
    ">",
    "---\n",
    "...\n",
    "%YAML 1.2\n",
    "#",
    "\"",
    "'",
    "\t",
    "  ",
    "\n",
    ",",
    "@",
    "`",
    "~",
    "null",
    "true",
    "{}",
    "[]",
    "1e9",
    "\\",
    "\u{7}",
    "\u{fffd}",
    "on: frame",
    "\u{1b}[31m",
];

fn models(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let count = if bench.full() { 100_000 } else { 2500 };
    let mut random = Random::new(3);
    let mut tried = Tried::default();
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..count {
        let text = match random.below(10) {
            0 => soup(&mut random, &PIECES, 60),
            1 => {
                let bytes: Vec<u8> = (0..random.below(300))
                    .map(|_| random.bits() as u8)
                    .collect();
                String::from_utf8_lossy(&bytes).into_owned()
            }
            _ => {
                let (_, text) = random.one_of(sample::ALL);
                mutilated(&mut random, text)
            }
        };
        match tried.input(&|| text.clone(), || {
            well_reported(&text, sample::read(&text))
        }) {
            Some(true) => accepted += 1,
            Some(false) => refused += 1,
            None => {}
        }
    }
    for (what, text) in hostile() {
        tried.input(&|| what.to_owned(), || {
            match well_reported(&text, sample::read(&text))? {
                true => Err("it is accepted".to_owned()),
                false => Ok(()),
            }
        });
    }
    tried.note(
        bench,
        count,
        "a model, or problems with their places",
        "every error has a place and a remedy",
    );
    for (what, count) in [("refused", refused), ("accepted", accepted)] {
        bench.at_least(what, f64::from(count), 100.0, "", "every outcome occurs");
    }
    Ok(())
}

/// True if a text is a model; an `Err` if a message about the text makes no sense.
fn well_reported(text: &str, read: Result<Model, Diagnostics>) -> Result<bool, String> {
    let Err(problems) = read else {
        return Ok(true);
    };
    if problems.problems.is_empty() || problems.problems.len() > 1000 {
        return Err(format!("{} problems", problems.problems.len()));
    }
    for problem in &problems.problems {
        if problem.message.is_empty() || problem.help.is_empty() {
            return Err(format!("no message or no remedy: {}", problem.line()));
        }
        if problem.message.len().max(problem.help.len()) > 2000 {
            return Err(format!("a message of {} bytes", problem.message.len()));
        }
        if problem.message.chars().any(char::is_control)
            || problem.help.chars().any(char::is_control)
        {
            return Err(format!(
                "a message with control characters: {:?}",
                problem.message
            ));
        }
        // a place may be after the end of the text
        let lines = text
            .split(['\n', '\r', '\u{85}', '\u{2028}', '\u{2029}'])
            .count()
            + 1;
        if problem.file == "garbage.yaml" && problem.line > lines {
            return Err(format!(
                "line {} of {lines}: {}",
                problem.line, problem.message
            ));
        }
    }
    // at most fifty problems are shown, with an excerpt of at most 2000 characters each
    for drawn in [problems.render(true), problems.render(false)] {
        if drawn.is_empty() || drawn.len() > 2_000_000 {
            return Err(format!("drawn in {} bytes", drawn.len()));
        }
    }
    Ok(false)
}

/// A random sequence of pieces.
fn soup(random: &mut Random, pieces: &[&str], most: usize) -> String {
    (0..random.below(most))
        .map(|_| *random.one_of(pieces))
        .collect()
}

/// A text with a few random changes.
fn mutilated(random: &mut Random, text: &str) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for _ in 0..1 + random.below(3) {
        let at = random.below(lines.len());
        match random.below(12) {
            0 if lines.len() > 1 => {
                lines.remove(at);
            }
            1 => lines.insert(at, lines[at].clone()),
            2 => {
                let other = random.below(lines.len());
                lines.swap(at, other);
            }
            3 => lines[at].insert_str(0, &" ".repeat(1 + random.below(5))),
            4 => lines[at] = lines[at].trim_start().to_owned(),
            5 => lines[at].insert(0, '\t'),
            6 => lines.truncate(at + 1),
            7 => {
                let line = lines[random.below(lines.len())].clone();
                lines[at].push_str(&line);
            }
            8 => lines[at].push_str(&"x".repeat(random.below(3000))),
            9 => {
                // remove or replace one character
                let mut characters: Vec<char> = lines[at].chars().collect();
                if !characters.is_empty() {
                    let place = random.below(characters.len());
                    match random.one_in(2) {
                        true => characters[place] = char::from(b' ' + random.below(95) as u8),
                        false => {
                            characters.remove(place);
                        }
                    }
                }
                lines[at] = characters.into_iter().collect();
            }
            _ => {
                let places: Vec<usize> = lines[at].char_indices().map(|(i, _)| i).collect();
                let place = if places.is_empty() {
                    0
                } else {
                    *random.one_of(&places)
                };
                let piece: &&str = random.one_of(&PIECES);
                lines[at].insert_str(place, piece);
            }
        }
    }
    lines.join(if random.one_in(10) { "\r\n" } else { "\n" })
}

/// Texts that are made to cost time, memory or stack, with descriptions.
fn hostile() -> Vec<(&'static str, String)> {
    let model = "model: m\ndimension: 2\nsystems:\n  - name: s\n    elements: [{ name: e, mass: 1, cg: [0, 0], inertia: 1 }]\n";
    let mut laughs = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n".to_owned();
    for i in 1..40 {
        let before = format!("*a{}", i - 1);
        laughs += &format!("a{i}: &a{i} [{}]\n", [before.as_str(); 9].join(", "));
    }
    let nested = |level: &dyn Fn(usize) -> String| (0..2000).map(level).collect::<String>();
    vec![
        ("a billion laughs", laughs),
        (
            "10 000 brackets",
            format!("{model}title: {}", "[".repeat(10_000)),
        ),
        (
            "10 000 braces",
            format!("{model}title: {}", "{a: ".repeat(10_000)),
        ),
        (
            "10 000 pairs of brackets",
            format!("{model}title: {}{}", "[".repeat(10_000), "]".repeat(10_000)),
        ),
        (
            "10 000 lists in a line",
            format!("{model}title:\n  {}x", "- ".repeat(10_000)),
        ),
        ("10 000 keys of keys", "? ".repeat(10_000)),
        (
            "2000 levels of indentation",
            nested(&|i| format!("{}a:\n", " ".repeat(i))),
        ),
        (
            "10 000 parentheses",
            format!("{model}parameters: {{ a: {} }}\n", "(".repeat(10_000)),
        ),
        (
            "1000 parentheses",
            format!(
                "{model}parameters: {{ a: {}1{} }}\n",
                "(".repeat(480),
                ")".repeat(480)
            ),
        ),
        (
            "a million signs",
            format!("{model}parameters: {{ a: 1{} }}\n", "-".repeat(1_000_000)),
        ),
        (
            "a number of a million digits",
            format!("{model}parameters: {{ a: {} }}\n", "9".repeat(1_000_000)),
        ),
        (
            "a key of a megabyte",
            format!("{model}{}: 1\n", "k".repeat(1 << 20)),
        ),
        (
            "a name of a megabyte",
            model.replace("name: s", &format!("name: {}", "s".repeat(1 << 20))),
        ),
        (
            "a megabyte of combining marks",
            format!("{model}title: [{}]\n", "\u{301}".repeat(1 << 19)),
        ),
        (
            "5000 problems",
            format!(
                "{model}curves:\n{}",
                (0..5000)
                    .map(|i| format!("  c{i}: {{ points: [] }}\n"))
                    .collect::<String>()
            ),
        ),
        (
            "5000 keys that are near misses",
            format!(
                "{model}{}",
                (0..5000)
                    .map(|i| format!("forcess{i}: 1\n"))
                    .collect::<String>()
            ),
        ),
        (
            "merge keys",
            format!("{model}run: {{ <<: {{ duration: 1 }} }}\n"),
        ),
        ("only a byte order mark", "\u{feff}".to_owned()),
        ("nothing", String::new()),
        ("a zero byte", "\0".to_owned()),
        ("CR alone", model.replace('\n', "\r\r") + "x"),
    ]
}

fn tables(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let count = if bench.full() { 200_000 } else { 5000 };
    const CELLS: [&str; 24] = [
        "0", "1", "2", "-1", "1e308", "5e-324", "nan", "inf", "-inf", "1e999", "", " ", "\"",
        "\"1\"", "1,5", ";", ",", "\t", "\n", "#", "x", "é", "\r\n", "\0",
    ];
    let mut random = Random::new(4);
    let mut tried = Tried::default();
    let (mut accepted, mut refused) = (0, 0);
    for _ in 0..count {
        let text = match random.below(4) {
            0 => soup(&mut random, &CELLS, 60),
            _ => mutilated(&mut random, sample::PULSE),
        };
        let column = |random: &mut Random| match random.below(4) {
            0 => Column::Name("time [ms]".into()),
            1 => Column::Name(soup(random, &CELLS, 4)),
            _ => Column::Number(random.below(4)),
        };
        let wanted = [column(&mut random), column(&mut random)];
        let input = || format!("{wanted:?} of {text:?}");
        let found = tried.input(&input, || {
            let table = Table::new("t.csv", &text).map_err(|problem| problem.line())?;
            match table.columns(Some(&wanted)).map(|found| found.rows) {
                Ok(rows) if rows.len() < 2 => Err(format!("{} points", rows.len())),
                Ok(rows) => match rows.iter().flat_map(|row| row.values).all(f64::is_finite) {
                    true => Ok(true),
                    false => Err(format!("{rows:?}")),
                },
                Err(Fault::Column(_, message, help)) if message.len() + help.len() < 4000 => {
                    Ok(false)
                }
                Err(Fault::Column(_, message, _)) => {
                    Err(format!("a message of {} bytes", message.len()))
                }
                Err(Fault::InFile(problem)) => match problem.to_string().len() {
                    0..10_000 => Ok(false),
                    length => Err(format!("drawn in {length} bytes")),
                },
            }
        });
        match found {
            Some(true) => accepted += 1,
            Some(false) => refused += 1,
            None => {}
        }
    }
    tried.note(
        bench,
        count,
        "points, or a problem",
        "no number that is not finite reaches a curve",
    );
    for (what, count) in [("refused", refused), ("accepted", accepted)] {
        bench.at_least(what, f64::from(count), 100.0, "", "every outcome occurs");
    }
    Ok(())
}
