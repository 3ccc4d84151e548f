//! Quantities on the command line and in studies, written as in a model: `0.1 ms`, `60 kN`, `20 deg`, `2 * 9.81 m/s^2`.
//!
//! A bare number is in SI units.

use bryant_generator::description::expression::{
    Expression, ExpressionKind, Function, Operator, parse,
};
use bryant_generator::description::unit::Dimension;

/// A text that is not a quantity with the requested unit; the message has a remedy.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct QuantityError(String);

/// The value in SI units of a quantity whose SI unit is `unit`; any dimension is accepted if `unit` is empty.
///
/// # Errors
/// The text is not a quantity, or has another dimension.
pub fn quantity(text: &str, unit: &str) -> Result<f64, QuantityError> {
    read(text, unit, dimension(unit))
}

/// The value in SI units of a quantity whose SI unit is `unit`; a pure number if `unit` is empty.
///
/// # Errors
/// The text is not a quantity, or has another dimension.
pub fn strict(text: &str, unit: &str) -> Result<f64, QuantityError> {
    let pure = unit.is_empty().then_some(Dimension::ONE);
    read(text, unit, pure.or_else(|| dimension(unit)))
}

fn read(text: &str, unit: &str, wanted: Option<Dimension>) -> Result<f64, QuantityError> {
    let expression = parse(text).map_err(|mistake| {
        QuantityError(format!("{}\n  help: {}", mistake.message, mistake.help))
    })?;
    let value = evaluate(&expression)?;
    if !value.number.is_finite() {
        return fail(format!("\"{text}\" is not a finite number"));
    }
    match (value.dimension, wanted) {
        (Some(found), Some(wanted)) if found != wanted => {
            let found = named(found);
            fail(match unit {
                "" => format!(
                    "\"{text}\" is {found}, but a pure number is needed\n  help: write it without a unit, or in %"
                ),
                unit => format!(
                    "\"{text}\" is {found}, but a quantity in {unit} is needed\n  \
                     help: write it with a unit of that kind, or as a bare number in {unit}"
                ),
            })
        }
        _ => Ok(value.number),
    }
}

/// A length of time \[s\], positive.
pub fn time(text: &str) -> Result<f64, QuantityError> {
    let value = quantity(text, "s")?;
    if value > 0.0 {
        Ok(value)
    } else {
        fail(format!("\"{text}\" is not a positive time"))
    }
}

/// A time \[s\], of any sign.
pub fn any_time(text: &str) -> Result<f64, QuantityError> {
    quantity(text, "s")
}

/// A relative tolerance: a number without unit above 0 and below 1; with 1, all of a value could be wrong.
pub fn tolerance(text: &str) -> Result<f64, QuantityError> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value < 1.0 => Ok(value),
        _ => fail(format!(
            "\"{text}\" is not a number above 0 and below 1\n  help: a tolerance is the share of a value that may be wrong, such as 1e-6"
        )),
    }
}

/// A value with its dimension, or a bare number, whose dimension is unknown.
#[derive(Clone, Copy)]
struct Value {
    number: f64,
    dimension: Option<Dimension>,
}

fn fail<T>(message: String) -> Result<T, QuantityError> {
    Err(QuantityError(message))
}

fn named(dimension: Dimension) -> String {
    match dimension.to_string().as_str() {
        "" => "a pure number".into(),
        unit => format!("in {unit}"),
    }
}

/// Dimension of an SI unit as a model writes it ("N*s/m"); `None` if it is empty or unknown.
pub fn dimension(unit: &str) -> Option<Dimension> {
    let expression = parse(&format!("1 {unit}")).ok()?;
    evaluate(&expression).ok()?.dimension
}

fn evaluate(expression: &Expression) -> Result<Value, QuantityError> {
    match &expression.kind {
        ExpressionKind::Number(number) => Ok(Value {
            number: *number,
            dimension: None,
        }),
        ExpressionKind::Quantity(number, unit) => Ok(Value {
            number: number * unit.factor,
            dimension: Some(unit.dimension),
        }),
        ExpressionKind::Parameter(name) => fail(format!(
            "\"{name}\" is neither a number nor a unit\n  help: a value is a number with its unit, such as `60 kN`"
        )),
        ExpressionKind::Negative(a) => {
            let a = evaluate(a)?;
            Ok(Value {
                number: -a.number,
                ..a
            })
        }
        ExpressionKind::Binary(operator, a, b) => binary(*operator, evaluate(a)?, evaluate(b)?),
        ExpressionKind::Call(function, a) => call(*function, evaluate(a)?),
    }
}

fn binary(operator: Operator, a: Value, b: Value) -> Result<Value, QuantityError> {
    let one = Dimension::ONE;
    let (x, y) = (a.number, b.number);
    let product = |dimension: fn(Dimension, Dimension) -> Dimension| {
        let known = a.dimension.is_some() || b.dimension.is_some();
        known.then(|| dimension(a.dimension.unwrap_or(one), b.dimension.unwrap_or(one)))
    };
    let (number, dimension) = match operator {
        Operator::Multiply => (x * y, product(|a, b| a * b)),
        Operator::Divide => (x / y, product(|a, b| a / b)),
        Operator::Add | Operator::Subtract => {
            if a.dimension.unwrap_or(one) != b.dimension.unwrap_or(one) {
                let [a, b] = [a, b].map(|v| named(v.dimension.unwrap_or(one)));
                return fail(format!(
                    "a quantity that is {a} and one that is {b} cannot be added"
                ));
            }
            let sum = if operator == Operator::Add {
                x + y
            } else {
                x - y
            };
            (sum, a.dimension.or(b.dimension))
        }
    };
    Ok(Value { number, dimension })
}

fn call(function: Function, a: Value) -> Result<Value, QuantityError> {
    let angle = a.dimension.unwrap_or(Dimension::ONE);
    match function {
        Function::SquareRoot => match a.dimension.map(Dimension::root) {
            Some(None) => fail(format!(
                "a quantity {} has no square root with a unit",
                named(angle)
            )),
            root => Ok(Value {
                number: a.number.sqrt(),
                dimension: root.flatten(),
            }),
        },
        Function::Sine | Function::Cosine if angle != Dimension::ONE => fail(format!(
            "sine and cosine are of angles, not of a quantity {}",
            named(angle)
        )),
        Function::Sine => Ok(Value {
            number: libm::sin(a.number),
            dimension: None,
        }),
        Function::Cosine => Ok(Value {
            number: libm::cos(a.number),
            dimension: None,
        }),
    }
}
