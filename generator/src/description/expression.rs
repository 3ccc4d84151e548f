//! Arithmetic as written in a quantity: numbers with units, parameters, + − * / ( ) sqrt sin cos pi.
//!
//! ```text
//! sum     = product (('+' | '-') product)*
//! product = factor (('*' | '/') factor)*
//! factor  = ('-' | '+') factor | number [units] | 'pi' | unit | parameter | function '(' sum ')' | '(' sum ')'
//! units   = unit ['^' integer] (('*' | '/') unit ['^' integer])*
//! ```
//!
//! Units behind a number bind it tightest: `x / 2 N/m` divides by two newtons per metre. Names of units are never names
//! of parameters, so a name means one thing wherever it stands.

use super::token::{Token, TokenKind, tokens};
use super::unit::{COMMON, Unit, unit};
use crate::diagnostic::{nearest, quoted};

/// Longest text \[characters\].
const MAX_LENGTH: usize = 1000;
/// Deepest nesting of parentheses, functions and signs.
const MAX_DEPTH: usize = 64;
/// The functions.
pub const FUNCTIONS: [&str; 3] = ["sqrt", "sin", "cos"];

/// A node of arithmetic and where it stands in its text.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    /// First character, from 0.
    pub offset: usize,
    /// Characters.
    pub length: usize,
    /// What it is.
    pub kind: ExpressionKind,
}

/// What a node computes.
#[derive(Clone, Debug, PartialEq)]
pub enum ExpressionKind {
    /// A bare number.
    Number(f64),
    /// A number with its unit.
    Quantity(f64, Unit),
    /// The value of a parameter.
    Parameter(String),
    /// −a
    Negative(Box<Expression>),
    /// a + b, a − b, a · b, a / b
    Binary(Operator, Box<Expression>, Box<Expression>),
    /// √a, sin a, cos a
    Call(Function, Box<Expression>),
}

/// The four operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// +
    Add,
    /// −
    Subtract,
    /// ·
    Multiply,
    /// /
    Divide,
}

/// The functions of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// Square root.
    SquareRoot,
    /// Sine.
    Sine,
    /// Cosine.
    Cosine,
}

/// Why a text is not arithmetic, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Mistake {
    /// First character at fault, from 0.
    pub offset: usize,
    /// Characters at fault.
    pub length: usize,
    /// What is wrong.
    pub message: String,
    /// What would be right.
    pub help: String,
}

/// Parses a text.
pub fn parse(text: &str) -> Result<Expression, Mistake> {
    let characters: Vec<char> = text.chars().collect();
    if characters.len() > MAX_LENGTH {
        return Err(Mistake {
            offset: 0,
            length: 1,
            message: format!("the expression has {} characters", characters.len()),
            help: format!("at most {MAX_LENGTH} are read; name parts of it as parameters"),
        });
    }
    let tokens = tokens(&characters)?;
    let mut parser = Reader {
        tokens,
        next: 0,
        end: characters.len(),
        depth: 0,
    };
    let expression = parser.sum()?;
    match parser.peek() {
        None => Ok(expression),
        Some(token) => Err(parser.unexpected(Some(token.clone()))),
    }
}

struct Reader {
    tokens: Vec<Token>,
    next: usize,
    end: usize,
    depth: usize,
}

impl Reader {
    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.next)
    }

    fn peek_sign(&self, ahead: usize, signs: &str) -> Option<char> {
        match self.tokens.get(self.next + ahead)?.kind {
            TokenKind::Sign(c) if signs.contains(c) => Some(c),
            _ => None,
        }
    }

    fn peek_unit(&self, ahead: usize) -> Option<Unit> {
        match &self.tokens.get(self.next + ahead)?.kind {
            TokenKind::Name(name) => unit(name),
            _ => None,
        }
    }

    fn sum(&mut self) -> Result<Expression, Mistake> {
        self.chain("+-", Reader::product)
    }

    fn product(&mut self) -> Result<Expression, Mistake> {
        self.chain("*/", Reader::factor)
    }

    /// Operands between operators of one rank, from left to right.
    fn chain(
        &mut self,
        signs: &str,
        operand: fn(&mut Self) -> Result<Expression, Mistake>,
    ) -> Result<Expression, Mistake> {
        let mut left = operand(self)?;
        while let Some(sign) = self.peek_sign(0, signs) {
            self.next += 1;
            let right = operand(self)?;
            let operator = match sign {
                '+' => Operator::Add,
                '-' => Operator::Subtract,
                '*' => Operator::Multiply,
                _ => Operator::Divide,
            };
            left = Expression {
                offset: left.offset,
                length: right.offset + right.length - left.offset,
                kind: ExpressionKind::Binary(operator, Box::new(left), Box::new(right)),
            };
        }
        Ok(left)
    }

    fn factor(&mut self) -> Result<Expression, Mistake> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let token = self.peek().cloned();
            return Err(Mistake {
                offset: token.map_or(self.end, |t| t.offset),
                length: 1,
                message: format!("the expression is nested more than {MAX_DEPTH} deep"),
                help: "name parts of it as parameters".to_owned(),
            });
        }
        let result = self.factor_inside();
        self.depth -= 1;
        result
    }

    fn factor_inside(&mut self) -> Result<Expression, Mistake> {
        let Some(token) = self.peek().cloned() else {
            return Err(self.unexpected(None));
        };
        self.next += 1;
        let Token { offset, length, .. } = token;
        let leaf = |kind| Expression {
            offset,
            length,
            kind,
        };
        match &token.kind {
            TokenKind::Number(value) => self.units(offset, length, *value),
            TokenKind::Sign(sign @ ('-' | '+')) => {
                let inner = self.factor()?;
                let length = inner.offset + inner.length - offset;
                Ok(match (sign, inner.kind) {
                    ('+', kind) => Expression {
                        offset,
                        length,
                        kind,
                    },
                    (_, ExpressionKind::Number(value)) => Expression {
                        offset,
                        length,
                        kind: ExpressionKind::Number(-value),
                    },
                    (_, kind) => Expression {
                        offset,
                        length,
                        kind: ExpressionKind::Negative(Box::new(Expression { kind, ..inner })),
                    },
                })
            }
            TokenKind::Sign('(') => {
                let inner = self.sum()?;
                self.close(offset)?;
                Ok(inner)
            }
            TokenKind::Sign(_) => {
                self.next -= 1;
                Err(self.unexpected(Some(token.clone())))
            }
            TokenKind::Name(name) if name == "pi" => {
                Ok(leaf(ExpressionKind::Number(std::f64::consts::PI)))
            }
            TokenKind::Name(name) if FUNCTIONS.contains(&name.as_str()) => {
                self.call(name, offset, length)
            }
            TokenKind::Name(name) if unit(name).is_some() => {
                self.next -= 1;
                self.units(offset, 0, 1.0)
            }
            TokenKind::Name(name) if self.peek_sign(0, "(").is_some() => Err(Mistake {
                offset,
                length,
                message: format!("there is no function {}", quoted(name)),
                help: "the functions are sqrt, sin and cos; products are written with `*`"
                    .to_owned(),
            }),
            TokenKind::Name(name) => Ok(leaf(ExpressionKind::Parameter(name.clone()))),
        }
    }

    /// The call of a function whose name has been read.
    fn call(&mut self, name: &str, offset: usize, length: usize) -> Result<Expression, Mistake> {
        if self.peek_sign(0, "(").is_none() {
            return Err(Mistake {
                offset,
                length,
                message: format!("the function {name} has no argument"),
                help: format!("write `{name}(…)`"),
            });
        }
        self.next += 1;
        let argument = self.sum()?;
        let end = self.close(offset + length)?;
        let function = match name {
            "sqrt" => Function::SquareRoot,
            "sin" => Function::Sine,
            _ => Function::Cosine,
        };
        Ok(Expression {
            offset,
            length: end - offset,
            kind: ExpressionKind::Call(function, Box::new(argument)),
        })
    }

    /// What stands behind a number: nothing, or units.
    fn units(
        &mut self,
        offset: usize,
        mut length: usize,
        value: f64,
    ) -> Result<Expression, Mistake> {
        let mut total: Option<Unit> = None;
        let mut divide = false;
        while let Some(mut unit) = self.peek_unit(0) {
            let token = &self.tokens[self.next];
            length = token.offset + token.length - offset;
            self.next += 1;
            if self.peek_sign(0, "^").is_some() {
                self.next += 1;
                let (power, end) = self.power()?;
                length = end - offset;
                unit = Unit {
                    factor: super::unit::whole_power(unit.factor, power),
                    dimension: unit.dimension.power(power),
                };
            }
            let so_far = total.unwrap_or(Unit {
                factor: 1.0,
                dimension: Default::default(),
            });
            total = Some(if divide {
                Unit {
                    factor: so_far.factor / unit.factor,
                    dimension: so_far.dimension / unit.dimension,
                }
            } else {
                Unit {
                    factor: so_far.factor * unit.factor,
                    dimension: so_far.dimension * unit.dimension,
                }
            });
            match self.peek_sign(0, "*/") {
                Some(sign) if self.peek_unit(1).is_some() => {
                    divide = sign == '/';
                    self.next += 1;
                }
                _ => break,
            }
        }
        if let Some(Token {
            offset,
            length,
            kind: TokenKind::Name(name),
        }) = self.peek().cloned()
        {
            let (message, help) = not_a_unit(&name);
            return Err(Mistake {
                offset,
                length,
                message,
                help,
            });
        }
        Ok(Expression {
            offset,
            length,
            kind: match total {
                None => ExpressionKind::Number(value),
                Some(unit) => ExpressionKind::Quantity(value, unit),
            },
        })
    }

    /// The integer behind `^` and where it ends.
    fn power(&mut self) -> Result<(i32, usize), Mistake> {
        let negative = self.peek_sign(0, "-").is_some();
        self.next += usize::from(negative);
        match self.peek().cloned() {
            Some(Token {
                offset,
                length,
                kind: TokenKind::Number(value),
            }) if value.fract() == 0.0 && value <= 9.0 => {
                self.next += 1;
                let power = value as i32;
                Ok((if negative { -power } else { power }, offset + length))
            }
            token => Err(Mistake {
                offset: token
                    .as_ref()
                    .map_or(self.end.saturating_sub(1), |t| t.offset),
                length: token.map_or(1, |t| t.length),
                message: "the power of a unit is not a whole number up to 9".to_owned(),
                help: "write `m/s^2` or `s^-1`".to_owned(),
            }),
        }
    }

    /// The closing parenthesis; returns where it ends.
    fn close(&mut self, open: usize) -> Result<usize, Mistake> {
        match self.peek_sign(0, ")") {
            Some(_) => {
                let token = &self.tokens[self.next];
                self.next += 1;
                Ok(token.offset + 1)
            }
            None => match self.peek().cloned() {
                None => Err(Mistake {
                    offset: open,
                    length: 1,
                    message: "the parenthesis is not closed".to_owned(),
                    help: "add `)`".to_owned(),
                }),
                token => Err(self.unexpected(token)),
            },
        }
    }

    fn unexpected(&self, token: Option<Token>) -> Mistake {
        let Some(Token {
            offset,
            length,
            kind,
        }) = token
        else {
            return Mistake {
                offset: self.end.saturating_sub(1),
                length: 1,
                message: "the expression ends where a number or a name is needed".to_owned(),
                help: "write a number, a number with its unit, or an expression of parameters"
                    .to_owned(),
            };
        };
        let (what, help) = match kind {
            TokenKind::Sign('^') => (
                "`^`".to_owned(),
                "only units have powers (`m/s^2`); write a square as `a * a`",
            ),
            TokenKind::Sign(c) => (
                format!("`{c}`"),
                "look for an operand or a parenthesis that is missing",
            ),
            TokenKind::Number(value) => (
                format!("the number {value}"),
                "look for an operator that is missing; products are written with `*`",
            ),
            TokenKind::Name(name) => (
                quoted(&name),
                "look for an operator that is missing; products are written with `*`",
            ),
        };
        Mistake {
            offset,
            length,
            message: format!("{what} cannot stand here"),
            help: help.to_owned(),
        }
    }
}

/// Other spellings of units, and those of other systems; what is written here.
const SPELLINGS: [(&[&str], &str); 24] = [
    (&["nm"], "N*m"),
    (&["nms"], "N*m*s"),
    (&["knm"], "kN*m"),
    (&["sec", "secs", "second", "seconds"], "s"),
    (&["msec", "msecs", "millisecond", "milliseconds"], "ms"),
    (&["minute", "minutes"], "min"),
    (&["hour", "hours", "hr"], "h"),
    (&["metre", "metres", "meter", "meters"], "m"),
    (
        &["millimetre", "millimetres", "millimeter", "millimeters"],
        "mm",
    ),
    (&["degree", "degrees", "grad"], "deg"),
    (&["radian", "radians", "rads"], "rad"),
    (&["newton", "newtons"], "N"),
    (&["kilogram", "kilograms", "kilo", "kgs"], "kg"),
    (&["gs", "g0", "gee"], "gn"),
    (&["kph", "kmh", "kmph"], "km/h"),
    (&["mps", "ms-1"], "m/s"),
    (&["percent"], "%"),
    (&["celsius", "kelvin"], "K"),
    (&["mph"], "1.609344 km/h"),
    (&["in", "inch", "inches"], "25.4 mm"),
    (&["ft", "foot", "feet"], "304.8 mm"),
    (&["lb", "lbs", "lbm", "pound", "pounds"], "0.45359237 kg"),
    (&["lbf"], "4.4482216 N"),
    (&["psi"], "6894.757 Pa"),
];

/// How a unit that is none would be written, if it is seen to be meant as one.
pub fn spelling(name: &str) -> Option<String> {
    let small = name.to_lowercase();
    let known = SPELLINGS
        .iter()
        .find(|(others, _)| others.contains(&small.as_str()));
    match known {
        Some((_, right)) if right.starts_with(|c: char| c.is_ascii_digit()) => {
            Some(format!("one `{name}` is `{right}`"))
        }
        Some((_, right)) => Some(format!("write `{right}`")),
        // `s2`, `m3`
        None => {
            let digit = name.chars().last().filter(|d| "234".contains(*d))?;
            let base = name.strip_suffix(digit)?;
            unit(base)?;
            Some(format!("write `{base}^{digit}`"))
        }
    }
}

/// What is wrong with a name behind a number or a unit, and what would be right.
fn not_a_unit(name: &str) -> (String, String) {
    if unit(name).is_some() {
        return (
            format!("the unit {} follows another one", quoted(name)),
            "units are joined by `*` and `/`: `kg*m^2`, `m/s^2`".to_owned(),
        );
    }
    let near = match name.chars().count() {
        // nearly every short word is near some unit; what counts is the case
        0..=2 => COMMON.into_iter().find(|u| u.eq_ignore_ascii_case(name)),
        _ => nearest(name, COMMON),
    };
    let help = match (spelling(name), near) {
        (Some(right), _) => right,
        (None, Some(near)) => format!("did you mean `{near}`?"),
        (None, None) => format!(
            "if it is a parameter, write `2 * {name}`; units are m, kg, s, N, J, W, Pa, Hz, rad with prefixes, \
             g, t, min, h, deg, rpm, %, L, K, bar, gn"
        ),
    };
    (format!("{} is not a unit", quoted(name)), help)
}
