//! Arithmetic in quantities: random sequences of its tokens, and expressions with known values.

use super::panics::Tried;
use crate::bench::{Bench, Trouble};
use crate::case::{Case, Group};
use crate::random::Random;
use bryant_generator::description::expression::{
    Expression, ExpressionKind, Function, Operator, parse,
};

/// The reader of quantities.
pub const QUANTITIES: Case = Case {
    group: Group::Garbage,
    name: "soups of quantities",
    law: "Any text is an expression, or a mistake with a place inside the text. An expression that is written at random has the value from \
          which it was made, within c·κ·ε.",
    run: quantities,
};

const WORDS: [&str; 58] = [
    "1",
    "0",
    "2.5",
    "1e308",
    "1e-308",
    "5e-324",
    "1e400",
    "1e-400",
    ".5",
    "5.",
    ".",
    "1e",
    "1e+",
    "1.2.3",
    "0x1",
    "+",
    "-",
    "*",
    "/",
    "(",
    ")",
    "(",
    ")",
    "^",
    "^",
    "²",
    "³",
    "·",
    "−",
    "×",
    "sqrt",
    "sin",
    "cos",
    "sqrt(",
    "sin(",
    "pi",
    "m",
    "kg",
    "s",
    "mm",
    "N",
    "kN",
    "deg",
    "°",
    "%",
    "h",
    "rpm",
    "gn",
    "L",
    "µm",
    "p",
    "q",
    "é",
    "\0",
    "^999999999",
    "^-9",
    "s^-1",
    "\u{2028}",
];

fn quantities(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let count = if bench.full() { 1_000_000 } else { 30_000 };
    let mut random = Random::new(5);
    let mut tried = Tried::default();
    let (mut read, mut refused) = (0, 0);
    for _ in 0..count {
        let words: Vec<&str> = (0..random.below(12))
            .map(|_| *random.one_of(&WORDS))
            .collect();
        let text = words.join(if random.one_in(3) { " " } else { "" });
        let found = tried.input(&|| text.clone(), || within(&text));
        match found {
            Some(true) => read += 1,
            Some(false) => refused += 1,
            None => {}
        }
    }
    // deeply nested texts, long texts, and both
    for word in [
        "(", "-", "+", "sqrt(", "1*", "1+", "1/", "m*", "m/", "1 ", "m ", "^", "m^9*", "(1)", "pi",
    ] {
        for count in [10, 63, 64, 65, 200, 333, 999, 100_000] {
            for end in ["", "1", "m", ")"] {
                let text = word.repeat(count) + end;
                tried.input(&|| format!("{count} × {word}{end}"), || within(&text));
            }
        }
    }
    for _ in 0..count / 10 {
        let written = Written::at_random(&mut random, 5);
        let found = tried.input(&|| written.text.clone(), || agrees(&written));
        read += usize::from(found.is_some());
    }
    tried.note(
        bench,
        count,
        "a value, or a mistake in its place",
        "c·κ·ε: 4 ε for each operation on the sum of the absolute values",
    );
    for (what, count) in [("refused", refused), ("read", read)] {
        bench.at_least(what, count as f64, 1000.0, "", "every outcome occurs");
    }
    Ok(())
}

/// True if a text is an expression; an `Err` if a reported place is not inside the text.
fn within(text: &str) -> Result<bool, String> {
    let characters = text.chars().count();
    match parse(text) {
        Ok(expression) => match expression.offset + expression.length <= characters {
            true => Ok(true),
            false => Err(format!("{expression:?} is longer than its text")),
        },
        Err(mistake) => {
            let good = mistake.offset <= characters
                && mistake.offset + mistake.length <= characters + 1
                && mistake.message.len() < 1000
                && !mistake.help.is_empty();
            match good {
                true => Ok(false),
                false => Err(format!("{mistake:?}")),
            }
        }
    }
}

/// An expression as text, with its value and a bound of its rounding error: the sum of the absolute values of all
/// parts, each times the factor by which the expression amplifies its error.
struct Written {
    text: String,
    value: f64,
    error: f64,
}

/// Units with their factors, from their definitions.
const UNITS: [(&str, f64); 14] = [
    ("", 1.0),
    ("", 1.0),
    ("", 1.0),
    (" m", 1.0),
    (" mm", 1e-3),
    ("kN", 1e3),
    (" deg", std::f64::consts::PI / 180.0),
    (" rpm", std::f64::consts::PI / 30.0),
    (" km/h", 1000.0 / 3600.0),
    (" cm^2", 1e-4),
    (" g", 1e-3),
    (" MPa*mm²", 1.0),
    (" %", 1e-2),
    (" 1", f64::NAN),
];

impl Written {
    fn at_random(random: &mut Random, depth: usize) -> Written {
        // rounding of the value is added to the errors that its operands carry over
        let made = |text: String, value: f64, carried: f64| Written {
            text,
            value,
            error: carried + 4.0 * f64::EPSILON * value.abs(),
        };
        if depth == 0 || random.one_in(4) {
            let number = random.uniform(0.1, 10.0);
            let (unit, factor) = UNITS[random.below(UNITS.len() - 1)];
            return made(format!("{number:?}{unit}"), number * factor, 0.0);
        }
        let a = Written::at_random(random, depth - 1);
        let space = |random: &mut Random| if random.one_in(2) { " " } else { "" };
        match random.below(7) {
            0 => made(format!("-({})", a.text), -a.value, a.error),
            1 => made(format!("sin({})", a.text), a.value.sin(), a.error),
            2 => made(format!("cos({})", a.text), a.value.cos(), a.error),
            kind => {
                let b = Written::at_random(random, depth - 1);
                let (sign, value, carried) = match kind {
                    3 => ("+", a.value + b.value, a.error + b.error),
                    4 => ("-", a.value - b.value, a.error + b.error),
                    5 => (
                        "*",
                        a.value * b.value,
                        a.error * b.value.abs() + b.error * a.value.abs(),
                    ),
                    _ => {
                        let ratio = a.value / b.value;
                        (
                            "/",
                            ratio,
                            (a.error + b.error * ratio.abs()) / b.value.abs(),
                        )
                    }
                };
                let text = format!(
                    "({}){}{sign}{}({})",
                    a.text,
                    space(random),
                    space(random),
                    b.text
                );
                made(text, value, carried)
            }
        }
    }
}

fn agrees(written: &Written) -> Result<(), String> {
    if written.text.chars().count() > 1000 {
        return match parse(&written.text) {
            Ok(_) => Err("longer than allowed".into()),
            Err(_) => Ok(()),
        };
    }
    let expression = parse(&written.text).map_err(|mistake| format!("{mistake:?}"))?;
    let value = value(&expression);
    // if a divisor may be 0 within its error, no bound is known
    let known = written.error.is_finite() && written.error < 1e-3 * (1.0 + written.value.abs());
    match !known || (value - written.value).abs() <= written.error {
        true => Ok(()),
        false => Err(format!(
            "{value:e} instead of {:e} ± {:e}",
            written.value, written.error
        )),
    }
}

fn value(expression: &Expression) -> f64 {
    match &expression.kind {
        ExpressionKind::Number(value) => *value,
        ExpressionKind::Quantity(value, unit) => value * unit.factor,
        ExpressionKind::Parameter(_) => f64::NAN,
        ExpressionKind::Negative(a) => -value(a),
        ExpressionKind::Binary(operator, a, b) => {
            let (a, b) = (value(a), value(b));
            match operator {
                Operator::Add => a + b,
                Operator::Subtract => a - b,
                Operator::Multiply => a * b,
                Operator::Divide => a / b,
            }
        }
        ExpressionKind::Call(function, a) => match function {
            Function::SquareRoot => value(a).sqrt(),
            Function::Sine => value(a).sin(),
            Function::Cosine => value(a).cos(),
        },
    }
}
