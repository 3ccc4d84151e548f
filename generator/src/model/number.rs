//! A number of a model: a constant, or an expression of parameters.

use serde::Serialize;

/// A number in SI units.
///
/// Arithmetic on parameters remains a tree until the equations are derived; the constructors turn constant expressions
/// into [`Number::Constant`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Number {
    /// A number that is known when the code is generated.
    Constant(f64),
    /// Index into [`Model::parameters`](super::Model::parameters).
    Parameter(usize),
    /// The value of a curve at time t, by its index in [`Model::curves`](super::Model::curves), which an input has in
    /// place of the parameter with this index.
    OverTime {
        /// The curve, over t \[s\].
        curve: usize,
        /// The input.
        input: usize,
    },
    /// −a
    Negative(Box<Number>),
    /// a + b
    Sum(Box<Number>, Box<Number>),
    /// a − b
    Difference(Box<Number>, Box<Number>),
    /// a · b
    Product(Box<Number>, Box<Number>),
    /// a / b
    Quotient(Box<Number>, Box<Number>),
    /// The smaller of a and b
    Smaller(Box<Number>, Box<Number>),
    /// √a
    SquareRoot(Box<Number>),
    /// sin a
    Sine(Box<Number>),
    /// cos a
    Cosine(Box<Number>),
}

impl Number {
    /// Zero.
    pub const ZERO: Number = Number::Constant(0.0);

    /// −a, simplified.
    pub fn negative(a: Number) -> Number {
        match a {
            Number::Constant(a) => Number::Constant(-a),
            Number::Negative(a) => *a,
            a => Number::Negative(Box::new(a)),
        }
    }

    /// a + b, simplified.
    pub fn sum(a: Number, b: Number) -> Number {
        match (a, b) {
            (Number::Constant(a), Number::Constant(b)) => Number::Constant(a + b),
            (Number::Constant(0.0), b) => b,
            (a, Number::Constant(0.0)) => a,
            (a, b) => Number::Sum(Box::new(a), Box::new(b)),
        }
    }

    /// a − b, simplified.
    pub fn difference(a: Number, b: Number) -> Number {
        match (a, b) {
            (Number::Constant(a), Number::Constant(b)) => Number::Constant(a - b),
            (Number::Constant(0.0), b) => Number::negative(b),
            (a, Number::Constant(0.0)) => a,
            (a, b) => Number::Difference(Box::new(a), Box::new(b)),
        }
    }

    /// a · b, simplified.
    pub fn product(a: Number, b: Number) -> Number {
        match (a, b) {
            (Number::Constant(a), Number::Constant(b)) => Number::Constant(a * b),
            (Number::Constant(0.0), _) | (_, Number::Constant(0.0)) => Number::ZERO,
            (Number::Constant(1.0), b) => b,
            (a, Number::Constant(1.0)) => a,
            (a, b) => Number::Product(Box::new(a), Box::new(b)),
        }
    }

    /// a / b, simplified.
    pub fn quotient(a: Number, b: Number) -> Number {
        match (a, b) {
            (Number::Constant(a), Number::Constant(b)) => Number::Constant(a / b),
            (Number::Constant(0.0), _) => Number::ZERO,
            (a, Number::Constant(1.0)) => a,
            (a, b) => Number::Quotient(Box::new(a), Box::new(b)),
        }
    }

    /// The smaller of a and b, simplified.
    pub fn smaller(a: Number, b: Number) -> Number {
        match (a, b) {
            (Number::Constant(a), Number::Constant(b)) => Number::Constant(a.min(b)),
            (a, b) => Number::Smaller(Box::new(a), Box::new(b)),
        }
    }

    /// √a, simplified.
    pub fn square_root(a: Number) -> Number {
        match a {
            Number::Constant(a) => Number::Constant(a.sqrt()),
            a => Number::SquareRoot(Box::new(a)),
        }
    }

    /// sin a, simplified.
    pub fn sine(a: Number) -> Number {
        match a {
            Number::Constant(a) => Number::Constant(libm::sin(a)),
            a => Number::Sine(Box::new(a)),
        }
    }

    /// cos a, simplified.
    pub fn cosine(a: Number) -> Number {
        match a {
            Number::Constant(a) => Number::Constant(libm::cos(a)),
            a => Number::Cosine(Box::new(a)),
        }
    }

    /// True for the constant 0.
    pub fn is_zero(&self) -> bool {
        self.constant() == Some(0.0)
    }

    /// The value, if the number is a constant.
    pub fn constant(&self) -> Option<f64> {
        match self {
            Number::Constant(value) => Some(*value),
            _ => None,
        }
    }

    /// Calls `visit` with the index of each parameter in the number.
    pub fn for_each_parameter(&self, visit: &mut dyn FnMut(usize)) {
        match self {
            Number::Constant(_) => {}
            Number::Parameter(index) | Number::OverTime { input: index, .. } => visit(*index),
            Number::Negative(a) | Number::SquareRoot(a) | Number::Sine(a) | Number::Cosine(a) => {
                a.for_each_parameter(visit)
            }
            Number::Sum(a, b)
            | Number::Difference(a, b)
            | Number::Product(a, b)
            | Number::Quotient(a, b)
            | Number::Smaller(a, b) => {
                a.for_each_parameter(visit);
                b.for_each_parameter(visit);
            }
        }
    }

    /// The number with another number in place of each parameter, simplified.
    pub fn with_parameters(&self, by: &dyn Fn(usize) -> Number) -> Number {
        let of = |a: &Number| a.with_parameters(by);
        match self {
            Number::Constant(value) => Number::Constant(*value),
            Number::Parameter(index) => by(*index),
            Number::OverTime { .. } => self.clone(),
            Number::Negative(a) => Number::negative(of(a)),
            Number::Sum(a, b) => Number::sum(of(a), of(b)),
            Number::Difference(a, b) => Number::difference(of(a), of(b)),
            Number::Product(a, b) => Number::product(of(a), of(b)),
            Number::Quotient(a, b) => Number::quotient(of(a), of(b)),
            Number::Smaller(a, b) => Number::smaller(of(a), of(b)),
            Number::SquareRoot(a) => Number::square_root(of(a)),
            Number::Sine(a) => Number::sine(of(a)),
            Number::Cosine(a) => Number::cosine(of(a)),
        }
    }

    /// Value at the given parameters (SI), indexed as in [`Model::parameters`](super::Model::parameters). An input over
    /// time has that of its parameter.
    pub fn value(&self, parameters: &[f64]) -> f64 {
        match self {
            Number::Constant(value) => *value,
            Number::Parameter(index) | Number::OverTime { input: index, .. } => parameters[*index],
            Number::Negative(a) => -a.value(parameters),
            Number::Sum(a, b) => a.value(parameters) + b.value(parameters),
            Number::Difference(a, b) => a.value(parameters) - b.value(parameters),
            Number::Product(a, b) => a.value(parameters) * b.value(parameters),
            Number::Quotient(a, b) => a.value(parameters) / b.value(parameters),
            Number::Smaller(a, b) => a.value(parameters).min(b.value(parameters)),
            Number::SquareRoot(a) => a.value(parameters).sqrt(),
            Number::Sine(a) => libm::sin(a.value(parameters)),
            Number::Cosine(a) => libm::cos(a.value(parameters)),
        }
    }
}

impl From<f64> for Number {
    fn from(value: f64) -> Self {
        Number::Constant(value)
    }
}
