//! Puts meaningless numbers in place of each number of a model.

use super::panics::Tried;
use super::sample;
use super::start::{Found, Start};
use crate::bench::{Bench, Engine, Trouble};
use crate::case::{Case, Group};
use crate::random::Random;
use bryant_generator::description::tree::{Node, NodeKind, Source, Span};

/// Replaces every number in the text of valid models.
pub const IN_THE_TEXT: Case = Case {
    group: Group::Garbage,
    name: "no numbers in the place of every number",
    law: "A number that makes no sense is refused with its place. Otherwise the equations have finite values at the start, or a run \
          reports before its first sample that their rates are not finite.",
    run: in_the_text,
};

/// Sets parameters of valid models at run time.
pub const AT_RUN_TIME: Case = Case {
    group: Group::Garbage,
    name: "parameters at the ends of what a number can be",
    law: "For every value of a parameter within its bounds the equations have finite values at the start, or a quantity that a run checks \
          is not finite.",
    run: at_run_time,
};

/// The replacements of a number.
const GARBAGE: [&str; 24] = [
    ".nan",
    "nan",
    ".inf",
    "-.inf",
    "inf",
    "1e308",
    "-1e308",
    "1e400",
    "1e-400",
    "5e-324",
    "-5e-324",
    "1e-200",
    "1e200",
    "0",
    "-0.0",
    "-1",
    "1/0",
    "0/0",
    "sqrt(-1)",
    "1e200 * 1e200",
    "1e9",
    "~",
    "1e",
    "0x10",
];

/// Number of replacements that are tried for each number; and of the accepted models, one in `DERIVED` is derived. The
/// full case tries and derives all.
const TRIED: usize = 6;
const DERIVED: usize = 6;

fn in_the_text(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let mut tried = Tried::default();
    let mut random = Random::new(1);
    let (mut refused, mut finite, mut reported) = (0, 0, 0);
    for scene in sample::scenes() {
        let tree = Source::parse(&scene.name, &scene.text)
            .map_err(|problem| Trouble::Case(problem.to_string()))?;
        let mut places = Vec::new();
        numbers(&tree.root, &mut places);
        for place in places {
            for garbage in chosen(&mut random, bench.full()) {
                let text = replaced(&tree.text, place, garbage);
                let derive = bench.full() || random.one_in(DERIVED);
                let input = || {
                    format!(
                        "{}, {garbage} at {}:{}",
                        scene.name, place.line, place.column
                    )
                };
                match tried.input(&input, || judge(bench.engine(), &text, derive)) {
                    Some(Judged::Refused) => refused += 1,
                    Some(Judged::Derived(Found::Finite)) => finite += 1,
                    Some(Judged::Derived(_)) => reported += 1,
                    Some(Judged::Accepted) | None => {}
                }
            }
        }
    }
    tried.note(
        bench,
        5000,
        "refused with place and remedy, or finite, or reported",
        "no number that is not finite is reported",
    );
    // each outcome must occur, or the case would prove nothing
    for (what, count) in [
        ("refused", refused),
        ("accepted, finite", finite),
        ("accepted, not finite and reported", reported),
    ] {
        bench.at_least(what, f64::from(count), 10.0, "", "every outcome occurs");
    }
    Ok(())
}

fn at_run_time(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    const VALUES: [f64; 12] = [
        0.0,
        -0.0,
        -1.0,
        5e-324,
        -5e-324,
        1e-300,
        1e-160,
        1e160,
        -1e160,
        f64::MAX,
        f64::MIN,
        1e9,
    ];
    let mut tried = Tried::default();
    let (mut finite, mut reported) = (0, 0);
    for scene in sample::scenes() {
        let model = sample::read(&scene.text).map_err(|p| Trouble::Refused(p.to_string()))?;
        if model.parameters.is_empty() {
            continue;
        }
        let start = Start::of(bench.engine(), &model);
        let defaults: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
        for (i, parameter) in model.parameters.iter().enumerate() {
            let ends = [parameter.min, parameter.max].into_iter().flatten();
            // a job refuses values outside the bounds
            let within = |value: &f64| {
                parameter.min.is_none_or(|min| *value >= min)
                    && parameter.max.is_none_or(|max| *value <= max)
            };
            for value in ends.chain(VALUES.into_iter().filter(within)) {
                let mut values = defaults.clone();
                values[i] = value;
                let input = || format!("{}, {} = {value:e}", scene.name, parameter.name);
                let check = || match start.at(&values) {
                    Found::Silent(what) => Err(format!("{what} is no number, and nothing says so")),
                    found => Ok(found),
                };
                match tried.input(&input, check) {
                    Some(Found::Finite) => finite += 1,
                    Some(_) => reported += 1,
                    None => {}
                }
            }
        }
    }
    tried.note(
        bench,
        50,
        "finite, or reported",
        "no number that is not finite is reported",
    );
    for (what, count) in [("finite", finite), ("not finite and reported", reported)] {
        bench.at_least(what, f64::from(count), 1.0, "", "every outcome occurs");
    }
    Ok(())
}

/// What happened to a model with a replaced number.
enum Judged {
    Refused,
    Accepted,
    Derived(Found),
}

fn judge(engine: &dyn Engine, text: &str, derive: bool) -> Result<Judged, String> {
    let model = match sample::read(text) {
        Ok(model) => model,
        Err(problems) => {
            for problem in &problems.problems {
                if problem.message.is_empty() || problem.help.is_empty() || problem.line == 0 {
                    return Err(format!("no place or no remedy: {}", problem.line()));
                }
            }
            return Ok(Judged::Refused);
        }
    };
    if !derive {
        return Ok(Judged::Accepted);
    }
    let defaults: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    match Start::of(engine, &model).at(&defaults) {
        Found::Silent(what) => Err(format!("{what} is no number, and nothing says so")),
        found => Ok(Judged::Derived(found)),
    }
}

/// Random replacements, or all.
fn chosen(random: &mut Random, all: bool) -> Vec<&'static str> {
    match all {
        true => GARBAGE.to_vec(),
        false => (0..TRIED).map(|_| *random.one_of(&GARBAGE)).collect(),
    }
}

/// Finds the places of numbers: scalars that begin like a number.
fn numbers(node: &Node, places: &mut Vec<Span>) {
    match &node.kind {
        NodeKind::Scalar { text, .. } => {
            if text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
                places.push(node.span);
            }
        }
        NodeKind::List(items) => items.iter().for_each(|item| numbers(item, places)),
        NodeKind::Map(entries) => entries
            .iter()
            .for_each(|entry| numbers(&entry.value, places)),
    }
}

/// The text with a replacement in one place.
fn replaced(text: &str, place: Span, by: &str) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let line: Vec<char> = lines[place.line - 1].chars().collect();
    let (before, rest) = line.split_at(place.column - 1);
    let after = &rest[place.length.min(rest.len())..];
    lines[place.line - 1] = before
        .iter()
        .copied()
        .chain(by.chars())
        .chain(after.iter().copied())
        .collect();
    lines.join("\n")
}
