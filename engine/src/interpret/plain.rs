//! A plain loop over the operations of a list: for models with too many values for runs of chains, and for scalars with
//! costly operations.

use super::Layout;
use crate::call::{self, Library};
use bryant_generator::expression::Function;
use bryant_generator::program::{List, Operation, Value};
use bryant_runtime::{Real, Task};
use std::collections::HashMap;

/// A place in the frame.
type Place = u32;

/// A list in the form that this loop runs.
#[derive(Debug)]
pub struct Code {
    steps: Vec<Step>,
    /// The calls; a step has the index of its call.
    calls: Vec<Call>,
    /// The places of the arguments of calls.
    arguments: Vec<Place>,
    /// The places of the results of the list.
    pub results: Vec<Place>,
    /// One more than the largest place in the code.
    pub end: usize,
}

/// A call: the range of its arguments; and the first place of its results, with their number.
#[derive(Clone, Copy, Debug)]
struct Call {
    function: Function,
    arguments: (u32, u32),
    results: (Place, u32),
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Neg,
    Add,
    Sub,
    Mul,
    Div,
    MulAdd,
    Sqrt,
    SinCos,
    Atan2,
    Max,
    Min,
    Call,
}

/// An operation on places. In a call, `a` is the index of the call.
#[derive(Clone, Copy, Debug)]
struct Step {
    kind: Kind,
    to: Place,
    a: Place,
    b: Place,
    c: Place,
}

impl Code {
    /// Number of arguments of the longest call.
    pub fn most_arguments(&self) -> usize {
        let lengths = self
            .calls
            .iter()
            .map(|call| call.arguments.1 - call.arguments.0);
        lengths.max().unwrap_or(0) as usize
    }
}

/// Encodes a list. `constants` gives the place of each constant, by its bits.
pub fn encode(list: &List, layout: &Layout, constants: &HashMap<u64, Place>) -> Code {
    let mut place: Vec<Place> = Vec::with_capacity(list.values());
    place.extend(list.constants.iter().map(|c| constants[&c.to_bits()]));
    place.extend(list.inputs.iter().map(|input| layout.place(*input)));
    let leaves = place.len();
    let last_use = last_uses(list);
    let mut frame = Places {
        next: layout.rest,
        free: Vec::new(),
    };
    let mut found = Code {
        steps: Vec::with_capacity(list.operations.len()),
        calls: Vec::new(),
        arguments: Vec::new(),
        results: Vec::new(),
        end: 0,
    };
    for (number, &operation) in list.operations.iter().enumerate() {
        let at = |value: Value| place[value.0 as usize];
        let kind = kind_of(operation);
        let first = found.arguments.len() as u32;
        let [a, b, c] = match kind {
            Kind::Call => {
                found.arguments.extend(list.operands(operation).map(at));
                [found.calls.len() as Place, 0, 0]
            }
            _ => {
                let mut operands = list.operands(operation).map(at);
                std::array::from_fn(|_| operands.next().unwrap_or(0))
            }
        };
        let mut freed: Vec<Value> = list.operands(operation).collect();
        freed.sort_unstable();
        freed.dedup();
        for value in freed {
            if value.0 as usize >= leaves && last_use[value.0 as usize] == number {
                frame.free.push(place[value.0 as usize]);
            }
        }
        let count = operation.defines() as u32;
        let start = place.len();
        // The results of a call have neighbouring places. All arguments are copied before the results are written.
        let to = match count {
            1 => frame.one(),
            _ => frame.several(count),
        };
        place.extend((0..count).map(|part| to + part));
        for value in start..place.len() {
            if last_use[value] == number {
                frame.free.push(place[value]);
            }
        }
        if let Operation::Call { function, .. } = operation {
            found.calls.push(Call {
                function,
                arguments: (first, found.arguments.len() as u32),
                results: (to, count),
            });
        }
        found.steps.push(Step { kind, to, a, b, c });
    }
    found.results = (list.results.iter())
        .map(|value| place[value.0 as usize])
        .collect();
    found.end = frame.next as usize;
    found
}

fn kind_of(operation: Operation) -> Kind {
    match operation {
        Operation::Neg(_) => Kind::Neg,
        Operation::Add(..) => Kind::Add,
        Operation::Sub(..) => Kind::Sub,
        Operation::Mul(..) => Kind::Mul,
        Operation::Div(..) => Kind::Div,
        Operation::MulAdd(..) => Kind::MulAdd,
        Operation::Sqrt(_) => Kind::Sqrt,
        Operation::SinCos(_) => Kind::SinCos,
        Operation::Atan2(..) => Kind::Atan2,
        Operation::Max(..) => Kind::Max,
        Operation::Min(..) => Kind::Min,
        Operation::Call { .. } => Kind::Call,
    }
}

/// Free places of the frame.
struct Places {
    next: Place,
    free: Vec<Place>,
}

impl Places {
    fn one(&mut self) -> Place {
        self.free.pop().unwrap_or_else(|| self.several(1))
    }

    fn several(&mut self, count: u32) -> Place {
        let first = self.next;
        self.next += count;
        first
    }
}

/// For each value, the last operation that uses it, or the operation that defines it if none uses it; `usize::MAX` for
/// results.
fn last_uses(list: &List) -> Vec<usize> {
    let leaves = list.constants.len() + list.inputs.len();
    let mut last = vec![0; leaves];
    for (number, &operation) in list.operations.iter().enumerate() {
        for value in list.operands(operation) {
            last[value.0 as usize] = number;
        }
        last.extend(std::iter::repeat_n(number, operation.defines()));
    }
    for value in &list.results {
        last[value.0 as usize] = usize::MAX;
    }
    last
}

/// The steps of a list as a task, compiled for the instructions of the scalar.
pub struct Steps<'a, T> {
    pub code: &'a Code,
    pub library: &'a Library,
    pub frame: &'a mut [T],
    /// Room for the arguments of a call.
    pub arguments: &'a mut [T],
}

impl<T: Real> Task for Steps<'_, T> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Steps {
            code,
            library,
            frame,
            arguments,
        } = self;
        for step in &code.steps {
            let (a, b, c) = (step.a as usize, step.b as usize, step.c as usize);
            let result = match step.kind {
                Kind::Neg => -frame[a],
                Kind::Add => frame[a] + frame[b],
                Kind::Sub => frame[a] - frame[b],
                Kind::Mul => frame[a] * frame[b],
                Kind::Div => frame[a] / frame[b],
                Kind::MulAdd => frame[a].mul_add(frame[b], frame[c]),
                Kind::Sqrt => frame[a].sqrt(),
                Kind::SinCos => {
                    let (sin, cos) = call::sin_cos(frame[a]);
                    frame[step.to as usize + 1] = cos;
                    sin
                }
                Kind::Atan2 => call::atan2(frame[a], frame[b]),
                Kind::Max => frame[a].max(frame[b]),
                Kind::Min => frame[a].min(frame[b]),
                Kind::Call => {
                    let site = &code.calls[a];
                    let (first, end) = site.arguments;
                    let places = &code.arguments[first as usize..end as usize];
                    for (argument, &place) in arguments.iter_mut().zip(places) {
                        *argument = frame[place as usize];
                    }
                    let (to, count) = (site.results.0 as usize, site.results.1 as usize);
                    let given = &arguments[..places.len()];
                    library.call(site.function, given, &mut frame[to..to + count]);
                    continue;
                }
            };
            frame[step.to as usize] = result;
        }
    }
}

// the lists and their evaluation are those of the tests of machine code
#[cfg(test)]
mod tests {
    use super::{Steps, encode};
    use crate::call::Library;
    use crate::interpret::Layout;
    use crate::tests::evaluate::evaluate;
    use crate::tests::random::{INPUTS, Mix, Random, list};
    use bryant_generator::expression::Function;
    use bryant_generator::program::{List, Operation, Value};
    use bryant_runtime::Task as _;
    use std::collections::HashMap;

    /// Appends a choice between any values, and a product with its result.
    fn append_call(list: &mut List, random: &mut Random) {
        let first = list.arguments.len() as u32;
        let values = list.values();
        let mut any = || Value(random.below(values) as u32);
        list.arguments.extend([(); 4].map(|()| any()));
        let (factor, result) = (any(), Value(values as u32));
        list.operations.push(Operation::Call {
            function: Function::Choose,
            first,
        });
        list.operations.push(Operation::Mul(result, factor));
        list.results.extend([result, Value(values as u32 + 1)]);
    }

    #[test]
    fn the_plain_loop_has_the_bits_of_each_operation_alone() {
        let mix = Mix {
            length: 60,
            calls: 0,
            reach: 20,
        };
        for seed in 0..50 {
            let random = &mut Random::new(seed);
            let mut list = list(random, mix);
            append_call(&mut list, random);
            let places = (0..).zip(&list.constants);
            let constants: HashMap<u64, u32> = places.map(|(i, c)| (c.to_bits(), i)).collect();
            let [state, parameters, derived] = INPUTS.map(|n| n as u32);
            let parameters_at = list.constants.len() as u32;
            let time = parameters_at + parameters + derived;
            let layout = Layout {
                parameters: parameters_at,
                derived: parameters_at + parameters,
                time,
                state: time + 1,
                rest: time + 1 + state,
            };
            let code = encode(&list, &layout, &constants);
            let mut frame: Vec<f64> = (0..code.end).map(|_| random.ordinary()).collect();
            frame[..list.constants.len()].copy_from_slice(&list.constants);

            let inputs = list.inputs.iter();
            let inputs = inputs.map(|input| frame[layout.place(*input) as usize]);
            let mut values = list.constants.clone();
            values.extend(inputs);
            for &operation in &list.operations {
                let defined = evaluate(&list, &values, operation);
                values.extend(defined);
            }

            Steps {
                code: &code,
                library: &Library::new(&[], None),
                frame: &mut frame,
                arguments: &mut vec![0.0; code.most_arguments()],
            }
            .run();
            for (value, &place) in list.results.iter().zip(&code.results) {
                let (found, expected) = (frame[place as usize], values[value.0 as usize]);
                let same = found.to_bits() == expected.to_bits();
                assert!(
                    same || found.is_nan() && expected.is_nan(),
                    "list {seed}: {found} for {expected}"
                );
            }
        }
    }
}
