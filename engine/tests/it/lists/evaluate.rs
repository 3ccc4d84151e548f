//! Plain evaluation of a list, to compare with.

use bryant_engine::internals::Library;
use bryant_generator::expression::Function;
use bryant_generator::model::Extrapolate;
use bryant_generator::program::{Curve, Input, List, Operation};
use bryant_generator::target::machine::Callee;
use bryant_runtime::Real;
use std::sync::LazyLock;

/// The inputs of lists, by regions.
pub struct Given<T> {
    pub time: T,
    pub state: Vec<T>,
    pub parameters: Vec<T>,
    pub derived: Vec<T>,
}

impl<T: Copy> Given<T> {
    fn input(&self, input: Input) -> T {
        match input {
            Input::Time => self.time,
            Input::State(i) => self.state[i as usize],
            Input::Acceleration(_) | Input::EventFunction(_) => unreachable!("no list has them"),
            Input::Parameter(i) => self.parameters[i as usize],
            Input::Derived(i) => self.derived[i as usize],
        }
    }
}

/// The results of a list.
pub fn results<T: Real>(list: &List, given: &Given<T>) -> Vec<T> {
    let constants = list.constants.iter().map(|number| T::from_f64(*number));
    let inputs = list.inputs.iter().map(|input| given.input(*input));
    let mut values: Vec<T> = constants.chain(inputs).collect();
    for operation in &list.operations {
        let defined = evaluate(list, &values, *operation);
        values.extend(defined);
    }
    let results = list.results.iter().map(|value| values[value.0 as usize]);
    results.collect()
}

/// The values that an operation defines.
pub fn evaluate<T: Real>(list: &List, values: &[T], operation: Operation) -> Vec<T> {
    let operands = list
        .operands(operation)
        .map(|value| values[value.0 as usize]);
    let operands: Vec<T> = operands.collect();
    let (a, b) = (operands[0], *operands.get(1).unwrap_or(&operands[0]));
    vec![match operation {
        Operation::Neg(_) => -a,
        Operation::Add(..) => a + b,
        Operation::Sub(..) => a - b,
        Operation::Mul(..) => a * b,
        Operation::Div(..) => a / b,
        Operation::MulAdd(..) => a.mul_add(b, operands[2]),
        Operation::Sqrt(_) => a.sqrt(),
        Operation::Max(..) => a.max(b),
        Operation::Min(..) => a.min(b),
        Operation::SinCos(_) => return called(Callee::SinCos, &operands),
        Operation::Atan2(..) => return called(Callee::Atan2, &operands),
        Operation::Call { function, .. } => return called(Callee::Function(function), &operands),
    }]
}

/// Curves that lists call: lines with each extrapolation, with as many points as are written out and with more, and a
/// cubic.
pub fn curves() -> Vec<Curve> {
    let curve = |count: usize, extrapolate, cubic: bool| {
        let point = |k: usize| {
            let x = k as f64;
            [0.7 * x - 1.3 + 0.1 * (x * 1.7).sin(), 2.0 * (x * 2.3).cos()]
        };
        Curve {
            name: String::new(),
            points: (0..count).map(point).collect(),
            tangents: cubic.then(|| (0..count).map(|k| 0.3 * k as f64 - 0.4).collect()),
            extrapolate,
        }
    };
    vec![
        curve(2, Extrapolate::Linear, false),
        curve(5, Extrapolate::Hold, false),
        curve(8, Extrapolate::Error, false),
        curve(3, Extrapolate::Error, false),
        curve(8, Extrapolate::Linear, false),
        curve(9, Extrapolate::Linear, false),
        curve(4, Extrapolate::Linear, true),
        Curve {
            points: vec![[0.0, 0.0], [0.1, 0.3], [0.3, 0.9], [0.7, 2.1]],
            ..curve(4, Extrapolate::Linear, false)
        },
    ]
}

/// The functions, with these curves. They are compiled in the engine for each scalar, and not here once more.
static LIBRARY: LazyLock<Library> = LazyLock::new(|| Library::new(&curves(), None));

/// True if [`called`] calls the function itself.
fn is_called(function: Function) -> bool {
    match function {
        Function::Approach(call) => call.early,
        _ => matches!(
            function,
            Function::Power
                | Function::Choose
                | Function::Curve(_)
                | Function::CurveSlope(_)
                | Function::CurveBreakpoints(_)
        ),
    }
}

/// The results of a function. Searches and functions of the user are replaced by weighted sums, with other weights
/// for each.
pub fn called<T: Real>(callee: Callee, arguments: &[T]) -> Vec<T> {
    let a = arguments;
    match callee {
        Callee::Function(function) if is_called(function) => {
            let mut found = vec![a[0]; callee.results()];
            LIBRARY.call(function, a, &mut found);
            found
        }
        Callee::SinCos => {
            let (sine, cosine) = arguments[0].sin_cos();
            vec![sine, cosine]
        }
        Callee::Atan2 => vec![arguments[0].atan2(arguments[1])],
        Callee::Function(function) => {
            let which = f64::from(format!("{function:?}").bytes().map(u32::from).sum::<u32>());
            let sum = |part: usize| {
                let mut sum = T::from_f64(0.01 * part as f64);
                for (index, argument) in arguments.iter().enumerate() {
                    let weight = (which * (index + 1) as f64 + part as f64).sin();
                    sum += T::from_f64(weight) * *argument;
                }
                sum
            };
            (0..callee.results()).map(sum).collect()
        }
    }
}
