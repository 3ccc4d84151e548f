//! Random expressions as programs. Each step applies an operation to earlier values, so that values are shared.

use bryant_generator::expression::{Expr, Function};
use proptest::prelude::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A type over which a program can be run.
pub trait Value:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A number of the same kind as `self`.
    fn number(self, value: f64) -> Self;
    fn sqrt(self) -> Self;
    fn sin(self) -> Self;
    fn cos(self) -> Self;
    fn atan2(self, x: Self) -> Self;
    fn max(self, other: Self) -> Self;
    fn min(self, other: Self) -> Self;
    fn curve(self) -> Self;
}

impl Value for Expr<'_> {
    fn number(self, value: f64) -> Self {
        self.graph().constant(value)
    }
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    fn sin(self) -> Self {
        self.sin()
    }
    fn cos(self) -> Self {
        self.cos()
    }
    fn atan2(self, x: Self) -> Self {
        self.atan2(x)
    }
    fn max(self, other: Self) -> Self {
        self.max(other)
    }
    fn min(self, other: Self) -> Self {
        self.min(other)
    }
    fn curve(self) -> Self {
        self.graph().call(Function::Curve(0), &[self])
    }
}

/// One step.
#[derive(Clone, Copy, Debug)]
pub enum Operation {
    Number(i8),
    Neg,
    Add,
    Sub,
    Mul,
    /// a / (1 + b²), a well-conditioned quotient
    Div,
    /// √(1 + a²)
    Sqrt,
    Sin,
    Cos,
    /// atan2(a, 1 + b²), away from the cut
    Atan2,
    Max,
    Min,
    Curve,
}

/// A random expression, or several.
#[derive(Clone, Debug)]
pub enum Program {
    /// Operations on the values of earlier steps, given as numbers of steps back.
    Steps(Vec<(Operation, usize, usize)>),
    /// Sums of signed products of the inputs, by their indices. They have much in common, up to sign.
    Sums(Vec<Vec<(bool, Vec<usize>)>>),
}

/// Programs of either kind.
pub fn programs() -> impl Strategy<Value = Program> {
    prop_oneof![steps(), sums()]
}

fn sums() -> impl Strategy<Value = Program> {
    let product = prop::collection::vec(0..6usize, 1..4);
    let term = (any::<bool>(), product);
    prop::collection::vec(prop::collection::vec(term, 2..7), 1..5).prop_map(Program::Sums)
}

/// Up to 40 steps, mostly sums and products.
fn steps() -> impl Strategy<Value = Program> {
    let operation = prop_oneof![
        2 => (-4..=4i8).prop_map(Operation::Number),
        1 => Just(Operation::Neg),
        6 => Just(Operation::Add),
        5 => Just(Operation::Sub),
        9 => Just(Operation::Mul),
        2 => Just(Operation::Div),
        1 => Just(Operation::Sqrt),
        1 => Just(Operation::Sin),
        1 => Just(Operation::Cos),
        1 => Just(Operation::Atan2),
        1 => prop_oneof![Just(Operation::Max), Just(Operation::Min)],
        1 => Just(Operation::Curve),
    ];
    // Operands are mostly recent, because otherwise nothing would be nested.
    let back = prop_oneof![0..4usize, 0..40usize];
    prop::collection::vec((operation, back.clone(), back), 3..40).prop_map(Program::Steps)
}

impl Program {
    /// The last three values of the steps, or all sums.
    pub fn run<V: Value>(&self, inputs: [V; 6]) -> Vec<V> {
        match self {
            Program::Steps(steps) => run_steps(steps, inputs),
            Program::Sums(sums) => sums.iter().map(|terms| run_sum(terms, inputs)).collect(),
        }
    }
}

fn run_sum<V: Value>(terms: &[(bool, Vec<usize>)], inputs: [V; 6]) -> V {
    let number = |value| inputs[0].number(value);
    terms.iter().fold(number(0.0), |sum, (minus, factors)| {
        let product = factors.iter().fold(number(1.0), |p, &f| p * inputs[f]);
        if *minus { sum - product } else { sum + product }
    })
}

fn run_steps<V: Value>(steps: &[(Operation, usize, usize)], inputs: [V; 6]) -> Vec<V> {
    let mut values = inputs.to_vec();
    for &(operation, i, j) in steps {
        let pick = |back: usize| values[values.len() - 1 - back % values.len()];
        let (a, b) = (pick(i), pick(j));
        let one = a.number(1.0);
        values.push(match operation {
            // Quarters, so that sums and products of numbers are exact.
            Operation::Number(quarters) => a.number(f64::from(quarters) * 0.25),
            Operation::Neg => -a,
            Operation::Add => a + b,
            Operation::Sub => a - b,
            Operation::Mul => a * b,
            Operation::Div => a / (one + b * b),
            Operation::Sqrt => (one + a * a).sqrt(),
            Operation::Sin => a.sin(),
            Operation::Cos => a.cos(),
            Operation::Atan2 => a.atan2(one + b * b),
            Operation::Max => a.max(b),
            Operation::Min => a.min(b),
            Operation::Curve => a.curve(),
        });
    }
    values.split_off(values.len() - 3)
}
