//! Plain evaluation of a list.

use bryant_generator::program::{Input, List, Operation};
use bryant_generator::target::x86_64::Callee;
use bryant_runtime::Real;

/// Values of the inputs of lists, by regions.
pub struct Given<T> {
    pub time: T,
    pub state: Vec<T>,
    pub accelerations: Vec<T>,
    pub guards: Vec<T>,
    pub parameters: Vec<T>,
    pub derived: Vec<T>,
}

impl<T: Copy> Given<T> {
    fn input(&self, input: Input) -> T {
        match input {
            Input::Time => self.time,
            Input::State(i) => self.state[i as usize],
            Input::Acceleration(i) => self.accelerations[i as usize],
            Input::Guard(i) => self.guards[i as usize],
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

/// What an operation defines.
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

/// The results of a function. Those of the runtime and the user are weighted sums here, with other weights for each.
pub fn called<T: Real>(callee: Callee, arguments: &[T]) -> Vec<T> {
    match callee {
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
