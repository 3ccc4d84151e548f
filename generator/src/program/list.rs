//! A straight-line program as data.

use crate::expression::Function;
use serde::{Deserialize, Serialize};

/// A value of a list, by its number: constants come first, then inputs, then the results of operations, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Value(pub u32);

/// An input of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Input {
    /// t \[s\].
    Time,
    /// An entry of the state y: q, v, z, m.
    State(u32),
    /// An acceleration, for a method that starts from accelerations.
    Acceleration(u32),
    /// An event function, for the method that renews the memory by its sign.
    EventFunction(u32),
    /// A parameter, by its index in the model.
    Parameter(u32),
    /// A value that depends on parameters alone, by its index among such values.
    Derived(u32),
}

/// One operation. It defines one value, except [`Operation::SinCos`], which defines two, and [`Operation::Call`], which
/// defines as many values as the function has results.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Operation {
    /// −a
    Neg(Value),
    /// a + b
    Add(Value, Value),
    /// a − b
    Sub(Value, Value),
    /// a · b
    Mul(Value, Value),
    /// a / b
    Div(Value, Value),
    /// a · b + c, rounded once if the scalar type supports that.
    MulAdd(Value, Value, Value),
    /// √a
    Sqrt(Value),
    /// sin a, then cos a.
    SinCos(Value),
    /// Angle of the point x = second operand, y = first operand.
    Atan2(Value, Value),
    /// The larger of the two; the first if either is NaN.
    Max(Value, Value),
    /// The smaller of the two; the first if either is NaN.
    Min(Value, Value),
    /// A function of the runtime or of the user. Its arguments are [`List::arguments`] from `first` on, as many as its
    /// [arity](Function::arity). If the function has several results, the call defines all of them, in order.
    Call {
        /// The function; if it has several results, its [first part](Function::first_part).
        function: Function,
        /// Index of its first argument.
        first: u32,
    },
}

/// A straight-line program: no loops, no branches, every value defined once.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct List {
    /// Constants: the values 0, 1, ….
    pub constants: Vec<f64>,
    /// Inputs: the values after the constants.
    pub inputs: Vec<Input>,
    /// Operations, which define the values after the inputs.
    pub operations: Vec<Operation>,
    /// Arguments of calls.
    pub arguments: Vec<Value>,
    /// The results, in order. A result may be a constant or an input, and may occur twice.
    pub results: Vec<Value>,
}

impl Operation {
    /// Number of values that the operation defines.
    pub fn defines(&self) -> usize {
        match self {
            Operation::SinCos(_) => 2,
            Operation::Call { function, .. } => function.part().map_or(1, |(_, parts)| parts),
            _ => 1,
        }
    }

    /// The same operation with its operands mapped. The arguments of a call are in the list and do not change.
    pub fn map(self, mut map: impl FnMut(Value) -> Value) -> Operation {
        match self {
            Operation::Neg(a) => Operation::Neg(map(a)),
            Operation::Add(a, b) => Operation::Add(map(a), map(b)),
            Operation::Sub(a, b) => Operation::Sub(map(a), map(b)),
            Operation::Mul(a, b) => Operation::Mul(map(a), map(b)),
            Operation::Div(a, b) => Operation::Div(map(a), map(b)),
            Operation::MulAdd(a, b, c) => Operation::MulAdd(map(a), map(b), map(c)),
            Operation::Sqrt(a) => Operation::Sqrt(map(a)),
            Operation::SinCos(a) => Operation::SinCos(map(a)),
            Operation::Atan2(a, b) => Operation::Atan2(map(a), map(b)),
            Operation::Max(a, b) => Operation::Max(map(a), map(b)),
            Operation::Min(a, b) => Operation::Min(map(a), map(b)),
            Operation::Call { .. } => self,
        }
    }
}

impl List {
    /// The operands of an operation, in order.
    pub fn operands(&self, operation: Operation) -> impl Iterator<Item = Value> + '_ {
        let (few, many): ([Option<Value>; 3], &[Value]) = match operation {
            Operation::Neg(a) | Operation::Sqrt(a) | Operation::SinCos(a) => {
                ([Some(a), None, None], &[])
            }
            Operation::Add(a, b)
            | Operation::Sub(a, b)
            | Operation::Mul(a, b)
            | Operation::Div(a, b)
            | Operation::Atan2(a, b)
            | Operation::Max(a, b)
            | Operation::Min(a, b) => ([Some(a), Some(b), None], &[]),
            Operation::MulAdd(a, b, c) => ([Some(a), Some(b), Some(c)], &[]),
            Operation::Call { function, first } => {
                let first = first as usize;
                ([None; 3], &self.arguments[first..first + function.arity()])
            }
        };
        few.into_iter().flatten().chain(many.iter().copied())
    }

    /// Number of values: constants, inputs and results of operations.
    pub fn values(&self) -> usize {
        let defined: usize = self.operations.iter().map(Operation::defines).sum();
        self.constants.len() + self.inputs.len() + defined
    }
}
